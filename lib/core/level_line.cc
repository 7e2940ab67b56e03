// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/level_line.h"

#include <algorithm>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

namespace meshpipe {
namespace {

using std::numbers::pi;
constexpr double sharp_peak = 15 * pi / 180;  ///< radians around: within a part its map is too uneven

using Edge = std::pair<int, int>;

Edge edge_of(const EdgeCrossing& c) { return {c.low, c.high}; }

/// By the edge, each once.
std::vector<EdgeCrossing> sorted(std::vector<EdgeCrossing> list) {
  std::sort(list.begin(), list.end(),
            [](const EdgeCrossing& p, const EdgeCrossing& q) { return edge_of(p) < edge_of(q); });
  list.erase(
      std::unique(list.begin(), list.end(),
                  [](const EdgeCrossing& p, const EdgeCrossing& q) { return edge_of(p) == edge_of(q); }),
      list.end());
  return list;
}

/// The crossings of a line with edges, while they move.
struct Crossings {
  const std::vector<Tri>& tris;
  const std::vector<Vec3>& points;
  const std::vector<int>& opposite;
  std::vector<signed char>& sign;
  std::vector<double> at;    ///< of each half-edge that is crossed, from its origin; else -1
  std::vector<int> crossed;  ///< half-edges, one for each crossed edge

  bool is_crossed(int h) const { return sign[origin(tris, h)] * sign[target(tris, h)] < 0; }

  /// Puts the crossing of an edge at a fraction of half-edge h, on both of its sides.
  void set(int h, double fraction) {
    const int o = opposite[h];
    if (at[h] < 0) crossed.push_back(o < 0 ? h : std::min(h, o));
    at[h] = fraction;
    if (o >= 0) at[o] = 1 - fraction;
  }
  void clear(int h) {
    at[h] = -1;
    if (int o = opposite[h]; o >= 0) at[o] = -1;
  }
  Vec3 place(int h) const { return lerp(points[origin(tris, h)], points[target(tris, h)], at[h]); }

  /// Where the line that crosses half-edge h meets the rest of its triangle's border.
  Vec3 across(int h) const {
    if (at[next(h)] >= 0) return place(next(h));
    if (at[prev(h)] >= 0) return place(prev(h));
    return points[target(tris, next(h))];
  }

  std::vector<EdgeCrossing> list() const {
    std::vector<EdgeCrossing> all;
    for (int h : crossed)
      if (at[h] >= 0) {
        const int a = origin(tris, h), b = target(tris, h);
        all.push_back({std::min(a, b), std::max(a, b), a < b ? at[h] : 1 - at[h]});
      }
    return sorted(std::move(all));
  }
};

/// The triangles around a vertex, unfolded: half_edge[i] leaves it towards link[i], at angle[i]. Of a closed
/// star the first link vertex is the last one too.
struct Star {
  std::vector<int> half_edge, link;
  std::vector<double> angle;
  bool closed;
  double total() const { return angle.back(); }
  bool is_peak() const { return closed && total() < sharp_peak; }
  int triangles() const { return (int)half_edge.size(); }

  /// Gathers the star of the origin of `first`, the first half-edge there on a border.
  void gather(const Crossings& c, int first) {
    half_edge.clear();
    link.clear();
    angle.assign(1, 0);
    const Vec3 p = c.points[origin(c.tris, first)];
    closed = for_each_spoke(c.opposite, first, [&](int h) {
      const int u = target(c.tris, h), w = origin(c.tris, prev(h));
      half_edge.push_back(h);
      link.push_back(u);
      angle.push_back(angle.back() + meshpipe::angle(c.points[u] - p, c.points[w] - p));
    });
    link.push_back(origin(c.tris, prev(half_edge.back())));
  }
};

class Pull {
 public:
  Pull(const Connectivity& c, LevelLine& line, const std::vector<LineVertex>& hold)
      : c_{c.mesh.tris, c.mesh.points, c.opposite, line.sign, std::vector<double>(c.opposite.size(), -1), {}},
        hold_(hold),
        first_(c.mesh.points.size(), -1) {
    for (int h = 0; h < c.n_half_edges(); ++h) {
      const int a = c.from(h), b = c.to(h);
      if (c.is_border(h) || first_[a] < 0) first_[a] = h;
      if (!c_.is_crossed(h)) continue;
      const double at = crossing_on(line, std::min(a, b), std::max(a, b));
      c_.set(h, a < b ? at : 1 - at);
    }
    for (int v = 0; v < (int)first_.size(); ++v)
      if (c_.sign[v] == 0 && first_[v] >= 0) on_.push_back(v);
    for (int i = 0, n = (int)c_.crossed.size(); i < n; ++i)
      for (int v : {c.from(c_.crossed[i]), c.to(c_.crossed[i])}) {
        star_.gather(c_, first_[v]);
        if (c_.sign[v] != 0 && hold[v] == LineVertex::moves && star_.is_peak()) put_on(v);
      }
  }

