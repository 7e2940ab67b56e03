// SPDX-License-Identifier: BSD-3-Clause
#include "lib/relax/tiles.h"

#include <numeric>
#include <span>

#include "lib/core/intersect.h"
#include "lib/core/triangle_count.h"
#include "lib/relax/patch.h"

namespace meshpipe {
namespace {

/// The lists of the pairs (key, row) that `each` calls its argument for.
template <class Each>
Lists lists_of(int keys, Each each) {
  Lists lists{std::vector<int>(keys + 1, 0), {}};
  each([&](int key, int) { ++lists.start[key + 1]; });
  std::partial_sum(lists.start.begin(), lists.start.end(), lists.start.begin());
  lists.row.resize(lists.start.back());
  std::vector<int> at(lists.start.begin(), lists.start.end() - 1);
  each([&](int key, int row) { lists.row[at[key]++] = row; });
  return lists;
}

template <class F>
void for_rows(const Lists& lists, int key, F f) {
  for (int i = lists.start[key]; i < lists.start[key + 1]; ++i) f(lists.row[i]);
}

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

struct Item {
  Vec3 middle;  ///< three times
  int triangle;
};

void split(std::vector<Item>::iterator first, std::vector<Item>::iterator last, std::ptrdiff_t most,
           std::vector<std::vector<int>>& boxes) {
  const std::ptrdiff_t n = last - first, count = (n + most - 1) / most;
  if (count <= 1) {
    std::vector<int>& box = boxes.emplace_back();
    for (auto i = first; i != last; ++i) box.push_back(i->triangle);
    std::sort(box.begin(), box.end());
    return;
  }
  Box extent{first->middle, first->middle};
  for (auto i = first; i != last; ++i) extent = join(extent, {i->middle, i->middle});
  const Vec3 d = extent.hi - extent.lo;
  double Vec3::*axis = d.x >= d.y && d.x >= d.z ? &Vec3::x : d.y >= d.z ? &Vec3::y : &Vec3::z;
  const auto middle = first + n * (count / 2) / count;
  std::nth_element(first, middle, last, [&](const Item& a, const Item& b) {
    return std::pair(a.middle.*axis, a.triangle) < std::pair(b.middle.*axis, b.triangle);
  });
  split(first, middle, most, boxes);
  split(middle, last, most, boxes);
}

/// The vertices up to `rings` edges away from these, these included, ascending.
std::vector<int> vertices_near(const Mesh& mesh, const Lists& at_vertex, std::vector<int> vertices,
                               int rings) {
  std::vector<int> outer = vertices;
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<int> found;
    for (int v : outer)
      for_rows(at_vertex, v,
               [&](int t) { found.insert(found.end(), mesh.tris[t].begin(), mesh.tris[t].end()); });
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
  int triangles = 0;
  for_rows(at_vertex, v, [&](int t) {
    ++triangles;
    for (int w : mesh.tris[t])
      if (w != v) neighbors.push_back(w);
  });
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

/// Cubes that fill the box of a mesh.
class Grid {
 public:
  Grid(const Mesh& mesh, double side, double most) {
    Box box = box_of(mesh, 0);
    for (int t = 1; t < (int)mesh.tris.size(); ++t) box = join(box, box_of(mesh, t));
    lo_ = box.lo;
    const Vec3 d = box.hi - box.lo;
    if (!(side > 1e-6 * norm(d))) side = std::max(1e-6 * norm(d), 1e-300);  // a mesh without area
    while ((d.x / side + 1) * (d.y / side + 1) * (d.z / side + 1) > most) side *= 1.25;
    side_ = side;
    n_ = {(int)(d.x / side) + 1, (int)(d.y / side) + 1, (int)(d.z / side) + 1};
  }
  int size() const { return n_[0] * n_[1] * n_[2]; }
  /// Calls f for the cubes that meet a box, or those at the border that are nearest.
  template <class F>
  void for_cubes(const Box& box, F f) const {
    const std::array<int, 3> a = cube(box.lo), b = cube(box.hi);
    for (int k = a[2]; k <= b[2]; ++k)
      for (int j = a[1]; j <= b[1]; ++j)
        for (int i = a[0]; i <= b[0]; ++i) f((k * n_[1] + j) * n_[0] + i);
  }
  /// The same for a triangle, halved until its pieces are no larger than cubes.
  template <class F>
  void for_cubes(Vec3 a, Vec3 b, Vec3 c, F f) const {
    const double bc = norm(c - b), ca = norm(a - c), ab = norm(b - a), longest = std::max({bc, ca, ab});
    if (longest <= side_) return for_cubes({lower(lower(a, b), c), upper(upper(a, b), c)}, f);
    if (longest == ca) std::swap(b, c), std::swap(a, b);
    if (longest == bc && longest != ca) std::swap(a, b), std::swap(b, c);
    const Vec3 middle = lerp(a, b, 0.5);
    for_cubes(a, middle, c, f);
    for_cubes(middle, b, c, f);
  }

 private:
  std::array<int, 3> cube(Vec3 p) const {
    const Vec3 d = (1 / side_) * (p - lo_);
    return {(int)std::clamp(d.x, 0.0, n_[0] - 1.0), (int)std::clamp(d.y, 0.0, n_[1] - 1.0),
            (int)std::clamp(d.z, 0.0, n_[2] - 1.0)};
  }
  Vec3 lo_;
  double side_;
  std::array<int, 3> n_;
};

/// For each tile, the triangles of a mesh in cubes that it has, too, but not its own; `tile`: per triangle.
Lists triangles_in_cubes(const Mesh& mesh, const Grid& grid, const Lists& tiles_at, int tiles,
                         const std::vector<int>& own) {
  constexpr int chunk = 1 << 14;
  const int n = (int)mesh.tris.size(), chunks = (n + chunk - 1) / chunk;
  std::vector<std::vector<std::pair<int, int>>> found(chunks);
  parallel_for(chunks, [&](int k) {
    std::vector<int> near;
    for (int t = k * chunk; t < std::min(n, (k + 1) * chunk); ++t) {
      const auto [a, b, c] = mesh.tris[t];
      near.clear();
      grid.for_cubes(mesh.points[a], mesh.points[b], mesh.points[c], [&](int cube) {
        for_rows(tiles_at, cube, [&](int tile) {
          if ((own.empty() || own[t] != tile) && std::find(near.begin(), near.end(), tile) == near.end())
            near.push_back(tile);
        });
      });
      for (int tile : near) found[k].push_back({tile, t});
    }
  });
  return lists_of(tiles, [&](auto add) {
    for (const auto& pairs : found)
      for (const auto& [tile, t] : pairs) add(tile, t);
  });
}

}  // namespace

std::vector<std::vector<int>> split_into_boxes(const Mesh& mesh, const std::vector<int>& triangles,
                                               int most) {
  std::vector<Item> items;
  items.reserve(triangles.size());
  for (int t : triangles) {
    const auto [a, b, c] = mesh.tris[t];
    items.push_back({mesh.points[a] + mesh.points[b] + mesh.points[c], t});
  }
  std::vector<std::vector<int>> boxes;
  if (!items.empty()) split(items.begin(), items.end(), most, boxes);
  return boxes;
}

Lists triangles_at_vertices(const Mesh& mesh) {
  return lists_of((int)mesh.points.size(), [&](auto add) {
    for (int t = 0; t < (int)mesh.tris.size(); ++t)
      for (int v : mesh.tris[t]) add(v, t);
  });
}

Lists around_tiles(const Mesh& mesh, const std::vector<std::vector<int>>& boxes, double reach,
                   const Mesh* reference) {
  constexpr double edges_per_cube = 4;
  const int tiles = (int)boxes.size(), n = (int)mesh.tris.size();
  const Grid grid(mesh, edges_per_cube * size_for_count(total_area(mesh), n), std::max(1000.0, 0.5 * n));
  std::vector<int> own(n, -1);
  std::vector<std::vector<int>> cubes(tiles);
  parallel_for(tiles, [&](int i) {
    std::vector<char> seen(grid.size());
    for (int t : boxes[i]) {
      own[t] = i;
      Box box = box_of(mesh, t);
      const double r = reach * std::max({box.hi.x - box.lo.x, box.hi.y - box.lo.y, box.hi.z - box.lo.z});
      box.lo = box.lo - Vec3{r, r, r}, box.hi = box.hi + Vec3{r, r, r};
      grid.for_cubes(box, [&](int cube) {
        if (!seen[cube]) seen[cube] = 1, cubes[i].push_back(cube);
      });
    }
  });
  const Lists tiles_at = lists_of(grid.size(), [&](auto add) {
    for (int i = 0; i < tiles; ++i)
      for (int cube : cubes[i]) add(cube, i);
  });
  return reference ? triangles_in_cubes(*reference, grid, tiles_at, tiles, {})
                   : triangles_in_cubes(mesh, grid, tiles_at, tiles, own);
}

Tile cut_tile(const TiledMesh& whole, const Lists& at_vertex, const Surface& reference,
              const std::vector<char>& corner, const std::vector<std::vector<int>>& boxes, const Lists& faces,
              const Lists& others, int tile) {
  Tile t;
  t.triangles = boxes[tile];
  take_mesh(t, whole, at_vertex);
  if (!others.start.empty())
    t.others = part_of(whole.mesh, {&others.row[others.start[tile]], &others.row[others.start[tile + 1]]});
  for_rows(faces, tile, [&](int f) { t.faces.push_back(f); });
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
    for_rows(at_vertex, v, [&](int t) { triangles.push_back(t); });
  sort_unique(triangles);
  return triangles;
}

}  // namespace meshpipe
