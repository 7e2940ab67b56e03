// SPDX-License-Identifier: BSD-3-Clause
#include "lib/levels.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lib/error.h"
#include "lib/sparse.h"
#include "lib/topology.h"

namespace meshpipe {
namespace {

constexpr double pi = std::numbers::pi;
// a level resolves about four diameters of a tube (a factor e^-2 in length each); two more make a margin for
// the natural condition where the system is cut off
constexpr double depth_in_diameters = 6;
// triangles this much smaller in area against the surface than at the border are withdrawn too, however
// coarse the mesh: a factor e^-4 for each diameter of a tube, so four of them
constexpr double least_stretch = 1e-7;
constexpr std::size_t least_domain = 2000;
constexpr std::size_t max_levels = 100000;

/// A set of withdrawn triangles that waits for its own level.
struct Pending {
  int parent = -1;
  Vec2 centre;
  std::vector<int> seeds;     // triangles that touch what is resolved
  std::vector<int> loop;      // half-edges of its border, in order
  std::vector<Vec2> border;   // their origins in the parent's disk
  std::vector<double> angle;  // and on the own circle
};

class LevelSolver {
 public:
  LevelSolver(const FilledDisk& disk, double min_area, int min_set)
      : disk_(disk),
        min_area_(min_area),
        min_set_(min_set),
        owner_(disk.tris.size(), -1),
        place_(disk.tris.size(), -1),
        visited_(disk.tris.size(), -1),
        known_(disk.points.size(), 0),
        passed_(3 * disk.tris.size(), 0),
        barycentre_(disk.tris.size()) {
    for (std::size_t t = 0; t < disk.tris.size(); t++) {
      const Tri& c = disk.tris[t];
      barycentre_[t] = (1. / 3) * (disk.points[c[0]] + disk.points[c[1]] + disk.points[c[2]]);
    }
  }

  std::vector<Level> run() {
    queue_.push_back(root());
    for (std::size_t i = 0; i < queue_.size(); i++) {
      if (i > max_levels) throw GoalMissed("more than " + std::to_string(max_levels) + " levels of maps");
      Pending set = std::move(queue_[i]);
      solve(set);
    }
    return std::move(levels_);
  }

 private:
  Pending root() {
    Pending set;
    for (std::size_t h = 0; h < disk_.opposite.size(); h++)
      if (disk_.opposite[h] < 0) {
        set.loop = border_loop(h);
        break;
      }
    const double total = border_length(set);
    double at = 0;
    for (int h : set.loop) {
      set.angle.push_back(2 * pi * at / total);
      at += length(h);
    }
    for (int v : disk_.rim) known_[v] = 1;
    for (std::size_t t = 0; t < disk_.tris.size(); t++)
      if (touches_known(t)) set.seeds.push_back(t);
    return set;
  }

  bool touches_known(int t) const {
    const Tri& c = disk_.tris[t];
    return known_[c[0]] || known_[c[1]] || known_[c[2]];
  }
  bool unresolved(int t) const { return t >= 0 && owner_[t] < 0; }

  bool on_border(int h) const { return disk_.opposite[h] < 0 || owner_[disk_.opposite[h] / 3] >= 0; }

  /// The border of the unresolved set to the left of h, from h on.
  std::vector<int> border_loop(int h) const {
    std::vector<int> loop;
    int e = h;
    do {
      loop.push_back(e);
      for (e = next(e); !on_border(e);) e = next(disk_.opposite[e]);
    } while (e != h);
    return loop;
  }

  double length(int h) const {
    return norm(disk_.points[target(disk_.tris, h)] - disk_.points[origin(disk_.tris, h)]);
  }
  double border_length(const Pending& set) const {
    double sum = 0;
    for (int h : set.loop) sum += length(h);
    return sum;
  }

  /// Gathers domain_: the triangles of the set within `depth` of its border; breadth first, so distances are
  /// those of the tree: an upper bound. Gives up beyond `most`. Returns whether some were left out.
  bool gather(const Pending& set, double depth, std::size_t most = SIZE_MAX) {
    for (int t : domain_) place_[t] = -1;
    domain_.clear();
    distance_.clear();
    for (int t : set.seeds) {
      place_[t] = domain_.size();
      domain_.push_back(t);
      distance_.push_back(0);
    }
    bool truncated = false;
    for (std::size_t i = 0; i < domain_.size(); i++) {
      if (domain_.size() > most) return true;
      int t = domain_[i];
      for (int h = 3 * t; h < 3 * t + 3; h++) {
        int n = disk_.opposite[h] < 0 ? -1 : disk_.opposite[h] / 3;
        if (!unresolved(n) || place_[n] >= 0) continue;
        double d = distance_[i] + norm(barycentre_[n] - barycentre_[t]);
        if (d > depth && domain_.size() > least_domain) {
          truncated = true;
          continue;
        }
        place_[n] = domain_.size();
        domain_.push_back(n);
        distance_.push_back(d);
      }
    }
    return truncated;
  }

