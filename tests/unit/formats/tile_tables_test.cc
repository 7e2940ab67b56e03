// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream/tile_tables.h"

#include <gtest/gtest.h>

#include "lib/core/error.h"
#include "lib/core/triangle_count.h"
#include "lib/lift/lift.h"
#include "lib/shape/shape.h"

using namespace meshpipe;

namespace {

Surface sized(const Mesh& mesh) {
  Surface s = surface_of(mesh);
  const double h = size_for_count(total_area(s), (double)s.tris.size());
  s.vertex.set("size", std::vector<double>(s.points.size(), h));
  return s;
}

/// A torus in tiles.
struct Example {
  Surface reference = sized(torus(0.4, 2000));
  std::vector<int> kinds{0};
  std::vector<char> corner = std::vector<char>(reference.points.size());
  RelaxOptions options;
  TiledRelax relax{reference, kinds, corner, options};
  TiledMesh whole = as_tiled(place_on(sized(torus(0.4, 2000)), reference));
  TilePass pass;

  Example() {
    options.tile = 400;
    pass = relax.pass(whole, true);
  }
  Stream shard(bool relaxed) const {
    TileTables tiles;
    int number = 0;
    relax.cut(whole, pass, [&](Tile tile) {
      if (relaxed) relax_tile(tile, kinds, pass);
      tiles.add(number++, tile);
    });
    Stream stream;
    tiles.write(stream, {kinds, pass, relaxed});
    stream.history = {{"mrelax", "1", ""}};
    return stream;
  }
  std::vector<Tile> join(const std::vector<Stream>& shards) const {
    const std::vector<std::string> names{"a", "b"};
    return join_tiles(whole, (int)reference.tris.size(), 5, pass, {"mrelax", "", ""},
                      {names.begin(), names.begin() + (long)shards.size()},
                      [&](const std::string& name) { return shards[name == "b"]; });
  }
};

}  // namespace

TEST(TileTables, HoldTilesToTheBit) {
  const Example e;
  Stream stream = read_stream(write_stream(e.shard(false), true), "shard");
  const TileShard shard = take_tiles(stream);
  int next = 0;
  e.relax.cut(e.whole, e.pass, [&](const Tile& tile) {
    const Tile& read = shard.tiles.at(next++);
    EXPECT_EQ(read.mesh.points, tile.mesh.points);
    EXPECT_EQ(read.mesh.tris, tile.mesh.tris);
    EXPECT_EQ(read.hold, tile.hold);
    EXPECT_EQ(read.vertices, tile.vertices);
    EXPECT_EQ(read.excess, tile.excess);
    EXPECT_EQ(read.faces, tile.faces);
    EXPECT_EQ(read.corner, tile.corner);
    EXPECT_EQ(read.slice.points, tile.slice.points);
    EXPECT_EQ(read.slice.tris, tile.slice.tris);
    EXPECT_EQ(read.others.points, tile.others.points);
    EXPECT_EQ(read.others.tris, tile.others.tris);
    for (std::size_t v = 0; v < tile.mesh.place.size(); ++v) {
      EXPECT_EQ(read.mesh.place[v].face, tile.mesh.place[v].face);
      EXPECT_EQ(read.mesh.place[v].b0, tile.mesh.place[v].b0);
    }
  });
  EXPECT_EQ(next, 5);
}

TEST(TileTables, AreJoinedOnlyIfTheyFit) {
  const Example e;
  const Stream good = e.shard(true);
  EXPECT_EQ(e.join({good}).size(), 5u);
  EXPECT_THROW(e.join({good, good}), BadInput);      // doubled
  EXPECT_THROW(e.join({e.shard(false)}), BadInput);  // not relaxed
  Stream other = good;
  other.history.back().arguments = "--sweeps=1";
  EXPECT_THROW(e.join({other}), BadInput);
  Example moved;
  for (Vec3& p : moved.whole.mesh.points) p.x += 1;
  EXPECT_THROW(moved.join({good}), BadInput);
}

// each number of a shard replaced by a wrong one: an error, or another sound shard, but no crash
TEST(TileTables, WrongNumbersAreRefused) {
  const Example e;
  for (bool relaxed : {false, true}) {
    const Stream good = e.shard(relaxed);
    auto spoil = [&](const Table& table, auto pick) {
      for (const Column& c : table.columns)
        for (int wrong : {-2, 1 << 30}) {
          Stream bad = good;
          Table& t = pick(bad);
          if (!std::holds_alternative<std::vector<int>>(t.find(c.name)->data) || t.rows == 0) continue;
          t.template get<int>(c.name)[t.rows / 2] = wrong;
          try {
            if (relaxed)
              e.join({bad});
            else
              take_tiles(bad);
          } catch (const BadInput&) {
          } catch (const NotAdmissible&) {
          }
        }
    };
    spoil(good.surface.vertex, [](Stream& s) -> Table& { return s.surface.vertex; });
    for (std::size_t i = 0; i < good.tables.size(); ++i)
      spoil(good.tables[i], [i](Stream& s) -> Table& { return s.tables[i]; });
  }
}
