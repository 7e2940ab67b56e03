// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/page.h"

#include <gtest/gtest.h>

#include <fstream>

#include "lib/draw/draw.h"

namespace meshpipe {
namespace {

Stream triangle_of(const std::string& patch) {
  Stream stream;
  stream.surface = surface_of({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  stream.surface.face.set("patch", std::vector<int>{7});
  stream.names.push_back({2, 7, patch});
  return stream;
}

int count(const std::string& text, const std::string& word) {
  int n = 0;
  for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) ++n;
  return n;
}

Page page_of(const Stream& stream) {
  Page page;
  page.title = "a <b> & c";
  page.items.push_back(page_item(stream, "x.ply", nullptr));
  return page;
}

TEST(page, escapes_what_names_hold) {
  const std::string plain = html_of(page_of(triangle_of("inlet")));
  const std::string evil = html_of(page_of(triangle_of("</script><script>alert(1)</script>\xff")));
  for (const char* word : {"<script", "</script>"}) EXPECT_EQ(count(plain, word), count(evil, word));
  EXPECT_EQ(evil.find("alert(1)</"), evil.npos);
  EXPECT_NE(evil.find("<title>a &lt;b> &amp; c</title>"), evil.npos);
}

TEST(page, lists_patches_and_the_worst_triangle) {
  const Page page = page_of(triangle_of("inlet"));
  ASSERT_EQ(page.items[0].patches.size(), 1u);
  EXPECT_EQ(page.items[0].patches[0].name, "inlet");
  EXPECT_DOUBLE_EQ(page.items[0].patches[0].area, 0.5);
  ASSERT_EQ(page.items[0].worst.size(), 1u);
  EXPECT_EQ(page.items[0].worst[0].triangle, 0);
  EXPECT_FALSE(page.items[0].contract);
  const auto json = json_of(page);
  EXPECT_EQ(json["results"][0]["patches"][0]["triangles"], 1);
  EXPECT_FALSE(json["results"][0].contains("met"));
}

TEST(page, shows_charts_as_large_as_their_parts) {
  Stream stream = triangle_of("inlet");
  stream.surface.face.set("part", std::vector<int>{0});
  Table part{"part", 0, {}}, chart{"chart_vertex", 0, {}};
  part.set("faces", std::vector<int>{1});
  chart.set("part", std::vector<int>{0, 0, 0});
  chart.set("vertex", std::vector<int>{0, 1, 2});
  chart.set("u", std::vector<double>{0, 8, 0});
  chart.set("v", std::vector<double>{0, 0, 8});
  stream.set(part);
  stream.set(chart);
  const PageItem item = page_item(stream, "x.ply", nullptr);
  ASSERT_EQ(item.meshes.size(), 2u);
  EXPECT_EQ(item.meshes[1].head["kind"], "charts");
  EXPECT_NEAR(item.meshes[1].head["diagonal"], std::sqrt(2.0), 1e-12);
}

TEST(page, says_what_failed) {
  Judgment judgment{parse_contract("kappa=0.9,topology"), {}, {}};
  const Stream stream = triangle_of("inlet");
  judgment.reference = stream.surface;
  judgment.findings = examine(stream.surface, judgment.reference, nullptr, 10);
  Page page;
  page.items.push_back(page_item(stream, "x.ply", &judgment));
  EXPECT_EQ(page.items[0].offending_triangles, std::vector<int>{0});
  EXPECT_EQ(json_of(page)["results"][0]["met"], false);
  const std::string html = html_of(page);
  EXPECT_NE(html.find("The contract is missed: 1 failure."), html.npos);
  EXPECT_NE(html.find("Show triangle 0"), html.npos);
}

TEST(page, packs_the_rows_that_are_not_shown_at_first) {
  Judgment judgment{parse_contract("kappa=0.9"), {}, {}};
  Mesh mesh;
  for (int t = 0; t <= (int)first_rows; ++t) {
    const double x = 2 * t;
    mesh.points.insert(mesh.points.end(), {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}});
    mesh.tris.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  Stream stream;
  stream.surface = surface_of(mesh);
  judgment.reference = stream.surface;
  judgment.findings = examine(stream.surface, judgment.reference, nullptr, 10);
  Page page;
  page.items.push_back(page_item(stream, "x.ply", &judgment));
  const std::string html = html_of(page);
  EXPECT_EQ(page.items[0].offending.size(), first_rows + 1);
  EXPECT_EQ(count(html, "<td>kappa</td>"), (int)first_rows);
  EXPECT_NE(html.find("Show all 101"), html.npos);
  EXPECT_NE(html.find("id=\"rows0\""), html.npos);
}

TEST(page, has_one_scale_of_colors) {
  std::ifstream file(SOURCE_DIR "/tools/report/viewer.js");
  const std::string script{std::istreambuf_iterator<char>(file), {}};
  std::string stops = "const stops = [";
  for (int i = 0; i < 5; ++i) {
    const Color c = scale_color(i / 4.0);
    stops += (i ? ", [" : "[") + std::to_string(c[0]) + ", " + std::to_string(c[1]) + ", " +
             std::to_string(c[2]) + ']';
  }
  EXPECT_NE(script.find(stops + "];"), script.npos) << stops;
  EXPECT_EQ(scale_color(-1), scale_color(0));
  EXPECT_EQ(scale_color(0.125), (Color{64, 42, 112}));
}

TEST(page, reads_times) {
  const auto times = parse_times("mclean 0.5 0,25 1\nkilled\nmtopo 1 2\nmrelax 1 2 3 4\nmcheck 1 2 3\n");
  ASSERT_EQ(times.size(), 2u);
  EXPECT_EQ(times[0].system, 0.25);
  EXPECT_EQ(times[1].program, "mcheck");
}

}  // namespace
}  // namespace meshpipe
