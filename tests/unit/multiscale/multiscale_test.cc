// SPDX-License-Identifier: BSD-3-Clause
#include "lib/multiscale/multiscale.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>
#include <sstream>

#include "formats/formats.h"
#include "lib/core/error.h"
#include "lib/core/topology.h"
#include "lib/multiscale/cut_line.h"
#include "lib/multiscale/levels.h"
#include "lib/plan/plan.h"
#include "tools/report/level_svg.h"

using namespace meshpipe;

namespace {

constexpr double pi = std::numbers::pi;

/// A tube of diameter 1 with `n` vertices around, jittered; its far end open or closed by a cone.
///
///   j+1  o---o---o      rows i along the axis, columns j around it
///        | / | \ |
///   j    o---o---o
///        i  i+1 i+2
Surface tube(double height, int n, bool closed = false) {
  std::mt19937 random(7);
  auto jitter = [&] { return 0.2 * (random() / 4294967296. - 0.5); };
  Surface s;
  const int rows = std::lround(height * n / pi);
  for (int i = 0; i <= rows; i++)
    for (int j = 0; j < n; j++) {
      double a = 2 * pi * (j + jitter()) / n;
      double z = height * (i + (i == 0 || i == rows ? 0 : jitter())) / rows;
      s.points.push_back({std::cos(a) / 2, std::sin(a) / 2, z});
    }
  for (int i = 0; i < rows; i++)
    for (int j = 0; j < n; j++) {
      int a = i * n + j, b = i * n + (j + 1) % n;
      // alternating diagonals: no sense of rotation
      if (i % 2) {
        s.tris.push_back({a, b, b + n});
        s.tris.push_back({a, b + n, a + n});
      } else {
        s.tris.push_back({a, b, a + n});
        s.tris.push_back({b, b + n, a + n});
      }
    }
  if (closed) {
    s.points.push_back({0, 0, height + 0.3});
    for (int j = 0; j < n; j++)
      s.tris.push_back({rows * n + j, rows * n + (j + 1) % n, static_cast<int>(s.points.size()) - 1});
  }
  s.vertex.rows = s.points.size();
  s.face.set("part", std::vector<int>(s.tris.size(), 0));
  return s;
}

/// Leaves out the triangles of the tube near these places of its side (height, angle): round holes.
Surface pierced(const Surface& s, const std::vector<std::array<double, 2>>& places, double radius) {
  Mesh m;
  std::vector<int> label;
  for (const Tri& t : s.tris) {
    Vec3 c = (1. / 3) * (s.points[t[0]] + s.points[t[1]] + s.points[t[2]]);
    bool in = false;
    for (auto [z, a] : places) in |= norm(c - Vec3{std::cos(a) / 2, std::sin(a) / 2, z}) < radius;
    label.push_back(in ? -1 : 0);
  }
  SubMesh rest = split_by_label(s, label, 1)[0];
  Surface out;
  out.points = rest.points;
  out.tris = rest.tris;
  out.vertex.rows = out.points.size();
  out.face.set("part", std::vector<int>(out.tris.size(), 0));
  return out;
}

std::vector<Topology> parts(const Surface& s, int n) {
  return topology_of_parts(s, s.face.get<int>("part"), n);
}

void expect_admissible(const Surface& s, int n) {
  for (const Topology& t : parts(s, n)) {
    EXPECT_EQ(t.components, 1);
    EXPECT_EQ(t.genus, 0);
    EXPECT_GE(t.loops, 1);
    EXPECT_LE(t.eta_geo, 4);
  }
}

double length_of_interface(const Surface& s) {
  std::vector<int> opposite = opposite_halfedges(s.tris, s.points.size());
  const auto& part = s.face.get<int>("part");
  double sum = 0;
  for (std::size_t h = 0; h < opposite.size(); h++)
    if (opposite[h] >= 0 && part[h / 3] < part[opposite[h] / 3])
      sum += norm(s.points[target(s.tris, h)] - s.points[origin(s.tris, h)]);
  return sum;
}

}  // namespace

TEST(Levels, ATubeTakesALevelForAboutFourDiametersAndNothingIsFlipped) {
  FilledDisk disk = fill_holes(tube(40, 24));
  EXPECT_EQ(disk.rim.size(), 24u);
  EXPECT_EQ(disk.tris.size() - disk.part_tris, 24u);
  EXPECT_EQ(disk.opposite, opposite_halfedges(disk.tris, disk.points.size()));
  std::vector<Level> levels = laplace_levels(disk);
  EXPECT_GE(levels.size(), 7u);
  EXPECT_LE(levels.size(), 12u);
  std::vector<int> seen(disk.tris.size(), 0);
  for (const Level& l : levels)
    for (std::size_t i = 0; i < l.tris.size(); i++) {
      seen[l.tris[i]]++;
      Vec2 a = l.uv[l.corners[i][0]], b = l.uv[l.corners[i][1]], c = l.uv[l.corners[i][2]];
      EXPECT_GT(cross(b - a, c - a), 0);
    }
  EXPECT_EQ(seen, std::vector<int>(disk.tris.size(), 1));
}

