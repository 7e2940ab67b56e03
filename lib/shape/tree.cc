// SPDX-License-Identifier: BSD-3-Clause
// Bodies given by implicit functions: a plate with holes, and a branching tree of tubes.
#include <algorithm>
#include <numbers>

#include "lib/core/cut.h"
#include "lib/core/edit_mesh.h"
#include "lib/core/error.h"
#include "lib/core/intersect.h"
#include "lib/core/lists.h"
#include "lib/core/random.h"
#include "lib/core/spatial_order.h"
#include "lib/core/topology.h"
#include "lib/core/triangle_count.h"
#include "lib/shape/shape.h"

namespace meshpipe {
namespace {

using std::numbers::pi;

/// Smooth minimum: differs from the minimum where a and b differ by less than k, by k / 4 at most; |gradient|
/// <= 1.
double smooth_min(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0);
  return std::min(a, b) - h * h / (4 * k);
}

/// Collapses the shortest edges until about `count` triangles are left, without flipping a triangle. An edge
/// counts as longer by the smaller `fineness` of its ends' (at most 1).
void coarsen(Mesh& mesh, int count, const std::vector<float>& fineness) {
  EditMesh edit(mesh.tris, (int)mesh.points.size(), {});
  auto& p = mesh.points;
  auto keeps_normals = [&](int h) {
    const int v = edit.from(h), w = edit.to(h);
    bool good = true;
    edit.star(v, [&](int e) {
      const int a = edit.to(e), b = edit.apex(e);
      if (a == w || b == w) return;
      const Vec3 before = area_vector(p[v], p[a], p[b]), after = area_vector(p[w], p[a], p[b]);
      good = good && dot(before, after) > 0.5 * norm(before) * norm(after) && kappa(p[w], p[a], p[b]) > 0.1;
    });
    return good;
  };
  // every sweep takes the edges a little longer than before, so that the lengths stay even
  double shortest = 0.5 * size_for_count(total_area(mesh), edit.live);
  for (int sweep = 0; sweep < 40 && edit.live > count; ++sweep, shortest *= 1.1)
    for (int h = 0; h < (int)edit.opp.size() && edit.live > count; ++h) {
      if (edit.dead(h / 3)) continue;
      const double allowed = shortest * std::min(fineness[edit.from(h)], fineness[edit.to(h)]);
      if (norm(p[edit.from(h)] - p[edit.to(h)]) > allowed) continue;
      if (!edit.on_border(edit.from(h)) && edit.can_collapse(h, edit.from(h)) &&
          edit.valence(edit.from(h)) + edit.valence(edit.to(h)) < 13 && keeps_normals(h))
        edit.collapse(h, edit.from(h));
    }
  mesh.tris.clear();
  for (std::size_t t = 0; t < edit.tris.size(); ++t)
    if (!edit.dead((int)t)) mesh.tris.push_back(edit.tris[t]);
  p = rearranged(p, number_by_first_use(mesh.tris, p.size()));
}

/// Multiplies the fineness of vertices near pairs of triangles of a coarser mesh of the same surface.
void refine_at(const Mesh& coarse, const std::vector<std::pair<int, int>>& pairs, const Mesh& mesh,
               std::vector<float>& fineness) {
  constexpr double reach = 1.5;    // in longest edges of the pair: the triangles around it
  constexpr float gentler = 0.7f;  // twice as many triangles
  std::vector<char> near(mesh.points.size(), 0);
  for (auto [s, t] : pairs) {
    Vec3 middle;
    for (int i = 0; i < 3; ++i)
      middle = middle + 1.0 / 6 * (coarse.points[coarse.tris[s][i]] + coarse.points[coarse.tris[t][i]]);
    double size = 0;
    for (int u : {s, t})
      for (int i = 0; i < 3; ++i)
        size = std::max(size,
                        norm(coarse.points[coarse.tris[u][i]] - coarse.points[coarse.tris[u][(i + 1) % 3]]));
    for (std::size_t v = 0; v < near.size(); ++v)
      if (norm(mesh.points[v] - middle) < reach * size) near[v] = 1;
  }
  for (std::size_t v = 0; v < near.size(); ++v)
    if (near[v]) fineness[v] *= gentler;
}

/// Pairs of triangles that cross, and each triangle that faces inwards, where f falls, as one with itself.
std::vector<std::pair<int, int>> find_faults(const Mesh& mesh, const Implicit& f) {
  std::vector<std::pair<int, int>> faults = self_intersections(mesh);
  std::vector<char> folded(mesh.tris.size());
#pragma omp parallel for schedule(dynamic, 256)
  for (int t = 0; t < (int)folded.size(); ++t) {
    const Vec3 middle = centroid(mesh, t), normal = area_vector(mesh, t);
    const Vec3 step = 0.05 * std::sqrt(norm(normal)) * normalized(normal);
    folded[t] = f(middle + step) < f(middle - step);
  }
  for (int t = 0; t < (int)folded.size(); ++t)
    if (folded[t]) faults.push_back({t, t});
  return faults;
}

/// Marches f on the grid that is a quarter finer than `count` triangles need, but not coarser than `cell`,
/// takes the surplus away again, which makes the triangles even, and smooths.
/// Throws: GoalMissed if triangles cross, however small they are left in that place.
Mesh march_to_count(const Implicit& f, Vec3 lo, Vec3 hi, double cell, int count,
                    const std::function<void(Mesh&)>& finish) {
  const Vec3 size = hi - lo;
  const double longest = std::max({size.x, size.y, size.z});
  const int coarsest = (int)std::min(std::ceil(longest / cell), 1e9);  // which march refuses
  // triangles grow with the square of the cells along a side
  Mesh mesh = march(f, lo, hi, coarsest);
  const int n = (int)std::lround(coarsest * std::sqrt(1.5 * count / mesh.tris.size()));
  if (n > coarsest) mesh = march(f, lo, hi, n);
  finish(mesh);
  relax_on(mesh, f, 2);
  // triangles as large as a tube is wide may cross in its forks: there they are left smaller
  constexpr int most_rounds = 10, rounds_for_folds = 5;  // some are cut so, with all corners in the plane
  std::vector<float> fineness(mesh.points.size(), 1);
  for (int round = 0;; ++round) {
    Mesh coarse = mesh;
    coarsen(coarse, count, fineness);
    relax_on(coarse, f, 5);
    const auto faults = find_faults(coarse, f);
    const bool crosses =
        std::any_of(faults.begin(), faults.end(), [](auto p) { return p.first != p.second; });
    if (faults.empty() || (round >= rounds_for_folds && !crosses)) return coarse;
    if (round == most_rounds)
      throw GoalMissed(std::to_string(faults.size()) + " pairs of triangles cross; ask for more than " +
                       std::to_string(count) + " triangles");
    refine_at(coarse, faults, mesh, fineness);
  }
}

// ---- the tree

/// A cone with round ends: radius ra at a, rb at b.
struct Segment {
  Vec3 a, b;
  double ra, rb;
};

double distance(const Segment& s, Vec3 p) {
  const Vec3 axis = s.b - s.a;
  const double length = norm(axis), lean = (s.ra - s.rb) / length, straight = std::sqrt(1 - lean * lean);
  const Vec3 d = p - s.a;
  const double x = dot(d, axis) / length, y = std::sqrt(std::max(0.0, dot(d, d) - x * x));
  // along the cone's side, from the circle of contact with the first sphere
  const double along = x * straight - y * lean;
  if (along <= 0) return norm(d) - s.ra;
  if (along >= length * straight) return norm(p - s.b) - s.rb;
  return x * lean + y * straight - s.ra;
}

struct Branch {
  int first, count;  ///< segments
  double blend;      ///< width of the smooth union with branches that are wider
};

struct End {
  Vec3 at, outward;
  double radius;
};

/// Distance to the union of all branches. A coarse grid knows which branches matter where.
class Tree {
 public:
  static constexpr double widest = 0.225;  ///< blend of the trunk
  std::vector<Segment> segments;
  std::vector<Branch> branches;
  std::vector<End> ends;
  Vec3 lo, hi;

