// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/intersect.h"

#include <algorithm>
#include <span>

#include "lib/core/bvh.h"
#include "lib/core/connectivity.h"
#include "lib/core/predicates.h"
#include "lib/core/weld.h"

namespace meshpipe {
namespace {

struct Corners {
  Vec3 a, b, c;
};

Corners corners(const Mesh& mesh, int t) {
  const Tri& v = mesh.tris[t];
  return {mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]]};
}

/// The plane's view along coordinate axis `axis`: exact, since it only leaves a coordinate out.
Vec2 drop(Vec3 p, int axis) {
  return axis == 0 ? Vec2{p.y, p.z} : axis == 1 ? Vec2{p.z, p.x} : Vec2{p.x, p.y};
}

/// A coordinate that can be left out such that the triangle keeps its area; -1 if it has none.
int view_axis(const Corners& t) {
  const Vec3 n = area_vector(t.a, t.b, t.c);
  const double size[3] = {std::abs(n.x), std::abs(n.y), std::abs(n.z)};
  int axis[3] = {0, 1, 2};
  std::stable_sort(axis, axis + 3, [&](int i, int j) { return size[i] > size[j]; });
  // the largest by rounded arithmetic may be flat by exact arithmetic
  for (int k : axis)
    if (orient2d(drop(t.a, k), drop(t.b, k), drop(t.c, k)) != 0) return k;
  return -1;
}

/// Is all of q strictly right of an edge of the convex polygon p (counterclockwise; a segment is a polygon of
/// two edges)?
bool edge_separates(std::span<const Vec2> p, std::span<const Vec2> q) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec2 a = p[i], b = p[(i + 1) % p.size()];
    if (std::all_of(q.begin(), q.end(), [&](Vec2 x) { return orient2d(a, b, x) < 0; })) return true;
  }
  return false;
}

/// Two convex sets in the plane, one of them with area, are apart only if an edge of either separates them:
/// the edges of their Minkowski difference are parallel to theirs.
bool polygons_meet(std::span<const Vec2> p, std::span<const Vec2> q) {
  return !edge_separates(p, q) && !edge_separates(q, p);
}

std::array<Vec2, 3> flat(const Corners& t, int axis) {
  std::array<Vec2, 3> r{drop(t.a, axis), drop(t.b, axis), drop(t.c, axis)};
  if (orient2d(r[0], r[1], r[2]) < 0) std::swap(r[1], r[2]);
  return r;
}

/// Segment pq against a triangle with area, when the sides of p and q of its plane are known.
bool segment_meets(Vec3 p, Vec3 q, int side_p, int side_q, const Corners& t) {
  if (side_p * side_q > 0) return false;
  if (side_p == 0 && side_q == 0) {
    const int axis = view_axis(t);
    const Vec2 pq[2] = {drop(p, axis), drop(q, axis)};
    return polygons_meet(flat(t, axis), pq);
  }
  const int x = orient3d(p, q, t.a, t.b), y = orient3d(p, q, t.b, t.c);
  if (x * y < 0) return false;
  const int z = orient3d(p, q, t.c, t.a);
  return x * z >= 0 && y * z >= 0;
}

bool boxes_apart(Vec3 p, Vec3 q, const Corners& t) {
  auto apart = [](double p, double q, double a, double b, double c) {
    return std::max(p, q) < std::min({a, b, c}) || std::min(p, q) > std::max({a, b, c});
  };
  return apart(p.x, q.x, t.a.x, t.b.x, t.c.x) || apart(p.y, q.y, t.a.y, t.b.y, t.c.y) ||
         apart(p.z, q.z, t.a.z, t.b.z, t.c.z);
}

bool segment_meets(Vec3 p, Vec3 q, const Corners& t) {
  if (boxes_apart(p, q, t)) return false;
  const int side_p = orient3d(t.a, t.b, t.c, p), side_q = orient3d(t.a, t.b, t.c, q);
  return segment_meets(p, q, side_p, side_q, t);
}

