// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "lib/clean/clean.h"
#include "lib/core/junctions.h"
#include "lib/shape/shape.h"
#include "lib/smooth/smooth.h"

using namespace meshpipe;

TEST(SmoothSheets, StaysConformingWithinTheBound) {
  Surface s = surface_of(labeled_image(3, true, true, 4000, 1));
  clean(s, {.sheets = CleanOptions::keep});
  take_apart(s);
  const std::vector<Vec3> before = s.points;
  Mesh joined = s;
  join_borders(joined);
  const SmoothReport r = smooth_sheets(s, {});
  Mesh after = s;
  join_borders(after);
  EXPECT_EQ(after.tris, joined.tris);
  EXPECT_LT(r.angle_after, 0.5 * r.angle_before);
  EXPECT_GT(r.farthest, 0);
  for (std::size_t v = 0; v < before.size(); ++v)
    EXPECT_LE(norm(s.points[v] - before[v]), r.within * (1 + 1e-12));
  EXPECT_LT(r.region_change, 1e-3);
}