TEST(Levels, AShortPartIsOneLevelAndItsHoleOnePoint) {
  std::vector<Level> levels = laplace_levels(fill_holes(tube(1, 12)));
  ASSERT_EQ(levels.size(), 1u);
  ASSERT_EQ(levels[0].holes.size(), 1u);
  EXPECT_LT(norm(levels[0].uv[levels[0].holes[0]]), 0.1);
}

TEST(CutLine, OfAStraightTubeRunsAlongTwoGenerators) {
  Surface s = tube(20, 24);
  FilledDisk disk = fill_holes(s);
  const std::vector<Level> levels = laplace_levels(disk);
  std::vector<double> f = cut_line_field(disk, levels, cut_lines(disk, levels, 0.3));
  // the rim's first vertex is at angle 0 of the disk: left of the line is where the angle from it is in (0,
  // pi)
  double start = std::atan2(s.points[disk.rim[0]].y, s.points[disk.rim[0]].x);
  double turn = std::atan2(s.points[disk.rim[1]].y, s.points[disk.rim[1]].x) > start ? 1 : -1;
  int wrong = 0;
  for (std::size_t v = 0; v < s.points.size(); v++) {
    double side = std::sin(turn * (std::atan2(s.points[v].y, s.points[v].x) - start) - 0.3) / 2;
    EXPECT_NE(f[v], 0);
    if (std::abs(side) > 0.1) wrong += (side > 0) != (f[v] > 0);
  }
  EXPECT_EQ(wrong, 0);
}

TEST(Multiscale, LongTubesFallIntoTwoStripsWithStraightBorders) {
  for (double height : {25., 100.}) {
    Surface s = tube(height, 16);
    const double area = total_area(s);
    std::vector<MultiscaleCut> cuts;
    ASSERT_EQ(multiscale_cut(s, {}, &cuts), 2);
    expect_admissible(s, 2);
    for (const Topology& t : parts(s, 2)) {
      EXPECT_EQ(t.loops, 1);
      EXPECT_GT(t.area, 0.4 * area);
    }
    EXPECT_NEAR(total_area(s), area, 1e-9 * area);
    EXPECT_LT(length_of_interface(s), 2.05 * height);
    ASSERT_EQ(cuts.size(), 1u);
    EXPECT_NEAR(cuts[0].length, 2, 0.1);
    EXPECT_GT(cuts[0].eta, 0.95 * height);
  }
}

TEST(Multiscale, AFingerIsCutThroughItsTip) {
  Surface s = tube(12, 16, true);
  ASSERT_EQ(multiscale_cut(s), 2);
  expect_admissible(s, 2);
  for (const Topology& t : parts(s, 2)) EXPECT_EQ(t.loops, 1);
}

TEST(Multiscale, TheCutPassesThroughEveryHole) {
  Surface s = pierced(tube(15, 32), {{2, 0.5}, {3.5, 3}, {6, 1}, {7, 4}, {7.2, 2}, {11, 5}, {14, 0}}, 0.2);
  ASSERT_EQ(topology_of(s).loops, 9);
  ASSERT_EQ(multiscale_cut(s), 2);
  expect_admissible(s, 2);
  for (const Topology& t : parts(s, 2)) EXPECT_EQ(t.loops, 1);
}

TEST(Multiscale, ShortPartsStayAsTheyAre) {
  Surface s = tube(3, 16);
  const auto tris = s.tris;
  EXPECT_EQ(multiscale_cut(s), 1);
  EXPECT_EQ(s.tris, tris);
  MultiscaleOptions options;
  options.max_aspect = 2;
  options.most_parts = 1;
  EXPECT_THROW(multiscale_cut(s, options), GoalMissed);
  EXPECT_EQ(s.tris, tris);
  options.most_parts = 2;
  EXPECT_EQ(multiscale_cut(s, options), 2);
}

TEST(Multiscale, TheStubOfALongTubeGoesWithOneHalf) {
  Surface s = tube(24, 16);
  std::vector<int> part;
  for (const Tri& t : s.tris)
    part.push_back((s.points[t[0]].z + s.points[t[1]].z + s.points[t[2]].z) / 3 < 2);
  s.face.set("part", part);
  ASSERT_EQ(multiscale_cut(s), 2);
  expect_admissible(s, 2);
  EXPECT_EQ(topology_of(s).loops, 2);
}

