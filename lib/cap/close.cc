// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numbers>
#include <numeric>

#include "lib/cap/steps.h"
#include "lib/core/cdt.h"
#include "lib/core/segments.h"

namespace meshpipe {
namespace {

/// Share of an extension in which the section becomes a circle; and radii that this takes at most.
constexpr double share_of_transition = 0.5, longest_transition = 2;
/// Rings of an extension at most.
constexpr int most_rings = 1000;
/// Radii that a stub is high at least; and rounds of smoothing of its border.
constexpr double least_stub = 0.25;
constexpr int smoothings = 10;

double smoothstep(double x) { return x >= 1 ? 1 : x * x * (3 - 2 * x); }

/// Points at equal distances along a rim, each with the vertex before it and its place on a circle.
struct Sections {
  std::vector<double> share;  ///< of the rim's length, of each of its vertices, and 1
  std::vector<Vec3> rim, circle;
  std::vector<int> before;
};

/// Divides a rim and the circle around the axis through `center`, with as little twist as possible. Edges of
/// the rim may be of very different length, those of its extension are not.
Sections sections_of(const Mesh& mesh, const std::vector<int>& rim, Vec3 center, Vec3 normal) {
  const double pi = std::numbers::pi;
  const PlaneView flat({center, normal});
  const int n = (int)rim.size();
  auto corner = [&](int i) { return mesh.points[rim[i % n]]; };
  Sections s;
  s.share.assign(n + 1, 0);
  double area = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    const double edge = norm(corner(i + 1) - corner(i));
    s.share[i + 1] = s.share[i] + edge;
    squares += edge * edge;
    area += 0.5 * cross(flat(corner(i)), flat(corner(i + 1)));
  }
  const double length = s.share[n], turn = (area > 0 ? 2 : -2) * pi, radius = std::sqrt(std::abs(area) / pi);
  for (double& share : s.share) share /= length;
  Vec2 mean;
  for (int i = 0; i < n; ++i) {
    const Vec2 p = flat(corner(i));
    const double a = std::atan2(p.y, p.x) - turn * s.share[i], weight = s.share[i + 1] - s.share[i];
    mean = mean + weight * Vec2{std::cos(a), std::sin(a)};
  }
  const double start = std::atan2(mean.y, mean.x);
  const int m = std::clamp((int)std::lround(length * length / squares), 6, std::max(6, n));
  for (int k = 0, i = 0; k < m; ++k) {
    const double share = (double)k / m, a = start + turn * share;
    while (s.share[i + 1] <= share) ++i;
    s.rim.push_back(lerp(corner(i), corner(i + 1), (share - s.share[i]) / (s.share[i + 1] - s.share[i])));
    s.circle.push_back(center + radius * (std::cos(a) * flat.right + std::sin(a) * flat.up));
    s.before.push_back(rim[i]);
  }
  return s;
}

/// Adds triangles between two rings, whose vertices are at shares of their lengths.
void join_rings(Mesh& mesh, const std::vector<int>& from, const std::vector<double>& share,
                const std::vector<int>& to) {
  const int n = (int)from.size(), m = (int)to.size();
  for (int i = 0, j = 0; i < n || j < m;) {
    const int a = from[i % n], d = to[j % m];
    // that of the next vertices which is nearer to the middle between the last ones
    if (j == m || (i < n && share[i] + share[i + 1] <= (2.0 * j + 1) / m))
      mesh.tris.push_back({a, from[++i % n], d});
    else
      mesh.tris.push_back({a, to[++j % m], d});
  }
}

/// Adds rings to a rim, the r-th with its vertices at place(k, r) for each of the sections. The last one is
/// the rim then.
template <class Place>
void add_rings(Mesh& mesh, std::vector<int>& rim, const Sections& s, int rings, Growth& growth, Place place) {
  const int m = (int)s.rim.size();
  std::vector<double> share = s.share;
  for (int r = 1; r <= rings; ++r) {
    std::vector<int> ring;
    for (int k = 0; k < m; ++k) {
      ring.push_back((int)mesh.points.size());
      growth.add_like(s.before[k]);
      mesh.points.push_back(place(k, r));
    }
    join_rings(mesh, rim, share, ring);
    share.resize(m + 1);
    for (int k = 0; k <= m; ++k) share[k] = (double)k / m;
    rim = std::move(ring);
  }
}

/// Averages the points of a ring with their neighbors, its area kept.
void smooth_ring(std::vector<Vec3>& ring) {
  const std::size_t n = ring.size();
  const Vec3 middle = (1.0 / n) * std::accumulate(ring.begin(), ring.end(), Vec3{});
  auto area = [&] {
    Vec3 sum;
    for (std::size_t k = 0; k < n; ++k) sum = sum + cross(ring[k] - middle, ring[(k + 1) % n] - middle);
    return norm(sum);
  };
  const double before = area();
  for (int round = 0; round < smoothings; ++round) {
    std::vector<Vec3> to;
    for (std::size_t k = 0; k < n; ++k)
      to.push_back(0.5 * ring[k] + 0.25 * (ring[(k + n - 1) % n] + ring[(k + 1) % n]));
    ring = std::move(to);
  }
  const double grow = std::sqrt(before / area());
  for (Vec3& p : ring) p = middle + grow * (p - middle);
}

int rings_of(double length, double edge) {
  return std::clamp((int)std::lround(length / edge), 2, most_rings);
}

/// Distance from an edge of a rim, in lengths of it, of the vertex inside the cap opposite the edge, and the
/// least one from anything else. Without such vertices a cap would have triangles as thin as the arc over a
/// few edges of the rim is high, which are features to be removed.
constexpr double height_of_apex = 0.866, least_distance = 0.5;

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
    growth.add_like(vertex[e.a]);
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
    const Sections s = sections_of(mesh, rim, end.center, end.normal);
    const int rings = rings_of(length, norm(s.circle[1] - s.circle[0]));
    add_rings(mesh, rim, s, rings, growth, [&](int k, int r) {
      const double z = length * r / rings;
      return lerp(s.rim[k], s.circle[k], smoothstep(z / transition)) + z * end.normal;
    });
  }
  return (int)(mesh.tris.size() - before);
}

void raise_end(Mesh& mesh, End& end, Growth& growth) {
  Plane plane{end.center, end.normal};
  double low = 0, high = 0;
  for (const std::vector<int>& rim : end.rims)
    for (int v : rim) {
      low = std::min(low, plane.height(mesh.points[v]));
      high = std::max(high, plane.height(mesh.points[v]));
    }
  high += least_stub * end.radius;
  plane.point = plane.point + high * plane.normal;
  for (std::vector<int>& rim : end.rims) {
    const Sections s = sections_of(mesh, rim, end.center, end.normal);
    std::vector<Vec3> last;
    for (Vec3 p : s.rim) last.push_back(p - plane.height(p) * plane.normal);
    smooth_ring(last);
    for (Vec3& p : last) p = p - plane.height(p) * plane.normal;  // against rounding
    const int rings = rings_of(high - low, norm(s.circle[1] - s.circle[0]));
    add_rings(mesh, rim, s, rings, growth, [&](int k, int r) {
      return r == rings ? last[k] : lerp(s.rim[k], last[k], (double)r / rings);
    });
  }
}

int projected_cap(Mesh& mesh, const End& end, Growth& growth) {
  const std::size_t before = mesh.tris.size();
  add_plane_triangles(mesh, end, growth);
  return (int)(mesh.tris.size() - before);
}

}  // namespace meshpipe
