// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "lib/core/bvh.h"
#include "lib/core/coarsen.h"
#include "lib/core/topology.h"
#include "lib/lift/lift.h"
#include "lib/shape/shape.h"

using namespace meshpipe;

namespace {

/// A coarse model of a mesh as a surface, with sizes that grow with z.
Surface coarse_of(const Mesh& mesh) {
  const std::vector<int> opposite = opposite_halfedges(mesh.tris, (int)mesh.points.size());
  Coarse coarse =
      coarsen({mesh, opposite}, 0,
              {.turn = 0.4, .length = 0.5, .deviation = std::vector<double>(mesh.points.size(), 0.02)});
  Surface s = surface_of(std::move(coarse));
  std::vector<double> size;
  for (Vec3 p : s.points) size.push_back(2 + p.z);
  s.vertex.set("size", std::move(size));
  s.face.set("part", std::vector<int>(s.tris.size(), 0));
  return s;
}

/// The first border loop of a surface as a line of points in the middle of its edges.
Lines border_of(const Surface& s) {
  Lines lines;
  const std::vector<int> loop = boundary_loops(opposite_halfedges(s)).front();
  lines.lines.push_back({border_line, 0, 0, (int)loop.size(), 1});
  for (int h : loop) lines.points.push_back({origin(s.tris, h), target(s.tris, h), 0.5});
  return lines;
}

}  // namespace

TEST(MoveToFine, PutsVerticesAndLinesOnTheFineSurface) {
  const Mesh mesh = tube(3, 60, false);
  const Surface coarse = coarse_of(mesh);
  ASSERT_LT(coarse.tris.size(), mesh.tris.size() / 4);
  LiftedMesh lifted = place_on(coarse, coarse);
  for (Vec3& p : lifted.points) p = p + Vec3{0.01, 0.02, 0};  // as points inside of triangles are off
  Lines lines = border_of(coarse);
  Surface fine = surface_of(mesh);
  move_to_fine(lifted, lines, coarse, fine);

  const Bvh tree(mesh);
  for (std::size_t v = 0; v < lifted.points.size(); ++v) {
    EXPECT_LT(tree.nearest(lifted.points[v]).distance, 1e-12);
    EXPECT_LT(norm(value_at(lifted.place[v], mesh.points, mesh.tris) - lifted.points[v]), 1e-12);
  }
  const std::vector<int> opposite = opposite_halfedges(fine);
  for (const LinePoint& p : lines.points) {
    int border = 0;
    for (int h = 0; h < (int)opposite.size(); ++h) {
      const int a = origin(fine.tris, h), b = target(fine.tris, h);
      border +=
          opposite[h] < 0 && ((a == p.a && b == p.b) || (a == p.b && b == p.a) || (p.a == p.b && a == p.a));
    }
    EXPECT_EQ(border, 1) << p.a << ' ' << p.b << ' ' << p.t;
  }
  const auto& size = fine.vertex.get<double>("size");
  for (std::size_t v = 0; v < size.size(); ++v) EXPECT_NEAR(size[v], 2 + fine.points[v].z, 0.05);
}

//  two sheets, one above the other, seen from above and from below: a vertex between them stays with its own
TEST(MoveToFine, StaysOnItsSideOfAThinSheet) {
  Surface fine = surface_of(
      {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0.1}, {1, 0, 0.1}, {0, 1, 0.1}}, {{0, 2, 1}, {3, 4, 5}}});
  Surface coarse = fine;
  coarse.vertex.set("size", std::vector<double>(6, 0.5));
  LiftedMesh lifted = place_on(coarse, coarse);
  lifted.line.assign(6, -1);
  lifted.points[0].z = 0.08, lifted.points[3].z = 0.02;
  Lines none;
  move_to_fine(lifted, none, coarse, fine);
  for (int v = 0; v < 6; ++v) EXPECT_EQ(lifted.points[v].z, v < 3 ? 0 : 0.1) << v;
}
