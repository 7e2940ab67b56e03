// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "lib/core/connectivity.h"
#include "lib/core/intersect.h"
#include "lib/core/lists.h"
#include "lib/core/original_triangles.h"
#include "lib/core/topology.h"
#include "lib/feature/feature.h"
#include "lib/lift/lift.h"

namespace meshpipe {
namespace {

constexpr double steepest_chord = 30 * degree;  ///< between a curve and its chord
constexpr double smooth_turn = 45 * degree;     ///< of a line at a vertex where it is a curve
constexpr double flat = 0.5 * degree;           ///< between normals of one flat piece
constexpr double much_larger = 4;  ///< ratio from which on a flat piece or straight edge is by design

/// Returns the inner control point next to the start of a cubic that leaves along `direction`, less a third
/// of the chord: that of a circle's arc, to sixth order in its angle (Goldapp 1991).
Vec3 control_off(Vec3 chord, Vec3 direction) {
  const double length = norm(chord);
  if (!(length > 0)) return {};
  const Vec3 along = (1 / length) * chord;
  Vec3 t = normalized(direction);
  double c = dot(t, along);
  const Vec3 aside = normalized(t - c * along);
  if (!(norm(aside) > 0)) return {};
  if (c < std::cos(steepest_chord)) {
    c = std::cos(steepest_chord);
    t = c * along + std::sin(steepest_chord) * aside;
  }
  return 2 * length / (3 * (1 + c)) * t - 1.0 / 3 * chord;
}

/// Averages normals over fans around vertices that feature edges bound; corner h is that of half-edge h's
/// origin.
class Corners {
 public:
  Corners(const Connectivity& mesh, const std::vector<char>& feature)
      : mesh_(mesh.mesh), beyond_(mesh.opposite) {
    for (std::size_t h = 0; h < beyond_.size(); ++h)
      if (feature[h]) beyond_[h] = -1;
  }

  /// Returns the surface's unit normal at every corner, the same within a fan.
  std::vector<Vec3> normals(const std::vector<Vec3>& of_triangle) const {
    std::vector<Vec3> normal(beyond_.size());
    std::vector<char> done(beyond_.size(), 0);
    std::vector<int> fan;
    for (int h = 0; h < (int)beyond_.size(); ++h) {
      if (done[h]) continue;
      fan.clear();
      for_each_spoke(beyond_, h, [&](int c) { done[c] = 1, fan.push_back(c); });
      const Vec3 n = mean(fan, of_triangle);
      for (int c : fan) normal[c] = n;
    }
    return normal;
  }

 private:
  Vec3 mean(const std::vector<int>& fan, const std::vector<Vec3>& of_triangle) const {
    auto edges = [&](int c) {
      const Vec3 p = mesh_.points[origin(mesh_.tris, c)];
      return std::array{mesh_.points[target(mesh_.tris, c)] - p,
                        mesh_.points[origin(mesh_.tris, prev(c))] - p};
    };
    auto area = [&](int c) {
      const auto [a, b] = edges(c);
      return norm(cross(a, b));
    };
    // a flat piece that is much larger than the rest was not rounded off: a fillet ends at it
    int largest = fan[0];
    double all = 0, piece = 0;
    for (int c : fan) {
      all += area(c);
      if (area(c) > area(largest)) largest = c;
    }
    auto in_piece = [&](int c) { return angle(of_triangle[c / 3], of_triangle[largest / 3]) < flat; };
    for (int c : fan)
      if (in_piece(c)) piece += area(c);
    const bool only_piece = piece > much_larger * (all - piece);
    // the weights that are exact on a sphere
    Vec3 sum{};
    for (int c : fan) {
      const auto [a, b] = edges(c);
      const double aa = dot(a, a), bb = dot(b, b);
      if (aa > 0 && bb > 0 && (!only_piece || in_piece(c)))
        sum = sum + norm(cross(a, b)) / (aa * bb) * of_triangle[c / 3];
    }
    return normalized(sum);
  }

  const Mesh& mesh_;
  std::vector<int> beyond_;  ///< the opposite half-edge, -1 at feature edges
};

/// The feature edges that meet at each vertex: a curve may pass where there are two.
class FeatureCurves {
 public:
  FeatureCurves(const Connectivity& mesh, const std::vector<char>& feature)
      : points_(mesh.mesh.points), count_(mesh.n_vertices(), 0), neighbor_(mesh.n_vertices()) {
    for (int h = 0; h < mesh.n_half_edges(); ++h) {
      if (!feature[h] || mesh.opposite[h] > h) continue;
      add(mesh.from(h), mesh.to(h));
      add(mesh.to(h), mesh.from(h));
    }
  }

  /// Returns the direction in which the curve along the edge to a neighbor leaves v; zero if none passes v.
  Vec3 direction(int v, int to) const {
    if (count_[v] != 2) return {};
    const int from = neighbor_[v][neighbor_[v][0] == to];
    const Vec3 back = points_[v] - points_[from], ahead = points_[to] - points_[v];
    const double l0 = norm(back), l1 = norm(ahead);
    if (angle(back, ahead) > smooth_turn || !(l0 > 0 && l1 > 0)) return {};
    if (l0 > much_larger * l1) return back;  // a straight piece that an arc ends at
    if (l1 > much_larger * l0) return ahead;
    return l1 / l0 * back + l0 / l1 * ahead;  // of the circle through the three points
  }

