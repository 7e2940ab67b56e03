// SPDX-License-Identifier: BSD-3-Clause
#include "lib/split_edges.h"

#include <algorithm>
#include <numeric>

#include "lib/error.h"
#include "lib/predicates.h"

namespace meshpipe {
namespace {

/// Where the charts have the vertices: rows of chart_vertex by vertex.
class ChartRows {
 public:
  ChartRows(Table& table, std::size_t n_vertices)
      : part_(table.get<int>("part")),
        vertex_(table.get<int>("vertex")),
        u_(table.get<double>("u")),
        v_(table.get<double>("v")),
        start_(n_vertices + 1, 0),
        row_(vertex_.size()) {
    for (int v : vertex_) ++start_[v + 1];
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    std::vector<int> at(start_.begin(), start_.end() - 1);
    for (int i = 0; i < static_cast<int>(vertex_.size()); ++i) row_[at[vertex_[i]]++] = i;
  }
  Vec2 uv(int part, int vertex) const {
    for (int k = start_[vertex]; k < start_[vertex + 1]; ++k)
      if (part_[row_[k]] == part) return {u_[row_[k]], v_[row_[k]]};
    throw BadInput("chart_vertex has no row for vertex " + std::to_string(vertex) + " in part " +
                   std::to_string(part));
  }

 private:
  const std::vector<int>&part_, &vertex_;
  const std::vector<double>&u_, &v_;
  std::vector<int> start_, row_;
};

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

template <class T>
std::vector<T> gathered(const std::vector<T>& values, const std::vector<int>& parent) {
  std::vector<T> out;
  out.reserve(parent.size());
  for (int t : parent) out.push_back(values[t]);
  return out;
}

}  // namespace

std::vector<int> split_edges(Surface& surface, const std::vector<int>& opposite, std::vector<char> mark,
                             Table* chart) {
  const int n_tris = static_cast<int>(surface.tris.size());
  const auto n_vertices = static_cast<int>(surface.points.size());
  auto marks_of = [&](int t) { return mark[3 * t] | mark[3 * t + 1] << 1 | mark[3 * t + 2] << 2; };
  auto corner = [&](int t, int c) {  // of a piece, in space
    if (c < 3) return surface.points[surface.tris[t][c]];
    return lerp(surface.points[surface.tris[t][c - 3]], surface.points[surface.tris[t][(c - 2) % 3]], 0.5);
  };
  auto cut = [&](int t, Piece* out) {
    return pieces_of(marks_of(t), out, [&](int a, int b, int c, int d) {
      return norm(corner(t, b) - corner(t, a)) < norm(corner(t, d) - corner(t, c));
    });
  };
  for (int h = 0; h < 3 * n_tris; ++h) mark[h] = mark[h] || (opposite[h] >= 0 && mark[opposite[h]]);

  Piece piece[4];
  if (chart) {
    const ChartRows rows(*chart, n_vertices);
    const auto& part = surface.face.get<int>("part");
    auto sound = [&](int t) {
      Vec2 uv[6];
      for (int i = 0; i < 3; ++i) uv[i] = rows.uv(part[t], surface.tris[t][i]);
      for (int i = 0; i < 3; ++i) uv[3 + i] = lerp(uv[i], uv[(i + 1) % 3], 0.5);
      const int n = cut(t, piece);
      for (int k = 0; k < n; ++k)
        if (orient2d(uv[piece[k][0]], uv[piece[k][1]], uv[piece[k][2]]) <= 0) return false;
      return true;
    };
    for (bool again = true; again;) {  // taking marks away changes how the neighbours are cut
      again = false;
      for (int t = 0; t < n_tris; ++t) {
        if (marks_of(t) == 0 || sound(t)) continue;
        again = true;
        for (int h = 3 * t; h < 3 * t + 3; ++h) {
          mark[h] = 0;
          if (opposite[h] >= 0) mark[opposite[h]] = 0;
        }
      }
    }
  }
  std::vector<int> middle(3 * static_cast<std::size_t>(n_tris), -1), ends;  // ends: pairs
  for (int h = 0; h < 3 * n_tris; ++h) {
    if (!mark[h] || middle[h] >= 0) continue;
    middle[h] = n_vertices + static_cast<int>(ends.size()) / 2;
    if (opposite[h] >= 0) middle[opposite[h]] = middle[h];
    ends.push_back(origin(surface.tris, h));
    ends.push_back(target(surface.tris, h));
  }
  if (ends.empty()) return {};

  if (chart) {
    const std::vector<int> part = surface.face.get<int>("part");
    std::vector<int> new_part, new_vertex;
    std::vector<double> new_u, new_v;
    const ChartRows rows(*chart, n_vertices);
    for (int h = 0; h < 3 * n_tris; ++h) {
      const int o = opposite[h];
      if (middle[h] < 0 || (o >= 0 && o < h && part[o / 3] == part[h / 3])) continue;
      const Vec2 m = lerp(rows.uv(part[h / 3], origin(surface.tris, h)),
                          rows.uv(part[h / 3], target(surface.tris, h)), 0.5);
      new_part.push_back(part[h / 3]);
      new_vertex.push_back(middle[h]);
      new_u.push_back(m.x);
      new_v.push_back(m.y);
    }
    auto append = [&](auto& column, const auto& more) {
      column.insert(column.end(), more.begin(), more.end());
    };
    append(chart->get<int>("part"), new_part);
    append(chart->get<int>("vertex"), new_vertex);
    append(chart->get<double>("u"), new_u);
    append(chart->get<double>("v"), new_v);
    chart->rows += new_part.size();
  }

  std::vector<Tri> tris;
  std::vector<int> parent;
  std::vector<std::uint8_t> model;
  const std::vector<std::uint8_t>* bits =
      surface.face.has("model") ? &surface.face.get<std::uint8_t>("model") : nullptr;
  for (int t = 0; t < n_tris; ++t) {
    const int n = cut(t, piece);
    for (int k = 0; k < n; ++k) {
      Tri v;
      std::uint8_t m = 0;
      for (int i = 0; i < 3; ++i) {
        const int c = piece[k][i], below = edge_below(c, piece[k][(i + 1) % 3]);
        v[i] = c < 3 ? surface.tris[t][c] : middle[3 * t + c - 3];
        if (bits && below >= 0 && ((*bits)[t] >> below & 1)) m |= static_cast<std::uint8_t>(1 << i);
      }
      tris.push_back(v);
      model.push_back(m);
      parent.push_back(t);
    }
  }
  const std::size_t n_new = ends.size() / 2;
  for (std::size_t i = 0; i < n_new; ++i)
    surface.points.push_back(lerp(surface.points[ends[2 * i]], surface.points[ends[2 * i + 1]], 0.5));
  for (Column& c : surface.vertex.columns)
    std::visit(
        [&]<class T>(std::vector<T>& v) {
          for (std::size_t i = 0; i < n_new; ++i) {
            const int a = std::min(ends[2 * i], ends[2 * i + 1]), b = std::max(ends[2 * i], ends[2 * i + 1]);
            if constexpr (std::is_same_v<T, double>)
              v.push_back(0.5 * v[a] + 0.5 * v[b]);
            else
              v.push_back(v[a]);
          }
        },
        c.data);
  surface.vertex.rows = surface.points.size();
  for (Column& c : surface.face.columns) std::visit([&](auto& v) { v = gathered(v, parent); }, c.data);
  surface.face.rows = parent.size();
  if (bits) surface.face.get<std::uint8_t>("model") = std::move(model);
  surface.tris = std::move(tris);
  return parent;
}

}  // namespace meshpipe
