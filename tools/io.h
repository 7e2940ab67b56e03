// SPDX-License-Identifier: BSD-3-Clause
// A program's input, output, messages and report.
#pragma once
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "formats/formats.h"
#include "tools/files.h"
#include "tools/options.h"

namespace meshpipe {

/// In what a program differs from the others.
struct Usage {
  bool reads = true;          ///< takes FILE
  std::string_view writes{};  ///< extensions of -o FILE; empty: those of meshes
  bool passes = false;        ///< makes a few passes over arrays as large as its input: freed memory is kept
  bool shards = false;        ///< FILE may be a shard of several streams
  bool sets_unit = false;     ///< chooses a unit in which the surface is measurable, if it is not
  bool any_size = false;      ///< computes nothing from coordinates, so that their size does not matter
};

/// Reads and writes as the common options ask.
class Io : public CommonOptions {
 public:
  /// Reads FILE or standard input, in any format, into `stream`, which outlives the body of the program.
  /// Throws: NotAdmissible if the size of the surface is not measurable (lib/core/mesh.h), unless of any
  /// size; BadUsage for options that are lengths if the stream has a unit. `wanted`: see read_stream.
  Stream& read(const Wanted& wanted = {});
  /// Reads a second file of the user's, such as a reference, in the unit of `stream`.
  Stream read(const std::string& path) const;
  /// Adds this program to the history and writes the stream to -o FILE or standard output; other formats get
  /// coordinates without a unit.
  void write(Stream& stream);
  /// Writes what `make` makes of each stream of FILE, in parallel: of those of a shard, of which read() has
  /// returned the first. Returns how many there are. Throws: BadUsage if -o FILE is no stream.
  int write_each(const std::function<Stream(Stream)>& make);
  /// Returns whether -o FILE has to be text; reports what its format cannot hold.
  /// Throws: CannotWrite for --binary STL whose single precision does not hold the surface.
  bool text_for(const Stream& stream) const;
  /// Writes another stream, in the unit of the one that was read, to a file, or standard output for "-", in
  /// the format of its extension.
  void write_to(const std::string& path, Stream other) const;
  /// Writes bytes to -o FILE or standard output.
  void write_bytes(std::string_view bytes) const;
  /// Writes bytes to another file, or standard output for "-".
  static void write_file(const std::string& path, std::string_view bytes);
  /// Checks before the work that a further file can be written; `option` is for the message.
  /// Throws: CannotWrite, or BadUsage if a `mesh` has an unknown extension, or if another option or the input
  /// is the same file; only -o may overwrite the input, by another mesh.
  void expect_report(const std::string& option, const std::string& path, bool mesh = false);
  /// Prints a line after the program's name on standard error, unless -q.
  void say(const std::string& line) const;
  /// Prints such a line even with -q.
  void warn(const std::string& line) const;
  /// Prints such a line only with -v.
  void detail(const std::string& line) const;

  std::string program;
  std::string arguments;  ///< that change the result, for the stream's history
  Usage usage;
  std::string length;             ///< an option given that has lengths, not shares of the surface's; "": none
  Stream stream;                  ///< what read() has read, as far as the program has come with it
  bool names_way_out = true;      ///< on a failure; not if it will be tried again
  nlohmann::ordered_json report;  ///< --json FILE gets it on success and on status 4 (if not empty), 5, 6
  /// Takes a failure in place of the line on standard error: status, message, and the program that failed.
  /// Returns whether the next program in the pipe learns of it.
  std::function<bool(int, const std::string&, const std::string&)> on_failure;
  mutable bool wrote_to_stdout = false;
  mutable std::string finished_file;  ///< the complete -o FILE: removed by a later failure

 private:
  std::vector<std::pair<std::string, std::string>> expected_files_;  ///< option, path
  int unit_ = 0;                                                     ///< of the stream that read() has read
  std::unique_ptr<InputFile> input_;                                 ///< FILE, if it has several streams
};

}  // namespace meshpipe
