// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/split_edges.h"

#include <algorithm>

#include "lib/core/chart.h"
#include "lib/core/predicates.h"
#include "lib/core/take_rows.h"

namespace meshpipe {
namespace {

/// Corners of a piece: 0 to 2 the triangle's own, 3 + i the middle of the edge from corner i to i+1.
using Piece = std::array<int, 3>;

/// The pieces of a triangle whose edges are marked as `marks` says (bit i: from corner i to i+1); of the two
/// ways to cut a quadrilateral, `shorter(a, b, c, d)` says whether a to b is the better one than c to d.
template <class Shorter>
int pieces_of(int marks, Piece* out, const Shorter& shorter) {
  if (marks == 0) {
    out[0] = {0, 1, 2};
    return 1;
  }
  if (marks == 7) {
    out[0] = {0, 3, 5};
    out[1] = {1, 4, 3};
    out[2] = {2, 5, 4};
    out[3] = {3, 4, 5};
    return 4;
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    if (marks == 1 << i) {
      out[0] = {i, 3 + i, k};
      out[1] = {3 + i, j, k};
      return 2;
    }
    if (marks == (1 << i | 1 << j)) {  // corner j is cut off
      out[0] = {3 + i, j, 3 + j};
      if (shorter(i, 3 + j, 3 + i, k)) {
        out[1] = {i, 3 + i, 3 + j};
        out[2] = {i, 3 + j, k};
      } else {
        out[1] = {i, 3 + i, k};
        out[2] = {3 + i, 3 + j, k};
      }
      return 3;
    }
  }
  return 0;
}

/// The edge (bit) of the triangle on which the edge from corner a to b of a piece lies, -1 inside.
int edge_below(int a, int b) {
  auto on = [](int c, int i) { return c == i || c == (i + 1) % 3 || c == 3 + i; };
  for (int i = 0; i < 3; ++i)
    if (on(a, i) && on(b, i)) return i;
  return -1;
}

/// How a surface is split: the marked half-edges, on both sides of an edge.
class EdgeSplit {
 public:
  EdgeSplit(const CutSurface& s, std::vector<char> mark)
      : surface_(s.surface),
        opposite_(s.opposite),
        mark_(std::move(mark)),
        n_tris_((int)s.surface.tris.size()) {
    for (int h = 0; h < 3 * n_tris_; ++h) mark_[h] = mark_[h] || (opposite_[h] >= 0 && mark_[opposite_[h]]);
  }

  /// Takes back the marks of triangles that would lose their orientation in the plane.
  void keep_orientation(Table& chart) {
    const ChartRows rows(chart, (int)surface_.points.size());
    const auto& part = surface_.face.get<int>("part");
    auto sound = [&](int t) {
      Vec2 uv[6];
      for (int i = 0; i < 3; ++i) uv[i] = rows.uv(part[t], surface_.tris[t][i]);
      for (int i = 0; i < 3; ++i) uv[3 + i] = lerp(uv[i], uv[(i + 1) % 3], 0.5);
      Piece piece[4];
      const int n = cut(t, piece);
      for (int k = 0; k < n; ++k)
        if (orient2d(uv[piece[k][0]], uv[piece[k][1]], uv[piece[k][2]]) <= 0) return false;
      return true;
    };
    for (bool again = true; again;) {  // taking marks away changes how the neighbors are cut
      again = false;
      for (int t = 0; t < n_tris_; ++t) {
        if (marks_of(t) == 0 || sound(t)) continue;
        again = true;
        for (int h = 3 * t; h < 3 * t + 3; ++h) {
          mark_[h] = 0;
          if (opposite_[h] >= 0) mark_[opposite_[h]] = 0;
        }
      }
    }
  }

  /// Numbers the new vertices; false if there are none.
  bool number_vertices() {
    const int n_vertices = (int)surface_.points.size();
    middle_.assign(mark_.size(), -1);
    for (int h = 0; h < 3 * n_tris_; ++h) {
      if (!mark_[h] || middle_[h] >= 0) continue;
      middle_[h] = n_vertices + (int)ends_.size();
      if (opposite_[h] >= 0) middle_[opposite_[h]] = middle_[h];
      ends_.push_back({origin(surface_.tris, h), target(surface_.tris, h)});
    }
    return !ends_.empty();
  }

