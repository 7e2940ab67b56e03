// SPDX-License-Identifier: BSD-3-Clause
#include "lib/lift/lift.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lib/core/error.h"
#include "lib/core/topology.h"

using namespace meshpipe;

namespace {

/// Charts of a surface in the plane: x and y, mirrored for the parts that are
/// seen from below.
std::vector<Chart> flat_charts(const Surface& s, int n_parts) {
  std::vector<Chart> charts;
  for (SubMesh& m : split_by_label(s, s.face.get<int>("part"), n_parts)) {
    const Vec3 n = area_vector(m.points[m.tris[0][0]], m.points[m.tris[0][1]], m.points[m.tris[0][2]]);
    std::vector<Vec2> uv;
    for (Vec3 p : m.points) uv.push_back({n.z > 0 ? p.x : -p.x, p.y});
    Chart c;
    c.opposite = opposite_halfedges(m.tris, static_cast<int>(m.points.size()));
    c.mesh = std::move(m);
    c.uv = std::move(uv);
    charts.push_back(std::move(c));
  }
  return charts;
}

/// Each chart's own triangles as its plane mesh; every line point must be a
/// vertex.
std::vector<PlaneMesh> own_triangles(const std::vector<Chart>& charts, const Lines& lines) {
  std::vector<PlaneMesh> meshes;
  for (int p = 0; p < (int)charts.size(); ++p) {
    const Chart& c = charts[p];
    PlaneMesh m;
    for (Vec2 uv : c.uv) m.points.push_back({uv, -1, {}});
    for (int t = 0; t < (int)c.mesh.tris.size(); ++t)
      for (int i = 0; i < 3; ++i)
        m.points[c.mesh.tris[t][i]].place = {t, i == 0 ? 1. : 0., i == 1 ? 1. : 0., i == 2 ? 1. : 0.};
    for (int r = (int)lines.points.size() - 1; r >= 0; --r)
      for (int i = 0; i < (int)c.mesh.vertex.size(); ++i)
        if (c.mesh.vertex[i] == lines.points[r].a) m.points[i].line_point = r;
    m.tris = c.mesh.tris;
    meshes.push_back(std::move(m));
  }
  return meshes;
}

/// Lines that go through vertices only.
void add_line(Lines& lines, int kind, std::vector<int> vertices, bool closed, std::vector<int> parts) {
  lines.lines.push_back({kind, 0, (int)lines.points.size(), (int)vertices.size(), closed});
  for (int v : vertices) lines.points.push_back({v, v, 0});
  for (int p : parts) lines.uses.push_back({(int)lines.lines.size() - 1, p});
}

//   3---2---5    two unit squares, parts and patches 0 | 1
//   |  /|  /|
//   | / | / |
//   |/  |/  |
//   0---1---4
Surface two_squares() {
  Surface s;
  s.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}};
  s.tris = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
  s.vertex.set("size", std::vector<double>{1, 1, 2, 2, 1, 1});
  s.face.set("part", std::vector<int>{0, 0, 1, 1});
  s.face.set("patch", std::vector<int>{7, 7, 9, 9});
  return s;
}

Lines lines_of_two_squares(int middle) {
  Lines lines;
  add_line(lines, border_line, {1, 0, 3, 2}, false, {0});
  add_line(lines, border_line, {1, 4, 5, 2}, false, {1});
  add_line(lines, middle, {1, 2}, false, {0, 1});
  return lines;
}

}  // namespace

TEST(Lift, GluesChartsAlongLines) {
  const Surface s = two_squares();
  const auto charts = flat_charts(s, 2);
  const Lines lines = lines_of_two_squares(interface_line);
  const LiftedMesh m = lift(s, charts, lines, own_triangles(charts, lines));
  EXPECT_EQ(m.points.size(), 6u);
  EXPECT_EQ(m.part, (std::vector<int>{0, 0, 1, 1}));
  // line points by row: 1, 0, 3, 2, then 4, 5
  EXPECT_EQ(m.points[0], s.points[1]);
  EXPECT_EQ(m.points[3], s.points[2]);
  EXPECT_EQ(m.size[3], 2);
  EXPECT_EQ(m.points[5], s.points[5]);
  const Topology t = topology_of(m);
  EXPECT_EQ(t.loops, 1);
  EXPECT_EQ(t.components, 1);
  // without a model edge between them the patches are one region, and the tie
  // goes to the smaller label
  EXPECT_EQ(m.patch, (std::vector<int>{7, 7, 7, 7}));
  EXPECT_EQ(m.model, (std::vector<std::uint8_t>{0, 0, 0, 0}));
  // the corners of the squares' union are corners; the ends of the interface
  // are on the border
  EXPECT_EQ(m.kind, (std::vector<int>{1, 2, 2, 1, 2, 2}));
  EXPECT_EQ(m.line[0], 0);
  for (std::size_t v = 0; v < m.points.size(); ++v) {
    const Place& p = m.place[v];
    const Tri& r = s.tris[p.face];
    EXPECT_EQ(p.b0 * s.points[r[0]] + p.b1 * s.points[r[1]] + p.b2 * s.points[r[2]], m.points[v]);
  }
}

