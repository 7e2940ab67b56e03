// SPDX-License-Identifier: BSD-3-Clause
#include "lib/multiscale/levels.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lib/core/connectivity.h"
#include "lib/core/error.h"
#include "lib/core/lists.h"
#include "lib/core/topology.h"
#include "lib/numeric/laplacian.h"

namespace meshpipe {
namespace {

using std::numbers::pi;
// a level resolves about four diameters of a tube (a factor e^-2 in length each); two more make a margin for
// the natural condition where the system is cut off
constexpr double depth_in_diameters = 6;
// triangles this much smaller in area against the surface than at the border are withdrawn too, however
// coarse the mesh: a factor e^-4 for each diameter of a tube, so four of them
constexpr double least_stretch = 1e-7;
constexpr double least_area = 1e-10 * pi;  // of a triangle's image: A_min of the paper, in the unit disk
constexpr std::size_t least_set = 10;      // triangles: smaller sets stay with their level
constexpr std::size_t least_domain = 2000;
constexpr std::size_t max_levels = 100000;

/// A set of withdrawn triangles that waits for its own level.
struct Pending {
  int parent = -1;
  Vec2 center;
  std::vector<int> seeds;     // triangles that touch what is resolved
  std::vector<int> loop;      // half-edges of its border, in order
  std::vector<Vec2> border;   // their origins in the parent's disk
  std::vector<double> angle;  // and on the own circle
};

/// All levels so far, and the level at work.
struct Solver {
  explicit Solver(const FilledDisk& d)
      : disk(d),
        owner(d.tris.size(), -1),
        place(d.tris.size(), -1),
        visited(d.tris.size(), -1),
        known(d.points.size(), 0),
        passed(3 * d.tris.size(), 0) {}

