// SPDX-License-Identifier: BSD-3-Clause
#include "lib/mesh2d/mesh2d.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "lib/core/error.h"
#include "lib/core/failure_facts.h"
#include "lib/core/lists.h"
#include "lib/core/number.h"
#include "lib/core/weld.h"
#include "lib/mesh2d/adapt.h"
#include "lib/mesh2d/plane_metric.h"
#include "lib/mesh2d/refine.h"
#include "lib/mesh2d/subdivide.h"

namespace meshpipe {
namespace {

constexpr int smoothing_sweeps = 4;

/// Returns a bound on the points of a chart's mesh, from which on it is taken for endless: many times the
/// number that its triangles ask for at the smallest of their corners' sizes.
std::size_t most_points(const Chart& chart, const std::vector<double>& size, int n_line_points) {
  constexpr double many = 16;  // distorted charts take up to twice the number
  double asked = n_line_points + static_cast<double>(chart.uv.size());
  for (const Tri& t : chart.mesh.tris) {
    const auto& p = chart.mesh.points;
    const double h = std::min({size[t[0]], size[t[1]], size[t[2]]});
    asked += norm(area_vector(p[t[0]], p[t[1]], p[t[2]])) / (std::sqrt(3) * h * h);
  }
  return static_cast<std::size_t>(std::min(many * asked + 1000, 357913941.0));  // half-edges are int
}

/// Refuses a size at a chart vertex that the numbers (u, v) cannot resolve; lib/lines/lines.h says why.
void refuse_unresolved_sizes(const Chart& chart, const std::vector<double>& size, const SizeMetric& field) {
  double extent = 0;
  for (Vec2 p : chart.uv) extent = std::max({extent, std::abs(p.x), std::abs(p.y)});
  // nearly all charts: the smallest size is resolved even at the farthest point with the largest stretch
  if (*std::min_element(size.begin(), size.end()) >
      2 * least_spacings * (std::nextafter(extent, infinity) - extent) * field.most_stretch())
    return;
  std::vector<char> seen(chart.uv.size(), 0);
  for (int h = 0; h < 3 * (int)chart.mesh.tris.size(); ++h) {
    const int v = origin(chart.mesh.tris, h);
    if (std::exchange(seen[v], 1)) continue;
    const double far = std::max(std::abs(chart.uv[v].x), std::abs(chart.uv[v].y));
    const Site site = field.at(Place{h / 3, 1.0 * (h % 3 == 0), 1.0 * (h % 3 == 1), 1.0 * (h % 3 == 2)});
    const LogMetric m = site.metric;
    const double stretch = std::exp(0.25 * (m.a + m.c) + 0.5 * std::hypot(0.5 * (m.a - m.c), m.b));
    const double spacing = (std::nextafter(far, infinity) - far) * stretch * site.size;
    if (!(site.size < least_spacings * spacing)) continue;
    const double least = 2 * least_spacings * spacing;  // elsewhere the map may be as coarse, or coarser
    throw Informed<GoalMissed>("vertex " + std::to_string(chart.mesh.vertex[v]) + " has size " +
                                   shown(site.size) + ", but points of the map are " + shown(spacing) +
                                   " apart there; expected sizes of at least " + shown(least),
                               sizes_from(least));
  }
}

/// The points and segments that the lines of a part make in its chart.
struct Drawing {
  std::vector<int> row;  // of Lines::points, ascending
  std::vector<FixedEdge> segments;
  int stay = 0;  // points of borders and model edges
};

Drawing draw(const PartLines& parts, int part) {
  Drawing d;
  int last = -1;
  for (int line : parts.lines_of_part[part]) {
    if (line == std::exchange(last, line)) continue;
    const Line& l = parts.lines.lines[line];
    // a model line may lie inside the part: it does if no other part uses it
    const bool border = l.kind != model_line || parts.shared[line];
    if (l.kind != interface_line) d.stay += l.count;
    for (int k = 0; k < l.count; ++k) {
      const int a = parts.point[l.first + k];
      d.row.push_back(a);
      if (k + 1 < l.count || l.closed)
        d.segments.push_back({a, parts.point[l.first + (k + 1) % l.count], border});
    }
  }
  sort_unique(d.row);
  auto number = [&](int row) {
    return (int)(std::lower_bound(d.row.begin(), d.row.end(), row) - d.row.begin());
  };
  for (FixedEdge& s : d.segments) s = {number(s.a), number(s.b), s.border};
  return d;
}

/// Finds the places of line points: chart vertices by the number of their surface vertex, for the few that
/// are asked for, and edges between them.
class Numbers {
 public:
  Numbers(const Chart& chart, std::vector<int> wanted) : chart_(chart), global_(std::move(wanted)) {
    sort_unique(global_);
    half_edge_.assign(global_.size(), -1);
    std::vector<int> slot(chart.mesh.vertex.size());
    for (std::size_t v = 0; v < slot.size(); ++v) slot[v] = find(chart.mesh.vertex[v]);
    for (int h = 0; h < 3 * (int)chart.mesh.tris.size(); ++h) {
      int k = slot[origin(chart.mesh.tris, h)];
      // on the border the first half-edge of the fan, so that turning left meets them all
      if (k >= 0 && (half_edge_[k] < 0 || chart.opposite[h] < 0)) half_edge_[k] = h;
    }
  }

