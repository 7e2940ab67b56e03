// SPDX-License-Identifier: BSD-3-Clause
// One vertex for all at the same place, to the last bit or within a tolerance.
#pragma once
#include <vector>

#include "lib/mesh.h"

namespace meshpipe {

/// Makes one vertex of all that have the same coordinates, and drops those that no triangle uses; vertices
/// are numbered by first use. Triangles stay as they are otherwise.
void weld(Mesh& mesh);

/// The first vertex with used != 0 and the coordinates of v, for every v (0 and -0 are equal); v itself if it
/// is not used.
std::vector<int> first_equal(const std::vector<Vec3>& points, const std::vector<char>& used);

/// Goes on from `same` as `first_equal` made it: a vertex that lies no farther than `tolerance` > 0 from an
/// earlier one that was kept is merged into the nearest of them. No vertex moves by more than the tolerance,
/// and chains of close vertices do not run together. Returns the number of vertices merged. Linear for
/// tolerances below the edges' length.
int merge_near(const std::vector<Vec3>& points, const std::vector<char>& used, double tolerance,
               std::vector<int>& same);

}  // namespace meshpipe
