// SPDX-License-Identifier: BSD-3-Clause
// Verification of sheets that meet: the lines where they do, and the regions between them.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "lib/solids/solids.h"

namespace meshpipe {

/// What is compared: {reference, result}.
using Both = std::array<int, 2>;

struct RegionVolume {
  int label;
  double reference, result;
  double explained = 0;  ///< by how much the volume may differ where the boundaries are near
};

struct SheetFindings {
  Both lines{}, corners{};  ///< lines of more than two sheets, and the points where they end or change
  Both flips{};             ///< lines of two triangles across which the orientation changes
  Both regions{};
  std::vector<RegionVolume> volumes;
  double volume_error = 0;  ///< largest difference over the reference's volume
  int worst = -1;           ///< row of `volumes` that has it
  std::vector<std::string> faults;
  /// Triangles with a free edge, where the reference has none in this patch, or at all if not `named`.
  std::vector<int> unmatched;
};

/// Returns the triangles along slits: pairs of free edges that have one place, and no other edge there.
std::vector<int> slits_of(const Mesh& mesh);

/// Compares the lines where sheets meet (by their patches, or by the number of sheets if patches are not
/// `named` alike) and, if `solid`, the regions that they enclose, which are unknown where sheets intersect.
/// In both surfaces sheets are apart, with the same coordinates where they meet. `sheets`: the regions on
/// both sides of each patch of the result.
SheetFindings compare_sheets(const Surface& reference, const Surface& result,
                             const std::vector<SheetPatch>& sheets, bool named, bool solid);

}  // namespace meshpipe
