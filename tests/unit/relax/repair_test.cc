// SPDX-License-Identifier: BSD-3-Clause
#include "lib/relax/repair.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/unit/relax/drawn.h"

using namespace meshpipe;

namespace {

// a hexagon with two vertices, g and h, where one would do
const std::vector<std::string> two_centers{"  e   d  ",  //
                                           "         ",  //
                                           "f   gh  c",  //
                                           "         ",  //
                                           "  a   b  "};
const char* const eight = "fag efg abg bhg bch cdh deg dgh";

void hold_rim(State& s) {
  for (int v = 0; v < 6; ++v) s.hold[v] = fixed;
}

TEST(Repair, TheBestEditIsFoundAndAdopted) {
  Drawn m(drawn_surface(two_centers, eight));
  hold_rim(m.s);
  const double before = objective(m.s);
  const std::vector<int> all = triangles_around(m.s, worst(m.s), 2);
  ASSERT_EQ(all.size(), 8u);
  const std::optional<State> best = repaired(m.s, all, false);
  ASSERT_TRUE(best);
  EXPECT_LT(objective(*best), before);
  EXPECT_EQ(objective(m.s), before);  // only tried
  adopt(m.s, *best, all);
  EXPECT_NEAR(objective(m.s), objective(*best), 1e-12);
  EXPECT_EQ(m.s.mesh.live, 6);
  EXPECT_NEAR(m.area(), 48, 1e-12);
}

// a vertex anchored off the middle of its hexagon, in the plane that it was to reach
TEST(Repair, AnAnchorThatSpoilsTrianglesIsGivenUpWhereNoFeatureIsMissed) {
  for (double height : {0.0, 10.0}) {
    Drawn m(drawn_surface({"  e   d  ",  //
                           "         ",  //
                           "f     g c",  //
                           "         ",  //
                           "  a   b  "},
                          "abg bcg cdg deg efg fag"));
    hold_rim(m.s);
    const Vec3 middle = 0.5 * (m.s.points[2] + m.s.points[5]);
    m.s.hold[6] = anchored;
    m.s.acute = true;
    m.s.points[6].z = height;  // at 10 the mesh, which stays on the reference, would miss it
    const std::optional<State> best = repaired(m.s, triangles_around(m.s, worst(m.s), 2), false);
    EXPECT_EQ(best.has_value(), height == 0);
    if (best) {
      EXPECT_LT(norm(best->points[6] - middle), 0.5);
    }
  }
}

//  a sharp corner a, where b is a corner as well and c is on a line
//                  _____e
//         ___c_----     |
//  a_----------b--------d
TEST(Repair, EndsOfLinesAtASharpCornerBecomeAsFarFromIt) {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {10, 0, 0}, {7, 1.4, 0}, {20, 0, 0}, {20, 4, 0}};
  mesh.tris = {{0, 1, 2}, {1, 4, 2}, {1, 3, 4}};
  Surface surface = surface_of(mesh);
  surface.vertex.set("size", std::vector<double>(5, 10));
  Drawn m(surface);
  for (int v = 0; v < 5; ++v) m.s.hold[v] = v == 2 ? slides : fixed;
  // what is split is not wanted here
  auto by_corner = [](const State& s, double) {
    return s.mesh.live == 3 ? 1 / kappa(s.points[0], s.points[1], s.points[2]) : 1e3;
  };
  const std::optional<State> best = repaired(m.s, {0, 1, 2}, true, {by_corner, true});
  ASSERT_TRUE(best);
  EXPECT_NEAR(norm(best->points[2]), 10, 1e-9);
}

// Numbers over the bound stand for what is over it, at any number of threads.
TEST(Trials, TheBestAreKeptInOrderWhateverIsKnownOfTheOthers) {
  const Drawn m(drawn_surface(two_centers, eight));
  std::vector<Trial> trials(50, Trial{0, m.s});
  for (int i = 0; i < 50; ++i) trials[i].state.points[0].x = i * 7 % 50;
  const Judge hasty{
      [](const State& s, double bound) { return s.points[0].x > bound ? bound + 1 : s.points[0].x; }};
  keep_best(trials, 5, hasty);
  ASSERT_EQ(trials.size(), 5u);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(trials[i].objective, i);
}

