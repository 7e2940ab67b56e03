// SPDX-License-Identifier: BSD-3-Clause
// The largest sizes that narrow strips and near sheets of a surface permit.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// A size that a surface permits at a point of one of its edges.
struct SizeBound {
  int half_edge;
  Vec3 place;
  double size;
  double gap;         ///< to the other line or sheet; of a tube its mean width
  double length = 0;  ///< of the side of a strip that this bounds; 0 for sheets and tubes
};

/// Interpolates values of the vertices along half-edge h, at its point nearest to p.
double value_along(const Mesh& mesh, const std::vector<double>& value, int h, Vec3 p);

/// Returns the number of triangles that narrow strips need beyond those for their area, if the size is at
/// most `most` and that of the bounds: a strip takes one triangle per edge on its sides, whatever its width.
double triangles_of_strips(const std::vector<SizeBound>& bounds, double most);

/// Measures where a surface comes so close to itself that edges of the length `asked` (per vertex) cannot be
/// good: a strip between two lines (borders or model edges) permits a multiple of its width, a bent sheet
/// those edges that sag towards another sheet by a share of the gap, a tube along a longer edge a quarter of
/// the way around it. Lines and sheets that meet nearby are adjacent, not near. Returns the bounds, at least
/// `least`, by half-edge; only those of strips if these need more triangles than `most_triangles`. `close`,
/// per triangle: unless it is empty, sheets are looked for only along edges of these and edges longer than
/// asked. Becomes where sheets are within the gap, folds too; smaller sizes are as a rule bounded only there.
std::vector<SizeBound> permitted_sizes(const Connectivity& surface, const std::vector<double>& asked,
                                       double least, double most_triangles, std::vector<char>& close);

}  // namespace meshpipe