  const FilledDisk& disk;
  std::vector<int> owner;    ///< of each triangle: the level that resolves it, or -1
  std::vector<int> place;    ///< of each triangle: in the domain of the level at work, or -1
  std::vector<int> visited;  ///< of each triangle: scratch of join_beyond
  std::vector<char> known;   ///< of each vertex: of a resolved triangle, or on the rim
  std::vector<char> passed;  ///< of each half-edge: on the borders of sets
  std::vector<Pending> queue;
  std::vector<Level> levels;
  // the level at work: its triangles, how far they are from its border, and what becomes of them
  std::vector<int> domain;
  std::vector<double> distance;
  std::vector<char> small;
  // the map of its triangles' corners
  std::vector<Tri> corners;
  std::vector<int> vertex;
  std::vector<char> fixed;
  std::vector<Vec2> uv;
};

bool touches_known(const Solver& s, int t) {
  const Tri& c = s.disk.tris[t];
  return s.known[c[0]] || s.known[c[1]] || s.known[c[2]];
}
bool unresolved(const Solver& s, int t) { return t >= 0 && s.owner[t] < 0; }

bool on_border(const Solver& s, int h) {
  return s.disk.opposite[h] < 0 || s.owner[s.disk.opposite[h] / 3] >= 0;
}

/// The border of the unresolved set to the left of h, from h on.
std::vector<int> border_loop(const Solver& s, int h) {
  std::vector<int> loop;
  int e = h;
  do {
    loop.push_back(e);
    for (e = next(e); !on_border(s, e);) e = next(s.disk.opposite[e]);
  } while (e != h);
  return loop;
}

Pending root(Solver& s) {
  Pending set;
  for (std::size_t h = 0; h < s.disk.opposite.size(); ++h)
    if (s.disk.opposite[h] < 0) {
      set.loop = border_loop(s, h);
      break;
    }
  const double total = loop_length(s.disk, set.loop);
  double at = 0;
  for (int h : set.loop) {
    set.angle.push_back(2 * pi * at / total);
    at += edge_length(s.disk, h);
  }
  for (int v : s.disk.rim) s.known[v] = 1;
  for (std::size_t t = 0; t < s.disk.tris.size(); ++t)
    if (touches_known(s, t)) set.seeds.push_back(t);
  return set;
}

/// Gathers s.domain: the triangles of the set within `depth` of its border; breadth first, so distances are
/// those of the tree: an upper bound. Gives up beyond `most`. Returns whether some were left out.
bool gather(Solver& s, const Pending& set, double depth, std::size_t most = SIZE_MAX) {
  for (int t : s.domain) s.place[t] = -1;
  s.domain.clear();
  s.distance.clear();
  for (int t : set.seeds) {
    s.place[t] = s.domain.size();
    s.domain.push_back(t);
    s.distance.push_back(0);
  }
  bool truncated = false;
  for (std::size_t i = 0; i < s.domain.size(); ++i) {
    if (s.domain.size() > most) return true;
    int t = s.domain[i];
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      int n = s.disk.opposite[h] < 0 ? -1 : s.disk.opposite[h] / 3;
      if (!unresolved(s, n) || s.place[n] >= 0) continue;
      double d = s.distance[i] + norm(centroid(s.disk, n) - centroid(s.disk, t));
      if (d > depth && s.domain.size() > least_domain) {
        truncated = true;
        continue;
      }
      s.place[n] = s.domain.size();
      s.domain.push_back(n);
      s.distance.push_back(d);
    }
  }
  return truncated;
}

bool beyond(const Solver& s, int h) {
  int o = s.disk.opposite[h];
  return o >= 0 && unresolved(s, o / 3) && s.place[o / 3] < 0;
}

/// Numbers the corners of the domain: a vertex where its triangles form several fans, a pinch of the
/// border, is one for each.
void number_corners(Solver& s) {
  s.vertex.clear();
  s.corners.assign(s.domain.size(), {-1, -1, -1});
  for (std::size_t i = 0; i < s.domain.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      if (s.corners[i][k] >= 0) continue;
      const int first = 3 * s.domain[i] + k, number = s.vertex.size();
      s.vertex.push_back(s.disk.tris[s.domain[i]][k]);
      // half-edges from this vertex: counter-clockwise to the end of the fan or all around, then clockwise
      int h = first;
      do {
        s.corners[s.place[h / 3]][h % 3] = number;
        h = s.disk.opposite[prev(h)];
      } while (h >= 0 && s.place[h / 3] >= 0 && h != first);
      if (h == first) continue;
      for (h = s.disk.opposite[first]; h >= 0 && s.place[h / 3] >= 0; h = s.disk.opposite[h]) {
        h = next(h);
        s.corners[s.place[h / 3]][h % 3] = number;
      }
    }
}

Vec2 image_center(const Solver& s, int i) {
  return (1. / 3) * (s.uv[s.corners[i][0]] + s.uv[s.corners[i][1]] + s.uv[s.corners[i][2]]);
}

void map(Solver& s, const Pending& set) {
  number_corners(s);
  std::vector<double> weights(3 * s.domain.size());
  for (std::size_t i = 0; i < s.domain.size(); ++i)
    std::copy_n(s.disk.weights.begin() + 3 * s.domain[i], 3, weights.begin() + 3 * i);
  s.fixed.assign(s.vertex.size(), 0);
  s.uv.assign(s.vertex.size(), {});
  for (std::size_t i = 0; i < set.loop.size(); ++i) {
    const int h = set.loop[i], l = s.corners[s.place[h / 3]][h % 3];
    s.fixed[l] = 1;
    s.uv[l] = {std::cos(set.angle[i]), std::sin(set.angle[i])};
  }
  solve_dirichlet(s.corners, weights, s.fixed, s.uv);
}

/// Area of a triangle taken as equilateral on its longest side: a needle that is thin on the surface already
/// is not one that lies deep.
template <class Point>
double blunt_area(Point a, Point b, Point c) {
  return std::sqrt(3.) / 4 * std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
}

/// Marks what is too small, by a logarithm averaged over some rings of triangles: the border of what is
/// withdrawn should not be ragged.
void find_small(Solver& s, double stretch_limit) {
  std::vector<double> depth(s.domain.size()), sum(s.vertex.size());
  std::vector<int> count(s.vertex.size());
  for (std::size_t i = 0; i < s.domain.size(); ++i) {
    const Tri &v = s.disk.tris[s.domain[i]], &l = s.corners[i];
    const double size = blunt_area(s.disk.points[v[0]], s.disk.points[v[1]], s.disk.points[v[2]]);
    const double image = blunt_area(s.uv[l[0]], s.uv[l[1]], s.uv[l[2]]);
    depth[i] = std::log(std::max(least_area, stretch_limit * size) / std::max(image, 1e-300));
  }
  for (int round = 0; round < 4; ++round) {
    std::fill(sum.begin(), sum.end(), 0);
    std::fill(count.begin(), count.end(), 0);
    for (std::size_t i = 0; i < s.domain.size(); ++i)
      for (int l : s.corners[i]) {
        sum[l] += depth[i];
        count[l]++;
      }
    for (std::size_t i = 0; i < s.domain.size(); ++i) {
      depth[i] = 0;
      for (int l : s.corners[i]) depth[i] += sum[l] / count[l] / 3;
    }
  }
  s.small.resize(s.domain.size());
  for (std::size_t i = 0; i < s.domain.size(); ++i) s.small[i] = depth[i] > 0;
}

/// A hole is resolved by one level as a whole: where one triangle of its fan is good, all are.
void keep_fans_whole(Solver& s) {
  for (std::size_t f = 0; f + 1 < s.disk.fan_begin.size(); ++f) {
    bool whole = true, good = false;
    for (int t = s.disk.fan_begin[f]; t < s.disk.fan_begin[f + 1]; ++t) {
      if (s.place[t] < 0)
        whole = false;
      else
        good |= !s.small[s.place[t]];
    }
    for (int t = s.disk.fan_begin[f]; t < s.disk.fan_begin[f + 1]; ++t)
      if (s.place[t] >= 0) s.small[s.place[t]] = !(whole && good);
  }
}

/// Does the good region reach where the domain was cut off?
bool good_at_the_end(const Solver& s) {
  for (std::size_t i = 0; i < s.domain.size(); ++i)
    if (!s.small[i])
      for (int h = 3 * s.domain[i]; h < 3 * s.domain[i] + 3; ++h)
        if (beyond(s, h)) return true;
  return false;
}

template <class Visit>
void neighbors(const Solver& s, int i, Visit visit) {
  for (int h = 3 * s.domain[i]; h < 3 * s.domain[i] + 3; ++h)
    if (s.disk.opposite[h] >= 0 && s.place[s.disk.opposite[h] / 3] >= 0)
      visit(s.place[s.disk.opposite[h] / 3]);
}

/// Good triangles behind small ones (coarse ones behind fine ones) go with the set that encloses them: then
/// every set is a disk.
void keep_what_touches_the_border(Solver& s) {
  std::vector<int> stack;
  std::vector<char> keep(s.domain.size(), 0);
  for (std::size_t i = 0; i < s.domain.size(); ++i)
    if (!s.small[i] && (s.fixed[s.corners[i][0]] || s.fixed[s.corners[i][1]] || s.fixed[s.corners[i][2]])) {
      keep[i] = 1;
      stack.push_back(i);
    }
  while (!stack.empty()) {
    int i = take_last(stack);
    neighbors(s, i, [&](int n) {
      if (s.small[n] || keep[n]) return;
      keep[n] = 1;
      stack.push_back(n);
    });
  }
  for (std::size_t i = 0; i < s.domain.size(); ++i) s.small[i] = !keep[i];
}

/// Sets that meet beyond the domain are one.
int join_beyond(Solver& s, std::vector<int>& set_of, int n_sets) {
  std::vector<int> to(n_sets, -1), stack;
  const int stamp = s.levels.size();
  int n = 0;
  for (std::size_t i = 0; i < s.domain.size(); ++i) {
    if (set_of[i] < 0 || s.visited[s.domain[i]] == stamp) continue;
    int number = to[set_of[i]] >= 0 ? to[set_of[i]] : n++;
    s.visited[s.domain[i]] = stamp;
    stack.push_back(s.domain[i]);
    while (!stack.empty()) {
      int t = take_last(stack);
      if (s.place[t] >= 0) to[set_of[s.place[t]]] = number;
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        int o = s.disk.opposite[h] < 0 ? -1 : s.disk.opposite[h] / 3;
        if (!unresolved(s, o) || s.visited[o] == stamp || (s.place[o] >= 0 && set_of[s.place[o]] < 0))
          continue;
        s.visited[o] = stamp;
        stack.push_back(o);
      }
    }
  }
  for (int& set : set_of)
    if (set >= 0) set = to[set];
  return n;
}

