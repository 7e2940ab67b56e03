// SPDX-License-Identifier: BSD-3-Clause
// Changing the connectivity: splits, collapses and flips, and the flips that take dislocations out.
#include <algorithm>
#include <cmath>

#include "lib/relaxer.h"

namespace meshpipe {

/// Edges (the smaller half-edge) that pass `test(h)`, ordered by `key(h)`, then by number.
template <class Test, class Key>
std::vector<int> Relaxer::ordered_edges(Test test, Key key) const {
  std::vector<std::pair<double, int>> found;
  for (int h = 0; h < (int)m_.opp.size(); ++h)
    if (!m_.dead(h / 3) && h < m_.opp[h] && !m_.hard[h] && test(h)) found.push_back({key(h), h});
  std::sort(found.begin(), found.end());
  std::vector<int> edges(found.size());
  for (std::size_t i = 0; i < found.size(); ++i) edges[i] = found[i].second;
  return edges;
}

// --- split ---

/// The place nearest to p that can be walked to from one of the vertices round it. A vertex on a model edge
/// has two sides, of which the one that faces along `facing` is meant; so a vertex that is free is asked
/// first.
Place Relaxer::place_near(Vec3 p, std::initializer_list<int> round, Vec3 facing) const {
  for (int v : round)
    if (held_[v] == loose) return ground_->walk.closest(lifted_.place[v], p);
  Place best = lifted_.place[*round.begin()];
  double least = 1e300;
  for (int v : round)
    for (const Place& start : {lifted_.place[v], ground_->walk.across(lifted_.place[v])}) {
      const Place q = ground_->walk.closest(start, p);
      const Vec3 d = ground_->walk.point(q) - p;
      const double score = dot(d, d) * (dot(ground_->walk.normal(q), facing) > 0.3 * norm(facing) ? 1 : 1e6);
      if (score < least) least = score, best = q;
    }
  return best;
}

/// Splits the edge of h at the place on the reference nearest to its middle; an edge of a border or model
/// edge on that. False if the pieces would fold, or if both ends of a model edge are corners.
bool Relaxer::split(int h) {
  const int g = m_.opp[h], a = m_.from(h), b = m_.to(h), c = m_.apex(h), d = g < 0 ? -1 : m_.apex(g);
  if (g < 0 && options_.keep_border) return false;
  // the rim of a patch, as a rule, or a seam
  if (g < 0 && held_[a] >= frozen && held_[b] >= frozen) return false;
  const Vec3 middle = lerp(at(a), at(b), 0.5);
  Place place;
  Vec3 facing{};
  if (m_.hard[h]) {
    const int from = on_line(a, b);
    if (from < 0 && g >= 0) return false;
    place = ground_->walk.slide(lifted_.place[from < 0 ? a : from], middle);
    // from a corner it may have gone the other way
    const Place other = ground_->walk.slide(lifted_.place[b], middle);
    if (from < 0 && norm(ground_->walk.point(other) - middle) < norm(ground_->walk.point(place) - middle))
      place = other;
    if (g < 0) facing = facing_at(place);
  } else {
    place = place_near(middle, {a, b, c, d}, normal(h / 3) + normal(g / 3));
    facing = facing_at(place);
  }
  const Vec3 p = ground_->walk.point(place);
  if (norm(p - middle) > (m_.hard[h] ? 0.3 : 0.5) * norm(at(b) - at(a))) return false;
  const int ring[5] = {b, c, a, d, b};
  for (int i = 0; i < (g < 0 ? 2 : 4); ++i) {
    const int v = ring[i], w = ring[i + 1];
    if (folds(i < 2 ? agrees(a, b, c) : agrees(b, a, d),
              agreement(p, at(v), at(w), facing + facing_[v] + facing_[w])))
      return false;
  }
  insert(h, place, p, facing);
  return true;
}

/// The end of a line's edge that is not a corner, so that it knows which line; -1 if both are.
int Relaxer::on_line(int a, int b) const { return held_[a] == slides ? a : held_[b] == slides ? b : -1; }

/// Puts a new vertex on the edge of h.
void Relaxer::insert(int h, const Place& place, Vec3 p, Vec3 facing) {
  const int g = m_.opp[h], a = m_.from(h), b = m_.to(h), c = m_.apex(h), d = g < 0 ? -1 : m_.apex(g);
  if (recording_) edits_.push_back({Edit::split, h, -1});
  points_.push_back(p);
  lifted_.place.push_back(place);
  lifted_.size.push_back(ground_->sizes ? ground_->size(place) : 0.5 * (lifted_.size[a] + lifted_.size[b]));
  finer_.push_back(std::min(finer_[a], finer_[b]));
  lifted_.kind.push_back(m_.hard[h] ? 1 : 0);
  lifted_.line.push_back(m_.hard[h] ? lifted_.line[on_line(a, b) < 0 ? a : on_line(a, b)] : -1);
  held_.push_back(m_.hard[h] ? slides : loose);
  facing_.push_back(facing);
  tried_.push_back(0);
  changed_.push_back(0);
  edited_.push_back(0);
  color_.push_back(-1);
  const int m = m_.split(h);
  for (int v : {m, a, b, c, d})
    if (v >= 0) edited(v);
  for (std::vector<int>* label : {&lifted_.patch, &lifted_.part}) {
    label->push_back((*label)[h / 3]);
    if (g >= 0) label->push_back((*label)[g / 3]);
  }
  ++report_.splits;
}

/// Splits edges longer than `above` times the size, the longest first, while there are fewer triangles than
/// `most`.
void Relaxer::split_long(double above, double most) {
  if (m_.live >= most) return;
  for (int h : ordered_edges([&](int e) { return ratio(e) > above; }, [&](int e) { return -ratio(e); })) {
    if (m_.live >= most) break;
    if (ratio(h) > above) split(h);
  }
}

// --- collapse ---

/// Takes the vertex `gone` of the edge of h out, into the edge's other end (or a better point if that is
/// free), when the star stays unfolded, sound in shape (energy at most `worst`, or no worse than now) and no
/// edge gets longer than `longest` times the size. A vertex on a border or model edge goes only along it, and
/// only if the line hardly changes. With `merge` it is a corner that goes into another.
bool Relaxer::collapse(int h, int gone, double worst, double longest, bool merge) {
  const int kept = m_.from(h) == gone ? m_.to(h) : m_.from(h), g = m_.opp[h];
  if (held_[kept] == frozen) return false;  // may be joined outside the patch
  if (merge ? held_[gone] != fixed : held_[gone] >= fixed || (held_[gone] == slides && !m_.hard[h]))
    return false;
  if (!m_.can_collapse(h, gone, merge)) return false;
  const int c = m_.apex(h), d = g < 0 ? -1 : m_.apex(g);
  if (g >= 0 && m_.valence(gone) + m_.valence(kept) - 4 > 9) return false;
  if (d >= 0 && held_[c] && held_[d] && held_[kept] && !m_.hard[h]) return false;
  Place place = lifted_.place[kept];
  Vec3 p = at(kept);
  if (held_[kept] == loose) {
    place = ground_->walk.closest(lifted_.place[kept], lerp(at(gone), p, 0.5));
    p = ground_->walk.point(place);
  }
  if (held_[gone] == slides) {
    // the line's next vertex on the other side
    int beyond = -1;
    m_.star(gone, [&](int e) {
      if (m_.hard[e] && m_.to(e) != kept) beyond = m_.to(e);
      if (m_.hard[prev(e)] && m_.apex(e) != kept) beyond = m_.apex(e);
    });
    if (beyond < 0) return false;
    const Vec3 chord = p - at(beyond);
    if (norm(cross(chord, at(gone) - at(beyond))) > 0.1 * size_at(gone) * norm(chord)) return false;
  }
  const Vec3 facing = held_[kept] ? facing_[kept] : facing_at(place);
  double now = 0, after = 0, agreed = 1, agree = 1;
  bool ok = true;
  for (int v : {gone, kept})
    m_.star(v, [&](int e) {
      const int b = m_.to(e), f = m_.apex(e);
      const Vec3 x = at(v), y = at(b), z = at(f);
      now = std::max(now, shape_energy(x, y, z));
      agreed = std::min(agreed, agrees(v, b, f));
      if (e / 3 == h / 3 || (g >= 0 && e / 3 == g / 3)) return;
      after = std::max(after, shape_energy(p, y, z));
      agree = std::min(agree, agreement(p, y, z, facing + facing_[b] + facing_[f]));
      if (norm(y - p) > longest * 0.5 * (size_at(b) + size_at(kept)) && norm(y - p) > norm(y - x)) ok = false;
    });
  if (!ok || (after > worst && after > now) || folds(agreed, agree)) return false;
  if (recording_) edits_.push_back({Edit::collapse, h, gone});
  m_.collapse(h, gone);
  if (held_[kept] == loose) put(kept, place, p, facing);
  edited(kept);
  m_.neighbours(kept, [&](int v) { edited(v); });
  ++report_.collapses;
  return true;
}

/// Collapses the edge whichever way works.
bool Relaxer::collapse_either(int h, double worst, double longest) {
  const int a = m_.from(h), b = m_.to(h);
  return collapse(h, a, worst, longest) || collapse(h, b, worst, longest);
}

/// Collapses edges shorter than `below` times the size, the shortest first, while there are more triangles
/// than `least`.
void Relaxer::collapse_short(double below, double least) {
  if (m_.live <= least) return;
  for (int h : ordered_edges([&](int e) { return ratio(e) < below; }, [&](int e) { return ratio(e); })) {
    if (m_.live <= least) break;
    if (!m_.dead(h / 3) && !m_.hard[h] && ratio(h) < below) collapse_either(h, 4, 1.4);
  }
}

/// Segments of borders and model edges much shorter than the size: an interface that ended close to a corner
/// leaves them. Of a border that is to be kept all those with a vertex that the input does not have.
void Relaxer::collapse_short_segments() {
  for (int h = 0; h < (int)m_.opp.size(); ++h) {
    if (m_.dead(h / 3) || !m_.hard[h] || h < m_.opp[h]) continue;
    if (options_.keep_border && m_.opp[h] < 0)
      collapse_either(h, 2000, 3);
    else if (ratio(h) < 0.6)
      collapse_either(h, 4, 1.6);
  }
}

/// Corners that a line of the model joins and that are so close that no triangle there could be good without
/// being tiny become one.
void Relaxer::merge_corners() {
  constexpr double close = 0.05;
  for (int h = 0; h < (int)m_.opp.size(); ++h) {
    if (m_.dead(h / 3) || !m_.hard[h] || h < m_.opp[h] || !(ratio(h) < close)) continue;
    const int a = m_.from(h), b = m_.to(h);
    if (held_[a] != fixed || held_[b] != fixed) continue;
    if (options_.keep_border && (m_.on_border(a) || m_.on_border(b))) continue;
    // two lines may become one only where they are as close, and not round the last triangle of a patch
    auto joins_lines = [&](int e) {
      if (e < 0 || !m_.hard[next(e)] || !m_.hard[prev(e)]) return false;
      const int t = m_.opp[next(e)] / 3;
      return m_.opp[next(e)] < 0 || m_.opp[prev(e)] < 0 || lifted_.patch[t] != lifted_.patch[e / 3] ||
             !(ratio(next(e)) < close && ratio(prev(e)) < close);
    };
    if (joins_lines(h) || joins_lines(m_.opp[h])) continue;
    if (collapse(h, a, 4, 1.6, true) || collapse(h, b, 4, 1.6, true)) ++report_.corners_merged;
  }
}

/// Inside vertices of valence 3 and 4 go: their star becomes one or two triangles.
void Relaxer::remove_irregular() {
  const int n = (int)m_.out.size();
  for (int v = 0; v < n; ++v) {
    if (m_.out[v] < 0 || held_[v] || m_.valence(v) > 4 || m_.on_border(v)) continue;
    int best = -1;
    double shortest = 1e300;
    m_.star(v, [&](int h) {
      const double l = norm(at(m_.to(h)) - at(v));
      if (l < shortest) shortest = l, best = h;
    });
    collapse(best, v, 4, 1.6);
  }
}

// --- flip ---

bool Relaxer::may_flip(int h) const {
  const int g = m_.opp[h];
  if (g < 0 || m_.hard[h]) return false;
  const int a = m_.from(h), b = m_.to(h), c = m_.apex(h), d = m_.apex(g);
  if (held_[c] == frozen && held_[d] == frozen) return false;  // may be joined outside the patch
  if (c == d || m_.valence(a) <= 3 || m_.valence(b) <= 3) return false;
  // the surface may not bend more across the new edge than across the old one, but for little
  const Vec3 n0 = normal(h / 3), n1 = normal(g / 3);
  const Vec3 m0 = normalized(area_vector(at(a), at(d), at(c))),
             m1 = normalized(area_vector(at(b), at(c), at(d)));
  if (dot(m0, n0 + n1) <= 0 || dot(m1, n0 + n1) <= 0 || dot(m0, m1) < std::min(dot(n0, n1), 0.9) - 1e-12)
    return false;
  return !folds(std::min(agrees(a, b, c), agrees(b, a, d)), std::min(agrees(a, d, c), agrees(b, c, d))) &&
         !(held_[c] == frozen ? m_.joined(d, c) : m_.joined(c, d));  // the rim may meet itself in a vertex
}

double Relaxer::worst_now(int h) const {
  const int a = m_.from(h), b = m_.to(h), c = m_.apex(h), d = m_.apex(m_.opp[h]);
  return std::max(shape(a, b, c), shape(b, a, d));
}
double Relaxer::worst_flipped(int h) const {
  const int a = m_.from(h), b = m_.to(h), c = m_.apex(h), d = m_.apex(m_.opp[h]);
  return std::max(shape(a, d, c), shape(b, c, d));
}

void Relaxer::flip(int h) {
  const int a = m_.from(h), b = m_.to(h), c = m_.apex(h), d = m_.apex(m_.opp[h]);
  if (recording_) edits_.push_back({Edit::flip, h, -1});
  m_.flip(h);
  for (int v : {a, b, c, d}) edited(v);
  ++report_.flips;
}

/// Neighbours a vertex has beyond what it should: 6 inside; the angle at a border is not known here, so 4.
int Relaxer::excess(int v) const { return m_.valence(v) - (m_.on_border(v) ? 4 : 6); }

/// By how much flipping the edge of h changes the sum of the squares of the excesses.
int Relaxer::flip_gain(int h) const {
  return 2 * (2 - excess(m_.from(h)) - excess(m_.to(h)) + excess(m_.apex(h)) + excess(m_.apex(m_.opp[h])));
}

/// Is the valence at both ends ours to choose? Not on model edges inside the surface.
bool Relaxer::flip_is_free(int h) const {
  if (m_.opp[h] < 0 || m_.hard[h]) return false;
  for (int v : {m_.from(h), m_.to(h)})
    if (held_[v] && held_[v] != anchored && !m_.on_border(v)) return false;
  return true;
}

/// Flips that bring valences nearer to 6 and leave triangles of sound shape.
void Relaxer::flip_to_regular() {
  for (int h = 0; h < (int)m_.opp.size(); ++h) {
    if (m_.dead(h / 3) || h > m_.opp[h] || !flip_is_free(h) || flip_gain(h) >= 0) continue;
    const double w = worst_flipped(h);
    if ((w <= 3 || w <= worst_now(h)) && may_flip(h)) flip(h);
  }
}

/// Flips that make the worse of the two triangles better; only where something changed since the last time.
void Relaxer::flip_to_shape() {
  const int since = flipped_at_;
  flipped_at_ = ++clock_;
  for (int h = 0; h < (int)m_.opp.size(); ++h) {
    if (m_.dead(h / 3) || h > m_.opp[h] || m_.hard[h]) continue;
    if (std::max({changed_[m_.from(h)], changed_[m_.to(h)], changed_[m_.apex(h)],
                  changed_[m_.apex(m_.opp[h])]}) < since)
      continue;
    const double most = 0.9 * worst_now(h);  // no triangle has less than 1
    if (most > 1 && worst_flipped(h) < most && may_flip(h)) flip(h);
  }
}

// --- dislocations ---

/// A pair of vertices of valence 5 and 7 is a dislocation of the triangular lattice: a flip moves it one step
/// along its glide line at no cost in valence, and two opposite ones that meet annihilate. Looks for up to
/// `depth` flips that begin with the edge of h, cost nothing until the last and gain there; keeps them, or
/// undoes them and says false.
bool Relaxer::unravel(int h, int depth, int gained) {
  constexpr double sound = 4;  // shape that smoothing mends
  if (!flip_is_free(h)) return false;
  gained += flip_gain(h);
  if (gained > 0 || (gained == 0 && depth == 1)) return false;
  const double w = worst_flipped(h);
  if ((w > sound && w > worst_now(h)) || !may_flip(h)) return false;
  const int four[4] = {m_.from(h), m_.to(h), m_.apex(h), m_.apex(m_.opp[h])};
  m_.flip(h);
  const int flipped = next(h);
  bool found = gained < 0;
  for (int i = 0; i < 4 && !found; ++i) {
    if (excess(four[i]) == 0) continue;
    int edges[2 * Star::most], n = 0;
    if (m_.valence(four[i]) > Star::most) continue;
    m_.star(four[i], [&](int e) { edges[n++] = e, edges[n++] = next(e); });
    for (int k = 0; k < n && !found; ++k)
      found = edges[k] != flipped && edges[k] != m_.opp[flipped] && unravel(edges[k], depth - 1, gained);
  }
  if (!found) {
    // flips that were undone have left the edges in place but not their numbers
    int back = -1;
    m_.star(four[2], [&](int e) {
      if (m_.to(e) == four[3]) back = e;
    });
    m_.flip(back);
    return false;
  }
  for (int v : four) edited(v);
  ++report_.flips;
  return true;
}

/// Takes pairs of dislocations out that are up to `depth` flips apart.
void Relaxer::remove_dislocations(int depth) {
  const int n = (int)m_.out.size();
  for (int v = 0; v < n; ++v) {
    if (m_.out[v] < 0 || held_[v] || excess(v) == 0 || m_.valence(v) > Star::most) continue;
    int edges[2 * Star::most], k = 0;
    m_.star(v, [&](int e) { edges[k++] = e, edges[k++] = next(e); });
    for (int i = 0; i < k; ++i)
      if (unravel(edges[i], depth, 0)) break;
  }
}

}  // namespace meshpipe
