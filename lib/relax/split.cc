// SPDX-License-Identifier: BSD-3-Clause
#include <initializer_list>

#include "lib/core/chord.h"
#include "lib/relax/junctions.h"
#include "lib/relax/operations.h"

namespace meshpipe {
namespace {

/// The place nearest to p that can be walked to from one of the vertices. A loose vertex is asked first,
/// since one on a model edge has two sides: then the one whose normal is along `normal` is meant.
Place place_near(const State& s, Vec3 p, std::initializer_list<int> vertices, Vec3 normal) {
  const SurfaceWalk& walk = s.reference->walk;
  for (int v : vertices)
    if (s.hold[v] == loose) return walk.closest(s.place[v], p);
  Place best = s.place[*vertices.begin()];
  double least = 1e300;
  for (int v : vertices)
    for (const Place& start : {s.place[v], walk.across(s.place[v])}) {
      const Place q = walk.closest(start, p);
      const Vec3 d = walk.point(q) - p;
      const bool same_side = dot(walk.normal(q), normal) > rules::same_side * norm(normal);
      const double score = dot(d, d) * (same_side ? 1 : 1e6);
      if (score < least) least = score, best = q;
    }
  return best;
}

/// Do the pieces fold when the edge of h gets a vertex at p?
bool folds_split(const State& s, int h, Vec3 p, Vec3 normal) {
  const EditMesh& m = s.mesh;
  const int g = m.opp[h], a = m.from(h), b = m.to(h), c = m.apex(h), d = g < 0 ? -1 : m.apex(g);
  const int ring[5] = {b, c, a, d, b};
  for (int i = 0; i < (g < 0 ? 2 : 4); ++i) {
    const int v = ring[i], w = ring[i + 1];
    if (folds(i < 2 ? s.cosine(a, b, c) : s.cosine(b, a, d),
              normal_cosine(p, s.points[v], s.points[w], normal + s.normal[v] + s.normal[w])))
      return true;
  }
  return false;
}

}  // namespace

int end_on_line(const State& s, int a, int b) {
  return s.hold[a] == slides ? a : s.hold[b] == slides ? b : -1;
}

bool split_edge(State& s, int h, double at, bool may_fold) {
  const EditMesh& m = s.mesh;
  const int g = m.opp[h], a = m.from(h), b = m.to(h), c = m.apex(h), d = g < 0 ? -1 : m.apex(g);
  if (g < 0 && s.keep_border) return false;
  // the rim of a patch, as a rule, or a seam
  if (g < 0 && s.hold[a] >= frozen && s.hold[b] >= frozen) return false;
  const Vec3 wanted = lerp(s.points[a], s.points[b], at);
  const int from = end_on_line(s, a, b);
  const Place place = m.hard[h]
                          ? (from < 0 ? s.reference->walk.slide(s.place[a], s.place[b], wanted)
                                      : s.reference->walk.slide(s.place[from], wanted))
                          : place_near(s, wanted, {a, b, c, d}, s.face_normal(h / 3) + s.face_normal(g / 3));
  const Vec3 p = s.reference->walk.point(place);
  if (norm(p - wanted) > (m.hard[h] ? rules::off_line : rules::off_edge) * norm(s.points[b] - s.points[a]))
    return false;
  const std::vector<CopyPlace> places = places_on_edge(s, h, place, p);
  for (const CopyPlace& e : places)
    if (!may_fold && folds_split(s, e.at, p, e.normal)) return false;
  insert_copies(s, places, p);
  return !places.empty();
}

void insert_vertex(State& s, int h, const Place& place, Vec3 p, Vec3 normal) {
  EditMesh& m = s.mesh;
  const int g = m.opp[h], a = m.from(h), b = m.to(h), c = m.apex(h), d = g < 0 ? -1 : m.apex(g);
  const bool hard = m.hard[h];
  if (s.recording) s.edits.push_back({Edit::split, h});
  s.points.push_back(p);
  s.place.push_back(place);
  s.normal.push_back(normal);
  s.size.push_back(s.reference->sizes ? s.reference->size(place) : 0.5 * (s.size[a] + s.size[b]));
  s.refinement.push_back(std::min(s.refinement[a], s.refinement[b]));
  s.hold.push_back(hard ? slides : loose);
  if (!s.copy.empty()) s.copy.push_back((int)s.copy.size());
  for (std::vector<int>* times : {&s.clocks.tried, &s.clocks.changed, &s.clocks.edited}) times->push_back(0);
  s.schedule.span.push_back(0);
  if (Labels& l = s.labels; !l.kind.empty()) {
    const int from = end_on_line(s, a, b);
    l.kind.push_back(hard);
    l.line.push_back(hard ? l.line[from < 0 ? a : from] : -1);
    for (std::vector<int>* label : {&l.patch, &l.part}) {
      label->push_back((*label)[h / 3]);
      if (g >= 0) label->push_back((*label)[g / 3]);
    }
  }
  const int v = m.split(h);
  for (int w : {v, a, b, c, d})
    if (w >= 0) mark_edited(s, w);
  ++s.counts.splits;
}

void split_long(State& s, double above, double most) {
  if (s.mesh.live >= most) return;
  for (int h : edges_by_length(s, above, false)) {
    if (s.mesh.live >= most) break;
    if (s.length(h) > above) split_edge(s, h);
  }
}

bool starts_chord(const State& s, int spoke, Vec3 q) {
  const EditMesh& m = s.mesh;
  return triangle_along(
             m.tris, s.points, [&](int h) { return m.opp[h]; }, [&](int h) { return m.hard[h] != 0; }, spoke,
             q, rules::along_plane) >= 0;
}

void split_chords(State& s) {
  const EditMesh& m = s.mesh;
  auto is_held = [&](int v) { return s.hold[v] != loose; };
  bool again = true;
  while (std::exchange(again, false))
    for (int h = 0; h < (int)m.opp.size(); ++h) {
      const int g = m.opp[h];
      if (m.dead(h / 3) || g < h || m.hard[h] || !is_held(m.from(h)) || !is_held(m.to(h))) continue;
      if (is_held(m.apex(h)) && is_held(m.apex(g))) continue;  // the place would be sought on the cap
      if (!starts_chord(s, h, s.points[m.to(h)]) && !starts_chord(s, g, s.points[m.to(g)])) continue;
      const int a = m.from(h), b = m.to(h), c = m.apex(h), d = m.apex(g);
      const bool unfolded = std::min(s.cosine(a, d, c), s.cosine(b, c, d)) > 0;
      // else one vertex may take in a whole strip, rung by rung
      const bool sound = std::max(s.shape(a, d, c), s.shape(b, c, d)) <=
                         std::max({rules::sound_for_valence, s.shape(a, b, c), s.shape(b, a, d)});
      if (unfolded && sound && !m.joined(c, d) && m.valence(a) > 3 && m.valence(b) > 3)
        flip_edge(s, h), again = true;
      else
        again = split_edge(s, h) || again;
    }
}

}  // namespace meshpipe
