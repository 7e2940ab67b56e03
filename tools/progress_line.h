// SPDX-License-Identifier: BSD-3-Clause
// The line on a terminal that shows how far a program is.
#pragma once
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace meshpipe {

/// What the program is doing; in a pipe it first waits for its input.
enum class Phase { waiting, reading, working, writing };
void set_phase(Phase phase);
/// Moves on from `waiting` to `reading`; other phases stay.
void note_input_begins();

/// Shows the percentage done and the seconds left from the first second on, if standard error is a terminal;
/// clears the line at the end.
class ProgressLine {
 public:
  ProgressLine(const std::string& program, bool quiet);
  ~ProgressLine();

 private:
  void watch(const std::string& program);

  std::thread thread_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool over_ = false;
};

}  // namespace meshpipe
