// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/page_meshes.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "formats/stream/line_tables.h"
#include "formats/stream/plane_tables.h"
#include "lib/check/check.h"
#include "lib/core/lists.h"
#include "lib/core/original_triangles.h"
#include "lib/core/segments.h"
#include "lib/core/union_find.h"

namespace meshpipe {
namespace {

/// Places of charts in rows, the highest first, each as large as its part.
class Layout {
 public:
  explicit Layout(const std::vector<Chart>& charts) {
    double area = 0;
    for (const Chart& c : charts) {
      Vec2 low = c.uv.at(0), high = low;
      double plane = 0;
      for (Vec2 p : c.uv) low = lower(low, p), high = upper(high, p);
      for (const Tri& t : c.mesh.tris) plane += 0.5 * cross(c.uv[t[1]] - c.uv[t[0]], c.uv[t[2]] - c.uv[t[0]]);
      const double scale = plane > 0 ? std::sqrt(total_area(c.mesh) / plane) : 1;
      sheets_.push_back({low, scale * (high - low), {}, scale});
      area += sheets_.back().size.x * sheets_.back().size.y;
    }
    std::vector<int> order = identity(charts.size());
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return sheets_[a].size.y > sheets_[b].size.y; });
    const double gap = 0.03 * std::sqrt(area), width = 1.5 * std::sqrt(area);
    double x = 0, y = 0, row = 0;
    for (int k : order) {
      Sheet& s = sheets_[k];
      if (x > 0 && x + s.size.x > width) x = 0, y -= row + gap, row = 0;
      row = std::max(row, s.size.y);
      s.at = {x, y - s.size.y};
      x += s.size.x + gap;
    }
  }
  Vec3 operator()(int chart, Vec2 uv) const {
    const Sheet& s = sheets_[chart];
    return {s.at.x + s.scale * (uv.x - s.low.x), s.at.y + s.scale * (uv.y - s.low.y), 0};
  }

 private:
  struct Sheet {
    Vec2 low, size, at;
    double scale = 1;
  };
  std::vector<Sheet> sheets_;
};

Vec3 point_of(const LinePoint& p, const Mesh& mesh) { return lerp(mesh.points[p.a], mesh.points[p.b], p.t); }

/// Returns the pairs of rows of Lines::points that are the ends of a segment, by PartLines::point.
std::set<std::pair<int, int>> segments_of(const PartLines& parts) {
  std::set<std::pair<int, int>> segments;
  for (const Line& l : parts.lines.lines)
    for (int k = l.closed ? 0 : 1; k < l.count; ++k)
      segments.insert(
          std::minmax(parts.point[l.first + (k + l.count - 1) % l.count], parts.point[l.first + k]));
  return segments;
}

}  // namespace

Surface before_cuts(const Surface& reference) {
  std::vector<int> whole = identity(reference.tris.size());
  Surface before;
  if (reference.face.has("origin"))
    before = surface_of(recover_triangles(reference, reference.face.get<int>("origin"), &whole));
  else
    before = surface_of(reference);
  std::vector<int> patch(before.tris.size());
  std::vector<std::uint8_t> model(before.tris.size());
  const auto& bits = model_of(reference);
  for (int h = 0; h < 3 * (int)whole.size(); ++h) {
    const int w = whole[h / 3];
    if (reference.face.has("patch")) patch[w] = reference.face.get<int>("patch")[h / 3];
    if (bits.empty() || !(bits[h / 3] >> (h % 3) & 1)) continue;
    // the edge of the whole triangle in which this one lies
    const Vec3 middle =
        lerp(reference.points[origin(reference.tris, h)], reference.points[target(reference.tris, h)], 0.5);
    auto distance = [&](int i) {
      return distance_to_segment(middle, before.points[origin(before.tris, 3 * w + i)],
                                 before.points[target(before.tris, 3 * w + i)]);
    };
    const int nearest = distance(0) <= distance(1) ? 0 : 1;
    model[w] |= 1 << (distance(nearest) <= distance(2) ? nearest : 2);
  }
  if (reference.face.has("patch")) before.face.set("patch", std::move(patch));
  if (!bits.empty()) before.face.set("model", std::move(model));
  return before;
}