/// Numbers the edge-connected sets of small triangles; sets that are too small to matter become good.
int find_sets(Solver& s, std::vector<int>& set_of, bool truncated) {
  set_of.assign(s.domain.size(), -1);
  std::vector<int> stack, members;
  std::vector<char> open;  // does the set go on beyond the domain?
  int n_sets = 0;
  for (std::size_t first = 0; first < s.domain.size(); ++first) {
    if (!s.small[first] || set_of[first] >= 0) continue;
    members.assign(1, first);
    set_of[first] = n_sets;
    bool reaches_beyond = false;
    for (std::size_t m = 0; m < members.size(); ++m) {
      int t = s.domain[members[m]];
      for (int h = 3 * t; truncated && h < 3 * t + 3; ++h) reaches_beyond |= beyond(s, h);
      neighbors(s, members[m], [&](int n) {
        if (!s.small[n] || set_of[n] >= 0) return;
        set_of[n] = n_sets;
        members.push_back(n);
      });
    }
    if (!reaches_beyond && members.size() < least_set) {
      for (int m : members) {
        s.small[m] = 0;
        set_of[m] = -1;
      }
      continue;
    }
    open.push_back(reaches_beyond);
    ++n_sets;
  }
  if (std::count(open.begin(), open.end(), 1) > 1) n_sets = join_beyond(s, set_of, n_sets);
  return n_sets;
}

