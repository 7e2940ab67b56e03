// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream/tile_tables.h"

#include <algorithm>
#include <limits>

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

Table pass_table(const TilePass& pass) {
  Table table{"tile_pass", 0, {}};
  table.set("sweeps", std::vector<int>{pass.sweeps});
  table.set("keep_border", std::vector<int>{pass.keep_border});
  table.set("repair", std::vector<int>{pass.repair});
  table.set("to_count", std::vector<int>{pass.to_count});
  table.set("goal", std::vector<double>{pass.goal});
  table.set("sample_size", std::vector<double>{pass.sample_size});
  table.set("mean_size", std::vector<double>{pass.mean_size});
  return table;
}

TilePass pass_from(const Stream& stream) {
  const Table& table = need_row(stream, "tile_pass", writer);
  auto number = [&](const char* name) { return table.get<int>(name)[0]; };
  auto length = [&](const char* name) {
    const double x = table.get<double>(name)[0];
    if (!(x > 0)) throw BadInput(std::string("tile_pass: ") + name + " is not positive");
    return x;
  };
  TilePass pass{number("sweeps"), number("keep_border") != 0, number("repair") != 0, number("to_count") != 0};
  pass.goal = length("goal"), pass.sample_size = length("sample_size"), pass.mean_size = length("mean_size");
  return pass;
}

bool same(const TilePass& a, const TilePass& b) {
  return a.sweeps == b.sweeps && a.keep_border == b.keep_border && a.repair == b.repair &&
         a.to_count == b.to_count && a.goal == b.goal && a.sample_size == b.sample_size &&
         a.mean_size == b.mean_size;
}

std::vector<double> first_weights(const std::vector<Place>& places) {
  std::vector<double> b0;
  for (const Place& p : places) b0.push_back(p.b0);
  return b0;
}

/// The columns of vertices that only tiles have. Places need all three weights: 1 - b1 - b2 rounds.
void set_tiled(Surface& s, std::vector<double> b0, const std::vector<Hold>& hold,
               std::vector<double> refinement) {
  s.vertex.set("b0", std::move(b0));
  s.vertex.set("hold", std::vector<std::uint8_t>(hold.begin(), hold.end()));
  s.vertex.set("refinement", std::move(refinement));
}

TiledMesh tiled_from(const Surface& s, LiftedMesh mesh) {
  const auto& hold = s.vertex.get<std::uint8_t>("hold");
  TiledMesh tiled{std::move(mesh), {}, s.vertex.get<double>("refinement")};
  s.vertex.get<double>("b0");
  for (std::size_t v = 0; v < hold.size(); ++v) {
    if (hold[v] > paired || !(tiled.refinement[v] > 0))
      throw BadInput("vertex " + std::to_string(v) + " has hold " + std::to_string(hold[v]) +
                     " and refinement " + std::to_string(tiled.refinement[v]) +
                     "; they are at most 5, and positive");
    tiled.hold.push_back(static_cast<Hold>(hold[v]));
  }
  return tiled;
}

}  // namespace

Stream stream_of(TileJob job) {
  Stream stream;
  Tile& tile = job.tile;
  Table table{"tile", 0, {}}, edges{"tile_edge", 0, {}}, lines{"tile_line", 0, {}};
  table.set("number", std::vector<int>{job.number});
  if (job.relaxed)
    for (const auto& [name, member] : count_columns) table.set(name, std::vector<int>{tile.counts.*member});
  std::vector<double> b0 = first_weights(tile.mesh.place);
  stream.surface = surface_from(std::move(tile.mesh));
  set_tiled(stream.surface, std::move(b0), tile.hold, std::move(tile.refinement));
  stream.surface.vertex.set("row", std::move(tile.vertices));
  stream.set(std::move(table));
  stream.set(pass_table(job.pass));
  std::vector<int> a, b;
  for (const auto& [from, to] : tile.model_rim) a.push_back(from), b.push_back(to);
  edges.set("a", std::move(a));
  edges.set("b", std::move(b));
  stream.set(std::move(edges));
  lines.set("kind", std::move(job.line_kind));
  stream.set(std::move(lines));
  if (job.relaxed) return stream;
  stream.surface.vertex.set("excess", std::move(tile.excess));
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
  const Table &table = need_row(stream, "tile", writer), &edges = stream.need("tile_edge", writer);
  TileJob job;
  job.number = table.get<int>("number")[0];
  job.line_kind = stream.need("tile_line", writer).get<int>("kind");
  job.pass = pass_from(stream);
  job.relaxed = table.has("tries");
  Tile& tile = job.tile;
  Surface& s = stream.surface;
  const int faces =
      job.relaxed ? std::numeric_limits<int>::max() : static_cast<int>(stream.need("ref_face", writer).rows);
  static_cast<TiledMesh&>(tile) =
      tiled_from(s, take_lifted(s, faces, static_cast<int>(job.line_kind.size())));
  tile.vertices = std::move(s.vertex.get<int>("row"));
  const auto &a = edges.get<int>("a"), &b = edges.get<int>("b");
  for (std::size_t e = 0; e < edges.rows; ++e) tile.model_rim.push_back({a[e], b[e]});
  std::sort(tile.model_rim.begin(), tile.model_rim.end());
  if (job.relaxed) {
    for (const auto& [name, member] : count_columns) tile.counts.*member = table.get<int>(name)[0];
    return job;
  }
  const Table &vertex = stream.need("ref_vertex", writer), &face = stream.need("ref_face", writer);
  static_cast<Mesh&>(tile.slice) = mesh_from(vertex, face);
  if (vertex.has("size")) tile.slice.vertex.set("size", vertex.get<double>("size"));
  if (face.has("model")) tile.slice.face.set("model", face.get<std::uint8_t>("model"));
  tile.faces = face.get<int>("row");
  if (vertex.has("corner"))
    for (std::uint8_t c : vertex.get<std::uint8_t>("corner")) tile.corner.push_back(c != 0);
  tile.others = mesh_from(stream.need("other_vertex", writer), stream.need("other_face", writer));
  tile.excess = std::move(s.vertex.get<int>("excess"));
  return job;
}