  bool beyond(int h) const {
    int o = disk_.opposite[h];
    return o >= 0 && unresolved(o / 3) && place_[o / 3] < 0;
  }

  void solve(const Pending& set) {
    const int self = levels_.size();
    const double area_limit = min_area_ * pi, scale = 2 * pi / border_length(set);
    const double stretch_limit = least_stretch * scale * scale;
    double depth = depth_in_diameters * border_length(set) / pi;
    bool truncated;
    for (;; depth *= 2) {
      truncated = gather(set, depth);
      // a small remainder is cheaper solved along than found to be needed
      const std::size_t most = domain_.size() + domain_.size() / 4;
      if (truncated && gather(set, 1e300, most))
        gather(set, depth);
      else
        truncated = false;
      map(set);
      find_small(area_limit, stretch_limit);
      keep_fans_whole();
      if (!truncated || !good_at_the_end()) break;
    }
    keep_what_touches_the_border();
    std::vector<int> set_of;
    int n_sets = find_sets(set_of, truncated);
    constexpr int most_rounds = 8;
    for (int round = 0; round < most_rounds && withdraw_holes(set_of, n_sets); round++) {
      keep_fans_whole();
      keep_what_touches_the_border();
      n_sets = find_sets(set_of, truncated);
    }
    if (std::count(small_.begin(), small_.end(), 0) == 0) {
      // nothing left to resolve in this frame that another would resolve better: take the level as it is
      gather(set, 1e300);
      map(set);
      small_.assign(domain_.size(), 0);
      n_sets = 0;
    }
    if (set.parent >= 0) levels_[set.parent].children.push_back(self);
    levels_.push_back(level_of(set, self));
    for (int s = 0; s < n_sets; s++) withdraw(s, set_of, self);
    for (int t : domain_) place_[t] = -1;
    domain_.clear();
  }

  /// Numbers the corners of the domain: a vertex where its triangles form several fans, a pinch of the
  /// border, is one for each.
  void number_corners() {
    vertex_.clear();
    corners_.assign(domain_.size(), {-1, -1, -1});
    for (std::size_t i = 0; i < domain_.size(); i++)
      for (int k = 0; k < 3; k++) {
        if (corners_[i][k] >= 0) continue;
        const int first = 3 * domain_[i] + k, number = vertex_.size();
        vertex_.push_back(disk_.tris[domain_[i]][k]);
        // half-edges from this vertex: counter-clockwise to the end of the fan or round, then clockwise
        int h = first;
        do {
          corners_[place_[h / 3]][h % 3] = number;
          h = disk_.opposite[prev(h)];
        } while (h >= 0 && place_[h / 3] >= 0 && h != first);
        if (h == first) continue;
        for (h = disk_.opposite[first]; h >= 0 && place_[h / 3] >= 0; h = disk_.opposite[h]) {
          h = next(h);
          corners_[place_[h / 3]][h % 3] = number;
        }
      }
  }

  void map(const Pending& set) {
    number_corners();
    std::vector<double> weights(3 * domain_.size());
    for (std::size_t i = 0; i < domain_.size(); i++)
      std::copy_n(disk_.weights.begin() + 3 * domain_[i], 3, weights.begin() + 3 * i);
    fixed_.assign(vertex_.size(), 0);
    uv_.assign(vertex_.size(), {});
    for (std::size_t i = 0; i < set.loop.size(); i++) {
      const int h = set.loop[i], l = corners_[place_[h / 3]][h % 3];
      fixed_[l] = 1;
      uv_[l] = {std::cos(set.angle[i]), std::sin(set.angle[i])};
    }
    solve_dirichlet(corners_, weights, fixed_, uv_);
  }

  /// Area of the image of triangle i of the domain, taken as equilateral on its longest side: a needle that
  /// is thin on the surface already is not one that lies deep.
  double image(int i) const {
    Vec2 a = uv_[corners_[i][0]], b = uv_[corners_[i][1]], c = uv_[corners_[i][2]];
    return std::sqrt(3.) / 4 * std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
  }

