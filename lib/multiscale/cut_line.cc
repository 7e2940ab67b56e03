// SPDX-License-Identifier: BSD-3-Clause
#include "lib/multiscale/cut_line.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "lib/core/lists.h"
#include "lib/core/segments.h"
#include "lib/core/take_rows.h"

namespace meshpipe {
namespace {

using std::numbers::pi;

Vec2 unit(double angle) { return {std::cos(angle), std::sin(angle)}; }
double angle_of(Vec2 a) { return std::atan2(a.y, a.x); }

/// What a line has to pass through: the center of a child set or of a hole.
struct Stop {
  Vec2 at = {};
  int child = -1;     ///< level, or -1
  double radius = 0;  ///< of the set or hole around it
};

/// Orders the stops of a path between its ends so that it is short: sorted along the chord as in the paper,
/// then improved by reversing pieces and moving single stops. A short path does not cross itself.
void shorten(std::vector<Stop>& path) {
  const int n = path.size();
  const Vec2 chord = path.back().at - path.front().at;
  std::vector<int> order = identity(n);
  std::stable_sort(order.begin() + 1, order.end() - 1,
                   [&](int a, int b) { return dot(path[a].at, chord) < dot(path[b].at, chord); });
  auto d = [&](int a, int b) { return norm(path[order[a]].at - path[order[b]].at); };
  const double least = 1e-9 * norm(chord);
  for (bool better = true; better;) {
    better = false;
    for (int i = 1; i < n - 1; ++i)
      for (int j = i + 1; j < n - 1; ++j)
        if (d(i - 1, j) + d(i, j + 1) < d(i - 1, i) + d(j, j + 1) - least) {
          std::reverse(order.begin() + i, order.begin() + j + 1);
          better = true;
        }
    for (int i = 1; i < n - 1; ++i)
      for (int j = 0; j < n - 1; ++j) {
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
  path = rearranged(path, order);
}

/// Where a segment of the parent's line, from outside to the set's center, first meets the set's border: as
/// an angle on the set's own circle.
double entry_angle(const Level& set, Vec2 from) {
  const Vec2 d = set.center - from;
  const std::size_t n = set.border.size();
  double first = 2, angle = 0, nearest = 1e300, angle_of_nearest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 a = set.border[i], b = set.border[(i + 1) % n];
    const double sa = cross(d, a - from), sb = cross(d, b - from);
    if (double r = norm(a - from); r < nearest) {
      nearest = r;
      angle_of_nearest = set.angle[i];
    }
    if ((sa < 0) == (sb < 0)) continue;
    const double t = sa / (sa - sb), at = dot(d, lerp(a, b, t) - from) / dot(d, d);
    if (at < 0 || at >= first) continue;
    first = at;
    angle = (1 - t) * set.angle[i] + t * (i + 1 < n ? set.angle[i + 1] : 2 * pi);
  }
  return first < 1 ? angle : angle_of_nearest;
}

/// A line that enters and leaves a set in a narrow angle would leave a thin strip all along the branch: turn
/// both ends to opposite places on the way in, on a circle around the stops if one fits. Moves the ends
/// of the path and returns whether it did.
bool turn_ends(std::vector<Stop>& path) {
  const double from = angle_of(path.front().at), to = angle_of(path.back().at);
  const double bend = std::remainder(to - from, 2 * pi);
  const double turn = (pi - std::abs(bend)) / 2;
  double radius = 0.25;
  for (std::size_t i = 1; i + 1 < path.size(); ++i)
    radius = std::max(radius, 1.3 * (norm(path[i].at) + path[i].radius));
  if (turn < 0.1 || radius > 0.8) return false;
  const double sign = bend < 0 ? -1 : 1;
  path.front().at = radius * unit(from - sign * turn);
  path.back().at = radius * unit(to + sign * turn);
  return true;
}

/// The stops of a level, with a place for the line's ends before and after them.
std::vector<Stop> stops_of(const FilledDisk& disk, const std::vector<Level>& levels, const Level& level) {
  std::vector<Stop> path(1);
  auto widen = [](Stop& s, Vec2 p) { s.radius = std::max(s.radius, norm(p - s.at)); };
  for (int c : level.children) {
    path.push_back({levels[c].center, c});
    for (Vec2 p : levels[c].border) widen(path.back(), p);
  }
  std::vector<int> stop_of(level.vertex.size(), -1);
  for (int h : level.holes) {
    stop_of[h] = path.size();
    path.push_back({level.uv[h]});
  }
  for (const Tri& c : level.corners)  // a fan's triangles end in its center
    if (int s = stop_of[c[2]]; s >= 0) widen(path[s], level.uv[c[1]]);
  if (path.size() == 1) path.push_back({middle_of(disk, level)});
  path.push_back({});
  return path;
}

/// Signed distance to a line: positive on its left, which is what the far arc from its end to its start
/// encloses.
class Sides {
 public:
  explicit Sides(const std::vector<Vec2>& line) : n_(line.size()), polygon_(line) {
    double start = angle_of(line.front()), end = angle_of(line.back());
    if (start < end) start += 2 * pi;
    constexpr int steps = 8;
    for (int i = 0; i <= steps; ++i) polygon_.push_back(20 * unit(end + i * (start - end) / steps));
  }
  double operator()(Vec2 p) const {
    double nearest = 1e300;
    for (std::size_t i = 0; i + 1 < n_; ++i)
      nearest = std::min(nearest, distance_to_segment(p, polygon_[i], polygon_[i + 1]));
    return encloses(polygon_, p) ? nearest : -nearest;
  }

 private:
  std::size_t n_;
  std::vector<Vec2> polygon_;
};

}  // namespace

std::vector<std::vector<Vec2>> cut_lines(const FilledDisk& disk, const std::vector<Level>& levels,
                                         double direction) {
  std::vector<std::vector<Vec2>> lines(levels.size());
  std::vector<std::array<double, 2>> ends(levels.size());  // where the parent's line meets the set's circle
  for (std::size_t l = 0; l < levels.size(); ++l) {
    std::vector<Stop> path = stops_of(disk, levels, levels[l]);
    const bool root = levels[l].parent < 0;
    if (root) {
      Vec2 middle;
      for (std::size_t i = 1; i + 1 < path.size(); ++i)
        middle = middle + (1. / (path.size() - 2)) * path[i].at;
      path.front().at = middle - 3 * unit(direction);
      path.back().at = middle + 3 * unit(direction);
    } else {
      path.front().at = unit(ends[l][0]);
      path.back().at = unit(ends[l][1]);
    }
    const Stop from = path.front(), to = path.back();
    const bool bent = !root && turn_ends(path);
    shorten(path);
    if (bent) {
      path.insert(path.begin(), from);
      path.push_back(to);
    }
    for (std::size_t i = 1; i + 1 < path.size(); ++i)
      if (int c = path[i].child; c >= 0)
        ends[c] = {entry_angle(levels[c], path[i - 1].at), entry_angle(levels[c], path[i + 1].at)};
    if (!root) lines[l].push_back(3 * path.front().at);
    for (const Stop& s : path) lines[l].push_back(s.at);
    if (!root) lines[l].push_back(3 * path.back().at);
  }
  return lines;
}

std::vector<double> cut_line_field(const FilledDisk& disk, const std::vector<Level>& levels,
                                   const std::vector<std::vector<Vec2>>& lines) {
  // a vertex between levels is the mean of what they say, each as a distance in space: value over gradient
  std::vector<double> sum(disk.part_vertices, 0), weight(disk.part_vertices, 0);
  std::vector<double> value, gradient, area;
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const Level& level = levels[l];
    const Sides side(lines[l]);
    const std::size_t n = level.vertex.size();
    value.resize(n);
    for (std::size_t v = 0; v < n; ++v) value[v] = side(level.uv[v]);
    gradient.assign(n, 0);
    area.assign(n, 0);
    for (std::size_t i = 0; i < level.tris.size(); ++i) {
      if (level.tris[i] >= disk.part_tris) continue;
      const Tri& c = level.corners[i];
      const Tri& t = disk.tris[level.tris[i]];
      Vec3 p[3] = {disk.points[t[0]], disk.points[t[1]], disk.points[t[2]]};
      double twice = norm(area_vector(p[0], p[1], p[2]));
      Vec3 rise = value[c[0]] * (p[2] - p[1]) + value[c[1]] * (p[0] - p[2]) + value[c[2]] * (p[1] - p[0]);
      for (int k = 0; k < 3; ++k) {
        gradient[c[k]] += norm(rise);  // over the double area, times it
        area[c[k]] += twice;
      }
    }
    for (std::size_t v = 0; v < n; ++v) {
      if (level.vertex[v] >= disk.part_vertices || !(gradient[v] > 0)) continue;
      double& s = sum[level.vertex[v]];
      double& w = weight[level.vertex[v]];
      if (s * value[v] < 0) s = w = 0;  // on a ragged border: the deeper level decides
      s += area[v] * value[v] / (gradient[v] / area[v]);
      w += area[v];
    }
  }
  for (std::size_t v = 0; v < sum.size(); ++v) {
    if (weight[v] > 0) sum[v] /= weight[v];
    if (!(std::abs(sum[v]) >= std::numeric_limits<double>::min()))
      sum[v] = std::numeric_limits<double>::min();
  }
  return sum;
}

}  // namespace meshpipe