  /// Returns the place of a line point; its face is -1 if the chart does not have that edge or vertex.
  Place place(const LinePoint& p) const {
    int k = find(p.a), first = k < 0 ? -1 : half_edge_[k], h = first;
    if (h < 0) return {};
    if (p.a == p.b) return place_on_edge(h, 1, 0);
    do {
      if (vertex(target(chart_.mesh.tris, h)) == p.b) return place_on_edge(h, 1 - p.t, p.t);
      int in = prev(h);  // runs towards a
      if (vertex(origin(chart_.mesh.tris, in)) == p.b) return place_on_edge(in, p.t, 1 - p.t);
      h = chart_.opposite[in];
    } while (h >= 0 && h != first);
    return {};
  }

 private:
  int vertex(int local) const { return chart_.mesh.vertex[local]; }
  int find(int vertex) const {
    auto i = std::lower_bound(global_.begin(), global_.end(), vertex);
    return i != global_.end() && *i == vertex ? (int)(i - global_.begin()) : -1;
  }
  const Chart& chart_;
  std::vector<int> global_, half_edge_;
};

/// Returns the triangle that holds p, or -1. Borders may be in the way of a walk.
int triangle_at(const Cdt& cdt, Vec2 p) {
  const int found = cdt.walk(p, 0, Cdt::border_segment);
  if (found >= 0) return found;
  for (int t = 0; t < (int)cdt.tris.size(); ++t) {
    auto left = [&](int h) { return orient2d(cdt.points[cdt.origin(h)], cdt.points[cdt.target(h)], p) >= 0; };
    if (left(3 * t) && left(3 * t + 1) && left(3 * t + 2)) return t;
  }
  return -1;
}

/// Inserts the vertices of the chart that the surface has flagged, each where it is far enough from lines,
/// for good.
void insert_kept(SiteMesh& m, const SizeMetric& field, const std::vector<char>& keep) {
  constexpr Spacing apart{1e-3, 1e-3};  // what is nearer makes needles that do not go away
  const Chart& chart = field.chart();
  std::vector<char> seen(chart.uv.size(), 0);
  for (int h = 0; h < 3 * (int)chart.mesh.tris.size() && !keep.empty(); ++h) {
    const int v = origin(chart.mesh.tris, h);
    if (!keep[chart.mesh.vertex[v]] || std::exchange(seen[v], 1)) continue;
    const int t = triangle_at(m.cdt, chart.uv[v]);
    if (t < 0) continue;
    insert_site(m, chart.uv[v],
                field.at(Place{h / 3, 1.0 * (h % 3 == 0), 1.0 * (h % 3 == 1), 1.0 * (h % 3 == 2)}), t, apart);
  }
  m.line_points = (int)m.cdt.points.size();
}

/// Splits edges between line points at the same place, and those along a segment of another line: where a
/// sheet meets itself, as the two sides of a pocket do, they would close it.
void open_pockets(SiteMesh& m, const SizeMetric& field, int n) {
  constexpr double same_place = 1e-6;  // of the size: copies of a point are nearer
  constexpr int most_passes = 4;       // pockets are small
  std::vector<Vec3> points;
  double size = infinity;
  for (int v = 0; v < n; ++v) points.push_back(m.site[v].space), size = std::min(size, m.site[v].size);
  std::vector<int> first = identity(n);
  if (n == 0 || merge_near(points, std::vector<char>(n, 1), same_place * size, first) == 0) return;
  const Cdt& cdt = m.cdt;
  std::vector<std::pair<int, int>> segments;
  auto key = [&](int h) {
    return std::pair<int, int>(std::minmax(first[cdt.origin(h)], first[cdt.target(h)]));
  };
  for (int h = 0; h < 3 * (int)cdt.tris.size(); ++h)
    if (cdt.fixed[h]) segments.push_back(key(h));
  std::sort(segments.begin(), segments.end());
  for (int pass = 0, more = 1; pass < most_passes && more > 0; ++pass) {
    more = 0;
    for (int h = 0; h < 3 * (int)cdt.tris.size(); ++h) {
      const int a = cdt.origin(h), b = cdt.target(h);
      if (cdt.fixed[h] || std::max(a, b) >= n) continue;
      if (first[a] != first[b] && !std::binary_search(segments.begin(), segments.end(), key(h))) continue;
      const Vec2 p = lerp(cdt.points[a], cdt.points[b], 0.5);
      const int t = cdt.walk(p, h / 3);
      if (t >= 0) more += insert_site(m, p, field.at(p, m.site[a].place.face), t, {0, 0});
    }
  }
}

PlaneMesh mesh(const Chart& chart, const std::vector<double>& size, const PartLines& parts, int part,
               Mesher mesher, const std::vector<char>& keep) {
  const Lines& lines = parts.lines;
  Drawing drawing = draw(parts, part);
  int n = (int)drawing.row.size();
  std::vector<int> wanted;
  for (int row : drawing.row) wanted.push_back(lines.points[row].a);
  Numbers numbers(chart, std::move(wanted));

  SizeMetric field(chart, size);
  refuse_unresolved_sizes(chart, size, field);
  std::vector<Vec2> uv(n);
  std::vector<Site> site(n);
  for (int i = 0; i < n; ++i) {
    const LinePoint& p = lines.points[drawing.row[i]];
    Place place = numbers.place(p);
    if (place.face < 0)
      throw NotAdmissible("line point " + std::to_string(drawing.row[i]) + " lies on edge " +
                          std::to_string(p.a) + " " + std::to_string(p.b) + ", which is not in the chart");
    site[i] = field.at(place);
    // as the third weight is zero, the same bits as linear interpolation along the edge
    uv[i] = value_at(place, chart.uv, chart.mesh.tris);
  }

  SiteMesh m{Cdt(uv, drawing.segments), std::move(site), n, most_points(chart, size, n), {}};
  insert_kept(m, field, keep);
  switch (mesher) {
    case Mesher::frontal:
      if (insert_subdivided(m, field, drawing.segments, drawing.stay))
        fill_gaps(m, field);
      else
        refine_frontal(m, field);
      break;
    case Mesher::delaunay:
      refine_delaunay(m, field);
      break;
    case Mesher::meshadapt:
      adapt_edges(m, field);
      break;
  }
  smooth_in_plane(m, field, smoothing_sweeps);
  open_pockets(m, field, n);

  PlaneMesh result;
  result.tris = std::move(m.cdt.tris);
  result.opposite = std::move(m.cdt.opposite);
  for (std::uint8_t kind : m.cdt.fixed) result.on_line.push_back(kind != Cdt::free_edge);
  result.points.resize(m.cdt.points.size());
  for (int v = 0; v < (int)result.points.size(); ++v)
    result.points[v] = {m.cdt.points[v], v < n ? drawing.row[v] : -1, m.site[v].place};
  return result;
}

}  // namespace

PartLines::PartLines(const Lines& given, int n_parts)
    : lines(given), shared(given.lines.size()), point(identity(given.points.size())) {
  std::vector<int> part(lines.lines.size(), -1);
  for (const LineUse& u : lines.uses) {
    if (part[u.line] >= 0 && part[u.line] != u.part) shared[u.line] = 1;
    part[u.line] = u.part;
  }
  lines_of_part = lists_of(n_parts, [&](auto use) {
    for (const LineUse& u : lines.uses) use(u.part, u.line);
  });
  auto& [start, line] = lines_of_part;
  for (int p = 0; p < n_parts; ++p) std::sort(line.begin() + start[p], line.begin() + start[p + 1]);

  std::vector<std::pair<int, int>> ends;  // vertex, row
  for (const Line& l : lines.lines)
    for (int row : {l.first, l.first + l.count - 1})
      if (lines.points[row].a == lines.points[row].b) ends.push_back({lines.points[row].a, row});
  std::sort(ends.begin(), ends.end());
  for (int row = 0; row < (int)point.size(); ++row) {
    const LinePoint& p = lines.points[row];
    if (p.a != p.b) continue;
    const auto first = std::lower_bound(ends.begin(), ends.end(), std::pair{p.a, -1});
    if (first != ends.end() && first->first == p.a) point[row] = first->second;
  }
}

/// Turns the place of a failure from one in the plane into the one on the surface that is mapped there.
static void place_on_surface(const Chart& chart, FailureFacts& facts) {
  const Place at = locate(chart, {facts.place.x, facts.place.y}, 0);
  const Tri& t = chart.mesh.tris[at.face];
  const Vec3 a = chart.mesh.points[t[0]], b = chart.mesh.points[t[1]], c = chart.mesh.points[t[2]];
  facts.place = value_at(at, chart.mesh.points, chart.mesh.tris);
  facts.reach = std::max({norm(b - a), norm(c - b), norm(a - c)});
}

PlaneMesh mesh_chart(const Chart& chart, const std::vector<double>& size, const PartLines& lines, int part,
                     Mesher mesher, const std::vector<char>& keep) {
  try {
    return mesh(chart, size, lines, part, mesher, keep);
  } catch (const GoalMissed& e) {
    FailureFacts facts = facts_of(e);
    std::string where;
    if (std::exchange(facts.in_plane, false)) {
      place_on_surface(chart, facts);
      where = " in the plane, (" + shown(facts.place) + ") on the surface";
    }
    throw Informed<GoalMissed>("part " + std::to_string(part) + ": " + e.what() + where, facts);
  } catch (const NotAdmissible& e) {
    throw NotAdmissible("part " + std::to_string(part) + ": " + e.what());
  }
}

}  // namespace meshpipe