  /// The same of triangle t itself.
  double size(int t) const {
    const Vec3 a = disk_.points[disk_.tris[t][0]], b = disk_.points[disk_.tris[t][1]],
               c = disk_.points[disk_.tris[t][2]];
    return std::sqrt(3.) / 4 * std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
  }

  /// Marks what is too small, by a logarithm averaged over some rings of triangles: the border of what is
  /// withdrawn should not be ragged.
  void find_small(double area_limit, double stretch_limit) {
    std::vector<double> depth(domain_.size()), sum(vertex_.size());
    std::vector<int> count(vertex_.size());
    for (std::size_t i = 0; i < domain_.size(); i++)
      depth[i] =
          std::log(std::max(area_limit, stretch_limit * size(domain_[i])) / std::max(image(i), 1e-300));
    for (int round = 0; round < 4; round++) {
      std::fill(sum.begin(), sum.end(), 0);
      std::fill(count.begin(), count.end(), 0);
      for (std::size_t i = 0; i < domain_.size(); i++)
        for (int l : corners_[i]) {
          sum[l] += depth[i];
          count[l]++;
        }
      for (std::size_t i = 0; i < domain_.size(); i++) {
        depth[i] = 0;
        for (int l : corners_[i]) depth[i] += sum[l] / count[l] / 3;
      }
    }
    small_.resize(domain_.size());
    for (std::size_t i = 0; i < domain_.size(); i++) small_[i] = depth[i] > 0;
  }

  /// A hole is resolved by one level as a whole: where one triangle of its fan is good, all are.
  void keep_fans_whole() {
    for (std::size_t f = 0; f + 1 < disk_.fan_begin.size(); f++) {
      bool whole = true, good = false;
      for (int t = disk_.fan_begin[f]; t < disk_.fan_begin[f + 1]; t++) {
        if (place_[t] < 0)
          whole = false;
        else
          good |= !small_[place_[t]];
      }
      for (int t = disk_.fan_begin[f]; t < disk_.fan_begin[f + 1]; t++)
        if (place_[t] >= 0) small_[place_[t]] = !(whole && good);
    }
  }

  /// Does the good region reach where the domain was cut off?
  bool good_at_the_end() const {
    for (std::size_t i = 0; i < domain_.size(); i++)
      if (!small_[i])
        for (int h = 3 * domain_[i]; h < 3 * domain_[i] + 3; h++)
          if (beyond(h)) return true;
    return false;
  }

  template <class Visit>
  void neighbours(int i, Visit visit) const {
    for (int h = 3 * domain_[i]; h < 3 * domain_[i] + 3; h++)
      if (disk_.opposite[h] >= 0 && place_[disk_.opposite[h] / 3] >= 0) visit(place_[disk_.opposite[h] / 3]);
  }

  /// Good triangles behind small ones (coarse ones behind fine ones) go with the set that encloses them: then
  /// every set is a disk.
  void keep_what_touches_the_border() {
    std::vector<int> stack;
    std::vector<char> keep(domain_.size(), 0);
    for (std::size_t i = 0; i < domain_.size(); i++)
      if (!small_[i] && (fixed_[corners_[i][0]] || fixed_[corners_[i][1]] || fixed_[corners_[i][2]])) {
        keep[i] = 1;
        stack.push_back(i);
      }
    while (!stack.empty()) {
      int i = stack.back();
      stack.pop_back();
      neighbours(i, [&](int n) {
        if (small_[n] || keep[n]) return;
        keep[n] = 1;
        stack.push_back(n);
      });
    }
    for (std::size_t i = 0; i < domain_.size(); i++) small_[i] = !keep[i];
  }

  /// Numbers the edge-connected sets of small triangles; sets that are too small to matter become good.
  int find_sets(std::vector<int>& set_of, bool truncated) {
    set_of.assign(domain_.size(), -1);
    std::vector<int> stack, members;
    std::vector<char> open;  // does the set go on beyond the domain?
    int n_sets = 0;
    for (std::size_t first = 0; first < domain_.size(); first++) {
      if (!small_[first] || set_of[first] >= 0) continue;
      members.assign(1, first);
      set_of[first] = n_sets;
      bool reaches_beyond = false;
      for (std::size_t m = 0; m < members.size(); m++) {
        int t = domain_[members[m]];
        for (int h = 3 * t; truncated && h < 3 * t + 3; h++) reaches_beyond |= beyond(h);
        neighbours(members[m], [&](int n) {
          if (!small_[n] || set_of[n] >= 0) return;
          set_of[n] = n_sets;
          members.push_back(n);
        });
      }
      if (!reaches_beyond && static_cast<int>(members.size()) < min_set_) {
        for (int m : members) {
          small_[m] = 0;
          set_of[m] = -1;
        }
        continue;
      }
      open.push_back(reaches_beyond);
      n_sets++;
    }
    if (std::count(open.begin(), open.end(), 1) > 1) n_sets = join_beyond(set_of, n_sets);
    return n_sets;
  }

