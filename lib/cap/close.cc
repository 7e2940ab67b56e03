// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numbers>

#include "lib/cap/steps.h"
#include "lib/core/cdt.h"
#include "lib/core/least_area.h"

namespace meshpipe {
namespace {

/// Share of an extension in which the section becomes a circle; and radii that this takes at most.
constexpr double share_of_transition = 0.5, longest_transition = 2;
/// Loops of more vertices have no cap of least area: that is cubic.
constexpr std::size_t most_corners = 600;

/// Rings of an extension at most.
constexpr int most_rings = 1000;

double smoothstep(double x) { return x >= 1 ? 1 : x * x * (3 - 2 * x); }

/// Returns for each vertex of a rim its place on a circle around the axis through `center`: at the angle of
/// its share of the length, with as little twist as possible.
std::vector<Vec3> circle_of(const Mesh& mesh, const std::vector<int>& rim, Vec3 center, Vec3 normal,
                            double radius) {
  const double pi = std::numbers::pi;
  const PlaneView flat({center, normal});
  const int n = (int)rim.size();
  std::vector<double> length(n + 1, 0);
  for (int i = 0; i < n; ++i)
    length[i + 1] = length[i] + norm(flat(mesh.points[rim[(i + 1) % n]]) - flat(mesh.points[rim[i]]));
  double area = 0;
  Vec2 mean;
  for (int i = 0; i < n; ++i) area += cross(flat(mesh.points[rim[i]]), flat(mesh.points[rim[(i + 1) % n]]));
  const double turn = area > 0 ? 1 : -1;
  for (int i = 0; i < n; ++i) {
    const Vec2 p = flat(mesh.points[rim[i]]);
    const double a = std::atan2(p.y, p.x) - turn * 2 * pi * length[i] / length[n];
    mean = mean + Vec2{std::cos(a), std::sin(a)};
  }
  const double start = std::atan2(mean.y, mean.x);
  std::vector<Vec3> circle;
  for (int i = 0; i < n; ++i) {
    const double a = start + turn * 2 * pi * length[i] / length[n];
    circle.push_back(center + radius * (std::cos(a) * flat.right + std::sin(a) * flat.up));
  }
  return circle;
}

/// Returns triangles of rim vertices over the projections of the rims, which must be simple.
std::vector<Tri> plane_triangles(const Mesh& mesh, const End& end) {
  const PlaneView flat({end.center, end.normal});
  std::vector<Vec2> points;
  std::vector<int> vertex;
  std::vector<FixedEdge> edges;
  for (const std::vector<int>& rim : end.rims) {
    const int first = (int)points.size(), n = (int)rim.size();
    for (int k = 0; k < n; ++k) {
      points.push_back(flat(mesh.points[rim[k]]));
      vertex.push_back(rim[k]);
      edges.push_back({first + k, first + (k + 1) % n, true});
    }
  }
  std::vector<Tri> tris = Cdt(points, edges).tris;
  for (Tri& t : tris)
    for (int& v : t) v = vertex[v];
  return tris;
}

}  // namespace

int extend_end(Mesh& mesh, End& end, double length, Growth& growth) {
  const std::size_t before = mesh.tris.size();
  const double transition = std::min(share_of_transition * length, longest_transition * end.radius);
  for (std::vector<int>& rim : end.rims) {
    const int n = (int)rim.size();
    const std::vector<Vec3> circle = circle_of(mesh, rim, end.center, end.normal, end_of(mesh, rim).radius);
    double edge = 0;
    for (int i = 0; i < n; ++i) edge += norm(mesh.points[rim[(i + 1) % n]] - mesh.points[rim[i]]) / n;
    const int rings = std::clamp((int)std::lround(length / edge), 2, most_rings);
    const std::vector<int> first = rim;
    for (int r = 1; r <= rings; ++r) {
      const double z = length * r / rings, share = smoothstep(z / transition);
      std::vector<int> ring;
      for (int i = 0; i < n; ++i) {
        ring.push_back((int)mesh.points.size());
        growth.vertex_like.push_back(first[i]);
        mesh.points.push_back(lerp(mesh.points[first[i]], circle[i], share) + z * end.normal);
      }
      for (int i = 0; i < n; ++i) {
        const int a = rim[i], b = rim[(i + 1) % n], c = ring[(i + 1) % n], d = ring[i];
        const bool other = norm(mesh.points[c] - mesh.points[a]) > norm(mesh.points[d] - mesh.points[b]);
        mesh.tris.push_back(other ? Tri{a, b, d} : Tri{a, b, c});
        mesh.tris.push_back(other ? Tri{b, c, d} : Tri{a, c, d});
      }
      rim = std::move(ring);
    }
  }
  return (int)(mesh.tris.size() - before);
}

int cap_end(Mesh& mesh, const End& end, bool least_area) {
  std::vector<Tri> tris;
  if (!least_area) {
    tris = plane_triangles(mesh, end);
  } else if (const std::size_t n = end.rims[0].size(); end.rims.size() == 1 && n <= most_corners) {
    std::vector<Vec3> corners;
    for (int v : end.rims[0]) corners.push_back(mesh.points[v]);
    for (const Tri& t : least_area_triangles(corners, std::vector<char>(n * n, 0)))
      tris.push_back({end.rims[0][t[0]], end.rims[0][t[1]], end.rims[0][t[2]]});
  }
  mesh.tris.insert(mesh.tris.end(), tris.begin(), tris.end());
  return (int)tris.size();
}

}  // namespace meshpipe