/// Where most of a set's surface is: a point that everything deep inside collapses to.
Vec2 center_of(const Solver& s, const std::vector<int>& set_of, int set) {
  Vec2 sum;
  double total = 0;
  for (std::size_t i = 0; i < s.domain.size(); ++i) {
    if (set_of[i] != set) continue;
    const Tri& c = s.disk.tris[s.domain[i]];
    const double area = norm(area_vector(s.disk.points[c[0]], s.disk.points[c[1]], s.disk.points[c[2]]));
    total += area;
    sum = sum + area * image_center(s, i);
  }
  return (1 / total) * sum;
}

Level level_of(Solver& s, const Pending& set, int self) {
  Level level;
  level.parent = set.parent;
  level.center = set.center;
  level.border = set.border;
  level.angle = set.angle;
  std::vector<int> to(s.vertex.size(), -1);
  for (std::size_t i = 0; i < s.domain.size(); ++i) {
    if (s.small[i]) continue;
    s.owner[s.domain[i]] = self;
    level.tris.push_back(s.domain[i]);
    Tri c;
    for (int k = 0; k < 3; ++k) {
      int& place = to[s.corners[i][k]];
      if (place < 0) {
        place = level.vertex.size();
        level.vertex.push_back(s.vertex[s.corners[i][k]]);
        level.uv.push_back(s.uv[s.corners[i][k]]);
        s.known[level.vertex.back()] = 1;
        if (level.vertex.back() >= s.disk.part_vertices) level.holes.push_back(place);
      }
      c[k] = place;
    }
    level.corners.push_back(c);
  }
  return level;
}

/// The border's vertices on the own circle: in the direction in which the parent's disk shows them from the
/// center, so that lines go straight on; where the border is ragged and turns back, half way between the
/// largest angle before and the smallest one after.
std::vector<double> angles_around(const Solver& s, const Pending& set) {
  const std::size_t n = set.loop.size();
  std::vector<double> angle(3 * n + 1), arc(n + 1, 0);
  angle[0] = 0;
  for (std::size_t i = 0; i < 3 * n; ++i) {
    const Vec2 a = set.border[i % n] - set.center, b = set.border[(i + 1) % n] - set.center;
    angle[i + 1] = angle[i] + std::atan2(cross(a, b), dot(a, b));
  }
  for (std::size_t i = 0; i < n; ++i) arc[i + 1] = arc[i] + edge_length(s.disk, set.loop[i]);
  const bool winds_once = std::abs(angle[n] - 2 * pi) < 1;
  std::vector<double> before = angle, after = angle;
  for (std::size_t i = 1; i < angle.size(); ++i) before[i] = std::max(before[i], before[i - 1]);
  for (std::size_t i = angle.size() - 1; i-- > 0;) after[i] = std::min(after[i], after[i + 1]);
  // with a share of the length, so that no two coincide
  const double share = winds_once ? 0.1 : 1;
  std::vector<double> out(n);
  for (std::size_t i = 0; i < n; ++i)
    out[i] = (1 - share) * (before[n + i] + after[n + i] - before[n] - after[n]) / 2 +
             share * 2 * pi * arc[i] / arc[n];
  return out;
}

