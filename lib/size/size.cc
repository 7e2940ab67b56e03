// SPDX-License-Identifier: BSD-3-Clause
#include "lib/size/size.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "lib/core/bvh.h"
#include "lib/core/error.h"
#include "lib/core/failure_facts.h"
#include "lib/core/junctions.h"
#include "lib/core/lists.h"
#include "lib/core/number.h"
#include "lib/core/shortest_paths.h"
#include "lib/core/split_edges.h"
#include "lib/core/take_rows.h"
#include "lib/core/topology.h"
#include "lib/feature/feature.h"
#include "lib/size/local_feature_size.h"
#include "lib/size/permitted.h"
#include "lib/size/sheet_distance.h"

namespace meshpipe {
namespace {

constexpr double default_size = 0.1;       ///< of the diagonal, where no source bounds the size
constexpr double longest_edge = 1.0 / 16;  ///< of the diagonal, where a field may have detail anywhere
constexpr int most_passes = 12;            ///< of splitting edges; each halves them, fields have few scales
constexpr double interpolation_error = 0.15;  ///< of the size in the middle of an edge
constexpr double excess_error = 0.5;          ///< the same near narrow places, where it only costs triangles
constexpr double count_error = 1e-3;          ///< of the number of triangles asked for
constexpr double most_times = 10;             ///< triangles of narrow strips, over those asked for,
constexpr double many_triangles = 5e4;        ///< unless they are no more than this: seconds
constexpr double wide_strip = 0.1;            ///< over the size: beyond what mfeature removes unasked
constexpr double much_less = 0.8;             ///< of the size: a bound on a field that has met others
/// Column of the vertices while a field is made: no column of a stream has a name with a space.
constexpr char permitted_before[] = "permitted before";
constexpr double most_growth = 1.5;  ///< of a uniform size, to make up for places that permit smaller ones

/// A vertex column and the share of it that is asked for.
struct Source {
  std::string column;
  double factor;
};

/// The field while it is made: wishes at the vertices, edges split where they are not linear.
struct Field {
  Surface& s;
  Table* chart;
  const SizeOptions& o;
  double diagonal = 0, cap = 0;
  double uniform = infinity, scale = 1;  ///< meet_count varies these two
  std::vector<int> opposite{};
  Lists next{};                     ///< as neighbors_of
  std::vector<double> curvature{};  ///< per triangle; empty if not needed
  std::vector<Source> sources{};
  std::vector<double> wish{}, size{}, permits{};  ///< per vertex: of the sources, the field, the surface
  // Where the surface is near itself: the bounds by half-edge of the surface as it came and along it, the
  // triangles of that, and which of them each triangle is part of. Empty where nothing is bounded.
  std::vector<SizeBound> bounds{};
  double strips = 0;  ///< triangles of strips that were bounded before these
  Surface given{};
  std::vector<int> root{};
  std::vector<char> close{};  ///< per triangle of `given`, see permitted_sizes; empty: not known
  std::unordered_map<std::uint64_t, double> asked{};  ///< by the two vertices, see there
};

/// Returns the local feature size where it is below the size; `curvature` may be empty.
std::vector<double> feature_size(const Connectivity& surface, const std::vector<double>& curvature,
                                 const std::vector<double>& size) {
  // averages may exceed what they are made of by rounding
  const double least = (1 - 1e-5) * least_tube_curvature(size);
  return local_feature_size(surface, curvature.empty() ? face_curvature(surface, least) : curvature, size);
}

/// Returns the size that a curvature asks for.
double by_curvature(const SizeOptions& o, double k) {
  if (!(k > 0)) return infinity;
  double h = infinity;
  if (o.per_turn > 0) h = 2 * std::numbers::pi / (o.per_turn * k);
  // a chord of length h over an arc of radius r is r - sqrt(r^2 - h^2 / 4) away from it
  if (o.chord > 0)
    h = std::min(h, o.chord * k < 1 ? 2 * std::sqrt(2 * o.chord / k - o.chord * o.chord) : 2 / k);
  return h;
}

/// What the field asks for in the middle between two vertices, or at one that is given twice. Places do not
/// change from pass to pass: what does not depend on the curvature is looked up once.
double asked(Field& f, int a, int b, double curvature) {
  const Vec3 p = lerp(f.s.points[a], f.s.points[b], 0.5);
  double h = 0;
  double& known =
      f.o.at_curvature ? h : f.asked[(std::uint64_t)std::min(a, b) << 32 | (std::uint64_t)std::max(a, b)];
  if (known > 0) return known;
  known = f.o.at(p, curvature);
  if (!(known > 0))
    throw BadInput("the size at " + shown(p) + " is " + shown(known) + ", but sizes are positive");
  return known;
}

/// Sets the wishes: what the sources ask for at the vertices.
void set_wishes(Field& f) {
  const std::size_t n = f.s.points.size();
  f.wish.assign(n, infinity);
  std::vector<double> most(n, 0);
  if (!f.curvature.empty())
    for (std::size_t t = 0; t < f.s.tris.size(); ++t) {
      const double h = by_curvature(f.o, f.curvature[t]);
      for (int v : f.s.tris[t]) {
        f.wish[v] = std::min(f.wish[v], h);
        most[v] = std::max(most[v], f.curvature[t]);
      }
    }
  for (const Source& x : f.sources) {
    const auto& data = f.s.vertex.get<double>(x.column);
    for (std::size_t v = 0; v < n; ++v) {
      if (!(data[v] > 0))
        throw BadInput("vertex " + std::to_string(v) + " has " + x.column + ' ' + shown(data[v]) +
                       ", but sizes are positive");
      f.wish[v] = std::min(f.wish[v], x.factor * data[v]);
    }
  }
  if (f.o.at)
    for (int v = 0; v < (int)n; ++v) f.wish[v] = std::min(f.wish[v], asked(f, v, v, most[v]));
}

/// Returns what the sources ask for in the middle of an edge.
double wish_between(Field& f, int h) {
  const int a = origin(f.s.tris, h), b = target(f.s.tris, h), o = f.opposite[h];
  double least = infinity, most = 0;
  if (!f.curvature.empty()) {
    most = o >= 0 ? std::max(f.curvature[h / 3], f.curvature[o / 3]) : f.curvature[h / 3];
    least = by_curvature(f.o, most);
  }
  for (const Source& x : f.sources) {
    const auto& data = f.s.vertex.get<double>(x.column);
    least = std::min(least, x.factor * 0.5 * (data[a] + data[b]));
  }
  if (f.o.at) least = std::min(least, asked(f, a, b, most));
  return least;
}

/// Calls visit(bound) for the bounds on the given edge that half-edge h is part of.
template <class Visit>
void each_bound(const Field& f, int h, Visit visit) {
  if (f.bounds.empty()) return;
  constexpr double slack = 1e-6;  // of the given edge, for rounding
  const Vec3 a = f.s.points[origin(f.s.tris, h)], b = f.s.points[target(f.s.tris, h)];
  const int t = f.root[h / 3];
  auto on_edge = [](const SizeBound& x, int k) { return x.half_edge < k; };
  auto first = std::lower_bound(f.bounds.begin(), f.bounds.end(), 3 * t, on_edge);
  while (first != f.bounds.end() && first->half_edge / 3 == t) {
    const int g = first->half_edge;
    const auto last = std::lower_bound(first, f.bounds.end(), g + 1, on_edge);
    const Vec3 p = f.s.points[origin(f.given.tris, g)], along = f.s.points[target(f.given.tris, g)] - p;
    const auto [from, to] = std::minmax({dot(a - p, along), dot(b - p, along)});
    const double most = to + slack * dot(along, along);
    first =
        std::lower_bound(first, last, from - slack * dot(along, along),
                         [&](const SizeBound& x, double least) { return dot(x.place - p, along) < least; });
    for (; first != last && dot(first->place - p, along) <= most; ++first)
      // on the sub-edge: a way by the place is no detour
      if (norm(first->place - a) + norm(b - first->place) <= norm(b - a) * (1 + 1e-9)) visit(*first);
    first = last;
  }
}

/// The number of triangles of strips beyond those that their area stands for.
double strip_triangles(const Field& f, double most) { return f.strips + triangles_of_strips(f.bounds, most); }

/// Lowers what the surface permits at the ends of every edge by the bounds on it, or has permitted before.
void bound_vertices(Field& f) {
  f.permits.assign(f.s.points.size(), infinity);
  if (f.s.vertex.has(permitted_before)) f.permits = f.s.vertex.get<double>(permitted_before);
  for (int h = 0; h < (int)f.opposite.size(); ++h)
    each_bound(f, h, [&](const SizeBound& x) {
      for (int v : {origin(f.s.tris, h), target(f.s.tris, h)})
        f.permits[v] = std::min(f.permits[v], x.size + f.o.gradation * norm(f.s.points[v] - x.place));
    });
}

double bounded(const Field& f, double wish) {
  return std::max(std::min({f.uniform, f.cap, f.diagonal, f.scale * wish}), f.o.min);
}

/// Sets the sizes: the wishes times `scale`, at most `uniform`, bounded and graded.
void set_sizes(Field& f, double uniform, double scale) {
  f.uniform = uniform, f.scale = scale;
  f.size.resize(f.wish.size());
  for (std::size_t v = 0; v < f.size.size(); ++v) {
    f.size[v] = bounded(f, f.wish[v]);
    if (!f.permits.empty()) f.size[v] = std::min(f.size[v], std::max(f.permits[v], f.o.min));
  }
  limit_gradation(f.s, f.next, f.o.gradation, f.size);
}

/// Sets the sizes to a field that asks for the number of triangles, if one is given. The number falls as x
/// grows: while x < 0 the uniform length is e^x diagonals; beyond, the other sources are multiplied by e^x.
void meet_count(Field& f) {
  if (!(f.o.triangles > 0)) return set_sizes(f, infinity, 1);
  auto count_at = [&](double x) {
    set_sizes(f, x < 0 ? f.diagonal * std::exp(x) : infinity, x > 0 ? std::exp(x) : 1);
    const double strips = strip_triangles(f, std::min({f.uniform, f.cap, f.diagonal}));
    return std::log((count_for_size(f.s, f.size) + strips) / f.o.triangles);
  };
  // without other sources all x > 0 are one: narrow places that ask for more there do so everywhere
  if (!f.bounds.empty() && *std::min_element(f.wish.begin(), f.wish.end()) == infinity && count_at(0) > 0)
    return;
  constexpr double step = 0.3, most = 20;  // of x: sizes grow by a third a step, up to e^20 times
  double low = std::min(0.0, std::log(size_for_count(total_area(f.s), f.o.triangles) / f.diagonal)),
         high = low;
  double above = count_at(low), below = above;
  while (below > 0 && high < most) {
    if (high > low) low = high, above = below;
    high += step;
    below = count_at(high);
    if (low > 0 && above - below < 1e-6) break;  // bounds let the sizes grow no more
  }
  if (below > 0) count_at(low);
  if (above <= 0 || below > 0)
    return;  // already the uniform length asks for no more, or all sizes are too small
  for (int i = 0; i < 30 && std::abs(below) > count_error && high - low > 1e-6; ++i) {
    // regula falsi, with a bisection every third step since it may creep
    double x = low + (high - low) * std::clamp(above / (above - below), 0.05, 0.95);
    if (i % 3 == 2) x = 0.5 * (low + high);
    const double c = count_at(x);
    if (c > 0)
      low = x, above = c;
    else
      high = x, below = c;
    if (std::abs(c) < count_error) return;
  }
  count_at(high);
}

/// Whether interpolation along the edge misses the field in its middle, on a scale that a mesh would show.
bool bends(Field& f, int h) {
  const int a = origin(f.s.tris, h), b = target(f.s.tris, h), o = f.opposite[h];
  const double l = edge_length(f.s, h);
  if (l < 0.5 * std::min(f.size[a], f.size[b])) return false;
  const Vec3 middle = lerp(f.s.points[a], f.s.points[b], 0.5);
  double m =
      std::min(bounded(f, wish_between(f, h)), std::min(f.size[a], f.size[b]) + 0.5 * f.o.gradation * l);
  for (int side : {h, o}) {
    if (side < 0) continue;
    const int apex = target(f.s.tris, next(side));
    m = std::min(m, f.size[apex] + f.o.gradation * norm(f.s.points[apex] - middle));
  }
  const double linear = 0.5 * (f.size[a] + f.size[b]);
  const double error = f.bounds.empty() || linear > m ? interpolation_error : excess_error;
  if (l > m && std::abs(m - linear) > error * m) return true;
  bool misses = false;
  for (int side : {h, o})
    if (side >= 0)
      each_bound(f, side, [&](const SizeBound& x) {
        const double t = norm(x.place - f.s.points[a]) / l;
        const double least = std::max(x.size, f.o.min);
        misses |= l > 2 * least && (1 - t) * f.size[a] + t * f.size[b] > (1 + interpolation_error) * least;
      });
  return misses;
}

/// Splits the edges that pass the test; returns whether there were any.
template <class Test>
bool split(Field& f, const Test& test) {
  std::vector<char> mark(f.opposite.size(), 0);
  for (int h = 0; h < (int)mark.size(); ++h)
    if (f.opposite[h] < h) mark[h] = test(h);
  const std::vector<int> parent = split_edges({f.s, f.opposite}, std::move(mark), f.chart);
  if (parent.empty()) return false;
  f.opposite = opposite_halfedges(f.s);
  f.next = neighbors_of(f.s);
  if (!f.root.empty()) f.root = rearranged(f.root, parent);
  if (!f.curvature.empty()) f.curvature = rearranged(f.curvature, parent);
  return true;
}

/// Lowers sizes to the local feature size; reports the place where that is most.
void lower_where_narrow(Field& f, SizeReport& report) {
  const auto feature = feature_size({f.s, f.opposite, model_of(f.s)}, f.curvature, f.size);
  for (std::size_t v = 0; v < feature.size(); ++v) f.permits[v] = std::min(f.permits[v], feature[v]);
  LoweredSize& most = report.lowered;
  for (std::size_t v = 0; v < f.permits.size(); ++v) {
    const double r = std::max(f.permits[v], f.o.min);
    if (!(r < f.size[v])) continue;
    if (const int n = ++most.places; n == 1 || f.size[v] / r > most.from / most.to)
      most = {n, f.s.points[v], f.size[v], r};
  }
  if (most.places > 0) meet_count(f);
}

/// Converts vertex data to doubles, in place.
void convert_data(Surface& s, const std::string& name) {
  expect_data(s, name);
  const Column* c = s.vertex.find(name);
  std::visit([&](const auto& v) { s.vertex.set(name, std::vector<double>(v.begin(), v.end())); },
             decltype(Column::data)(c->data));
}

/// Are these labels of at most n parts? The column may be another program's.
bool has_labels(const Column* column, int n) {
  const auto* labels = column ? std::get_if<std::vector<int>>(&column->data) : nullptr;
  return labels && std::all_of(labels->begin(), labels->end(), [&](int l) { return 0 <= l && l < n; });
}

/// Returns how many triangles narrow places may ask for.
double most_for(double triangles) { return std::max(most_times * triangles, many_triangles); }

/// Throws: GoalMissed if narrow strips ask for many times as many triangles as there should be.
void refuse_costly_strips(std::vector<SizeBound> bounds, double triangles, const SizeReport& r) {
  const double strips = triangles_of_strips(bounds, infinity), limit = most_for(triangles);
  if (strips <= limit) return;
  FailureFacts facts;
  facts.strip_width = std::max(wide_strip * r.narrow.from, 2 * r.narrow.gap);
  auto left = [&] {
    std::erase_if(bounds, [&](const SizeBound& x) { return x.gap < facts.strip_width; });
    return triangles_of_strips(bounds, infinity);
  };
  while (left() > limit) facts.strip_width *= 2;
  throw Informed<GoalMissed>("narrow strips ask for " + shown(std::round(strips)) + " triangles instead of " +
                                 shown(std::round(triangles)) + ": the narrowest is " + shown(r.narrow.gap) +
                                 " wide at " + shown(r.narrow.at),
                             facts);
}

/// Puts the surface back as it was before it was split for its bounds (not the chart table), and throws
/// GoalMissed, if the field asks for more triangles than `limit`, or has taken as many vertices.
void refuse_costly_field(Field& f, double limit, double triangles, const SizeReport& r) {
  const double count = count_for_size(f.s, f.size) + strip_triangles(f, infinity);
  if (count <= limit && (double)(f.s.points.size() - f.given.points.size()) <= limit) return;
  f.s = std::move(f.given);
  throw Informed<GoalMissed>("lines and sheets near each other ask for about " + shown(std::round(count)) +
                                 " triangles instead of " + shown(std::round(triangles)) +
                                 ": the nearest are " + shown(r.narrow.gap) + " apart at " +
                                 shown(r.narrow.at),
                             {.narrow_width = r.narrow.gap});
}

/// Throws: GoalMissed if closed components so slender that the size is more than their circumference, in the
/// mean along their length, ask for many times as many triangles: four edges around are the least.
void refuse_costly_tubes(const Surface& s, const std::vector<int>& opposite, double size, double triangles) {
  constexpr double few_triangles = 1000;
  std::vector<int> component;
  const int n = components(opposite, component);
  std::vector<double> area(n, 0);
  std::vector<Box> box(n, {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}});
  std::vector<char> open(n, 0);
  for (int t = 0; t < (int)s.tris.size(); ++t) {
    const int c = component[t];
    area[c] += triangle_area(s, t);
    box[c] = join(box[c], box_of(s, t));
    for (int h = 3 * t; h < 3 * t + 3; ++h) open[c] |= opposite[h] < 0;
  }
  double asked = 0, narrowest = infinity;
  Vec3 place;
  for (int c = 0; c < n; ++c) {
    const double around = area[c] / norm(box[c].hi - box[c].lo);
    if (open[c] || !(size > around)) continue;
    asked += area[c] / (0.25 * std::sqrt(3.0) * around * around / (ring_edges * ring_edges));
    if (around < narrowest) narrowest = around, place = 0.5 * (box[c].lo + box[c].hi);
  }
  if (asked <= most_times * std::max(triangles, few_triangles)) return;
  throw Informed<GoalMissed>("slender parts ask for " + shown(std::round(asked)) + " triangles instead of " +
                                 shown(std::round(triangles)) + ": the size is " + shown(size) +
                                 ", and the mean way around one is " + shown(narrowest) + ", its middle at " +
                                 shown(place),
                             {.narrow_width = narrowest});
}

/// Returns where the surface permits less than `size`; nothing if it permits that everywhere. With a number
/// of triangles to be met also where it permits less than sizes may grow to elsewhere.
std::vector<SizeBound> bounds_below(const Surface& s, const std::vector<int>& opposite,
                                    const std::vector<double>& size, const SizeOptions& o, SizeReport& report,
                                    std::vector<char>& close) {
  std::vector<double> most = size;
  if (o.triangles > 0)
    for (double& h : most) h *= most_growth;
  const double triangles = o.triangles > 0 ? o.triangles : count_for_size(s, size);
  auto bounds = permitted_sizes({s, opposite, model_of(s)}, most, o.min, most_for(triangles), close);
  for (const SizeBound& x : bounds) {
    const double h = value_along(s, size, x.half_edge, x.place);
    if (!(x.size < h)) continue;
    if (const int n = ++report.narrow.places; n == 1 || x.size < report.narrow.to)
      report.narrow = {n, x.place, h, x.size, x.gap};
  }
  if (report.narrow.places == 0) bounds.clear();
  refuse_costly_strips(bounds, triangles, report);
  return bounds;
}

/// One of --around, --across and --gap: a column, and what it is of the ball that touches opposite sheets.
struct Measured {
  const char* column;
  double edges;     ///< asked for, around or across; 0: not asked for
  double balls;     ///< the column, in radii of the ball
  double per_ball;  ///< length that takes the edges, in radii of the ball
  SheetDistance::Side side;
  double factor() const { return per_ball / (balls * edges); }
};

/// Measures the surface into a vertex column that becomes a source. Where edges longer than their sizes miss
/// what is between their ends they are split, and the new vertices measured.
MeasuredSize measure_sheets(Field& f, const Measured& kind, bool may_split) {
  const SheetDistance sheets({f.s, f.opposite, model_of(f.s)}, kind.side, f.diagonal);
  auto column = [&]() -> std::vector<double>& { return f.s.vertex.get<double>(kind.column); };
  f.s.vertex.set(kind.column, sheets.radii());
  for (double& x : column()) x *= kind.balls;
  auto bound_by_sections = [&] {  // ends and rims are sections, however they are shaped
    if (kind.balls != 1) return;
    const std::vector<double> around = closed_line_lengths({f.s, f.opposite, model_of(f.s)});
    for (std::size_t v = 0; v < around.size(); ++v)
      column()[v] = std::min(column()[v], around[v] / (2 * std::numbers::pi));
  };
  bound_by_sections();
  int known = 0;  // edges between vertices below this one have been looked at
  auto bends = [&](int h) {
    if (std::max(origin(f.s.tris, h), target(f.s.tris, h)) < known) return false;
    const double l = edge_length(f.s, h);
    if (l > longest_edge * f.diagonal) return true;
    const double a = column()[origin(f.s.tris, h)], b = column()[target(f.s.tris, h)];
    if (l < kind.factor() * std::min(a, b)) return false;
    const Vec3 middle = lerp(f.s.points[origin(f.s.tris, h)], f.s.points[target(f.s.tris, h)], 0.5);
    const double there = kind.balls * sheets.radius_at(middle), linear = 0.5 * (a + b);
    return std::abs(there - linear) > interpolation_error * std::min(there, linear);
  };
  for (int pass = 0; may_split && pass < most_passes; ++pass) {
    const std::size_t before = f.s.points.size();
    if (!split(f, bends)) break;
    known = (int)before;
    for (std::size_t v = before; v < f.s.points.size(); ++v)
      column()[v] = kind.balls * sheets.radius_at(f.s.points[v]);
    bound_by_sections();
  }
  f.sources.push_back({kind.column, kind.factor()});
  const std::vector<double>& values = column();
  const std::size_t at = std::min_element(values.begin(), values.end()) - values.begin();
  const auto measured =
      std::count_if(values.begin(), values.end(), [&](double x) { return x < kind.balls * f.diagonal; });
  return {kind.column, kind.edges, (int)measured, values[at], kind.factor() * values[at], f.s.points[at]};
}

/// Bounds a field again that has met its bounds, and returns whether there are any: sheets that were joined
/// within the size asked for need not be within what it is now. The smallest size stays.
bool bound_again(Field& f, double most_triangles) {
  const double least = *std::min_element(f.size.begin(), f.size.end());
  std::vector<char> close;
  if (!f.close.empty()) close = rearranged(f.close, f.root);
  auto bounds = permitted_sizes({f.s, f.opposite, model_of(f.s)}, f.size, least, most_triangles, close);
  std::erase_if(bounds, [&](const SizeBound& x) {
    return !(x.size < much_less * value_along(f.s, f.size, x.half_edge, x.place));
  });
  if (bounds.empty()) return false;
  f.strips += triangles_of_strips(f.bounds, infinity);
  f.bounds = std::move(bounds);
  f.s.vertex.set(permitted_before, f.permits);
  f.given = f.s;
  f.root = identity(f.s.tris.size());
  return true;
}

/// Makes a field that is not uniform; `bounds`, `triangles` and `close` are those of a uniform size, larger
/// than those that follow; 0: not known.
std::vector<double> make_field(Surface& s, Table* chart, const SizeOptions& o, bool may_split,
                               SizeReport& report, std::vector<SizeBound> bounds = {}, double triangles = 0,
                               std::vector<char> close = {}) {
  const bool bounds_known = triangles > 0;
  Field f{.s = s, .chart = chart, .o = o, .diagonal = diagonal(s)};
  f.cap = o.max > 0 ? o.max : infinity;
  if (o.size > 0) f.cap = std::min(f.cap, o.size);
  if (!(o.size > 0 || o.triangles > 0 || o.max > 0 || o.at || !o.data.empty()))
    f.cap = default_size * f.diagonal;
  f.opposite = opposite_halfedges(f.s);
  f.next = neighbors_of(f.s);
  if (o.per_turn > 0 || o.chord > 0 || (o.at && o.at_curvature))
    f.curvature = face_curvature({f.s, f.opposite, model_of(f.s)});
  const std::size_t n_before = s.points.size();
  if (!o.data.empty()) f.sources.push_back({o.data, 1});
  for (const Measured& kind : {Measured{"radius", o.around, 1, 2 * std::numbers::pi, SheetDistance::inside},
                               Measured{"thickness", o.across, 2, 2, SheetDistance::inside},
                               Measured{"gap", o.gap, 2, 2, SheetDistance::outside}})
    if (kind.edges > 0) report.measured.push_back(measure_sheets(f, kind, may_split));
  if (may_split && o.at)
    while (split(f, [&](int h) { return edge_length(f.s, h) > longest_edge * f.diagonal; })) {
    }
  double limit = infinity;  // triangles
  auto follow_field = [&] {
    bool split_last = false;
    for (int pass = 0;; ++pass) {
      set_wishes(f);
      bound_vertices(f);
      const bool meets = !split_last;  // the count: on the surface as it comes, and again once it is split
      if (meets)
        meet_count(f);
      else
        set_sizes(f, f.uniform, f.scale);
      if ((double)(s.points.size() - f.given.points.size()) > limit) break;  // it is refused
      split_last = may_split && pass < most_passes && split(f, [&](int h) { return bends(f, h); });
      if (!split_last && meets) break;
    }
  };
  if (bounds.empty()) {
    follow_field();
    if (std::vector<char> unused; !bounds_known)
      bounds = bounds_below(s, f.opposite, f.size, o, report, unused);
  }
  if (!bounds.empty()) {
    if (!bounds_known) triangles = count_for_size(s, f.size);
    limit = most_for(triangles);
    f.bounds = std::move(bounds);
    f.close = std::move(close);
    f.given = s;
    f.root = identity(s.tris.size());
    follow_field();
  }
  lower_where_narrow(f, report);
  if (!f.bounds.empty()) refuse_costly_field(f, limit, triangles, report);
  if (!f.bounds.empty() && may_split && bound_again(f, limit)) {
    follow_field();
    f.s.vertex.erase(permitted_before);
    refuse_costly_field(f, limit, triangles, report);
  }
  report.strips = strip_triangles(f, std::min({f.uniform, f.cap, f.diagonal}));
  report.added = (int)(s.points.size() - n_before);
  report.scale = f.scale;
  return std::move(f.size);
}

}  // namespace

