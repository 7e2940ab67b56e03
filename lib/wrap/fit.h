// SPDX-License-Identifier: BSD-3-Clause
// The boundary of the voxels as quadrilaterals, fitted to the surface at the offset from the soup.
#pragma once
#include "lib/core/bvh.h"
#include "lib/wrap/voxels.h"

namespace meshpipe {

/// The quadrilaterals of a closed manifold, oriented outward.
struct QuadMesh {
  std::vector<Vec3> points;
  std::vector<std::array<int, 4>> quads;
  std::vector<std::uint8_t> bridge;  ///< per quadrilateral: it closes a gap, and the soup is not behind it
};

/// Returns the faces between voxels inside and outside, oriented outward.
QuadMesh boundary_of(const Voxels& voxels);

/// Returns the points moved to where the planes at `offset` from the soup meet, in the least-squares sense,
/// so that edges and corners of the soup are edges and corners of the fitted surface; points far from the
/// soup go to the middle of their neighbors. Source: quadric error functions as in dual contouring (Ju and
/// others 2002).
std::vector<Vec3> fitted_points(const QuadMesh& boundary, const Mesh& soup, const Bvh& tree, double offset,
                                double spacing);

/// Returns two triangles per quadrilateral, by the diagonal whose middle is closer to the offset surface.
std::vector<Tri> divided(const QuadMesh& boundary, const std::vector<Vec3>& points, const Mesh& soup,
                         const Bvh& tree, double offset);

}  // namespace meshpipe
