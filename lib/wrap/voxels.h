// SPDX-License-Identifier: BSD-3-Clause
// A sparse grid of voxels around a triangle soup, and which of them lie outside.
#pragma once
#include <array>
#include <cstdint>

#include "lib/core/bvh.h"
#include "lib/wrap/wrap.h"

namespace meshpipe {

/// Cubes of side `spacing`, in blocks of 8^3; blocks are stored only near the soup.
struct Voxels {
  static constexpr int side = 8, volume = side * side * side;
  enum State : std::uint8_t { inside, open, outside };

  Vec3 low;
  double spacing = 0;
  std::array<int, 3> blocks{};            ///< number of blocks along each axis
  std::vector<int> stored;                ///< per block: its index among the stored ones, or -1
  std::vector<std::uint8_t> far_outside;  ///< per block that is not stored: whether it is outside
  std::vector<std::array<int, 3>> place;  ///< per stored block: its position
  std::vector<float> distance;            ///< per voxel: of its center from the soup
  std::vector<std::uint8_t> state;        ///< per voxel: State

  int block_index(int i, int j, int k) const { return (k * blocks[1] + j) * blocks[0] + i; }
  Vec3 center(int i, int j, int k) const { return low + spacing * Vec3{i + 0.5, j + 0.5, k + 0.5}; }
  /// Returns the voxel at a position, or -1 - its block where the block is not stored.
  std::int64_t at(int i, int j, int k) const {
    const int block = block_index(i / side, j / side, k / side), s = stored[block];
    return s < 0 ? -1 - (std::int64_t)block
                 : (std::int64_t)s * volume + (k % side * side + j % side) * side + i % side;
  }
  /// Returns the position of a stored voxel.
  std::array<int, 3> position(std::int64_t voxel) const {
    const auto& b = place[voxel / volume];
    const int v = (int)(voxel % volume);
    return {b[0] * side + v % side, b[1] * side + v / side % side, b[2] * side + v / (side * side)};
  }
  bool is_outside(std::int64_t voxel) const {
    return voxel < 0 ? far_outside[-1 - voxel] : state[voxel] == outside;
  }
};

/// Computes which voxels are outside: those that a ball of diameter alpha sweeps that comes from infinity and
/// never comes nearer to the soup than the offset, and those reached from there by descending the distance
/// from the soup, so that concave edges are sharp and narrow gaps end at their narrowest place. The boundary
/// is a manifold, and no voxel outside meets the soup.
Voxels outside_voxels(const Mesh& soup, const Bvh& tree, const WrapOptions& options, WrapReport& report);

}  // namespace meshpipe
