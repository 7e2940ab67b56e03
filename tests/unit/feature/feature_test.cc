// SPDX-License-Identifier: BSD-3-Clause
#include "lib/feature/feature.h"

#include <gtest/gtest.h>

#include <bit>
#include <random>

using namespace meshpipe;

/// Squares i, j of a grid over [0, nx] x [0, ny], of which z(i, j) gives the heights.
template <class Height>
static Surface terrain(int nx, int ny, Height z) {
  Surface s;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) s.points.push_back({(double)i, (double)j, z(i, j)});
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      int a = j * (nx + 1) + i, b = a + 1, d = a + nx + 1, c = d + 1;
      s.tris.push_back({a, b, c});
      s.tris.push_back({a, c, d});
    }
  s.face.rows = s.tris.size();
  return s;
}

//  the unit cube, 12 triangles
//     7---6
//    /|  /|
//   4---5 |
//   | 3-|-2
//   |/  |/
//   0---1
static Surface cube() {
  Surface s;
  s.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  for (std::array<int, 4> q :
       {std::array{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}) {
    s.tris.push_back({q[0], q[1], q[2]});
    s.tris.push_back({q[0], q[2], q[3]});
  }
  s.face.rows = s.tris.size();
  return s;
}

static const FeatureOptions automatic;
static const FeatureOptions none{FeatureOptions::none, 40, 20, 0};
static FeatureOptions angles(double strong, double weak) { return {FeatureOptions::angles, strong, weak, 0}; }

TEST(Feature, ACubeHasTwelveCreasesAndEightCorners) {
  Surface s = cube();
  FeatureReport r = mark_features(s, automatic);
  EXPECT_EQ(r.crease_edges, 12);
  EXPECT_EQ(r.corners, 8);
  int bits = 0;
  for (int t = 0; t < 12; ++t) {
    bits += std::popcount(s.face.get<std::uint8_t>("model")[t]);
    EXPECT_EQ(s.face.get<std::uint8_t>("model")[t] & (t % 2 ? 1 : 4), 0);  // the diagonal of the square
  }
  EXPECT_EQ(bits, 24);  // on both sides
  EXPECT_EQ(mark_features(s, none).model_edges, 0);
  EXPECT_EQ(mark_features(s, angles(91, 90.5)).model_edges, 0);
}

TEST(Feature, TinyComponentsKeepTheirCreases) {
  Surface s;
  for (const Vec3 o : {Vec3{0, 0, 0}, Vec3{1000, 0, 0}, Vec3{0, 1000, 0}}) {
    const int n = (int)s.points.size();
    for (const Vec3 p : {Vec3{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}) s.points.push_back(o + p);
    for (const Tri& t : {Tri{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}})
      s.tris.push_back({n + t[0], n + t[1], n + t[2]});
  }
  s.face.rows = s.tris.size();
  EXPECT_EQ(mark_features(s, {}).crease_edges, 18);
  FeatureOptions coarse;  // without their edges they would shrink to a blob of as many triangles
  coarse.size = 20;
  EXPECT_EQ(mark_features(s, coarse).crease_edges, 18);
}

TEST(Feature, PatchBordersAreModelEdgesInEveryMode) {
  Surface s = terrain(4, 4, [](int, int) { return 0.0; });
  std::vector<int> patch(32, 1);
  for (int t = 16; t < 32; ++t) patch[t] = 2;
  s.face.set("patch", patch);
  for (const FeatureOptions& o : {automatic, none, angles(40, 20)}) {
    FeatureReport r = mark_features(s, o);
    EXPECT_EQ(r.patch_edges, 4);
    EXPECT_EQ(r.crease_edges, 0);
    EXPECT_EQ(r.corners, 2);
  }
}

TEST(Feature, ARidgeFromBorderToBorderIsDesignAndNoiseIsNot) {
  auto ridge = [](int i, int) { return -std::abs(i - 10.0); };
  Surface s = terrain(20, 20, ridge);
  EXPECT_EQ(mark_features(s, automatic).crease_edges, 20);

  std::mt19937 random(1);
  s = terrain(40, 40, [&](int, int) { return random() * 2e-10; });
  EXPECT_GT(mark_features(s, angles(40, 20)).crease_edges, 200);
  EXPECT_EQ(mark_features(s, automatic).crease_edges, 0);
}

TEST(Feature, WhatHadCreasesStaysDesignAndPatchBordersAreNone) {
  std::mt19937 random(1);
  Surface s = terrain(40, 40, [&](int, int) { return random() * 2e-10; });
  std::vector<int> patch(3200, 1);
  for (int t = 1600; t < 3200; ++t) patch[t] = 2;
  s.face.set("patch", patch);
  EXPECT_EQ(mark_features(s, automatic).patch_edges, 40);
  FeatureOptions again;
  again.again = true;
  EXPECT_EQ(mark_features(s, again).crease_edges, 0);
  EXPECT_GT(mark_features(s, angles(40, 20)).crease_edges, 200);
  EXPECT_GT(mark_features(s, again).crease_edges, 200);
}

TEST(Feature, AStaircaseOfVoxelsIsNoDesign) {
  // heights in whole steps along a slanted plane: all edges sharp, all chains short
  Surface s = terrain(40, 40, [](int i, int j) { return 1.5 * ((i + 2 * j) / 4); });
  EXPECT_EQ(mark_features(s, automatic).crease_edges, 0);
}

//  pits between flat hills: every crease is short, but there is nothing between smooth and sharp
//   ___   ___   _
//      \_/   \_/
TEST(Feature, ShortCreasesAreDesignIfTheyAreFarApartAndNothingIsBetweenSmoothAndSharp) {
  auto pits = [](int i, int j) {
    return 0.2 * std::sin(0.5 * i) * std::sin(0.5 * j) +
           (i % 8 % 7 && j % 8 % 7 && i % 8 < 5 && j % 8 < 5 ? -2.0 : 0.0);
  };
  Surface s = terrain(40, 40, pits);
  EXPECT_GT(mark_features(s, automatic).crease_edges, 500);
  FeatureOptions coarse;
  coarse.size = 4;
  EXPECT_EQ(mark_features(s, coarse).crease_edges, 0);
  //  the same with dunes between: every angle is there
  Surface dunes =
      terrain(40, 40, [&](int i, int j) { return pits(i, j) + 1.2 * std::sin(0.9 * i) * std::sin(0.7 * j); });
  EXPECT_EQ(mark_features(dunes, automatic).crease_edges, 0);
}

//  hats of all sizes: every chain is short and bends, but hardly an edge is between smooth and sharp
TEST(Feature, APolyhedronKeepsItsCreasesHoweverRough) {
  std::mt19937 random(7);
  std::vector<double> z(41 * 41);
  for (double& x : z) x = std::uniform_real_distribution(2.0, 4.0)(random);
  auto hats = [&](int i, int j) { return i % 2 && j % 2 ? z[41 * j + i] : 0.0; };
  Surface s = terrain(40, 40, hats);
  EXPECT_GT(mark_features(s, automatic).crease_edges, 2000);
  EXPECT_EQ(mark_features(s, automatic).crease_edges, mark_features(s, angles(40, 20)).crease_edges);
  FeatureOptions coarse;
  coarse.size = 8;
  EXPECT_EQ(mark_features(s, coarse).crease_edges, 0);
  Surface noise = terrain(40, 40, [&](int i, int j) { return 0.5 * z[41 * j + i]; });
  EXPECT_EQ(mark_features(noise, automatic).crease_edges, 0);
}

//  a thin gear: all chains are short, flanks bend by every angle, and teeth are as near as triangles are
//  large
TEST(Feature, WhatIsMadeOfPlanesIsDesignUnlessTheseAreSteps) {
  constexpr int teeth = 20, flank = 3, n = teeth * 2 * (flank + 1);
  Surface s;
  for (double z : {0.0, 0.03}) {
    for (int i = 0; i < n; ++i) {
      const int k = i % (2 * flank + 2), rise = std::min(k, 2 * flank + 1 - k);
      const double r = 0.9 + 0.2 * rise / flank, share = 0.12 + 0.13 * std::pow((double)rise / flank, 1.5);
      const double a = 0.314 * (i / (2 * flank + 2) + (k > flank ? 1 - share : share));
      s.points.push_back({r * std::cos(a), r * std::sin(a), z});
    }
    s.points.push_back({0, 0, z});
  }
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n, up = n + 1;
    for (Tri t : {Tri{j, i, n}, {i + up, j + up, n + up}, {i, j, j + up}, {i, j + up, i + up}})
      s.tris.push_back(t);
  }
  s.face.rows = s.tris.size();
  EXPECT_GT(mark_features(s, automatic).crease_edges, 2 * n);
}

//  spikes on a plate that goes over into dunes: all creases are short, and edges bend by every angle
TEST(Feature, WhatHasLargePlaneFacesIsDesign) {
  auto surface = [](int plate) {
    return terrain(40, 40, [&](int i, int j) {
      return i >= plate ? 0.6 * std::sin(0.9 * i) * std::sin(0.7 * j) : i % 4 == 2 && j % 4 == 2 ? 2.0 : 0.0;
    });
  };
  Surface s = surface(24), dunes = surface(4);
  EXPECT_GT(mark_features(s, automatic).crease_edges, 500);
  EXPECT_EQ(mark_features(dunes, automatic).crease_edges, 0);
}

TEST(Feature, AChainGoesOnAlongWeakEdgesAndEndsFreelyOnlyIfItIsLong) {
  // a ridge whose slopes flatten along j: sharp at j = 0, 30 degrees in the middle, none at the end
  auto fading = [](int i, int j) { return -std::abs(i - 10.0) * std::max(0.0, 1 - j / 20.0); };
  Surface s = terrain(20, 20, fading);
  const int strong = mark_features(s, angles(40, 40)).crease_edges,
            weak = mark_features(s, angles(40, 20)).crease_edges;
  FeatureOptions fine, coarse;
  fine.size = 1, coarse.size = 4;
  EXPECT_EQ(mark_features(s, fine).crease_edges, weak);
  EXPECT_EQ(mark_features(s, coarse).crease_edges, 0);
  EXPECT_GT(strong, 8);
  EXPECT_GT(weak, strong + 2);
  EXPECT_LT(weak, 20);
}

TEST(Feature, AShortPieceThatEndsFreelyIsDropped) {
  Surface s = terrain(
      20, 20, [](int i, int j) { return i == 10 && (j == 10 || j == 11) ? 0.6 : 0.0; });  // a small fold
  FeatureOptions o = angles(40, 40);
  o.size = 0.1;
  EXPECT_EQ(mark_features(s, o).crease_edges, 5);
  o.size = 3;
  EXPECT_EQ(mark_features(s, o).crease_edges, 3);  // a closed ring of three is no free end
}

TEST(Feature, TheNormalOfAFlatTriangleIsThatOfItsNeighbor) {
  // the cube with a point on an edge: a cap of no height between two faces must not break or double the
  // crease
  Surface s = cube();
  s.points.push_back({0.5, 1e-9, 1e-9});  // next to edge 0-1
  s.tris[1] = {0, 2, 8};                  // bottom: (0, 2, 1) becomes two, and a cap (0, 8, 1) of the front
  s.tris.push_back({8, 2, 1});
  s.tris[0] = {0, 3, 2};
  s.tris.push_back({0, 8, 1});
  s.face.rows = s.tris.size();
  FeatureReport r = mark_features(s, automatic);
  EXPECT_EQ(r.crease_edges, 13);
  EXPECT_EQ(r.corners, 8);
}

//  a pit with 24 walls in a wide plate, from the side; rims of about 6.2
//   ----.   .----
//       |___|
TEST(Feature, TheRimsOfAHoleAreKeptUnlessTheyAreMuchShorterThanAnEdge) {
  Surface s;
  constexpr int n = 24;
  for (auto [radius, z] : {std::pair{100.0, 0.0}, {1.0, 0.0}, {1.0, -1.0}})
    for (int i = 0; i < n; ++i)
      s.points.push_back({radius * std::cos(2 * M_PI * i / n), radius * std::sin(2 * M_PI * i / n), z});
  s.points.push_back({0, 0, -1});
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    for (int ring : {0, n}) {
      s.tris.push_back({ring + i, ring + j, ring + n + i});
      s.tris.push_back({ring + j, ring + n + j, ring + n + i});
    }
    s.tris.push_back({2 * n + i, 2 * n + j, 3 * n});
  }
  s.face.rows = s.tris.size();
  FeatureOptions options;
  options.size = 5;  // other pieces would have to be longer than 15
  EXPECT_EQ(mark_features(s, options).crease_edges, 2 * n);
  options.size = 20;
  EXPECT_EQ(mark_features(s, options).crease_edges, 0);
}

