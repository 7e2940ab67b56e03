// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream/tile_tables.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "formats/stream/lift_tables.h"
#include "formats/stream/spans.h"
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
  const Table& table = stream.need("tile_pass", writer);
  if (table.rows != 1) throw BadInput("table 'tile_pass' has " + std::to_string(table.rows) + " rows, not 1");
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

/// Columns of table `tile`: the rows of each in the other tables, in this order.
constexpr const char* sizes[] = {"vertices",  "faces",          "edges",      "ref_vertices",
                                 "ref_faces", "other_vertices", "other_faces"};
constexpr std::size_t sizes_of_relaxed = 3;

}  // namespace

void TileTables::add(int number, const Tile& tile) {
  const LiftedMesh& from = tile.mesh;
  const Surface& slice = tile.slice;
  auto count = [](const auto& list) { return static_cast<int>(list.size()); };
  numbers_.push_back(number);
  rows_.push_back({count(from.points), count(from.tris), count(tile.model_rim), count(slice.points),
                   count(slice.tris), count(tile.others.points), count(tile.others.tris)});
  counts_.push_back(tile.counts);
  LiftedMesh& to = all_.mesh;
  append_tris(to.tris, from.tris, to.points.size());
  append(to.points, from.points), append(to.kind, from.kind), append(to.line, from.line);
  append(to.size, from.size), append(to.patch, from.patch), append(to.part, from.part);
  append(to.model, from.model);
  const int first_face = count(slice_.tris);
  for (Place p : from.place) p.face += first_face, to.place.push_back(p);
  append(all_.hold, tile.hold), append(all_.refinement, tile.refinement);
  append(vertices_, tile.vertices), append(excess_, tile.excess), append(faces_, tile.faces);
  append(corner_, tile.corner);
  append_tris(others_.tris, tile.others.tris, others_.points.size());
  append(others_.points, tile.others.points);
  for (const auto& [a, b] : tile.model_rim) rim_[0].push_back(a), rim_[1].push_back(b);
  append_tris(slice_.tris, slice.tris, slice_.points.size());
  append(slice_.points, slice.points);
  auto column = [&]<class T>(Table& table, const Table& more, const char* name, T) {
    if (!more.has(name)) return;
    if (!table.has(name)) table.set(name, std::vector<T>());
    append(table.get<T>(name), more.get<T>(name));
    table.rows = table.get<T>(name).size();
  };
  column(slice_.vertex, slice.vertex, "size", 0.0);
  column(slice_.face, slice.face, "model", std::uint8_t());
}

void TileTables::write(Stream& stream, const TileWork& work) {
  stream.tables.clear();
  Table table{"tile", 0, {}};
  table.set("number", std::move(numbers_));
  auto column = [&](const char* name, const auto& list, auto of) {
    std::vector<int> values;
    for (const auto& x : list) values.push_back(of(x));
    table.set(name, std::move(values));
  };
  for (std::size_t i = 0; i < (work.relaxed ? sizes_of_relaxed : std::size(sizes)); ++i)
    column(sizes[i], rows_, [i](const auto& rows) { return rows[i]; });
  if (work.relaxed)
    for (const auto& [name, member] : count_columns)
      column(name, counts_, [m = member](const RelaxCounts& c) { return c.*m; });
  std::vector<double> b0 = first_weights(all_.mesh.place);
  stream.surface = surface_from(std::move(all_.mesh));
  set_tiled(stream.surface, std::move(b0), all_.hold, std::move(all_.refinement));
  stream.surface.vertex.set("row", std::move(vertices_));
  stream.set(std::move(table));
  stream.set(pass_table(work.pass));
  Table edges{"tile_edge", 0, {}};
  edges.set("a", std::move(rim_[0]));
  edges.set("b", std::move(rim_[1]));
  stream.set(std::move(edges));
  Table lines{"tile_line", 0, {}};
  lines.set("kind", work.line_kind);
  stream.set(std::move(lines));
  if (!work.relaxed) {
    stream.surface.vertex.set("excess", std::move(excess_));
    Table vertex = table_of("ref_vertex", slice_, true), face = table_of("ref_face", slice_, false);
    for (Column& c : slice_.vertex.columns) vertex.columns.push_back(std::move(c));
    for (Column& c : slice_.face.columns) face.columns.push_back(std::move(c));
    if (!corner_.empty()) vertex.set("corner", std::vector<std::uint8_t>(corner_.begin(), corner_.end()));
    face.set("row", std::move(faces_));
    stream.set(std::move(vertex));
    stream.set(std::move(face));
    stream.set(table_of("other_vertex", others_, true));
    stream.set(table_of("other_face", others_, false));
  }
  *this = {};
}