bool disjoint_triangles_meet(const Corners& s, const Corners& t) {
  const int s0 = orient3d(t.a, t.b, t.c, s.a), s1 = orient3d(t.a, t.b, t.c, s.b),
            s2 = orient3d(t.a, t.b, t.c, s.c);
  if ((s0 > 0 && s1 > 0 && s2 > 0) || (s0 < 0 && s1 < 0 && s2 < 0)) return false;
  if (s0 == 0 && s1 == 0 && s2 == 0) {
    const int axis = view_axis(t);
    return polygons_meet(flat(s, axis), flat(t, axis));
  }
  const int t0 = orient3d(s.a, s.b, s.c, t.a), t1 = orient3d(s.a, s.b, s.c, t.b),
            t2 = orient3d(s.a, s.b, s.c, t.c);
  if ((t0 > 0 && t1 > 0 && t2 > 0) || (t0 < 0 && t1 < 0 && t2 < 0)) return false;
  // triangles that are not coplanar meet in a segment (or a point), each end of which is on an edge of one of
  // them
  return segment_meets(s.a, s.b, s0, s1, t) || segment_meets(s.b, s.c, s1, s2, t) ||
         segment_meets(s.c, s.a, s2, s0, t) || segment_meets(t.a, t.b, t0, t1, s) ||
         segment_meets(t.b, t.c, t1, t2, s) || segment_meets(t.c, t.a, t2, t0, s);
}

/// What is left of a polygon on the side of a plane to which the normal points (Sutherland and Hodgman,
/// 1974).
void cut_off(std::vector<Vec3>& polygon, Vec3 on_plane, Vec3 normal) {
  std::vector<Vec3> kept;
  for (std::size_t j = 0; j < polygon.size(); ++j) {
    const Vec3 p = polygon[j], q = polygon[(j + 1) % polygon.size()];
    const double d = dot(p - on_plane, normal), e = dot(q - on_plane, normal);
    if (d >= 0) kept.push_back(p);
    if ((d > 0 && e < 0) || (d < 0 && e > 0)) kept.push_back(lerp(p, q, d / (d - e)));
  }
  polygon = std::move(kept);
}

/// Twice the area of a plane polygon.
double area_of(const std::vector<Vec3>& polygon) {
  Vec3 sum;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    sum = sum + area_vector(polygon[0], polygon[i - 1], polygon[i]);
  return norm(sum);
}

/// What triangle s has above and below t, the polygon that they share if they are in one plane.
std::vector<Vec3> overlap_of(const Corners& s, const Corners& t) {
  std::vector<Vec3> polygon{s.a, s.b, s.c};
  const Vec3 n = area_vector(t.a, t.b, t.c);
  cut_off(polygon, t.a, cross(n, t.b - t.a));
  cut_off(polygon, t.b, cross(n, t.c - t.b));
  cut_off(polygon, t.c, cross(n, t.a - t.c));
  return polygon;
}

/// Where triangle s lies on t: what it has above and below t, if half of that is no farther than `near` (so
/// not next to a sharp edge); nothing if they are not parallel, or only side by side.
std::vector<Vec3> coincidence(const Corners& s, const Corners& t, double near) {
  constexpr double parallel = 0.99, sliver = 1e-6;  // cosine; of the smaller triangle's area
  const Vec3 m = area_vector(s.a, s.b, s.c), n = area_vector(t.a, t.b, t.c), up = normalized(n);
  if (!(std::abs(dot(m, up)) > parallel * norm(m))) return {};
  auto beyond = [&](Vec3 on_plane, Vec3 normal) {
    return std::max(
               {dot(s.a - on_plane, normal), dot(s.b - on_plane, normal), dot(s.c - on_plane, normal)}) <= 0;
  };
  if (beyond(t.a - near * up, up) || beyond(t.a + near * up, -1.0 * up) || beyond(t.a, cross(n, t.b - t.a)) ||
      beyond(t.b, cross(n, t.c - t.b)) || beyond(t.c, cross(n, t.a - t.c)))
    return {};
  std::vector<Vec3> polygon = overlap_of(s, t);
  const double all = area_of(polygon);
  cut_off(polygon, t.a - near * up, up);
  cut_off(polygon, t.a + near * up, -1.0 * up);
  const double area = area_of(polygon);
  const bool lies_on_it = area > 0.5 * all && area > sliver * std::min(norm(m), norm(n));
  return lies_on_it ? polygon : std::vector<Vec3>{};
}

bool coplanar(const Corners& s, const Corners& t) {
  return orient3d(s.a, s.b, s.c, t.a) == 0 && orient3d(s.a, s.b, s.c, t.b) == 0 &&
         orient3d(s.a, s.b, s.c, t.c) == 0;
}

