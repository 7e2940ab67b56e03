// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/verdict.h"

#include <gtest/gtest.h>

#include "formats/stream/model_edges.h"

using namespace meshpipe;

//   3---2     lines 5 and 6 of the input, both from corner to corner; the result has no edge 0 2
//   | \ |
//   0---1
TEST(Verdict, NamesLinesThatNoEdgeOfTheResultHas) {
  Stream s;
  s.surface.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  s.surface.tris = {{0, 1, 3}, {1, 2, 3}};
  s.surface.vertex.rows = 4;
  s.surface.face.set<std::uint8_t>("model", {2, 4});
  s.surface.vertex.set<int>("line", std::vector<int>(4, 0));
  s.surface.vertex.set<int>("kind", std::vector<int>(4, 2));
  Table line{"line", 0, {}}, reference{"ref_vertex", 0, {}};
  for (const char* column : {"kind", "first", "count", "closed"}) line.set<int>(column, {1, 1});
  line.set<int>("tag", {5, 6});
  reference.set<double>("x", {0.0});
  s.tables = {line, reference};
  write_model_edges(s, segments_between(s.surface.points, {{1, 3, 5}, {0, 2, 6}, {0, 2, 7}}));
  s.names = {{1, 6, "rim"}};
  EXPECT_EQ(warnings_of(s, {}),
            std::vector<std::string>{"lines of the input that have no edge in the result: 'rim', 7"});
  EXPECT_EQ(report_of({}, s)["lines_lost"].dump(), R"(["'rim'","7"])");
  s.tables.erase(s.tables.begin() + 1);  // ref_vertex: a file that mcheck compares with another
  EXPECT_TRUE(warnings_of(s, {}).empty());
}
