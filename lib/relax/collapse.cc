// SPDX-License-Identifier: BSD-3-Clause
#include "lib/relax/junctions.h"
#include "lib/relax/operations.h"

namespace meshpipe {
namespace {

/// Would the edges of `gone` that become edges of `kept` be chords?
bool makes_chord(const State& s, int h, int gone, int kept) {
  const EditMesh& m = s.mesh;
  const int c = m.apex(h), d = m.opp[h] < 0 ? -1 : m.apex(m.opp[h]);
  if (!s.hold[kept]) return false;
  bool found = false;
  m.star(gone, [&](int e) {
    const int v = m.to(e);
    if (found || !s.hold[v] || v == kept || v == c || v == d || m.hard[e]) return;
    found = starts_chord(s, next(e), s.points[kept]) ||
            (!m.hard[h] && starts_chord(s, m.from(h) == kept ? h : next(h), s.points[v]));
  });
  return found;
}

/// May `gone` go as far as the connectivity and what is held are concerned? With `may_fold` also from between
/// held vertices.
bool may_collapse(const State& s, int h, int gone, int kept, bool merge, bool may_fold = false) {
  const EditMesh& m = s.mesh;
  if (s.hold[kept] == frozen) return false;  // may be joined outside the patch
  if (merge ? s.hold[gone] != fixed : s.hold[gone] >= fixed || (s.hold[gone] == slides && !m.hard[h]))
    return false;
  const bool is_ear = m.valence(gone) < 3;  // a corner of the border
  if (is_ear || !m.can_collapse(h, gone, merge) || makes_chord(s, h, gone, kept)) return false;
  const int g = m.opp[h];
  if (g < 0) return true;
  const int c = m.apex(h), d = m.apex(g);
  return m.valence(gone) + m.valence(kept) - 4 <= rules::largest_valence &&
         (may_fold || m.valence(gone) == 3 || !(s.hold[c] && s.hold[d] && s.hold[kept] && !m.hard[h]));
}

/// Does the line through `gone` hardly change when it goes straight to p, where `kept` will be?
bool line_stays(const State& s, int gone, int kept, Vec3 p) {
  int beyond = -1;  // the line's next vertex on the other side
  s.mesh.star(gone, [&](int e) {
    if (s.mesh.hard[e] && s.mesh.to(e) != kept) beyond = s.mesh.to(e);
    if (s.mesh.hard[prev(e)] && s.mesh.apex(e) != kept) beyond = s.mesh.apex(e);
  });
  if (beyond < 0) return false;
  const Vec3 chord = p - s.points[beyond];
  if (is_shared(s, gone) && norm(chord) > rules::junction_segment * s.target(gone)) return false;
  return !(norm(cross(chord, s.points[gone] - s.points[beyond])) >
           rules::line_deviation * s.target(gone) * norm(chord));
}

/// Where the vertex that stays will be.
struct Kept {
  Place place;
  Vec3 p, normal;
};

/// Does the star get no worse than `limits`, or than it was, when `gone` goes?
bool leaves_sound(const State& s, int h, int gone, const Kept& at, const rules::Collapse& limits) {
  const EditMesh& m = s.mesh;
  const int kept = m.from(h) == gone ? m.to(h) : m.from(h), g = m.opp[h];
  double shape_before = 0, shape_after = 0, cosine_before = 1, cosine_after = 1;
  bool short_enough = true;
  for (int v : {gone, kept}) {
    // what does not change, such as the needle in a sharp corner, permits no others
    if (v == kept && s.hold[kept] != loose) continue;
    m.star(v, [&](int e) {
      const int b = m.to(e), f = m.apex(e);
      const Vec3 x = s.points[v], y = s.points[b], z = s.points[f];
      shape_before = std::max(shape_before, shape_energy(x, y, z));
      cosine_before = std::min(cosine_before, s.cosine(v, b, f));
      if (e / 3 == h / 3 || (g >= 0 && e / 3 == g / 3)) return;
      shape_after = std::max(shape_after, shape_energy(at.p, y, z));
      cosine_after = std::min(cosine_after, normal_cosine(at.p, y, z, at.normal + s.normal[b] + s.normal[f]));
      const double l = norm(y - at.p);
      if (l > limits.length * 0.5 * (s.target(b) + s.target(kept)) && l > norm(y - x)) short_enough = false;
    });
  }
  return short_enough && (shape_after <= limits.shape || shape_after <= shape_before) &&
         (limits.may_fold || !folds(cosine_before, cosine_after));
}

/// Would taking these vertices out along these edges leave two borders between the same two vertices? So does
/// a slit of a sheet, in which another one ends, with its last vertex but the ends.
bool closes_slit(const State& s, const std::vector<std::pair<int, int>>& edges) {
  const EditMesh& m = s.mesh;
  auto kept = [&](const std::pair<int, int>& e) {
    return m.from(e.first) == e.second ? m.to(e.first) : m.from(e.first);
  };
  bool closes = false;
  for (const auto& a : edges)
    for (const auto& b : edges) {
      if (a.second >= b.second || kept(a) != kept(b)) continue;
      m.neighbors(a.second, [&](int v) { closes = closes || (v != kept(a) && m.joined(b.second, v)); });
    }
  return closes;
}

/// Takes `gone` and its copies out, each along its edge of the line where sheets meet.
bool collapse_copies(State& s, int h, int gone, const rules::Collapse& limits) {
  const EditMesh& m = s.mesh;
  const Vec3 p = s.points[m.from(h) == gone ? m.to(h) : m.from(h)];
  const std::vector<std::pair<int, int>> edges = with_copies(s, h, gone);
  for (const auto& [e, v] : edges) {
    const int kept = m.from(e) == v ? m.to(e) : m.from(e);
    if (!may_collapse(s, e, v, kept, false) || doubles_edges(s, e, v) || !line_stays(s, v, kept, p) ||
        !leaves_sound(s, e, v, {s.place[kept], p, s.normal[kept]}, limits))
      return false;
  }
  if (closes_slit(s, edges)) return false;
  for (const auto& [e, v] : edges) remove_vertex(s, e, v);
  return !edges.empty();
}

/// Collapses the edge whichever way works.
bool collapse_either(State& s, int h, const rules::Collapse& limits) {
  const int a = s.mesh.from(h), b = s.mesh.to(h);
  return collapse_edge(s, h, a, limits) || collapse_edge(s, h, b, limits);
}

}  // namespace

bool collapse_edge(State& s, int h, int gone, const rules::Collapse& limits, bool merge) {
  if (is_shared(s, gone)) return !merge && collapse_copies(s, h, gone, limits);
  const EditMesh& m = s.mesh;
  const int kept = m.from(h) == gone ? m.to(h) : m.from(h);
  if (!may_collapse(s, h, gone, kept, merge, limits.may_fold) || doubles_edges(s, h, gone)) return false;
  Kept at{s.place[kept], s.points[kept], s.normal[kept]};
  if (s.hold[kept] == loose) {
    at.place = s.reference->walk.closest(s.place[kept], lerp(s.points[gone], at.p, 0.5));
    at.p = s.reference->walk.point(at.place);
    at.normal = s.reference->normal(at.place);
  }
  if (s.hold[gone] == slides && !line_stays(s, gone, kept, at.p)) return false;
  if (!leaves_sound(s, h, gone, at, limits)) return false;
  if (s.hold[kept] == loose) put(s, kept, at.place, at.p, at.normal);
  remove_vertex(s, h, gone);
  return true;
}

void remove_vertex(State& s, int h, int gone) {
  const int kept = s.mesh.from(h) == gone ? s.mesh.to(h) : s.mesh.from(h);
  if (s.recording) s.edits.push_back({Edit::collapse, h, gone});
  s.mesh.collapse(h, gone);
  mark_edited(s, kept);
  s.mesh.neighbors(kept, [&](int v) { mark_edited(s, v); });
  ++s.counts.collapses;
}

void collapse_short(State& s, double below, double least) {
  if (s.mesh.live <= least) return;
  for (int h : edges_by_length(s, below, true)) {
    if (s.mesh.live <= least) break;
    if (!s.mesh.dead(h / 3) && !s.mesh.hard[h] && s.length(h) < below)
      collapse_either(s, h, rules::short_edge);
  }
}

void collapse_short_segments(State& s) {
  const EditMesh& m = s.mesh;
  for (int h = 0; h < (int)m.opp.size(); ++h) {
    if (m.dead(h / 3) || !m.hard[h] || h < m.opp[h]) continue;
    if (s.keep_border && m.opp[h] < 0)
      collapse_either(s, h, rules::kept_border);
    else if (s.length(h) < rules::short_segment)
      collapse_either(s, h, rules::short_line);
  }
}

void merge_corners(State& s) {
  const EditMesh& m = s.mesh;
  auto close = [&](int h) { return s.length(h) < rules::merged_corners; };
  // two lines may become one only where they are as close, and not around the last triangle of a patch
  auto joins_lines = [&](int e) {
    if (e < 0 || !m.hard[next(e)] || !m.hard[prev(e)]) return false;
    const int t = m.opp[next(e)] / 3;
    return m.opp[next(e)] < 0 || m.opp[prev(e)] < 0 || s.labels.patch[t] != s.labels.patch[e / 3] ||
           !(close(next(e)) && close(prev(e)));
  };
  for (int h = 0; h < (int)m.opp.size(); ++h) {
    if (m.dead(h / 3) || !m.hard[h] || h < m.opp[h] || !close(h)) continue;
    const int a = m.from(h), b = m.to(h);
    if (s.hold[a] != fixed || s.hold[b] != fixed) continue;
    if (s.keep_border && (m.on_border(a) || m.on_border(b))) continue;
    if (joins_lines(h) || joins_lines(m.opp[h])) continue;
    if (collapse_edge(s, h, a, rules::near_corners, true) ||
        collapse_edge(s, h, b, rules::near_corners, true))
      ++s.counts.corners_merged;
  }
}

void open_peaks(State& s) {
  const EditMesh& m = s.mesh;
  for (int v = 0; v < (int)m.out.size(); ++v) {
    if (m.out[v] < 0 || s.hold[v] != anchored || m.on_border(v)) continue;
    for (bool narrow = true; narrow;) {
      std::vector<std::pair<double, int>> spokes;
      double around = 0, ring = 0, size = 0;
      m.star(v, [&](int h) {
        const Vec3 a = s.points[m.to(h)] - s.points[v], b = s.points[m.apex(h)] - s.points[v];
        spokes.push_back({norm(a), h});
        around += m.hard[h] ? 1e300 : angle(a, b);
        ring += norm(b - a), size += s.target(m.to(h)) / m.valence(v);
      });
      if (around > rules::sharp_peak) break;
      std::sort(spokes.begin(), spokes.end());
      s.size[v] = std::max(s.size[v], 2 * spokes.front().first - size);
      auto removes = [&](const auto& spoke) {
        return collapse_edge(s, spoke.second, m.to(spoke.second), rules::into_peak);
      };
      narrow = ring < rules::around_peak * size && std::any_of(spokes.begin(), spokes.end(), removes);
    }
  }
}

void remove_irregular(State& s) {
  const EditMesh& m = s.mesh;
  const int n = (int)m.out.size();
  for (int v = 0; v < n; ++v) {
    if (m.out[v] < 0 || s.hold[v] || m.valence(v) > 4 || m.on_border(v)) continue;
    int best = -1;
    double shortest = 1e300;
    m.star(v, [&](int h) {
      const double l = norm(s.points[m.to(h)] - s.points[v]);
      if (l < shortest) shortest = l, best = h;
    });
    collapse_edge(s, best, v, rules::irregular);
  }
}

}  // namespace meshpipe