namespace {

/// Throws: BadInput if a relaxed tile does not fit into the mesh.
void expect_fits(const Tile& tile, const std::string& name, const TiledMesh& whole, int reference_faces) {
  for (std::size_t v = 0; v < tile.vertices.size(); ++v) {
    const int row = tile.vertices[v];
    if (row < -1 || row >= static_cast<int>(whole.mesh.points.size()) ||
        (row >= 0 && norm(whole.mesh.points[row] - tile.mesh.points[v]) != 0))
      throw BadInput(name + ": its rim is not that of the mesh, at vertex " + std::to_string(row));
  }
  for (const Place& p : tile.mesh.place)
    if (p.face >= reference_faces)
      throw BadInput(name + " has a vertex on ref_face " + std::to_string(p.face) + ", but there are " +
                     std::to_string(reference_faces));
}

}  // namespace

std::vector<Tile> join_tiles(const TiledMesh& whole, int reference_faces, int tiles, const TilePass& pass,
                             const Provenance& by, const std::vector<std::string>& names,
                             const ReadShard& read) {
  std::vector<Tile> all(tiles);
  std::vector<const std::string*> from(tiles, nullptr);
  auto take = [&](const std::string& name, Stream stream) {
    const Provenance made = stream.history.empty() ? Provenance{} : stream.history.back();
    TileJob job = take_tile(std::move(stream));
    if (!job.relaxed) throw BadInput("its tiles are not relaxed yet");
    if (made.program != by.program || made.arguments != by.arguments)
      throw BadInput("it was made with options '" + made.arguments + "', not '" + by.arguments + "'");
    if (!same(job.pass, pass)) throw BadInput("its tiles are those of another mesh or pass");
    const std::string tile = "tile " + std::to_string(job.number);
    if (job.number < 0 || job.number >= tiles)
      throw BadInput("it has " + tile + ", but there are " + std::to_string(tiles));
    if (from[job.number]) throw BadInput(tile + " is in " + *from[job.number] + ", too");
    expect_fits(job.tile, tile, whole, reference_faces);
    from[job.number] = &name;
    all[job.number] = std::move(job.tile);
  };
  for (const std::string& name : names)
    read(name, [&](Stream stream) { of_shard(name, [&] { take(name, std::move(stream)); }); });
  for (int i = 0; i < tiles; ++i)
    if (!from[i])
      throw BadInput("tile " + std::to_string(i) + " of " + std::to_string(tiles) + " is in no shard");
  return all;
}

void write_tiled(Stream& stream, const TiledMesh& mesh, const std::vector<char>& corner,
                 const BetweenPasses& between) {
  write_lifted(stream, mesh.mesh);
  set_tiled(stream.surface, first_weights(mesh.mesh.place), mesh.hold, mesh.refinement);
  Table table{"relaxing", 0, {}}, corners{"relaxing_corner", 0, {}};
  for (const auto& [name, member] : count_columns) table.set(name, std::vector<int>{between.counts.*member});
  table.set("second_order", std::vector<int>{between.second_order});
  stream.set(std::move(table));
  std::vector<int> vertices;
  for (std::size_t v = 0; v < corner.size(); ++v)
    if (corner[v]) vertices.push_back(static_cast<int>(v));
  corners.set("vertex", std::move(vertices));
  stream.set(std::move(corners));
}

TiledMesh take_tiled(Stream& stream, LiftedMesh mesh, BetweenPasses& between) {
  const Table& table = need_row(stream, "relaxing", "mrelax --join");
  for (const auto& [name, member] : count_columns) between.counts.*member = table.get<int>(name)[0];
  between.second_order = table.get<int>("second_order")[0] != 0;
  stream.erase("relaxing"), stream.erase("relaxing_corner");
  return tiled_from(stream.surface, std::move(mesh));
}

std::vector<char> read_corners(const Stream& stream) {
  const std::size_t n = stream.need("ref_vertex", "mlift").rows;
  std::vector<char> corner(n);
  for (int v : stream.need("relaxing_corner", "mrelax --join").get<int>("vertex")) {
    if (v < 0 || v >= static_cast<int>(n))
      throw BadInput("relaxing_corner names vertex " + std::to_string(v) + ", but there are " +
                     std::to_string(n));
    corner[v] = 1;
  }
  return corner;
}

}  // namespace meshpipe
