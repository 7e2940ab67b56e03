// SPDX-License-Identifier: BSD-3-Clause
#include "lib/size/permitted.h"

#include <algorithm>
#include <bit>
#include <cfloat>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "lib/core/intersect.h"
#include "lib/core/normals.h"
#include "lib/size/local_feature_size.h"
#include "lib/size/section.h"

namespace meshpipe {
namespace {

constexpr double per_width = 7;       ///< size over the width of a strip; from 10 on kappa falls below 0.1
constexpr double least_width = 1e-5;  ///< of the diagonal: narrower strips are no features if they are short
constexpr double rounding_of_places = 1e-15;  ///< of coordinates: lines no farther apart may be one
constexpr double most_sag = 0.45;             ///< of the gap; triangles sag by 4/3 of what edges do
constexpr double longest = 1.4;               ///< edge, in sizes: a longer one is split
constexpr double least_width_share = 0.1;     ///< size over widths of triangles, where sheets almost touch
constexpr double least_share = 1.0 / 16;      ///< of the size asked for: sheets and arches ask for no less
constexpr double at_line = 1.05;              ///< gaps: the nearest place of a sheet is where both meet
constexpr double fold_at_lines = 0.5;         ///< of the size permitted: sheets that meet at lines within it
constexpr double lowered = 0.62;       ///< of the size asked for: sheets that permit more have not failed
constexpr double needle = 0.1;         ///< height of a triangle over the width of its strip
constexpr int most_needles = 8;        ///< side by side along a line
constexpr double opposed = 0.5;        ///< least cosine between the way across and the sides that face it
constexpr double sharp_corner = 0.54;  ///< radians between lines that taper to a sharp corner
constexpr double most_opening = 2;   ///< of the width over the way to the corner: more is the end of a strip
constexpr double least_bend = 1e-3;  ///< radians: edges across flatter ones hardly sag
constexpr double flat_triangle = 1e-7;  ///< height over length, below which rounding decides on the normal
constexpr double arch_turn = 2.1;       ///< radians: a chord of a third of a turn is half as long off its arc
constexpr double quarter = 0.785;       ///< of a circle, over its diameter: edges across arches turn as much
constexpr int most_of_arch = 64;        ///< triangles between its lines: more of them follow it anyway
constexpr double rounding = 1e-9;       ///< of a distance to the same point, from two triangles
constexpr int chunk = 340;              ///< triangles, neighbors in space
constexpr long long most_work = 3LL * chunk * 300;  ///< looks at triangles for a chunk: 300 for a half-edge
constexpr long long most_section_work = 1'000'000;  ///< the same for all sections of a chunk: milliseconds
constexpr int most_pieces = 1000;                   ///< of a piece of an edge that are measured
constexpr double least_piece = 1e-4;                ///< of an edge: bounds the measurements of one
constexpr double most_reach = 32;                   ///< sizes, within which what is near edges is looked at,
constexpr std::size_t most_near = 16;               ///< if it is no more triangles for each of them
constexpr double one_way = 0.7;  ///< least cosine between an axis and the normals of a sheet that is a graph
constexpr double corner_turn = 0.35;  ///< radians: a line that turns by more may come near others there only

using Four = float __attribute__((vector_size(16)));

/// The box of a triangle in single precision, rounded outward, with the number of the triangle.
struct Boxed {
  Four lo, hi;
  int triangle() const { return std::bit_cast<int>((float)lo[3]); }
};

Boxed boxed(const Box& box, int triangle = 0) {
  auto down = [](double x) { return std::nextafter((float)x, -FLT_MAX); };
  auto up = [](double x) { return std::nextafter((float)x, FLT_MAX); };
  return {Four{down(box.lo.x), down(box.lo.y), down(box.lo.z), std::bit_cast<float>(triangle)},
          Four{up(box.hi.x), up(box.hi.y), up(box.hi.z), 0}};
}

/// Whether they have a point in common, or nearly.
bool overlap(const Boxed& a, const Boxed& b) {
  const auto apart = (a.lo > b.hi) | (b.lo > a.hi);
  return (apart[0] | apart[1] | apart[2]) == 0;
}

/// Looks at what is connected, in one place after the other.
class Search {
 public:
  explicit Search(const Connectivity& surface) : surface_(surface), seen_(surface.n_tris(), 0) {}

