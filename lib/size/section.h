// SPDX-License-Identifier: BSD-3-Clause
// Sections of tubes between their vertices.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// Measures tubes along edges that are longer than the size: their rings have no vertices there.
class Sections {
 public:
  /// Takes the size per vertex. Requires: the surface outlives this.
  Sections(const Connectivity& surface, const std::vector<double>& asked);

  /// Returns the length of the section at a right angle to half-edge h through its point p; infinity if it is
  /// open or longer than `most`, crosses three lines (which keep it), or is near the peak to which the tube
  /// tapers (sharp_peaks), where local_feature_size bounds the size. `asked`: at p. Counts triangles in
  /// `work`.
  double length(int h, Vec3 p, double asked, double most, long long& work) const;

 private:
  const Connectivity& surface_;
  std::vector<char> peak_;  ///< per vertex
  double least_, least_at_peaks_;
};

}  // namespace meshpipe