  /// Appends the rows of the new vertices.
  void extend(Table& chart) const {
    const std::vector<int>& part = surface_.face.get<int>("part");
    std::vector<int> new_part, new_vertex;
    std::vector<double> new_u, new_v;
    const ChartRows rows(chart, (int)surface_.points.size());
    for (int h = 0; h < 3 * n_tris_; ++h) {
      const int o = opposite_[h];
      if (middle_[h] < 0 || (o >= 0 && o < h && part[o / 3] == part[h / 3])) continue;
      const Vec2 m = lerp(rows.uv(part[h / 3], origin(surface_.tris, h)),
                          rows.uv(part[h / 3], target(surface_.tris, h)), 0.5);
      new_part.push_back(part[h / 3]);
      new_vertex.push_back(middle_[h]);
      new_u.push_back(m.x);
      new_v.push_back(m.y);
    }
    auto append = [&](auto& column, const auto& more) {
      column.insert(column.end(), more.begin(), more.end());
    };
    append(chart.get<int>("part"), new_part);
    append(chart.get<int>("vertex"), new_vertex);
    append(chart.get<double>("u"), new_u);
    append(chart.get<double>("v"), new_v);
    chart.rows += new_part.size();
  }

  /// Replaces the triangles by their pieces; returns the triangle that each was part of.
  std::vector<int> split_triangles() {
    std::vector<Tri> tris;
    std::vector<int> parent;
    std::vector<std::uint8_t> model;
    const bool has_model = surface_.face.has("model");
    const std::vector<std::uint8_t>& bits = has_model ? surface_.face.get<std::uint8_t>("model") : no_model;
    for (int t = 0; t < n_tris_; ++t) {
      Piece piece[4];
      const int n = cut(t, piece);
      for (int k = 0; k < n; ++k) {
        Tri v;
        std::uint8_t m = 0;
        for (int i = 0; i < 3; ++i) {
          const int c = piece[k][i], below = edge_below(c, piece[k][(i + 1) % 3]);
          v[i] = c < 3 ? surface_.tris[t][c] : middle_[3 * t + c - 3];
          if (has_model && below >= 0 && (bits[t] >> below & 1)) m |= static_cast<std::uint8_t>(1 << i);
        }
        tris.push_back(v);
        model.push_back(m);
        parent.push_back(t);
      }
    }
    take_rows(surface_.face, parent);
    if (has_model) surface_.face.get<std::uint8_t>("model") = std::move(model);
    surface_.tris = std::move(tris);
    return parent;
  }

  /// Appends the new vertices with their columns.
  void append_vertices() {
    for (auto [a, b] : ends_) surface_.points.push_back(lerp(surface_.points[a], surface_.points[b], 0.5));
    std::vector<RowBetween> middles;
    for (auto [a, b] : ends_)
      middles.push_back({std::max(a, b), std::min(a, b), 0.5});  // labels of the lower
    interpolate_rows(surface_.vertex, middles);
    surface_.vertex.rows = surface_.points.size();
  }

 private:
  int marks_of(int t) const { return mark_[3 * t] | mark_[3 * t + 1] << 1 | mark_[3 * t + 2] << 2; }
  /// Corner c of a piece of triangle t, in space.
  Vec3 corner(int t, int c) const {
    if (c < 3) return surface_.points[surface_.tris[t][c]];
    return lerp(surface_.points[surface_.tris[t][c - 3]], surface_.points[surface_.tris[t][(c - 2) % 3]],
                0.5);
  }
  int cut(int t, Piece* out) const {
    return pieces_of(marks_of(t), out, [&](int a, int b, int c, int d) {
      return norm(corner(t, b) - corner(t, a)) < norm(corner(t, d) - corner(t, c));
    });
  }

  Surface& surface_;
  const std::vector<int>& opposite_;
  std::vector<char> mark_;
  const int n_tris_;
  std::vector<int> middle_;               // of each half-edge: the new vertex, or -1
  std::vector<std::array<int, 2>> ends_;  // of each new vertex
};

}  // namespace

std::vector<int> split_edges(const CutSurface& s, std::vector<char> mark, Table* chart) {
  EdgeSplit split(s, std::move(mark));
  if (chart) split.keep_orientation(*chart);
  if (!split.number_vertices()) return {};
  if (chart) split.extend(*chart);
  std::vector<int> parent = split.split_triangles();
  split.append_vertices();
  return parent;
}

}  // namespace meshpipe