  void sweep(double snap) {
    snap_ = snap;
    least_ = std::clamp(snap, 1e-3, 0.4);
    // crossings that are gone leave the list, new ones have come at its end
    std::erase_if(c_.crossed, [&](int h) { return c_.at[h] < 0; });
    for (std::size_t i = 0; i < c_.crossed.size(); ++i)
      if (c_.at[c_.crossed[i]] >= 0) slide(c_.crossed[i]);
    std::erase_if(on_, [&](int v) { return c_.sign[v] != 0; });
    for (std::size_t i = 0; i < on_.size(); ++i)
      if (hold_[on_[i]] == LineVertex::moves && c_.sign[on_[i]] == 0) leave(on_[i]);
  }

  std::vector<EdgeCrossing> crossings() const { return c_.list(); }

 private:
  void slide(int h) {
    const int a = origin(c_.tris, h), b = target(c_.tris, h), o = c_.opposite[h];
    const Vec3 edge = c_.points[b] - c_.points[a];
    const double length = norm(edge);
    if (!(length > 0)) return;
    const Vec3 along = (1 / length) * edge;
    auto unfold = [&](Vec3 p, double& s, double& height) {
      s = dot(p - c_.points[a], along);
      height = norm(p - c_.points[a] - s * along);
    };
    double s, height;
    unfold(c_.across(h), s, height);
    if (o >= 0) {
      double s2, height2;
      unfold(c_.across(o), s2, height2);
      if (!(height + height2 > 0)) return;
      s = (s * height2 + s2 * height) / (height + height2);
    }
    const double at = s / length;
    if (at < snap_ && hold_[a] == LineVertex::moves && put_on(a)) return;
    if (1 - at < snap_ && hold_[b] == LineVertex::moves && put_on(b)) return;
    c_.set(h, std::clamp(at, least_, 1 - least_));  // kept off a vertex that cannot be run through
  }

  /// A way that the line takes from a vertex that it runs through: into triangle `at` of the star (from link
  /// vertex `at` to the next), or along the edge to link vertex `at`.
  struct Branch {
    int at;
    bool edge;
    double angle, length;
  };
  /// The branches if the line ran through v. False if it could not, for it would touch itself or follow two
  /// edges of a triangle.
  bool find_branches(int v) {
    branches_.clear();
    const int n = star_.triangles();
    for (int i = 0; i < n; ++i) {
      const int a = star_.link[i], b = star_.link[i + 1];
      if (c_.sign[a] == 0 && c_.sign[b] == 0) return false;
      const int behind = i > 0 ? i - 1 : star_.closed ? n - 1 : -1;
      if (c_.sign[a] == 0 && behind >= 0 && c_.sign[star_.link[behind]] * c_.sign[b] < 0)
        branches_.push_back({i, true, star_.angle[i], norm(c_.points[a] - c_.points[v])});
      if (c_.sign[a] * c_.sign[b] < 0) {
        const Vec3 p = c_.place(next(star_.half_edge[i]));
        branches_.push_back({i, false, star_.angle[i] + angle(c_.points[a] - c_.points[v], p - c_.points[v]),
                             norm(p - c_.points[v])});
      }
    }
    return (int)branches_.size() <= (star_.closed ? 2 : 1);
  }

  bool put_on(int v) {
    star_.gather(c_, first_[v]);
    if (!find_branches(v)) return false;
    for (int i = 0; i < star_.triangles(); ++i) {
      c_.clear(star_.half_edge[i]);
      c_.clear(prev(star_.half_edge[i]));
    }
    c_.sign[v] = 0;
    on_.push_back(v);
    return true;
  }