namespace {

/// Gives the tiles what only those have that are not relaxed yet.
void read_slices(const Stream& stream, const Table& table, TileShard& shard) {
  const Table &vertex = stream.need("ref_vertex", writer), &face = stream.need("ref_face", writer);
  const Table &other_vertex = stream.need("other_vertex", writer),
              &other_face = stream.need("other_face", writer);
  const Mesh reference = mesh_from(vertex, face), others = mesh_from(other_vertex, other_face);
  const auto points = spans_of(table, "ref_vertices", vertex.rows),
             tris = spans_of(table, "ref_faces", face.rows),
             other_points = spans_of(table, "other_vertices", other_vertex.rows),
             other_tris = spans_of(table, "other_faces", other_face.rows),
             vertices = spans_of(table, "vertices", stream.surface.vertex.rows);
  for (std::size_t i = 0; i < shard.tiles.size(); ++i) {
    Tile& tile = shard.tiles[i];
    Surface& s = tile.slice;
    s.points = points[i].of(reference.points);
    s.tris = tris_of(reference.tris, tris[i], points[i]);
    if (vertex.has("size")) s.vertex.set("size", points[i].of(vertex.get<double>("size")));
    if (face.has("model")) s.face.set("model", tris[i].of(face.get<std::uint8_t>("model")));
    tile.faces = tris[i].of(face.get<int>("row"));
    if (vertex.has("corner"))
      for (std::uint8_t c : points[i].of(vertex.get<std::uint8_t>("corner"))) tile.corner.push_back(c != 0);
    tile.others.points = other_points[i].of(others.points);
    tile.others.tris = tris_of(others.tris, other_tris[i], other_points[i]);
    tile.excess = vertices[i].of(stream.surface.vertex.get<int>("excess"));
    for (Place& p : tile.mesh.place) {
      if (p.face < tris[i].first || p.face >= tris[i].last)
        throw BadInput("tile " + std::to_string(shard.numbers[i]) + " has a vertex on ref_face " +
                       std::to_string(p.face) + " of another tile");
      p.face -= tris[i].first;
    }
  }
}

}  // namespace

TileShard take_tiles(Stream& stream) {
  const Table &table = stream.need("tile", writer), &edges = stream.need("tile_edge", writer);
  TileShard shard;
  shard.numbers = table.get<int>("number");
  shard.line_kind = stream.need("tile_line", writer).get<int>("kind");
  shard.pass = pass_from(stream);
  shard.relaxed = table.has("tries");
  Surface& s = stream.surface;
  const TiledMesh all =
      tiled_from(s, take_lifted(s,
                                shard.relaxed ? std::numeric_limits<int>::max()
                                              : static_cast<int>(stream.need("ref_face", writer).rows),
                                static_cast<int>(shard.line_kind.size())));
  const auto vertices = spans_of(table, "vertices", all.mesh.points.size()),
             faces = spans_of(table, "faces", all.mesh.tris.size()),
             rim = spans_of(table, "edges", edges.rows);
  for (std::size_t i = 0; i < table.rows; ++i) {
    Tile& tile = shard.tiles.emplace_back();
    const Span &v = vertices[i], &f = faces[i];
    LiftedMesh& m = tile.mesh;
    m.points = v.of(all.mesh.points), m.place = v.of(all.mesh.place), m.kind = v.of(all.mesh.kind);
    m.line = v.of(all.mesh.line), m.size = v.of(all.mesh.size), m.patch = f.of(all.mesh.patch);
    m.part = f.of(all.mesh.part), m.model = f.of(all.mesh.model), m.tris = tris_of(all.mesh.tris, f, v);
    tile.hold = v.of(all.hold), tile.refinement = v.of(all.refinement);
    tile.vertices = v.of(s.vertex.get<int>("row"));
    for (int e = rim[i].first; e < rim[i].last; ++e)
      tile.model_rim.push_back({edges.get<int>("a")[e], edges.get<int>("b")[e]});
    std::sort(tile.model_rim.begin(), tile.model_rim.end());
    if (shard.relaxed)
      for (const auto& [name, member] : count_columns) tile.counts.*member = table.get<int>(name)[i];
  }
  if (!shard.relaxed) read_slices(stream, table, shard);
  return shard;
}

namespace {

/// Throws: BadInput if a relaxed tile does not fit into the mesh.
void expect_fits(const Tile& tile, int number, const TiledMesh& whole, int reference_faces) {
  const std::string name = "tile " + std::to_string(number);
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
                             const std::function<Stream(const std::string&)>& read) {
  std::vector<Tile> all(tiles);
  std::vector<const std::string*> from(tiles, nullptr);
  for (const std::string& name : names) try {
      Stream stream = read(name);
      TileShard shard = take_tiles(stream);
      if (!shard.relaxed) throw BadInput("its tiles are not relaxed yet");
      const Provenance made = stream.history.empty() ? Provenance{} : stream.history.back();
      if (made.program != by.program || made.arguments != by.arguments)
        throw BadInput("it was made with options '" + made.arguments + "', not '" + by.arguments + "'");
      if (!same(shard.pass, pass)) throw BadInput("its tiles are those of another mesh or pass");
      for (std::size_t i = 0; i < shard.tiles.size(); ++i) {
        const int number = shard.numbers[i];
        if (number < 0 || number >= tiles)
          throw BadInput("it has tile " + std::to_string(number) + ", but there are " +
                         std::to_string(tiles));
        if (from[number])
          throw BadInput("tile " + std::to_string(number) + " is in " + *from[number] + ", too");
        expect_fits(shard.tiles[i], number, whole, reference_faces);
        from[number] = &name;
        all[number] = std::move(shard.tiles[i]);
      }
    } catch (const BadInput& e) {
      throw BadInput(name + ": " + e.what());
    } catch (const NotAdmissible& e) {
      throw BadInput(name + ": " + e.what());
    }
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
  const Table& table = stream.need("relaxing", "mrelax --join");
  if (table.rows != 1) throw BadInput("table 'relaxing' has " + std::to_string(table.rows) + " rows, not 1");
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
