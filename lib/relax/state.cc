// SPDX-License-Identifier: BSD-3-Clause
#include "lib/relax/state.h"

#include <bit>

#include "lib/core/error.h"
#include "lib/core/normals.h"
#include "lib/core/number.h"
#include "lib/core/parallel.h"
#include "lib/core/topology.h"
#include "lib/core/triangle_count.h"
#include "lib/relax/junctions.h"

namespace meshpipe {
namespace {

/// See Schedule.
char span_of(const EditMesh& mesh, int v) {
  unsigned other = 0;
  mesh.neighbors(v, [&](int w) { other |= (unsigned)(v ^ w); });
  return (char)std::bit_width(other);
}

/// Holds a vertex on no line that is at a corner: a peak. Maps to the plane have moved it by rounding.
void hold_at_corner(State& s, int v, const std::vector<char>& corner) {
  constexpr double rounding = 1e-6;  // of the triangle, and of the edges: others may be near the corner, too
  Place p = s.place[v];
  double shortest = HUGE_VAL;
  s.mesh.neighbors(v, [&](int w) { shortest = std::min(shortest, norm(s.points[w] - s.points[v])); });
  for (double* b : {&p.b0, &p.b1, &p.b2}) {
    const int at = s.reference->surface.tris[p.face][b == &p.b0 ? 0 : b == &p.b1 ? 1 : 2];
    if (!(*b > 1 - rounding) || !corner[at]) continue;
    if (norm(s.reference->surface.points[at] - s.points[v]) > rounding * shortest) continue;
    p.b0 = p.b1 = p.b2 = 0;
    *b = 1;
    put(s, v, p, s.reference->surface.points[at], s.reference->normal(p));
    s.hold[v] = anchored;
    return;
  }
}

/// Holds the ends of triangles that fill sharp corners where mlines has placed them: moves make them worse.
void hold_sharp_corners(State& s) {
  constexpr double widest = 0.125, equal = 0.01;  // radians; of the length: sides that differ by less
  const EditMesh& m = s.mesh;
  std::vector<int> ends;
  for (int h = 0; h < (int)m.opp.size(); ++h) {
    if (!m.hard[h] || !m.hard[prev(h)] || s.hold[m.from(h)] != fixed) continue;
    const Vec3 p = s.points[m.from(h)], a = s.points[m.to(h)] - p, b = s.points[m.apex(h)] - p;
    if (angle(a, b) < widest && std::abs(norm(a) - norm(b)) < equal * norm(a))
      ends.insert(ends.end(), {m.to(h), m.apex(h)});
  }
  for (int v : ends) s.hold[v] = fixed;
}

}  // namespace

Reference::Reference(const Surface& reference)
    : surface(reference),
      sizes(reference.vertex.has("size") ? &reference.vertex.get<double>("size") : nullptr),
      patches(reference.face.has("patch") ? &reference.face.get<int>("patch") : nullptr),
      walk(reference, model_of(reference)),
      normals(vertex_area_vectors(reference)) {}

Vec3 Reference::normal(const Place& p) const { return normalized(value_at(p, normals, surface.tris)); }

double Reference::size(const Place& p) const { return value_at(p, *sizes, surface.tris); }

State::State(const Reference& on, EditMesh edited_mesh, std::vector<Vec3> at, std::vector<Place> places,
             std::vector<double> sizes)
    : reference(&on),
      mesh(std::move(edited_mesh)),
      points(std::move(at)),
      place(std::move(places)),
      normal(points.size()),
      size(std::move(sizes)),
      refinement(points.size(), 1),
      hold(points.size()) {
  const int n = (int)points.size();
  clocks.tried.resize(n), clocks.changed.resize(n), clocks.edited.resize(n);
  schedule.span.resize(n);
  for (int v = 0; v < n; ++v)
    if (mesh.out[v] >= 0) schedule.span[v] = span_of(mesh, v);
}

bool faces_reference(const State& s, const Place& from, Vec3 p, Vec3 q, Vec3 r) {
  const SurfaceWalk& walk = s.reference->walk;
  return dot(area_vector(p, q, r), walk.normal(walk.closest(from, (1.0 / 3) * (p + q + r), true))) > 0;
}

State start_state(LiftedMesh& lifted, const Reference& reference, const std::vector<int>& line_kind,
                  const std::vector<char>& corner, bool sheets_meet) {
  const int n = (int)lifted.points.size();
  State s(reference, EditMesh(std::move(lifted.tris), n, lifted.model), std::move(lifted.points),
          std::move(lifted.place), std::move(lifted.size));
  s.labels = {std::move(lifted.kind), std::move(lifted.line), std::move(lifted.patch),
              std::move(lifted.part)};
  for (int v = 0; v < n; ++v) {
    const int line = s.labels.line[v];
    if (line >= 0 && line_kind[line] != interface_line) s.hold[v] = slides;
    s.normal[v] = reference.normal(s.place[v]);
  }
  std::vector<std::uint8_t> ends(n);
  for (int h = 0; h < (int)s.mesh.hard.size(); ++h) {
    if (!s.mesh.hard[h] || h < s.mesh.opp[h]) continue;
    for (int v : {s.mesh.from(h), s.mesh.to(h)}) {
      s.hold[v] = slides;
      if (s.mesh.opp[h] >= 0) s.normal[v] = {};
      if (ends[v] < 3) ++ends[v];
    }
  }
  // where an interface ended on a line the vertex slides; a corner of the model stays
  for (int v = 0; v < n; ++v) {
    if (!s.hold[v]) continue;
    const Place& p = s.place[v];
    const Tri& t = reference.surface.tris[p.face];
    const int at = p.b0 == 1 ? t[0] : p.b1 == 1 ? t[1] : p.b2 == 1 ? t[2] : -1;
    if (ends[v] != 2 || (at >= 0 && !corner.empty() && corner[at])) s.hold[v] = fixed;
  }
  hold_sharp_corners(s);
  for (int v = 0; v < n && !corner.empty(); ++v)
    if (!s.hold[v] && s.mesh.out[v] >= 0) hold_at_corner(s, v, corner);
  if (sheets_meet) share_vertices(s);
  return s;
}

std::vector<int> finish(State& s, LiftedMesh& r) {
  const EditMesh& m = s.mesh;
  std::vector<int> number(m.out.size(), -1), row(m.tris.size(), -1);
  auto& [kind, line, patch, part] = s.labels;
  int n = 0, k = 0;
  for (std::size_t v = 0; v < m.out.size(); ++v) {
    if (m.out[v] < 0) continue;
    number[v] = n;
    const bool on_line = s.hold[v] == slides || s.hold[v] == fixed || s.hold[v] == paired;
    s.place[n] = s.place[v], s.size[n] = s.size[v];
    kind[n] = on_line ? kind[v] : 0, line[n] = on_line ? line[v] : -1;
    s.points[n++] = s.points[v];
  }
  s.points.resize(n), s.place.resize(n), s.size.resize(n), kind.resize(n), line.resize(n);
  r = {};
  for (int t = 0; t < (int)m.tris.size(); ++t) {
    if (m.dead(t)) continue;
    const Tri& v = m.tris[t];
    std::uint8_t model = 0;
    for (int i = 0; i < 3; ++i)
      if (m.hard[3 * t + i] && m.opp[3 * t + i] >= 0) model |= 1 << i;
    r.tris.push_back({number[v[0]], number[v[1]], number[v[2]]});
    r.model.push_back(model);
    patch[k] = patch[t], part[k] = part[t];
    row[t] = k++;
  }
  patch.resize(k), part.resize(k);
  r.points = std::move(s.points), r.place = std::move(s.place), r.size = std::move(s.size);
  r.kind = std::move(kind), r.line = std::move(line);
  r.patch = std::move(patch), r.part = std::move(part);
  return row;
}

double mean_size(const State& s) {
  if (s.whole.mean_size > 0) return s.whole.mean_size;
  double area = 0;
  for (int t = 0; t < (int)s.mesh.tris.size(); ++t)
    if (const Tri& v = s.mesh.tris[t]; !s.mesh.dead(t))
      area += 0.5 * norm(area_vector(s.points[v[0]], s.points[v[1]], s.points[v[2]]));
  return size_for_count(area, s.mesh.live);
}

void put(State& s, int v, const Place& place, Vec3 p, Vec3 normal) {
  s.place[v] = place;
  s.points[v] = p;
  s.normal[v] = normal;
  if (s.reference->sizes) s.size[v] = s.reference->size(place);
}

void expect_single_fans(const State& s) {
  for (int h : further_fans(s.mesh.tris, s.mesh.opp, (int)s.points.size()))
    if (s.hold[s.mesh.from(h)] != frozen)
      throw NotAdmissible("the vertex at " + shown(s.points[s.mesh.from(h)]) +
                          " joins two fans of triangles, as mlift leaves none");
}

void mark_edited(State& s, int v) {
  mark_changed(s, v);
  s.clocks.edited[v] = s.clocks.now;
  s.schedule.span[v] = span_of(s.mesh, v);
  s.schedule.listed = false;
}

std::vector<int> edges_by_length(const State& s, double limit, bool shorter) {
  constexpr int chunk = 1 << 14;
  const int n = (int)s.mesh.opp.size();
  std::vector<std::vector<std::pair<double, int>>> part((n + chunk - 1) / chunk);
  auto look = [&](int k) {
    for (int h = k * chunk; h < std::min(n, (k + 1) * chunk); ++h) {
      if (s.mesh.dead(h / 3) || h >= s.mesh.opp[h] || s.mesh.hard[h]) continue;
      const double l = s.length(h);
      if (shorter ? l < limit : l > limit) part[k].push_back({shorter ? l : -l, h});
    }
  };
  parallel_for((int)part.size(), look, n > rules::half_edges_worth_threads);
  std::vector<std::pair<double, int>> found;
  for (const auto& p : part) found.insert(found.end(), p.begin(), p.end());
  std::sort(found.begin(), found.end());
  std::vector<int> edges(found.size());
  for (std::size_t i = 0; i < found.size(); ++i) edges[i] = found[i].second;
  return edges;
}

}  // namespace meshpipe
