// SPDX-License-Identifier: BSD-3-Clause
#include "lib/feature/merge.h"

#include <gtest/gtest.h>

#include <cmath>

#include "formats/foreign/patch_groups.h"
#include "lib/core/error.h"
#include "lib/core/topology.h"
#include "lib/feature/feature.h"
#include "lib/feature/model_edges.h"

using namespace meshpipe;

namespace {

//  z   a profile, extruded along y: patches 1 | 2 | 3 | 4, of widths 1, 1, 0.05 and 1; between 1 and 2 it
//  bends |      4     by 10 degrees, the strip 3 is a chamfer of 45 degrees between 2 and 4 |     / |1 2 3
Surface profile(double chamfer) {
  Surface s;
  const double turn[4] = {0, 10, 10 + chamfer, 10 + 2 * chamfer}, width[4] = {1, 1, 0.05, 1};
  Vec3 p;
  std::vector<int> patch;
  for (int i = 0; i <= 4; ++i) {
    for (int j = 0; j <= 10; ++j) s.points.push_back({p.x, 0.2 * j, p.z});
    if (i == 4) break;
    const double a = turn[i] * std::acos(-1) / 180;
    p = p + width[i] * Vec3{std::cos(a), 0, std::sin(a)};
  }
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 10; ++j) {
      const int a = 11 * i + j, b = a + 11;
      s.tris.push_back({a, b, b + 1});
      s.tris.push_back({a, b + 1, a + 1});
      patch.insert(patch.end(), 2, i + 1);
    }
  s.face.set("patch", patch);
  return s;
}

std::vector<int> merged(const Surface& s, double h) {
  PatchMerge m = no_merge(s);
  merge_automatically(m, s, h);
  return m.into;
}

}  // namespace

TEST(Merge, TangentPatchesAndSmallOnes) {
  const Surface s = profile(45);
  EXPECT_EQ(merged(s, 0.05), (std::vector<int>{1, 1, 3, 4}));  // the strip is as wide as the size
  const std::vector<int> coarse = merged(s, 0.5);              // now it is small; it turns as much to both
  EXPECT_EQ(coarse[0], coarse[1]);
  EXPECT_NE(coarse[2], 3);
  EXPECT_NE(coarse[0], coarse[3]);
  EXPECT_EQ(merged(profile(70), 0.5), (std::vector<int>{1, 1, 3, 4}));  // a step stays
}

TEST(Merge, Groups) {
  const Surface s = profile(45);
  PatchMerge m = no_merge(s);
  merge_groups(m, {{3, 2}, {2, 4}});
  EXPECT_EQ(m.into, (std::vector<int>{1, 3, 3, 3}));
  EXPECT_EQ(m.count(), 2);
  EXPECT_EQ(m(4), 3);
  EXPECT_EQ(m(99), 99);
  EXPECT_THROW(merge_groups(m, {{1, 7}}), NotAdmissible);
}

// the borders of a chamfer vanish with it, those of a step stay as creases
TEST(Merge, BordersThatVanish) {
  for (double bend : {45., 70.}) {
    Surface s = profile(bend);
    const std::vector<int> before = s.face.get<int>("patch");
    EXPECT_EQ(mark_features(s, {}).patch_edges, 30);
    for (int& p : s.face.get<int>("patch")) p = 1;
    std::vector<int> opposite = opposite_halfedges(s);
    const FeatureReport r = mark_features({s, opposite}, {}, &before);
    EXPECT_EQ(r.patch_edges, 0);
    EXPECT_EQ(r.crease_edges, bend < 60 ? 0 : 20);
  }
}

TEST(Merge, GroupsOfAFile) {
  Stream stream;
  stream.surface = profile(45);
  stream.names = {{2, 1, "left wing"}, {2, 2, "right wing"}, {2, 3, "chamfer"}, {2, 7, "lost"}};
  const auto g = read_groups("# comment\nwings = *wing 3\nlost\n\"left wing\" lost 4\n", "f", stream);
  ASSERT_EQ(g.size(), 2u);
  EXPECT_EQ(g[0].name, "wings");
  EXPECT_EQ(g[0].patches, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(g[1].name, "");
  EXPECT_EQ(g[1].patches, (std::vector<int>{1, 4}));
  for (const char* bad : {"nose\n", "a =\n", "\"left\n", "9\n"})
    EXPECT_THROW(read_groups(bad, "f", stream), BadInput);
}

TEST(ModelEdges, GivenEdgesAreFoundWhenTheyAreCut) {
  Surface s = profile(0);
  ModelSegments line;  // along the border of 1 and 2, as one long segment, and one across a triangle
  line.points = {s.points[11], s.points[21], s.points[0], s.points[14]};
  line.tris = {{0, 1, 1}, {2, 3, 3}};
  line.tag = {5, 6};
  const std::vector<int> under = segments_under(s, line);
  EXPECT_EQ(std::count(under.begin(), under.end(), 0), 20);  // from both sides
  EXPECT_EQ(std::count(under.begin(), under.end(), 1), 0);
  s.face.erase("patch");
  std::vector<int> opposite = opposite_halfedges(s);
  const FeatureReport r = mark_features({s, opposite}, {FeatureOptions::none, 40, 20, 0}, nullptr, &under);
  EXPECT_EQ(r.given_edges, 10);
  EXPECT_EQ(r.model_edges, 10);
}
