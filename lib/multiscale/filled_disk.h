// SPDX-License-Identifier: BSD-3-Clause
// A part of genus 0 as a topological disk with the weights of its Laplacian.
#pragma once
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// A part of genus 0 made a topological disk: all its loops but the longest are filled by fans around virtual
/// centers. The part's own vertices and triangles come first, then the centers and the fans.
struct FilledDisk : Mesh {
  std::vector<int> opposite;
  std::vector<double> weights;  ///< of the Laplacian, per half-edge; positive
  std::vector<int> rim;         ///< vertices of the longest loop, counter-clockwise
  int part_vertices = 0, part_tris = 0;
  std::vector<int> fan_begin;  ///< first triangle of each hole's fan, and the end
};

/// Returns whether the point is inside the polygon, by the even-odd rule.
bool encloses(const std::vector<Vec2>& polygon, Vec2 p);

/// Fills the holes of a part, all loops but the longest, by fans around virtual centers. Requires: one
/// component of genus 0 with a border, no pinched vertex.
FilledDisk fill_holes(const Mesh& part);

}  // namespace meshpipe
