// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "formats/formats.h"
#include "formats/stream/lift_tables.h"
#include "formats/stream/line_tables.h"
#include "formats/stream/plane_tables.h"
#include "formats/stream/second_order.h"
#include "formats/stream/stages.h"
#include "lib/core/error.h"

using namespace meshpipe;

namespace {

//  3---2    one part, its border a line from 0 around to 0 in three segments
//  |  /|
//  | / |
//  |/  |
//  0---1
Stream square_with_lines() {
  Stream stream;
  Surface& s = stream.surface;
  s.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  s.tris = {{0, 1, 2}, {0, 2, 3}};
  s.vertex.set("size", std::vector<double>(4, 1));
  s.face.set("part", std::vector<int>(2, 0));
  Table part{"part", 0, {}};
  part.set("faces", std::vector<int>{2});
  stream.set(std::move(part));
  Lines lines;
  lines.lines = {{border_line, 0, 0, 3, 1}};
  lines.uses = {{0, 0}};
  lines.points = {{0, 0, 0}, {1, 2, 0.5}, {2, 3, 0.75}};
  write_lines(stream, lines);
  return stream;
}

template <class T>
Stream with(const char* table, const char* column, T value) {
  Stream stream = square_with_lines();
  Table changed = *stream.find(table);
  changed.get<T>(column)[0] = value;
  stream.set(std::move(changed));
  return stream;
}

}  // namespace

TEST(LineTables, ReadWhatTheyWrote) {
  const Stream stream = read_stream(write_stream(square_with_lines(), false), "test");
  const Lines lines = read_lines(stream);
  ASSERT_EQ(lines.lines.size(), 1u);
  EXPECT_EQ(lines.lines[0].closed, 1);
  EXPECT_EQ(lines.uses[0].part, 0);
  ASSERT_EQ(lines.points.size(), 3u);
  EXPECT_EQ(lines.points[2].b, 3);
  EXPECT_EQ(lines.points[2].t, 0.75);
}

TEST(LineTables, RefuseWhatCannotBe) {
  EXPECT_THROW(read_lines(with("line", "kind", 3)), BadInput);
  EXPECT_THROW(read_lines(with("line", "closed", 2)), BadInput);
  EXPECT_THROW(read_lines(with("line", "first", 1)), BadInput);
  EXPECT_THROW(read_lines(with("line", "count", 2)), BadInput);
  EXPECT_THROW(read_lines(with("line", "count", 4)), BadInput);
  EXPECT_THROW(read_lines(with("line", "count", 2147483647)), BadInput);
  EXPECT_THROW(read_lines(with("line_use", "line", 1)), BadInput);
  EXPECT_THROW(read_lines(with("line_use", "part", 1)), BadInput);
  EXPECT_THROW(read_lines(with("line_vertex", "vertex_a", 4)), BadInput);
  EXPECT_THROW(read_lines(with("line_vertex", "vertex_b", -1)), BadInput);
  EXPECT_THROW(read_lines(with("line_vertex", "t", 1.5)), BadInput);
  Stream none = square_with_lines();
  none.erase("line");
  EXPECT_THROW(read_lines(none), NotAdmissible);
}

TEST(PlaneTables, ReadWhatTheyWrote) {
  Stream stream = square_with_lines();
  std::vector<Chart> charts(1);
  charts[0].mesh.face = {0, 1};
  std::vector<PlaneMesh> meshes(1);
  meshes[0].points = {
      {{0, 0}, 0, {}}, {{1, 0.5}, 1, {}}, {{0.25, 1}, 2, {}}, {{0.5, 0.5}, -1, {1, 0.5, 0.25, 0.25}}};
  meshes[0].tris = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  write_plane_meshes(stream, charts, meshes);
  const auto back = read_plane_meshes(read_stream(write_stream(stream, false), "test"), charts);
  ASSERT_EQ(back.size(), 1u);
  EXPECT_EQ(back[0].tris, meshes[0].tris);
  EXPECT_EQ(back[0].points[2].line_point, 2);
  EXPECT_EQ(back[0].points[3].place.face, 1);
  EXPECT_EQ(back[0].points[3].place.b0, 0.5);

  Table face = *stream.find("chart_face");
  face.get<int>("b")[1] = 4;
  Stream bad = stream;
  bad.set(face);
  EXPECT_THROW(read_plane_meshes(bad, charts), BadInput);
  Table point = *stream.find("chart_point");
  point.get<int>("face")[3] = 7;
  bad = stream;
  bad.set(point);
  EXPECT_THROW(read_plane_meshes(bad, charts), BadInput);
}

