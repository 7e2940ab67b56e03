// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numbers>

#include "lib/cap/steps.h"
#include "lib/core/least_area.h"
#include "lib/core/normals.h"
#include "lib/core/split_edges.h"
#include "lib/core/topology.h"

namespace meshpipe {
namespace {

/// Loops of more vertices have no cap of least area: that is cubic.
constexpr std::size_t most_corners = 600;
/// Mean edge lengths of the rim above which edges of the cap are split, and how often at most.
constexpr double longest_edge = 1.5;
constexpr int most_splits = 6;
/// Sweeps of Gauss and Seidel: enough for the few hundred vertices of a cap.
constexpr int sweeps = 200;

/// Splits edges inside the cap that join vertices of its rim, or are long.
void refine(Surface& cap, double length) {
  const int rim = (int)cap.points.size();
  for (int round = 0; round < most_splits; ++round) {
    std::vector<int> opposite = opposite_halfedges(cap);
    std::vector<char> mark(opposite.size(), 0);
    const Connectivity c{cap, opposite};
    for (int h = 0; h < c.n_half_edges(); ++h)
      mark[h] =
          !c.is_border(h) && ((c.from(h) < rim && c.to(h) < rim) || c.length(h) > longest_edge * length);
    if (std::count(mark.begin(), mark.end(), 1) == 0) return;
    split_edges({cap, opposite}, mark, nullptr);
  }
}

/// Moves the vertices from `rim` on to a membrane under pressure, which bulges by `height` if it is round.
void inflate(Surface& cap, int rim, double height) {
  const Lists neighbors = neighbors_of(cap);
  const double pressure = height * std::numbers::pi / total_area(cap);
  std::vector<double> force(cap.points.size(), 0);  // for edges as they are at first: otherwise it may grow
  for (int v = rim; v < (int)cap.points.size(); ++v)
    for (int w : neighbors[v]) {
      const Vec3 way = cap.points[w] - cap.points[v];
      force[v] += pressure * dot(way, way);
    }
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    const std::vector<Vec3> normals = vertex_normals(cap);
    for (int v = rim; v < (int)cap.points.size(); ++v) {
      Vec3 sum = force[v] * normals[v];
      for (int w : neighbors[v]) sum = sum + (cap.points[w] - cap.points[v]);
      cap.points[v] = cap.points[v] + (1.0 / (double)neighbors[v].size()) * sum;
    }
  }
}

}  // namespace

bool fits_membrane(const End& end) { return end.rims.size() == 1 && end.rims[0].size() <= most_corners; }

int fair_cap(Mesh& mesh, const End& end, double bulge, Growth& growth) {
  const std::vector<int>& rim = end.rims[0];
  const int n = (int)rim.size();
  Mesh least;
  double length = 0;
  for (int i = 0; i < n; ++i) {
    least.points.push_back(mesh.points[rim[i]]);
    length += norm(mesh.points[rim[(i + 1) % n]] - mesh.points[rim[i]]) / n;
  }
  least.tris = least_area_triangles(least.points, std::vector<char>(rim.size() * rim.size(), 0));
  Surface cap = surface_of(std::move(least));
  refine(cap, length);
  inflate(cap, n, bulge * end.radius);
  const int first = (int)mesh.points.size() - n;
  for (std::size_t v = rim.size(); v < cap.points.size(); ++v) {
    mesh.points.push_back(cap.points[v]);
    growth.add_like(rim[0]);
  }
  for (const Tri& t : cap.tris) {
    Tri added = t;
    for (int& v : added) v = v < n ? rim[v] : first + v;
    mesh.tris.push_back(added);
  }
  return (int)cap.tris.size();
}

}  // namespace meshpipe