  /// Call it once all branches are there.
  void make_grid() {
    lo = {1e300, 1e300, 1e300};
    hi = {-1e300, -1e300, -1e300};
    for (const Segment& s : segments)
      for (auto [p, r] : {std::pair{s.a, s.ra}, std::pair{s.b, s.rb}})
        lo = lower(lo, p - Vec3{r, r, r}), hi = upper(hi, p + Vec3{r, r, r});
    const Vec3 size = hi - lo;
    const double longest = std::max({size.x, size.y, size.z}), margin = 0.02 * longest;
    lo = lo - Vec3{margin, margin, margin};
    hi = hi + Vec3{margin, margin, margin};
    h_ = (longest + 2 * margin) / 48;
    for (int k = 0; k < 3; ++k)
      n_[k] = (int)std::ceil((k == 0 ? hi.x - lo.x : k == 1 ? hi.y - lo.y : hi.z - lo.z) / h_);
    const int cells = n_[0] * n_[1] * n_[2];
    std::vector<std::vector<int>> near(cells);
#pragma omp parallel for schedule(dynamic, 64)
    for (int c = 0; c < cells; ++c) {
      const Vec3 center = lo + h_ * Vec3{c % n_[0] + 0.5, c / n_[0] % n_[1] + 0.5, c / (n_[0] * n_[1]) + 0.5};
      const double across = std::sqrt(3) * h_;
      std::vector<std::pair<double, int>> found;
      double closest = 1e300, blend = 0;
      for (const Branch& b : branches) {
        // its distance is at least that of the ball around it; no point of it counts beyond the widest blend
        const Segment &s = segments[b.first], &e = segments[b.first + b.count - 1];
        const double ball = norm(center - lerp(s.a, e.b, 0.5)) - norm(e.b - s.a) - s.ra;
        if (ball > closest + across + 2 * widest) continue;
        const double d = branch_distance(b, center);
        closest = std::min(closest, d);
        found.push_back({d, (int)(&b - branches.data())});
      }
      for (auto [d, b] : found)
        if (d <= closest + across) blend = std::max(blend, branches[b].blend);
      for (auto [d, b] : found)
        if (d <= closest + across + 2 * blend) near[c].push_back(b);
    }
    near_ = lists_of(cells, [&](auto use) {
      for (int c = 0; c < cells; ++c)
        for (int b : near[c]) use(c, b);
    });
  }

