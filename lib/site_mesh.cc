// SPDX-License-Identifier: BSD-3-Clause
#include "lib/site_mesh.h"

#include <algorithm>
#include <cmath>

namespace meshpipe {
namespace {

// Area over squared edges of the worst triangle at v, were it at x.
double worst_shape(const SiteMesh& m, int v, Vec3 x) {
  double worst = 1e300;
  m.cdt.around(v, [&](int h) {
    Vec3 a = m.site[m.cdt.target(h)].space - x, b = m.site[m.cdt.apex(h)].space - x;
    worst = std::min(worst, norm(cross(a, b)) / (dot(a, a) + dot(b, b) + dot(b - a, b - a)));
  });
  return worst;
}

}  // namespace

bool insert_site(SiteMesh& m, Vec2 p, const Site& there, int t, Spacing spacing) {
  Cdt& cdt = m.cdt;
  Frame f = frame_of(there.metric);
  bool free = cdt.grow_cavity(p, t, [&](int u) {
    // in-circle in the metric at p: plain rounding will do, as the cavity is kept star-shaped exactly
    const Tri& corner = cdt.tris[u];
    Vec2 a = f.to(cdt.points[corner[0]] - p), b = f.to(cdt.points[corner[1]] - p),
         c = f.to(cdt.points[corner[2]] - p);
    return dot(a, a) * cross(b, c) + dot(b, b) * cross(c, a) + dot(c, c) * cross(a, b) > 0;
  });
  if (!free) return false;
  for (int h : cdt.rim()) {
    Vec3 a = m.site[cdt.origin(h)].space - there.space;
    if (norm(a) < spacing.vertex * there.size) return false;
    if (!cdt.fixed[h]) continue;
    Vec3 b = m.site[cdt.target(h)].space - there.space;
    if (norm(cross(a, b)) < spacing.line * there.size * norm(b - a)) return false;
  }
  cdt.fill_cavity(p);
  m.site.push_back(there);
  return true;
}

void flip_to_delaunay(SiteMesh& m, std::vector<int>& todo) {
  Cdt& cdt = m.cdt;
  // on a curved surface flips might go round in circles: bounded
  for (std::size_t budget = 10 * todo.size(); !todo.empty() && budget > 0; --budget) {
    int h = todo.back(), o = cdt.opposite[h];
    todo.pop_back();
    if (o < 0 || cdt.fixed[h]) continue;
    Vec3 a = m.site[cdt.origin(h)].space, b = m.site[cdt.target(h)].space, c = m.site[cdt.apex(h)].space,
         d = m.site[cdt.apex(o)].space;
    // sin(gamma + delta) < 0 for the angles that look at the edge: not Delaunay
    double ca = norm(cross(a - c, b - c)), da = norm(cross(a - d, b - d));
    double sine = ca * dot(a - d, b - d) + dot(a - c, b - c) * da;
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

void smooth_in_plane(SiteMesh& m, const SizeMetric& field, int sweeps) {
  Cdt& cdt = m.cdt;
  flip_to_delaunay(m);
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
    flip_to_delaunay(m);
  }
}

}  // namespace meshpipe