//  a flat plate of 12 triangles: its rim is a thousandth of the size, so top and bottom meet in one crease
//  instead of two; where the mesh is as fine as the rim is high, in two
TEST(Feature, TheRimOfAThinPlateIsOneCrease) {
  Surface s = cube();
  for (Vec3& p : s.points) p = {10 * p.x, 10 * p.y, 0.005 * p.z};
  FeatureOptions options;
  options.size = 5;
  FeatureReport r = mark_features(s, options);
  EXPECT_GT(r.slivers, 0);
  EXPECT_LE(r.crease_edges, 8);  // four sides, and at most a short one at each corner
  EXPECT_GE(r.crease_edges, 4);
  options.size = 0.005;
  r = mark_features(s, options);
  EXPECT_EQ(r.slivers, 0);
  EXPECT_EQ(r.crease_edges, 12);
}

//  the same with a side that is cut next to a corner: where its short piece shows which way it faces, so does
//  the long one
TEST(Feature, ASideInOnePlaneFacesOneWay) {
  Surface s;
  const std::pair<double, double> outline[] = {{0, 0}, {0.3, 0}, {10, 0}, {10, 10}, {0, 10}};
  for (double z : {0.0, 0.2})
    for (const auto& [x, y] : outline) s.points.push_back({x, y, z});
  for (int i = 0; i < 5; ++i) {
    const int j = (i + 1) % 5;
    s.tris.push_back({i, j, 5 + j});
    s.tris.push_back({i, 5 + j, 5 + i});
    if (i != 3 && j != 3) s.tris.push_back({3, j, i}), s.tris.push_back({8, 5 + i, 5 + j});
  }
  s.face.rows = s.tris.size();
  FeatureOptions options;
  options.size = 5;
  mark_features(s, options);
  const auto& model = s.face.get<std::uint8_t>("model");
  auto is_crease = [&](int a, int b) {
    for (int h = 0; h < 3 * (int)s.tris.size(); ++h)
      if (origin(s.tris, h) == a && target(s.tris, h) == b) return (model[h / 3] >> h % 3 & 1) != 0;
    return false;
  };
  for (int i : {0, 1}) {
    EXPECT_TRUE(is_crease(i, i + 1));          // the edge below
    EXPECT_TRUE(is_crease(5 + i + 1, 5 + i));  // and that above
    EXPECT_FALSE(is_crease(i, 5 + i + 1));     // not a diagonal between
  }
}

