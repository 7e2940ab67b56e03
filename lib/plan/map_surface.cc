// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>

#include "lib/core/error.h"
#include "lib/core/parallel.h"
#include "lib/core/progress.h"
#include "lib/core/topology.h"
#include "lib/partition/partition.h"
#include "lib/plan/bisect.h"
#include "lib/plan/plan.h"

namespace meshpipe {
namespace {

/// What is known of every part while charts are made.
struct Charts {
  std::vector<Chart> chart;
  std::vector<ParamReport> report;
  std::vector<std::string> failure;  ///< why there is no map; empty if there is one
  std::vector<char> waiting;         ///< for a map
  std::vector<char> as_it_is;        ///< its area scale is too large, but no cut along its limbs helps
};

/// Returns the map of a chart for the same part after cuts of its neighbors have split edges of its border:
/// the images of these edges are split alike. Empty if that is not one-to-one, or the part is another. `row`:
/// -1 per vertex of the surface, before and after the call.
std::vector<Vec2> with_split_border(const Chart& chart, const SubMesh& part, std::vector<int>& row) {
  const std::size_t n = part.points.size(), added = n - chart.uv.size();
  if (part.tris.size() != chart.mesh.tris.size() + added) return {};
  for (std::size_t i = 0; i < chart.uv.size(); ++i) row[chart.mesh.vertex[i]] = (int)i;
  std::vector<Vec2> uv(n);
  std::vector<char> known(n, 0);
  for (std::size_t v = 0; v < n; ++v)
    if (const int i = row[part.vertex[v]]; i >= 0) uv[v] = chart.uv[i], known[v] = 1;
  for (int v : chart.mesh.vertex) row[v] = -1;
  const std::vector<int> opposite = opposite_halfedges(part);
  std::size_t found = 0;
  for (const std::vector<int>& loop : boundary_loops(opposite)) {
    auto vertex = [&](std::size_t i) { return origin(part.tris, loop[i % loop.size()]); };
    auto length = [&](std::size_t i, std::size_t k) {
      return norm(part.points[vertex(k)] - part.points[vertex(i)]);
    };
    for (std::size_t i = 0, last = loop.size(); i < loop.size(); ++i, ++last) {
      std::size_t end = i + 1;  // of the edge that was split
      while (end < last && known[vertex(i)] && !known[vertex(end)]) ++end;
      for (std::size_t k = i + 1; k < end && end < last; ++k, ++found)
        uv[vertex(k)] = lerp(uv[vertex(i)], uv[vertex(end)], length(i, k) / length(i, end));
    }
  }
  const bool holds = found == added && count_inverted(part.tris, uv) == 0;
  return holds && border_is_simple({part, opposite}, uv) ? uv : std::vector<Vec2>();
}

/// Takes the parts as they are after cuts. One that was not cut itself keeps its map if that can be extended.
void take_parts(const Surface& surface, int n_parts, Charts& charts) {
  std::vector<SubMesh> parts = split_by_label(surface, surface.face.get<int>("part"), n_parts);
  charts.chart.resize(n_parts), charts.report.resize(n_parts), charts.failure.resize(n_parts);
  charts.waiting.resize(n_parts, 1), charts.as_it_is.resize(n_parts, 0);
  std::vector<int> row(surface.points.size(), -1);
  for (int p = 0; p < n_parts; ++p) {
    Chart& chart = charts.chart[p];
    if (!charts.waiting[p] && parts[p].vertex != chart.mesh.vertex) {
      chart.uv = with_split_border(chart, parts[p], row);
      charts.waiting[p] = chart.uv.empty();
      charts.report[p].apart.clear();
      if (!charts.waiting[p]) measure_distortion(parts[p], chart.uv, charts.report[p]);
    }
    chart.mesh = std::move(parts[p]);
  }
}

/// Takes maps that are known, one-to-one and of the part as it is, and the reports of parts that have none.
void take_known(std::vector<Chart> known, const std::vector<ParamReport>& reports, Charts& charts) {
  for (std::size_t p = 0; p < std::min(known.size(), charts.chart.size()); ++p) {
    const SubMesh& mesh = charts.chart[p].mesh;
    const bool holds = known[p].mesh.vertex == mesh.vertex && count_inverted(mesh.tris, known[p].uv) == 0;
    charts.waiting[p] = !holds;
    if (!holds && !known[p].uv.empty()) continue;
    charts.chart[p].uv = std::move(known[p].uv);
    charts.report[p] = reports[p];
  }
}

/// Maps the parts that wait for it, in parallel.
void map_waiting(const ParamOptions& options, int round, std::size_t n_triangles, Charts& charts) {
  parallel_for((int)charts.chart.size(), [&](int p) {
    if (!charts.waiting[p]) return;
    if (round == 0 && !options.strict && charts.report[p].area_scale > limit::area_scale) return;
    Chart& chart = charts.chart[p];
    charts.failure[p].clear();
    try {
      const bool any = options.strict || round >= limit::limb_rounds || charts.as_it_is[p];
      chart.uv = map_part(chart.mesh, options, charts.report[p], any ? infinity : limit::area_scale);
      if (round == 0) add_progress((double)chart.mesh.tris.size() / (double)n_triangles);
    } catch (const GoalMissed& e) {
      charts.failure[p] = "part " + std::to_string(p) + ": " + e.what();
    } catch (const NotAdmissible& e) {
      throw NotAdmissible("part " + std::to_string(p) + ": " + e.what());
    }
  });
}

/// Cuts a part without a map, or with a poor one. Returns the new number of parts, n_parts if it stays as it
/// is; sets as_it_is[p] if it has to be mapped all the same.
int cut_again(Surface& surface, int p, int n_parts, const ParamOptions& options, int round, Charts& charts) {
  const ParamReport& report = charts.report[p];
  const SubMesh& mesh = charts.chart[p].mesh;
  const bool missed = !charts.failure[p].empty();
  const double area_scale = missed ? infinity : report.area_scale;
  const bool chosen = is_own_choice(report, options);
  const bool stretched =
      !missed && !chosen && round < limit::stretched_rounds &&
      (report.anisotropy_p99 > limit::anisotropy ||
       (report.anisotropy_mean > limit::mean_anisotropy && mesh.tris.size() >= limit::least_triangles));
  const bool limbs =
      !missed && !charts.as_it_is[p] && round < limit::limb_rounds && area_scale > limit::area_scale;
  const int n = limbs || stretched ? cut_along_limbs(surface, p, n_parts) : n_parts;
  charts.as_it_is[p] = charts.chart[p].uv.empty() && !missed && n == n_parts;
  if (n > n_parts || charts.as_it_is[p] || !(area_scale > limit::unresolved_area_scale || stretched))
    return n;
  // between places that should be apart, and in halves; the latter first if the former has not helped
  std::vector<std::array<int, 2>> choice[2] = {report.apart, {}};
  for (auto& pair : choice[0]) pair = {mesh.vertex[pair[0]], mesh.vertex[pair[1]]};
  if (round >= limit::limb_rounds) std::swap(choice[0], choice[1]);
  return n_parts +
         (bisect_part(surface, p, n_parts, choice[0]) || bisect_part(surface, p, n_parts, choice[1]));
}

/// Leaves parts that might be cut, by the reasons of cut_again, without a map, and reports why one has none.
void leave_poor(bool strict, Charts& charts) {
  for (std::size_t p = 0; p < charts.chart.size(); ++p) {
    ParamReport& r = charts.report[p];
    if (charts.failure[p].empty() &&
        (strict || (r.area_scale <= limit::area_scale && r.anisotropy_mean <= limit::mean_anisotropy)))
      continue;
    const double scale = charts.chart[p].uv.empty() ? r.area_scale : 1;
    charts.chart[p].uv.clear();
    r = {}, r.area_scale = scale;
  }
}

}  // namespace

std::vector<Chart> map_surface(Surface& surface, int n_parts, const ParamOptions& options,
                               std::vector<ParamReport>& reports, std::vector<Chart> known, bool alone) {
  if (!options.strict && options.map != MapKind::conformal) split_ears(surface, n_parts);
  Charts charts;
  for (int round = 0;; ++round) {
    take_parts(surface, n_parts, charts);
    if (round == 0) take_known(std::move(known), reports, charts);
    map_waiting(options, round, surface.tris.size(), charts);
    if (alone) leave_poor(options.strict, charts);
    if (alone) break;
    const bool may_cut = !options.strict && round < limit::most_rounds;
    for (int p = 0, n = n_parts; p < n; ++p) {
      if (!charts.waiting[p]) continue;
      const int before = n_parts;
      if (may_cut) n_parts = cut_again(surface, p, n_parts, options, round, charts);
      charts.waiting[p] = n_parts > before || (may_cut && charts.as_it_is[p]);
      if (!charts.waiting[p] && !charts.failure[p].empty()) throw GoalMissed(charts.failure[p]);
    }
    if (std::count(charts.waiting.begin(), charts.waiting.end(), 1) == 0) break;
  }
  reports = std::move(charts.report);
  return std::move(charts.chart);
}

}  // namespace meshpipe