  /// Sets that meet beyond the domain are one.
  int join_beyond(std::vector<int>& set_of, int n_sets) {
    std::vector<int> to(n_sets, -1), stack;
    const int stamp = levels_.size();
    int n = 0;
    for (std::size_t i = 0; i < domain_.size(); i++) {
      if (set_of[i] < 0 || visited_[domain_[i]] == stamp) continue;
      int number = to[set_of[i]] >= 0 ? to[set_of[i]] : n++;
      visited_[domain_[i]] = stamp;
      stack.push_back(domain_[i]);
      while (!stack.empty()) {
        int t = stack.back();
        stack.pop_back();
        if (place_[t] >= 0) to[set_of[place_[t]]] = number;
        for (int h = 3 * t; h < 3 * t + 3; h++) {
          int o = disk_.opposite[h] < 0 ? -1 : disk_.opposite[h] / 3;
          if (!unresolved(o) || visited_[o] == stamp || (place_[o] >= 0 && set_of[place_[o]] < 0)) continue;
          visited_[o] = stamp;
          stack.push_back(o);
        }
      }
    }
    for (int& s : set_of)
      if (s >= 0) s = to[s];
    return n;
  }

  /// Where most of a set's surface is: a point that everything deep inside collapses to.
  Vec2 centre_of(const std::vector<int>& set_of, int s) const {
    Vec2 sum;
    double total = 0;
    for (std::size_t i = 0; i < domain_.size(); i++) {
      if (set_of[i] != s) continue;
      const Tri& c = disk_.tris[domain_[i]];
      const double area = norm(area_vector(disk_.points[c[0]], disk_.points[c[1]], disk_.points[c[2]]));
      total += area;
      sum = sum + area * image_centre(i);
    }
    return (1 / total) * sum;
  }

  /// A hole close to a set is hard to pass through on the way to it: makes the neighbourhood of such holes
  /// small, so that both come apart in a level of their own. Returns whether there were any.
  bool withdraw_holes(const std::vector<int>& set_of, int n_sets) {
    std::vector<Vec2> centres(n_sets);
    for (int s = 0; s < n_sets; s++) centres[s] = centre_of(set_of, s);
    bool any = false;
    for (std::size_t f = 0; f + 1 < disk_.fan_begin.size(); f++) {
      const int begin = disk_.fan_begin[f], end = disk_.fan_begin[f + 1];
      // only a fan that lies in the domain as a whole and is not withdrawn already
      if (std::any_of(place_.begin() + begin, place_.begin() + end,
                      [&](int i) { return i < 0 || small_[i]; }))
        continue;
      const Vec2 centre = uv_[corners_[place_[begin]][2]];
      double r = 0;
      for (int t = begin; t < end; t++) r = std::max(r, norm(uv_[corners_[place_[t]][0]] - centre));
      if (r > 0.2) continue;
      if (std::none_of(centres.begin(), centres.end(), [&](Vec2 c) { return norm(c - centre) < 2 * r; }))
        continue;
      for (std::size_t i = 0; i < domain_.size(); i++)
        if (norm(image_centre(i) - centre) < 2 * r) small_[i] = 1;
      for (int t = begin; t < end; t++) small_[place_[t]] = 1;
      any = true;
    }
    return any;
  }

  Level level_of(const Pending& set, int self) {
    Level level;
    level.parent = set.parent;
    level.centre = set.centre;
    level.border = set.border;
    level.angle = set.angle;
    std::vector<int> to(vertex_.size(), -1);
    for (std::size_t i = 0; i < domain_.size(); i++) {
      if (small_[i]) continue;
      owner_[domain_[i]] = self;
      level.tris.push_back(domain_[i]);
      Tri c;
      for (int k = 0; k < 3; k++) {
        int& place = to[corners_[i][k]];
        if (place < 0) {
          place = level.vertex.size();
          level.vertex.push_back(vertex_[corners_[i][k]]);
          level.uv.push_back(uv_[corners_[i][k]]);
          known_[level.vertex.back()] = 1;
          if (level.vertex.back() >= disk_.part_vertices) level.holes.push_back(place);
        }
        c[k] = place;
      }
      level.corners.push_back(c);
    }
    return level;
  }