//  the same with a rim of four rows, with and without a step: top and bottom meet in its middle
TEST(Feature, TheRimOfSeveralRowsIsOneCrease) {
  for (double step : {0.0, 0.002}) {
    Surface s;
    const int rows = 4;
    for (int i = 0; i <= rows; ++i)
      for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
        const double side = 5 - (i > rows / 2 ? step : 0);
        s.points.push_back({side * x, side * y, 0.005 * (i - (step > 0 && i > rows / 2 ? 1 : 0))});
      }
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < 4; ++j) {
        const int a = 4 * i + j, b = 4 * i + (j + 1) % 4;
        s.tris.push_back({a, b, b + 4});
        s.tris.push_back({a, b + 4, a + 4});
      }
    for (const Tri& t : {Tri{0, 2, 1}, {0, 3, 2}, {16, 17, 18}, {16, 18, 19}}) s.tris.push_back(t);
    s.face.rows = s.tris.size();
    FeatureOptions options;
    options.size = 5;
    const FeatureReport r = mark_features(s, options);
    EXPECT_GE(r.crease_edges, 4);
    EXPECT_LE(r.crease_edges, 8);
    options.size = 0.01;  // a band of several sizes stays as it is
    EXPECT_GE(mark_features(s, options).crease_edges, step > 0 ? 20 : 12);
  }
}

