// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/page_meshes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "formats/stream/line_tables.h"
#include "formats/stream/plane_tables.h"

namespace meshpipe {
namespace {

/// A square of two triangles, 0 1 2 and 0 2 3, the first cut in two at vertex 4 of its first edge.
Surface cut_square() {
  Surface s = surface_of(
      {{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 0, 0}}, {{0, 4, 2}, {4, 1, 2}, {0, 2, 3}}});
  s.face.set("origin", std::vector<int>{0, 0, 1});
  s.face.set("part", std::vector<int>{0, 1, 0});
  s.face.set("patch", std::vector<int>{7, 7, 8});
  s.face.set("model", std::vector<std::uint8_t>{1, 1, 4});
  return s;
}

TEST(page_meshes, shows_the_reference_before_cuts) {
  const Surface s = before_cuts(cut_square());
  ASSERT_EQ(s.tris.size(), 2u);
  EXPECT_EQ(s.face.get<int>("patch"), (std::vector<int>{7, 8}));
  EXPECT_FALSE(s.face.has("part"));
  const auto& model = s.face.get<std::uint8_t>("model");
  int first = 0;
  while (s.tris[0][first] != 0) ++first;  // the edge from 0 to 1
  EXPECT_EQ(model[0], 1 << first);
  EXPECT_EQ(model[1], 4);
}

TEST(page_meshes, keeps_a_reference_without_cuts) {
  Surface s = cut_square();
  s.face.erase("origin");
  EXPECT_EQ(before_cuts(s).tris, s.tris);
  EXPECT_EQ(model_of(before_cuts(s)), model_of(s));
}

TEST(page_meshes, marks_borders_and_edges_between_parts) {
  EXPECT_EQ(line_edges(cut_square()), (std::vector<std::uint8_t>{1 + 2, 1 + 2 + 4, 2 + 4}));
}

TEST(page_meshes, measures_how_far_apart_thick_edges_are) {
  const Surface s = cut_square();
  // thick: the diagonal and the border of triangle 2, from there a region of its own
  const std::vector<double> d = spacing_of(s, {4, 0, 7});
  EXPECT_DOUBLE_EQ(d[0], 2 * 2 / std::sqrt(8.0));
  EXPECT_DOUBLE_EQ(d[1], d[0]);
  EXPECT_DOUBLE_EQ(d[2], 2 * 2 / (4 + std::sqrt(8.0)));
  EXPECT_EQ(spacing_of(s, {})[0], HUGE_VAL);
  EXPECT_EQ(spacing_of(s, {0, 0, 0})[0], HUGE_VAL);
}

TEST(page_meshes, lays_plane_meshes_where_the_charts_are) {
  Stream stream;
  stream.surface = surface_of({{{0, 0, 5}, {1, 0, 5}, {0, 1, 5}}, {{0, 1, 2}}});
  stream.surface.face.set("part", std::vector<int>{0});
  Table part{"part", 1, {}};
  part.set("faces", std::vector<int>{1});
  stream.set(part);
  std::vector<Chart> charts(1);
  static_cast<Mesh&>(charts[0].mesh) = stream.surface;
  charts[0].mesh.vertex = {0, 1, 2}, charts[0].mesh.face = {0};
  charts[0].uv = {{0, 0}, {4, 0}, {0, 4}};
  // a line around the triangle with a point in the middle of its first edge, and a point inside
  write_lines(stream,
              {{{border_line, 0, 0, 4, 1}}, {{0, 0}}, {{0, 0, 0}, {0, 1, 0.5}, {1, 1, 0}, {2, 2, 0}}});
  PlaneMesh mesh;
  mesh.points = {
      {{0, 0}, 0, {}}, {{2, 0}, 1, {}}, {{4, 0}, 2, {}}, {{0, 4}, 3, {}}, {{1, 1}, -1, {0, 0.5, 0.25, 0.25}}};
  mesh.tris = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  write_plane_meshes(stream, charts, {mesh});
  const PlaneMeshes all = plane_meshes(stream, charts);
  EXPECT_NEAR(norm(all.space.points[1] - Vec3{0.5, 0, 5}), 0, 1e-15);
  EXPECT_NEAR(norm(all.space.points[4] - Vec3{0.25, 0.25, 5}), 0, 1e-15);
  EXPECT_EQ(model_of(all.space), (std::vector<std::uint8_t>{1, 1, 1, 1}));
  EXPECT_EQ(all.space.face.get<int>("part"), std::vector<int>(4, 0));
  EXPECT_NEAR(norm(all.flat[2] - all.flat[0]), 1, 1e-12);  // as large as in space
  const Mesh chart = flat_charts(stream.surface, charts);
  EXPECT_NEAR(norm(all.flat[3] - chart.points[2]), 0, 1e-12);
  ASSERT_EQ(line_points(stream).size(), 4u);
  EXPECT_NEAR(norm(line_points(stream)[1] - Vec3{0.5, 0, 5}), 0, 1e-15);
}

}  // namespace
}  // namespace meshpipe
