// SPDX-License-Identifier: BSD-3-Clause
#include "lib/check/shares.h"

#include <algorithm>

#include "lib/check/check.h"
#include "lib/core/boxes.h"
#include "lib/core/intersect.h"
#include "lib/core/topology.h"
#include "lib/core/triangle_count.h"

namespace meshpipe {
namespace {

constexpr double reach = 2;                     // edges: farther away, a distance is more than is allowed
constexpr double longest = 4;                   // edges: longer triangles of the reference are halved
constexpr double small_ratio = 0.5;             // of the allowed distance: sizes stay where it is no more
constexpr int bounded_effort = 64, effort = 8;  // points per sample, as in distance_between

/// Appends triangles of a mesh to a part, whose vertices have these rows in the mesh.
void append_part(const Mesh& mesh, const int* first, const int* last, std::vector<int>& number, Mesh& part,
                 std::vector<int>& rows) {
  part.tris.reserve(part.tris.size() + (last - first));
  for (; first != last; ++first) {
    Tri& t = part.tris.emplace_back(mesh.tris[*first]);
    for (int& v : t) {
      if (number[v] < 0) {
        number[v] = (int)rows.size();
        rows.push_back(v);
        part.points.push_back(mesh.points[v]);
      }
      v = number[v];
    }
  }
}

/// Forgets the numbers of these rows.
void forget(const std::vector<int>& rows, std::vector<int>& number) {
  for (int row : rows) number[row] = -1;
}

/// Returns the mesh with triangles halved until no edge is longer than `most`; halves have new vertices.
Mesh halved(const Mesh& mesh, double most) {
  Mesh out{mesh.points, {}};
  std::vector<Tri> left;
  for (const Tri& tri : mesh.tris) {
    left.push_back(tri);
    while (!left.empty()) {
      const Tri t = left.back();
      left.pop_back();
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
  return out;
}

std::vector<int> all_rows(const Mesh& mesh) {
  std::vector<int> all(mesh.tris.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// Whose triangles the shares have, and the other surface.
struct Side {
  const Mesh &mesh, &other;
  bool of_result;
};

/// Cuts the shares of one side; `common`: what all have.
void cut_side(const Side& side, const std::vector<double>& allowed, int triangles, double edge,
              const CheckShare& common, const std::function<void(CheckShare)>& take) {
  const auto boxes = split_into_boxes(side.mesh, all_rows(side.mesh), triangles);
  const double area = total_area(side.mesh);
  const double own_edge = size_for_count(area, (double)side.mesh.tris.size());
  const double edges = reach * std::max(1.0, edge / own_edge);
  const Lists others = around_tiles(side.mesh, boxes, edges, &side.other);
  const Lists next = side.of_result ? around_tiles(side.mesh, boxes, 1, nullptr) : Lists();
  std::vector<int> number(side.mesh.points.size(), -1), other_number(side.other.points.size(), -1);
  for (int i = 0; i < (int)boxes.size(); ++i) {
    CheckShare share = common;
    share.of_result = side.of_result;
    share.own = (int)boxes[i].size();
    std::vector<int> rows, other_rows;
    append_part(side.mesh, boxes[i].data(), boxes[i].data() + boxes[i].size(), number, share.mesh, rows);
    const double part = area > 0 ? total_area(share.mesh) / area : 1;
    share.samples = std::max(1, (int)(common.samples * part));
    share.budget = std::max(1000, (int)(common.budget * part));
    const int *first = others.row.data() + others.start[i], *last = others.row.data() + others.start[i + 1];
    append_part(side.other, first, last, other_number, share.other, other_rows);
    share.triangles = side.of_result ? boxes[i] : std::vector<int>(first, last);
    for (int t : share.triangles) share.allowed.push_back(allowed[t]);
    if (side.of_result) {
      const int *from = next.row.data() + next.start[i], *to = next.row.data() + next.start[i + 1];
      append_part(side.mesh, from, to, number, share.mesh, rows);
      share.triangles.insert(share.triangles.end(), from, to);
      share.vertices = rows;
    }
    forget(rows, number), forget(other_rows, other_number);
    take(std::move(share));
  }
}

}  // namespace

void cut_check(const Mesh& result, const Mesh& reference, const std::vector<double>& allowed, int triangles,
               int samples, double most, const TakeShare& take) {
  CheckShare common;
  const double d = diagonal(reference);
  common.diagonal = d > 0 ? d : 1;
  common.most = most;
  const long long enough = ((long long)reference.tris.size() + (long long)result.tris.size()) / 4 + 500;
  common.samples = (int)std::min<long long>(samples, enough);
  common.budget = (most > 0 ? bounded_effort : effort) * samples;
  const double edge = size_for_count(total_area(result), (double)result.tris.size());
  const Mesh pieces = halved(reference, longest * edge);
  auto shares_of = [&](const Mesh& mesh) { return ((int)mesh.tris.size() + triangles - 1) / triangles; };
  const int all = shares_of(result) + shares_of(pieces);
  int number = 0;
  const auto number_it = [&](CheckShare share) { take(std::move(share), number++, all); };
  cut_side({result, reference, true}, allowed, triangles, edge, common, number_it);
  cut_side({pieces, result, false}, allowed, triangles, edge, common, number_it);
}

namespace {

/// Measures distances where there is nothing within reach: as far as can be.
void measure_far(const CheckShare& share, const Mesh& own, OneWay& d, std::vector<double>& off) {
  d.largest = d.upper = d.mean = d.rms = share.diagonal;
  d.place = d.deviation.place = own.points[own.tris[0][0]];
  d.deviation.worst = reach / most_deviation;  // at least
  off.assign(own.points.size(), share.diagonal);
}

/// Measures distances and folds where there is.
void measure_near(const CheckShare& share, const Mesh& own, const Bvh& own_tree, ShareFindings& f,
                  std::vector<double>& off) {
  const Bvh other_tree(share.other);
  const std::vector<int> opposite = opposite_halfedges(share.other);
  const Connectivity other{share.other, opposite};
  OneWay& d = f.distance;
  d = distance_from(own, own_tree, other, other_tree,
                    {share.samples, share.budget, share.diagonal, share.most, share.of_result},
                    share.allowed);
  for (std::size_t t = 0; t < d.deviation.ratio.size(); ++t)
    if (d.deviation.ratio[t] > small_ratio) f.ratios.push_back({share.triangles[t], d.deviation.ratio[t]});
  d.deviation.ratio = {};
  if (d.deviation.triangle >= 0) d.deviation.triangle = share.triangles[d.deviation.triangle];
  if (!share.of_result) return;
  off = vertex_distances(own, own_tree, other, other_tree);
  const std::vector<int> next = opposite_halfedges(share.mesh);
  auto whole = [&](int h) { return 3 * share.triangles[h / 3] + h % 3; };
  for (int h : find_folds({share.mesh, next}, share.other, other_tree))
    if (h / 3 < share.own) f.folds.push_back(std::min(whole(h), whole(next[h])));
}

}  // namespace

ShareFindings measure(const CheckShare& share) {
  ShareFindings f;
  f.of_result = share.of_result;
  const Mesh own{share.mesh.points, {share.mesh.tris.begin(), share.mesh.tris.begin() + share.own}};
  f.area = total_area(own);
  const Bvh own_tree(own);
  std::vector<double> off;
  if (share.other.tris.empty())
    measure_far(share, own, f.distance, off);
  else
    measure_near(share, own, own_tree, f, off);
  if (!share.of_result) return f;
  const std::vector<char> used = used_points(own);
  for (std::size_t v = 0; v < off.size(); ++v)
    if (used[v]) f.off.push_back({share.vertices[v], off[v]});
  for (const auto& [s, t] : self_intersections(share.mesh, own_tree))
    f.crossings.push_back(std::minmax(share.triangles[s], share.triangles[t]));
  return f;
}

Measured join_findings(const std::vector<ShareFindings>& shares, const Mesh& result, double diagonal,
                       std::vector<double> allowed) {
  Measured m;
  const double unit = diagonal > 0 ? diagonal : 1;
  m.off.assign(result.points.size(), std::numeric_limits<double>::infinity());
  Deviation& deviation = m.distance.deviation;
  deviation.ratio.assign(result.tris.size(), 0);
  double largest[2] = {0, 0}, upper = 0, area[2] = {0, 0}, mean[2] = {0, 0}, squares[2] = {0, 0};
  for (const ShareFindings& f : shares) {
    const OneWay& d = f.distance;
    const int side = f.of_result;
    if (d.largest >= std::max(largest[0], largest[1])) m.distance.place = d.place;
    largest[side] = std::max(largest[side], d.largest);
    upper = std::max(upper, d.upper);
    area[side] += f.area, mean[side] += f.area * d.mean, squares[side] += f.area * d.rms * d.rms;
    for (const auto& [t, ratio] : f.ratios) deviation.ratio[t] = std::max(deviation.ratio[t], ratio);
    if (d.deviation.worst > deviation.worst)
      deviation.worst = d.deviation.worst, deviation.triangle = d.deviation.triangle,
      deviation.place = d.deviation.place;
    for (const auto& [v, off] : f.off) m.off[v] = std::min(m.off[v], off);
    m.intersections.insert(m.intersections.end(), f.crossings.begin(), f.crossings.end());
    m.folds.insert(m.folds.end(), f.folds.begin(), f.folds.end());
  }
  deviation.allowed = std::move(allowed);
  for (double& off : m.off)
    if (!(off < std::numeric_limits<double>::infinity())) off = 0;  // of unused vertices
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
