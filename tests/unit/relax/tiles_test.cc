// SPDX-License-Identifier: BSD-3-Clause
#include "lib/relax/tiles.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <set>

#include "lib/core/error.h"
#include "lib/core/topology.h"
#include "lib/lift/lift.h"
#include "lib/shape/shape.h"
#include "tests/unit/relax/drawn.h"

using namespace meshpipe;

namespace {

std::vector<int> all_triangles(const Mesh& mesh) {
  std::vector<int> all(mesh.tris.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

TiledMesh tiled(const Surface& s) {
  const std::size_t n = s.points.size();
  return {lifted_of(s), std::vector<Hold>(n), std::vector<double>(n, 1)};
}

std::vector<Tile> cut_all(const TiledMesh& whole, const Surface& reference, int most) {
  std::vector<Tile> tiles;
  const Lists at_vertex = triangles_at_vertices(whole.mesh);
  const auto boxes = split_into_boxes(whole.mesh, all_triangles(whole.mesh), most);
  const Lists faces = around_tiles(whole.mesh, boxes, 2, &reference),
              others = around_tiles(whole.mesh, boxes, 2, nullptr);
  for (int i = 0; i < (int)boxes.size(); ++i)
    tiles.push_back(cut_tile(whole, at_vertex, reference, {}, boxes, faces, others, i));
  return tiles;
}

/// Puts tiles in the place of the mesh that they were cut from. Returns the vertices on seams.
std::vector<int> put_back(TiledMesh& whole, std::vector<Tile> tiles) {
  std::vector<int> number = remove_region(whole, all_triangles(whole.mesh)), seams;
  for (Tile& tile : tiles) {
    for (Place& p : tile.mesh.place) p.face = tile.faces[p.face];  // as a pass does
    append_tile(whole, tile, number, seams);
  }
  return seams;
}

TEST(Tiles, BoxesCoverEachTriangleOnce) {
  const Mesh mesh = torus(0.4, 3000);
  std::vector<int> seen;
  const auto boxes = split_into_boxes(mesh, all_triangles(mesh), 500);
  EXPECT_EQ(boxes.size(), (mesh.tris.size() + 499) / 500);
  for (const std::vector<int>& box : boxes) {
    EXPECT_LE(box.size(), 500u);
    EXPECT_TRUE(std::is_sorted(box.begin(), box.end()));
    seen.insert(seen.end(), box.begin(), box.end());
  }
  std::sort(seen.begin(), seen.end());
  EXPECT_EQ(seen, all_triangles(mesh));
}

TEST(Tiles, TheRimIsFrozenAndNothingElse) {
  const Surface s = sized(torus(0.4, 3000), 3000);
  const TiledMesh whole = tiled(s);
  std::map<std::array<double, 3>, int> tiles_at;
  const auto at = [](Vec3 p) { return std::array{p.x, p.y, p.z}; };
  const std::vector<Tile> tiles = cut_all(whole, s, 500);
  for (const Tile& tile : tiles)
    for (Vec3 p : tile.mesh.points) ++tiles_at[at(p)];
  EXPECT_EQ(tiles_at.size(), s.points.size());
  for (const Tile& tile : tiles) {
    const Rim& rim = tile.rim;
    for (std::size_t i = 0; i < tile.hold.size(); ++i)
      EXPECT_EQ(tile.hold[i] == frozen, tiles_at[at(tile.mesh.points[i])] > 1);
    EXPECT_EQ(std::count(tile.hold.begin(), tile.hold.end(), frozen), (std::ptrdiff_t)rim.vertex.size());
    for (std::size_t i = 0; i < rim.vertex.size(); ++i) {
      EXPECT_EQ(tile.mesh.points[rim.vertex[i]], s.points[rim.row[i]]);
      EXPECT_EQ(rim.hold[i], loose);
    }
  }
}

TEST(Tiles, RimsKnowTheirValenceInTheWhole) {
  const Surface s = sized(torus(0.4, 3000), 3000);
  const TiledMesh whole = tiled(s);
  std::vector<int> valence(s.points.size());
  for (const Tri& t : s.tris)
    for (int v : t) ++valence[v];  // closed
  for (const Tile& tile : cut_all(whole, s, 500))
    for (std::size_t i = 0; i < tile.rim.row.size(); ++i)
      EXPECT_EQ(tile.rim.excess[i], valence[tile.rim.row[i]] - 6);
}

TEST(Tiles, EachHasTheReferenceAndTheOthersAroundIt) {
  Surface reference = sized(torus(0.4, 8000), 2000);
  reference.face.set("origin", identity(reference.tris.size()));
  TiledMesh whole;
  whole.mesh = place_on(sized(torus(0.4, 2000), 2000), reference);
  whole.hold.resize(whole.mesh.points.size()), whole.refinement.resize(whole.mesh.points.size(), 1);
  std::set<int> faces;
  for (const Tile& tile : cut_all(whole, reference, 250)) {
    for (std::size_t i = 0; i < tile.hold.size(); ++i) {
      const Place& p = tile.mesh.place[i];
      const Tri& t = tile.slice.tris[p.face];
      const Vec3 x =
          p.b0 * tile.slice.points[t[0]] + p.b1 * tile.slice.points[t[1]] + p.b2 * tile.slice.points[t[2]];
      EXPECT_LT(norm(x - tile.mesh.points[i]), 1e-12);
    }
    faces.insert(tile.faces.begin(), tile.faces.end());
    EXPECT_EQ(tile.faces.size(), tile.slice.tris.size());
    EXPECT_EQ(tile.slice.face.get<int>("origin"), tile.faces);
    EXPECT_LT(tile.faces.size(), 3 * reference.tris.size() / 4);
    // vertices of the rim have triangles on both sides
    std::set<std::array<double, 3>> beyond;
    for (Vec3 p : tile.others.points) beyond.insert({p.x, p.y, p.z});
    for (std::size_t i = 0; i < tile.hold.size(); ++i) {
      const Vec3 p = tile.mesh.points[i];
      EXPECT_TRUE(tile.hold[i] != frozen || beyond.count({p.x, p.y, p.z}));
    }
  }
  EXPECT_EQ(faces.size(), reference.tris.size());
}

// triangles of the reference much longer than tiles: all tiles along them have them
TEST(Tiles, NeedlesOfTheReferenceAreInEachSliceThatTheyCross) {
  Mesh strips;  // of a plate, each as long as the plate
  const int n = 20;
  for (int i = 0; i <= n; ++i)
    for (double y : {0.0, 20.0}) strips.points.push_back({(double)i / 4, y, 0});
  for (int i = 0; i < n; ++i) {
    strips.tris.push_back({2 * i, 2 * i + 2, 2 * i + 3});
    strips.tris.push_back({2 * i, 2 * i + 3, 2 * i + 1});
  }
  Mesh grid;
  for (int j = 0; j <= 20; ++j)
    for (int i = 0; i <= 5; ++i) grid.points.push_back({(double)i, (double)j, 0});
  for (int j = 0; j < 20; ++j)
    for (int i = 0; i < 5; ++i) {
      const int a = 6 * j + i;
      grid.tris.push_back({a, a + 1, a + 7});
      grid.tris.push_back({a, a + 7, a + 6});
    }
  const Surface reference = sized(strips, 200);
  TiledMesh whole;
  whole.mesh = place_on(sized(grid, 200), reference);
  whole.hold.resize(whole.mesh.points.size()), whole.refinement.resize(whole.mesh.points.size(), 1);
  const std::vector<Tile> tiles = cut_all(whole, reference, 50);
  EXPECT_EQ(tiles.size(), 4u);
  for (const Tile& tile : tiles) EXPECT_EQ(tile.faces.size(), reference.tris.size());
}

TEST(Tiles, PutBackTheyAreTheMeshAgain) {
  const Body body = cube(600);
  Surface s = sized(body, 600);
  TiledMesh whole = tiled(s);
  for (std::size_t t = 0; t < s.tris.size(); ++t) whole.mesh.model[t] = (std::uint8_t)(t % 8);
  auto corners = [](const LiftedMesh& m) {
    std::vector<std::array<double, 10>> rows;
    for (std::size_t t = 0; t < m.tris.size(); ++t) {
      const Vec3 a = m.points[m.tris[t][0]], b = m.points[m.tris[t][1]], c = m.points[m.tris[t][2]];
      rows.push_back({a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, (double)m.patch[t]});
    }
    std::sort(rows.begin(), rows.end());
    return rows;
  };
  const auto before = corners(whole.mesh);
  std::vector<Tile> tiles = cut_all(whole, s, 100);
  std::set<int> shared;
  for (const Tile& tile : tiles) shared.insert(tile.rim.row.begin(), tile.rim.row.end());
  EXPECT_EQ(put_back(whole, tiles).size(), shared.size());
  EXPECT_EQ(corners(whole.mesh), before);
  EXPECT_EQ(whole.mesh.points.size(), s.points.size());
  EXPECT_EQ(whole.hold.size(), s.points.size());
  for (std::size_t v = 0; v < s.points.size(); ++v)
    EXPECT_EQ(whole.mesh.points[v],
              s.points[s.tris[whole.mesh.place[v].face][whole.mesh.place[v].b0 == 1   ? 0
                                                        : whole.mesh.place[v].b1 == 1 ? 1
                                                                                      : 2]]);
}

TEST(Tiles, OfAnotherMeshAreRefused) {
  const Surface s = sized(torus(0.4, 3000), 3000);
  TiledMesh whole = tiled(s);
  std::vector<Tile> tiles = cut_all(whole, s, 500);
  for (Vec3& p : tiles.back().rim.mesh.points) p.x += 1;
  EXPECT_THROW(put_back(whole, tiles), BadInput);
}

// the rest of the mesh stays what it is
TEST(Tiles, ReplaceARegion) {
  const Surface s = sized(torus(0.4, 3000), 3000);
  TiledMesh whole = tiled(s);
  const std::vector<int> region = triangles_near(s, {7}, 3);
  const Lists at_vertex = triangles_at_vertices(s), faces{{0, (int)s.tris.size()}, all_triangles(s)};
  const Tile tile = cut_tile(whole, at_vertex, s, {}, {region}, faces, {}, 0);
  std::vector<int> number = remove_region(whole, region), seams;
  EXPECT_EQ(whole.mesh.tris.size(), s.tris.size() - region.size());
  append_tile(whole, tile, number, seams);
  EXPECT_TRUE(seams.empty());
  EXPECT_EQ(whole.mesh.points.size(), s.points.size());
  EXPECT_NEAR(total_area(whole.mesh), total_area(s), 1e-9);
  EXPECT_NO_THROW(opposite_halfedges(whole.mesh));
}

TEST(Tiles, ModelEdgesOfRimsStay) {
  const Body body = cube(600);
  Surface s = sized(body, 600);
  TiledMesh whole = tiled(s);
  const std::vector<int> opposite = opposite_halfedges(s.tris, (int)s.points.size());
  for (int h = 0; h < (int)opposite.size(); ++h)
    if (body.patch[h / 3] != body.patch[opposite[h] / 3]) whole.mesh.model[h / 3] |= 1 << h % 3;
  auto edges = [](const LiftedMesh& m) {
    int count = 0;
    for (std::uint8_t bits : m.model) count += (bits & 1) + (bits >> 1 & 1) + (bits >> 2 & 1);
    return count;
  };
  const int before = edges(whole.mesh);
  std::vector<Tile> tiles = cut_all(whole, s, 100);
  for (Tile& tile : tiles) {
    const std::vector<int> beyond = opposite_halfedges(tile.mesh.tris, (int)tile.mesh.points.size());
    for (int h = 0; h < (int)beyond.size(); ++h)
      if (beyond[h] < 0) tile.mesh.model[h / 3] &= ~(1 << h % 3);  // a border while the tile is by itself
  }
  put_back(whole, tiles);
  EXPECT_EQ(edges(whole.mesh), before);
}

// two plates, a vertical one through a horizontal one, each in a box of its own
TEST(Tiles, CrossingsOfBoxesAreFound) {
  Mesh mesh{
      {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {1, 1, -1}, {1, 1, 1}, {4, 1, 0}, {9, 9, 9}, {9, 8, 9}, {9, 9, 8}},
      {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}}};
  const std::vector<std::pair<int, int>> expected{{0, 1}};
  EXPECT_EQ(tile_intersections(mesh, {{0}, {1}, {2}}, 1), expected);
  mesh.points[5] = {1, 4, 0}, mesh.points[3].z = 0.5;
  EXPECT_TRUE(tile_intersections(mesh, {{0}, {1}, {2}}, 1).empty());
}

TEST(Tiles, TrianglesNearComeRingByRing) {
  const Surface s = sized(torus(0.4, 3000), 3000);
  EXPECT_EQ(triangles_near(s, {7}, 1).size(), 6u);
  EXPECT_EQ(triangles_near(s, {7}, 2).size(), 24u);
  EXPECT_EQ(triangles_near(s, {}, 2).size(), 0u);
}

}  // namespace