/// The polygon or the ends of the segment that two triangles share, or a point near it.
std::vector<Vec3> contact(const Mesh& mesh, int s, int t) {
  std::vector<Vec3> found;
  if (coplanar(corners(mesh, s), corners(mesh, t))) {
    found = overlap_of(corners(mesh, s), corners(mesh, t));
    if (!found.empty()) return found;
  }
  for (auto [f, g] : {std::pair{corners(mesh, s), corners(mesh, t)}, {corners(mesh, t), corners(mesh, s)}}) {
    const Vec3 n = normalized(area_vector(g.a, g.b, g.c)), p[4] = {f.a, f.b, f.c, f.a};
    for (int i = 0; i < 3; ++i) {
      const double d0 = dot(p[i] - g.a, n), d1 = dot(p[i + 1] - g.a, n), longest = norm(p[i + 1] - p[i]);
      if (d0 * d1 > 0 || d0 == d1) continue;
      const Vec3 x = lerp(p[i], p[i + 1], d0 / (d0 - d1));
      const auto b = closest_on_triangle(x, g.a, g.b, g.c);
      if (norm(vector_to(b, g.a, g.b, g.c, x)) <= 1e-6 * longest) found.push_back(x);
    }
  }
  if (found.empty()) {
    const Box a = box_of(mesh, s), b = box_of(mesh, t);
    found.push_back(lerp(upper(a.lo, b.lo), lower(a.hi, b.hi), 0.5));
  }
  std::pair<Vec3, Vec3> ends{found[0], found[0]};
  for (Vec3 x : found)
    for (Vec3 y : found)
      if (norm(y - x) > norm(ends.second - ends.first)) ends = {x, y};
  return {ends.first, ends.second};
}

/// Adds a polygon, or a segment by its ends, as triangles.
void add_place(const std::vector<Vec3>& ring, Mesh& places) {
  const int first = (int)places.points.size(), n = (int)ring.size();
  places.points.insert(places.points.end(), ring.begin(), ring.end());
  if (n < 3) places.tris.push_back({first, first + n - 1, first + n - 1});
  for (int i = 2; i < n; ++i) places.tris.push_back({first, first + i - 1, first + i});
}

}  // namespace

bool triangles_intersect(const Mesh& mesh, int s, int t) {
  const Tri &a = mesh.tris[s], &b = mesh.tris[t];
  int in_a[3], in_b[3], shared = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (a[i] == b[j] && shared < 3) {
        in_a[shared] = i;
        in_b[shared++] = j;
      }
  if (shared == 3) return true;
  // a corner twice: no triangle, which soundness reports
  if (shared == 2 && (in_a[0] == in_a[1] || in_b[0] == in_b[1])) return false;
  if (shared == 0) return disjoint_triangles_meet(corners(mesh, s), corners(mesh, t));
  const auto& p = mesh.points;
  if (shared == 1) {
    const int i = in_a[0], j = in_b[0];
    return segment_meets(p[a[(i + 1) % 3]], p[a[(i + 2) % 3]], corners(mesh, t)) ||
           segment_meets(p[b[(j + 1) % 3]], p[b[(j + 2) % 3]], corners(mesh, s));
  }
  const Vec3 &u = p[a[in_a[0]]], &v = p[a[in_a[1]]];
  const Vec3 &w = p[a[3 - in_a[0] - in_a[1]]], &x = p[b[3 - in_b[0] - in_b[1]]];
  if (orient3d(u, v, w, x) != 0) return false;
  const int axis = view_axis({u, v, w});
  if (axis < 0) return false;
  const Vec2 from = drop(u, axis), to = drop(v, axis);
  return orient2d(from, to, drop(w, axis)) == orient2d(from, to, drop(x, axis));
}

bool has_area(Vec3 a, Vec3 b, Vec3 c) {
  for (int axis : {2, 0, 1})
    if (orient2d(drop(a, axis), drop(b, axis), drop(c, axis)) != 0) return true;
  return false;
}
bool has_area(const Mesh& mesh, int t) { return view_axis(corners(mesh, t)) >= 0; }

std::vector<std::pair<int, int>> self_intersections(const Mesh& mesh) {
  if (mesh.tris.empty()) return {};
  return self_intersections(mesh, Bvh(mesh));
}

