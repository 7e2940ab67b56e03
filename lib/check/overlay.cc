// SPDX-License-Identifier: BSD-3-Clause
#include "lib/check/overlay.h"

#include <algorithm>

namespace meshpipe {
namespace {

/// Of the area: more than this uncovered is no rounding; and what rounding cannot tell from nothing. What is
/// uncovered is taken to be as wide as its root.
constexpr double uncovered = 1e-8, rounding = 1e-15;
/// Of its distance, how far a face that misses the triangle by rounding may reach into it.
constexpr double overlooked = 1e-12;

/// A triangle in its own plane, and the coordinates of points there: x and y, and z above it.
struct Frame {
  explicit Frame(const std::array<Vec3, 3>& c)
      : origin(c[0]),
        x(normalized(c[1] - c[0])),
        z(normalized(area_vector(c[0], c[1], c[2]))),
        y(cross(z, x)),
        area(norm(area_vector(c[0], c[1], c[2]))),
        corner{Vec2{0, 0}, Vec2{norm(c[1] - c[0]), 0}, Vec2{dot(c[2] - c[0], x), dot(c[2] - c[0], y)}} {}
  Vec3 operator()(Vec3 p) const {
    const Vec3 d = p - origin;
    return {dot(d, x), dot(d, y), dot(d, z)};
  }
  /// How far q is inside of side k, in units of its length.
  double inside(int k, const Vec3& q) const {
    if (k == 0) return q.y;
    const Vec2 apex = corner[2];
    const double length = corner[1].x;
    return k == 1 ? (apex.x - length) * q.y - apex.y * (q.x - length) : apex.y * q.x - apex.x * q.y;
  }

