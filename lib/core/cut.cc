// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/cut.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "lib/core/lists.h"
#include "lib/core/take_rows.h"

namespace meshpipe {
namespace {

/// Where the zero level crosses the edge from a value to one of the other sign, as a fraction of the edge.
double crossing(double from, double to) { return from / (from - to); }

double smallest_angle(Vec3 a, Vec3 b, Vec3 c) {
  return std::min({angle(b - a, c - a), angle(c - b, a - b), angle(a - c, b - c)});
}

void check_lengths(const Surface& s, std::size_t values, const std::vector<char>& active) {
  auto expect = [](const std::string& what, std::size_t has, std::size_t needs) {
    if (has != needs)
      throw std::logic_error("cut: " + what + " has " + std::to_string(has) + " values for " +
                             std::to_string(needs));
  };
  expect("field", values, s.points.size());
  if (!active.empty()) expect("active", active.size(), s.tris.size());
  for (const Column& c : s.vertex.columns)
    expect("vertex column '" + c.name + "'", c.size(), s.points.size());
  for (const Column& c : s.face.columns) expect("face column '" + c.name + "'", c.size(), s.tris.size());
}

/// The signs of the field with vertices close to the level put on it (sign 0).
///
/// A vertex is put on the level only if the interface stays a curve there: if it would meet four or more
/// branches, or a triangle would have all its corners on the level, the vertex keeps its sign (and its
/// crossings are kept off its end of the edges instead, which needs no care for topology).
class Signs {
 public:
  Signs(const Surface& s, const std::vector<double>& field, const std::vector<char>& active, double snap)
      : tris_(s.tris), field_(field), snap_(snap), sign(field.size()) {
    for (std::size_t v = 0; v < field.size(); ++v) sign[v] = (field[v] > 0) - (field[v] < 0);
    gather_candidates(active);
    for (auto [t, v] : candidates_)
      if (still_close(v) && stays_a_curve(v)) sign[v] = 0;
  }

 private:
  void gather_candidates(const std::vector<char>& active) {
    std::vector<double> closest(sign.size(), 1);
    for (std::size_t t = 0; t < tris_.size(); ++t) {
      if (!active.empty() && !active[t]) continue;
      for (int i = 0; i < 3; ++i) {
        int a = tris_[t][i], b = tris_[t][(i + 1) % 3];
        if (sign[a] * sign[b] >= 0) continue;
        double c = crossing(field_[a], field_[b]);
        closest[a] = std::min(closest[a], c);
        closest[b] = std::min(closest[b], 1 - c);
      }
    }
    rank_.assign(sign.size(), -1);
    for (std::size_t v = 0; v < sign.size(); ++v)
      if (closest[v] <= snap_) candidates_.push_back({closest[v], (int)v});
    std::sort(candidates_.begin(), candidates_.end());
    for (std::size_t i = 0; i < candidates_.size(); ++i) rank_[candidates_[i].second] = (int)i;

    star_ = lists_of((int)candidates_.size(), [&](auto use) {
      for (std::size_t t = 0; t < tris_.size(); ++t)
        if (active.empty() || active[t])
          for (int i = 0; i < 3; ++i)
            if (int r = rank_[tris_[t][i]]; r >= 0) use(r, (int)(3 * t + i));
    });
  }

  /// An earlier candidate may have taken the crossing away.
  bool still_close(int v) const {
    for (int h : star_[rank_[v]])
      for (int w : {target(tris_, h), origin(tris_, prev(h))})
        if (sign[v] * sign[w] < 0 && crossing(field_[v], field_[w]) <= snap_) return true;
    return false;
  }

  /// Counts the branches of the interface that would leave v: crossed link edges, and edges to link vertices
  /// on the level whose two triangles lie on different sides.
  bool stays_a_curve(int v) {
    int branches = 0;
    link_.clear();
    for (int h : star_[rank_[v]]) {
      int a = target(tris_, h), b = origin(tris_, prev(h));
      if (sign[a] == 0 && sign[b] == 0) return false;
      branches += sign[a] * sign[b] < 0;
      link_.push_back({a, sign[a] + sign[b]});
      link_.push_back({b, sign[a] + sign[b]});
    }
    std::sort(link_.begin(), link_.end());
    bool border = false;
    for (std::size_t i = 0; i < link_.size();) {
      std::size_t j = i + 1;
      while (j < link_.size() && link_[j].first == link_[i].first) ++j;
      if (j - i != 2)
        border = true;
      else if (sign[link_[i].first] == 0)
        branches += link_[i].second * link_[i + 1].second < 0;
      i = j;
    }
    return branches <= (border ? 1 : 2);
  }

  const std::vector<Tri>& tris_;
  const std::vector<double>& field_;
  double snap_;
  std::vector<std::pair<double, int>> candidates_;
  std::vector<int> rank_;                  // of candidates
  Lists star_;                             // the half-edges of active triangles that leave each candidate
  std::vector<std::pair<int, int>> link_;  // scratch of stays_a_curve

