// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream/shards.h"

#include <gtest/gtest.h>

#include "formats/stream/line_tables.h"
#include "lib/core/error.h"
#include "lib/mesh2d/mesh2d.h"

using namespace meshpipe;

namespace {

/// A square of two parts: the border of part 0, the line between them, the border of part 1.
Stream square() {
  Stream s;
  s.surface = surface_of({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}});
  s.surface.face.set("part", std::vector<int>{0, 1});
  Table part{"part", 0, {}};
  part.set("genus", std::vector<int>{0, 0});
  s.set(std::move(part));
  Lines lines;
  lines.lines = {{border_line, 0, 0, 3, 0}, {model_line, 7, 3, 2, 0}, {border_line, 0, 5, 3, 0}};
  lines.uses = {{0, 0}, {1, 0}, {1, 1}, {2, 1}};
  for (int v : {0, 1, 2, 0, 2, 2, 3, 0}) lines.points.push_back({v, v, 0});
  write_lines(s, lines);
  return s;
}

}  // namespace

TEST(shards, keep_the_order_of_line_points_and_what_they_stand_for) {
  const Stream whole = square();
  const ShardNumbers n = number_shard(whole, {1});
  EXPECT_EQ(n.faces, (std::vector<int>{1}));
  EXPECT_EQ(n.vertices, (std::vector<int>{0, 2, 3}));
  // rows 0 and 2, the first at their vertices, are on no line of part 1
  EXPECT_EQ(n.line_points, (std::vector<int>{0, 0, 2, 2, 3, 4, 5, 6, 7}));
  const Lines lines = read_lines(whole);
  const PartLines all(lines, 2), some(n.lines, 1);
  for (std::size_t row = 0; row < n.line_points.size(); ++row)
    EXPECT_EQ(n.line_points[some.point[row]], all.point[n.line_points[row]]);
}

TEST(shards, have_model_lines_that_bound_them_as_borders) {
  const ShardNumbers n = number_shard(square(), {1});
  ASSERT_EQ(n.lines.lines.size(), 4u);
  EXPECT_EQ(n.lines.lines[2].kind, interface_line);
  EXPECT_EQ(n.lines.lines[3].kind, border_line);
  const ShardNumbers both = number_shard(square(), {0, 1});
  EXPECT_EQ(both.line_points.size(), 8u);
}

TEST(shards, are_streams) {
  const Stream whole = square();
  const Stream shard = cut_shard(whole, number_shard(whole, {1}), {1, 0, 0, 1});
  const Stream again = read_stream(write_stream(shard, true), "shard");
  EXPECT_TRUE(is_shard(again));
  EXPECT_EQ(again.surface.face.get<int>("part"), (std::vector<int>{0}));
  EXPECT_EQ(again.find("shard")->get<int>("part"), (std::vector<int>{1}));
  EXPECT_EQ(kept_vertices(again), (std::vector<char>{1, 0, 1}));
  EXPECT_EQ(share_out(whole, 5).size(), 2u);
}

TEST(shards, are_joined_only_with_the_tables_that_theirs_point_to) {
  Stream whole = square();
  for (const char* table : {"line", "line_use", "line_vertex"}) whole.erase(table);
  Stream shard = cut_shard(whole, number_shard(whole, {0, 1}), {});
  shard.history.push_back({"mmesh2d", "1", ""});
  Table points{"chart_point", 0, {}};
  points.set("part", std::vector<int>{0, 1});
  points.set("line_vertex", std::vector<int>{7, 1 << 30});
  shard.set(std::move(points));
  EXPECT_THROW(join_shards(whole, {"a"}, {"mmesh2d", "", ""}, [&](const std::string&) { return shard; }),
               BadInput);
}

TEST(shards, that_lack_a_table_of_the_others_are_named) {
  Stream whole = square();
  std::vector<Stream> shards;
  for (int part : {0, 1}) {
    Stream& shard = shards.emplace_back(cut_shard(whole, number_shard(whole, {part}), {}));
    shard.history.push_back({"mparam", "1", ""});
    Table charts{"chart_vertex", 0, {}};
    charts.set("part", std::vector<int>{0});
    if (part == 0) charts.set("vertex", std::vector<int>{0});
    shard.set(std::move(charts));
  }
  const auto read = [&](const std::string& name) { return shards[name == "b"]; };
  for (const char* lacks : {"column 'vertex'", "table 'chart_vertex'"}) {
    Stream all = whole;
    try {
      join_shards(all, {"a", "b"}, {"mparam", "", ""}, read);
      ADD_FAILURE();
    } catch (const BadInput& e) {
      EXPECT_TRUE(std::string(e.what()).starts_with("b: ")) << e.what();
      EXPECT_NE(std::string(e.what()).find(lacks), std::string::npos) << e.what();
    }
    shards[1].erase("chart_vertex");
  }
}
