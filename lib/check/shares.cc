// SPDX-License-Identifier: BSD-3-Clause
#include "lib/check/shares.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "lib/check/check.h"
#include "lib/core/boxes.h"
#include "lib/core/intersect.h"
#include "lib/core/lists.h"
#include "lib/core/topology.h"
#include "lib/core/triangle_count.h"

namespace meshpipe {
namespace {

constexpr double reach = 2;          // edges: farther away, a distance is more than is allowed
constexpr double longest = 4;        // edges: longer triangles of the reference are halved
constexpr double small_ratio = 0.5;  // of the allowed distance: sizes stay where it is no more
constexpr int bounded_effort = 64, free_effort = 8;  // points per sample, as in distance_between

/// Appends a mesh with triangles halved until no edge is longer than `most`; halves have new vertices.
void append_halved(const Mesh& mesh, double most, Mesh& out) {
  const int first = (int)out.points.size();
  out.points.insert(out.points.end(), mesh.points.begin(), mesh.points.end());
  std::vector<Tri> left;
  for (const auto& [x, y, z] : mesh.tris) {
    left.push_back({x + first, y + first, z + first});
    while (!left.empty()) {
      const Tri t = take_last(left);
      int edge = 0;
      double length = -1;
      for (int i = 0; i < 3; ++i)
        if (const double l = norm(out.points[t[(i + 1) % 3]] - out.points[t[i]]); l > length)
          edge = i, length = l;
      if (length <= most) {
        out.tris.push_back(t);
        continue;
      }
      const int a = t[edge], b = t[(edge + 1) % 3], c = t[(edge + 2) % 3], m = (int)out.points.size();
      out.points.push_back(lerp(out.points[a], out.points[b], 0.5));
      left.push_back({m, b, c});
      left.push_back({a, m, c});
    }
  }
}

}  // namespace

void cut_check(const Mesh& result, const Mesh& reference, const std::vector<double>& allowed, int triangles,
               int samples, double most, const TakeShare& take) {
  const double d = diagonal(reference), area[2] = {total_area(reference), total_area(result)};
  const int n = (int)result.tris.size();
  const double edge = size_for_count(area[1], n);
  Mesh both = result;
  append_halved(reference, longest * edge, both);
  const auto boxes = split_into_boxes(both, identity(both.tris.size()), 2 * triangles);
  const Lists around = around_tiles(both, boxes, reach, nullptr, reach * edge);
  const long long enough = ((long long)reference.tris.size() + n) / 4 + 500;
  const int effort = (most > 0 ? bounded_effort : free_effort) * samples;
  samples = (int)std::min<long long>(samples, enough);
  for (int i = 0; i < (int)boxes.size(); ++i) {
    CheckShare share;
    share.diagonal = d > 0 ? d : 1, share.most = most;
    std::vector<int> others;
    std::array<double, 2> part{0, 0};
    for (int t : boxes[i]) part[t < n] += triangle_area(both, t);
    for (const std::span<const int> rows : {std::span<const int>(boxes[i]), around[i]}) {
      const auto middle = std::lower_bound(rows.begin(), rows.end(), n);
      share.triangles.insert(share.triangles.end(), rows.begin(), middle);
      others.insert(others.end(), middle, rows.end());
      if (rows.data() == boxes[i].data())
        share.own = (int)share.triangles.size(), share.other_own = (int)others.size();
    }
    share.mesh = part_of(both, share.triangles, &share.vertices), share.other = part_of(both, others);
    for (int t : share.triangles) share.allowed.push_back(allowed[t]);
    for (int side : {0, 1}) {
      const double of = area[side] > 0 ? part[side] / area[side] : 1;
      share.samples[side] = std::max(1, (int)(samples * of));
      share.budget[side] = std::max(1000, (int)(effort * of));
    }
    take(std::move(share), i, (int)boxes.size());
  }
}

namespace {

/// A surface with what searches need, which there is only if it has triangles.
struct Side {
  Side(const Mesh& mesh, int first) : surface{mesh, opposite} {
    if (mesh.tris.empty()) return;
    opposite = opposite_halfedges(mesh), tree.emplace(mesh);
    std::copy_if(tree->order().begin(), tree->order().end(), std::back_inserter(own),
                 [&](int t) { return t < first; });
  }
  std::vector<int> opposite, own;  ///< own: the first triangles, neighbors close together
  Connectivity surface;
  std::optional<Bvh> tree;
};

/// What is measured where there is nothing within reach: as far as can be.
OneWay far_away(const CheckShare& share, Vec3 place) {
  OneWay d;
  d.largest = d.upper = d.mean = d.rms = share.diagonal;
  d.place = d.deviation.place = place;
  d.deviation.worst = reach / most_deviation;  // at least
  return d;
}

/// Measures from one side, 0: the reference, to the other.
void measure_from(const CheckShare& share, int side, const Side& from, const Side& to, ShareFindings& f) {
  const Mesh& mesh = from.surface.mesh;
  for (int t : from.own) f.area[side] += triangle_area(mesh, t);
  if (from.own.empty()) return;
  OneWay& d = f.distance[side];
  if (!to.tree) return void(d = far_away(share, mesh.points[mesh.tris[from.own[0]][0]]));
  d = distance_from(mesh, from.own, to.surface, *to.tree,
                    {share.samples[side], share.budget[side], share.diagonal, share.most, side == 1},
                    share.allowed);
  for (std::size_t t = 0; t < d.deviation.ratio.size(); ++t)
    if (d.deviation.ratio[t] > small_ratio) f.ratios.push_back({share.triangles[t], d.deviation.ratio[t]});
  d.deviation.ratio = {};
  if (d.deviation.triangle >= 0) d.deviation.triangle = share.triangles[d.deviation.triangle];
}

/// Finds folds between own triangles and others, and the distances of vertices of own ones.
void measure_result(const CheckShare& share, const Side& result, const Side& reference, ShareFindings& f) {
  std::vector<double> off(share.mesh.points.size(), share.diagonal);
  if (reference.tree) {
    off = vertex_distances(share.mesh, result.own, reference.surface, *reference.tree);
    auto whole = [&](int h) { return 3 * share.triangles[h / 3] + h % 3; };
    for (int h : find_folds(result.surface, share.other, *reference.tree))
      if (const int g = result.surface.opposite[h]; std::min(h, g) / 3 < share.own)
        f.folds.push_back(std::min(whole(h), whole(g)));
  }
  std::vector<char> used(off.size());
  for (int t : result.own)
    for (int v : share.mesh.tris[t])
      if (!std::exchange(used[v], 1)) f.off.push_back({share.vertices[v], off[v]});
  for (const auto& [s, t] : self_intersections(share.mesh, *result.tree, share.own))
    f.intersections.push_back(std::minmax(share.triangles[s], share.triangles[t]));
}

}  // namespace

ShareFindings measure(const CheckShare& share) {
  const Side reference(share.other, share.other_own), result(share.mesh, share.own);
  ShareFindings f;
  measure_from(share, 0, reference, result, f);
  measure_from(share, 1, result, reference, f);
  if (share.own > 0) measure_result(share, result, reference, f);
  return f;
}

Measured join_findings(const std::vector<ShareFindings>& shares, const Mesh& result, double diagonal,
                       std::vector<double> allowed) {
  Measured m;
  const double unit = diagonal > 0 ? diagonal : 1;
  m.off.assign(result.points.size(), infinity);
  Deviation& deviation = m.distance.deviation;
  deviation.ratio.assign(result.tris.size(), 0);
  double largest[2] = {0, 0}, upper = 0, area[2] = {0, 0}, mean[2] = {0, 0}, squares[2] = {0, 0};
  for (const ShareFindings& f : shares) {
    for (int side : {1, 0}) {
      const OneWay& d = f.distance[side];
      if (d.largest >= std::max(largest[0], largest[1])) m.distance.place = d.place;
      largest[side] = std::max(largest[side], d.largest);
      upper = std::max(upper, d.upper);
      area[side] += f.area[side], mean[side] += f.area[side] * d.mean;
      squares[side] += f.area[side] * d.rms * d.rms;
      if (d.deviation.worst > deviation.worst)
        deviation.worst = d.deviation.worst, deviation.triangle = d.deviation.triangle,
        deviation.place = d.deviation.place;
    }
    for (const auto& [t, ratio] : f.ratios) deviation.ratio[t] = std::max(deviation.ratio[t], ratio);
    for (const auto& [v, off] : f.off) m.off[v] = std::min(m.off[v], off);
    m.intersections.insert(m.intersections.end(), f.intersections.begin(), f.intersections.end());
    m.folds.insert(m.folds.end(), f.folds.begin(), f.folds.end());
  }
  deviation.allowed = std::move(allowed);
  for (double& off : m.off)
    if (!(off < infinity)) off = 0;  // of unused vertices
  sort_unique(m.intersections);
  sort_unique(m.folds);
  m.distance.to_reference = largest[1] / unit, m.distance.to_mesh = largest[0] / unit;
  m.distance.hausdorff = std::max(largest[0], largest[1]) / unit;
  m.distance.bound = upper / unit - m.distance.hausdorff;
  for (int side : {0, 1})
    if (area[side] > 0) {
      m.distance.mean = std::max(m.distance.mean, mean[side] / area[side] / unit);
      m.distance.rms = std::max(m.distance.rms, std::sqrt(squares[side] / area[side]) / unit);
    }
  return m;
}

}  // namespace meshpipe
