// SPDX-License-Identifier: BSD-3-Clause
// Shares of a check as streams, on which mcheck works as separate jobs.
#pragma once
#include "formats/stream/shards.h"
#include "lib/check/check.h"

namespace meshpipe {

/// A share of a check.
struct CheckJob {
  int number = 0, all = 0;  ///< of the share, among all
  CheckShare share;
};

/// Returns whether the stream is a share to be measured: table `check_share`.
inline bool is_check_share(const Stream& stream) { return stream.find("check_share") != nullptr; }

/// Returns the share as a stream, without history: its mesh is the surface.
Stream stream_of(CheckJob job);
/// Takes a share out of its stream. Throws: BadInput or NotAdmissible for any other stream.
CheckJob take_share(Stream stream);
/// Returns what was measured of a share as a stream without a surface or history.
Stream stream_of(int number, int all, ShareFindings found);

/// Returns what was measured of a stream's result in all shares, in their order. `names`: of the shards'
/// files. Throws: BadInput, with a shard's name, for one that is none of this result or was not made by `by`,
/// and for shares that are missing or doubled.
std::vector<ShareFindings> join_checks(const Stream& whole, const Provenance& by,
                                       const std::vector<std::string>& names, const ReadShard& read);

}  // namespace meshpipe
