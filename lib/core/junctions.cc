// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/junctions.h"

#include <algorithm>
#include <tuple>

#include "lib/core/chart.h"
#include "lib/core/edges.h"
#include "lib/core/intersect.h"
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

/// A point that a border edge lacks.
struct Missing {
  int half_edge;
  double t;
  Vec3 point;
  int vertex;  ///< of the other border
  bool operator<(const Missing& o) const {
    return std::tie(half_edge, t, vertex) < std::tie(o.half_edge, o.t, o.vertex);
  }
};

/// A border half-edge as it leaves a place: that of its origin, or backwards that of its target.
struct Ray {
  int place, half_edge, forward;
  auto operator<=>(const Ray&) const = default;
};

std::vector<Ray> find_rays(const Connectivity& c, const std::vector<int>& place) {
  std::vector<char> shared(c.n_vertices(), 0);
  for (int v = 0; v < c.n_vertices(); ++v)
    if (place[v] != v) shared[place[v]] = 1;
  std::vector<Ray> rays;
  for (int h = 0; h < c.n_half_edges(); ++h) {
    if (!c.is_border(h)) continue;
    if (const int from = place[c.from(h)]; shared[from]) rays.push_back({from, h, 1});
    if (const int to = place[c.to(h)]; shared[to]) rays.push_back({to, h, 0});
  }
  std::sort(rays.begin(), rays.end());
  return rays;
}

/// Finds the vertices of other borders on border edges that lack them: along each pair of edges that leave a
/// place in the same direction. Those that are almost the same become the same.
class Comparison {
 public:
  Comparison(Mesh& mesh, const Connectivity& c, const std::vector<int>& place)
      : mesh_(mesh), c_(c), place_(place), before_(c.n_vertices(), -1) {
    for (int h = 0; h < c.n_half_edges(); ++h)
      if (c.is_border(h)) before_[c.to(h)] = h;
    const std::vector<Ray> rays = find_rays(c, place);
    for (std::size_t i = 0, end; i < rays.size(); i = end) {
      for (end = i; end < rays.size() && rays[end].place == rays[i].place;) ++end;
      for (std::size_t j = i; j < end; ++j)
        for (std::size_t k = i; k < end; ++k)
          if (j != k) follow(rays[j], rays[k]);
    }
    std::sort(found_.begin(), found_.end());
  }

  /// The points that edges lack, each once.
  std::vector<Missing> missing() {
    std::vector<Missing> points;
    for (const Missing& m : found_) {
      if (!points.empty() && points.back().half_edge == m.half_edge && m.t - points.back().t <= same_place)
        mesh_.points[m.vertex] = points.back().point;
      else
        points.push_back(m);
    }
    return points;
  }

 private:
  int end_of(const Ray& r) const { return r.forward ? c_.to(r.half_edge) : c_.from(r.half_edge); }

  /// Adds what lies on the edge `along` of the border that leaves its place with `other`.
  void follow(const Ray& along, Ray other) {
    const int last = end_of(along);
    if (place_[end_of(other)] == place_[last]) return;
    const Vec3 a = c_.point(along.place), edge = c_.point(last) - a;
    const double l2 = dot(edge, edge);
    for (int steps = c_.n_half_edges(); steps > 0; --steps) {
      const int v = end_of(other);
      const Vec3 d = c_.point(v) - a;
      const double t = dot(d, edge) / l2;
      if (!(t > same_place && t < 1 + same_place && norm(cross(d, edge)) <= straight * l2)) return;
      if (t > 1 - same_place) {
        if (place_[v] != place_[last]) mesh_.points[std::max(v, last)] = c_.point(std::min(v, last));
        return;
      }
      found_.push_back({along.half_edge, along.forward ? t : 1 - t, c_.point(v), v});
      other.half_edge = other.forward ? next_on_border(c_.opposite, other.half_edge) : before_[v];
    }
  }

  Mesh& mesh_;
  const Connectivity& c_;
  const std::vector<int>& place_;
  std::vector<int> before_;  ///< the border half-edge that ends at a vertex
  std::vector<Missing> found_;
};

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
    const std::vector<int> opposite = opposite_halfedges(surface);
    const Connectivity c{surface, opposite};
    const std::vector<int> place = first_at_border(c);
    const std::vector<Missing> missing = Comparison(surface, c, place).missing();
    if (missing.empty()) return (int)(surface.points.size() - before);
    split_at(surface, chart, missing);
  }
}

/// Makes one vertex of those of the candidates that are at the same place; returns per vertex what it was.
static std::vector<int> join_equal(Mesh& mesh, const std::vector<char>& candidates) {
  const int n = (int)mesh.points.size();
  std::vector<int> number = first_equal(mesh.points, candidates), vertex;
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

std::vector<int> join_borders(Mesh& mesh) {
  std::vector<char> border(mesh.points.size(), 0);
  for_each_edge(mesh.tris, (int)mesh.points.size(), [&](std::span<const EdgeUse> uses) {
    if (const int h = half_edge(uses[0]); uses.size() == 1)
      border[origin(mesh.tris, h)] = border[target(mesh.tris, h)] = 1;
  });
  return join_equal(mesh, border);
}

std::vector<std::pair<int, int>> sheet_intersections(Mesh& mesh, const Bvh& tree) {
  const std::vector<Tri> apart = mesh.tris;
  const std::size_t vertices = mesh.points.size();
  join_equal(mesh, std::vector<char>(vertices, 1));
  std::vector<std::pair<int, int>> pairs = self_intersections(mesh, tree);
  if (mesh.points.size() == vertices) return pairs;
  auto neighbors = [&](int h, int g) {
    return std::minmax(origin(apart, h), target(apart, h)) == std::minmax(origin(apart, g), target(apart, g));
  };
  for_each_edge(mesh.tris, (int)mesh.points.size(), [&](std::span<const EdgeUse> uses) {
    if (uses.size() < 3) return;
    for (EdgeUse e : uses) {
      const int h = half_edge(e);
      int other = -1;
      bool inside = false;
      for (EdgeUse f : uses) {
        const int g = half_edge(f);
        if (g == h) continue;
        if (neighbors(h, g))
          inside = true;
        else if (other < 0)
          other = g / 3;
      }
      if (inside && other >= 0) pairs.push_back(std::minmax(h / 3, other));
    }
  });
  sort_unique(pairs);
  return pairs;
}

}  // namespace meshpipe
