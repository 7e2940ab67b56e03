// SPDX-License-Identifier: BSD-3-Clause
#include "lib/size/sheet_distance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lib/core/normals.h"
#include "lib/core/shortest_paths.h"
#include "lib/core/topology.h"
#include "lib/size/local_feature_size.h"

namespace meshpipe {
namespace {

constexpr double tilt[] = {20 * degree, 40 * degree};  ///< of the rays around that along the normal
constexpr int per_ring = 6;
constexpr int least_hits = 5;  ///< of 13 rays: with fewer nothing faces the point
/// Of the ball that counts, from the smallest. Where branches meet, most are too large: of vertices there 99
/// % are within 4 % of a branch's radius, and with the median within 8 %. Tubes gain up to 1 % by the median.
constexpr double rank = 0.25;
const double most_sheet_cosine =
    std::cos(120 * degree);  ///< largest cosine between the normals of sheets that face each other
/// Largest cosine between normals of parallel sheets. Others meet: where the ball between them is below
/// `least_slanted` of the longest edge or of the rim's radius, it lies in a fold that no single edge shows.
const double parallel = std::cos(150 * degree);
constexpr double least_slanted = 0.5;
const double smooth = std::cos(40 * degree);  ///< least cosine between normals of one smooth surface
constexpr int averaged = 4;        ///< rings for a normal: noise of a tenth of an edge tilts it by 2 degrees
constexpr double fold_angle = 75;  ///< degrees; a little above that of sheets that face each other
/// Of the distance from a fold, within an edge of it: smaller balls touch its other side.
constexpr double least_resolved = 0.8;
/// Of the radii by rays of one vertex, their third quartile over the first. With 1.02 all vertices where
/// tubes meet are within 6 % of one of them, with 1.03 some are 50 % off; noise leaves fewer vertices to fill
/// from.
constexpr double consensus = 1.02;
constexpr double branching = 1.5;  ///< radii from where rays agree: beyond them it is no branching of tubes
constexpr double largest_corner = 120, least_reflex = 220;  ///< degrees; noise bends less
/// Radii from what is measured, as far as there is an opening next to it: rays leave through it.
constexpr double opening = 2;
constexpr double lone = 0.5;   ///< of the least of the neighbors: a thin place has two vertices at least
constexpr int most_sides = 8;  ///< that are measured at one point of creases
constexpr double same_side = 0.999;  ///< cosine between normals
constexpr double on_surface = 1e-9;  ///< of the largest radius, which is the size of the model
constexpr double inset = 0.3;  ///< towards the triangle's center: vertices of creases are measured off them

/// Unit normals of the vertices, averaged over rings of vertices whose normals are alike.
std::vector<Vec3> averaged_normals(const Mesh& mesh) {
  std::vector<Vec3> normal = vertex_normals(mesh), to(normal.size());
  const Lists next = neighbors_of(mesh);
  for (int i = 0; i < averaged; ++i) {
#pragma omp parallel for schedule(static)
    for (int v = 0; v < (int)normal.size(); ++v) {
      Vec3 sum = normal[v];
      for (int w : next[v])
        if (const Vec3 n = normal[w]; dot(n, normal[v]) > smooth) sum = sum + 0.5 * n;
      to[v] = normalized(sum);
    }
    std::swap(normal, to);
  }
  return normal;
}

/// Returns the mesh with open components inverted so that they would enclose a positive volume, their loops
/// closed towards one of their vertices.
Mesh oriented_outward(const Connectivity& c) {
  Mesh mesh = c.mesh;
  std::vector<int> component;
  const int n = components(c.opposite, component);
  std::vector<double> volume(n, 0);
  std::vector<char> open(n, 0);
  auto add = [&](int t, Vec3 a, Vec3 b, Vec3 p) {
    const Vec3 middle = c.point(c.mesh.tris[0][0]);
    volume[component[t]] += dot(a - middle, cross(b - middle, p - middle));
  };
  for (int t = 0; t < c.n_tris(); ++t) {
    const auto& [i, j, k] = c.mesh.tris[t];
    add(t, c.point(i), c.point(j), c.point(k));
  }
  for (const auto& loop : boundary_loops(c.opposite)) {
    open[component[loop[0] / 3]] = 1;
    for (int h : loop) add(h / 3, c.point(c.to(h)), c.point(c.from(h)), c.point(c.from(loop[0])));
  }
  for (int t = 0; t < c.n_tris(); ++t)
    if (const int k = component[t]; open[k] && volume[k] < 0) std::swap(mesh.tris[t][1], mesh.tris[t][2]);
  return mesh;
}

/// Replaces the radii of the vertices flagged, layer by layer, by the mean of their neighbors' that are
/// known; `none` where there are none.
void fill(const Mesh& mesh, double none, std::vector<char> left, std::vector<double>& radius) {
  const Lists next = neighbors_of(mesh);
  std::vector<int> todo;
  for (int v = 0; v < (int)left.size(); ++v)
    if (left[v]) todo.push_back(v);
  for (std::vector<int> filled{0}; !filled.empty();) {  // layer by layer
    filled.clear();
    std::erase_if(todo, [&](int v) {
      double sum = 0;
      int n = 0;
      for (int u : next[v])
        if (!left[u] && radius[u] < none) sum += radius[u], ++n;
      if (n == 0) return false;
      radius[v] = sum / n;
      filled.push_back(v);
      return true;
    });
    for (int v : filled) left[v] = 0;
  }
  for (int v : todo) radius[v] = none;
}

}  // namespace

double angle_behind(const Connectivity& c, int h) {
  const Vec3 n = c.area_vector(h / 3), m = c.area_vector(c.opposite[h] / 3);
  const Vec3 along = normalized(c.point(c.to(h)) - c.point(c.from(h)));
  return 180 - std::atan2(dot(cross(n, m), along), dot(n, m)) / degree;
}

SheetDistance::SheetDistance(const Connectivity& surface, Side side, double none)
    : mesh_(oriented_outward(surface)),
      face_(face_normals(mesh_)),
      vertex_(averaged_normals(mesh_)),
      tree_(mesh_),
      side_(side),
      none_(none),
      radius_(mesh_.points.size(), none),
      creased_(mesh_.points.size(), 0),
      folded_(mesh_.points.size(), 0),
      sure_(mesh_.points.size(), 0),
      slanted_(mesh_.points.size(), 0) {
  measure();
  if (side_ == inside) close_openings(surface);
  leave_branchings(surface);
  leave_folds(surface);
}

Vec3 SheetDistance::normal_at(int face, double b1, double b2) const {
  const auto& [i, j, k] = mesh_.tris[face];
  for (int v : {i, j, k})
    if (creased_[v]) return face_[face];
  return normalized((1 - b1 - b2) * vertex_[i] + b1 * vertex_[j] + b2 * vertex_[k]);
}

SheetDistance::Ball SheetDistance::ball(Vec3 p, Vec3 normal) const {
  const int sign = side_ == inside ? 1 : -1;
  const Vec3 down = -sign * normal;
  const Vec3 x = normalized(std::abs(down.x) < 0.6 ? cross(down, {1, 0, 0}) : cross(down, {0, 1, 0}));
  const Vec3 y = cross(down, x);
  std::pair<double, double> found[1 + 2 * per_ring];  // radii, cosines between the normals
  int n = 0;
  auto look = [&](Vec3 d) {
    const Bvh::RayHit hit = tree_.first_hit(p, d, sign);
    if (hit.face < 0) return;
    const Vec3 m = normal_at(hit.face, hit.b1, hit.b2), across = normal - m;
    if (dot(normal, m) > most_sheet_cosine) return;
    // a ball of radius r around c touches both: p = c + r normal, p + distance d = c + r m; in the mean
    const double r = -sign * hit.distance * dot(d, across) / dot(across, across);
    if (r > 0) found[n++] = {r, dot(normal, m)};
  };
  look(down);
  for (double t : tilt)
    for (int i = 0; i < per_ring; ++i) {
      const double turn = 2 * std::numbers::pi * (i + (t == tilt[0] ? 0 : 0.5)) / per_ring;
      look(std::cos(t) * down + std::sin(t) * (std::cos(turn) * x + std::sin(turn) * y));
    }
  if (n < least_hits) return {none_};
  auto nth = [&](double share) {
    const auto at = found + (int)(share * (n - 1));
    std::nth_element(found, at, found + n);
    return *at;
  };
  const auto [radius, cosine] = nth(rank);
  const bool agree = n > per_ring && nth(1 - rank).first < consensus * radius;
  const bool slanted = cosine > parallel;
  return {std::min(radius, none_), agree, slanted};
}

SheetDistance::Ball SheetDistance::ball_on_face(int t, Vec3 p) const {
  return ball(lerp(p, centroid(mesh_, t), inset), face_[t]);
}

double SheetDistance::radius_at(Vec3 p) const {
  const Place place = tree_.nearest(p).place;
  const auto& [i, j, k] = mesh_.tris[place.face];
  if (folded_[i] || folded_[j] || folded_[k]) return value_at(place, radius_, mesh_.tris);
  double longest = 0;
  for (int h = 3 * place.face; h < 3 * place.face + 3; ++h)
    longest = std::max(longest, edge_length(mesh_, h));
  const auto [least, most] = std::minmax({radius_[i], radius_[j], radius_[k]});
  const Vec3 n = normal_at(place.face, place.b1, place.b2);
  const double there = n == face_[place.face] ? ball_on_sides(place.face, p) : ball(p, n).radius;
  return std::clamp(there, lone * (least - longest), (most + longest) / lone);
}

double SheetDistance::ball_on_sides(int face, Vec3 p) const {
  Vec3 done[most_sides] = {face_[face]};
  int sides = 1;
  double least = ball_on_face(face, p).radius;
  const Vec3 r = on_surface * none_ * Vec3{1, 1, 1};
  tree_.overlapping({p - r, p + r}, [&](int t) {
    if (norm(closest_point(mesh_, t, p) - p) > r.x || sides == most_sides) return;
    for (int s = 0; s < sides; ++s)
      if (dot(done[s], face_[t]) > same_side) return;
    done[sides++] = face_[t];
    least = std::min(least, ball_on_face(t, p).radius);
  });
  return least;
}

void SheetDistance::measure() {
  const int n = (int)mesh_.points.size(), n_tris = (int)mesh_.tris.size();
  std::vector<Ball> at_corner(3 * static_cast<std::size_t>(n_tris), Ball{-1});
  for (int h = 0; h < 3 * n_tris; ++h)
    if (const int v = origin(mesh_.tris, h);
        norm(face_[h / 3]) > 0 && !(dot(face_[h / 3], vertex_[v]) > smooth))
      creased_[v] = 1;
#pragma omp parallel for schedule(dynamic, 64)
  for (int t = 0; t < n_tris; ++t)
    for (int i = 0; i < 3; ++i)
      if (const int v = mesh_.tris[t][i]; creased_[v] && norm(face_[t]) > 0)
        at_corner[3 * t + i] = ball_on_face(t, mesh_.points[v]);
  for (int h = 0; h < 3 * n_tris; ++h)
    if (const int v = origin(mesh_.tris, h); at_corner[h].radius >= 0 && at_corner[h].radius < radius_[v]) {
      radius_[v] = at_corner[h].radius;
      slanted_[v] = at_corner[h].slanted;
    }
#pragma omp parallel for schedule(dynamic, 64)
  for (int v = 0; v < n; ++v)
    if (!creased_[v] && norm(vertex_[v]) > 0) {
      const Ball there = ball(mesh_.points[v], vertex_[v]);
      radius_[v] = there.radius;
      sure_[v] = there.sure;
    }
}

/// In components with open ends, gives vertices at which rays find nothing the radius of the nearest that has
/// one, up to `opening` radii away: rays leave through the opening.
void SheetDistance::close_openings(const Connectivity& c) {
  std::vector<int> component;
  std::vector<char> open(components(c.opposite, component), 0);
  for (int h = 0; h < c.n_half_edges(); ++h)
    if (c.is_border(h)) open[component[h / 3]] = 1;
  const Lists next = neighbors_of(mesh_);
  std::vector<double> way(c.n_vertices(), infinity);  // in radii
  std::vector<int> sources;
  for (int h = 0; h < c.n_half_edges(); ++h)
    if (const int v = c.from(h); open[component[h / 3]] && radius_[v] < none_ && way[v] > 0)
      way[v] = 0, sources.push_back(v);
  shortest_paths(sources, way, [&](int v, auto reach) {
    if (way[v] > opening) return false;
    for (int u : next[v])
      if (reach(u, way[v] + norm(mesh_.points[u] - mesh_.points[v]) / radius_[v])) {
        radius_[u] = radius_[v];
        folded_[u] = 1;
      }
    return true;
  });
}

/// Where branches meet, rays find other ones, or none: vertices whose rays disagree get what those around
/// them have, as far as a tube is wide.
void SheetDistance::leave_branchings(const Connectivity& c) {
  // branches meet at edges that are reflex, bodies have corners between others
  std::vector<char> corner(c.n_vertices(), 0), reflex(c.n_vertices(), 0);
  for (int h = 0; h < c.n_half_edges(); ++h) {
    if (c.is_border(h) || !creased_[c.from(h)]) continue;
    const double angle = angle_on_side(c, h);
    if (angle < largest_corner) corner[c.from(h)] = 1;
    if (angle > least_reflex) reflex[c.from(h)] = 1;
  }
  const Lists next = neighbors_of(mesh_);
  const int n = (int)radius_.size();
  std::vector<double> way(n, infinity);  // in radii
  std::vector<int> sources;
  for (int v = 0; v < n; ++v)
    if (sure_[v]) way[v] = 0, sources.push_back(v);
  std::vector<char> left(n, 0);
  std::vector<double> radius = radius_;
  shortest_paths(sources, way, [&](int v, auto reach) {
    if (way[v] > branching) return false;
    left[v] = way[v] > 0 && (!corner[v] || reflex[v]);
    for (int u : next[v])
      if (reach(u, way[v] + norm(mesh_.points[u] - mesh_.points[v]) / radius[v])) radius[u] = radius[v];
    return true;
  });
  for (int v = 0; v < n; ++v) folded_[v] |= left[v];
  fill(mesh_, none_, std::move(left), radius_);
}

double SheetDistance::angle_on_side(const Connectivity& c, int h) const {
  const bool inverted = c.mesh.tris[h / 3] != mesh_.tris[h / 3];
  const double behind = angle_behind(c, h);
  return (side_ == inside) != inverted ? behind : 360 - behind;
}

/// Flags the vertices within `reach` of a fold (its longest edge, or the radius of its rim) at which the ball
/// touches the other side of the fold.
void SheetDistance::leave_sides(const Connectivity& c, const std::vector<char>& fold,
                                std::vector<double> reach) {
  std::vector<double> way(c.n_vertices(), infinity);
  std::vector<int> sources;
  for (int v = 0; v < c.n_vertices(); ++v)
    if (fold[v]) way[v] = 0, sources.push_back(v);
  const Lists next = neighbors_of(mesh_);
  shortest_paths(sources, way, [&](int v, auto lower) {
    if (radius_[v] < least_resolved * way[v]) folded_[v] = 1;
    for (int u : next[v]) {
      const double d = way[v] + norm(mesh_.points[u] - mesh_.points[v]);
      if (d <= reach[v] && lower(u, d)) reach[u] = reach[v];
    }
  });
}

/// Replaces the radii on folds, and those next to them that leave_sides flags, by the mean of the neighbors
/// farther away, or by the largest balls on the triangles where there are none.
void SheetDistance::leave_folds(const Connectivity& c) {
  std::vector<char> fold(c.n_vertices(), 0);
  for (int h = 0; h < c.n_half_edges(); ++h) {
    if (c.is_border(h)) continue;
    if (angle_on_side(c, h) < fold_angle) fold[c.from(h)] = fold[c.to(h)] = 1;
  }
  std::vector<double> longest(c.n_vertices(), 0);
  for (int h = 0; h < c.n_half_edges(); ++h)
    for (int v : {c.from(h), c.to(h)}) longest[v] = std::max(longest[v], c.length(h));
  const std::vector<double> around = closed_line_lengths(c);  // of rims, which are finer than what they end
  for (int v = 0; v < c.n_vertices(); ++v) {
    if (around[v] < none_) longest[v] = std::max(longest[v], around[v] / (2 * std::numbers::pi));
    fold[v] |= creased_[v] && slanted_[v] && radius_[v] < least_slanted * longest[v];
    folded_[v] |= fold[v];
  }
  leave_sides(c, fold, longest);
  fill(mesh_, none_, folded_, radius_);
  const std::vector<double> filled = radius_;
  for (int h = 0; h < c.n_half_edges(); ++h) {  // tubes of three sides are all folds
    const int v = c.from(h), t = h / 3;
    if (!folded_[v] || filled[v] < none_) continue;
    for (int corner : mesh_.tris[t]) {  // almost at the middles of edges: largest balls of the section
      const double r = ball(lerp(centroid(mesh_, t), mesh_.points[corner], -0.45), face_[t]).radius;
      if (r < none_) radius_[v] = radius_[v] < none_ ? std::max(radius_[v], r) : r;
    }
  }
  const Lists next = neighbors_of(mesh_);
  // what a single vertex has alone is a fault there
  const std::vector<double> before = radius_;
  for (int v = 0; v < c.n_vertices(); ++v) {
    double least = none_;
    for (int w : next[v]) least = std::min(least, before[w]);
    if (before[v] >= lone * least) continue;
    radius_[v] = least;
    folded_[v] = 1;
  }
}

}  // namespace meshpipe