TEST(Repair, NoBadTriangleIsLeft) {
  Drawn m(drawn_surface(two_centers, eight));
  hold_rim(m.s);
  EXPECT_LT(quality(m.s, worst(m.s)), 1);
  Repairs memory;
  repair_worst(m.s, memory);
  EXPECT_GE(quality(m.s, worst(m.s)), 1);
  EXPECT_NEAR(m.area(), 48, 1e-12);
}

TEST(Repair, TrianglesInsideAndAtBordersAreAcute) {
  // 95 degrees at c, and no angle below 42
  Drawn m(drawn_surface({"  c  ", "a       b"}, "abc"));
  m.s.points[2] = {4, 3.7, 0};
  for (int v = 0; v < 3; ++v) m.s.hold[v] = loose;
  EXPECT_LT(quality(m.s, 0), 0.95);
  m.s.hold[0] = slides;  // the border may force it
  EXPECT_GT(quality(m.s, 0), 1);
  m.s.acute = true;
  EXPECT_LT(quality(m.s, 0), 0.95);
  m.s.hold[0] = loose;
  m.s.points[2] = {4, 4.4, 0};  // 85 degrees
  EXPECT_GT(quality(m.s, 0), 1);
}

TEST(Repair, WhatIsGoodStays) {
  Drawn m(drawn_surface({"  e   d  ",  //
                         "         ",  //
                         "f   g   c",  //
                         "         ",  //
                         "  a   b  "},
                        "abg bcg cdg deg efg fag"));
  Repairs memory;
  repair_worst(m.s, memory);
  EXPECT_EQ(m.s.counts.splits + m.s.counts.collapses + m.s.counts.flips, 0);
  EXPECT_TRUE(m.s.points == m.surface.points);
}

// a fan of more triangles than a patch may have
TEST(Repair, HugeNeighborhoodsAreNotTried) {
  constexpr int n = rules::largest_patch + 1;
  Mesh fan;
  fan.points.push_back({0, 0, 0});
  for (int i = 0; i < n; ++i) {
    const double turn = 2 * 3.14159265358979 * i / n;
    fan.points.push_back({std::cos(turn), std::sin(turn), 0});
    fan.tris.push_back({0, 1 + i, 1 + (i + 1) % n});
  }
  Surface s = surface_of(fan);
  s.vertex.set("size", std::vector<double>(n + 1, 1));
  Drawn m(s);
  Repairs memory;
  repair_worst(m.s, memory);
  EXPECT_EQ(m.s.counts.splits + m.s.counts.collapses + m.s.counts.flips, 0);
}

TEST(Patch, ItsRimIsFrozen) {
  Drawn m(drawn_surface(two_centers, eight));
  const int t = m.edge('b', 'h') / 3;  // b h g
  const State patch = extract(m.s, {t});
  ASSERT_EQ(patch.points.size(), 3u);  // b, g, h
  for (Hold hold : patch.hold) EXPECT_EQ(hold, frozen);
  EXPECT_TRUE(patch.recording);
  EXPECT_EQ(patch.points[0], m.s.points['b' - 'a']);
}

TEST(Patch, TrianglesAroundComeRingByRing) {
  Drawn m(drawn_surface(two_centers, eight));
  const int t = m.edge('f', 'a') / 3;
  EXPECT_EQ(triangles_around(m.s, t, 0), std::vector<int>{t});
  const std::vector<int> one = triangles_around(m.s, t, 1);
  EXPECT_EQ(one.front(), t);
  EXPECT_EQ(one.size(), 6u);  // all but those of c
  EXPECT_EQ(triangles_around(m.s, t, 2).size(), 8u);
}

// neighborhoods that overlap and cannot be changed: each is looked at once, and tried until the bound
TEST(Patch, AttemptsHaveABound) {
  Drawn m(drawn_surface(two_centers, eight));
  std::vector<int> items(100);
  std::iota(items.begin(), items.end(), 0);
  int looked = 0, tried = 0, failed = 0;
  auto around = [&](int, std::vector<int> before) {
    looked += before.empty();
    return before.empty() ? std::vector<int>{0, 1} : before;
  };
  auto attempt = [&](int, const std::vector<int>&) {
    ++tried;
    return std::optional<State>();
  };
  EXPECT_EQ(
      change_neighborhoods(m.s, items, 5, 7, around, attempt, [&](const std::vector<int>&) { ++failed; }), 0);
  EXPECT_EQ(looked, 100);
  EXPECT_EQ(tried, 7);
  EXPECT_EQ(failed, 7);
}

}  // namespace
