// SPDX-License-Identifier: BSD-3-Clause
// The levels of Laplace maps of a long part (the paper's section 3, steps 1 to 4): one harmonic map of a
// disk, computed piecewise in frames of size 1, so that its exponentially small regions keep all their
// digits.
#pragma once
#include <vector>

#include "lib/multiscale/filled_disk.h"

namespace meshpipe {

/// One level's map: the triangles it resolves, in a frame of size 1 (the root: the unit disk). A child's
/// frame is (uv of the parent - center) / scale; frames are never composed, since that would underflow.
struct Level {
  int parent = -1;
  Vec2 center;  ///< a point of this set, in the parent's disk
  std::vector<int> children;
  std::vector<int> tris;     ///< triangles of the disk, by number
  std::vector<Tri> corners;  ///< their corners as places in `vertex`
  std::vector<int> vertex;   ///< vertices of the disk, by number
  std::vector<Vec2> uv;
  std::vector<int> holes;     ///< places in `vertex` of the virtual centers resolved here
  std::vector<Vec2> border;   ///< of the set in the parent's disk, counter-clockwise; empty for the root
  std::vector<double> angle;  ///< of the border's vertices on the own circle, rising by less than 2 pi
};

/// Returns the point of a level's frame around which most of its surface is: where the line divides it if
/// there is nothing to pass through.
Vec2 middle_of(const FilledDisk& disk, const Level& level);

/// Maps the disk level by level; level 0 maps the rim to the unit circle. Triangles whose image is smaller
/// than 1e-10 of the level's disk are withdrawn in edge-connected sets. Each set of 10 or more is a level of
/// its own, with the parent's image of its border as Dirichlet data. Parents come before children; every
/// triangle is in one level. A level's system covers only what it can resolve, so that the whole is close to
/// linear however long the part is. Throws: GoalMissed if a system is singular.
std::vector<Level> laplace_levels(const FilledDisk& disk);

}  // namespace meshpipe
