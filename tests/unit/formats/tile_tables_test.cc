// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream/tile_tables.h"

#include <gtest/gtest.h>

#include "lib/core/error.h"
#include "lib/core/topology.h"
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
    pass = relax.pass(whole, false);
  }
  std::vector<Stream> tiles(bool relaxed) const {
    std::vector<Stream> streams;
    relax.cut(whole, pass, [&](Tile tile) {
      if (relaxed) relax_tile(tile, kinds, pass);
      streams.push_back(stream_of({(int)streams.size(),
                                   {5, (int)whole.mesh.points.size(), kinds, {1}, pass, {}},
                                   relaxed,
                                   std::move(tile)}));
      streams.back().history = {{"mrelax", "1", ""}};
    });
    return streams;
  }
  JoinedTiles join(const std::vector<std::vector<Stream>>& shards) const {
    const std::vector<std::string> names{"a", "b"};
    Stream stream;
    return join_tiles(stream, (int)reference.tris.size(), {"mrelax", "", ""},
                      {names.begin(), names.begin() + (long)shards.size()},
                      [&](const std::string& name, const auto& take) {
                        for (const Stream& s : shards[name == "b"]) take(s);
                      });
  }
};

}  // namespace

TEST(TileTables, HoldTilesToTheBit) {
  const Example e;
  const std::vector<Stream> streams = e.tiles(false);
  int next = 0;
  e.relax.cut(e.whole, e.pass, [&](const Tile& tile) {
    const TileJob job = take_tile(read_stream(write_stream(streams.at(next), true), "tile"));
    EXPECT_EQ(job.number, next++);
    EXPECT_FALSE(job.relaxed);
    const Tile& read = job.tile;
    EXPECT_EQ(read.mesh.points, tile.mesh.points);
    EXPECT_EQ(read.mesh.tris, tile.mesh.tris);
    EXPECT_EQ(read.hold, tile.hold);
    EXPECT_EQ(read.refinement, tile.refinement);
    EXPECT_EQ(read.rim.vertex, tile.rim.vertex);
    EXPECT_EQ(read.rim.row, tile.rim.row);
    EXPECT_EQ(read.rim.excess, tile.rim.excess);
    EXPECT_EQ(read.rim.hold, tile.rim.hold);
    EXPECT_EQ(read.rim.mesh.points, tile.rim.mesh.points);
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
  const std::vector<Stream> good = e.tiles(true);
  const JoinedTiles joined = e.join({good});
  EXPECT_NO_THROW(opposite_halfedges(joined.mesh.mesh));
  EXPECT_FALSE(joined.seams.empty());
  const JoinedTiles again = e.join({{good.begin() + 2, good.end()}, {good.begin(), good.begin() + 2}});
  EXPECT_EQ(again.mesh.mesh.points, joined.mesh.mesh.points);
  EXPECT_EQ(again.mesh.mesh.tris, joined.mesh.mesh.tris);
  EXPECT_THROW(e.join({{good.begin(), good.end() - 1}}), BadInput);  // one is missing
  EXPECT_THROW(e.join({good, good}), BadInput);                      // doubled
  EXPECT_THROW(e.join({e.tiles(false)}), BadInput);                  // not relaxed
  std::vector<Stream> other = good;
  other.back().history.back().arguments = "--sweeps=1";
  EXPECT_THROW(e.join({other}), BadInput);
  other = good;
  other.back().history.insert(other.back().history.begin(), {"mlift", "1", ""});
  EXPECT_THROW(e.join({other}), BadInput);  // made of another stream
  Example moved;
  for (Vec3& p : moved.whole.mesh.points) p.x += 1;
  other = good;
  other.back() = moved.tiles(true).back();
  EXPECT_THROW(e.join({other}), BadInput);
}

// several streams one after the other are read where that is allowed, binary and as text
TEST(ReadStream, TakesOneOfSeveral) {
  const Example e;
  for (bool ascii : {false, true}) {
    std::string all;
    for (const Stream& s : e.tiles(false)) all += write_stream(s, ascii);
    MemorySource source(all);
    int next = 0;
    while (!source.left.empty()) EXPECT_EQ(take_tile(read_stream(source, "shard", true)).number, next++);
    EXPECT_EQ(next, 5);
    EXPECT_THROW(read_stream(all, "shard"), BadInput);
    for (const std::string& bad : {all + "x", all.substr(0, all.size() - 1)}) {
      source.left = bad;
      for (int i = 0; i < 4; ++i) read_stream(source, "shard", true);
      EXPECT_THROW(read_stream(source, "shard", true), BadInput);
    }
  }
}

// each number of a shard replaced by a wrong one: an error, or another sound shard, but no crash
TEST(TileTables, WrongNumbersAreRefused) {
  const Example e;
  for (bool relaxed : {false, true}) {
    const std::vector<Stream> tiles = e.tiles(relaxed);
    const Stream& good = tiles[0];
    auto spoil = [&](const Table& table, auto pick) {
      for (const Column& c : table.columns)
        for (int wrong : {-2, 1 << 30}) {
          Stream bad = good;
          Table& t = pick(bad);
          if (!std::holds_alternative<std::vector<int>>(t.find(c.name)->data) || t.rows == 0) continue;
          t.template get<int>(c.name)[t.rows / 2] = wrong;
          try {
            if (relaxed)
              e.join({{bad}, {tiles.begin() + 1, tiles.end()}});
            else
              take_tile(bad);
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
