// SPDX-License-Identifier: BSD-3-Clause
#include "tools/io.h"

#include <omp.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <map>
#include <mutex>

#include "formats/foreign/stl.h"
#include "lib/core/error.h"
#include "lib/core/parallel.h"
#include "tools/files.h"
#include "tools/progress_line.h"

namespace meshpipe {
namespace {

/// Returns whether a path gets the stream: .ply, no extension, standard output.
bool is_stream_name(const std::string& path) {
  const std::string extension = extension_of(path);
  return path == "-" || extension.empty() || extension == ".ply" || extension == ".mply";
}

void encode(const std::string& path, const Stream& stream, bool text, const Sink& sink) {
  if (is_stream_name(path))
    write_stream(stream, text, sink);
  else
    sink(write_as(stream, path, text));
}

std::string name_of(const std::string& path) { return path == "-" ? "stdin" : path; }

/// Returns a stream that was read, in this unit, after its checks.
Stream accepted(const Io& io, Stream stream, int unit) {
  // what the reader of a foreign file left out; the remarks of a stream were reported by earlier programs
  if (stream.history.empty())
    for (const std::string& remark : stream.remarks) io.say(remark);
  if (io.usage.any_size) return stream;
  change_unit(stream, unit);
  expect_measurable(stream.surface);
  return stream;
}

bool needs_text(const Io& io, const std::string& path, const Stream& stream) {
  if (extension_of(path) != ".stl") return false;
  const std::string why = beyond_single_precision(stream.surface);
  if (why.empty()) return false;
  if (io.binary)
    throw CannotWrite(path + ": single precision of binary .stl does not hold the surface: " + why);
  io.say(path + " is written as text, single precision of binary .stl does not hold the surface: " + why);
  return true;
}

void write_output(const Io& io, bool text, const std::function<void(const Sink&)>& produce) {
  if (io.output == "-" && !text && ::isatty(STDOUT_FILENO))
    throw BadUsage("the stream is binary and standard output is a terminal; use -o FILE, a pipe or --ascii");
  write_atomically(io.output, [&](const Sink& sink) {
    produce([&](std::string_view bytes) {
      io.wrote_to_stdout = io.output == "-";
      sink(bytes);
    });
  });
  if (io.output != "-") io.finished_file = io.output;
}

}  // namespace

Stream& Io::read(const Wanted& wanted) {
  if (input == "-" && ::isatty(STDIN_FILENO))
    throw BadUsage("no FILE, and standard input is a terminal; see " + program + " --help");
  input_ = std::make_unique<InputFile>(input);
  stream = read_next(*input_, name_of(input), usage.shards, wanted);
  if (!usage.shards || input_->next(1).empty()) input_.reset();  // frees its memory now
  unit_ = stream.unit;
  if (usage.sets_unit && unit_ == 0) {
    unit_ = measurable_unit(stream.surface);
    if (unit_ != 0)
      say("coordinates and lengths are multiples of 2^" + std::to_string(unit_) + " from here on");
  }
  stream = accepted(*this, std::move(stream), unit_);
  if (unit_ != 0 && !length.empty())
    throw BadUsage(length + " has lengths, but those of this surface are multiples of 2^" +
                   std::to_string(unit_) + ": run mconvert --scale 1e" +
                   std::to_string(-(int)(unit_ * std::log10(2))) + " before mclean");
  set_phase(Phase::working);
  return stream;
}

Stream Io::read(const std::string& path) const {
  InputFile file(path);
  return accepted(*this, read_next(file, name_of(path)), unit_);
}

bool Io::text_for(const Stream& stream) const {
  const std::string extension = extension_of(output);
  // only text STL holds patches and their names
  const bool named = extension == ".stl" && !binary && !stream.names.empty();
  const bool text = ascii || named || (stream.ascii && !binary) || needs_text(*this, output, stream);
  if (is_stream_name(output) && program != "mconvert") return text;
  if (const std::string lost = lost_in(stream, output, text); !lost.empty())
    say("left out, " + std::string(extension == ".stl" && !text ? "binary " : "") + extension +
        " cannot hold it: " + lost);
  return text;
}

void Io::write(Stream& stream) {
  if (&stream != &this->stream) stream.unit = unit_;
  if (!is_stream_name(output)) change_unit(stream, 0);
  stream.history.push_back({program, MESHPIPE_VERSION, arguments});
  const bool text = text_for(stream);
  set_phase(Phase::writing);
  write_output(*this, text, [&](const Sink& sink) { encode(output, stream, text, sink); });
}

int Io::write_each(const std::function<Stream(Stream)>& make) {
  if (!is_stream_name(output))
    throw BadUsage("-o " + output + ": the result of a shard is a stream; expected the extension .ply");
  const bool text = ascii || (stream.ascii && !binary);
  const auto history = stream.history;
  std::mutex reading, writing;
  int n = 0, written = 0;
  std::map<int, Stream> made;  // and not written yet, since one before them is missing
  std::map<int, std::exception_ptr> failed;
  // what was read before the first that fails is made in any case, so that failures do not depend on the
  // threads
  auto take = [&] {
    const std::lock_guard lock(reading);
    if (n == 0) return std::pair(n++, std::move(stream));
    const std::lock_guard other(writing);
    if (!failed.empty() || !input_ || input_->next(1).empty()) return std::pair(-1, Stream());
    try {
      const std::string where = name_of(input) + " stream " + std::to_string(n + 1);
      Stream next = read_next(*input_, where, true);
      return std::pair(n++, std::move(next));
    } catch (...) {
      failed[n] = std::current_exception();
      return std::pair(-1, Stream());
    }
  };
  auto put = [&](int i, Stream one, const Sink& sink) {
    one.history = history;
    one.history.push_back({program, MESHPIPE_VERSION, arguments});
    const std::lock_guard lock(writing);
    made[i] = std::move(one);
    for (; made.contains(written); made.erase(written++)) encode(output, made[written], text, sink);
  };
  write_output(*this, text, [&](const Sink& sink) {
    parallel_for(omp_get_max_threads(), [&](int) {
      for (;;) {
        auto [i, next] = take();
        if (i < 0) return;
        try {
          put(i, make(std::move(next)), sink);
        } catch (...) {
          const std::lock_guard lock(writing);
          failed[i] = std::current_exception();
        }
      }
    });
    if (!failed.empty()) std::rethrow_exception(failed.begin()->second);
  });
  return n;
}

void Io::write_to(const std::string& path, Stream other) const {
  other.unit = unit_;
  if (!is_stream_name(path)) change_unit(other, 0);
  const bool text = ascii || needs_text(*this, path, other);
  write_atomically(path, [&](const Sink& sink) { encode(path, other, text, sink); });
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
