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

/// The columns of vertices that only tiles have. Places need all three weights: 1 - b1 - b2 rounds.
void set_tiled(Surface& s, const TiledMesh& mesh) {
  std::vector<double> b0;
  for (const Place& p : mesh.mesh.place) b0.push_back(p.b0);
  s.vertex.set("b0", std::move(b0));
  s.vertex.set("hold", std::vector<std::uint8_t>(mesh.hold.begin(), mesh.hold.end()));
  s.vertex.set("refinement", mesh.refinement);
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

/// All tiles of a shard as one, their rows one tile after the other.
struct Joined {
  TiledMesh all;
  std::vector<int> vertices, excess, faces;
  std::vector<char> corner;
  Mesh others;
  Surface slice;
  std::vector<int> rim[2];
};

void append_tile(Joined& j, const Tile& tile) {
  LiftedMesh& to = j.all.mesh;
  const LiftedMesh& from = tile.mesh;
  append_tris(to.tris, from.tris, to.points.size());
  append(to.points, from.points), append(to.kind, from.kind), append(to.line, from.line);
  append(to.size, from.size), append(to.patch, from.patch), append(to.part, from.part);
  append(to.model, from.model);
  const int first_face = static_cast<int>(j.slice.tris.size());
  for (Place p : from.place) p.face += first_face, to.place.push_back(p);
  append(j.all.hold, tile.hold), append(j.all.refinement, tile.refinement);
  append(j.vertices, tile.vertices), append(j.excess, tile.excess), append(j.faces, tile.faces);
  append(j.corner, tile.corner);
  append_tris(j.others.tris, tile.others.tris, j.others.points.size());
  append(j.others.points, tile.others.points);
  for (const auto& [a, b] : tile.model_rim) j.rim[0].push_back(a), j.rim[1].push_back(b);
  Surface& s = j.slice;
  append_tris(s.tris, tile.slice.tris, s.points.size());
  append(s.points, tile.slice.points);
  auto column = [&]<class T>(Table& table, const Table& more, const char* name, T) {
    if (!more.has(name)) return;
    if (!table.has(name)) table.set(name, std::vector<T>());
    append(table.get<T>(name), more.get<T>(name));
    table.rows = table.get<T>(name).size();
  };
  column(s.vertex, tile.slice.vertex, "size", 0.0);
  column(s.face, tile.slice.face, "model", std::uint8_t());
}

}  // namespace

void write_tiles(Stream& stream, const TileShard& shard) {
  stream.tables.clear();
  Joined j;
  Table table{"tile", 0, {}};
  table.set("number", shard.numbers);
  auto count = [&](const char* name, auto of) {
    std::vector<int> counts;
    for (const Tile& tile : shard.tiles) counts.push_back(static_cast<int>(of(tile)));
    table.set(name, std::move(counts));
  };
  count("vertices", [](const Tile& t) { return t.mesh.points.size(); });
  count("faces", [](const Tile& t) { return t.mesh.tris.size(); });
  count("edges", [](const Tile& t) { return t.model_rim.size(); });
  if (shard.relaxed) {
    for (const auto& [name, member] : count_columns)
      count(name, [m = member](const Tile& t) { return t.counts.*m; });
  } else {
    count("ref_vertices", [](const Tile& t) { return t.slice.points.size(); });
    count("ref_faces", [](const Tile& t) { return t.slice.tris.size(); });
    count("other_vertices", [](const Tile& t) { return t.others.points.size(); });
    count("other_faces", [](const Tile& t) { return t.others.tris.size(); });
  }
  for (const Tile& tile : shard.tiles) append_tile(j, tile);
  stream.surface = surface_from(j.all.mesh);
  set_tiled(stream.surface, j.all);
  stream.surface.vertex.set("row", std::move(j.vertices));
  stream.set(std::move(table));
  stream.set(pass_table(shard.pass));
  Table edges{"tile_edge", 0, {}};
  edges.set("a", std::move(j.rim[0]));
  edges.set("b", std::move(j.rim[1]));
  stream.set(std::move(edges));
  Table lines{"tile_line", 0, {}};
  lines.set("kind", shard.line_kind);
  stream.set(std::move(lines));
  if (shard.relaxed) return;
  stream.surface.vertex.set("excess", std::move(j.excess));
  write_reference(stream, j.slice);
  Table vertex = stream.need("ref_vertex", writer), face = stream.need("ref_face", writer);
  if (!j.corner.empty()) vertex.set("corner", std::vector<std::uint8_t>(j.corner.begin(), j.corner.end()));
  face.set("row", std::move(j.faces));
  stream.set(std::move(vertex));
  stream.set(std::move(face));
  stream.set(table_of("other_vertex", j.others, true));
  stream.set(table_of("other_face", j.others, false));
}

