// SPDX-License-Identifier: BSD-3-Clause
#include "lib/level_line.h"

#include <algorithm>
#include <numbers>
#include <tuple>

namespace meshpipe {
namespace {

constexpr double pi = std::numbers::pi;

auto edge_of(const EdgeCrossing& c) { return std::tie(c.low, c.high); }

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

class Pull {
 public:
  Pull(const Mesh& mesh, const std::vector<int>& opposite, LevelLine& line, const std::vector<Hold>& hold)
      : tris_(mesh.tris),
        points_(mesh.points),
        opposite_(opposite),
        sign_(line.sign),
        hold_(hold),
        at_(3 * mesh.tris.size(), -1),
        first_(mesh.points.size(), -1) {
    for (int h = 0; h < (int)at_.size(); ++h) {
      const int a = origin(tris_, h), b = target(tris_, h);
      if (opposite[h] < 0 || first_[a] < 0) first_[a] = h;
      if (is_crossed(h)) {
        const auto found = std::lower_bound(
            line.crossing.begin(), line.crossing.end(), std::pair(std::min(a, b), std::max(a, b)),
            [](const EdgeCrossing& c, std::pair<int, int> e) { return std::pair(c.low, c.high) < e; });
        set(h, a < b ? found->at : 1 - found->at);
      }
    }
    for (int v = 0; v < (int)first_.size(); ++v)
      if (sign_[v] == 0 && first_[v] >= 0) on_.push_back(v);
    for (int v = 0; v < (int)first_.size(); ++v)
      if (hold[v] == Hold::joins && sign_[v] != 0 && first_[v] >= 0) put_on(v);
  }

  void sweep(double snap) {
    snap_ = snap;
    least_ = std::clamp(snap, 1e-3, 0.4);
    // crossings that are gone leave the list, new ones have come at its end
    std::erase_if(crossed_, [&](int h) { return at_[h] < 0; });
    for (std::size_t i = 0; i < crossed_.size(); ++i)
      if (at_[crossed_[i]] >= 0) slide(crossed_[i]);
    std::erase_if(on_, [&](int v) { return sign_[v] != 0; });
    for (std::size_t i = 0; i < on_.size(); ++i)
      if (hold_[on_[i]] == Hold::moves && sign_[on_[i]] == 0) leave(on_[i]);
  }

  std::vector<EdgeCrossing> crossings() const {
    std::vector<EdgeCrossing> list;
    for (int h : crossed_)
      if (at_[h] >= 0) {
        const int a = origin(tris_, h), b = target(tris_, h);
        list.push_back({std::min(a, b), std::max(a, b), a < b ? at_[h] : 1 - at_[h]});
      }
    return sorted(std::move(list));
  }

 private:
  bool is_crossed(int h) const { return sign_[origin(tris_, h)] * sign_[target(tris_, h)] < 0; }

  /// Puts the crossing of an edge at a fraction of half-edge h, on both of its sides.
  void set(int h, double at) {
    const int o = opposite_[h];
    if (at_[h] < 0) crossed_.push_back(o < 0 ? h : std::min(h, o));
    at_[h] = at;
    if (o >= 0) at_[o] = 1 - at;
  }
  void clear(int h) {
    at_[h] = -1;
    if (int o = opposite_[h]; o >= 0) at_[o] = -1;
  }
  Vec3 place(int h) const { return lerp(points_[origin(tris_, h)], points_[target(tris_, h)], at_[h]); }

  /// Where the line that crosses half-edge h meets the rest of its triangle's border.
  Vec3 across(int h) const {
    if (at_[next(h)] >= 0) return place(next(h));
    if (at_[prev(h)] >= 0) return place(prev(h));
    return points_[target(tris_, next(h))];
  }

  void slide(int h) {
    const int a = origin(tris_, h), b = target(tris_, h), o = opposite_[h];
    const Vec3 edge = points_[b] - points_[a];
    const double length = norm(edge);
    if (!(length > 0)) return;
    const Vec3 along = (1 / length) * edge;
    auto unfold = [&](Vec3 p, double& s, double& height) {
      s = dot(p - points_[a], along);
      height = norm(p - points_[a] - s * along);
    };
    double s, height;
    unfold(across(h), s, height);
    if (o >= 0) {
      double s2, height2;
      unfold(across(o), s2, height2);
      if (!(height + height2 > 0)) return;
      s = (s * height2 + s2 * height) / (height + height2);
    }
    const double at = s / length;
    if (at < snap_ && hold_[a] == Hold::moves && put_on(a)) return;
    if (1 - at < snap_ && hold_[b] == Hold::moves && put_on(b)) return;
    set(h, std::clamp(at, least_, 1 - least_));  // kept off a vertex that cannot be run through
  }

