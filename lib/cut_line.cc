// SPDX-License-Identifier: BSD-3-Clause
#include "lib/cut_line.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace meshpipe {
namespace {

constexpr double pi = std::numbers::pi;

Vec2 unit(double angle) { return {std::cos(angle), std::sin(angle)}; }
double angle_of(Vec2 a) { return std::atan2(a.y, a.x); }

/// Orders points 1..n-2 of a path whose ends stay, so that it is short: sorted along the chord as in the
/// paper, then improved by reversing pieces and moving single points. A short path does not cross itself.
void shorten(std::vector<Vec2>& path, std::vector<int>& id) {
  const int n = path.size();
  const Vec2 chord = path.back() - path.front();
  std::vector<int> order(n);
  for (int i = 0; i < n; i++) order[i] = i;
  std::stable_sort(order.begin() + 1, order.end() - 1,
                   [&](int a, int b) { return dot(path[a], chord) < dot(path[b], chord); });
  auto d = [&](int a, int b) { return norm(path[order[a]] - path[order[b]]); };
  const double least = 1e-9 * norm(chord);
  for (bool better = true; better;) {
    better = false;
    for (int i = 1; i < n - 1; i++)
      for (int j = i + 1; j < n - 1; j++)
        if (d(i - 1, j) + d(i, j + 1) < d(i - 1, i) + d(j, j + 1) - least) {
          std::reverse(order.begin() + i, order.begin() + j + 1);
          better = true;
        }
    for (int i = 1; i < n - 1; i++)
      for (int j = 0; j < n - 1; j++) {
        if (j == i || j == i - 1) continue;
        double gain = d(i - 1, i) + d(i, i + 1) - d(i - 1, i + 1);
        if (d(j, i) + d(i, j + 1) - d(j, j + 1) < gain - least) {
          if (j > i)
            std::rotate(order.begin() + i, order.begin() + i + 1, order.begin() + j + 1);
          else
            std::rotate(order.begin() + j + 1, order.begin() + i, order.begin() + i + 1);
          better = true;
        }
      }
  }
  std::vector<Vec2> p(n);
  std::vector<int> k(n);
  for (int i = 0; i < n; i++) {
    p[i] = path[order[i]];
    k[i] = id[order[i]];
  }
  path.swap(p);
  id.swap(k);
}

/// Distance from the frame's origin to the level's border in a direction; the nearest if there are several.
double reach(const Level& level, Vec2 direction) {
  double r = 1e300;
  for (auto [a, b] : level.border) {
    double sa = cross(direction, a), sb = cross(direction, b);
    if ((sa < 0) == (sb < 0)) continue;
    double at = dot(direction, lerp(a, b, sa / (sa - sb)));
    if (at > 0) r = std::min(r, at);
  }
  return r < 1e299 ? r : 0.4;
}

/// A line that meets a tube's end in a sharp bend would leave a thin strip all along the tube: turn both arms
/// towards opposite sides on the way in. `path` is from, point, to.
void open_bend(std::vector<Vec2>& path, std::vector<int>& id) {
  const Vec2 p = path[1], in = path[0] - p, out = path[2] - p;
  const double bend = std::remainder(angle_of(out) - angle_of(in), 2 * pi);
  const double turn = (pi - std::abs(bend)) / 2;
  if (turn < 0.1) return;
  const double r = 0.25 * std::min(norm(in), norm(out)), sign = bend < 0 ? -1 : 1;
  path = {path[0], p + r * unit(angle_of(in) - sign * turn), p, p + r * unit(angle_of(out) + sign * turn),
          path[2]};
  id = {-1, -1, id[1], -1, -1};
}

/// The line of every level, in its own frame; both ends lie far outside.
std::vector<std::vector<Vec2>> draw(const std::vector<Level>& levels, double direction) {
  std::vector<std::vector<Vec2>> lines(levels.size());
  std::vector<std::array<Vec2, 2>> arms(
      levels.size());  // directions from the set's centre along the parent's line
  for (std::size_t l = 0; l < levels.size(); l++) {
    const Level& level = levels[l];
    std::vector<Vec2> path{{}};
    std::vector<int> id{-1};
    for (int c : level.children) {
      path.push_back(levels[c].centre);
      id.push_back(c);
    }
    for (int h : level.holes) {
      path.push_back(level.uv[h]);
      id.push_back(-1);
    }
    Vec2 from, to;
    if (level.parent < 0) {
      Vec2 middle;
      for (std::size_t i = 1; i < path.size(); i++) middle = middle + (1. / (path.size() - 1)) * path[i];
      from = middle - 3 * unit(direction);
      to = middle + 3 * unit(direction);
    } else {
      // where the parent's line has surely crossed the border of the set; up to there it goes straight on
      from = 0.8 * reach(level, arms[l][0]) * arms[l][0];
      to = 0.8 * reach(level, arms[l][1]) * arms[l][1];
    }
    if (path.size() == 1) {
      path.push_back({});
      id.push_back(-1);
    }
    path[0] = from;
    path.push_back(to);
    id.push_back(-1);
    if (path.size() > 3)
      shorten(path, id);
    else if (level.parent >= 0)
      open_bend(path, id);
    for (std::size_t i = 1; i + 1 < path.size(); i++)
      if (int c = id[i]; c >= 0) {
        for (int arm = 0; arm < 2; arm++) {
          Vec2 d = path[arm ? i + 1 : i - 1] - path[i];
          arms[c][arm] = norm(d) > 0 ? (1 / norm(d)) * d : Vec2{arm ? 1. : -1., 0};
        }
      }
    if (level.parent >= 0) {
      path.insert(path.begin(), 3 * arms[l][0]);
      path.push_back(3 * arms[l][1]);
    }
    lines[l] = std::move(path);
  }
  return lines;
}

/// Signed distance to a line: positive on its left, which is what the far arc from its end to its start
/// encloses.
class Sides {
 public:
  explicit Sides(const std::vector<Vec2>& line) : n_(line.size()), polygon_(line) {
    double start = angle_of(line.front()), end = angle_of(line.back());
    if (start < end) start += 2 * pi;
    constexpr int steps = 8;
    for (int i = 0; i <= steps; i++) polygon_.push_back(20 * unit(end + i * (start - end) / steps));
  }
  double operator()(Vec2 p) const {
    double nearest = 1e300;
    for (std::size_t i = 0; i + 1 < n_; i++) {
      Vec2 a = polygon_[i], d = polygon_[i + 1] - a;
      double l2 = dot(d, d), t = l2 > 0 ? std::clamp(dot(p - a, d) / l2, 0., 1.) : 0;
      Vec2 q = a + t * d - p;
      nearest = std::min(nearest, dot(q, q));
    }
    bool inside = false;
    for (std::size_t i = 0, j = polygon_.size() - 1; i < polygon_.size(); j = i++) {
      Vec2 a = polygon_[j], b = polygon_[i];
      if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y)) inside = !inside;
    }
    return inside ? std::sqrt(nearest) : -std::sqrt(nearest);
  }

 private:
  std::size_t n_;
  std::vector<Vec2> polygon_;
};

}  // namespace