void refuse_more_triangles(const Mesh& mesh, const std::vector<double>& size, double limit) {
  const double smallest = *std::min_element(size.begin(), size.end());
  if (!(smallest > 0)) return;
  const double triangles = count_for_size(mesh, size);
  if (triangles <= limit) return;
  char why[120];
  std::snprintf(why, sizeof why, "size %.6g asks for %.3g triangles, but memory holds about %.2g", smallest,
                triangles, limit);
  // on a uniform mesh; a tenth is left for what narrow places take
  throw Informed<GoalMissed>(why, sizes_from(size_for_count(total_area(mesh), 0.9 * limit)));
}

void refuse_unresolved_sizes(const Mesh& mesh, const std::vector<double>& size) {
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const Vec3 p = mesh.points[v];
    const double far = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    const double spacing = std::nextafter(far, infinity) - far;
    if (!(size[v] > 0) || size[v] >= least_spacings * spacing) continue;
    const double least = 2 * least_spacings * spacing;  // narrow places get less than what is asked for
    throw Informed<GoalMissed>("vertex " + std::to_string(v) + " has size " + shown(size[v]) +
                                   ", but coordinates there are " + shown(spacing) +
                                   " apart; expected sizes of at least " + shown(least),
                               {.least_size = least, .far_off = far > diagonal(mesh)});
  }
}