 public:
  std::vector<signed char> sign;
};

/// A half-edge that the level crosses, by its edge.
struct Crossed {
  int low, high, half_edge;
  bool active;
};

/// Appends the vertices of the cut edges; cut[h] is the new vertex on half-edge h, or -1. `crossing_at` gives
/// the place on an edge, from its lower vertex.
template <class CrossingAt>
std::vector<int> insert_vertices(Surface& s, const std::vector<char>& active,
                                 const std::vector<signed char>& sign, CrossingAt crossing_at) {
  std::vector<Crossed> crossed;
  for (int h = 0; h < (int)(3 * s.tris.size()); ++h) {
    int a = origin(s.tris, h), b = target(s.tris, h);
    if (sign[a] * sign[b] < 0)
      crossed.push_back({std::min(a, b), std::max(a, b), h, active.empty() || active[h / 3]});
  }
  std::sort(crossed.begin(), crossed.end(), [](const Crossed& p, const Crossed& q) {
    return std::tie(p.low, p.high, p.half_edge) < std::tie(q.low, q.high, q.half_edge);
  });

  std::vector<int> cut(3 * s.tris.size(), -1);
  std::vector<RowBetween> places;
  int n = (int)s.points.size();
  for (std::size_t i = 0; i < crossed.size();) {
    auto [a, b, h, is_active] = crossed[i];
    std::size_t j = i;
    for (; j < crossed.size() && crossed[j].low == a && crossed[j].high == b; ++j)
      is_active |= crossed[j].active;
    if (is_active) {
      for (std::size_t k = i; k < j; ++k) cut[crossed[k].half_edge] = n + (int)places.size();
      places.push_back({a, b, crossing_at(a, b)});
    }
    i = j;
  }

  for (const RowBetween& p : places) s.points.push_back(lerp(s.points[p.a], s.points[p.b], p.t));
  interpolate_rows(s.vertex, places);
  s.vertex.rows = s.points.size();
  return cut;
}

/// Cuts one triangle after another: the first piece takes the triangle's place, the others are appended.
class Splitter {
 public:
  Splitter(Surface& s, const std::vector<int>& cut) : s_(s), cut_(cut) {
    if (s.face.has("model")) model_ = &s.face.get<std::uint8_t>("model");
  }

  /// `side_of` gives the side of a piece by a corner that it has of the old triangle.
  template <class Side>
  void split(int t, std::vector<int>& side, Side side_of) {
    int n_cut = 0, first = 0;
    for (int i = 0; i < 3; ++i)
      if (cut_[3 * t + i] >= 0) ++n_cut, first = i;
    if (n_cut == 1) {
      int i = first, j = (i + 1) % 3, k = (i + 2) % 3, m = cut_[3 * t + i];
      Tri v = s_.tris[t];
      int bits = model_ ? (*model_)[t] : 0, on = bits >> i & 1;
      int bit_j = bits >> j & 1, bit_k = bits >> k & 1;
      int left = side_of(v[i]), right = side_of(v[j]);
      put(t, {v[i], m, v[k]}, on | bit_k << 2, left, side);
      append(t, {m, v[j], v[k]}, on | bit_j << 1, right, side);
    } else if (n_cut == 2) {
      // corner i is alone: edges i and k = i+2 are cut, j = i+1 is not
      int j = 0;
      while (cut_[3 * t + j] >= 0) ++j;
      int k = (j + 1) % 3, i = (j + 2) % 3, m = cut_[3 * t + i], n = cut_[3 * t + k];
      Tri v = s_.tris[t];
      int bits = model_ ? (*model_)[t] : 0;
      int bit_i = bits >> i & 1, bit_j = bits >> j & 1, bit_k = bits >> k & 1;
      int alone = side_of(v[i]), pair = side_of(v[j]);
      Vec3 pb = s_.points[v[j]], pc = s_.points[v[k]], pm = s_.points[m], pn = s_.points[n];
      double mc = std::min(smallest_angle(pm, pb, pc), smallest_angle(pm, pc, pn));
      double bn = std::min(smallest_angle(pm, pb, pn), smallest_angle(pb, pc, pn));
      put(t, {v[i], m, n}, bit_i | bit_k << 2, alone, side);
      if (mc >= bn) {
        append(t, {m, v[j], v[k]}, bit_i | bit_j << 1, pair, side);
        append(t, {m, v[k], n}, bit_k << 1, pair, side);
      } else {
        append(t, {m, v[j], n}, bit_i, pair, side);
        append(t, {v[j], v[k], n}, bit_j | bit_k << 1, pair, side);
      }
    }
  }

  /// Face columns of the appended pieces.
  void copy_columns() {
    append_rows(s_.face, source_);
    if (model_) std::copy(bits_.begin(), bits_.end(), model_->end() - (std::ptrdiff_t)bits_.size());
    s_.face.rows = s_.tris.size();
  }

