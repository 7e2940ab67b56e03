// SPDX-License-Identifier: BSD-3-Clause
// The file with the outcomes of a chain's rounds.
#pragma once
#include <string>

#include "tools/io.h"
#include "tools/report/rounds.h"

namespace meshpipe {

/// The verdict on one round of a chain, added to the file that holds those of the rounds before it. Errors of
/// the program are written there and not on standard error.
class RoundFile {
 public:
  /// Takes over the failures of `io`, which this must outlive; does nothing without a file.
  RoundFile(Io& io, std::string file, bool bounded_distance);
  /// Returns whether the chain is to be repeated: then this round writes nothing else.
  bool repeats() const { return !file_.empty() && is_repeated(before_, outcome); }
  void write() const;

  Outcome outcome;

 private:
  std::string file_, before_;
};

}  // namespace meshpipe