void limit_gradation(const Mesh& mesh, const Lists& next, double slope, std::vector<double>& size) {
  auto each_lower = [&](int v, const auto& lower) {
    for (int u : next[v])
      if (size[u] > size[v]) lower(u, size[v] + slope * norm(mesh.points[u] - mesh.points[v]));
  };
  std::vector<int> sources;
  for (int v = 0; v < (int)size.size(); ++v) {
    bool lowers = false;
    each_lower(v, [&](int u, double most) { lowers |= most < size[u]; });
    if (lowers) sources.push_back(v);
  }
  shortest_paths(sources, size, [&](int v, auto reach) { each_lower(v, reach); });
}

int match_sheets(Surface& surface, Table* chart, double slope) {
  const int added = match_borders(surface, chart);
  std::vector<double>& size = surface.vertex.get<double>("size");
  Mesh joined = surface;
  const std::vector<int> vertex = join_borders(joined);
  std::vector<double> least(vertex.size(), infinity);
  for (std::size_t t = 0; t < joined.tris.size(); ++t)
    for (int i = 0; i < 3; ++i)
      least[joined.tris[t][i]] = std::min(least[joined.tris[t][i]], size[surface.tris[t][i]]);
  lower_along_short_lines(joined, least);
  limit_gradation(joined, neighbors_of(joined), slope, least);
  for (std::size_t t = 0; t < joined.tris.size(); ++t)
    for (int i = 0; i < 3; ++i) size[surface.tris[t][i]] = least[joined.tris[t][i]];
  return added;
}

