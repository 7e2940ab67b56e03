// SPDX-License-Identifier: BSD-3-Clause
#include "lib/param/param.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include "lib/core/error.h"
#include "lib/core/predicates.h"
#include "lib/param/conformal.h"
#include "lib/param/optimize.h"

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

/// sigma1/sigma2 above which triangles cost the mesher more than some steps of optimization cost here, and
/// the triangles of a part up to which that is so; larger parts are cut, which costs less than either.
constexpr double poor = 4;
constexpr std::size_t small = 20000;
/// sigma1/sigma2, in the mean over the area, from where on a map is all but a line: points of a mesh in it
/// fall together.
constexpr double absurd = 100;

/// The element at the fraction q of the order.
double quantile(std::vector<double>& values, double q) {
  auto at = values.begin() + (std::ptrdiff_t)(q * (double)(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// A map to try where the one asked for, and its repair, is not one-to-one or all but a line.
struct Fallback {
  MapKind kind;
  double bend = 0;  ///< of a conformal map's border, towards a circle
};

/// What is tried, in order. A circle can shrink a limb below what doubles hold, so that conformal maps, whose
/// border is free, come first where they were asked for, and last where they were not.
std::vector<Fallback> fallbacks(const ParamOptions& asked) {
  std::vector<Fallback> circle, conformal;
  for (MapKind kind : {MapKind::harmonic, MapKind::convex})
    if (kind > asked.map || (kind == asked.map && asked.neumann)) circle.push_back({kind});
  for (double bend : {0.0, 0.03, 0.06, 0.12, 0.25, 0.5, 1.0})
    if (bend > 0 || asked.map != MapKind::conformal || asked.form != ConformalForm::boundary_first)
      conformal.push_back({MapKind::conformal, bend});
  std::vector<Fallback>& first = asked.map == MapKind::conformal ? conformal : circle;
  const std::vector<Fallback>& last = asked.map == MapKind::conformal ? circle : conformal;
  first.insert(first.end(), last.begin(), last.end());
  return first;
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
    return options_.form == ConformalForm::spectral ? spectral_map(part_, disk_, filled)
                                                    : least_squares_map(part_, disk_, filled);
  }

  /// The map asked for, its repair, or the first of the fallbacks that is one-to-one and more than a line; if
  /// none is, the one with the least sigma1/sigma2.
  std::vector<Vec2> run(double most_uneven) {
    report_ = {};
    report_.used = options_.map;
    report_.form = options_.form;
    if (is_too_uneven(most_uneven)) return {};
    std::vector<Vec2> uv = asked_for();
    bool valid = report_.flips_before == 0 && report_.border_was_simple;
    if (!valid && options_.strict) refuse();
    if (!valid) {
      valid = !uv.empty() && repaired(uv);
      report_.flips_after = uv.empty() ? report_.flips_before : count_inverted(part_.tris, uv);
    }
    if (valid) measure_distortion(part_, uv, report_);
    for (const Fallback& next : fallbacks(options_)) {
      if (valid && !is_all_but_a_line()) break;
      const ParamReport before = report_;
      std::vector<Vec2> trial = uv;
      const bool found = try_next(next, trial);
      if (found && report_.border_was_simple) report_.apart.clear();
      if (found) measure_distortion(part_, trial, report_);
      if (!valid || (found && report_.anisotropy_mean < before.anisotropy_mean))
        uv = std::move(trial), valid = found;
      else
        report_ = before;
    }
    if (!valid) give_up(uv);
    // what is valid and poor costs the mesher more than a few steps here
    constexpr int steps_if_poor = 20;
    const bool improve = part_.tris.size() <= small && !options_.strict &&
                         (report_.used != options_.map || options_.map == MapKind::conformal) &&
                         (report_.anisotropy_p99 > poor || report_.anisotropy_mean > 1.5);
    if (int steps = std::max(options_.optimize, improve ? steps_if_poor : 0); steps > 0) lower(uv, steps);
    return uv;
  }

 private:
  /// Is the area scale of the conformal map, known before it is solved for, above the limit?
  bool is_too_uneven(double limit) {
    if (options_.map != MapKind::conformal || options_.form != ConformalForm::boundary_first) return false;
    try {
      report_.area_scale = std::min(boundary_first().area_distortion(), std::numeric_limits<double>::max());
    } catch (const GoalMissed&) {  // singular to rounding
    }
    return report_.area_scale > limit;
  }

  /// The map asked for, as it comes; none if it is singular to rounding, or its border does not close.
  std::vector<Vec2> asked_for() {
    std::vector<Vec2> uv;
    try {
      uv = plain(options_.map);
    } catch (const GoalMissed&) {
      report_.flips_before = (int)part_.tris.size();
      return {};
    }
    report_.flips_before = count_inverted(part_.tris, uv);
    report_.border_was_simple = border_is_simple({part_, disk_.opposite}, uv);
    if (!report_.border_was_simple) report_.apart = sample(border_crossings({part_, disk_.opposite}, uv));
    return uv;
  }

  /// Replaces uv by this map if it is one-to-one, as it comes or repaired; by a circle map in any case.
  bool try_next(const Fallback& next, std::vector<Vec2>& uv) {
    const bool conformal = next.kind == MapKind::conformal;
    report_.used = next.kind;
    std::vector<Vec2> trial;
    bool valid = false;
    try {
      trial = conformal ? bent(next.bend) : on_circle(next.kind, round());
      valid = !trial.empty() && (valid_map(trial) || repaired(trial));
    } catch (const GoalMissed&) {  // singular to rounding, or a border that does not close
    }
    if (valid) report_.bend = next.bend;
    if (valid && conformal) report_.form = ConformalForm::boundary_first;
    if (valid || (!conformal && !trial.empty())) uv = std::move(trial);
    return valid;
  }

  [[noreturn]] void give_up(std::vector<Vec2>& uv) {
    uv.resize(part_.points.size());  // none if every system of equations was singular
    if (report_.apart.empty()) {
      // what has shrunk to nothing, from the border
      std::vector<std::array<int, 2>> pairs;
      for (const Tri& t : part_.tris)
        if (orient2d(uv[t[0]], uv[t[1]], uv[t[2]]) <= 0)
          pairs.push_back({t[0], origin(part_.tris, disk_.loops[0][0])});
      report_.apart = sample(pairs);
    }
    throw GoalMissed("no one-to-one map: " + std::to_string(count_inverted(part_.tris, uv)) + " of " +
                     std::to_string(part_.tris.size()) + " triangles of the convex map inverted or flat");
  }

  /// Lowers the distortion, unless that makes the map worse by its worst triangles.
  void lower(std::vector<Vec2>& uv, int steps) {
    std::vector<Vec2> better = uv;
    ParamReport after = report_;
    after.steps = lower_distortion(part_, disk_, steps, better);
    scale_to_area(part_, better);
    if (after.steps == 0 || !valid_map(better)) return;
    measure_distortion(part_, better, after);
    if (options_.optimize == 0 && after.anisotropy_p99 > report_.anisotropy_p99 &&
        after.anisotropy_mean >= report_.anisotropy_mean)
      return;
    report_ = after;
    uv = std::move(better);
  }

  bool is_all_but_a_line() const {
    return !options_.strict && !is_own_choice(report_, options_) && !(report_.anisotropy_mean <= absurd);
  }

  bool valid_map(const std::vector<Vec2>& uv) const {
    return count_inverted(part_.tris, uv) == 0 && border_is_simple({part_, disk_.opposite}, uv);
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
    std::vector<Vec2> uv = extend_border(part_, filled, disk_, weights, circle_border(part_, disk_));
    scale_to_area(part_, uv);
    return uv;
  }

  BoundaryFirst& boundary_first() {
    if (!boundary_first_) boundary_first_.emplace(part_, disk_, flat());
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
      return repair_stars({part_, disk_.opposite}, sweeps, at) == 0 && valid_map(at);
    };
    std::vector<Vec2> first = uv;
    if (stars(first)) {
      uv = std::move(first);
      return true;
    }
    try {
      if (report_.used == MapKind::conformal) {
        // the border of the intrinsic triangulation, but harmonic on the triangles that there are
        std::vector<Vec2> again = extend_border(part_, round(), disk_, Weights::finite_element, uv);
        if (count_inverted(part_.tris, again) < count_inverted(part_.tris, uv)) uv = std::move(again);
        if (valid_map(uv) || stars(uv)) return true;
      }
      std::vector<Vec2> again = extend_border(part_, round(), disk_, Weights::cotangent, uv);
      if (!valid_map(again) && !stars(again)) return false;
      uv = std::move(again);
      return true;
    } catch (const GoalMissed&) {  // singular to rounding
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
  double part_area = 0, sum = 0, chart_area = 0, smallest = infinity, least = infinity, most = 0;
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
    anisotropy.push_back(std::min(determinant > 0 ? sigma * (sigma / determinant) : infinity, most_finite));
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
  report.area_scale = std::min(low > 0 ? quantile(scale, 0.99) / low : infinity, most_finite);
  report.smallest_area = smallest / chart_area;
  report.anisotropy_mean = std::min(sum / part_area, most_finite);
  if (report.apart.empty()) report.apart.push_back(extremes);
}

std::vector<Vec2> map_part(const SubMesh& part, const ParamOptions& options, ParamReport& report,
                           double most_uneven) {
  return Search(part, options, report).run(most_uneven);
}

}  // namespace meshpipe
