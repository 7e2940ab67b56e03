// SPDX-License-Identifier: BSD-3-Clause
// How the library fails: one exception type for each kind of failure a user can act on.
// The message is one line in lower case, without a period, with the place and both numbers.
#pragma once
#include <stdexcept>

namespace meshpipe {

struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// The command line asks for something impossible or not built yet (exit 2).
struct BadUsage : Error {
  using Error::Error;
};
/// The input cannot be read or is malformed (exit 3).
struct BadInput : Error {
  using Error::Error;
};
/// The input is sound but not admissible here: not manifold, not a disk, a section missing (exit 4).
struct NotAdmissible : Error {
  using Error::Error;
};
/// The stage could not reach its goal (exit 5).
struct GoalMissed : Error {
  using Error::Error;
};
/// The result was checked and misses its contract (exit 6).
struct ContractMissed : Error {
  using Error::Error;
};
/// The result could not be written (exit 7).
struct CannotWrite : Error {
  using Error::Error;
};

}  // namespace meshpipe
