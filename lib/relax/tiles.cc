// SPDX-License-Identifier: BSD-3-Clause
#include "lib/relax/tiles.h"

#include "lib/core/error.h"
#include "lib/core/intersect.h"
#include "lib/core/spatial_order.h"
#include "lib/relax/patch.h"

namespace meshpipe {
namespace {

std::pair<int, int> edge(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// See excess.
int excess_in(const Mesh& mesh, const Lists& at_vertex, int v) {
  std::vector<int> neighbors;
  const int triangles = (int)at_vertex[v].size();
  for (int t : at_vertex[v])
    for (int w : mesh.tris[t])
      if (w != v) neighbors.push_back(w);
  sort_unique(neighbors);
  const int valence = (int)neighbors.size();
  return valence - (valence == triangles ? 6 : 4);
}

/// Sets the columns of vertices to those of these rows.
void take_vertices(TiledMesh& to, const TiledMesh& from, const std::vector<int>& rows) {
  to.mesh.points = rearranged(from.mesh.points, rows), to.mesh.place = rearranged(from.mesh.place, rows);
  to.mesh.kind = rearranged(from.mesh.kind, rows), to.mesh.line = rearranged(from.mesh.line, rows);
  to.mesh.size = rearranged(from.mesh.size, rows);
  to.hold = rearranged(from.hold, rows), to.refinement = rearranged(from.refinement, rows);
}

/// Copies the rows of a tile, freezes its rim and keeps the model edges on it.
void take_mesh(Tile& tile, const TiledMesh& whole, const Lists& at_vertex,
               const std::vector<int>& triangles) {
  const LiftedMesh& from = whole.mesh;
  LiftedMesh& to = tile.mesh;
  Rim& rim = tile.rim;
  to.tris = rearranged(from.tris, triangles), to.model = rearranged(from.model, triangles);
  to.patch = rearranged(from.patch, triangles), to.part = rearranged(from.part, triangles);
  const std::vector<int> list = number_by_first_use(to.tris, from.points.size());
  take_vertices(tile, whole, list);
  std::vector<int> uses(list.size());
  for (const Tri& t : to.tris)
    for (int v : t) ++uses[v];
  for (int i = 0; i < (int)list.size(); ++i)
    if (uses[i] < at_vertex.start[list[i] + 1] - at_vertex.start[list[i]]) {
      tile.hold[i] = frozen;
      rim.vertex.push_back(i), rim.row.push_back(list[i]);
      rim.excess.push_back(excess_in(from, at_vertex, list[i]));
    }
  take_vertices(rim, whole, rim.row);
  for (std::size_t t = 0; t < to.tris.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const int a = to.tris[t][i], b = to.tris[t][(i + 1) % 3];
      if ((to.model[t] >> i & 1) && tile.hold[a] == frozen && tile.hold[b] == frozen)
        tile.model_rim.push_back(edge(list[a], list[b]));
    }
  std::sort(tile.model_rim.begin(), tile.model_rim.end());
}

/// Copies the rows of the slice, and the places' numbers in it.
void take_slice(Tile& tile, const Surface& reference, const std::vector<char>& corner) {
  Surface& slice = tile.slice;
  std::vector<int> number(reference.tris.size(), -1);
  for (int i = 0; i < (int)tile.faces.size(); ++i) number[tile.faces[i]] = i;
  for (Place& p : tile.mesh.place) {
    if (number[p.face] < 0) number[p.face] = (int)tile.faces.size(), tile.faces.push_back(p.face);
    p.face = number[p.face];
  }
  std::vector<int> vertices;
  static_cast<Mesh&>(slice) = part_of(reference, tile.faces, &vertices);
  if (reference.vertex.has("size"))
    slice.vertex.set("size", rearranged(reference.vertex.get<double>("size"), vertices));
  if (reference.face.has("model"))
    slice.face.set("model", rearranged(reference.face.get<std::uint8_t>("model"), tile.faces));
  if (reference.face.has("origin"))
    slice.face.set("origin", rearranged(reference.face.get<int>("origin"), tile.faces));
  if (!corner.empty()) tile.corner = rearranged(corner, vertices);
}

}  // namespace

Lists triangles_at_vertices(const Mesh& mesh) {
  return lists_of((int)mesh.points.size(), [&](auto add) {
    for (int t = 0; t < (int)mesh.tris.size(); ++t)
      for (int v : mesh.tris[t]) add(v, t);
  });
}

Tile cut_tile(const TiledMesh& whole, const Lists& at_vertex, const Surface& reference,
              const std::vector<char>& corner, const std::vector<std::vector<int>>& boxes, const Lists& faces,
              const Lists& others, int tile) {
  Tile t;
  take_mesh(t, whole, at_vertex, boxes[tile]);
  if (!others.start.empty()) t.others = part_of(whole.mesh, others[tile]);
  t.faces.assign(faces[tile].begin(), faces[tile].end());
  take_slice(t, reference, corner);
  return t;
}

std::vector<std::pair<int, int>> tile_intersections(const Mesh& mesh,
                                                    const std::vector<std::vector<int>>& boxes,
                                                    double reach) {
  std::vector<int> near = around_tiles(mesh, boxes, reach, nullptr).row;
  sort_unique(near);
  std::vector<std::pair<int, int>> pairs;
  if (near.empty()) return pairs;
  pairs = self_intersections(part_of(mesh, near));
  for (auto& [a, b] : pairs) a = near[a], b = near[b];
  return pairs;
}

namespace {

/// Keeps the rows that are marked.
template <class T>
void keep_rows(std::vector<T>& column, const std::vector<char>& keep) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < column.size(); ++i)
    if (keep[i]) column[n++] = column[i];
  column.resize(n);
}

int append_vertex(TiledMesh& whole, const TiledMesh& from, int v) {
  const LiftedMesh& m = from.mesh;
  LiftedMesh& to = whole.mesh;
  to.points.push_back(m.points[v]), to.place.push_back(m.place[v]);
  to.kind.push_back(m.kind[v]), to.line.push_back(m.line[v]), to.size.push_back(m.size[v]);
  whole.hold.push_back(from.hold[v]), whole.refinement.push_back(from.refinement[v]);
  return (int)to.points.size() - 1;
}

}  // namespace