SizeReport set_size(Surface& surface, Table* chart, const SizeOptions& options, bool may_split) {
  if (surface.tris.empty()) throw NotAdmissible("the surface has no triangles");
  if (!options.data.empty()) convert_data(surface, options.data);
  const double area = total_area(surface);
  if (!(area > 0)) throw NotAdmissible("the surface has no area");
  const bool uniform = !(options.per_turn > 0 || options.chord > 0 || options.around > 0 ||
                         options.across > 0 || options.gap > 0 || !options.data.empty() || options.at);
  SizeReport report;
  if (options.layers.first > 0) report.layers = check_layers(surface, options.layers);
  std::vector<double> size;
  if (uniform) {
    double h = options.size > 0 ? options.size : infinity;
    if (options.triangles > 0) h = std::min(h, size_for_count(area, options.triangles));
    if (options.max > 0) h = std::min(h, options.max);
    h = std::max(h, options.min);
    size.assign(surface.points.size(), h);
    const std::vector<int> opposite = opposite_halfedges(surface);
    const double triangles = area / (0.25 * std::sqrt(3.0) * h * h);
    refuse_costly_tubes(surface, opposite, h, triangles);
    std::vector<char> close;
    auto bounds = bounds_below(surface, opposite, size, options, report, close);
    auto fits = [&] {
      const auto feature = feature_size({surface, opposite, model_of(surface)}, {}, size);
      return std::equal(feature.begin(), feature.end(), size.begin(), std::greater_equal<>());
    };
    if (!bounds.empty() || !fits()) {
      SizeOptions o = options;
      o.max = o.max > 0 ? std::min(o.max, most_growth * h) : most_growth * h;
      size = make_field(surface, chart, o, may_split, report, std::move(bounds), triangles, std::move(close));
      report.scale = 1;
    }
  } else {
    size = make_field(surface, chart, options, may_split, report);
  }
  report.triangles = count_for_size(surface, size) + report.strips;
  report.least = report.triangles;
  if (has_labels(surface.face.find("part"), (int)surface.tris.size())) {
    const std::vector<int> opposite = opposite_halfedges(surface);
    report.least = std::max(report.least, count_with_borders({surface, opposite, model_of(surface)},
                                                             surface.face.get<int>("part"), size));
  }
  const auto [least, most] = std::minmax_element(size.begin(), size.end());
  report.smallest = *least, report.largest = *most;
  refuse_more_triangles(surface, size, options.most_triangles);
  refuse_unresolved_sizes(surface, size);
  surface.vertex.set("size", std::move(size));
  return report;
}

}  // namespace meshpipe
