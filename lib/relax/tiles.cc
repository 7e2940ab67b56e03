// SPDX-License-Identifier: BSD-3-Clause
#include "lib/relax/tiles.h"

#include <span>

#include "lib/core/intersect.h"
#include "lib/relax/patch.h"

namespace meshpipe {
namespace {

/// Rows of a whole that a part has, numbered by first use.
struct Rows {
  std::vector<int> list, number;  ///< number: per row of the whole, -1: the part does not have it
  explicit Rows(std::size_t whole) : number(whole, -1) {}
  int of(int row) {
    if (number[row] < 0) number[row] = (int)list.size(), list.push_back(row);
    return number[row];
  }
};

template <class T>
std::vector<T> picked(const std::vector<T>& column, const std::vector<int>& rows) {
  std::vector<T> values;
  values.reserve(rows.size());
  for (int row : rows) values.push_back(column[row]);
  return values;
}

std::pair<int, int> edge(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// The vertices up to `rings` edges away from these, these included, ascending.
std::vector<int> vertices_near(const Mesh& mesh, const Lists& at_vertex, std::vector<int> vertices,
                               int rings) {
  std::vector<int> outer = vertices;
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<int> found;
    for (int v : outer)
      for (int t : at_vertex[v]) found.insert(found.end(), mesh.tris[t].begin(), mesh.tris[t].end());
    sort_unique(found);
    outer.clear();
    std::set_difference(found.begin(), found.end(), vertices.begin(), vertices.end(),
                        std::back_inserter(outer));
    const auto middle = (std::ptrdiff_t)vertices.size();
    vertices.insert(vertices.end(), outer.begin(), outer.end());
    std::inplace_merge(vertices.begin(), vertices.begin() + middle, vertices.end());
  }
  return vertices;
}

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

/// Copies the rows of a tile, freezes its rim and keeps the model edges on it.
void take_mesh(Tile& tile, const TiledMesh& whole, const Lists& at_vertex) {
  const LiftedMesh& from = whole.mesh;
  LiftedMesh& to = tile.mesh;
  Rows vertices(from.points.size());
  to.tris = picked(from.tris, tile.triangles), to.model = picked(from.model, tile.triangles);
  to.patch = picked(from.patch, tile.triangles), to.part = picked(from.part, tile.triangles);
  for (Tri& t : to.tris)
    for (int& v : t) v = vertices.of(v);
  const std::vector<int>& list = tile.vertices = vertices.list;
  to.points = picked(from.points, list), to.place = picked(from.place, list);
  to.kind = picked(from.kind, list), to.line = picked(from.line, list), to.size = picked(from.size, list);
  tile.hold = picked(whole.hold, list), tile.refinement = picked(whole.refinement, list);
  std::vector<int> uses(list.size());
  for (const Tri& t : to.tris)
    for (int v : t) ++uses[v];
  tile.excess.resize(list.size());
  for (std::size_t i = 0; i < list.size(); ++i)
    if (uses[i] < at_vertex.start[list[i] + 1] - at_vertex.start[list[i]]) {
      tile.hold[i] = frozen;
      tile.excess[i] = excess_in(from, at_vertex, list[i]);
    }
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
  Rows faces(reference.tris.size()), vertices(reference.points.size());
  for (int f : tile.faces) faces.of(f);
  for (Place& p : tile.mesh.place) p.face = faces.of(p.face);
  tile.faces = std::move(faces.list);
  slice.tris = picked(reference.tris, tile.faces);
  for (Tri& t : slice.tris)
    for (int& v : t) v = vertices.of(v);
  slice.points = picked(reference.points, vertices.list);
  if (reference.vertex.has("size"))
    slice.vertex.set("size", picked(reference.vertex.get<double>("size"), vertices.list));
  if (reference.face.has("model"))
    slice.face.set("model", picked(reference.face.get<std::uint8_t>("model"), tile.faces));
  if (!corner.empty()) tile.corner = picked(corner, vertices.list);
}

/// These triangles as a mesh of its own.
Mesh part_of(const Mesh& mesh, std::span<const int> triangles) {
  Rows vertices(mesh.points.size());
  Mesh part;
  for (int t : triangles) {
    Tri& v = part.tris.emplace_back(mesh.tris[t]);
    for (int& w : v) w = vertices.of(w);
  }
  part.points = picked(mesh.points, vertices.list);
  return part;
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
  t.triangles = boxes[tile];
  take_mesh(t, whole, at_vertex);
  if (!others.start.empty())
    t.others = part_of(whole.mesh,
                       {others.row.data() + others.start[tile], others.row.data() + others.start[tile + 1]});
  t.faces.assign(faces[tile].begin(), faces[tile].end());
  take_slice(t, reference, corner);
  return t;
}

std::vector<std::pair<int, int>> crossings_of_boxes(const Mesh& mesh,
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

std::vector<int> replace_tiles(TiledMesh& whole, std::vector<Tile> tiles) {
  const LiftedMesh& old = whole.mesh;
  const int n = (int)old.points.size();
  std::vector<char> gone_triangle(old.tris.size());
  // triangles at each vertex that are in no tile; -1: a frozen vertex of a tile
  std::vector<int> uses(n, 0), number(n, -1);
  std::vector<char> keep(n);
  for (const Tile& tile : tiles)
    for (int t : tile.triangles) gone_triangle[t] = 1;
  for (std::size_t t = 0; t < old.tris.size(); ++t)
    if (!gone_triangle[t])
      for (int v : old.tris[t]) ++uses[v], keep[v] = 1;
  for (const Tile& tile : tiles)
    for (int v : tile.vertices)
      if (v >= 0) keep[v] = 1;
  TiledMesh result;
  LiftedMesh& to = result.mesh;
  std::size_t points = std::count(keep.begin(), keep.end(), 1),
              triangles = std::count(gone_triangle.begin(), gone_triangle.end(), 0);
  for (const Tile& tile : tiles) {
    points += std::count(tile.vertices.begin(), tile.vertices.end(), -1);
    triangles += tile.mesh.tris.size();
  }
  to.points.reserve(points), to.place.reserve(points), to.kind.reserve(points), to.line.reserve(points);
  to.size.reserve(points), result.hold.reserve(points), result.refinement.reserve(points);
  to.tris.reserve(triangles), to.model.reserve(triangles);
  to.patch.reserve(triangles), to.part.reserve(triangles);
  auto add_vertex = [&](const TiledMesh& from, int v) {
    const LiftedMesh& m = from.mesh;
    to.points.push_back(m.points[v]), to.place.push_back(m.place[v]);
    to.kind.push_back(m.kind[v]), to.line.push_back(m.line[v]), to.size.push_back(m.size[v]);
    result.hold.push_back(from.hold[v]), result.refinement.push_back(from.refinement[v]);
    return (int)to.points.size() - 1;
  };
  auto add_triangle = [&](const LiftedMesh& from, int t, const std::vector<int>& rows, std::uint8_t model) {
    const Tri& v = from.tris[t];
    to.tris.push_back({rows[v[0]], rows[v[1]], rows[v[2]]});
    to.model.push_back(model), to.patch.push_back(from.patch[t]), to.part.push_back(from.part[t]);
  };
  for (int v = 0; v < n; ++v)
    if (keep[v]) number[v] = add_vertex(whole, v);
  for (int t = 0; t < (int)old.tris.size(); ++t)
    if (!gone_triangle[t]) add_triangle(old, t, number, old.model[t]);
  std::vector<int> seams;
  for (Tile& tile : tiles) {
    std::vector<int> rows;
    for (int v = 0; v < (int)tile.vertices.size(); ++v) {
      const int known = tile.vertices[v];
      rows.push_back(known < 0 ? add_vertex(tile, v) : number[known]);
      if (known >= 0 && uses[known] == 0) seams.push_back(number[known]);
    }
    for (int t = 0; t < (int)tile.mesh.tris.size(); ++t) {
      std::uint8_t model = tile.mesh.model[t];
      for (int i = 0; i < 3 && !tile.model_rim.empty(); ++i) {
        const int a = tile.vertices[tile.mesh.tris[t][i]], b = tile.vertices[tile.mesh.tris[t][(i + 1) % 3]];
        if (a >= 0 && b >= 0 && std::binary_search(tile.model_rim.begin(), tile.model_rim.end(), edge(a, b)))
          model |= 1 << i;
      }
      add_triangle(tile.mesh, t, rows, model);
    }
    tile = {};  // frees its memory now
  }
  whole = std::move(result);
  sort_unique(seams);
  return seams;
}

std::vector<int> triangles_near(const Mesh& mesh, std::vector<int> vertices, int rings) {
  const Lists at_vertex = triangles_at_vertices(mesh);
  std::vector<int> triangles;
  for (int v : vertices_near(mesh, at_vertex, std::move(vertices), rings - 1))
    triangles.insert(triangles.end(), at_vertex[v].begin(), at_vertex[v].end());
  sort_unique(triangles);
  return triangles;
}

}  // namespace meshpipe
