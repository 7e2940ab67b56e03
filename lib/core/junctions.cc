// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/junctions.h"

#include <algorithm>

#include "lib/core/chart_rows.h"
#include "lib/core/edges.h"
#include "lib/core/take_rows.h"
#include "lib/core/topology.h"
#include "lib/core/weld.h"

namespace meshpipe {

std::vector<int> first_at_border(const Connectivity& c) {
  std::vector<char> border(c.n_vertices(), 0);
  for (int h = 0; h < c.n_half_edges(); ++h)
    if (c.is_border(h)) border[c.from(h)] = border[c.to(h)] = 1;
  return first_equal(c.mesh.points, border);
}

namespace {

constexpr double same_place = 1e-9;  // of an edge: cuts nearer than this are one
constexpr double straight = 1e-9;    // of an edge: what is farther off it is no piece of it

/// A border from one junction to the next, straight: the pieces of one edge that cuts have left.
struct Piece {
  int from, to;           ///< the places of its ends, from < to
  std::vector<int> edge;  ///< half-edges, in the direction of the border
  bool reversed;          ///< the border runs from `to`
};

/// A point that a border edge lacks.
struct Missing {
  int half_edge;
  double t;
  Vec3 point;
  bool operator<(const Missing& o) const {
    return half_edge != o.half_edge ? half_edge < o.half_edge : t < o.t;
  }
};

std::vector<Piece> find_pieces(const Connectivity& c, const std::vector<int>& place) {
  std::vector<char> shared(c.n_vertices(), 0);
  for (int v = 0; v < c.n_vertices(); ++v)
    if (place[v] != v) shared[v] = shared[place[v]] = 1;
  std::vector<Piece> pieces;
  for (int h = 0; h < c.n_half_edges(); ++h) {
    if (!c.is_border(h) || !shared[c.from(h)]) continue;
    Piece p{place[c.from(h)], 0, {h}, false};
    const std::size_t most = c.n_half_edges();
    while (!shared[c.to(p.edge.back())] && p.edge.size() < most)
      p.edge.push_back(next_on_border(c.opposite, p.edge.back()));
    p.to = place[c.to(p.edge.back())];
    const Vec3 a = c.point(p.from), along = c.point(p.to) - a;
    const double length = norm(along);
    bool is_straight = length > 0;
    for (std::size_t i = 1; i < p.edge.size() && is_straight; ++i)
      is_straight = norm(cross(c.point(c.from(p.edge[i])) - a, along)) <= straight * length * length;
    if (!is_straight) continue;
    p.reversed = p.from > p.to;
    if (p.reversed) std::swap(p.from, p.to);
    pieces.push_back(std::move(p));
  }
  std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& p, const Piece& q) {
    return std::pair(p.from, p.to) < std::pair(q.from, q.to);
  });
  return pieces;
}

/// Finds the points that some pieces between the same places have and others lack; those that are almost the
/// same become the same.
std::vector<Missing> compare_pieces(Mesh& mesh, const std::vector<Piece>& pieces) {
  std::vector<Missing> missing;
  for (std::size_t i = 0, end; i < pieces.size(); i = end) {
    for (end = i;
         end < pieces.size() && pieces[end].from == pieces[i].from && pieces[end].to == pieces[i].to;)
      ++end;
    const Vec3 a = mesh.points[pieces[i].from], along = mesh.points[pieces[i].to] - a;
    auto at = [&](Vec3 p) { return dot(p - a, along) / dot(along, along); };
    std::vector<std::pair<double, int>> cuts;
    for (std::size_t k = i; k < end; ++k)
      for (std::size_t j = 1; j < pieces[k].edge.size(); ++j) {
        const int v = origin(mesh.tris, pieces[k].edge[j]);
        cuts.push_back({at(mesh.points[v]), v});
      }
    if (cuts.empty() || end - i < 2) continue;
    std::sort(cuts.begin(), cuts.end());
    std::vector<double> place{cuts[0].first};
    std::vector<Vec3> point{mesh.points[cuts[0].second]};
    for (const auto& [t, v] : cuts) {
      if (t - place.back() > same_place) place.push_back(t), point.push_back(mesh.points[v]);
      mesh.points[v] = point.back();
    }
    for (std::size_t k = i; k < end; ++k)
      for (int h : pieces[k].edge) {
        const double x = at(mesh.points[origin(mesh.tris, h)]), y = at(mesh.points[target(mesh.tris, h)]);
        for (std::size_t j = 0; j < place.size(); ++j)
          if (const double t = (place[j] - x) / (y - x);
              place[j] > std::min(x, y) + same_place && place[j] < std::max(x, y) - same_place)
            missing.push_back({h, t, point[j]});
      }
  }
  std::sort(missing.begin(), missing.end());
  return missing;
}

