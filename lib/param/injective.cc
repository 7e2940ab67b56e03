// SPDX-License-Identifier: BSD-3-Clause
#include "lib/param/injective.h"

#include <algorithm>

#include "lib/core/predicates.h"
#include "lib/core/segments.h"
#include "lib/core/topology.h"

namespace meshpipe {
namespace {

bool inverted(const Tri& t, const std::vector<Vec2>& uv) {
  return orient2d(uv[t[0]], uv[t[1]], uv[t[2]]) <= 0;
}

/// The turn of a simple polygon, +1 counter-clockwise: that of the leftmost of its lowest vertices, where it
/// is convex.
int turn(const std::vector<Vec2>& polygon) {
  std::size_t n = polygon.size(), low = 0;
  for (std::size_t i = 1; i < n; ++i)
    if (polygon[i].y < polygon[low].y || (polygon[i].y == polygon[low].y && polygon[i].x < polygon[low].x))
      low = i;
  return orient2d(polygon[(low + n - 1) % n], polygon[low], polygon[(low + 1) % n]);
}

/// Is the area of a polygon so small that points of its edges, which are rounded, may lie beyond others?
bool is_flat(const std::vector<Vec2>& polygon) {
  constexpr double rounding = 1e-12;
  double area = 0, length = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 p = polygon[i] - polygon[0], q = polygon[(i + 1) % polygon.size()] - polygon[0];
    area += 0.5 * cross(p, q), length += norm(q - p);
  }
  return !(std::abs(area) > rounding * length * length);
}

/// The kernel of a star-shaped polygon: the polygon's box clipped by the half-plane of each edge.
std::vector<Vec2> kernel(const std::vector<Vec2>& polygon) {
  Vec2 low = polygon[0], high = polygon[0];
  for (Vec2 p : polygon) low = lower(low, p), high = upper(high, p);
  std::vector<Vec2> region{low, {high.x, low.y}, high, {low.x, high.y}}, clipped;
  for (std::size_t e = 0; e < polygon.size() && !region.empty(); ++e) {
    Vec2 a = polygon[e], d = polygon[(e + 1) % polygon.size()] - a;
    clipped.clear();
    for (std::size_t i = 0; i < region.size(); ++i) {
      Vec2 p = region[i], q = region[(i + 1) % region.size()];
      double sp = cross(d, p - a), sq = cross(d, q - a);
      if (sp >= 0) clipped.push_back(p);
      if ((sp > 0 && sq < 0) || (sp < 0 && sq > 0)) clipped.push_back(lerp(p, q, sp / (sp - sq)));
    }
    region.swap(clipped);
  }
  return region;
}

/// The area's centroid; it lies well inside a convex polygon where the mean of the corners may not.
Vec2 centroid(const std::vector<Vec2>& polygon) {
  Vec2 sum{0, 0};
  double area = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    Vec2 p = polygon[i] - polygon[0], q = polygon[i + 1] - polygon[0];
    double a = cross(p, q);
    area += a;
    sum = sum + (a / 3) * (p + q);
  }
  return area > 0 ? polygon[0] + (1 / area) * sum : polygon[0];
}

}  // namespace

int count_inverted(const std::vector<Tri>& tris, const std::vector<Vec2>& uv) {
  return (int)std::count_if(tris.begin(), tris.end(), [&](const Tri& t) { return inverted(t, uv); });
}

namespace {

struct Loops {
  int counter_clockwise = 0, flat = 0;
};

/// The border edges in the order of its loops.
std::vector<Segment> border(const Connectivity& c, const std::vector<Vec2>& uv, Loops& loops) {
  std::vector<Segment> segments;
  for (const auto& loop : boundary_loops(c.opposite)) {
    std::vector<Vec2> polygon;
    for (int h : loop) {
      const int a = c.from(h), b = c.to(h);
      segments.push_back({uv[a], uv[b], a, b});
      polygon.push_back(uv[a]);
    }
    loops.counter_clockwise += turn(polygon) > 0, loops.flat += is_flat(polygon);
  }
  return segments;
}

}  // namespace

bool border_is_simple(const Connectivity& c, const std::vector<Vec2>& uv) {
  Loops loops;
  const std::vector<Segment> segments = border(c, uv, loops);
  return loops.counter_clockwise == 1 && loops.flat == 0 && SegmentTree(segments).crossings(1).empty();
}

bool polygon_is_simple(const std::vector<Vec2>& polygon) {
  std::vector<Segment> segments;
  int n = (int)polygon.size();
  for (int i = 0; i < n; ++i) segments.push_back({polygon[i], polygon[(i + 1) % n], i, (i + 1) % n});
  return turn(polygon) > 0 && SegmentTree(segments).crossings(1).empty();
}

std::vector<std::array<int, 2>> border_crossings(const Connectivity& c, const std::vector<Vec2>& uv) {
  Loops loops;
  const std::vector<Segment> segments = border(c, uv, loops);
  std::vector<std::array<int, 2>> pairs = SegmentTree(segments).crossings();
  for (auto& [s, t] : pairs) {
    s = segments[s].from;
    t = segments[t].from;
  }
  return pairs;
}

int repair_stars(const Connectivity& c, int sweeps, std::vector<Vec2>& uv) {
  const std::vector<Tri>& tris = c.mesh.tris;
  std::vector<int> bad;
  for (int t = 0; t < (int)tris.size(); ++t)
    if (inverted(tris[t], uv)) bad.push_back(t);
  std::vector<int> star;
  std::vector<Vec2> polygon;
  for (int sweep = 0; sweep < sweeps && !bad.empty(); ++sweep) {
    bool moved = false;
    for (int t : bad) {
      for (int h = 3 * t; h < 3 * t + 3 && inverted(tris[t], uv); ++h) {
        // the star of the half-edge's origin, counter-clockwise, and the polygon around it
        star.clear();
        polygon.clear();
        const bool closed = c.for_each_spoke(h, [&](int g) {
          star.push_back(g / 3);
          polygon.push_back(uv[c.to(g)]);
        });
        if (!closed) continue;  // a border vertex
        std::vector<Vec2> inside = kernel(polygon);
        if (inside.size() < 3) continue;
        Vec2& p = uv[origin(tris, h)];
        Vec2 before = p;
        p = centroid(inside);
        if (std::any_of(star.begin(), star.end(), [&](int s) { return inverted(tris[s], uv); }))
          p = before;
        else
          moved = true;
      }
    }
    std::erase_if(bad, [&](int t) { return !inverted(tris[t], uv); });
    if (!moved) break;
  }
  return (int)bad.size();
}

}  // namespace meshpipe
