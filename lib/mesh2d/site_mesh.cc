// SPDX-License-Identifier: BSD-3-Clause
#include "lib/mesh2d/site_mesh.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "lib/core/connectivity.h"
#include "lib/core/error.h"
#include "lib/core/lists.h"

namespace meshpipe {
namespace {

/// Returns area over squared edges of the worst triangle at v, if v were at x.
double worst_shape(const SiteMesh& m, int v, Vec3 x) {
  double worst = 1e300;
  m.cdt.around(v, [&](int h) {
    Vec3 a = m.site[m.cdt.target(h)].space - x, b = m.site[m.cdt.apex(h)].space - x;
    worst = std::min(worst, norm(cross(a, b)) / (dot(a, a) + dot(b, b) + dot(b - a, b - a)));
  });
  return worst;
}

/// What a triangle covers of the chart: area over the squared size, and of the vertices that it misses the
/// one that is farthest from its corners, over the size.
struct Cover {
  double area = 0, apart = 0;
  Missed missed{};
};

/// Measures how far corner `corner` of the chart's triangle `face`, which triangle t covers, is from t.
void measure(const SiteMesh& m, const Chart& chart, int face, int corner, int t, Cover& cover) {
  const int vertex = chart.mesh.tris[face][corner];
  const Vec2 p = chart.uv[vertex];
  const Tri& v = m.cdt.tris[t];
  const Vec2 a = m.cdt.points[v[0]] - p, b = m.cdt.points[v[1]] - p, c = m.cdt.points[v[2]] - p;
  const double bc = cross(b, c), ca = cross(c, a), sum = bc + ca + cross(a, b), b0 = bc / sum, b1 = ca / sum;
  if (!(sum > 0)) return;
  const Site &s0 = m.site[v[0]], &s1 = m.site[v[1]], &s2 = m.site[v[2]];
  const Vec3 flat = b0 * s0.space + b1 * s1.space + (1 - b0 - b1) * s2.space;
  const double size = b0 * s0.size + b1 * s1.size + (1 - b0 - b1) * s2.size;
  const Vec3 x = chart.mesh.points[vertex];
  if (!(norm(x - flat) > least_spacing.vertex * size)) return;
  const double apart = std::min({norm(x - s0.space), norm(x - s1.space), norm(x - s2.space)}) / size;
  if (apart > cover.apart) cover.apart = apart, cover.missed = {p, face, t};
}

/// Returns for each vertex of the chart the triangle that covers it, negative: none, and measures `cover` of
/// each triangle except the area. Goes over the chart from neighbor to neighbor, so that walks are short.
std::vector<int> cover_vertices(const SiteMesh& m, const Chart& chart, std::vector<Cover>& cover) {
  constexpr int unknown = -2;
  std::vector<int> covered_by(chart.uv.size(), unknown);
  struct Step {
    int face, triangle;
  };
  std::vector<char> done(chart.mesh.tris.size(), 0);
  std::vector<Step> stack;
  for (int first = 0; first < (int)done.size(); ++first) {
    if (done[first]) continue;
    stack.push_back({first, 0});
    done[first] = 1;
    while (!stack.empty()) {
      auto [face, t] = take_last(stack);
      for (int i = 0; i < 3; ++i) {
        int& s = covered_by[chart.mesh.tris[face][i]];
        if (s == unknown) {
          s = m.cdt.walk(chart.uv[chart.mesh.tris[face][i]], t, Cdt::border_segment);
          if (s >= 0) measure(m, chart, face, i, s, cover[s]);
        }
        if (s >= 0) t = s;  // else between a border and its chord
      }
      for (int h = 3 * face; h < 3 * face + 3; ++h) {
        const int o = chart.opposite[h] / 3;
        if (chart.opposite[h] < 0 || done[o]) continue;
        done[o] = 1;
        stack.push_back({o, t});
      }
    }
  }
  return covered_by;
}

}  // namespace

bool insert_site(SiteMesh& m, Vec2 p, const Site& there, int t, Spacing spacing) {
  Cdt& cdt = m.cdt;
  MetricFactor f = factor_of(there.metric);
  bool free = m.cavity.grow(cdt, p, t, [&](int u) {
    // in-circle in the metric at p: plain rounding will do, as the cavity is kept star-shaped exactly
    const Tri& corner = cdt.tris[u];
    Vec2 a = f.to(cdt.points[corner[0]] - p), b = f.to(cdt.points[corner[1]] - p),
         c = f.to(cdt.points[corner[2]] - p);
    return dot(a, a) * cross(b, c) + dot(b, b) * cross(c, a) + dot(c, c) * cross(a, b) > 0;
  });
  if (!free) return false;
  for (int h : m.cavity.rim()) {
    Vec3 a = m.site[cdt.origin(h)].space - there.space;
    if (norm(a) < spacing.vertex * there.size) return false;
    if (!cdt.fixed[h]) continue;
    Vec3 b = m.site[cdt.target(h)].space - there.space;
    if (norm(cross(a, b)) < spacing.line * there.size * norm(b - a)) return false;
  }
  if (cdt.points.size() >= m.most_points)
    throw GoalMissed("more than " + std::to_string(m.most_points) +
                     " points are needed, many times the number that the sizes ask for; the chart is too "
                     "distorted");
  m.cavity.fill(cdt, p);
  m.site.push_back(there);
  return true;
}

bool split_long_edge(SiteMesh& m, const SizeMetric& field, int h, double longest) {
  const Cdt& cdt = m.cdt;
  const Site &a = m.site[cdt.origin(h)], &b = m.site[cdt.target(h)];
  // the middle in space may be far from the middle in the plane: halve where it lies until it is roughly
  // there
  double low = 0, high = 1;
  Vec2 p;
  Site middle{a};
  for (int step = 0; step < 30; ++step) {
    const double t = 0.5 * (low + high);
    p = lerp(cdt.points[cdt.origin(h)], cdt.points[cdt.target(h)], t);
    middle = field.at(p, middle.place.face);
    const double to_a = norm(middle.space - a.space), to_b = norm(middle.space - b.space);
    if (!(to_a + to_b > longest * middle.size)) return false;
    if (std::max(to_a, to_b) < 1.5 * std::min(to_a, to_b)) break;
    (to_a < to_b ? low : high) = t;
  }
  const int t = cdt.walk(p, h / 3);  // by rounding the point lies in either triangle of the edge
  return t >= 0 && insert_site(m, p, middle, t, least_spacing);
}

std::vector<Missed> missed_vertices(const SiteMesh& m, const SizeMetric& field) {
  constexpr double many = 2;  // over the area of a triangle of the size
  const Chart& chart = field.chart();
  std::vector<Cover> cover(m.cdt.tris.size());
  const std::vector<int> covered_by = cover_vertices(m, chart, cover);
  std::vector<Missed> missed;
  if (std::none_of(cover.begin(), cover.end(), [](const Cover& c) { return c.apart > 0; })) return missed;
  for (int face = 0; face < (int)chart.mesh.tris.size(); ++face)
    for (int corner : chart.mesh.tris[face]) {
      const int t = covered_by[corner];
      if (t < 0 || !(cover[t].apart > 0)) continue;  // nearly all
      const Site& near = m.site[m.cdt.tris[t][0]];
      cover[t].area += triangle_area(chart.mesh, face) / 3 / (near.size * near.size);
    }
  for (const Cover& c : cover)
    if (c.apart > 0 && c.area > many * 0.25 * std::sqrt(3)) missed.push_back(c.missed);
  return missed;
}

void flip_to_delaunay(SiteMesh& m, std::vector<int>& todo) {
  Cdt& cdt = m.cdt;
  // on a curved surface flips might repeat for ever: bounded
  for (std::size_t budget = 10 * todo.size(); !todo.empty() && budget > 0; --budget) {
    int h = todo.back(), o = cdt.opposite[h];
    todo.pop_back();
    if (o < 0 || cdt.fixed[h]) continue;
    Vec3 a = m.site[cdt.origin(h)].space, b = m.site[cdt.target(h)].space, c = m.site[cdt.apex(h)].space,
         d = m.site[cdt.apex(o)].space;
    // sin(gamma + delta) < 0 for the angles that look at the edge: not Delaunay
    const double cosine_c = dot(a - c, b - c), cosine_d = dot(a - d, b - d);
    if (cosine_c >= 0 && cosine_d >= 0) continue;  // most edges, without a root
    double sine = norm(cross(a - c, b - c)) * cosine_d + cosine_c * norm(cross(a - d, b - d));
    double scale = norm(a - c) * norm(b - c) * norm(a - d) * norm(b - d);
    if (!(sine < -1e-10 * scale) || !cdt.can_flip(h)) continue;
    int t = h / 3, s = o / 3;
    cdt.flip(h);
    for (int e : {3 * t + 1, 3 * t + 2, 3 * s + 1, 3 * s + 2}) todo.push_back(e);
  }
  todo.clear();
}

void flip_to_delaunay(SiteMesh& m) {
  std::vector<int> todo;
  for (int h = 0; h < 3 * (int)m.cdt.tris.size(); ++h)
    if (h < m.cdt.opposite[h]) todo.push_back(h);
  flip_to_delaunay(m, todo);
}

void smooth_in_plane(SiteMesh& m, const SizeMetric& field, int sweeps, bool flips) {
  Cdt& cdt = m.cdt;
  if (flips) flip_to_delaunay(m);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (int v = m.line_points; v < (int)cdt.points.size(); ++v) {
      if (cdt.at[v] < 0) continue;
      Vec3 sum{};
      double weight = 0;
      cdt.around(v, [&](int h) {
        // a long edge pulls more, so that edges even out
        Vec3 d = m.site[cdt.target(h)].space - m.site[v].space;
        double w = norm(d);
        sum = sum + w * d;
        weight += w;
      });
      if (!(weight > 0)) continue;
      Vec2 q = cdt.points[v] + field.to_plane(m.site[v].place.face, (1 / weight) * sum);
      bool good = std::isfinite(q.x) && std::isfinite(q.y);
      cdt.around(v, [&](int h) {
        good = good && orient2d(q, cdt.points[cdt.target(h)], cdt.points[cdt.apex(h)]) > 0;
      });
      if (!good) continue;
      Site there = field.at(q, m.site[v].place.face);
      double worst = worst_shape(m, v, there.space);
      if (worst < 0.2 && worst < worst_shape(m, v, m.site[v].space)) continue;
      cdt.points[v] = q;
      m.site[v] = there;
    }
    if (flips) flip_to_delaunay(m);
  }
}

}  // namespace meshpipe