namespace {

// a square of two triangles, and its borders as segments with labels 1 to 4
struct Framed {
  Mesh square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  ModelSegments frame;
  Framed() {
    frame.points = square.points;
    for (int i = 0; i < 4; ++i) frame.tris.push_back({i, (i + 1) % 4, (i + 1) % 4});
    frame.tag = {1, 2, 3, 4};
    frame.ridge = frame.required = {0, 0, 0, 0};
  }
};

bool has_corner(const ModelSegments& segments, double x) {
  return std::any_of(segments.points.begin(), segments.points.end(), [&](Vec3 p) { return p.x == x; });
}

}  // namespace

TEST(ModelSegments, OfABorderMoveWithIt) {
  const Framed f;
  Mesh moved = f.square;
  for (Vec3& p : moved.points) p = 2.0 * p;
  const std::vector<int> under = segments_under(f.square, f.frame);
  const ModelSegments after = moved_segments(f.frame, under, moved, under);
  EXPECT_EQ(after.tag.size(), 4u) << "each once, also that from the last vertex to the first";
  EXPECT_TRUE(has_corner(after, 2));
  EXPECT_FALSE(has_corner(after, 1));
}

TEST(ModelSegments, OfRimsFollowTreatedEnds) {
  const Framed f;
  Mesh capped = f.square;  // inside out, with another triangle
  for (Vec3& p : capped.points) p = 2.0 * p;
  for (Tri& t : capped.tris) std::swap(t[1], t[2]);
  capped.tris.push_back({0, 1, 3});
  const ModelSegments moved = segments_after_ends(f.frame, f.square, capped);
  EXPECT_EQ(moved.tag.size(), 4u);
  EXPECT_TRUE(has_corner(moved, 2));
  Mesh cut = f.square;
  cut.tris.pop_back();
  EXPECT_EQ(segments_after_ends(f.frame, f.square, cut).tag.size(),
            2u);  // those of the triangle that is left
}