  double operator()(Vec3 p) const {
    auto cell = [&](double x, int k) { return std::clamp((int)(x / h_), 0, n_[k] - 1); };
    const Vec3 d = p - lo;
    const int c = (cell(d.z, 2) * n_[1] + cell(d.y, 1)) * n_[0] + cell(d.x, 0);
    double result = 1e300, closest = 1e300, blend = widest;
    for (int i : near_[c]) {
      const Branch& b = branches[i];
      const double distance = branch_distance(b, p);
      result = smooth_min(result, distance, std::min(blend, b.blend));
      if (distance < closest) {
        closest = distance;
        blend = b.blend;
      }
    }
    return result;
  }

 private:
  double branch_distance(const Branch& b, Vec3 p) const {
    double result = 1e300;
    for (int i = b.first; i < b.first + b.count; ++i) result = std::min(result, distance(segments[i], p));
    return result;
  }

  double h_ = 1;
  int n_[3] = {1, 1, 1};
  Lists near_;  ///< branches by cell
};

/// Grows the tree over leaves that are spread evenly over a disk, which stands for the directions within an
/// angle of the z axis (Lambert's equal-area map). A branch serves a set of leaves and is halved with it, so
/// branches stay within cones that do not meet.
class Grower {
 public:
  /// `length` is that of a branch over its radius.
  Grower(int leaves, double ratio, double length, int seed) : ratio_(ratio), length_(length), random_(seed) {
    spread_ = 2 * std::sin(0.5 * (0.1 + 0.08 * std::log2(leaves)));
    const double golden = pi * (3 - std::sqrt(5));
    for (int i = 0; i < leaves; ++i) {
      const double r = std::sqrt((i + 0.5) / leaves), turn = i * golden;
      leaves_.push_back({r * std::cos(turn), r * std::sin(turn)});
    }
  }

  Tree grow() {
    const Vec3 root{0, 0, 0}, up{0, 0, 1};
    std::vector<int> all = identity(leaves_.size());
    tree_.ends.push_back({root, {0, 0, -1}, 0.5});
    const double length = branch_length(0.5);
    const Vec3 fork = place(all, apex + length);
    add_branch({0, 0, -0.25}, fork, up, up, 0.5, 0.5 * 0.96);
    split(all, fork, up, apex + length, 0.5);
    return std::move(tree_);
  }

