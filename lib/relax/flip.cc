// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/fold.h"
#include "lib/relax/junctions.h"
#include "lib/relax/operations.h"

namespace meshpipe {
namespace {

/// The worse shape of the two triangles of the edge of h as they are, and as they would be flipped.
double worse_now(const State& s, int h) {
  const EditMesh& m = s.mesh;
  const int a = m.from(h), b = m.to(h), c = m.apex(h), d = m.apex(m.opp[h]);
  return std::max(s.shape(a, b, c), s.shape(b, a, d));
}
double worse_flipped(const State& s, int h) {
  const EditMesh& m = s.mesh;
  const int a = m.from(h), b = m.to(h), c = m.apex(h), d = m.apex(m.opp[h]);
  return std::max(s.shape(a, d, c), s.shape(b, c, d));
}

/// By how much flipping the edge of h changes the sum of the squares of the excesses.
int flip_gain(const State& s, int h) {
  const EditMesh& m = s.mesh;
  return 2 *
         (2 - excess(s, m.from(h)) - excess(s, m.to(h)) + excess(s, m.apex(h)) + excess(s, m.apex(m.opp[h])));
}

/// May the valence at both ends be chosen? Not on model edges inside the surface.
bool valence_is_free(const State& s, int h) {
  if (s.mesh.opp[h] < 0 || s.mesh.hard[h]) return false;
  for (int v : {s.mesh.from(h), s.mesh.to(h)})
    if (s.hold[v] && s.hold[v] != anchored && !s.mesh.on_border(v)) return false;
  return true;
}

/// The edges of the star of v: those at v and those opposite to it. Returns their number, 0 if too many.
int edges_of_star(const EditMesh& m, int v, int (&edges)[2 * rules::largest_star]) {
  int n = 0;
  if (m.valence(v) <= rules::largest_star) m.star(v, [&](int e) { edges[n++] = e, edges[n++] = next(e); });
  return n;
}

/// Looks for up to `depth` flips that begin with the edge of h, cost nothing in valence until the last and
/// gain there. Keeps them, or undoes them and returns false.
bool unravel(State& s, int h, int depth, int gained) {
  EditMesh& m = s.mesh;
  if (!valence_is_free(s, h)) return false;
  gained += flip_gain(s, h);
  if (gained > 0 || (gained == 0 && depth == 1)) return false;
  const double w = worse_flipped(s, h);
  if ((w > rules::sound_for_smoothing && w > worse_now(s, h)) || !may_flip(s, h)) return false;
  const int four[4] = {m.from(h), m.to(h), m.apex(h), m.apex(m.opp[h])};
  m.flip(h);
  const int flipped = next(h);
  bool found = gained < 0;
  for (int i = 0; i < 4 && !found; ++i) {
    if (excess(s, four[i]) == 0) continue;
    int edges[2 * rules::largest_star];
    const int n = edges_of_star(m, four[i], edges);
    for (int k = 0; k < n && !found; ++k)
      found = edges[k] != flipped && edges[k] != m.opp[flipped] && unravel(s, edges[k], depth - 1, gained);
  }
  if (!found) {
    // flips that were undone have left the edges in place but not their numbers
    int back = -1;
    m.star(s.hold[four[2]] == frozen ? four[3] : four[2], [&](int e) {  // frozen, it may have other fans
      if (m.to(e) == four[2] || m.to(e) == four[3]) back = e;
    });
    m.flip(back);
    return false;
  }
  for (int v : four) mark_edited(s, v);
  ++s.counts.flips;
  return true;
}

/// Flips the edges that `wanted` holds for, in order. It is asked for all at first, in parallel, and again
/// where an edge nearby was flipped.
template <class Wanted>
void flip_all(State& s, Wanted wanted) {
  enum Flip : char { no, yes, ask_again };
  const EditMesh& m = s.mesh;
  const int n = (int)m.opp.size();
  std::vector<Flip> flip(n);
#pragma omp parallel for schedule(static) if (n > rules::half_edges_worth_threads)
  for (int h = 0; h < n; ++h) flip[h] = wanted(h) ? yes : no;
  for (int h = 0; h < n; ++h) {
    if (flip[h] == no || (flip[h] == ask_again && !wanted(h)) || !may_flip(s, h)) continue;
    const int four[4] = {m.from(h), m.to(h), m.apex(h), m.apex(m.opp[h])};
    flip_edge(s, h);
    for (int v : four)
      m.star(v, [&](int e) {
        for (int k : {e, next(e), prev(e)})
          for (int side : {k, m.opp[k]})
            if (side >= 0) flip[side] = ask_again;
      });
  }
}

}  // namespace

bool may_flip(const State& s, int h) {
  const EditMesh& m = s.mesh;
  const int g = m.opp[h];
  if (g < 0 || m.hard[h]) return false;
  const int a = m.from(h), b = m.to(h), c = m.apex(h), d = m.apex(g);
  if (s.hold[c] == frozen && s.hold[d] == frozen) return false;  // may be joined outside the patch
  if (c == d || m.valence(a) <= 3 || m.valence(b) <= 3) return false;
  const Vec3 n0 = s.face_normal(h / 3), n1 = s.face_normal(g / 3),
             m0 = normalized(area_vector(s.points[a], s.points[d], s.points[c])),
             m1 = normalized(area_vector(s.points[b], s.points[c], s.points[d]));
  // of two that lie flat on each other the larger faces the right way
  const Vec3 up = lie_flat(n0, n1) ? area_vector(s.points[a], s.points[b], s.points[c]) +
                                         area_vector(s.points[b], s.points[a], s.points[d])
                                   : n0 + n1;
  if (dot(m0, up) <= 0 || dot(m1, up) <= 0 ||
      dot(m0, m1) < std::min(dot(n0, n1), rules::bend) - rules::same_cosine)
    return false;
  return !folds(std::min(s.cosine(a, b, c), s.cosine(b, a, d)),
                std::min(s.cosine(a, d, c), s.cosine(b, c, d))) &&
         !(s.hold[c] == frozen ? m.joined(d, c) : m.joined(c, d)) &&  // the rim may meet itself in a vertex
         !joined_elsewhere(s, c, d) &&
         !(s.hold[c] && s.hold[d] &&
           (starts_chord(s, prev(h), s.points[d]) || starts_chord(s, prev(g), s.points[c])));
}

void flip_edge(State& s, int h) {
  EditMesh& m = s.mesh;
  const int a = m.from(h), b = m.to(h), c = m.apex(h), d = m.apex(m.opp[h]);
  if (s.recording) s.edits.push_back({Edit::flip, h, -1});
  m.flip(h);
  for (int v : {a, b, c, d}) mark_edited(s, v);
  ++s.counts.flips;
}

int excess(const State& s, int v) {
  if (s.hold[v] == frozen && !s.whole.rim_excess.empty()) return s.mesh.valence(v) + s.whole.rim_excess[v];
  return s.mesh.valence(v) - (s.mesh.on_border(v) ? 4 : 6);
}

void flip_to_regular(State& s) {
  flip_all(s, [&](int h) {
    if (s.mesh.dead(h / 3) || h > s.mesh.opp[h] || !valence_is_free(s, h) || flip_gain(s, h) >= 0)
      return false;
    const double w = worse_flipped(s, h);
    return w <= rules::sound_for_valence || w <= worse_now(s, h);
  });
}

void flip_to_shape(State& s) {
  const EditMesh& m = s.mesh;
  const std::vector<int>& changed = s.clocks.changed;
  const int since = s.clocks.flipped;
  s.clocks.flipped = ++s.clocks.now;
  flip_all(s, [&](int h) {
    if (m.dead(h / 3) || h > m.opp[h] || m.hard[h]) return false;
    if (std::max({changed[m.from(h)], changed[m.to(h)], changed[m.apex(h)], changed[m.apex(m.opp[h])]}) <
        since)
      return false;
    const double most = rules::shape_gain * worse_now(s, h);  // no triangle has less than 1
    return most > 1 && worse_flipped(s, h) < most;
  });
}

void remove_dislocations(State& s, int depth) {
  const int n = (int)s.mesh.out.size();
  for (int v = 0; v < n; ++v) {
    if (s.mesh.out[v] < 0 || s.hold[v] || excess(s, v) == 0) continue;
    int edges[2 * rules::largest_star];
    const int k = edges_of_star(s.mesh, v, edges);
    for (int i = 0; i < k; ++i)
      if (unravel(s, edges[i], depth, 0)) break;
  }
}

}  // namespace meshpipe