  /// Whether these triangles are one sheet that is a graph over a plane, and have no edge on a line.
  bool one_graph(std::span<const Boxed> triangles, const std::vector<Vec3>& normal) {
    Vec3 axis;
    for (const Boxed& x : triangles) axis = axis + normal[x.triangle()];
    axis = normalized(axis);
    for (const Boxed& x : triangles)
      if (!(dot(normal[x.triangle()], axis) > one_way)) return false;
    ++turn_;
    for (const Boxed& x : triangles) seen_[x.triangle()] = turn_;
    queue_.assign(1, triangles[0].triangle());
    seen_[queue_[0]] = 0;
    for (std::size_t i = 0; i < queue_.size(); ++i)
      for (int h = 3 * queue_[i]; h < 3 * queue_[i] + 3; ++h) {
        if (surface_.is_border(h) || surface_.is_model(h)) return false;
        if (int& seen = seen_[surface_.opposite[h] / 3]; seen == turn_)
          seen = 0, queue_.push_back(surface_.opposite[h] / 3);
      }
    return queue_.size() == triangles.size();
  }

  /// Calls visit(t) for the first triangles and those that are connected with them across edges nearer to p
  /// than reach() that pass the test; it returns false to stop.
  template <class Crosses, class Reach, class Visit>
  void flood(const std::vector<int>& first, Vec3 p, Crosses crosses, Reach reach, Visit visit) {
    ++turn_;
    queue_ = first;
    for (int t : queue_) seen_[t] = turn_;
    for (std::size_t i = 0; i < queue_.size(); ++i) {
      const int t = queue_[i];
      ++work;
      if (!visit(t)) return;
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        if (surface_.is_border(h) || !crosses(h)) continue;
        const int u = surface_.opposite[h] / 3;
        if (seen_[u] == turn_) continue;
        const Vec3 a = surface_.point(surface_.from(h)), b = surface_.point(surface_.to(h));
        if (!(norm(lerp(a, b, nearest_fraction(p, a, b)) - p) < reach())) continue;
        seen_[u] = turn_;
        queue_.push_back(u);
      }
    }
  }

  long long work = 0;          ///< triangles that were looked at
  long long section_work = 0;  ///< the same along sections
  std::vector<Boxed> near;     ///< lists of measure_sheets, one after the other
  std::vector<int> close;      ///< half-edges along which a sheet is within the gap

 private:
  const Connectivity& surface_;
  std::vector<int> seen_, queue_;
  int turn_ = 0;
};

/// How an edge bends.
struct Bend {
  Vec3 up{};          ///< to the side where the surface is hollow
  double widths = 0;  ///< of its two triangles, at a right angle from the edge
  double gap = 0;     ///< sheets farther away are not near; 0: it is flat, or its triangles are
};

/// What is measured at one point after the other.
class Measure {
 public:
  Measure(const Connectivity& surface, const std::vector<double>& asked);
  /// Returns the size permitted at t along half-edge h, and the gap there; infinite where nothing bounds it.
  SizeBound at(int h, double t, Search& search) const {
    const Vec3 p = lerp(surface_.point(surface_.from(h)), surface_.point(surface_.to(h)), t);
    if (search.work > most_work) return {h, p, infinity, 0};
    return is_line(h) ? strip(h, p, search) : sheet(h, p, search);
  }
  /// The same for the tube along a half-edge that is longer than the size; its mean width is the gap.
  SizeBound section(int h, double t, Search& search) const {
    const Vec3 p = lerp(surface_.point(surface_.from(h)), surface_.point(surface_.to(h)), t);
    const double most = asked(h, p);
    if (search.section_work > most_section_work || !(surface_.length(h) > most) ||
        (!is_line(h) && !(bend(h, p).gap > 0)))
      return {h, p, infinity, 0};
    const double around = sections_.length(h, p, most, lowered * ring_edges * most, search.section_work);
    return {h, p, around / ring_edges, around / std::numbers::pi};
  }
  /// How half-edge h bends at p, which is not on a line.
  Bend bend(int h, Vec3 p) const;
  /// The size asked for at a point of an edge.
  double asked(int h, Vec3 p) const { return value_along(surface_.mesh, asked_, h, p); }
  /// Whether a triangle that passes the test is connected with the edge of h within a distance from p, across
  /// edges that pass the other one.
  template <class Crosses, class Test>
  bool joins(int h, Vec3 p, double within, Crosses crosses, Test test, Search& search) const {
    bool found = false;
    search.flood(
        {h / 3, surface_.opposite[h] / 3}, p, crosses, [&] { return within; },
        [&](int t) { return !(found = test(t)); });
    return found;
  }
  const Bvh& tree() const { return tree_; }
  const std::vector<Vec3>& normals() const { return normal_; }
  const Connectivity& surface() const { return surface_; }
  /// Neighbors of half-edges on lines, around the region.
  int before(int h) const {
    for (h = prev(h); !is_line(h);) h = prev(surface_.opposite[h]);
    return h;
  }
  int after(int h) const {
    for (h = next(h); !is_line(h);) h = next(surface_.opposite[h]);
    return h;
  }
  bool is_line(int h) const {
    return surface_.is_border(h) || surface_.is_model(h) || surface_.is_model(surface_.opposite[h]);
  }