TEST(Lift, ModelEdgesSeparatePatches) {
  Surface s = two_squares();
  s.face.set("model", std::vector<std::uint8_t>{2, 0, 0, 4});
  const auto charts = flat_charts(s, 2);
  const Lines lines = lines_of_two_squares(model_line);
  const LiftedMesh m = lift(s, charts, lines, own_triangles(charts, lines));
  EXPECT_EQ(m.patch, (std::vector<int>{7, 7, 9, 9}));
  EXPECT_EQ(std::count(m.model.begin(), m.model.end(), 0), 2);
  EXPECT_EQ(m.kind, (std::vector<int>{2, 2, 2, 2, 2, 2}));  // the border meets the crease at 1 and 2
}

TEST(Lift, PointsOnEdgesAreExact) {
  const Surface s = two_squares();
  const auto charts = flat_charts(s, 2);
  Lines lines;  // the middle line has a point at a third of its edge
  add_line(lines, border_line, {1, 0, 3, 2}, false, {0});
  add_line(lines, border_line, {1, 4, 5, 2}, false, {1});
  lines.lines.push_back({interface_line, 0, 8, 3, 0});
  lines.uses.insert(lines.uses.end(), {{2, 0}, {2, 1}});
  lines.points.insert(lines.points.end(), {{1, 1, 0}, {1, 2, 1. / 3}, {2, 2, 0}});
  auto point = [&](double x, double y, int row) { return ChartPoint{{x, y}, row, {0, 1, 0, 0}}; };
  std::vector<PlaneMesh> meshes(2);
  meshes[0].points = {point(0, 0, 1), point(1, 0, 0), point(1, 1. / 3, 9), point(1, 1, 3), point(0, 1, 2)};
  meshes[0].tris = {{0, 1, 2}, {0, 2, 4}, {4, 2, 3}};
  meshes[1].points = {point(1, 0, 0), point(2, 0, 5), point(2, 1, 6), point(1, 1, 3), point(1, 1. / 3, 9)};
  meshes[1].tris = {{0, 1, 4}, {4, 1, 2}, {4, 2, 3}};
  const LiftedMesh m = lift(s, charts, lines, meshes);
  ASSERT_EQ(m.points.size(), 7u);
  EXPECT_EQ(m.points[6], lerp(s.points[1], s.points[2], 1. / 3));
  EXPECT_EQ(m.kind[6], 1);
  EXPECT_EQ(m.line[6], 2);
  EXPECT_EQ(m.place[6].face, 0);  // 0 1 2: the first triangle with the edge
  EXPECT_EQ(m.place[6].b1, 1 - 1. / 3);
  EXPECT_EQ(m.place[6].b2, 1. / 3);
  EXPECT_NEAR(m.size[6], 4. / 3, 1e-15);
}

//    2---1      a pillow: two hexagons, front and back, glued along their loop.
//    Both have the same inner edges
//   / \  |\     0-2, 0-3, 0-4: glued as they are, four triangles would share
//   each of them
//  3---\-| 0
//   \   \|/
//    4---5
TEST(Lift, InnerEdgesOfTwoChartsDoNotCoincide) {
  Surface s;
  for (int i = 0; i < 6; ++i)
    s.points.push_back({std::cos(i * std::acos(0.5)), std::sin(i * std::acos(0.5)), 0});
  s.points.push_back({0, 0, 0.1});
  s.points.push_back({0, 0, -0.1});
  std::vector<int> part;
  for (int i = 0; i < 6; ++i) {
    s.tris.push_back({i, (i + 1) % 6, 6});
    s.tris.push_back({(i + 1) % 6, i, 7});
    part.insert(part.end(), {0, 1});
  }
  s.face.set("part", std::move(part));
  s.vertex.set("size", std::vector<double>(8, 1));
  const auto charts = flat_charts(s, 2);
  Lines lines;
  add_line(lines, interface_line, {0, 1, 2, 3, 4, 5}, true, {0, 1});
  std::vector<PlaneMesh> meshes(2);
  for (int side : {0, 1}) {
    for (int i = 0; i < 6; ++i)
      meshes[side].points.push_back(
          {{side ? -s.points[i].x : s.points[i].x, s.points[i].y}, i, {0, 1, 0, 0}});
    for (int i = 1; i < 5; ++i) meshes[side].tris.push_back(side ? Tri{0, i + 1, i} : Tri{0, i, i + 1});
  }
  const LiftedMesh m = lift(s, charts, lines, meshes);
  const Topology t = topology_of(m);
  EXPECT_EQ(t.genus, 0);
  EXPECT_EQ(t.loops, 0);
  EXPECT_EQ(m.points.size(), 9u);  // three edges of one side were cut
  for (std::size_t v = 6; v < 9; ++v) EXPECT_EQ(m.kind[v], 0);
}

TEST(Lift, RefusesAMeshWithAGap) {
  const Surface s = two_squares();
  const auto charts = flat_charts(s, 2);
  const Lines lines = lines_of_two_squares(interface_line);
  auto meshes = own_triangles(charts, lines);
  meshes[1].tris.pop_back();
  EXPECT_THROW(lift(s, charts, lines, meshes), GoalMissed);
}
