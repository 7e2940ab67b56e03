// SPDX-License-Identifier: BSD-3-Clause
#include "lib/mesh2d.h"

#include <algorithm>
#include <string>

#include "lib/error.h"
#include "lib/frontal.h"

namespace meshpipe {
namespace {

constexpr int smoothing_sweeps = 4;

// The points and segments that the lines of a part make in its chart.
struct Drawing {
  std::vector<int> row;  // of Lines::points, ascending
  std::vector<Segment> segments;
};

Drawing draw(const Lines& lines, int part) {
  std::vector<char> used(lines.lines.size(), 0);
  for (const LineUse& u : lines.uses)
    if (u.part == part) used[u.line] = 1;
  // a model line may lie inside the part: it does if no other part uses it
  std::vector<char> shared(lines.lines.size(), 0);
  for (const LineUse& u : lines.uses)
    if (used[u.line] && u.part != part) shared[u.line] = 1;

  // ends of lines that are the same surface vertex are one point: that of the smallest row
  std::vector<std::pair<int, int>> ends;  // vertex, row
  for (const Line& l : lines.lines)
    for (int row : {l.first, l.first + l.count - 1})
      if (lines.points[row].a == lines.points[row].b) ends.push_back({lines.points[row].a, row});
  std::sort(ends.begin(), ends.end());
  auto same = [&](int row) {
    const LinePoint& p = lines.points[row];
    if (p.a != p.b) return row;
    auto first = std::lower_bound(ends.begin(), ends.end(), std::pair{p.a, -1});
    return first != ends.end() && first->first == p.a ? first->second : row;
  };

  Drawing d;
  for (std::size_t i = 0; i < lines.lines.size(); ++i) {
    if (!used[i]) continue;
    const Line& l = lines.lines[i];
    bool border = l.kind != model_line || shared[i];
    for (int k = 0; k < l.count; ++k) {
      int a = same(l.first + k);
      d.row.push_back(a);
      if (k + 1 < l.count || l.closed) d.segments.push_back({a, same(l.first + (k + 1) % l.count), border});
    }
  }
  std::sort(d.row.begin(), d.row.end());
  d.row.erase(std::unique(d.row.begin(), d.row.end()), d.row.end());
  auto number = [&](int row) { return (int)(std::lower_bound(d.row.begin(), d.row.end(), row) - d.row.begin()); };
  for (Segment& s : d.segments) s = {number(s.a), number(s.b), s.border};
  return d;
}

// Surface vertices to chart vertices, for the few that are asked for; and a triangle of each.
class Numbers {
 public:
  Numbers(const Chart& chart, std::vector<int> wanted) : global_(std::move(wanted)) {
    std::sort(global_.begin(), global_.end());
    global_.erase(std::unique(global_.begin(), global_.end()), global_.end());
    local_.assign(global_.size(), -1);
    triangle_.assign(global_.size(), -1);
    std::vector<int> slot(chart.mesh.vertex.size(), -1);
    for (std::size_t v = 0; v < slot.size(); ++v) {
      int k = find(chart.mesh.vertex[v]);
      if (k >= 0) local_[slot[v] = k] = (int)v;
    }
    for (std::size_t t = 0; t < chart.mesh.tris.size(); ++t)
      for (int v : chart.mesh.tris[t])
        if (slot[v] >= 0) triangle_[slot[v]] = (int)t;
  }
  int local(int vertex) const {
    int k = find(vertex);
    return k < 0 ? -1 : local_[k];
  }
  int triangle(int vertex) const { return triangle_[find(vertex)]; }

 private:
  int find(int vertex) const {
    auto i = std::lower_bound(global_.begin(), global_.end(), vertex);
    return i != global_.end() && *i == vertex ? (int)(i - global_.begin()) : -1;
  }
  std::vector<int> global_, local_, triangle_;
};

PlaneMesh mesh(const Chart& chart, const std::vector<double>& size, const Lines& lines, int part) {
  Drawing drawing = draw(lines, part);
  int n = (int)drawing.row.size();
  std::vector<int> wanted;
  for (int row : drawing.row)
    for (int v : {lines.points[row].a, lines.points[row].b}) wanted.push_back(v);
  Numbers numbers(chart, wanted);

  SizeMetric field(chart, size);
  std::vector<Vec2> uv(n);
  std::vector<Site> site(n);
  for (int i = 0; i < n; ++i) {
    const LinePoint& p = lines.points[drawing.row[i]];
    int a = numbers.local(p.a), b = numbers.local(p.b);
    if (a < 0 || b < 0)
      throw NotAdmissible("line point " + std::to_string(drawing.row[i]) + " lies on edge " + std::to_string(p.a) +
                          " " + std::to_string(p.b) + ", which is not in the chart");
    uv[i] = lerp(chart.uv[a], chart.uv[b], p.t);
    site[i] = field.at(uv[i], numbers.triangle(p.a));
  }

  SiteMesh m{Cdt(uv, drawing.segments), std::move(site), n};
  insert_frontal(m, field);
  smooth_in_plane(m, field, smoothing_sweeps);

  PlaneMesh result;
  result.tris = std::move(m.cdt.tris);
  result.points.resize(m.cdt.points.size());
  for (int v = 0; v < (int)result.points.size(); ++v)
    result.points[v] = {m.cdt.points[v], v < n ? drawing.row[v] : -1, m.site[v].place};
  return result;
}

}  // namespace

PlaneMesh mesh_chart(const Chart& chart, const std::vector<double>& size, const Lines& lines, int part) {
  try {
    return mesh(chart, size, lines, part);
  } catch (const GoalMissed& e) {
    throw GoalMissed("part " + std::to_string(part) + ": " + e.what());
  } catch (const NotAdmissible& e) {
    throw NotAdmissible("part " + std::to_string(part) + ": " + e.what());
  }
}

}  // namespace meshpipe
