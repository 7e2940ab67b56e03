// SPDX-License-Identifier: BSD-3-Clause
// Vertices where the reference bends: between sheets that are nearer to each other than chords sag, a mesh
// without intersections has them there.
#include "lib/relax/repair.h"

namespace meshpipe {
namespace {

/// A place for a vertex, and its distance from what may go there.
struct Goal {
  double distance;
  Place place;
};

/// The place at a fraction of the edge of half-edge h of the reference.
Place place_on_edge(int h, double at) {
  double b[3] = {0, 0, 0};
  b[h % 3] = 1 - at, b[(h + 1) % 3] = at;
  return {h / 3, b[0], b[1], b[2]};
}

/// Where the segment from a to b passes the one from p to q, as a fraction of it from a.
double passing_fraction(Vec3 p, Vec3 q, Vec3 a, Vec3 b) {
  double at = 0.5;
  for (int i = 0; i < rules::steps_to_passing; ++i)
    at = nearest_fraction(lerp(p, q, nearest_fraction(lerp(a, b, at), p, q)), a, b);
  return at;
}

/// The edges of the reference that bend, found around the corners of t as far as `reach` from it.
std::vector<int> bent_edges(const State& s, int t, double reach) {
  const Mesh& surface = s.reference->surface;
  const SurfaceWalk& walk = s.reference->walk;
  const Tri& v = s.mesh.tris[t];
  const Vec3 center = (1.0 / 3) * (s.points[v[0]] + s.points[v[1]] + s.points[v[2]]);
  std::vector<int> faces, edges;
  auto add = [&](int face) {
    if (std::find(faces.begin(), faces.end(), face) == faces.end()) faces.push_back(face);
  };
  for (int i : v) add(s.place[i].face);
  for (std::size_t i = 0; i < faces.size() && (int)faces.size() < rules::faces_of_bends; ++i)
    for (int h = 3 * faces[i]; h < 3 * faces[i] + 3; ++h) {
      const int g = walk.opposite()[h];
      if (g < 0) continue;
      const Vec3 a = surface.points[origin(surface.tris, h)], b = surface.points[target(surface.tris, h)];
      auto is_near = [&](double at) {
        const Vec3 p = lerp(a, b, at);
        return norm(nearest_point(s, t, p) - p) <= reach;
      };
      if (!is_near(nearest_fraction(center, a, b)) && !is_near(0) && !is_near(1)) continue;
      if (h < g && angle(area_vector(surface, h / 3), area_vector(surface, g / 3)) > rules::bent)
        edges.push_back(h);
      add(g / 3);
    }
  return edges;
}

}  // namespace

bool reaches(const State& s, int v, Vec3 p, bool on_line) {
  const SurfaceWalk& walk = s.reference->walk;
  const Place to = on_line ? walk.slide(s.place[v], p) : walk.closest(s.place[v], p);
  return norm(walk.point(to) - p) < rules::reached * s.target(v);
}

std::vector<Edit> edits_to_bends(const State& s, int t) {
  const Mesh& surface = s.reference->surface;
  double longest = 0;
  for (int h = 3 * t; h < 3 * t + 3; ++h)
    longest = std::max(longest, norm(s.points[s.mesh.to(h)] - s.points[s.mesh.from(h)]));
  const double reach = rules::near_bend * longest;
  const std::vector<int> bent = bent_edges(s, t, reach);
  std::vector<Edit> edits;
  auto take = [&](std::vector<Goal>& goals, int h, int end) {
    std::stable_sort(goals.begin(), goals.end(),
                     [](const Goal& a, const Goal& b) { return a.distance < b.distance; });
    std::vector<Vec3> taken;
    for (const Goal& g : goals) {
      const Vec3 p = s.reference->walk.point(g.place);
      if (std::any_of(taken.begin(), taken.end(),
                      [&](Vec3 q) { return norm(p - q) < rules::same_bend * longest; }))
        continue;
      edits.push_back({Edit::reach, h, end, 0, g.place});
      taken.push_back(p);
      if ((int)taken.size() == rules::bends_tried) break;
    }
  };
  for (int h = 3 * t; h < 3 * t + 3; ++h) {
    const int from = s.mesh.from(h);
    const Vec3 p = s.points[from], q = s.points[s.mesh.to(h)];
    std::vector<Goal> moves, inserts;
    for (int e : bent) {
      const Vec3 a = surface.points[origin(surface.tris, e)], b = surface.points[target(surface.tris, e)];
      auto add = [&](std::vector<Goal>& goals, Vec3 x, double at) {
        if (const double d = norm(lerp(a, b, at) - x); d < reach) goals.push_back({d, place_on_edge(e, at)});
      };
      for (double at : {0.0, 1.0, nearest_fraction(p, a, b)}) add(moves, p, at);
      for (double at : {0.0, 1.0, passing_fraction(p, q, a, b)})
        if (const double x = nearest_fraction(lerp(a, b, at), p, q);
            x > rules::end_of_edge && x < 1 - rules::end_of_edge)
          add(inserts, lerp(p, q, x), at);
    }
    if (s.hold[from] == loose || s.hold[from] == anchored) take(moves, h, from);
    if (!s.mesh.hard[h]) take(inserts, h, -1);
  }
  return edits;
}

bool reach(State& s, const Edit& edit) {
  const Vec3 p = s.reference->walk.point(edit.place), normal = s.reference->normal(edit.place);
  const int from = s.mesh.from(edit.h), to = s.mesh.to(edit.h);
  if (!reaches(s, from, p, false) && (edit.end >= 0 || !reaches(s, to, p, false))) return false;
  const int v = edit.end >= 0 ? edit.end : (int)s.mesh.out.size();
  if (edit.end >= 0)
    put(s, v, edit.place, p, normal);
  else
    insert_vertex(s, edit.h, edit.place, p, normal);
  s.hold[v] = anchored;
  mark_edited(s, v);
  s.schedule.listed = false;
  return true;
}

}  // namespace meshpipe
