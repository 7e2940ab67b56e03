// SPDX-License-Identifier: BSD-3-Clause
// Topology of the regions of a labeled surface, and of the union of two of them without counting again.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// Counts of an edge-connected region, of which its topology follows and which add up in unions.
struct Region {
  int faces = 0;
  int border = 0;        ///< half-edges whose other side is another region, or nothing
  int inside = 0;        ///< vertices with their whole star in the region
  int loops = 0;         ///< closed walks of border half-edges
  bool pinched = false;  ///< a vertex that lies on the border more than once
  double area = 0;
  double longest_loop = 0;
  /// Returns the genus by eq. (2) of the paper. The border's vertices count once for each fan: V = inside +
  /// border, E = (3 F + border) / 2.
  int genus() const { return (2 - inside - (border - faces) / 2 - loops) / 2; }
  bool maps_to_the_plane() const { return !pinched && loops > 0 && genus() == 0; }
  /// Returns the paper's estimate of the aspect ratio, eta = pi A / L^2; 0 without a border.
  double aspect() const {
    return longest_loop > 0 ? 3.14159265358979323846 * area / (longest_loop * longest_loop) : 0;
  }
};

/// The regions of a labeled surface: row l of both is label l.
struct Regions {
  std::vector<Region> region;
  std::vector<std::vector<int>> border;  ///< border half-edges
};

/// Measures the regions of the labels 0..n-1 (`label`: per triangle; negative: none) of an oriented manifold
/// without pinched vertices. Linear.
Regions find_regions(const Connectivity& c, const std::vector<int>& label, int n);

/// Replaces the labels (per triangle) by numbers 0..n-1 of their edge-connected pieces, in the order of their
/// first triangles; returns n.
int separate_pieces(const Connectivity& c, std::vector<int>& label);

/// A fan of `size` triangles around a vertex of a region; the border half-edge that leaves the vertex.
struct Fan {
  int vertex, size, half_edge;
};
/// Returns the fans with label `l` at vertices where the region of that label touches itself, all but the
/// largest at each vertex, sorted by vertex and size. `border`: half-edges of the region's border; those that
/// are no longer on it are skipped.
std::vector<Fan> pinched_fans(const Connectivity& c, const std::vector<int>& label, int l,
                              const std::vector<int>& border);

/// Joins regions one pair after another; looks only at their borders.
class Joiner {
 public:
  /// Takes the regions of `label` (find_regions); keeps references to all else.
  Joiner(const Connectivity& c, std::vector<int>& label, Regions regions);
  /// Returns the region that the union of neighboring regions a and b would be.
  Region joined(int a, int b);
  /// Makes region b part of a, in the labels too; b is left empty.
  void join(int a, int b);
  const Regions& regions() const { return regions_; }

 private:
  const Connectivity c_;
  std::vector<int>& label_;
  Regions regions_;
  std::vector<int> outgoing_, shared_, outer_;
};

}  // namespace meshpipe
