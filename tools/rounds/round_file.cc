// SPDX-License-Identifier: BSD-3-Clause
#include "tools/rounds/round_file.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "lib/core/error.h"
#include "tools/files.h"

namespace meshpipe {

RoundFile::RoundFile(Io& io, std::string file, bool bounded_distance) : file_(std::move(file)) {
  if (file_.empty()) return;
  io.expect_report("--verdict", file_);
  if (std::filesystem::is_regular_file(file_)) before_ = read_bytes(file_);
  outcome.bounded_distance = bounded_distance;
  io.on_failure = [this, &io](int status, const std::string& why, const std::string& program) {
    outcome.status = status;
    outcome.program = program;
    outcome.message = why;
    try {
      write();
    } catch (const CannotWrite& e) {
      std::fprintf(stderr, "%s: error: %s\n", io.program.c_str(), e.what());
    }
    return !repeats();
  };
}

double RoundFile::least_distance(double last) const {
  for (const Score& s : scores_in(before_))
    if (s.requirement == "hausdorff") last = std::min(last, -s.value);
  return last;
}

void RoundFile::write() const {
  if (!file_.empty()) Io::write_file(file_, before_ + verdict_block(before_, outcome));
}

Stream& read(Io& io, Summary& summary, const Wanted& wanted) {
  summary.output = io.output;
  try {
    return io.read(wanted);
  } catch (const UpstreamFailed&) {
    summary.counts = true;
    throw;
  }
}

int add_to_table(const std::string& file, const Summary& summary, int status) {
  if (!summary.counts) return status;
  try {
    append_line(file, summary_heading(), summary_line(summary, status));
    return status;
  } catch (const CannotWrite& e) {
    std::fprintf(stderr, "mcheck: error: %s\n", e.what());
  }
  if (status != 0) return status;
  remove_file(summary.output);
  return 7;
}

}  // namespace meshpipe