 private:
  SizeBound strip(int h, Vec3 p, Search& search) const;
  SizeBound sheet(int h, Vec3 p, Search& search) const;
  Vec3 inward(int h, double width) const;
  bool adjacent_along(int h, Vec3 p, int other, Vec3 q, double width) const;
  SizeBound arch(int h, Vec3 p, Search& search) const;
  double until_sag(int h, Vec3 p, Vec3 up, double most, Search& search) const;

  const Connectivity& surface_;
  const std::vector<double>& asked_;
  double least_width_, largest_;
  std::vector<Vec3> normal_;  ///< of triangles
  Sections sections_;
  Bvh tree_;
};

Measure::Measure(const Connectivity& surface, const std::vector<double>& asked)
    : surface_(surface),
      asked_(asked),
      least_width_(least_width * diagonal(surface.mesh)),
      largest_(*std::max_element(asked.begin(), asked.end())),
      normal_(face_normals(surface.mesh)),
      sections_(surface, asked),
      tree_(surface.mesh) {}

/// Whether q on the half-edge `other` is reached from p on h along the lines around their region, on a way
/// that is short for the width between them.
bool Measure::adjacent_along(int h, Vec3 p, int other, Vec3 q, double width) const {
  const double most = std::max(per_width * width, largest_);
  for (bool forward : {true, false}) {
    double way = 0;
    bool sharp = false;
    Vec3 x = p;
    for (int g = h; g != other || way == 0;) {
      const int v = forward ? surface_.to(g) : surface_.from(g);
      const int then = forward ? after(g) : before(g);
      way += norm(surface_.point(v) - x);
      x = surface_.point(v);
      if (way > most || then == h) {
        way = infinity;
        break;
      }
      const int w = forward ? surface_.to(then) : surface_.from(then);
      const double opening =
          std::numbers::pi -
          angle(x - surface_.point(forward ? surface_.from(g) : surface_.to(g)), surface_.point(w) - x);
      sharp = sharp || (opening < sharp_corner && opening * way < most_opening * width);
      g = then;
    }
    way += norm(q - x);
    if (way <= per_width * width || (sharp && way <= largest_)) return true;
  }
  return false;
}

/// Returns the unit vector from a line into the region of h, across it. Needles far narrower than the strip
/// may be folded along it: then the next triangle that is wide enough gives the direction.
Vec3 Measure::inward(int h, double width) const {
  int g = h;
  for (int i = 0; i < most_needles && norm(surface_.area_vector(g / 3)) < needle * width * surface_.length(g);
       ++i) {
    const int a = next(g), b = next(a);
    int across = surface_.length(a) > surface_.length(b) ? a : b;
    if (is_line(across)) across = across == a ? b : a;
    if (is_line(across)) break;
    g = surface_.opposite[across];
  }
  return normalized(cross(normal_[g / 3], surface_.point(surface_.to(h)) - surface_.point(surface_.from(h))));
}

/// Calls visit(t, g, q) for the lines around the region of h that are less than `width` from p: q is the
/// point of half-edge g of triangle t nearest to p. Looks at no more than `most` triangles.
template <class Visit>
void lines_near(const Measure& m, int h, Vec3 p, const double& width, int most, Search& search, Visit visit) {
  const Connectivity& s = m.surface();
  search.flood(
      {h / 3}, p, [&](int g) { return !m.is_line(g); }, [&] { return width; },
      [&](int t) {
        for (int g = 3 * t; g < 3 * t + 3; ++g) {
          if (g == h || !m.is_line(g)) continue;
          const Vec3 a = s.point(s.from(g)), b = s.point(s.to(g));
          const Vec3 q = lerp(a, b, nearest_fraction(p, a, b));
          if (norm(q - p) < width) visit(t, g, q);
        }
        return --most > 0;
      });
}

SizeBound Measure::strip(int h, Vec3 p, Search& search) const {
  double width = asked(h, p) / per_width;
  const double least = surface_.length(h) < per_width * width ? least_width_ : rounding_of_places * norm(p);
  SizeBound found{h, p, infinity, 0};
  lines_near(*this, h, p, width, surface_.n_tris(), search, [&](int, int g, Vec3 q) {
    const double d = norm(q - p);
    if (d <= least || dot(q - p, inward(h, d)) < opposed * d || dot(p - q, inward(g, d)) < opposed * d ||
        adjacent_along(h, p, g, q, d))
      return;
    width = d;
    found.size = per_width * d;
    found.gap = d;
  });
  return found.size < infinity ? found : arch(h, p, search);
}

/// As strip, where the surface between two lines bends so much that edges across it must be shorter than the
/// lines are apart.
SizeBound Measure::arch(int h, Vec3 p, Search& search) const {
  SizeBound found{h, p, infinity, 0};
  double width = longest * asked(h, p);
  const double least = least_share * width;
  // from one line at a right angle, over its region or at least not away from it
  auto faces = [&](int g, Vec3 d) {
    const Vec3 along = surface_.point(surface_.to(g)) - surface_.point(surface_.from(g));
    const double l = norm(d);
    return std::abs(dot(d, along)) < opposed * l * norm(along) && dot(d, inward(g, l)) > -opposed * l;
  };
  lines_near(*this, h, p, width, most_of_arch, search, [&](int t, int g, Vec3 q) {
    const double d = norm(q - p);
    if (d < least || !faces(h, q - p) || !faces(g, p - q) || angle(normal_[h / 3], normal_[t]) < arch_turn ||
        adjacent_along(h, p, g, q, d))
      return;
    width = d;
    found.size = quarter * d;
    found.gap = d;
  });
  return found;
}

/// Returns the distance from p at which the surface, connected without model edges, rises by `most`.
double Measure::until_sag(int h, Vec3 p, Vec3 up, double most, Search& search) const {
  double reach = 0.5 * longest * asked(h, p);
  search.flood(
      {h / 3, surface_.opposite[h] / 3}, p, [&](int g) { return !is_line(g); }, [&] { return reach; },
      [&](int t) {
        Vec3 level[2];
        int n = 0;
        for (int g = 3 * t; g < 3 * t + 3; ++g) {
          const Vec3 a = surface_.point(surface_.from(g)), b = surface_.point(surface_.to(g));
          const double za = dot(a - p, up) - most, zb = dot(b - p, up) - most;
          if ((za > 0) != (zb > 0) && n < 2) level[n++] = lerp(a, b, za / (za - zb));
        }
        const double at = nearest_fraction(p, level[0], level[1]);
        if (n == 2) reach = std::min(reach, norm(lerp(level[0], level[1], at) - p));
        return true;
      });
  return reach;
}

Bend Measure::bend(int h, Vec3 p) const {
  const int s = h / 3, t = surface_.opposite[h] / 3;
  const Vec3 along = surface_.point(surface_.to(h)) - surface_.point(surface_.from(h));
  const double length = norm(along);
  const double angle =
      std::atan2(dot(cross(normal_[s], normal_[t]), along) / length, dot(normal_[s], normal_[t]));
  auto height = [&](int face) { return norm(surface_.area_vector(face)) / length; };
  if (!(std::abs(angle) > least_bend) || !(std::min(height(s), height(t)) > flat_triangle * length))
    return {};
  const double most = asked(h, p);
  // the largest width within the size of p: the height of a long needle is far from here
  auto width = [&](int side) {
    const Vec3 a = surface_.point(surface_.from(side)), d = surface_.point(surface_.to(side)) - a;
    const double foot = dot(surface_.point(surface_.to(next(side))) - a, d) / length;
    const double here = dot(p - a, d) / length;
    const double x = std::clamp(foot, std::max(here - most, 0.0), std::min(here + most, length));
    return height(side / 3) * (x < foot ? x / foot : x > foot ? (length - x) / (length - foot) : 1);
  };
  const double at_s = width(h), at_t = width(surface_.opposite[h]);
  // a chord of the size asked sags to the side where the surface is hollow, at most by this
  const double sag = std::min(0.125 * most * most * std::abs(angle) / ((at_s + at_t) / 3), 0.5 * most);
  return {normalized((angle > 0 ? -1.0 : 1.0) * (normal_[s] + normal_[t])), at_s + at_t,
          longest * longest * lowered * lowered * sag / most_sag};
}

/// Whether t, whose edges or corners are nearest to p at a distance, has no neighbor that is nearer.
bool is_ridge(const Connectivity& surface, int t, Vec3 p, double distance) {
  for (int h = 3 * t; h < 3 * t + 3; ++h)
    if (!surface.is_border(h) &&
        norm(closest_point(surface.mesh, surface.opposite[h] / 3, p) - p) < (1 - rounding) * distance)
      return false;
  return true;
}

SizeBound Measure::sheet(int h, Vec3 p, Search& search) const {
  const SizeBound none{h, p, infinity, 0};
  const int s = h / 3, t = surface_.opposite[h] / 3;
  auto [up, widths, gap] = bend(h, p);
  if (!(gap > 0)) return none;
  int other = -1;
  tree_.in_cone(p, up, opposed, gap, [&, &up = up, &gap = gap](int u) {
    ++search.work;
    if (u == s || u == t) return gap;
    const auto& [i, j, k] = surface_.mesh.tris[u];
    auto rises = [&](int v) { return dot(surface_.point(v) - p, up) > 0; };
    if (!rises(i) && !rises(j) && !rises(k)) return gap;
    const Vec3 d = closest_point(surface_.mesh, u, p) - p;
    const double l = norm(d);
    if (l > gap || dot(d, up) < opposed * l || l == 0) return gap;
    if (std::abs(dot(normal_[u], up)) < opposed && !is_ridge(surface_, u, p, l)) return gap;
    if (l < gap || u < other) other = u;
    return gap = l;
  });
  if (other < 0) return none;
  const double most = asked(h, p), size = std::max({2 / longest * until_sag(h, p, up, most_sag * gap, search),
                                                    least_width_share * widths, least_share * most});
  if (size > lowered * most) return none;
  search.close.push_back(h);
  auto is_other = [&](int u) { return u == other; };
  const bool across = std::abs(dot(normal_[other], up)) >= opposed;  // else a line is near, as at a corner
  // what is connected within the size is a fold that a mesh of this size leaves out, unless lines hold it
  if (joins(
          h, p, most, [&](int g) { return !is_line(g); }, is_other, search) ||
      joins(
          h, p, across ? std::max(fold_at_lines * size, at_line * gap) : most, [](int) { return true; },
          is_other, search))
    return none;
  return {h, p, size, gap};
}

/// Does the line of h turn at its start? For half-edges on lines.
bool turns(const Measure& measure, int h) {
  const Connectivity& s = measure.surface();
  auto along = [&](int e) { return s.point(s.to(e)) - s.point(s.from(e)); };
  return angle(along(measure.before(h)), along(h)) > corner_turn;
}

/// Measures a half-edge between two parameters at points about as far apart as the sizes they permit, also
/// where a strip or a tube tapers. `at(t)`: the bound at t; `strips`: whether it may be that of a strip.
template <class At>
void measure_along(const Measure& measure, int h, double from, double to, const At& at, bool strips,
                   std::vector<SizeBound>& found, double apart = 1) {
  SizeBound x = at(0.5 * (from + to));
  if (x.size == infinity) return;
  const double length = measure.surface().length(h), piece = (to - from) * length;
  if (piece < apart * x.size || piece < least_piece * length) {
    x.length = strips ? piece : 0;
    return found.push_back(x);
  }
  const int n = (int)std::min(std::ceil(piece / x.size), (double)most_pieces);
  for (int i = 0; i < n; ++i)
    measure_along(measure, h, from + (to - from) * i / n, from + (to - from) * (i + 1) / n, at, strips, found,
                  2);
}

/// Measures a half-edge in pieces about as long as the sizes there.
void measure_edge(const Measure& measure, int h, Search& search, std::vector<SizeBound>& found) {
  const Connectivity& s = measure.surface();
  const Vec3 a = s.point(s.from(h)), b = s.point(s.to(h));
  const double at_a = measure.asked(h, a), at_b = measure.asked(h, b), length = s.length(h);
  // the number of sizes along the edge: the integral of 1 / size, which is linear
  const double growth = at_b / at_a;
  const bool even = std::abs(growth - 1) < 1e-6;
  const double sizes = length / at_a * (even ? 1 : std::log(growth) / (growth - 1));
  const int pieces = (int)std::clamp(std::ceil(sizes), 1.0, (double)most_pieces);
  auto at = [&](int k) {
    const double x = (double)k / pieces;
    return even || k == pieces ? x : (std::pow(growth, x) - 1) / (growth - 1);
  };
  const bool line = measure.is_line(h);
  for (int k = 0; k < pieces; ++k)
    measure_along(
        measure, h, at(k), at(k + 1), [&](double t) { return measure.at(h, t, search); }, line, found);
  for (int k = 0; k < pieces; ++k)
    measure_along(
        measure, h, at(k), at(k + 1), [&](double t) { return measure.section(h, t, search); }, false, found);
}

/// Measures edges next to each other, on sheets within the gap of their middles; at once if what is near is
/// one sheet. `first`, `last`: of a list in search.near that has all triangles that are near these edges;
/// empty: the tree has them.
void measure_sheets(const Measure& measure, std::span<const SizeBound> edges, Search& search,
                    std::vector<SizeBound>& found, std::size_t first = 0, std::size_t last = 0) {
  if (edges.empty() || search.work > most_work) return;
  if (edges.size() == 1) return measure_edge(measure, edges[0].half_edge, search, found);
  Box box{edges[0].place, edges[0].place};
  double gap = 0;
  for (const SizeBound& x : edges) {
    box = join(box, {x.place, x.place});
    gap = std::max(gap, x.gap);
  }
  const Vec3 margin{gap, gap, gap};
  const Box around{box.lo - margin, box.hi + margin};
  std::vector<Boxed>& near = search.near;
  const std::size_t most = first < last ? last - first : most_near * edges.size();
  if (near.size() < last + most) near.resize(last + most);
  std::size_t end = last;
  if (first == last && norm(around.hi - around.lo) < most_reach * edges[0].size) {
    measure.tree().overlapping(around, [&](int t) {
      ++search.work;
      if (end - last < most) near[end] = boxed(box_of(measure.surface().mesh, t), t);
      ++end;
    });
    if (end - last > most) end = last;
  }
  const Boxed nearly = boxed(around);
  for (; first < last; ++first) {  // without a branch, which could not be predicted
    near[end] = near[first];
    end += overlap(near[first], nearly);
  }
  if (end > last && search.one_graph(std::span(near).subspan(last, end - last), measure.normals())) return;
  for (auto part : {edges.first(edges.size() / 2), edges.subspan(edges.size() / 2)})
    measure_sheets(measure, part, search, found, last, end);
}

/// Drops the bounds of sheets next to places where they meet: no size keeps these apart.
void drop_intersecting(const Measure& measure, const Connectivity& surface, std::vector<SizeBound>& bounds) {
  const Mesh& mesh = surface.mesh;
  std::vector<int> row(bounds.empty() ? 0 : surface.n_tris(), -1);
  std::vector<Mesh> places;  // by row, where a triangle meets others
  auto places_of = [&](int t) -> const Mesh& {
    if (row[t] >= 0) return places[row[t]];
    std::vector<std::pair<int, int>> pairs;
    const Box box = box_of(mesh, t);
    if (has_area(mesh, t))
      measure.tree().overlapping(box, [&](int u) {
        if (u != t && overlap(box, box_of(mesh, u)) &&
            triangles_intersect(mesh, std::min(t, u), std::max(t, u)) && has_area(mesh, u))
          pairs.push_back({std::min(t, u), std::max(t, u)});
      });
    row[t] = (int)places.size();
    return places.emplace_back(contacts(mesh, pairs));
  };
  Search search(surface);
  std::erase_if(bounds, [&](const SizeBound& x) {
    if (measure.is_line(x.half_edge)) return false;
    const double size = measure.asked(x.half_edge, x.place);
    auto meets = [&](int t) {
      const Mesh& near = places_of(t);
      for (int k = 0; k < (int)near.tris.size(); ++k)
        if (norm(closest_point(near, k, x.place) - x.place) < size) return true;
      return false;
    };
    return measure.joins(
        x.half_edge, x.place, 0.5 * size, [](int) { return true; }, meets, search);
  });
}

}  // namespace