  void withdraw(int s, const std::vector<int>& set_of, int parent) {
    Pending child;
    child.parent = parent;
    double longest = 0;
    int deepest = -1;
    std::vector<int> loop;
    for (std::size_t i = 0; i < domain_.size(); i++) {
      if (set_of[i] != s) continue;
      const int t = domain_[i];
      if (deepest < 0 || distance_[i] > distance_[deepest]) deepest = i;
      if (touches_known(t)) child.seeds.push_back(t);
      for (int h = 3 * t; h < 3 * t + 3; h++)
        if (on_border(h) && !passed_[h]) {
          loop = border_loop(h);
          double sum = 0;
          for (int e : loop) {
            sum += length(e);
            passed_[e] = 1;
          }
          if (sum > longest) {
            longest = sum;
            child.loop = loop;
          }
        }
    }
    for (int t : child.seeds) passed_[3 * t] = passed_[3 * t + 1] = passed_[3 * t + 2] = 0;
    for (int h : child.loop) child.border.push_back(uv_[corners_[place_[h / 3]][h % 3]]);
    child.centre = centre_of(set_of, s);
    if (!encloses(child.border, child.centre)) child.centre = image_centre(deepest);
    child.angle = angles_around(child);
    queue_.push_back(std::move(child));
  }

  /// The border's vertices on the own circle: in the direction in which the parent's disk shows them from the
  /// centre, so that lines go straight on; where the border is ragged and turns back, half way between the
  /// largest angle before and the smallest one after.
  std::vector<double> angles_around(const Pending& set) const {
    const std::size_t n = set.loop.size();
    std::vector<double> angle(3 * n + 1), arc(n + 1, 0);
    angle[0] = 0;
    for (std::size_t i = 0; i < 3 * n; i++) {
      const Vec2 a = set.border[i % n] - set.centre, b = set.border[(i + 1) % n] - set.centre;
      angle[i + 1] = angle[i] + std::atan2(cross(a, b), dot(a, b));
    }
    for (std::size_t i = 0; i < n; i++) arc[i + 1] = arc[i] + length(set.loop[i]);
    const bool winds_once = std::abs(angle[n] - 2 * pi) < 1;
    std::vector<double> before = angle, after = angle;
    for (std::size_t i = 1; i < angle.size(); i++) before[i] = std::max(before[i], before[i - 1]);
    for (std::size_t i = angle.size() - 1; i-- > 0;) after[i] = std::min(after[i], after[i + 1]);
    // with a share of the length, so that no two coincide
    const double share = winds_once ? 0.1 : 1;
    std::vector<double> out(n);
    for (std::size_t i = 0; i < n; i++)
      out[i] = (1 - share) * (before[n + i] + after[n + i] - before[n] - after[n]) / 2 +
               share * 2 * pi * arc[i] / arc[n];
    return out;
  }

  Vec2 image_centre(int i) const {
    return (1. / 3) * (uv_[corners_[i][0]] + uv_[corners_[i][1]] + uv_[corners_[i][2]]);
  }

  const FilledDisk& disk_;
  const double min_area_;
  const int min_set_;
  std::vector<int> owner_;  // level that resolves the triangle, or -1
  std::vector<int> place_;  // in the domain of the level at work, or -1
  std::vector<int> visited_;
  std::vector<char> known_;   // vertex of a resolved triangle or on the rim
  std::vector<char> passed_;  // half-edges of the borders of sets
  std::vector<Vec3> barycentre_;
  std::vector<Pending> queue_;
  std::vector<Level> levels_;
  // the level at work
  std::vector<int> domain_, vertex_;
  std::vector<double> distance_;
  std::vector<Tri> corners_;
  std::vector<char> fixed_, small_;
  std::vector<Vec2> uv_;
};

}  // namespace

Vec2 middle_of(const FilledDisk& disk, const Level& level) {
  Vec2 sum;
  double total = 0;
  for (std::size_t i = 0; i < level.tris.size(); i++) {
    const Tri& t = disk.tris[level.tris[i]];
    const double area = norm(area_vector(disk.points[t[0]], disk.points[t[1]], disk.points[t[2]]));
    total += area;
    for (int v : level.corners[i]) sum = sum + (area / 3) * level.uv[v];
  }
  return (1 / total) * sum;
}

std::vector<Level> laplace_levels(const FilledDisk& disk, double min_area, int min_set) {
  return LevelSolver(disk, min_area, min_set).run();
}

}  // namespace meshpipe
