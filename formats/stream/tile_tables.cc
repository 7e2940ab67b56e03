// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream/tile_tables.h"

#include <algorithm>
#include <limits>
#include <map>

#include "formats/stream/lift_tables.h"
#include "formats/stream/mesh_tables.h"
#include "lib/core/error.h"

namespace meshpipe {
namespace {

constexpr const char* writer = "mrelax --shards";

constexpr std::pair<const char*, int RelaxCounts::*> count_columns[] = {
    {"splits", &RelaxCounts::splits},
    {"collapses", &RelaxCounts::collapses},
    {"flips", &RelaxCounts::flips},
    {"moves", &RelaxCounts::moves},
    {"corners_merged", &RelaxCounts::corners_merged},
    {"tries", &RelaxCounts::tries}};

void set_counts(Table& table, const RelaxCounts& counts) {
  for (const auto& [name, member] : count_columns) table.set(name, std::vector<int>{counts.*member});
}

RelaxCounts counts_from(const Table& table) {
  RelaxCounts counts;
  for (const auto& [name, member] : count_columns) counts.*member = table.get<int>(name)[0];
  return counts;
}

/// A table of one column.
Table column_table(const char* table, const char* column, std::vector<int> values) {
  Table t{table, 0, {}};
  t.set(column, std::move(values));
  return t;
}

Table pass_table(const TilePass& pass, const RelaxCounts& before) {
  Table table{"tile_pass", 0, {}};
  set_counts(table, before);
  table.set("sweeps", std::vector<int>{pass.sweeps});
  table.set("keep_border", std::vector<int>{pass.keep_border});
  table.set("repair", std::vector<int>{pass.repair});
  table.set("to_count", std::vector<int>{pass.to_count});
  table.set("keep_count", std::vector<int>{pass.keep_count});
  table.set("goal", std::vector<double>{pass.goal});
  table.set("sample_size", std::vector<double>{pass.sample_size});
  table.set("mean_size", std::vector<double>{pass.mean_size});
  return table;
}

TilePass pass_from(const Table& table) {
  auto number = [&](const char* name) { return table.get<int>(name)[0]; };
  auto length = [&](const char* name) {
    const double x = table.get<double>(name)[0];
    if (!(x > 0)) throw BadInput(std::string("tile_pass: ") + name + " is not positive");
    return x;
  };
  TilePass pass{number("sweeps"), number("keep_border") != 0, number("repair") != 0, number("to_count") != 0,
                number("keep_count") != 0};
  pass.goal = length("goal"), pass.sample_size = length("sample_size"), pass.mean_size = length("mean_size");
  return pass;
}

bool same(const TilesOf& a, const TilesOf& b) {
  const TilePass &p = a.pass, &q = b.pass;
  return a.count == b.count && a.vertices == b.vertices && a.line_kind == b.line_kind &&
         a.corners == b.corners && p.sweeps == q.sweeps && p.keep_border == q.keep_border &&
         p.repair == q.repair && p.to_count == q.to_count && p.keep_count == q.keep_count &&
         p.goal == q.goal && p.sample_size == q.sample_size && p.mean_size == q.mean_size &&
         std::all_of(std::begin(count_columns), std::end(count_columns),
                     [&](const auto& c) { return a.before.*c.second == b.before.*c.second; });
}

/// A mesh as a surface, without triangles if it is a rim.
Surface surface_of_tiled(TiledMesh tiled) {
  Surface s = surface_from(std::move(tiled.mesh));
  s.vertex.set("hold", std::vector<std::uint8_t>(tiled.hold.begin(), tiled.hold.end()));
  if (std::any_of(tiled.refinement.begin(), tiled.refinement.end(), [](double f) { return f != 1; }))
    s.vertex.set("refinement", std::move(tiled.refinement));
  return s;
}

TiledMesh tiled_from(Surface& s, int faces, int lines) {
  TiledMesh tiled{take_lifted(s, faces, lines), {}, {}};
  const auto& hold = s.vertex.get<std::uint8_t>("hold");
  tiled.refinement.assign(hold.size(), 1);
  if (s.vertex.has("refinement")) tiled.refinement = std::move(s.vertex.get<double>("refinement"));
  for (std::size_t v = 0; v < hold.size(); ++v) {
    if (hold[v] > paired || !(tiled.refinement[v] > 0))
      throw BadInput("vertex " + std::to_string(v) + " has hold " + std::to_string(hold[v]) +
                     " and refinement " + std::to_string(tiled.refinement[v]) +
                     "; they are at most 5, and positive");
    tiled.hold.push_back(static_cast<Hold>(hold[v]));
  }
  return tiled;
}

Table rim_table(Rim rim) {
  Surface s = surface_of_tiled(std::move(rim));
  Table table = point_table("tile_rim", s);
  for (Column& c : s.vertex.columns) table.columns.push_back(std::move(c));
  table.set("vertex", std::move(rim.vertex));
  table.set("row", std::move(rim.row));
  if (!rim.excess.empty()) table.set("excess", std::move(rim.excess));
  return table;
}

/// Throws: BadInput if it has others than the vertices of its tile and of all.
Rim rim_from(Table table, const TilesOf& of, const TiledMesh& tile, bool relaxed) {
  Surface s;
  s.points = mesh_from(table, triangle_table("", {})).points;
  s.vertex = std::move(table);
  for (const char* column : {"patch", "part"}) s.face.set(column, std::vector<int>());
  s.face.set("model", std::vector<std::uint8_t>());
  Rim rim{tiled_from(s, std::numeric_limits<int>::max(), static_cast<int>(of.line_kind.size())), {}, {}, {}};
  rim.vertex = std::move(s.vertex.get<int>("vertex"));
  rim.row = std::move(s.vertex.get<int>("row"));
  if (!relaxed) rim.excess = s.vertex.rows ? std::move(s.vertex.get<int>("excess")) : std::vector<int>();
  const int vertices = static_cast<int>(tile.hold.size());
  for (std::size_t i = 0; i < rim.row.size(); ++i)
    if (rim.vertex[i] < 0 || rim.vertex[i] >= vertices || rim.row[i] < 0 || rim.row[i] >= of.vertices)
      throw BadInput("tile_rim " + std::to_string(i) + " is vertex " + std::to_string(rim.vertex[i]) +
                     " of the tile and " + std::to_string(rim.row[i]) + " of all, but there are " +
                     std::to_string(vertices) + " and " + std::to_string(of.vertices));
  return rim;
}

}  // namespace

Stream stream_of(TileJob job) {
  Stream stream;
  Tile& tile = job.tile;
  Table table = column_table("tile", "number", {job.number}), edges{"tile_edge", 0, {}};
  table.set("of", std::vector<int>{job.of.count});
  table.set("vertices", std::vector<int>{job.of.vertices});
  if (job.relaxed) set_counts(table, tile.counts);
  stream.surface = surface_of_tiled(std::move(tile));
  stream.set(std::move(table));
  stream.set(pass_table(job.of.pass, job.of.before));
  std::vector<int> a, b;
  for (const auto& [from, to] : tile.model_rim) a.push_back(from), b.push_back(to);
  edges.set("a", std::move(a));
  edges.set("b", std::move(b));
  stream.set(std::move(edges));
  stream.set(rim_table(std::move(tile.rim)));
  stream.set(column_table("tile_line", "kind", std::move(job.of.line_kind)));
  stream.set(column_table("tile_corner", "vertex", std::move(job.of.corners)));
  if (job.relaxed) return stream;
  Table vertex = point_table("ref_vertex", tile.slice), face = triangle_table("ref_face", tile.slice);
  for (Column& c : tile.slice.vertex.columns) vertex.columns.push_back(std::move(c));
  for (Column& c : tile.slice.face.columns) face.columns.push_back(std::move(c));
  if (!tile.corner.empty())
    vertex.set("corner", std::vector<std::uint8_t>(tile.corner.begin(), tile.corner.end()));
  face.set("row", std::move(tile.faces));
  stream.set(std::move(vertex));
  stream.set(std::move(face));
  stream.set(point_table("other_vertex", tile.others));
  stream.set(triangle_table("other_face", tile.others));
  return stream;
}

TileJob take_tile(Stream stream) {
  const Table &table = need_row(stream, "tile", writer), &pass = need_row(stream, "tile_pass", writer);
  TileJob job;
  job.number = table.get<int>("number")[0];
  job.of = {table.get<int>("of")[0],
            table.get<int>("vertices")[0],
            stream.need("tile_line", writer).get<int>("kind"),
            stream.need("tile_corner", writer).get<int>("vertex"),
            pass_from(pass),
            counts_from(pass)};
  job.relaxed = table.has("tries");
  Tile& tile = job.tile;
  const int lines = static_cast<int>(job.of.line_kind.size());
  const int faces =
      job.relaxed ? std::numeric_limits<int>::max() : static_cast<int>(stream.need("ref_face", writer).rows);
  static_cast<TiledMesh&>(tile) = tiled_from(stream.surface, faces, lines);
  tile.rim = rim_from(stream.need("tile_rim", writer), job.of, tile, job.relaxed);
  const Table& edges = stream.need("tile_edge", writer);
  const auto &a = edges.get<int>("a"), &b = edges.get<int>("b");
  for (std::size_t e = 0; e < edges.rows; ++e) tile.model_rim.push_back({a[e], b[e]});
  std::sort(tile.model_rim.begin(), tile.model_rim.end());
  if (job.relaxed) {
    tile.counts = counts_from(table);
    return job;
  }
  const Table &vertex = stream.need("ref_vertex", writer), &face = stream.need("ref_face", writer);
  static_cast<Mesh&>(tile.slice) = mesh_from(vertex, face);
  if (vertex.has("size")) tile.slice.vertex.set("size", vertex.get<double>("size"));
  if (face.has("model")) tile.slice.face.set("model", face.get<std::uint8_t>("model"));
  if (face.has("origin")) tile.slice.face.set("origin", face.get<int>("origin"));
  tile.faces = face.get<int>("row");
  if (vertex.has("corner"))
    for (std::uint8_t c : vertex.get<std::uint8_t>("corner")) tile.corner.push_back(c != 0);
  tile.others = mesh_from(stream.need("other_vertex", writer), stream.need("other_face", writer));
  return job;
}

JoinedTiles join_tiles(const Stream& whole, int faces, const Provenance& by,
                       const std::vector<std::string>& names, const ReadShard& read) {
  JoinedTiles joined;
  std::vector<int> number;
  std::map<int, const std::string*> from;
  std::map<int, Tile> waiting;  // for those before them
  int next = 0;
  auto take = [&](const std::string& name, Stream stream) {
    if (!is_tile(stream)) throw BadInput("it has no tiles");
    const std::vector<Provenance> made = std::move(stream.history);
    TileJob job = take_tile(std::move(stream));
    if (!job.relaxed) throw BadInput("its tiles are not relaxed yet");
    expect_made_of(whole, made, by);
    if (from.empty()) joined.of = job.of, joined.counts = job.of.before;
    if (!same(job.of, joined.of)) throw BadInput("its tiles are those of another mesh or pass");
    const std::string tile = "tile " + std::to_string(job.number);
    if (job.number < 0 || job.number >= job.of.count)
      throw BadInput("it has " + tile + ", but there are " + std::to_string(job.of.count));
    if (const auto [other, added] = from.emplace(job.number, &name); !added)
      throw BadInput(tile + " is in " + *other->second + ", too");
    for (const std::vector<Place>* places : {&job.tile.mesh.place, &job.tile.rim.mesh.place})
      for (const Place& p : *places)
        if (p.face >= faces)
          throw BadInput(tile + " has a vertex on ref_face " + std::to_string(p.face) + ", but there are " +
                         std::to_string(faces));
    if (next == 0 && waiting.empty()) {
      // tiles have almost the same number of triangles; a damaged one does not ask for more than most
      constexpr double spare = 1.1, most = 1 << 26;
      const auto rows = [&](std::size_t n) {
        return static_cast<std::size_t>(std::min(most, spare * job.of.count * static_cast<double>(n)));
      };
      reserve(joined.mesh, rows(job.tile.mesh.points.size()), rows(job.tile.mesh.tris.size()));
    }
    waiting.emplace(job.number, std::move(job.tile));
    for (; waiting.contains(next); waiting.erase(next++)) {
      append_tile(joined.mesh, waiting[next], number, joined.seams);
      add(joined.counts, waiting[next].counts);
    }
  };
  for (const std::string& name : names)
    read(name, [&](Stream stream) { of_shard(name, [&] { take(name, std::move(stream)); }); });
  if (next < joined.of.count)
    throw BadInput("tile " + std::to_string(next) + " of " + std::to_string(joined.of.count) +
                   " is in no shard");
  return joined;
}

}  // namespace meshpipe
