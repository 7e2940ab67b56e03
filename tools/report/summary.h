// SPDX-License-Identifier: BSD-3-Clause
// A table of many verdicts, one line each: every run of mcheck adds its own.
#pragma once
#include <string>
#include <vector>

#include "lib/check/check.h"

namespace meshpipe {

/// What one run of mcheck has found out; nothing yet at first.
struct Summary {
  std::string output;             ///< file of the result: names the line
  std::vector<Failure> failures;  ///< of the contract
  std::vector<Figure> figures;    ///< none if no result came
  bool counts = false;            ///< is there anything to add a line for?
};

/// Returns the heading of the table, tab-separated: output, status, failed, and the key of every figure.
std::string summary_heading();

/// Returns the line of a run with this exit status; "-" for what it does not have.
std::string summary_line(const Summary& summary, int status);

}  // namespace meshpipe