 private:
  void add(int v, int other) {
    if (count_[v] < 2) neighbor_[v][count_[v]] = other;
    if (count_[v] < 3) ++count_[v];
  }

  const std::vector<Vec3>& points_;
  std::vector<char> count_;  ///< up to 3
  std::vector<std::array<int, 2>> neighbor_;
};

/// Marks the feature edges of the surface that a reference was cut from: borders, and edges that begin with a
/// model edge where they leave their first corner.
std::vector<char> feature_edges(const Surface& reference, const Connectivity& whole,
                                const std::vector<int>& below) {
  std::vector<char> feature(whole.n_half_edges(), 0);
  for (int h = 0; h < whole.n_half_edges(); ++h) feature[h] = whole.is_border(h);
  if (!reference.face.has("model")) return feature;
  const std::vector<int> opposite = opposite_halfedges(reference);
  const Connectivity cut{reference, opposite, reference.face.get<std::uint8_t>("model")};
  for (int g = 0; g < cut.n_half_edges(); ++g) {
    if (!cut.is_model(g)) continue;
    const int t = below[g / 3];
    if (!cut.is_border(g) && below[opposite[g] / 3] == t) continue;  // within the triangle
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      if (whole.from(h) != cut.from(g)) continue;
      feature[h] = 1;
      if (!whole.is_border(h)) feature[whole.opposite[h]] = 1;
    }
  }
  return feature;
}

}  // namespace

CurvedSurface::CurvedSurface(const Surface& reference) : reference_(reference) {
  if (reference.face.has("origin")) {
    whole_ = recover_triangles(reference, reference.face.get<int>("origin"), &below_);
  } else {
    whole_ = reference;
    below_ = identity(reference.tris.size());
  }
  const std::vector<int> opposite = opposite_halfedges(whole_);
  const Connectivity whole{whole_, opposite};
  const std::vector<char> feature = feature_edges(reference, whole, below_);
  const std::vector<Vec3> normal = Corners(whole, feature).normals(side_normals(whole, 0));
  const FeatureCurves curves(whole, feature);
  off_.resize(opposite.size());
  for (int h = 0; h < (int)opposite.size(); ++h) {
    const int a = origin(whole_.tris, h), b = target(whole_.tris, h);
    const Vec3 chord = whole_.points[b] - whole_.points[a];
    Vec3 from_a, from_b;
    if (feature[h]) {
      from_a = curves.direction(a, b), from_b = curves.direction(b, a);
      // an arc's last piece is bent as its other end is
      auto mirrored = [&](Vec3 t) { return t - 2 * dot(t, chord) / dot(chord, chord) * chord; };
      if (norm(from_a) > 0 && norm(from_b) == 0)
        from_b = mirrored(from_a);
      else if (norm(from_b) > 0 && norm(from_a) == 0)
        from_a = mirrored(from_b);
    } else {
      const Vec3 n = normal[h], m = normal[next(h)];
      from_a = chord - dot(chord, n) * n;
      from_b = dot(chord, m) * m - chord;
    }
    off_[h] = {control_off(chord, from_a), control_off(-1 * chord, from_b)};
  }
}

Vec3 CurvedSurface::point(const Place& place) const {
  const std::vector<Vec3>& p = reference_.points;
  const Vec3 x = value_at(place, p, reference_.tris);
  const int t = below_[place.face];
  const Tri& v = whole_.tris[t];
  double b[3] = {place.b0, place.b1, place.b2};
  if (v != reference_.tris[place.face]) {
    const Vec3 n = area_vector(p[v[0]], p[v[1]], p[v[2]]);
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      sum += b[i] = std::max(0.0, dot(area_vector(x, p[v[(i + 1) % 3]], p[v[(i + 2) % 3]]), n));
    if (!(sum > 0)) return x;
    for (double& c : b) c /= sum;
  }
  Vec3 off{}, mean{};
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const auto& [near_i, near_j] = off_[3 * t + i];
    mean = mean + 1.0 / 6 * (near_i + near_j);
    off = off + 3 * b[i] * b[j] * (b[i] * near_i + b[j] * near_j);
  }
  return x + off + 6 * b[0] * b[1] * b[2] * 1.5 * mean;
}

int raise_vertices(LiftedMesh& mesh, const CurvedSurface& surface) {
  const std::vector<Vec3> before = mesh.points;
  for (std::size_t v = 0; v < before.size(); ++v) mesh.points[v] = surface.point(mesh.place[v]);
  std::vector<char> stays(before.size(), 0);
  for (bool lowered = true; lowered;) {
    lowered = false;
    for (auto [s, t] : self_intersections(mesh))
      for (int u : {s, t})
        for (int v : mesh.tris[u]) {
          if (stays[v]) continue;
          stays[v] = 1;
          mesh.points[v] = before[v];
          lowered = true;
        }
  }
  return (int)std::count(stays.begin(), stays.end(), 1);
}

}  // namespace meshpipe