  Vec3 origin, x, z, y;
  double area;  ///< twice
  Vec2 corner[3];
};

/// Twice the area of a, b, c seen from above.
double turn(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Is the segment a-b clear of the triangle, seen from above?
bool clear(const Frame& f, const Vec3& a, const Vec3& b) {
  for (int k = 0; k < 3; ++k)
    if (f.inside(k, a) < 0 && f.inside(k, b) < 0) return true;
  double side[3];
  for (int k = 0; k < 3; ++k) side[k] = turn(a, b, {f.corner[k].x, f.corner[k].y, 0});
  return (side[0] > 0 && side[1] > 0 && side[2] > 0) || (side[0] < 0 && side[1] < 0 && side[2] < 0);
}

/// Is the triangle a, b, c clear of it?
bool clear(const Frame& f, const Vec3& a, const Vec3& b, const Vec3& c) {
  auto right_of = [&](const Vec3& p, const Vec3& q) {
    return std::all_of(f.corner, f.corner + 3, [&](Vec2 x) { return turn(p, q, {x.x, x.y, 0}) < 0; });
  };
  for (int k = 0; k < 3; ++k)
    if (f.inside(k, a) < 0 && f.inside(k, b) < 0 && f.inside(k, c) < 0) return true;
  return right_of(a, b) || right_of(b, c) || right_of(c, a);
}

/// The largest height of the plane of a, b, c over the triangle.
double plane_height(const Frame& f, const Vec3& a, const Vec3& b, const Vec3& c) {
  const double whole = turn(a, b, c);
  double highest = 0;
  for (const Vec2& corner : f.corner) {
    const Vec3 q{corner.x, corner.y, 0};
    highest =
        std::max(highest, std::abs(turn(q, b, c) * a.z + turn(q, c, a) * b.z + turn(q, a, b) * c.z) / whole);
  }
  return highest;
}

/// A point in a frame, as a corner of a polygon.
using Polygon = std::array<Vec3, 8>;

/// Keeps the part of a convex polygon of n corners where `height`, linear, is >= 0; nothing of zero area.
template <class Height>
int clip(Polygon*& polygon, Polygon*& spare, int n, const Height& height) {
  double heights[std::tuple_size_v<Polygon>];
  bool all = true, none = true;
  for (int i = 0; i < n; ++i) {
    heights[i] = height((*polygon)[i]);
    all &= heights[i] >= 0;
    none &= heights[i] <= 0;
  }
  if (all || none) return all ? n : 0;
  int kept = 0;
  for (int i = 0; i < n; ++i) {
    const int j = i + 1 < n ? i + 1 : 0;
    const double a = heights[i], b = heights[j];
    if (a >= 0) (*spare)[kept++] = (*polygon)[i];
    if ((a < 0) != (b < 0)) (*spare)[kept++] = lerp((*polygon)[i], (*polygon)[j], a / (a - b));
  }
  std::swap(polygon, spare);
  return kept;
}

}  // namespace

double sheet_height(const Connectivity& surface, int face, const std::array<Vec3, 3>& triangle,
                    double enough) {
  constexpr int most = 48;  // faces: beyond it the tree is the faster way
  const Frame frame(triangle);
  if (!(frame.area > 0)) return infinity;
  struct Face {
    int entered;  ///< its half-edge that was come through; corners from where that starts
    Vec3 corner[3];
  } faces[most];
  int n = 0;
  double highest = 0, reach = 0;
  auto add = [&](int h, const Vec3& a, const Vec3& b, const Vec3& c) {
    for (const Vec3& p : {a, b, c}) reach = std::max({reach, std::abs(p.x), std::abs(p.y)});
    double height = std::max({std::abs(a.z), std::abs(b.z), std::abs(c.z)});
    if (height > enough) height = plane_height(frame, a, b, c);
    highest = std::max(highest, height);
    faces[n++] = {h, {a, b, c}};
    return turn(a, b, c) > 0 && highest <= enough;
  };
  const int start = 3 * face;
  const Vec3 a = frame(surface.point(surface.from(start))), b = frame(surface.point(surface.to(start))),
             c = frame(surface.point(surface.apex(start)));
  // something of the first is above or below: then the rest is, by continuity
  if (!add(start, a, b, c) || clear(frame, a, b, c)) return infinity;
  for (int i = 0; i < n; ++i)
    for (int k = i > 0; k < 3; ++k) {
      const Vec3 from = faces[i].corner[k], to = faces[i].corner[(k + 1) % 3];
      if (clear(frame, from, to)) continue;
      int h = faces[i].entered;
      for (int turns = 0; turns < k; ++turns) h = next(h);
      const int g = surface.opposite[h];
      if (g < 0) return infinity;
      if (std::any_of(faces, faces + n, [&](const Face& f) { return f.entered / 3 == g / 3; })) continue;
      if (n == most || !add(g, to, from, frame(surface.point(surface.apex(g))))) return infinity;
    }
  return highest + overlooked * reach;
}

double overlay_height(const Mesh& surface, const Bvh& tree, const std::array<Vec3, 3>& c, double enough) {
  const Frame frame(c);
  if (!(frame.area > 0)) return infinity;
  constexpr int most = 512;  // faces: beyond it halves of the triangle are faster, 2.7 times among needles
  int seen = 0;
  double covered = 0, highest = 0;
  Polygon polygons[2];
  const Vec3 z = frame.z, margin{enough * std::abs(z.x), enough * std::abs(z.y), enough * std::abs(z.z)};
  tree.overlapping({lower(lower(c[0], c[1]), c[2]) - margin, upper(upper(c[0], c[1]), c[2]) + margin},
                   [&](int t) {
                     if (++seen > most) return;
                     Polygon *p = &polygons[0], *spare = &polygons[1];
                     for (int k = 0; k < 3; ++k) (*p)[k] = frame(surface.points[surface.tris[t][k]]);
                     if (!(turn((*p)[0], (*p)[1], (*p)[2]) > 0)) return;
                     int m = 3;
                     for (int k = 0; k < 3; ++k)
                       m = clip(p, spare, m, [&](const Vec3& q) { return frame.inside(k, q); });
                     for (int k = 0; k < m; ++k) {
                       const Vec3 &o = (*p)[0], &a = (*p)[k], &b = (*p)[k + 1 < m ? k + 1 : 0];
                       covered += turn(o, a, b);
                       highest = std::max(highest, std::abs(a.z));
                     }
                   });
  const double area = frame.area, gap = std::abs(covered - area);
  return seen <= most && gap <= uncovered * area ? highest + std::sqrt(std::max(gap, rounding * area))
                                                 : infinity;
}

}  // namespace meshpipe
