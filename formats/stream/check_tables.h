// SPDX-License-Identifier: BSD-3-Clause
// Shares of a check as streams, on which mcheck works as jobs of their own.
#pragma once
#include <array>

#include "formats/stream.h"
#include "lib/check/check.h"

namespace meshpipe {

/// Some shares of a check.
struct CheckShard {
  int all = 0;               ///< shares of the check
  std::vector<int> numbers;  ///< of these, in the order of all
  std::vector<CheckShare> shares;
};

/// Returns whether the stream has shares to be measured, table `check_share`.
inline bool has_check_shares(const Stream& stream) { return stream.find("check_share") != nullptr; }

/// Shares one after the other as the columns of a stream.
class ShareTables {
 public:
  void add(int number, const CheckShare& share);
  /// Moves the shares into a stream, from which all tables are dropped: their meshes are its surface. `all`:
  /// shares of the check.
  void write(Stream& stream, int all);

 private:
  std::vector<int> numbers_;
  std::vector<CheckShare> heads_;         ///< without lists
  std::vector<std::array<int, 4>> rows_;  ///< of each share's meshes
  Mesh meshes_, others_;
  std::vector<int> vertices_, triangles_;
  std::vector<double> allowed_;
};

/// Reads what ShareTables wrote. Throws: BadInput if the rows of a table are not those of the shares.
CheckShard read_shares(const Stream& stream);

/// Puts what was measured of the shares into the stream, in place of everything else.
void write_findings(Stream& stream, const CheckShard& shard, const std::vector<ShareFindings>& found);

/// Returns what was measured of a stream's result in all shares, in their order. `read` returns a shard by
/// its name. Throws: BadInput, with a shard's name, for one that is none of this result, or was not made by
/// `by`, and for shares that are missing or doubled.
std::vector<ShareFindings> join_checks(const Stream& whole, const Provenance& by,
                                       const std::vector<std::string>& names,
                                       const std::function<Stream(const std::string&)>& read);

}  // namespace meshpipe