std::vector<int> remove_region(TiledMesh& whole, const std::vector<int>& region) {
  LiftedMesh& m = whole.mesh;
  std::vector<int> number(m.points.size(), -1);
  std::vector<char> stays(m.tris.size(), 1), used(m.points.size());
  for (int t : region) stays[t] = 0;
  keep_rows(m.tris, stays), keep_rows(m.model, stays), keep_rows(m.patch, stays), keep_rows(m.part, stays);
  for (const Tri& t : m.tris)
    for (int v : t) used[v] = 1;
  int outside = 0;
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v]) number[v] = outside++;
  for (Tri& t : m.tris)
    for (int& v : t) v = number[v];
  keep_rows(m.points, used), keep_rows(m.place, used), keep_rows(m.kind, used), keep_rows(m.line, used);
  keep_rows(m.size, used), keep_rows(whole.hold, used), keep_rows(whole.refinement, used);
  return number;
}

void reserve(TiledMesh& whole, std::size_t points, std::size_t triangles) {
  LiftedMesh& m = whole.mesh;
  m.points.reserve(points), m.place.reserve(points), m.kind.reserve(points), m.line.reserve(points);
  m.size.reserve(points), whole.hold.reserve(points), whole.refinement.reserve(points);
  m.tris.reserve(triangles), m.model.reserve(triangles);
  m.patch.reserve(triangles), m.part.reserve(triangles);
}

void append_tile(TiledMesh& whole, const Tile& tile, std::vector<int>& number, std::vector<int>& seams) {
  LiftedMesh& to = whole.mesh;
  const Rim& rim = tile.rim;
  std::vector<int> rows(tile.mesh.points.size(), -1), known(rows.size(), -1);  // of the mesh now, and before
  for (int i = 0; i < (int)rim.vertex.size(); ++i) {
    const int row = rim.row[i];
    if (row >= (int)number.size()) number.resize(row + 1, -1);
    if (number[row] < 0) {
      number[row] = append_vertex(whole, rim, i);
      seams.push_back(number[row]);
    } else if (to.points[number[row]] != rim.mesh.points[i]) {
      throw BadInput("its rim is not that of the other tiles, at vertex " + std::to_string(row));
    }
    known[rim.vertex[i]] = row, rows[rim.vertex[i]] = number[row];
  }
  for (int v = 0; v < (int)rows.size(); ++v)
    if (rows[v] < 0) rows[v] = append_vertex(whole, tile, v);
  for (std::size_t t = 0; t < tile.mesh.tris.size(); ++t) {
    const Tri& v = tile.mesh.tris[t];
    std::uint8_t model = tile.mesh.model[t];
    for (int i = 0; i < 3 && !tile.model_rim.empty(); ++i) {
      const int a = known[v[i]], b = known[v[(i + 1) % 3]];
      if (a >= 0 && b >= 0 && std::binary_search(tile.model_rim.begin(), tile.model_rim.end(), edge(a, b)))
        model |= 1 << i;
    }
    to.tris.push_back({rows[v[0]], rows[v[1]], rows[v[2]]});
    to.model.push_back(model), to.patch.push_back(tile.mesh.patch[t]), to.part.push_back(tile.mesh.part[t]);
  }
}

std::vector<int> triangles_near(const Mesh& mesh, const std::vector<int>& vertices, int rings) {
  std::vector<int> triangles;
  std::vector<char> near(mesh.points.size());
  for (int v : vertices) near[v] = 1;
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<char> next = near;
    triangles.clear();
    for (int t = 0; t < (int)mesh.tris.size(); ++t) {
      const auto [a, b, c] = mesh.tris[t];
      if (near[a] | near[b] | near[c]) triangles.push_back(t), next[a] = next[b] = next[c] = 1;
    }
    near.swap(next);
  }
  return triangles;
}

}  // namespace meshpipe