 private:
  static constexpr double apex = 2.5;  ///< how far below the inlet the cones of the branches meet

  double branch_length(double radius) { return length_ * radius * (0.85 + 0.3 * random_.uniform()); }

  Vec3 place(const std::vector<int>& set, double distance) {
    Vec2 m;
    for (int i : set) m = m + leaves_[i];
    m = 1.0 / set.size() * m;
    const double wobble = 0.12 * std::sqrt((double)set.size() / leaves_.size());
    if (set.size() < leaves_.size())
      m = m + wobble * Vec2{2 * random_.uniform() - 1, 2 * random_.uniform() - 1};
    const double x = spread_ * m.x, y = spread_ * m.y, rr = x * x + y * y;
    const double scale = std::sqrt(std::max(0.0, 1 - rr / 4));
    return distance * Vec3{x * scale, y * scale, 1 - rr / 2} - Vec3{0, 0, apex};
  }

  void split(std::vector<int>& set, Vec3 at, Vec3 direction, double reach, double radius) {
    Vec2 lo{1e300, 1e300}, hi{-1e300, -1e300};
    for (int i : set) lo = lower(lo, leaves_[i]), hi = upper(hi, leaves_[i]);
    const bool along_x = hi.x - lo.x > hi.y - lo.y;
    std::sort(set.begin(), set.end(), [&](int a, int b) {
      return along_x ? leaves_[a].x < leaves_[b].x : leaves_[a].y < leaves_[b].y;
    });
    const auto middle = set.begin() + set.size() / 2;
    for (std::vector<int> half :
         {std::vector<int>(set.begin(), middle), std::vector<int>(middle, set.end())}) {
      if (half.empty()) continue;
      const double child = radius * ratio_, length = branch_length(child);
      const bool leaf = half.size() == 1;
      const Vec3 to = place(half, reach + length * (leaf ? 1.25 : 1));
      const Vec3 end_direction =
          normalized((leaf ? 0.3 : 0.6) * normalized(to + Vec3{0, 0, apex}) + normalized(to - at));
      const Vec3 start_direction = normalized(0.45 * direction + 0.55 * normalized(to - at));
      if (leaf) {
        // beyond its end, for the cut to go through a clean tube
        add_branch(at, to + 0.5 * child * end_direction, start_direction, end_direction, child, child * 0.9);
        tree_.ends.push_back({to, end_direction, child * 0.9});
      } else {
        add_branch(at, to, start_direction, end_direction, child, child * 0.96);
        split(half, to, end_direction, reach + length, child);
      }
    }
  }

  /// A curve (Hermite's) of cones.
  void add_branch(Vec3 from, Vec3 to, Vec3 start, Vec3 end, double r0, double r1) {
    constexpr int pieces = 6;
    const double length = norm(to - from);
    auto at = [&](double t) {
      const double u = 1 - t;
      return u * u * (1 + 2 * t) * from + t * t * (3 - 2 * t) * to + t * u * u * length * start -
             t * t * u * length * end;
    };
    tree_.branches.push_back({(int)tree_.segments.size(), pieces, 2 * Tree::widest * r0});
    for (int i = 0; i < pieces; ++i) {
      const double t = (double)i / pieces, next = (i + 1.0) / pieces;
      tree_.segments.push_back({at(t), at(next), r0 + t * (r1 - r0), r0 + next * (r1 - r0)});
    }
  }