void withdraw(Solver& s, int set, const std::vector<int>& set_of, int parent) {
  Pending child;
  child.parent = parent;
  double longest = 0;
  int deepest = -1;
  for (std::size_t i = 0; i < s.domain.size(); ++i) {
    if (set_of[i] != set) continue;
    const int t = s.domain[i];
    if (deepest < 0 || s.distance[i] > s.distance[deepest]) deepest = i;
    if (touches_known(s, t)) child.seeds.push_back(t);
    for (int h = 3 * t; h < 3 * t + 3; ++h)
      if (on_border(s, h) && !s.passed[h]) {
        const std::vector<int> loop = border_loop(s, h);
        for (int e : loop) s.passed[e] = 1;
        if (const double length = loop_length(s.disk, loop); length > longest)
          longest = length, child.loop = loop;
      }
  }
  for (int t : child.seeds) s.passed[3 * t] = s.passed[3 * t + 1] = s.passed[3 * t + 2] = 0;
  for (int h : child.loop) child.border.push_back(s.uv[s.corners[s.place[h / 3]][h % 3]]);
  child.center = center_of(s, set_of, set);
  if (!encloses(child.border, child.center)) child.center = image_center(s, deepest);
  child.angle = angles_around(s, child);
  s.queue.push_back(std::move(child));
}

void solve(Solver& s, const Pending& set) {
  const int self = s.levels.size();
  const double scale = 2 * pi / loop_length(s.disk, set.loop);
  const double stretch_limit = least_stretch * scale * scale;
  double depth = depth_in_diameters * loop_length(s.disk, set.loop) / pi;
  bool truncated;
  for (;; depth *= 2) {
    truncated = gather(s, set, depth);
    // a small remainder is cheaper solved along than found to be needed
    const std::size_t most = s.domain.size() + s.domain.size() / 4;
    if (truncated && gather(s, set, 1e300, most))
      gather(s, set, depth);
    else
      truncated = false;
    map(s, set);
    find_small(s, stretch_limit);
    keep_fans_whole(s);
    if (!truncated || !good_at_the_end(s)) break;
  }
  keep_what_touches_the_border(s);
  std::vector<int> set_of;
  int n_sets = find_sets(s, set_of, truncated);
  if (std::count(s.small.begin(), s.small.end(), 0) == 0) {
    // nothing left to resolve in this frame that another would resolve better: take the level as it is
    gather(s, set, 1e300);
    map(s, set);
    s.small.assign(s.domain.size(), 0);
    n_sets = 0;
  }
  if (set.parent >= 0) s.levels[set.parent].children.push_back(self);
  s.levels.push_back(level_of(s, set, self));
  for (int i = 0; i < n_sets; ++i) withdraw(s, i, set_of, self);
  for (int t : s.domain) s.place[t] = -1;
  s.domain.clear();
}

}  // namespace

Vec2 middle_of(const FilledDisk& disk, const Level& level) {
  Vec2 sum;
  double total = 0;
  for (std::size_t i = 0; i < level.tris.size(); ++i) {
    const Tri& t = disk.tris[level.tris[i]];
    const double area = norm(area_vector(disk.points[t[0]], disk.points[t[1]], disk.points[t[2]]));
    total += area;
    for (int v : level.corners[i]) sum = sum + (area / 3) * level.uv[v];
  }
  return (1 / total) * sum;
}

std::vector<Level> laplace_levels(const FilledDisk& disk) {
  Solver s(disk);
  s.queue.push_back(root(s));
  for (std::size_t i = 0; i < s.queue.size(); ++i) {
    if (i > max_levels) throw GoalMissed("more than " + std::to_string(max_levels) + " levels of maps");
    const Pending set = std::move(s.queue[i]);
    solve(s, set);
  }
  return std::move(s.levels);
}

}  // namespace meshpipe