TEST(Multiscale, TrianglesOfNoPartAreLeftAloneAndStayConforming) {
  Surface s = tube(24, 16);
  std::vector<int> part;
  for (const Tri& t : s.tris)
    part.push_back((s.points[t[0]].z + s.points[t[1]].z + s.points[t[2]].z) / 3 < 2 ? -1 : 0);
  s.face.set("part", part);
  ASSERT_EQ(multiscale_cut(s), 2);
  expect_admissible(s, 2);
  EXPECT_EQ(topology_of(s).loops, 2);
  EXPECT_NEAR(total_area(s) - parts(s, 2)[0].area - parts(s, 2)[1].area, 2 * pi, 0.5);
}

// with triangles of no part nothing is joined; the ends stay, but get vertices on their borders
TEST(Multiscale, TheTopologyIsThatOfTheResultWhateverIsKnown) {
  Surface s = tube(24, 16);
  std::vector<int> part;
  for (const Tri& t : s.tris) {
    const double z = (s.points[t[0]].z + s.points[t[1]].z + s.points[t[2]].z) / 3;
    part.push_back(z < 1 ? -1 : z < 4 ? 1 : z > 21 ? 2 : 0);
  }
  s.face.set("part", part);
  for (std::vector<Topology> known : {std::vector<Topology>(), topology_of_parts(s, part, 3)}) {
    Surface cut = s;
    const int n = multiscale_cut(cut, {}, nullptr, &known);
    ASSERT_GT(n, 3);
    const std::vector<Topology> measured = topology_of_parts(cut, cut.face.get<int>("part"), n);
    ASSERT_EQ((int)known.size(), n);
    for (int p = 0; p < n; p++) {
      EXPECT_EQ(known[p].faces, measured[p].faces);
      EXPECT_EQ(known[p].loops, measured[p].loops);
      EXPECT_EQ(known[p].area, measured[p].area);
      EXPECT_EQ(known[p].eta_geo, measured[p].eta_geo);
    }
  }
}

TEST(Multiscale, TwoRunsGiveTheSame) {
  Surface a = tube(25, 16), b = tube(25, 16);
  multiscale_cut(a);
  multiscale_cut(b);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.tris, b.tris);
  EXPECT_EQ(a.face.get<int>("part"), b.face.get<int>("part"));
}

// a tetrahedron: closed
TEST(Multiscale, APartWithoutABorderIsNotAdmissible) {
  Surface s;
  s.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  s.tris = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  s.vertex.rows = 4;
  s.face.set("part", std::vector<int>(4, 0));
  EXPECT_THROW(multiscale_cut(s), NotAdmissible);
}

TEST(Multiscale, RealSurfacesFallIntoTwo) {
  const char* corpus = std::getenv("MESHPIPE_CORPUS");
  if (!corpus) GTEST_SKIP() << "MESHPIPE_CORPUS is not set";
  for (const char* file : {"bunny_stanford.obj", "plane_holes.obj"}) {
    std::filesystem::path path = std::filesystem::path(corpus) / file;
    std::stringstream bytes;
    bytes << std::ifstream(path, std::ios::binary).rdbuf();
    Surface s = read_any(bytes.str(), file).surface;
    s.face.set("part", std::vector<int>(s.tris.size(), 0));
    ASSERT_EQ(multiscale_cut(s), 2) << file;
    expect_admissible(s, 2);
  }
}

TEST(LevelSvg, EveryLevelShowsItsSetsAndItsLine) {
  Surface s = tube(20, 16);
  MultiscaleOptions options;
  options.keep_maps = true;
  std::vector<MultiscaleCut> cuts;
  multiscale_cut(s, options, &cuts);
  const CutMaps& maps = cuts[0].maps;
  const std::vector<std::string> names = level_names(maps.levels);
  ASSERT_GE(names.size(), 3u);
  EXPECT_EQ(names[0], "0-0");
  EXPECT_EQ(names[2], "2-0");
  for (std::size_t l = 0; l < names.size(); l++) {
    const std::string svg = level_svg(maps, l);
    EXPECT_NE(svg.find("level " + names[l]), std::string::npos);
    EXPECT_NE(svg.find("#d01010"), std::string::npos);
    for (int child : maps.levels[l].children)
      EXPECT_NE(svg.find(">" + names[child] + "<"), std::string::npos);
  }
  EXPECT_NE(levels_svg(maps.levels, names).find("href=\"1-0\""), std::string::npos);
}
