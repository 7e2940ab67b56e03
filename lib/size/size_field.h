// SPDX-License-Identifier: BSD-3-Clause
// A size field given on another mesh or on scattered points.
#pragma once
#include <vector>

#include "lib/core/bvh.h"
#include "lib/core/mesh.h"

namespace meshpipe {

/// A size field on another mesh: a target edge length per point, linear on triangles. A point of no triangle
/// has one of its own with three equal corners (add_lone_points).
struct SizeField : Mesh {
  std::vector<double> size;
};

/// Adds a degenerate triangle for every point that no triangle uses.
void add_lone_points(SizeField& field);

/// Returns the size at the point of the field nearest to p; where several sheets are almost equally near, the
/// smallest. Distances that differ by a tenth of the larger size are almost equal; by what they differ more
/// than by a tenth of the smaller size, that grows, by `gradation` per length. `tree`: of the field.
double size_near(const SizeField& field, const Bvh& tree, Vec3 p, double gradation);

/// Throws NotAdmissible, with the names of the existing columns, unless the vertices have column `name`.
void expect_data(const Surface& surface, const std::string& name);

}  // namespace meshpipe