TEST(LiftTables, FineSurfaceIsWholeOrRefused) {
  Stream stream = square_with_lines();
  const Surface input = stream.surface;
  EXPECT_FALSE(take_fine(stream));
  write_fine(stream, input);
  Stream copy = read_stream(write_stream(stream, false), "test");
  const std::optional<Surface> back = take_fine(copy);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->points, input.points);
  EXPECT_EQ(back->tris, input.tris);
  EXPECT_FALSE(take_fine(copy));

  for (const char* table : {"fine_vertex", "fine_face"}) {
    Stream damaged = stream;
    damaged.erase(table);
    EXPECT_THROW(take_fine(damaged), NotAdmissible);
  }
  Stream empty = stream;
  write_fine(empty, Surface{});
  EXPECT_THROW(take_fine(empty), BadInput);
  Stream wrong = stream;
  for (Table& t : wrong.tables)
    if (t.name == "fine_face") t.get<int>("b")[0] = (int)input.points.size();
  EXPECT_THROW(read_stream(write_stream(wrong, false), "test"), BadInput);
  write_reference(stream, input);  // what is lifted belongs to this one
  EXPECT_FALSE(take_fine(stream));
}

TEST(LiftTables, ReadWhatTheyWrote) {
  Stream stream = square_with_lines();
  const Surface input = stream.surface;
  LiftedMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0.5, 0}, {0.25, 1, 0}};
  mesh.tris = {{0, 1, 2}};
  mesh.place = {{0, 1, 0, 0}, {0, 0, 0.5, 0.5}, {1, 0, 0.25, 0.75}};
  mesh.kind = {2, 1, 1};
  mesh.line = {0, 0, 0};
  mesh.size = {1, 1, 1};
  mesh.patch = {5};
  mesh.part = {0};
  mesh.model = {0};
  write_reference(stream, input);
  write_lifted(stream, mesh);
  stream = read_stream(write_stream(stream, false), "test");
  Stream copy = stream;
  const LiftedMesh back = take_lifted(copy.surface, 2, 1);
  EXPECT_EQ(back.points, mesh.points);
  EXPECT_EQ(back.tris, mesh.tris);
  EXPECT_EQ(back.place[2].b2, 0.75);
  EXPECT_EQ(back.kind, mesh.kind);
  EXPECT_EQ(back.patch, mesh.patch);
  const Surface reference = read_reference(stream);
  EXPECT_EQ(reference.points, input.points);
  EXPECT_EQ(reference.tris, input.tris);
  EXPECT_EQ(reference.face.get<int>("origin"), (std::vector<int>{0, 1}));
  EXPECT_EQ(read_lines(stream).points.size(), 3u);  // they index the reference now

  stream.surface.vertex.get<double>("b1")[1] = 0.75;
  EXPECT_THROW(take_lifted(stream.surface, 2, 1), BadInput);
}

namespace {

std::string tables_after(Stage remade, bool lifted, bool of_a_file = false) {
  Stream stream = square_with_lines();
  if (of_a_file) stream.erase("line_use");
  for (const char* name : {"chart_vertex", "chart_point", "chart_face", "own"})
    stream.set(Table{name, 0, {}});
  if (lifted) {
    stream.set(Table{"ref_vertex", 0, {}});
    stream.surface.vertex.set("line", std::vector<int>(4, 0));
  }
  drop_downstream(stream, remade);
  std::string names;
  for (const Table& t : stream.tables) names += t.name + ' ';
  return names + (stream.surface.vertex.has("line") ? "vertex.line" : "");
}

}  // namespace

TEST(Stages, DropWhatNoLongerHolds) {
  EXPECT_EQ(tables_after(Stage::parts, false), "part own ");
  EXPECT_EQ(tables_after(Stage::charts, false), "part chart_vertex own ");
  EXPECT_EQ(tables_after(Stage::sizes, false), "part chart_vertex own ");
  EXPECT_EQ(tables_after(Stage::features, false), "part chart_vertex own ");
  EXPECT_EQ(tables_after(Stage::lines, false), "part line line_use line_vertex chart_vertex own ");
  EXPECT_EQ(tables_after(Stage::sizes, false, true), "part line line_vertex chart_vertex own ");
  EXPECT_EQ(tables_after(Stage::parts, true), "part own ");
  EXPECT_EQ(tables_after(Stage::sizes, true),
            "part line line_use line_vertex chart_vertex chart_point chart_face own ref_vertex vertex.line");
}

TEST(Losses, NodesWithinEdges) {
  Stream stream = square_with_lines();
  stream.erase("line");
  write_mid_points(stream, {{0, 1, {0.5, 0, 0}}, {0, 2, {0.5, 0.5, 0}}});
  for (const char* path : {"a.stl", "a.off", "a.obj", "a.vtk", "a.mesh", "a.ply"})
    EXPECT_NE(lost_in(stream, path, true).find("2 nodes within edges (second order)"), std::string::npos)
        << path;
  for (const char* path : {"a.msh", "a.msh2", "a.msh4", "a.vtu", "a.mply"})
    EXPECT_EQ(lost_in(stream, path, true).find("nodes"), std::string::npos) << path;
}