/// Appends rows for vertices from number `vertex` on: in the part of triangle inside[i], between others.
void extend(Table& chart, const std::vector<int>& part, const std::vector<int>& inside,
            const std::vector<RowBetween>& added, int vertex) {
  const ChartRows rows(chart, vertex);
  std::vector<Vec2> uv;
  for (std::size_t i = 0; i < added.size(); ++i) {
    const auto& [a, b, t] = added[i];
    uv.push_back(lerp(rows.uv(part[inside[i]], a), rows.uv(part[inside[i]], b), t));
  }
  for (std::size_t i = 0; i < uv.size(); ++i) {
    chart.get<int>("part").push_back(part[inside[i]]);
    chart.get<int>("vertex").push_back(vertex + (int)i);
    chart.get<double>("u").push_back(uv[i].x);
    chart.get<double>("v").push_back(uv[i].y);
  }
  chart.rows += uv.size();
}

/// Splits border edges at points, at most one edge of a triangle. Face columns are copied, vertex columns
/// interpolated.
void split_at(Surface& s, Table* chart, const std::vector<Missing>& points) {
  std::vector<int> face;          // of the triangles appended
  std::vector<RowBetween> added;  // vertices
  std::vector<int> inside;        // the triangle whose edge a vertex is on
  int last = -1;
  auto* model = s.face.has("model") ? &s.face.get<std::uint8_t>("model") : nullptr;
  std::vector<std::uint8_t> bits;
  for (std::size_t i = 0, end; i < points.size(); i = end) {
    const int h = points[i].half_edge, t = h / 3, k = h % 3;
    for (end = i; end < points.size() && points[end].half_edge == h;) ++end;
    if (t == last) continue;
    last = t;
    const int a = s.tris[t][k], b = s.tris[t][(k + 1) % 3], apex = s.tris[t][(k + 2) % 3];
    const int mark = model ? (*model)[t] : 0;
    int from = 0;
    for (; i < end; ++i) {
      const int v = (int)s.points.size();
      s.points.push_back(points[i].point);
      added.push_back({a, b, points[i].t});
      inside.push_back(t);
      if (from == 0) {
        s.tris[t][(k + 1) % 3] = v;
        if (model) (*model)[t] = (std::uint8_t)(mark & ~(1 << (k + 1) % 3));
      } else {
        s.tris.push_back({from, v, apex});
        face.push_back(t), bits.push_back(mark >> k & 1);
      }
      from = v;
    }
    s.tris.push_back({from, b, apex});
    face.push_back(t), bits.push_back((mark >> k & 1) | (mark >> (k + 1) % 3 & 1) << 1);
  }
  append_rows(s.face, face);
  if (model) std::copy(bits.begin(), bits.end(), s.face.get<std::uint8_t>("model").end() - (long)bits.size());
  if (chart) extend(*chart, s.face.get<int>("part"), inside, added, (int)s.vertex.rows);
  interpolate_rows(s.vertex, added);
}

}  // namespace

int match_borders(Surface& surface, Table* chart) {
  const std::size_t before = surface.points.size();
  for (;;) {
    const std::vector<int> opposite = opposite_halfedges(surface.tris, (int)surface.points.size());
    const Connectivity c{surface, opposite};
    const std::vector<Missing> missing = compare_pieces(surface, find_pieces(c, first_at_border(c)));
    if (missing.empty()) return (int)(surface.points.size() - before);
    split_at(surface, chart, missing);
  }
}

std::vector<int> join_borders(Mesh& mesh) {
  const int n = (int)mesh.points.size();
  std::vector<char> border(n, 0);
  for_each_edge(mesh.tris, n, [&](std::span<const EdgeUse> uses) {
    if (const int h = half_edge(uses[0]); uses.size() == 1)
      border[origin(mesh.tris, h)] = border[target(mesh.tris, h)] = 1;
  });
  std::vector<int> number = first_equal(mesh.points, border), vertex;
  for (int v = 0; v < n; ++v)
    if (number[v] == v) {
      number[v] = (int)vertex.size();
      vertex.push_back(v);
    } else {
      number[v] = number[number[v]];  // which came before
    }
  for (std::size_t v = 0; v < vertex.size(); ++v) mesh.points[v] = mesh.points[vertex[v]];
  mesh.points.resize(vertex.size());
  for (Tri& t : mesh.tris)
    for (int& v : t) v = number[v];
  return vertex;
}

}  // namespace meshpipe
