// SPDX-License-Identifier: BSD-3-Clause
#include "lib/param.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <optional>
#include <string>

#include "lib/bisect.h"
#include "lib/error.h"
#include "lib/injective.h"
#include "lib/param_conformal.h"
#include "lib/param_ears.h"
#include "lib/param_optimize.h"
#include "lib/predicates.h"
#include "lib/progress.h"
#include "lib/topology.h"

namespace meshpipe {
namespace {

/// A few of the pairs of vertices whose border edges cross.
std::vector<std::array<int, 2>> sample(const std::vector<std::array<int, 2>>& crossings) {
  constexpr std::size_t most = 4;
  std::vector<std::array<int, 2>> few;
  for (std::size_t k = 0; k < std::min(most, crossings.size()); ++k)
    few.push_back(crossings[(2 * k + 1) * crossings.size() / (2 * std::min(most, crossings.size()))]);
  return few;
}

/// sigma1/sigma2 above which triangles cost the mesher more than some steps of optimisation cost here, and
/// the triangles of a part up to which that is so; larger parts are cut, which costs less than either.
constexpr double poor = 4;
constexpr std::size_t small = 20000;

/// The element at the fraction q of the order.
double quantile(std::vector<double>& values, double q) {
  auto at = values.begin() + (std::ptrdiff_t)(q * (double)(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Solves again, with positive weights, for the inner vertices at most `rings` triangles away from one that
/// is inverted; all others stay.
void solve_patches(const SubMesh& part, const Disk& disk, int rings, std::vector<Vec2>& uv) {
  std::vector<char> fixed(uv.size(), 1), near(uv.size(), 0);
  for (const Tri& t : part.tris)
    if (orient2d(uv[t[0]], uv[t[1]], uv[t[2]]) <= 0)
      for (int v : t) near[v] = 1;
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<char> grown = near;
    for (const Tri& t : part.tris)
      if (near[t[0]] || near[t[1]] || near[t[2]])
        for (int v : t) grown[v] = 1;
    near.swap(grown);
  }
  for (std::size_t v = 0; v < uv.size(); ++v) fixed[v] = !near[v];
  for (const auto& loop : disk.loops)
    for (int h : loop) fixed[origin(part.tris, h)] = 1;
  std::vector<Tri> tris;
  std::vector<double> weights;
  for (const Tri& t : part.tris) {
    if (fixed[t[0]] && fixed[t[1]] && fixed[t[2]]) continue;
    tris.push_back(t);
    for (double w : cotangent_weights(part.points[t[0]], part.points[t[1]], part.points[t[2]], 0.01))
      weights.push_back(std::min(w, 50.0));
  }
  solve_dirichlet(tris, weights, fixed, uv);
}

/// Cuts a limb along its length if its triangles then keep their shape much better in every piece; not across
/// model edges, which would meet the cut at any angle. Returns the new number of parts; n_parts, with nothing
/// changed, if it did not.
int cut_if_flatter(Surface& surface, const SubMesh& part_mesh, int part, int n_parts,
                   const ParamOptions& options, const ParamReport& whole) {
  constexpr double much = 0.6;  // what may be left of the median of sigma1/sigma2 above 1
  constexpr double least_aspect = 2;
  if (topology_of(part_mesh).eta_geo < least_aspect) return n_parts;
  if (surface.face.has("model")) {
    const auto& model = surface.face.get<std::uint8_t>("model");
    const auto opposite = opposite_halfedges(part_mesh.tris, (int)part_mesh.points.size());
    for (std::size_t h = 0; h < opposite.size(); ++h)
      if (opposite[h] >= 0 && (model[part_mesh.face[h / 3]] >> h % 3 & 1)) return n_parts;
  }
  Surface trial = surface;
  const int n = cut_along_limbs(trial, part, n_parts);
  if (n == n_parts) return n_parts;
  std::vector<int> piece = trial.face.get<int>("part");
  for (int& label : piece) label = label == part ? 0 : label < n_parts ? -1 : label - n_parts + 1;
  for (const SubMesh& mesh : split_by_label(trial, piece, n - n_parts + 1)) {
    ParamReport report;
    try {
      map_part(mesh, options, report);
    } catch (const GoalMissed&) {
      return n_parts;
    } catch (const NotAdmissible&) {
      return n_parts;
    }
    if (report.anisotropy_median - 1 > much * (whole.anisotropy_median - 1) ||
        report.anisotropy_p99 > whole.anisotropy_p99)
      return n_parts;
  }
  surface = std::move(trial);
  return n;
}

/// The same map of a part after a cut of its neighbours, which put vertices on the edges of its border; empty
/// if that is not how the part has changed, or if the map is not one-to-one to rounding.
std::vector<Vec2> same_map(const Chart& before, const SubMesh& part, std::size_t n_surface) {
  std::vector<int> place(n_surface, -1);
  for (std::size_t i = 0; i < before.uv.size(); ++i) place[before.mesh.vertex[i]] = (int)i;
  std::vector<Vec2> uv(part.points.size());
  std::size_t added = 0;
  for (std::size_t v = 0; v < uv.size(); ++v) {
    int at = place[part.vertex[v]];
    if (at >= 0)
      uv[v] = before.uv[at];
    else
      ++added;
  }
  auto is_new = [&](int v) { return place[part.vertex[v]] < 0; };
  const std::vector<int> opposite = opposite_halfedges(part.tris, (int)part.points.size());
  for (const auto& loop : boundary_loops(opposite)) {
    auto vertex = [&](std::size_t i) { return origin(part.tris, loop[i % loop.size()]); };
    std::size_t a = 0;
    while (a < loop.size() && is_new(vertex(a))) ++a;
    if (a == loop.size()) return {};
    for (const std::size_t end = a + loop.size(); a < end;) {
      std::size_t b = a + 1;
      while (is_new(vertex(b))) ++b;
      const int from = vertex(a), to = vertex(b);
      const double length = norm(part.points[to] - part.points[from]);
      for (std::size_t i = a + 1; i < b; ++i, --added)
        uv[vertex(i)] = lerp(uv[from], uv[to],
                             norm(part.points[vertex(i)] - part.points[from]) / std::max(length, 1e-300));
      a = b;
    }
  }
  if (added > 0 || count_inverted(part.tris, uv) > 0 || !border_is_simple(part.tris, opposite, uv)) return {};
  return uv;
}

/// What maps of one part share, and the search for one that is one-to-one.
class Search {
 public:
  Search(const SubMesh& part, const ParamOptions& options, ParamReport& report)
      : part_(part), options_(options), report_(report), disk_(disk_of(part)) {
    if (options.neumann && options.map == MapKind::conformal && options.form == ConformalForm::boundary_first)
      throw BadUsage(
          "boundary neumann does not go with boundary first flattening; use least squares or spectral");
  }

  std::vector<Vec2> plain(MapKind kind) {
    if (kind != MapKind::conformal) return on_circle(kind, options_.neumann ? open() : round());
    if (options_.form == ConformalForm::boundary_first) return bent(0);
    const Filled filled = options_.neumann ? open() : flat();
    return options_.form == ConformalForm::spectral ? spectral_map(part_, disk_, filled, &report_.time)
                                                    : least_squares_map(part_, disk_, filled, &report_.time);
  }

  std::vector<Vec2> run(double most_uneven) {
    report_ = {};
    report_.used = options_.map;
    report_.form = options_.form;
    std::vector<Vec2> uv;
    try {
      if (options_.map == MapKind::conformal && options_.form == ConformalForm::boundary_first) {
        report_.area_scale = boundary_first().unevenness();
        if (report_.area_scale > most_uneven) return {};
      }
      uv = plain(options_.map);
      report_.flips_before = count_inverted(part_.tris, uv);
      report_.border_was_simple = border_is_simple(part_.tris, disk_.opposite, uv);
      if (!report_.border_was_simple)
        report_.apart = sample(border_crossings(part_.tris, disk_.opposite, uv));
    } catch (const GoalMissed&) {  // singular to rounding, or a border that does not close
      report_.flips_before = (int)part_.tris.size();
    }
    bool valid = report_.flips_before == 0 && report_.border_was_simple;
    if (!valid) {
      if (options_.strict) refuse();
      valid = !uv.empty() && repaired(uv);
      report_.flips_after = uv.empty() ? report_.flips_before : count_inverted(part_.tris, uv);
    }
    if (!valid && options_.map == MapKind::conformal) valid = try_bends(uv);
    for (MapKind kind : {MapKind::harmonic, MapKind::convex})
      if (!valid && (kind > options_.map || (kind == options_.map && options_.neumann)))
        valid = try_circle(kind, uv);
    if (!valid && options_.map != MapKind::conformal) {
      // circles that shrink a limb below what doubles hold: a free border may not
      std::vector<Vec2> other;
      report_.used = MapKind::conformal;
      if (try_bends(other)) {
        uv = std::move(other);
        valid = true;
      }
    }
    if (!valid) uv.resize(part_.points.size());  // none if every system of equations was singular
    if (!valid && report_.apart.empty()) {
      // what has shrunk to nothing, from the border
      std::vector<std::array<int, 2>> pairs;
      for (const Tri& t : part_.tris)
        if (orient2d(uv[t[0]], uv[t[1]], uv[t[2]]) <= 0)
          pairs.push_back({t[0], origin(part_.tris, disk_.loops[0][0])});
      report_.apart = sample(pairs);
    }
    if (!valid)
      throw GoalMissed("no one-to-one map: " + std::to_string(count_inverted(part_.tris, uv)) + " of " +
                       std::to_string(part_.tris.size()) + " triangles of the convex map inverted or flat");
    measure_distortion(part_, uv, report_);
    // what is valid and poor costs the mesher more than a few steps here
    constexpr int steps_if_poor = 20;
    bool mend = part_.tris.size() <= small && !options_.strict &&
                (report_.used != options_.map || options_.map == MapKind::conformal) &&
                (report_.anisotropy_p99 > poor || report_.anisotropy_mean > 1.5);
    if (int steps = std::max(options_.optimize, mend ? steps_if_poor : 0); steps > 0) lower(uv, steps);
    return uv;
  }

 private:
  /// Lowers the distortion, unless that makes the map worse by its worst triangles.
  void lower(std::vector<Vec2>& uv, int steps) {
    std::vector<Vec2> better = uv;
    ParamReport after = report_;
    after.steps = lower_distortion(part_, disk_, steps, better, &report_.time);
    after.time = report_.time;
    scale_to_area(part_, better);
    if (after.steps == 0 || !valid_map(better)) return;
    measure_distortion(part_, better, after);
    if (options_.optimize == 0 && after.anisotropy_p99 > report_.anisotropy_p99 &&
        after.anisotropy_mean >= report_.anisotropy_mean)
      return;
    report_ = after;
    uv = std::move(better);
  }

  bool valid_map(const std::vector<Vec2>& uv) const {
    return count_inverted(part_.tris, uv) == 0 && border_is_simple(part_.tris, disk_.opposite, uv);
  }

  [[noreturn]] void refuse() const {
    throw GoalMissed("the map is not one-to-one: " + std::to_string(report_.flips_before) + " of " +
                     std::to_string(part_.tris.size()) + " triangles inverted or flat" +
                     (report_.border_was_simple ? "" : ", the border crosses itself"));
  }

  const Filled& open() {
    if (!open_) open_ = open_holes(part_);
    return *open_;
  }
  const Filled& round() {
    if (!round_) round_ = round_holes(part_, disk_);
    return *round_;
  }
  Filled flat() { return flat_holes(part_, disk_); }

  std::vector<Vec2> on_circle(MapKind kind, const Filled& filled) {
    Weights weights = kind == MapKind::harmonic ? Weights::finite_element : options_.weights;
    std::vector<Vec2> uv =
        extend_border(part_, filled, disk_, weights, circle_border(part_, disk_), &report_.time);
    scale_to_area(part_, uv);
    return uv;
  }

  BoundaryFirst& boundary_first() {
    if (!boundary_first_) boundary_first_.emplace(part_, disk_, flat(), &report_.time);
    return *boundary_first_;
  }

  std::vector<Vec2> bent(double bend) {
    std::vector<Vec2> polygon = boundary_first().polygon(bend);
    if (polygon.empty() && bend == 0) throw GoalMissed("the border of the conformal map does not close");
    if (bend > 0 && (polygon.empty() || !polygon_is_simple(polygon))) return {};
    return boundary_first().map(polygon);
  }

  /// Repairs a map whose outer border is simple; true if it is then one-to-one.
  bool repaired(std::vector<Vec2>& uv) {
    std::vector<Vec2> polygon;
    for (int h : disk_.loops[0]) polygon.push_back(uv[origin(part_.tris, h)]);
    if (!polygon_is_simple(polygon)) return false;
    constexpr int sweeps = 10;
    auto stars = [&](std::vector<Vec2>& at) {
      return repair_stars(part_.tris, disk_.opposite, sweeps, at) == 0 && valid_map(at);
    };
    std::vector<Vec2> first = uv;
    if (stars(first)) {
      uv = std::move(first);
      return true;
    }
    try {
      if (report_.used == MapKind::conformal) {
        // the border of the intrinsic triangulation, but harmonic on the triangles that there are
        std::vector<Vec2> again =
            extend_border(part_, round(), disk_, Weights::finite_element, uv, &report_.time);
        if (count_inverted(part_.tris, again) < count_inverted(part_.tris, uv)) uv = std::move(again);
        if (valid_map(uv) || stars(uv)) return true;
      }
      for (int rings : {2, 6}) {
        std::vector<Vec2> again = uv;
        solve_patches(part_, disk_, rings, again);
        if (!stars(again)) continue;
        uv = std::move(again);
        return true;
      }
      std::vector<Vec2> again = extend_border(part_, round(), disk_, Weights::cotangent, uv, &report_.time);
      if (!valid_map(again) && !stars(again)) return false;
      uv = std::move(again);
      return true;
    } catch (const GoalMissed&) {  // singular to rounding
      return false;
    }
  }

  bool try_bends(std::vector<Vec2>& uv) {
    try {
      for (double bend : {0.0, 0.03, 0.06, 0.12, 0.25, 0.5, 1.0}) {
        if (bend == 0 && options_.map == MapKind::conformal && options_.form == ConformalForm::boundary_first)
          continue;  // that was the map asked for
        uv = bent(bend);
        if (uv.empty() || (!valid_map(uv) && !repaired(uv))) continue;
        report_.bend = bend;
        report_.form = ConformalForm::boundary_first;
        return true;
      }
    } catch (const GoalMissed&) {
    }
    return false;
  }

  bool try_circle(MapKind kind, std::vector<Vec2>& uv) {
    try {
      report_.used = kind;
      uv = on_circle(kind, round());
      return valid_map(uv) || repaired(uv);
    } catch (const GoalMissed&) {
      return false;
    }
  }

  const SubMesh& part_;
  const ParamOptions& options_;
  ParamReport& report_;
  Disk disk_;
  std::optional<Filled> open_, round_;
  std::optional<BoundaryFirst> boundary_first_;
};

}  // namespace

void measure_distortion(const SubMesh& part, const std::vector<Vec2>& uv, ParamReport& report) {
  std::vector<double> anisotropy, scale;
  double part_area = 0, sum = 0, chart_area = 0, smallest = HUGE_VAL, least = HUGE_VAL, most = 0;
  constexpr double most_finite = std::numeric_limits<double>::max();
  std::array<int, 2> extremes{0, 0};
  for (const Tri& t : part.tris) {
    Vec3 e = part.points[t[1]] - part.points[t[0]], f = part.points[t[2]] - part.points[t[0]];
    Vec2 p = uv[t[1]] - uv[t[0]], q = uv[t[2]] - uv[t[0]];
    double image = 0.5 * cross(p, q), l = norm(e), area = 0.5 * norm(cross(e, f));
    chart_area += image;
    smallest = std::min(smallest, image);
    if (!(area > 0)) continue;
    // the derivatives along the first edge and across it, and from them the two parts of the map that keep
    // and that reverse angles; sigma1 and sigma2 are the sum and the difference of their norms
    Vec2 x = (1 / l) * p, y = (l / (2 * area)) * (q - (dot(e, f) / (l * l)) * p);
    double keep = 0.5 * std::hypot(x.x + y.y, x.y - y.x), reverse = 0.5 * std::hypot(x.x - y.y, x.y + y.x);
    // sigma2 from the determinant, for the difference may cancel; finite, for a table has to hold it
    double sigma = keep + reverse, determinant = image / area;
    anisotropy.push_back(std::min(determinant > 0 ? sigma * (sigma / determinant) : HUGE_VAL, most_finite));
    part_area += area;
    sum += area * anisotropy.back();
    scale.push_back(image / area);
    if (scale.back() < least) least = scale.back(), extremes[0] = t[0];
    if (scale.back() > most) most = scale.back(), extremes[1] = t[0];
  }
  if (anisotropy.empty()) return;
  report.anisotropy_median = quantile(anisotropy, 0.5);
  report.anisotropy_p99 = quantile(anisotropy, 0.99);
  report.anisotropy_max = quantile(anisotropy, 1);
  double low = quantile(scale, 0.01);
  report.area_scale = std::min(low > 0 ? quantile(scale, 0.99) / low : HUGE_VAL, most_finite);
  report.smallest_area = smallest / chart_area;
  report.anisotropy_mean = std::min(sum / part_area, most_finite);
  if (report.apart.empty()) report.apart.push_back(extremes);
}

std::vector<Vec2> plain_map(const SubMesh& part, const ParamOptions& options) {
  ParamReport report;
  return Search(part, options, report).plain(options.map);
}

std::vector<Vec2> map_part(const SubMesh& part, const ParamOptions& options, ParamReport& report,
                           double most_uneven) {
  return Search(part, options, report).run(most_uneven);
}

std::vector<Chart> map_surface(Surface& surface, int n_parts, const ParamOptions& options,
                               std::vector<ParamReport>& reports) {
  constexpr int most_rounds = 24, limb_rounds = 2, stretched_rounds = 12, even_rounds = 12;
  constexpr double too_uneven = 1e8, unresolved = 1e16;  // edges of 1e-8 of the chart keep half their digits
  constexpr double too_stretched = 4;                    // sigma1/sigma2, the mean over the area
  constexpr double too_steep = 1.05;                     // sigma1/sigma2, the median
  constexpr std::size_t least_triangles = 50;            // of a part that is cut for the sake of its shape
  constexpr std::size_t least_of_a_limb = 500;
  if (!options.strict && options.map != MapKind::conformal) split_ears(surface, n_parts);
  std::vector<Chart> charts;
  std::vector<char> waiting, whole;  // whole: too uneven, but nothing to be done about it
  reports.clear();
  for (int round = 0;; ++round) {
    // a part is mapped anew if it was cut, or if its map does not hold after the cut of a neighbour
    std::vector<SubMesh> parts = split_by_label(surface, surface.face.get<int>("part"), n_parts);
    charts.resize(n_parts);
    reports.resize(n_parts);
    waiting.resize(n_parts, 1);
    whole.resize(n_parts, 0);
    for (int p = 0; p < n_parts; ++p) {
      if (!waiting[p] && parts[p].vertex != charts[p].mesh.vertex) {
        charts[p].uv = same_map(charts[p], parts[p], surface.points.size());
        waiting[p] = charts[p].uv.empty();
        if (!waiting[p]) measure_distortion(parts[p], charts[p].uv, reports[p]);
      }
      charts[p].mesh = std::move(parts[p]);
    }

    std::vector<std::exception_ptr> failure(n_parts);
#pragma omp parallel for schedule(dynamic)
    for (int p = 0; p < n_parts; ++p) {
      if (!waiting[p]) continue;
      try {
        bool any = options.strict || round >= limb_rounds || whole[p];
        charts[p].uv = map_part(charts[p].mesh, options, reports[p], any ? HUGE_VAL : too_uneven);
        if (round == 0) add_progress((double)charts[p].mesh.tris.size() / (double)surface.tris.size());
      } catch (const GoalMissed& e) {
        failure[p] = std::make_exception_ptr(GoalMissed("part " + std::to_string(p) + ": " + e.what()));
      } catch (const NotAdmissible& e) {
        failure[p] = std::make_exception_ptr(NotAdmissible("part " + std::to_string(p) + ": " + e.what()));
      } catch (...) {
        failure[p] = std::current_exception();
      }
    }
    int n_before = n_parts;
    for (int p = 0; p < n_before; ++p) {
      bool fresh = waiting[p], missed = false;
      waiting[p] = 0;
      if (!fresh) continue;
      try {
        if (failure[p]) std::rethrow_exception(failure[p]);
      } catch (const GoalMissed&) {
        missed = true;
      }
      int n = n_parts;
      double uneven = missed ? HUGE_VAL : reports[p].area_scale;
      if (!options.strict && round < most_rounds) {
        // a circle map that was asked for is the user's own choice
        bool chosen = reports[p].used == options.map && options.map != MapKind::conformal;
        bool stretched = !missed && !chosen && round < stretched_rounds &&
                         reports[p].anisotropy_mean > too_stretched &&
                         charts[p].mesh.tris.size() >= least_triangles;
        bool limbs = !missed && !whole[p] && round < limb_rounds && uneven > too_uneven;
        if (missed || limbs || stretched || reports[p].anisotropy_p99 > poor)
          n_parts = cut_along_model_edges(surface, p, n_parts);
        if (n_parts == n && (limbs || stretched)) n_parts = cut_along_limbs(surface, p, n_parts);
        if (n_parts == n && !missed && !chosen && round < limb_rounds &&
            reports[p].anisotropy_median > too_steep && charts[p].mesh.tris.size() >= least_of_a_limb)
          n_parts = cut_if_flatter(surface, charts[p].mesh, p, n_parts, options, reports[p]);
        whole[p] = charts[p].uv.empty() && !missed && n_parts == n;
        if (n_parts == n && !whole[p] && (uneven > unresolved || stretched)) {
          // places that should be apart, and halves of the part; the latter first if the former has not
          // helped
          std::vector<std::array<int, 2>> choice[2] = {reports[p].apart, {}};
          if (round >= limb_rounds) std::swap(choice[0], choice[1]);
          const bool peeled = missed && round >= even_rounds;  // little by little
          if ((peeled && bisect_part(surface, p, n_parts, {}, true)) ||
              bisect_part(surface, p, n_parts, choice[0]) || bisect_part(surface, p, n_parts, choice[1]))
            ++n_parts;
        }
      }
      if (n_parts > n || whole[p])
        waiting[p] = 1;
      else if (missed)
        std::rethrow_exception(failure[p]);
    }
    if (std::find(waiting.begin(), waiting.end(), 1) == waiting.end()) break;
  }
  return charts;
}

}  // namespace meshpipe
