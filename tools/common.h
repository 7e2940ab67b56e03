// SPDX-License-Identifier: BSD-3-Clause
// What every program shares: the common options, reading and writing, reports, exit statuses.
#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "formats/formats.h"
#include "formats/stream.h"
#include "lib/error.h"

namespace meshpipe {

/// A program's input, output and reports, as the common options ask for them.
class Io {
 public:
  /// Reads FILE or standard input, in any format. Throws NotAdmissible if its size is not measurable
  /// (lib/mesh.h), unless Usage says any_size.
  Stream read();
  /// Reads a second file (a reference, say); `path` as the user gave it.
  Stream read(const std::string& path) const;
  /// The bytes of another file of the user's, or of standard input for "-".
  static std::string read_bytes(const std::string& path);
  /// Adds this program to the history and writes the stream to -o FILE (beside it, then renamed) or standard
  /// output.
  void write(Stream& stream);
  /// Whether -o FILE is to be text; and tells what the format of its extension has no room for.
  /// Throws CannotWrite if it is to be binary STL by --binary and single precision does not hold the surface.
  bool text_for(const Stream& stream) const;
  /// Writes another stream to a file of the user's ("-": standard output), in the format of its extension.
  void write_to(const std::string& path, const Stream& stream) const;
  /// Writes bytes to -o FILE or standard output, the same way.
  void write_bytes(std::string_view bytes) const;
  /// Writes bytes to another file of the user's, beside it and renamed, or to standard output for "-".
  static void write_file(const std::string& path, std::string_view bytes);
  /// Before the work, not after it: throws CannotWrite if write_file would fail now for a further file, and
  /// BadUsage if write_to would for the extension of a `mesh`, or if the file is that of -o, of --json, or
  /// one that was expected before (`option` is for the message).
  void expect_report(const std::string& option, const std::string& path, bool mesh = false);
  /// A line on standard error, after the program's name; not with -q.
  void say(const std::string& line) const;
  /// The same, only with -v.
  void detail(const std::string& line) const;

  std::string program;
  std::string input = "-", output = "-";
  bool ascii = false, binary = false, quiet = false, verbose = false;
  int threads = 0;
  nlohmann::ordered_json report;  ///< what --json FILE writes once the body has returned, or failed with 4
                                  ///< (if it holds anything), 5, 6
  std::string json;

 private:
  /// Whether a file must be text: of STL, because single precision does not hold the surface, which it says.
  bool needs_text(const std::string& path, const Stream& stream) const;
  friend int run_tool(int, char**, const char*, const char*, const std::function<void(CLI::App&)>&,
                      const std::function<void(Io&)>&, struct Usage);
  bool any_size_ = false;
  std::string arguments_;
  std::vector<std::pair<std::string, std::string>> files_;  ///< that are to be written, by their options
  mutable bool written_ = false;  ///< something went to standard output: no failure line after it
  mutable std::string finished_;  ///< the file of -o, once it has its name: removed by a failure after that
};

/// What is not as usual with a program.
struct Usage {
  bool reads = true;        ///< takes FILE
  bool writes_mesh = true;  ///< -o is a mesh, its format by extension
  bool passes = false;    ///< a few passes over all its input, in arrays of that size: most of its time would
                          ///< go into fresh pages, so that freed memory is kept for the next arrays
  bool any_size = false;  ///< computes nothing of coordinates, which may be beyond what areas can be told of
};

/// A check of an option's value: above 0, and finite.
CLI::Validator positive_number();

/// How many triangles the machine's memory holds while a pipeline of these programs works on them.
double most_triangles();

/// The whole main of a program: parses the common options and those that `options` adds, runs `body`, and
/// turns exceptions into one line on standard error and the documented exit status. `summary` ends with the
/// examples --help shows ("\n  mclean ..."). Options of `options` that change the result are recorded in the
/// stream; put those that do not in the group "Reports". That -o and --json can be written is seen before
/// `body` runs; for further files call expect_report first.
int run_tool(int argc, char** argv, const char* program, const char* summary,
             const std::function<void(CLI::App&)>& options, const std::function<void(Io&)>& body,
             Usage usage = {});

}  // namespace meshpipe