std::vector<double> cut_line_field(const FilledDisk& disk, const std::vector<Level>& levels,
                                   double direction) {
  const auto lines = draw(levels, direction);
  // a vertex between levels is the mean of what they say, each as a distance in space: value over gradient
  std::vector<double> sum(disk.part_vertices, 0), weight(disk.part_vertices, 0);
  std::vector<double> value, gradient, area;
  for (std::size_t l = 0; l < levels.size(); l++) {
    const Level& level = levels[l];
    const Sides side(lines[l]);
    const std::size_t n = level.vertex.size();
    value.resize(n);
    for (std::size_t v = 0; v < n; v++) value[v] = side(level.uv[v]);
    gradient.assign(n, 0);
    area.assign(n, 0);
    for (std::size_t i = 0; i < level.tris.size(); i++) {
      if (level.tris[i] >= disk.part_tris) continue;
      const Tri& c = level.corners[i];
      const Tri& t = disk.tris[level.tris[i]];
      Vec3 p[3] = {disk.points[t[0]], disk.points[t[1]], disk.points[t[2]]};
      double twice = norm(area_vector(p[0], p[1], p[2]));
      Vec3 rise = value[c[0]] * (p[2] - p[1]) + value[c[1]] * (p[0] - p[2]) + value[c[2]] * (p[1] - p[0]);
      for (int k = 0; k < 3; k++) {
        gradient[c[k]] += norm(rise);  // over the double area, times it
        area[c[k]] += twice;
      }
    }
    for (std::size_t v = 0; v < n; v++) {
      if (level.vertex[v] >= disk.part_vertices || !(gradient[v] > 0)) continue;
      sum[level.vertex[v]] += area[v] * value[v] / (gradient[v] / area[v]);
      weight[level.vertex[v]] += area[v];
    }
  }
  for (std::size_t v = 0; v < sum.size(); v++) {
    if (weight[v] > 0) sum[v] /= weight[v];
    if (!(std::abs(sum[v]) >= std::numeric_limits<double>::min()))
      sum[v] = std::numeric_limits<double>::min();
  }
  return sum;
}

}  // namespace meshpipe
