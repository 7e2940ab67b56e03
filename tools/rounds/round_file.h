// SPDX-License-Identifier: BSD-3-Clause
// The file with the outcomes of a chain's rounds, and the table with those of many chains.
#pragma once
#include <string>

#include "tools/io.h"
#include "tools/report/summary.h"
#include "tools/rounds/rounds.h"

namespace meshpipe {

/// The verdict on one round of a chain, added to the file that holds those of the rounds before it. Errors of
/// the program are written there and not on standard error.
class RoundFile {
 public:
  /// Takes over the failures of `io`, which this must outlive; does nothing without a file.
  RoundFile(Io& io, std::string file, bool bounded_distance);
  /// Returns whether the chain is to be repeated: then this round writes nothing else.
  bool repeats() const { return !file_.empty() && is_repeated(before_, outcome); }
  /// Returns the mean size of the first round's result, by which later rounds are judged, which may be finer;
  /// 0: none.
  double first_size() const {
    const std::vector<double> sizes = numbers_in(before_, "size");
    return sizes.empty() ? 0 : sizes[0];
  }
  /// Returns the smallest bound of the distance that this round, whose is `last`, or one before it has
  /// reached.
  double least_distance(double last) const;
  void write() const;

  Outcome outcome;

 private:
  std::string file_, before_;
};

/// Reads the result. A program before this one that has failed counts in the summary, too.
Stream& read(Io& io, Summary& summary, const Wanted& wanted);

/// Adds the line of a finished run to a table, if it counts. Returns the run's status, or 7 if a success
/// cannot be added: then the result is removed.
int add_to_table(const std::string& file, const Summary& summary, int status);

}  // namespace meshpipe
