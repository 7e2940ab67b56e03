// SPDX-License-Identifier: BSD-3-Clause
#include "tools/io.h"

#include <unistd.h>

#include <cstdio>

#include "formats/foreign/stl.h"
#include "lib/core/error.h"
#include "tools/files.h"
#include "tools/progress_line.h"

namespace meshpipe {
namespace {

/// Returns whether a path gets the stream: .ply, no extension, standard output.
bool is_stream_name(const std::string& path) {
  const std::string extension = extension_of(path);
  return path == "-" || extension.empty() || extension == ".ply";
}

void encode(const std::string& path, const Stream& stream, bool text, const Sink& sink) {
  if (is_stream_name(path))
    write_stream(stream, text, sink);
  else
    sink(write_as(stream, path, text));
}

}  // namespace

Stream& Io::read() {
  if (input == "-" && ::isatty(STDIN_FILENO))
    throw BadUsage("no FILE, and standard input is a terminal; see " + program + " --help");
  stream = read(input);
  set_phase(Phase::working);
  return stream;
}

std::string Io::read_bytes(const std::string& path) { return std::string(InputFile(path).rest()); }

Stream Io::read(const std::string& path) const {
  InputFile file(path);
  const std::string where = path == "-" ? "stdin" : path;
  constexpr std::size_t start = 200;  // bytes that show a stream
  Stream stream = is_stream(file.next(start)) ? read_stream(file, where) : read_any(file.rest(), where);
  // what the reader of a foreign file left out; the remarks of a stream were reported by earlier programs
  if (stream.history.empty())
    for (const std::string& remark : stream.remarks) say(remark);
  if (!any_size) expect_measurable(stream.surface);
  return stream;
}

bool Io::needs_text(const std::string& path, const Stream& stream) const {
  if (extension_of(path) != ".stl") return false;
  const std::string why = beyond_single_precision(stream.surface);
  if (why.empty()) return false;
  if (binary) throw CannotWrite(path + ": single precision of binary .stl does not hold the surface: " + why);
  say(path + " is written as text, single precision of binary .stl does not hold the surface: " + why);
  return true;
}

bool Io::text_for(const Stream& stream) const {
  const std::string extension = extension_of(output);
  // only text STL holds patches and their names
  const bool named = extension == ".stl" && !binary && !stream.names.empty();
  const bool text = ascii || named || (stream.ascii && !binary) || needs_text(output, stream);
  if (is_stream_name(output) && program != "mconvert") return text;
  if (const std::string lost = lost_in(stream, output, text); !lost.empty())
    say("left out, " + std::string(extension == ".stl" && !text ? "binary " : "") + extension +
        " cannot hold it: " + lost);
  return text;
}

void Io::write(Stream& stream) {
  stream.history.push_back({program, MESHPIPE_VERSION, arguments});
  const bool text = text_for(stream);
  if (output == "-" && !text && ::isatty(STDOUT_FILENO))
    throw BadUsage("the stream is binary and standard output is a terminal; use -o FILE, a pipe or --ascii");
  auto produce = [&](const Sink& sink) { encode(output, stream, text, sink); };
  set_phase(Phase::writing);
  if (output != "-") {
    write_atomically(output, produce);
    finished_file = output;
    return;
  }
  wrote_to_stdout = true;
  produce([](std::string_view bytes) { write_all(STDOUT_FILENO, bytes, "stdout"); });
}

void Io::write_to(const std::string& path, const Stream& stream) const {
  const bool text = ascii || needs_text(path, stream);
  write_atomically(path, [&](const Sink& sink) { encode(path, stream, text, sink); });
}

void Io::write_bytes(std::string_view bytes) const {
  if (output != "-") {
    write_file(output, bytes);
    finished_file = output;
    return;
  }
  wrote_to_stdout = true;
  write_all(STDOUT_FILENO, bytes, "stdout");
}

void Io::write_file(const std::string& path, std::string_view bytes) {
  write_atomically(path, [&](const Sink& sink) { sink(bytes); });
}

void Io::expect_report(const std::string& option, const std::string& path, bool mesh) {
  for (const auto& [other, file] : expected_files_)
    if (is_same_file(path, file)) {
      throw BadUsage(option + ' ' + path + ": " +
                     (path != "-"     ? "that is the file of " + other
                      : other == "-o" ? "standard output is for the result; give -o FILE"
                                      : "standard output is for " + other));
    }
  if (path != "-" && is_same_file(path, input) && !(mesh && option == "-o"))
    throw BadUsage(option + ' ' + path + ": that is the input");
  expected_files_.push_back({option, path});
  if (mesh && !is_stream_name(path)) writer_of(path);
  expect_writable(path);
}

void Io::warn(const std::string& line) const {
  // on a terminal, over the progress line
  const char* clear = ::isatty(STDERR_FILENO) ? "\r\033[K" : "";
  std::fprintf(stderr, "%s%s: %s\n", clear, program.c_str(), line.c_str());
}

void Io::say(const std::string& line) const {
  if (!quiet) warn(line);
}

void Io::detail(const std::string& line) const {
  if (verbose) say(line);
}

}  // namespace meshpipe
