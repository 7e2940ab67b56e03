// SPDX-License-Identifier: BSD-3-Clause
// Topology of the regions of a labeled surface, and of the union of two of them without counting again.
#pragma once
#include <vector>

#include "lib/core/connectivity.h"

namespace meshpipe {

/// What the topology of an edge-connected region follows from, and adds up when regions are joined.
struct Region {
  int faces = 0;
  int border = 0;        ///< half-edges whose other side is another region, or nothing
  int inside = 0;        ///< vertices with their whole star in the region
  int loops = 0;         ///< closed walks of border half-edges
  bool pinched = false;  ///< a vertex that lies on the border more than once
  double area = 0;
  double longest_loop = 0;
  /// Eq. (2), the border's vertices counted once for each fan: V = inside + border, E = (3 F + border) / 2.
  int genus() const { return (2 - inside - (border - faces) / 2 - loops) / 2; }
  bool maps_to_the_plane() const { return !pinched && loops > 0 && genus() == 0; }
  /// The paper's estimate of the aspect ratio, eta = pi A / L^2.
  double aspect() const {
    return longest_loop > 0 ? 3.14159265358979323846 * area / (longest_loop * longest_loop) : 0;
  }
};

/// The regions of a labeled surface: row l of both is label l.
struct Regions {
  std::vector<Region> region;
  std::vector<std::vector<int>> border;  ///< border half-edges
};

/// Regions of the labels 0..n-1 of an oriented manifold without pinched vertices; linear.
Regions find_regions(const Connectivity& c, const std::vector<int>& label, int n);

/// Gives the edge-connected pieces of the labels the numbers 0..n-1, by their first triangles; returns n.
int separate_pieces(const Connectivity& c, std::vector<int>& label);

/// The triangles around the origin of a border half-edge of a region.
struct Fan {
  int vertex, size, half_edge;
};
/// Returns the fans of label `l` at vertices where its region touches itself, without the largest at each, by
/// vertex and size. `border`: half-edges of the region's border.
std::vector<Fan> pinched_fans(const Connectivity& c, const std::vector<int>& label, int l,
                              const std::vector<int>& border);

/// Joins regions one pair after another; looks only at their borders.
class Joiner {
 public:
  /// Keeps references to all except the regions.
  Joiner(const Connectivity& c, std::vector<int>& label, Regions regions);
  /// What the union of two neighboring regions would be.
  Region joined(int a, int b);
  /// Makes b part of a; b is left empty.
  void join(int a, int b);
  const Regions& regions() const { return regions_; }

 private:
  const Connectivity c_;
  std::vector<int>& label_;
  Regions regions_;
  std::vector<int> outgoing_, shared_, outer_;
};

}  // namespace meshpipe