double value_along(const Mesh& mesh, const std::vector<double>& value, int h, Vec3 p) {
  const int a = origin(mesh.tris, h), b = target(mesh.tris, h);
  return std::lerp(value[a], value[b], nearest_fraction(p, mesh.points[a], mesh.points[b]));
}

double triangles_of_strips(const std::vector<SizeBound>& bounds, double most) {
  // one side of a strip of length l and width w has the area of l w / 2
  const double share = 2 / std::sqrt(3.0);
  double n = 0;
  for (const SizeBound& x : bounds) {
    const double h = std::min(x.size, most);
    n += x.length / h * std::max(0.0, 1 - share * x.gap / h);
  }
  return n;
}

std::vector<SizeBound> permitted_sizes(const Connectivity& surface, const std::vector<double>& asked,
                                       double least, double most_triangles, std::vector<char>& close) {
  const Measure measure(surface, asked);
  const std::vector<int>& order = measure.tree().order();
  const int n = surface.n_tris();
  std::vector<std::vector<SizeBound>> found((n + chunk - 1) / chunk);
  const std::vector<char> among = std::exchange(close, std::vector<char>(n, 0));
  auto may_be_near = [&](int h) { return among.empty() || among[h / 3] || among[surface.opposite[h] / 3]; };
  // both are measured as time permits: of fans of needles each point sees all
  std::vector<SizeBound> all;
  for (bool line : {true, false}) {
#pragma omp parallel
    {
      Search search(surface);
#pragma omp for schedule(dynamic)
      for (int c = 0; c < (int)found.size(); ++c) {
        std::vector<SizeBound> edges;
        search.work = search.section_work = 0;
        for (int i = 3 * c * chunk; i < 3 * std::min(n, (c + 1) * chunk); ++i) {
          const int h = 3 * order[i / 3] + i % 3;
          if (measure.is_line(h) != line || (!line && h < surface.opposite[h])) continue;
          if (!line) {
            const Vec3 middle = lerp(surface.point(surface.from(h)), surface.point(surface.to(h)), 0.5);
            const double size = measure.asked(h, middle);
            const bool is_long = surface.length(h) > size;
            const double gap = is_long ? infinity : may_be_near(h) ? measure.bend(h, middle).gap : 0;
            if (gap > 0) edges.push_back({h, middle, size, gap});
            continue;
          }
          measure_edge(measure, h, search, found[c]);
          if (turns(measure, h))
            for (const SizeBound& x : {measure.at(h, 0, search), measure.at(measure.before(h), 1, search)})
              if (x.size < infinity) found[c].push_back(x);
        }
        measure_sheets(measure, edges, search, found[c]);
        if (search.work > most_work)  // not all were measured
          for (const SizeBound& x : edges) search.close.push_back(x.half_edge);
      }
#pragma omp critical
      for (int h : search.close) close[h / 3] = close[surface.opposite[h] / 3] = 1;
    }
    all.clear();
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    for (SizeBound& x : all) x.size = std::max(x.size, least);
    if (triangles_of_strips(all, infinity) > most_triangles) return all;
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const SizeBound& a, const SizeBound& b) { return a.half_edge < b.half_edge; });
  drop_intersecting(measure, surface, all);
  return all;
}

}  // namespace meshpipe