  double ratio_, length_, spread_;
  Random random_;
  std::vector<Vec2> leaves_;
  Tree tree_;
};

/// Returns how many diameters long a tube of diameter 1 with the tree's area is, counting each branch without
/// the piece inside its parent.
double aspect_of(const Tree& tree) {
  double area = 0;
  for (const Branch& b : tree.branches) {
    const Segment &first = tree.segments[b.first], &last = tree.segments[b.first + b.count - 1];
    double length = 0;
    for (int i = b.first; i < b.first + b.count; ++i) length += norm(tree.segments[i].b - tree.segments[i].a);
    area += pi * (first.ra + last.rb) * std::max(0.0, length - first.ra);
  }
  return area / pi;
}

/// Removes the surface beyond every end's plane.
void cut_ends(Mesh& mesh, const std::vector<End>& ends) {
  Surface s = surface_of(std::move(mesh));
  std::vector<double> field(s.points.size(), -1);
  for (std::size_t v = 0; v < s.points.size(); ++v)
    for (const End& e : ends) {
      const Vec3 d = s.points[v] - e.at;
      // the branch ends 1.6 radii away, the tube leaves the ball equally far before the end
      if (dot(d, d) < 3.6 * e.radius * e.radius) field[v] = dot(d, e.outward) / e.radius;
    }
  std::vector<int> side;
  cut_by_scalar_field(s, field, {}, side, 0.2);
  mesh = static_cast<Mesh&>(split_by_label(s, side, 1)[0]);
  // vertices that the cut was snapped to are put into the plane too
  for (const auto& loop : boundary_loops(opposite_halfedges(mesh)))
    for (int h : loop) {
      Vec3& p = mesh.points[origin(mesh.tris, h)];
      const End* nearest = &ends[0];
      for (const End& e : ends)
        if (norm(p - e.at) < norm(p - nearest->at)) nearest = &e;
      p = p - dot(p - nearest->at, nearest->outward) * nearest->outward;
    }
}

}  // namespace

Mesh genus_surface(int g, int n) {
  constexpr double thickness = 0.22, rounding = 0.2, hole = 0.27;
  const int rows = std::max(1, (int)std::sqrt(g / 2.0)), columns = std::max(1, (g + rows - 1) / rows);
  const double x = columns / 2.0 - 0.05, y = rows / 2.0 - 0.05;
  auto f = [=](Vec3 p) {
    auto box = [](Vec3 p, Vec3 half) {
      const Vec3 q{std::abs(p.x) - half.x, std::abs(p.y) - half.y, std::abs(p.z) - half.z};
      return norm(Vec3{std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0)}) +
             std::min(std::max({q.x, q.y, q.z}), 0.0);
    };
    // a plate with rounded outline and edges
    const double outline = box({p.x, p.y, 0}, {x - 0.35, y - 0.35, 1}) - 0.35;
    double d = -smooth_min(-outline, thickness - std::abs(p.z), rounding);
    const int column = std::clamp((int)std::floor(p.x + columns / 2.0), 0, columns - 1);
    const int row = std::clamp((int)std::floor(p.y + rows / 2.0), 0, rows - 1);
    // the nearest hole is in this square or in an adjacent one
    for (int j = std::max(0, row - 1); j <= std::min(rows - 1, row + 1); ++j)
      for (int i = std::max(0, column - 1); i <= std::min(columns - 1, column + 1); ++i)
        if (j * columns + i < g) {
          const double u = p.x - (i + 0.5 - columns / 2.0), v = p.y - (j + 0.5 - rows / 2.0);
          d = -smooth_min(-d, std::sqrt(u * u + v * v) - hole, rounding);
        }
    return d;
  };
  const Vec3 half{x + 0.1, y + 0.1, thickness + 0.1};
  return march_to_count(f, -1.0 * half, half, 0.1, n, [](Mesh&) {});
}

Mesh branching_tree(int generations, int outlets, double ratio, int n, int seed, double aspect) {
  const int leaves = outlets > 0 ? outlets - 1 : 1 << generations;
  double length = 5.5;
  Tree tree = Grower(leaves, ratio, length, seed).grow();
  for (int i = 0; aspect > 0 && i < 8; ++i) {
    length *= aspect / aspect_of(tree);
    tree = Grower(leaves, ratio, length, seed).grow();
  }
  tree.make_grid();
  double smallest = 1;
  for (const End& e : tree.ends) smallest = std::min(smallest, e.radius);
  Mesh mesh =
      march_to_count(tree, tree.lo, tree.hi, smallest / 1.4, n, [&](Mesh& m) { cut_ends(m, tree.ends); });
  const Topology t = topology_of(mesh);
  if (t.genus != 0 || t.loops != leaves + 1 || t.components != 1)
    throw GoalMissed("the tree's tubes touch: genus " + std::to_string(t.genus) + ", " +
                     std::to_string(t.loops) + " open ends instead of " + std::to_string(leaves + 1) +
                     "; try another seed or a smaller ratio");
  return mesh;
}

}  // namespace meshpipe