  /// Takes the line off a vertex to the side on which it is bent, if it then passes well off it.
  void leave(int v) {
    constexpr double bent = 0.02, well = 1.2;
    star_.gather(c_, first_[v]);
    if (star_.is_peak() || !find_branches(v) || (int)branches_.size() != (star_.closed ? 2 : 1)) return;
    const int n = star_.triangles();
    // a side: from one branch to the other counter-clockwise, or between the branch and the border
    struct Side {
      double from, to, first, second;  // angles, and how far the line goes there
      int begin, count;                // link vertices inside
    };
    Side sides[2];
    const Branch& b = branches_[0];
    const int after = b.at + 1;
    if (star_.closed) {
      const Branch& c = branches_[1];
      const int until = c.edge ? c.at : c.at + 1, back = b.edge ? b.at : b.at + 1;
      sides[0] = {b.angle, c.angle, b.length, c.length, after, until - after};
      sides[1] = {c.angle, b.angle + star_.total(), c.length, b.length, c.at + 1, back + n - (c.at + 1)};
    } else {
      sides[0] = {0, b.angle, 0, b.length, 0, b.edge ? b.at : b.at + 1};
      sides[1] = {b.angle, star_.total(), b.length, 0, after, n + 1 - after};
    }
    for (Side& s : sides) {
      const double open = s.to - s.from;
      if (s.count < 1 || open > (star_.closed ? pi : pi / 2) - bent) continue;
      if (!star_.closed) (s.first > 0 ? s.second : s.first) = std::max(s.first, s.second) * std::cos(open);
      places_.clear();
      bool sound = true;
      for (int k = 0; k < s.count && sound; ++k) {
        const int i = star_.closed ? (s.begin + k) % n : s.begin + k, u = star_.link[i];
        double at = star_.angle[i] - s.from;
        if (at < 0) at += star_.total();
        const double reach =
            s.first * s.second * std::sin(open) / (s.first * std::sin(at) + s.second * std::sin(open - at));
        const double t = reach / norm(c_.points[u] - c_.points[v]);
        // the side's link vertices lie on it, none on the line
        sound = c_.sign[u] != 0 && c_.sign[u] == c_.sign[star_.link[star_.closed ? s.begin % n : s.begin]] &&
                t > well * snap_ && t > least_;
        places_.push_back({i, std::min(t, 1 - least_)});
      }
      if (!sound) continue;
      c_.sign[v] = (signed char)-c_.sign[star_.link[places_[0].first]];
      for (auto [i, t] : places_)
        if (i < n)
          c_.set(star_.half_edge[i], t);
        else  // the last edge of an open star
          c_.set(prev(star_.half_edge[n - 1]), 1 - t);
      return;
    }
  }

  Crossings c_;
  const std::vector<LineVertex>& hold_;
  double snap_ = 0, least_ = 0;  // least_: of an edge between a vertex and a crossing
  std::vector<int> first_;       // of each vertex: a half-edge that leaves it, on the border the first
  std::vector<int> on_;          // vertices that the line runs through
  Star star_;                    // scratch, as the following
  std::vector<Branch> branches_;
  std::vector<std::pair<int, double>> places_;
};

}  // namespace

double crossing_on(const LevelLine& line, int low, int high) {
  const Edge edge(low, high);
  const auto found = std::lower_bound(line.crossing.begin(), line.crossing.end(), edge,
                                      [](const EdgeCrossing& c, const Edge& e) { return edge_of(c) < e; });
  if (found == line.crossing.end() || edge_of(*found) != edge)
    throw std::logic_error("no crossing between " + std::to_string(low) + " and " + std::to_string(high));
  return found->at;
}

void pull_straight(const Connectivity& c, LevelLine& line, const std::vector<LineVertex>& hold, double snap,
                   int sweeps) {
  // the vertices that it runs through hold the line: in the end only, when it is straight
  constexpr double freely = 0.1, part = 0.67;
  Pull pull(c, line, hold);
  for (int i = 0; i < sweeps; ++i) pull.sweep(i < part * sweeps ? freely * snap : snap);
  line.crossing = pull.crossings();
}

LevelLine zero_level(const Mesh& mesh, const std::vector<double>& field) {
  LevelLine line;
  for (double f : field) line.sign.push_back((signed char)((f > 0) - (f < 0)));
  for (const Tri& t : mesh.tris)
    for (int i = 0; i < 3; ++i) {
      const int a = std::min(t[i], t[(i + 1) % 3]), b = std::max(t[i], t[(i + 1) % 3]);
      if (line.sign[a] * line.sign[b] < 0) line.crossing.push_back({a, b, field[a] / (field[a] - field[b])});
    }
  line.crossing = sorted(std::move(line.crossing));
  return line;
}

LevelLine in_whole(const LevelLine& line, const std::vector<int>& vertex, std::size_t n) {
  LevelLine whole{std::vector<signed char>(n, 1), line.crossing};
  for (std::size_t i = 0; i < vertex.size(); ++i) whole.sign[vertex[i]] = line.sign[i];
  for (EdgeCrossing& c : whole.crossing) {
    c.low = vertex[c.low], c.high = vertex[c.high];
    if (c.low > c.high) std::swap(c.low, c.high), c.at = 1 - c.at;
  }
  whole.crossing = sorted(std::move(whole.crossing));
  return whole;
}

}  // namespace meshpipe