std::vector<std::pair<int, int>> self_intersections(const Mesh& mesh, const Bvh& bvh, int own) {
  const int n = (int)mesh.tris.size();
  // a few triangles that are neighbors in the tree look for partners together
  constexpr int group = 4, chunk = 2048;
  const int chunks = (n + chunk - 1) / chunk;
  std::vector<std::vector<std::pair<int, int>>> found(chunks);
#pragma omp parallel for schedule(dynamic) if (chunks > 1)
  for (int c = 0; c < chunks; ++c)
    for (int first = c * chunk, size; first < std::min(n, (c + 1) * chunk); first += size) {
      size = std::min({group, n - first, (c + 1) * chunk - first});
      const int* members = &bvh.order()[first];
      if (std::all_of(members, members + size, [&](int t) { return t >= own; })) continue;
      Box boxes[group], all = box_of(mesh, members[0]);
      for (int i = 0; i < size; ++i) all = join(all, boxes[i] = box_of(mesh, members[i]));
      bvh.overlapping(all, [&](int t) {
        const Box box = box_of(mesh, t);
        for (int i = 0; i < size; ++i)
          if (members[i] < std::min(t, own) && overlap(boxes[i], box) &&
              triangles_intersect(mesh, members[i], t))
            found[c].push_back(std::minmax(members[i], t));
      });
    }
  std::vector<std::pair<int, int>> all;
  for (const auto& f : found) all.insert(all.end(), f.begin(), f.end());
  // a triangle without area has no plane: it is counted as such elsewhere
  std::erase_if(all, [&](const auto& p) { return !has_area(mesh, p.first) || !has_area(mesh, p.second); });
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<std::pair<int, int>> crossings(Mesh mesh, std::vector<std::pair<int, int>> pairs) {
  if (!pairs.empty()) weld(mesh);
  std::erase_if(pairs, [&](const auto& p) { return !triangles_intersect(mesh, p.first, p.second); });
  return pairs;
}

Mesh contacts(const Mesh& mesh, const std::vector<std::pair<int, int>>& pairs, Mesh places) {
  for (auto [s, t] : pairs) add_place(contact(mesh, s, t), places);
  return places;
}

Mesh coincidences(const Mesh& mesh, double near, Mesh places) {
  if (mesh.tris.empty()) return places;
  const Bvh tree(mesh);
  const Vec3 margin{near, near, near};
  std::vector<std::vector<std::vector<Vec3>>> found(mesh.tris.size());
#pragma omp parallel for schedule(dynamic, 256)
  for (int s = 0; s < (int)mesh.tris.size(); ++s) {
    const Box own = box_of(mesh, s), box{own.lo - margin, own.hi + margin};
    tree.overlapping(box, [&](int t) {
      if (t <= s || !overlap(box, box_of(mesh, t))) return;
      if (auto shared = coincidence(corners(mesh, s), corners(mesh, t), near); !shared.empty())
        found[s].push_back(std::move(shared));
    });
  }
  for (const auto& polygons : found)
    for (const std::vector<Vec3>& polygon : polygons) add_place(polygon, places);
  return places;
}

std::vector<std::pair<int, int>> new_intersections(const Mesh& mesh,
                                                   const std::vector<std::pair<int, int>>& pairs,
                                                   const Mesh& known) {
  return pairs.empty() || known.tris.empty() ? pairs : new_intersections(mesh, pairs, Bvh(known));
}

std::vector<std::pair<int, int>> new_intersections(const Mesh& mesh,
                                                   const std::vector<std::pair<int, int>>& pairs,
                                                   const Bvh& known) {
  std::vector<std::pair<int, int>> found;
  for (auto [s, t] : pairs) {
    double longest = 0;
    for (int h : {3 * s, 3 * s + 1, 3 * s + 2, 3 * t, 3 * t + 1, 3 * t + 2})
      longest = std::max(longest, edge_length(mesh, h));
    std::vector<Vec3> places = contact(mesh, s, t);
    places.push_back(lerp(places[0], places[places.size() / 2], 0.5));
    const double near = 2 * longest;
    const auto is_known = [&](Vec3 p) { return known.nearest_within(p, near, near).place.face >= 0; };
    if (std::none_of(places.begin(), places.end(), is_known)) found.push_back({s, t});
  }
  return found;
}

}  // namespace meshpipe