 private:
  void put(int t, Tri corners, int bits, int side_value, std::vector<int>& side) {
    s_.tris[t] = corners;
    if (model_) (*model_)[t] = (std::uint8_t)bits;
    side[t] = side_value;
  }
  void append(int t, Tri corners, int bits, int side_value, std::vector<int>& side) {
    s_.tris.push_back(corners);
    bits_.push_back((std::uint8_t)bits);
    side.push_back(side_value);
    source_.push_back(t);
  }

  Surface& s_;
  const std::vector<int>& cut_;
  std::vector<std::uint8_t>* model_ = nullptr;
  std::vector<int> source_;
  std::vector<std::uint8_t> bits_;
};

/// The half-edges whose neighbors a cut changes, except those of pieces to come: those of triangles that
/// are split, and their neighbors.
std::vector<int> half_edges_of_split(const std::vector<int>& cut, const Connectivity& c) {
  auto is_split = [&](int t) { return cut[3 * t] >= 0 || cut[3 * t + 1] >= 0 || cut[3 * t + 2] >= 0; };
  std::vector<int> list;
  for (int t = 0; t < (int)cut.size() / 3; ++t) {
    if (!is_split(t)) continue;
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      list.push_back(h);
      if (const int o = c.opposite[h]; o >= 0 && !is_split(o / 3)) list.push_back(o);
    }
  }
  return list;
}

/// Makes neighbors of the listed half-edges, which have no others, and of those of the pieces from `first`
/// on.
void join_neighbors(const CutSurface& surface, int first, const std::vector<int>& list) {
  const std::vector<Tri>& tris = surface.surface.tris;
  std::vector<int>& opposite = surface.opposite;
  struct Use {
    int low, high, half_edge;
    auto edge() const { return std::tie(low, high); }
  };
  std::vector<Use> uses;
  auto add = [&](int h) {
    const int a = origin(tris, h), b = target(tris, h);
    uses.push_back({std::min(a, b), std::max(a, b), h});
  };
  for (int h : list) add(h);
  for (int h = 3 * first; h < 3 * (int)tris.size(); ++h) add(h);
  std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) { return a.edge() < b.edge(); });
  opposite.resize(3 * tris.size());
  for (const Use& u : uses) opposite[u.half_edge] = -1;
  for (std::size_t i = 1; i < uses.size(); ++i)
    if (uses[i - 1].edge() == uses[i].edge()) {
      opposite[uses[i - 1].half_edge] = uses[i].half_edge;
      opposite[uses[i].half_edge] = uses[i - 1].half_edge;
    }
}

/// Without opposite half-edges, none are updated.
template <class CrossingAt>
int cut(const CutSurface& connected, const std::vector<signed char>& sign, const std::vector<char>& active,
        std::vector<int>& side, CrossingAt crossing_at) {
  Surface& surface = connected.surface;
  const bool has_opposite = !connected.opposite.empty();
  const int n_tris = (int)surface.tris.size(), n_points = (int)surface.points.size();
  name_origins(surface);
  const std::vector<int> cut = insert_vertices(surface, active, sign, crossing_at);

  std::vector<int> changed;
  if (has_opposite) changed = half_edges_of_split(cut, connected.connectivity());
  side.assign(n_tris, -1);
  Splitter splitter(surface, cut);
  for (int t = 0; t < n_tris; ++t) {
    const bool is_active = active.empty() || active[t];
    const Tri v = surface.tris[t];
    if (is_active) {
      // without a cut edge all corners off the level agree; with all corners on it, field >= 0
      int sum = sign[v[0]] + sign[v[1]] + sign[v[2]];
      side[t] = sum < 0 ? 0 : 1;
    }
    splitter.split(t, side, [&](int corner) { return is_active ? sign[corner] > 0 : -1; });
  }
  splitter.copy_columns();
  if (has_opposite) join_neighbors(connected, n_tris, changed);
  return (int)surface.points.size() - n_points;
}

}  // namespace

void name_origins(Surface& surface) {
  if (surface.face.has("origin")) return;
  surface.face.set("origin", identity(surface.tris.size()));
}

int cut_by_scalar_field(Surface& surface, const std::vector<double>& field, const std::vector<char>& active,
                        std::vector<int>& side, double snap) {
  check_lengths(surface, field.size(), active);
  for (double f : field)
    if (!std::isfinite(f)) throw std::logic_error("cut: field is not finite");
  snap = std::clamp(snap, 0.0, 0.5);
  const Signs signs(surface, field, active, snap);
  std::vector<int> none;
  return cut({surface, none}, signs.sign, active, side,
             [&](int a, int b) { return std::clamp(crossing(field[a], field[b]), snap, 1 - snap); });
}

int cut_along_line(const CutSurface& s, const LevelLine& line, const std::vector<char>& active,
                   std::vector<int>& side) {
  check_lengths(s.surface, line.sign.size(), active);
  return cut(s, line.sign, active, side, [&](int a, int b) { return crossing_on(line, a, b); });
}

}  // namespace meshpipe
