// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numbers>

#include "lib/cap/steps.h"
#include "lib/core/cdt.h"

namespace meshpipe {
namespace {

/// Share of an extension in which the section becomes a circle; and radii that this takes at most.
constexpr double share_of_transition = 0.5, longest_transition = 2;
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

/// Distance from an edge of a rim, in lengths of it, of the vertex inside the cap opposite the edge, and the
/// least one from anything else. Without such vertices a cap would have triangles as thin as the arc over a
/// few edges of the rim is high, which are features to be removed.
constexpr double height_of_apex = 0.866, least_distance = 0.5;

double distance_to_segment(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 along = b - a;
  return norm(p - lerp(a, b, std::clamp(dot(p - a, along) / dot(along, along), 0.0, 1.0)));
}

/// Inserts a vertex opposite a border edge if there is enough space. Returns it, or -1.
int add_apex(Cdt& cdt, Cavity& cavity, int a, int b) {
  const Vec2 pa = cdt.points[a], pb = cdt.points[b], along = pb - pa;
  const double length = norm(along), least = least_distance * length;
  const Vec2 p = lerp(pa, pb, 0.5) + height_of_apex * Vec2{-along.y, along.x};
  const int h = cdt.half_edge(a, b);
  const int t = h < 0 ? -1 : cdt.walk(p, h / 3);
  auto conflict = [&](int s) {
    const Tri& v = cdt.tris[s];
    return incircle(cdt.points[v[0]], cdt.points[v[1]], cdt.points[v[2]], p) > 0;
  };
  if (t < 0 || !cavity.grow(cdt, p, t, conflict)) return -1;
  for (int g : cavity.rim()) {
    const Vec2 from = cdt.points[cdt.origin(g)], to = cdt.points[cdt.target(g)];
    if (norm(p - from) < least || (cdt.fixed[g] && distance_to_segment(p, from, to) < least)) return -1;
  }
  return cavity.fill(cdt, p);
}

/// Adds triangles over the projections of the rims, which must be simple.
void add_plane_triangles(Mesh& mesh, const End& end, Growth& growth) {
  const Plane plane{end.center, end.normal};
  const PlaneView flat(plane);
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
  Cdt cdt(points, edges);
  Cavity cavity;
  for (const FixedEdge& e : edges) {
    const int v = add_apex(cdt, cavity, e.a, e.b);
    if (v < 0) continue;
    const Vec3 a = mesh.points[vertex[e.a]], b = mesh.points[vertex[e.b]];
    const Vec2 p = cdt.points[v];
    vertex.push_back((int)mesh.points.size());
    growth.vertex_like.push_back(vertex[e.a]);
    mesh.points.push_back(flat.origin + p.x * flat.right + p.y * flat.up +
                          0.5 * (plane.height(a) + plane.height(b)) * plane.normal);
  }
  for (const Tri& t : cdt.tris) mesh.tris.push_back({vertex[t[0]], vertex[t[1]], vertex[t[2]]});
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

int plane_cap(Mesh& mesh, const End& end, Growth& growth) {
  const std::size_t before = mesh.tris.size();
  add_plane_triangles(mesh, end, growth);
  return (int)(mesh.tris.size() - before);
}

}  // namespace meshpipe
