// SPDX-License-Identifier: BSD-3-Clause
#include "lib/check/sheets.h"

#include <gtest/gtest.h>

using namespace meshpipe;

namespace {

// Three sheets of one triangle each meet along a line, which is also a diagonal of a square:
//    d---b
//    |  /|     sheets: (a b x), (a b y), (a b z), each with its own points
//    | / |
//    a---c
Surface fan_through_square(bool along_line) {
  Surface s;
  for (Vec3 x : {Vec3{.5, .5, 1}, Vec3{1, 0, 1}, Vec3{0, 1, 1}}) {
    const int n = (int)s.points.size();
    s.points.insert(s.points.end(), {{0, 0, 0}, {1, 1, 0}, x});
    s.tris.push_back({n, n + 1, n + 2});
  }
  const int a = (int)s.points.size(), b = a + 1, c = a + 2, d = a + 3;
  s.points.insert(s.points.end(), {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}});
  if (along_line)
    s.tris.push_back({a, c, b}), s.tris.push_back({a, b, d});
  else
    s.tris.push_back({a, c, d}), s.tris.push_back({c, b, d});
  return s;
}

}  // namespace

TEST(CompareSheets, InsideOfASheetAlongALineIsNoPartOfIt) {
  for (bool first : {false, true})
    for (bool second : {false, true}) {
      const SheetFindings f =
          compare_sheets(fan_through_square(first), fan_through_square(second), {}, false, false);
      EXPECT_TRUE(f.faults.empty()) << f.faults[0];
      EXPECT_EQ(f.lines, (Both{1, 1}));
      EXPECT_EQ(f.corners, (Both{2, 2}));
    }
}

//  3---2---7   two squares; (1 2) and (4 5) are the sides of a slit, in one place, and no sheet
//  |  /|  /|   ends there
//  | / | / |
//  0---1---6
TEST(CompareSheets, FreeEdgesInOnePlaceAreASlit) {
  Mesh m{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {2, 0, 0}, {2, 1, 0}},
         {{0, 1, 2}, {0, 2, 3}, {4, 6, 7}, {4, 7, 5}}};
  EXPECT_EQ(slits_of(m), (std::vector<int>{0, 3}));
  m.tris[2][0] = m.tris[3][0] = 1, m.tris[3][2] = 2;
  EXPECT_EQ(slits_of(m), std::vector<int>{});
  const Surface line = fan_through_square(true);  // where sheets meet, more than two are free
  EXPECT_EQ(slits_of(line), std::vector<int>{});
}

TEST(CompareSheets, ALineOfOtherSheetsIsFound) {
  Surface less = fan_through_square(true);
  less.tris.erase(less.tris.begin());
  EXPECT_FALSE(compare_sheets(fan_through_square(true), less, {}, false, false).faults.empty());
}
