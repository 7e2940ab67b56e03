// SPDX-License-Identifier: BSD-3-Clause
#include "lib/lift/lift.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "lib/core/connectivity.h"
#include "lib/core/error.h"
#include "lib/core/lists.h"
#include "lib/core/topology.h"

namespace meshpipe {
namespace {

using Edge = std::array<int, 2>;
Edge sorted_edge(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// Returns the vertex of each line point: rows that are the same surface vertex share one.
std::vector<int> number_line_points(const Lines& lines, std::size_t n_reference, int& n_vertices) {
  std::vector<int> vertex(lines.points.size()), on(n_reference, -1);
  n_vertices = 0;
  for (std::size_t i = 0; i < lines.points.size(); ++i) {
    const LinePoint& p = lines.points[i];
    if (p.a != p.b)
      vertex[i] = n_vertices++;
    else if (on[p.a] >= 0)
      vertex[i] = on[p.a];
    else
      vertex[i] = on[p.a] = n_vertices++;
  }
  return vertex;
}

/// Returns the segments of the lines for which `wanted` holds, as sorted pairs of vertices, in order.
template <class Wanted>
std::vector<Edge> segments_of(const Lines& lines, const std::vector<int>& vertex, const Wanted& wanted) {
  std::vector<Edge> edges;
  for (const Line& l : lines.lines) {
    if (!wanted(l)) continue;
    for (int i = 0; i + 1 < l.count + l.closed; ++i)
      edges.push_back(sorted_edge(vertex[l.first + i], vertex[l.first + (i + 1) % l.count]));
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// Sets position, size, place, kind and line of the vertices that stand for line points.
void lift_line_points(const Surface& s, const Lines& lines, const std::vector<int>& vertex, LiftedMesh& out) {
  const auto& size = s.vertex.get<double>("size");
  const std::vector<char> corner = line_corners(s, lines);
  const int n_rows = (int)lines.points.size();
  for (int kept : {1, 0})  // a vertex of several lines is on one that is a border or a model edge, if any
    for (int l = 0; l < (int)lines.lines.size(); ++l) {
      const Line& line = lines.lines[l];
      if ((line.kind != interface_line) != (kept != 0)) continue;
      for (int i = line.first; i < line.first + line.count; ++i) {
        const int v = vertex[i];
        if (out.line[v] >= 0) continue;
        const LinePoint& p = lines.points[i];
        out.points[v] = p.a == p.b ? s.points[p.a] : lerp(s.points[p.a], s.points[p.b], p.t);
        out.size[v] = p.a == p.b ? size[p.a] : (1 - p.t) * size[p.a] + p.t * size[p.b];
        out.kind[v] = p.a == p.b && corner[p.a] ? 2 : 1;
        out.line[v] = l;
      }
    }

  // a triangle that has the edge: rows by their first vertex, met by the half-edges that leave it either way
  const Lists rows = lists_of((int)s.points.size(), [&](auto use) {
    for (int row = 0; row < n_rows; ++row) use(lines.points[row].a, row);
  });
  for (int t = 0; t < (int)s.tris.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      for (int row : rows[s.tris[t][i]]) {
        const LinePoint& p = lines.points[row];
        Place& place = out.place[vertex[row]];
        if (place.face >= 0) continue;
        for (int j = 0; j < 3; ++j) {
          if (s.tris[t][j] != p.b) continue;
          double b[3] = {0, 0, 0};
          b[i] = 1 - p.t;
          b[j] += p.t;  // the same corner if the point is on a vertex
          place = {t, b[0], b[1], b[2]};
        }
      }
    }
  for (int i = 0; i < n_rows; ++i)
    if (out.place[vertex[i]].face < 0)
      throw BadInput("line_vertex " + std::to_string(i) + " is on edge " + std::to_string(lines.points[i].a) +
                     ", " + std::to_string(lines.points[i].b) + ", which no triangle has");
}

/// An inner edge of a plane mesh between two of its points.
struct InnerEdge {
  int part, a, b;
};

/// Returns inner edges between line points that another part, or a line, joins as well: once glued, more
/// than two triangles would share the edge.
std::vector<InnerEdge> double_edges(const std::vector<PlaneMesh>& meshes, const Lines& lines,
                                    const std::vector<int>& vertex) {
  struct Use {
    Edge ends;
    int part, a, b;
  };
  std::vector<Use> uses;
  for (int p = 0; p < (int)meshes.size(); ++p)
    for (const Tri& t : meshes[p].tris)
      for (int i = 0; i < 3; ++i) {
        const int a = t[i], b = t[(i + 1) % 3];
        const int ra = meshes[p].points[a].line_point, rb = meshes[p].points[b].line_point;
        if (ra >= 0 && rb >= 0) uses.push_back({sorted_edge(vertex[ra], vertex[rb]), p, a, b});
      }
  std::sort(uses.begin(), uses.end(), [](const Use& x, const Use& y) {
    return std::tie(x.ends, x.part, x.a) < std::tie(y.ends, y.part, y.a);
  });
  const std::vector<Edge> segments = segments_of(lines, vertex, [](const Line&) { return true; });
  std::vector<InnerEdge> inner;
  for (std::size_t i = 0, end; i < uses.size(); i = end) {
    for (end = i; end < uses.size() && uses[end].ends == uses[i].ends;) ++end;
    if (end - i <= 2) continue;
    bool keep = !std::binary_search(segments.begin(), segments.end(), uses[i].ends);  // one of them may stay
    for (std::size_t k = i; k + 1 < end; ++k) {
      if (uses[k].part != uses[k + 1].part) continue;
      if (!keep) inner.push_back({uses[k].part, uses[k].a, uses[k].b});
      keep = false;
      ++k;
    }
  }
  return inner;
}

/// Splits an inner edge in the middle.
void split_edge(const Chart& chart, PlaneMesh& mesh, int a, int b) {
  const int middle = (int)mesh.points.size(), n = (int)mesh.tris.size();
  const Vec2 uv = lerp(mesh.points[a].uv, mesh.points[b].uv, 0.5);
  mesh.points.push_back({uv, -1, locate(chart, uv, std::max(0, mesh.points[a].place.face))});
  for (int t = 0; t < n; ++t)
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const Edge e{mesh.tris[t][i], mesh.tris[t][j]};
      if (e != Edge{a, b} && e != Edge{b, a}) continue;
      Tri half = mesh.tris[t];
      mesh.tris[t][j] = middle;
      half[i] = middle;
      mesh.tris.push_back(half);
      break;
    }
}

/// Appends the patches of the reference below the triangles of one part.
void look_below(const Surface& s, const Chart& chart, const PlaneMesh& mesh, std::vector<int>& below) {
  const auto& patch = s.face.get<int>("patch");
  int hint = 0;
  for (const Tri& t : mesh.tris) {
    const Vec2 uv = (1.0 / 3) * (mesh.points[t[0]].uv + mesh.points[t[1]].uv + mesh.points[t[2]].uv);
    for (int v : t)
      if (mesh.points[v].place.face >= 0) hint = mesh.points[v].place.face;
    hint = locate(chart, uv, hint).face;
    below.push_back(patch[chart.mesh.face[hint]]);
  }
}

/// Returns per triangle the label of its region (triangles joined across edges that are not model edges): the
/// one with the largest area there.
std::vector<int> label_regions(const Connectivity& mesh, const std::vector<int>& below) {
  const int n = mesh.n_tris();
  std::vector<int> within = mesh.opposite, region, order = identity(n);
  for (int h = 0; h < 3 * n; ++h)
    if (mesh.is_model(h)) within[h] = -1;
  const int n_regions = components(within, region);
  std::sort(order.begin(), order.end(), [&](int t, int u) {
    return std::tie(region[t], below[t], t) < std::tie(region[u], below[u], u);
  });
  std::vector<int> label(n_regions, 0), patch(n);
  std::vector<double> most(n_regions, -1);
  for (int i = 0; i < n;) {
    const int r = region[order[i]], b = below[order[i]];
    double area = 0;
    for (; i < n && region[order[i]] == r && below[order[i]] == b; ++i)
      area += norm(mesh.area_vector(order[i]));
    if (area > most[r]) {
      most[r] = area;
      label[r] = b;
    }
  }
  for (int t = 0; t < n; ++t) patch[t] = label[region[t]];
  return patch;
}

/// Checks that the glued mesh is a manifold and its border edges are the segments of the border lines, and
/// returns its opposite half-edges.
std::vector<int> check_glue(const LiftedMesh& mesh, const std::vector<Edge>& segments) {
  const int n_vertices = (int)mesh.points.size();
  std::vector<int> opposite;
  try {
    opposite = opposite_halfedges(mesh.tris, n_vertices);
  } catch (const NotAdmissible& e) {
    throw GoalMissed(std::string("the glued mesh is not a manifold: ") + e.what());
  }
  const int pinched = find_pinched_vertex(mesh.tris, opposite, n_vertices);
  if (pinched >= 0) throw GoalMissed("the glued mesh is pinched at vertex " + std::to_string(pinched));
  std::size_t border = 0;
  for (int h = 0; h < (int)opposite.size(); ++h) {
    if (opposite[h] >= 0) continue;
    ++border;
    const Edge e = sorted_edge(origin(mesh.tris, h), target(mesh.tris, h));
    if (!std::binary_search(segments.begin(), segments.end(), e))
      throw GoalMissed("the glued mesh is open along edge " + std::to_string(e[0]) + ", " +
                       std::to_string(e[1]) + ", which is no segment of the border lines");
  }
  if (border != segments.size())
    throw GoalMissed("the glued mesh has " + std::to_string(border) +
                     " border edges, the border's lines have " + std::to_string(segments.size()) +
                     " segments");
  return opposite;
}

/// Splits the inner edges that would have more than two triangles.
std::vector<PlaneMesh> repair_doubled(std::vector<PlaneMesh> meshes, const std::vector<InnerEdge>& doubled,
                                      std::vector<Chart>& charts) {
  for (const InnerEdge& e : doubled) {
    if (charts[e.part].opposite.empty()) index_chart(charts[e.part]);
    split_edge(charts[e.part], meshes[e.part], e.a, e.b);
  }
  return meshes;
}

/// Sets position, size and place of the inside points of one part, numbered from `next` on, and appends its
/// triangles.
void lift_part(const Surface& s, const Chart& chart, const PlaneMesh& mesh, const std::vector<int>& vertex,
               int part, int next, LiftedMesh& out) {
  const auto& size = s.vertex.get<double>("size");
  std::vector<int> number;
  for (const ChartPoint& x : mesh.points) {
    number.push_back(x.line_point < 0 ? next++ : vertex[x.line_point]);
    if (x.line_point >= 0) continue;
    const int v = number.back();
    const Place place{chart.mesh.face[x.place.face], x.place.b0, x.place.b1, x.place.b2};
    out.place[v] = place;
    out.points[v] = value_at(place, s.points, s.tris);
    out.size[v] = value_at(place, size, s.tris);
  }
  for (const Tri& t : mesh.tris) out.tris.push_back({number[t[0]], number[t[1]], number[t[2]]});
  out.part.insert(out.part.end(), mesh.tris.size(), part);
}

/// Sets the model bits of edges that are segments of model lines.
void mark_model_edges(const Lines& lines, const std::vector<int>& vertex, int n_line_vertices,
                      LiftedMesh& out) {
  const std::vector<Edge> model =
      segments_of(lines, vertex, [](const Line& l) { return l.kind == model_line; });
  out.model.assign(out.tris.size(), 0);
  for (std::size_t t = 0; t < out.tris.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const int a = out.tris[t][i], b = out.tris[t][(i + 1) % 3];
      if (a < n_line_vertices && b < n_line_vertices &&
          std::binary_search(model.begin(), model.end(), sorted_edge(a, b)))
        out.model[t] |= static_cast<std::uint8_t>(1 << i);
    }
}

}  // namespace

LiftedMesh lift(const Surface& reference, std::vector<Chart> charts, const Lines& lines,
                const std::vector<PlaneMesh>& meshes) {
  const int n_parts = (int)meshes.size();
  int n_line_vertices = 0;
  const std::vector<int> vertex = number_line_points(lines, reference.points.size(), n_line_vertices);
  const std::vector<InnerEdge> doubled = double_edges(meshes, lines, vertex);
  std::vector<PlaneMesh> repaired;
  if (!doubled.empty()) repaired = repair_doubled(meshes, doubled, charts);
  const std::vector<PlaneMesh>& parts = doubled.empty() ? meshes : repaired;

  LiftedMesh out;
  std::size_t n_vertices = n_line_vertices, n_tris = 0;
  std::vector<int> first(n_parts);  // number of each part's first inside point
  for (int p = 0; p < n_parts; ++p) {
    first[p] = (int)n_vertices;
    for (const ChartPoint& x : parts[p].points) n_vertices += x.line_point < 0;
    n_tris += parts[p].tris.size();
  }
  out.points.resize(n_vertices);
  out.place.resize(n_vertices);
  out.size.resize(n_vertices);
  out.kind.assign(n_vertices, 0);
  out.line.assign(n_vertices, -1);
  out.tris.reserve(n_tris);
  out.part.reserve(n_tris);
  lift_line_points(reference, lines, vertex, out);

  const auto* patch = reference.face.has("patch") ? &reference.face.get<int>("patch") : nullptr;
  const bool patches =
      patch && std::adjacent_find(patch->begin(), patch->end(), std::not_equal_to<>()) != patch->end();
  std::vector<int> below;
  for (int p = 0; p < n_parts; ++p) {
    lift_part(reference, charts[p], parts[p], vertex, p, first[p], out);
    if (!patches) continue;
    if (charts[p].opposite.empty()) index_chart(charts[p]);
    look_below(reference, charts[p], parts[p], below);
  }
  mark_model_edges(lines, vertex, n_line_vertices, out);

  const auto border = segments_of(lines, vertex, [](const Line& l) { return l.kind == border_line; });
  const std::vector<int> opposite = check_glue(out, border);
  out.patch = patches ? label_regions({out, opposite, out.model}, below)
                      : std::vector<int>(n_tris, patch && !patch->empty() ? patch->front() : 0);
  return out;
}

}  // namespace meshpipe