namespace {

/// Gives the tiles what only those have that are not relaxed yet.
void read_slices(const Stream& stream, const Table& table, TileShard& shard) {
  const Surface reference = read_reference(stream);
  const Table &vertex = stream.need("ref_vertex", writer), &face = stream.need("ref_face", writer);
  const Table &other_vertex = stream.need("other_vertex", writer),
              &other_face = stream.need("other_face", writer);
  const Mesh others = mesh_from(other_vertex, other_face);
  const auto points = spans_of(table, "ref_vertices", vertex.rows),
             tris = spans_of(table, "ref_faces", face.rows),
             other_points = spans_of(table, "other_vertices", other_vertex.rows),
             other_tris = spans_of(table, "other_faces", other_face.rows),
             vertices = spans_of(table, "vertices", stream.surface.points.size());
  for (std::size_t i = 0; i < shard.tiles.size(); ++i) {
    Tile& tile = shard.tiles[i];
    Surface& s = tile.slice;
    s.points = points[i].of(reference.points);
    s.tris = tris_of(reference.tris, tris[i], points[i]);
    if (reference.vertex.has("size"))
      s.vertex.set("size", points[i].of(reference.vertex.get<double>("size")));
    s.face.set("model", tris[i].of(reference.face.get<std::uint8_t>("model")));
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

TileShard read_tiles(const Stream& stream) {
  const Table &table = stream.need("tile", writer), &edges = stream.need("tile_edge", writer);
  TileShard shard;
  shard.numbers = table.get<int>("number");
  shard.line_kind = stream.need("tile_line", writer).get<int>("kind");
  shard.pass = pass_from(stream);
  shard.relaxed = table.has("tries");
  const Surface& s = stream.surface;
  const TiledMesh all =
      tiled_from(s, lifted_from(s,
                                shard.relaxed ? std::numeric_limits<int>::max()
                                              : static_cast<int>(stream.need("ref_face", writer).rows),
                                static_cast<int>(shard.line_kind.size())));
  const auto vertices = spans_of(table, "vertices", s.points.size()),
             faces = spans_of(table, "faces", s.tris.size()), rim = spans_of(table, "edges", edges.rows);
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
      const Stream stream = read(name);
      TileShard shard = read_tiles(stream);
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

void write_tiled(Stream& stream, const TiledMesh& mesh, const BetweenPasses& between) {
  write_lifted(stream, mesh.mesh);
  set_tiled(stream.surface, mesh);
  Table table{"relaxing", 0, {}};
  for (const auto& [name, member] : count_columns) table.set(name, std::vector<int>{between.counts.*member});
  table.set("second_order", std::vector<int>{between.second_order});
  stream.set(std::move(table));
}

TiledMesh read_tiled(const Stream& stream, BetweenPasses& between) {
  const Table& table = stream.need("relaxing", "mrelax --join");
  if (table.rows != 1) throw BadInput("table 'relaxing' has " + std::to_string(table.rows) + " rows, not 1");
  for (const auto& [name, member] : count_columns) between.counts.*member = table.get<int>(name)[0];
  between.second_order = table.get<int>("second_order")[0] != 0;
  return tiled_from(stream.surface, read_lifted(stream));
}

}  // namespace meshpipe