std::vector<std::uint8_t> line_edges(const Surface& surface) {
  std::vector<std::uint8_t> bits = model_of(surface);
  bits.resize(surface.tris.size());
  const auto& part = surface.face.get<int>("part");
  const std::vector<int> opposite = soundness_of(surface).opposite;
  for (int h = 0; h < (int)opposite.size(); ++h)
    if (opposite[h] < 0 || part[h / 3] != part[opposite[h] / 3]) bits[h / 3] |= 1 << (h % 3);
  return bits;
}

std::vector<Vec3> line_points(const Stream& stream) {
  std::vector<Vec3> points;
  for (const LinePoint& p : read_lines(stream).points) points.push_back(point_of(p, stream.surface));
  return points;
}

std::vector<double> spacing_of(const Mesh& mesh, const std::vector<std::uint8_t>& thick) {
  const int n = (int)mesh.tris.size();
  std::vector<double> spacing(n, HUGE_VAL), area(n, 0), length(n, 0);
  if (std::all_of(thick.begin(), thick.end(), [](std::uint8_t bits) { return bits == 0; })) return spacing;
  const std::vector<int> opposite = soundness_of(mesh).opposite;
  UnionFind regions(n);
  auto is_thick = [&](int h) { return (thick[h / 3] >> (h % 3) & 1) != 0; };
  for (int h = 0; h < 3 * n; ++h)
    if (opposite[h] > h && !is_thick(h) && !is_thick(opposite[h])) regions.join(h / 3, opposite[h] / 3);
  for (int h = 0; h < 3 * n; ++h) {
    const int r = regions.find(h / 3);
    if (h % 3 == 0) area[r] += triangle_area(mesh, h / 3);
    if (is_thick(h)) length[r] += edge_length(mesh, h);
  }
  for (int t = 0; t < n; ++t)
    if (const int r = regions.find(t); length[r] > 0) spacing[t] = 2 * area[r] / length[r];
  return spacing;
}

Mesh flat_charts(const Surface& surface, const std::vector<Chart>& charts) {
  const Layout layout(charts);
  Mesh flat{{}, std::vector<Tri>(surface.tris.size(), Tri{0, 0, 0})};
  for (int k = 0; k < (int)charts.size(); ++k) {
    const int first = (int)flat.points.size();
    for (Vec2 p : charts[k].uv) flat.points.push_back(layout(k, p));
    const SubMesh& m = charts[k].mesh;
    for (std::size_t t = 0; t < m.tris.size(); ++t)
      for (int i = 0; i < 3; ++i) flat.tris[m.face[t]][i] = first + m.tris[t][i];
  }
  return flat;
}

PlaneMeshes plane_meshes(const Stream& stream, const std::vector<Chart>& charts) {
  const Layout layout(charts);
  const Lines lines = read_lines(stream);
  const auto segments = segments_of(PartLines(lines, (int)charts.size()));
  const std::vector<PlaneMesh> meshes = read_plane_meshes(stream, charts);
  PlaneMeshes all;
  Mesh& space = all.space;
  std::vector<int> part;
  std::vector<std::uint8_t> model;
  for (int k = 0; k < (int)charts.size(); ++k) {
    const int first = (int)space.points.size();
    const Mesh& chart = charts[k].mesh;
    for (const ChartPoint& p : meshes[k].points) {
      all.flat.push_back(layout(k, p.uv));
      if (p.line_point >= 0) {
        space.points.push_back(point_of(lines.points[p.line_point], stream.surface));
        continue;
      }
      space.points.push_back(value_at(p.place, chart.points, chart.tris));
    }
    for (const Tri& t : meshes[k].tris) {
      space.tris.push_back({first + t[0], first + t[1], first + t[2]});
      part.push_back(k);
      model.push_back(0);
      for (int i = 0; i < 3; ++i) {
        const int a = meshes[k].points[t[i]].line_point, b = meshes[k].points[t[(i + 1) % 3]].line_point;
        if (segments.contains(std::minmax(a, b))) model.back() |= 1 << i;
      }
    }
  }
  all.space = surface_of(std::move(space));
  all.space.face.set("part", std::move(part));
  all.space.face.set("model", std::move(model));
  return all;
}

}  // namespace meshpipe
