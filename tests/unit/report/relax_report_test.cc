// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/relax_report.h"

#include <gtest/gtest.h>

using namespace meshpipe;

TEST(RelaxReport, SaysWhereThereAreMoreTrianglesThanPromised) {
  auto said = [](std::size_t triangles, int asked, int by_default) {
    const std::vector<std::string> lines = relax_lines({}, triangles, asked, by_default);
    return lines.size() > 1 ? lines[1] : "";
  };
  EXPECT_EQ(said(1020, 1000, 0), "");
  EXPECT_EQ(said(1100, 1000, 0), "narrow places of the model keep it from the 1000 triangles asked for");
  EXPECT_NE(said(1300, 1000, 0).find("1.3 times as many"), std::string::npos);
  EXPECT_EQ(said(1190, 0, 1000), "");
  EXPECT_NE(said(1300, 0, 1000).find("--triangles 1000"), std::string::npos);
  EXPECT_EQ(said(1300, 0, 0), "");
}