  /// The triangles around a vertex, unfolded: half_edge[i] leaves it towards link[i], at angle[i].
  struct Star {
    std::vector<int> half_edge, link;
    std::vector<double> angle;
    bool closed;
    double total() const { return angle.back(); }
  };
  /// Of a closed star the first link vertex is the last one too.
  void look_around(int v) {
    star_.half_edge.clear();
    star_.link.clear();
    star_.angle.assign(1, 0);
    int h = first_[v];
    for (;;) {
      const int u = target(tris_, h), w = origin(tris_, prev(h));
      star_.half_edge.push_back(h);
      star_.link.push_back(u);
      star_.angle.push_back(star_.angle.back() + angle(points_[u] - points_[v], points_[w] - points_[v]));
      const int following = opposite_[prev(h)];
      star_.closed = following == first_[v];
      if (following < 0 || star_.closed) {
        star_.link.push_back(w);
        break;
      }
      h = following;
    }
  }
  int triangles() const { return (int)star_.half_edge.size(); }

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
    const int n = triangles();
    for (int i = 0; i < n; ++i) {
      const int a = star_.link[i], b = star_.link[i + 1];
      if (sign_[a] == 0 && sign_[b] == 0) return false;
      const int behind = i > 0 ? i - 1 : star_.closed ? n - 1 : -1;
      if (sign_[a] == 0 && behind >= 0 && sign_[star_.link[behind]] * sign_[b] < 0)
        branches_.push_back({i, true, star_.angle[i], norm(points_[a] - points_[v])});
      if (sign_[a] * sign_[b] < 0) {
        const Vec3 p = place(next(star_.half_edge[i]));
        branches_.push_back({i, false, star_.angle[i] + angle(points_[a] - points_[v], p - points_[v]),
                             norm(p - points_[v])});
      }
    }
    return (int)branches_.size() <= (star_.closed ? 2 : 1);
  }

  bool put_on(int v) {
    look_around(v);
    if (!find_branches(v)) return false;
    for (int i = 0; i < triangles(); ++i) {
      clear(star_.half_edge[i]);
      clear(prev(star_.half_edge[i]));
    }
    sign_[v] = 0;
    on_.push_back(v);
    return true;
  }

  /// Takes the line off a vertex to the side on which it is bent, if it then passes well off it.
  void leave(int v) {
    constexpr double bent = 0.02, well = 1.2;
    look_around(v);
    if (!find_branches(v) || (int)branches_.size() != (star_.closed ? 2 : 1)) return;
    const int n = triangles();
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
        const double t = reach / norm(points_[u] - points_[v]);
        // the side's link vertices lie on it, none on the line
        sound = sign_[u] != 0 && sign_[u] == sign_[star_.link[star_.closed ? s.begin % n : s.begin]] &&
                t > well * snap_ && t > least_;
        places_.push_back({i, std::min(t, 1 - least_)});
      }
      if (!sound) continue;
      sign_[v] = (signed char)-sign_[star_.link[places_[0].first]];
      for (auto [i, t] : places_)
        if (i < n)
          set(star_.half_edge[i], t);
        else  // the last edge of an open star
          set(prev(star_.half_edge[n - 1]), 1 - t);
      return;
    }
  }

  const std::vector<Tri>& tris_;
  const std::vector<Vec3>& points_;
  const std::vector<int>& opposite_;
  std::vector<signed char>& sign_;
  const std::vector<Hold>& hold_;
  double snap_ = 0, least_ = 0;    // least_: of an edge between a vertex and a crossing
  std::vector<double> at_;         // of each half-edge that is crossed, from its origin; else -1
  std::vector<int> first_;         // of each vertex: a half-edge that leaves it, on the border the first
  std::vector<int> crossed_, on_;  // half-edges, one for each crossed edge; vertices
  Star star_;                      // scratch, as the following
  std::vector<Branch> branches_;
  std::vector<std::pair<int, double>> places_;
};

}  // namespace

void pull_straight(const Mesh& mesh, const std::vector<int>& opposite, LevelLine& line,
                   const std::vector<Hold>& hold, double snap, int sweeps) {
  // the vertices that it runs through hold the line: in the end only, when it is straight
  constexpr double freely = 0.1, part = 0.67;
  Pull pull(mesh, opposite, line, hold);
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
