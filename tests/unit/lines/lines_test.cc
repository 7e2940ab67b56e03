// SPDX-License-Identifier: BSD-3-Clause
#include "lib/lines/lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "lib/core/error.h"
#include "lib/core/segments.h"
#include "lib/core/topology.h"
#include "lib/lines/noncrossing.h"
#include "lib/size/size.h"

using namespace meshpipe;

namespace {

const double pi = std::acos(-1.0);

/// A grid of nx by ny squares, two triangles each, vertex j (nx + 1) + i at place(i / nx, j / ny), part by
/// square.
Surface grid(int nx, int ny, const std::function<Vec3(double, double)>& place,
             const std::function<int(int, int)>& part_of, double size) {
  Surface s;
  std::vector<int> part;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) s.points.push_back(place(double(i) / nx, double(j) / ny));
  auto v = [&](int i, int j) { return j * (nx + 1) + i; };
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int p = part_of(i, j);
      if (p < 0) continue;  // a hole
      s.tris.push_back({v(i, j), v(i + 1, j), v(i + 1, j + 1)});
      s.tris.push_back({v(i, j), v(i + 1, j + 1), v(i, j + 1)});
      part.insert(part.end(), 2, p);
    }
  s.vertex.set("size", std::vector<double>(s.points.size(), size));
  s.face.set("part", std::move(part));
  return s;
}

Vec3 flat(double x, double y) { return {x, y, 0}; }

/// Charts of a flat surface: x and y.
std::vector<Chart> flat_charts(const Surface& s, int n_parts) {
  std::vector<Chart> charts;
  for (SubMesh& m : split_by_label(s, s.face.get<int>("part"), n_parts)) {
    std::vector<Vec2> uv;
    for (Vec3 p : m.points) uv.push_back({p.x, p.y});
    Chart c;
    c.mesh = std::move(m);
    c.uv = std::move(uv);
    charts.push_back(std::move(c));
  }
  return charts;
}

Vec3 position(const Surface& s, const LinePoint& p) { return lerp(s.points[p.a], s.points[p.b], p.t); }

double length(const Surface& s, const Lines& lines, int l) {
  const Line& line = lines.lines[l];
  double sum = 0;
  for (int i = 0; i + 1 < line.count + line.closed; ++i)
    sum += norm(position(s, lines.points[line.first + (i + 1) % line.count]) -
                position(s, lines.points[line.first + i]));
  return sum;
}

void set_model_edge(Surface& s, int a, int b) {
  auto& model = s.face.get<std::uint8_t>("model");
  for (int t = 0; t < (int)s.tris.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const int p = s.tris[t][i], q = s.tris[t][(i + 1) % 3];
      if ((p == a && q == b) || (p == b && q == a)) model[t] |= std::uint8_t(1 << i);
    }
}

}  // namespace

TEST(Size, TriangleCountOfTheSizeIsTheCountAskedFor) {
  const double h = size_for_count(2, 1000);
  EXPECT_NEAR(2 / (h * h * std::sqrt(3.0) / 4), 1000, 1e-9);
}

//  o---+---o    a square of side 1 in two parts:
//  |   |   |    border lines break at the corners o and at the ends + of the interface
//  o---+---o
TEST(Lines, BreakAtCornersAndJunctions) {
  const Surface s = grid(
      10, 10, flat, [](int i, int) { return i < 5 ? 0 : 1; }, 0.25);
  const Lines lines = make_lines(s, flat_charts(s, 2));
  ASSERT_EQ(lines.lines.size(), 7u);
  int borders = 0, interfaces = 0;
  double border_length = 0;
  for (int l = 0; l < 7; ++l) {
    const Line& line = lines.lines[l];
    EXPECT_FALSE(line.closed);
    if (line.kind == interface_line) {
      ++interfaces;
      EXPECT_EQ(line.count, 5);
      EXPECT_NEAR(length(s, lines, l), 1, 1e-15);
    } else {
      ++borders;
      border_length += length(s, lines, l);
    }
  }
  EXPECT_EQ(borders, 6);
  EXPECT_EQ(interfaces, 1);
  EXPECT_NEAR(border_length, 4, 1e-14);
  // the interface is used by both parts, the others by one
  EXPECT_EQ(lines.uses.size(), 8u);
  for (std::size_t i = 1; i < lines.uses.size(); ++i)
    EXPECT_TRUE(
        lines.uses[i - 1].line < lines.uses[i].line ||
        (lines.uses[i - 1].line == lines.uses[i].line && lines.uses[i - 1].part < lines.uses[i].part));
}

//  0 <|    a triangle of two degrees: from the first points on, both sides are divided alike, and segments
//  are at
//          most 8 times as long as the triangle is wide there
TEST(Lines, OneTriangleFillsASharpCorner) {
  const double width = 2 * pi / 180;
  Surface s;
  s.points = {{0, 0, 0}, {1, 0, 0}, {1, width, 0}};
  s.tris = {{0, 1, 2}};
  s.vertex.set("size", std::vector<double>(3, 0.1));
  s.face.set("part", std::vector<int>{0});
  const Lines lines = make_lines(s, flat_charts(s, 1));
  ASSERT_EQ(lines.lines.size(), 3u);
  std::vector<std::vector<double>> distances;
  for (const Line& l : lines.lines) {
    std::vector<double>& d = distances.emplace_back();
    for (int i = 0; i < l.count; ++i) d.push_back(norm(position(s, lines.points[l.first + i])));
    std::sort(d.begin(), d.end());
  }
  std::sort(distances.begin(), distances.end());
  ASSERT_GT(distances[0].size(), 8u);
  ASSERT_GT(distances[1].size(), 8u);
  EXPECT_NEAR(distances[0][1], 0.1, 1e-12);
  for (std::size_t i = 1; i < 6; ++i) {
    EXPECT_NEAR(distances[0][i], distances[1][i], 1e-12);
    EXPECT_LT(distances[0][i + 1] - distances[0][i], 8.1 * width * distances[0][i]);
  }
}

//  0 <|    the same where the lower side is also that of another sheet, below: there it is divided alike
TEST(Lines, OneTriangleFillsASharpCornerWhereSheetsMeet) {
  const double width = 2 * pi / 180;
  Surface s;
  s.points = {{0, 0, 0}, {1, 0, 0}, {0.5, -1, 0}, {0, 0, 0}, {1, 0, 0}, {1, width, 0}};
  s.tris = {{0, 2, 1}, {3, 4, 5}};
  s.vertex.set("size", std::vector<double>(6, 0.1));
  s.face.set("part", std::vector<int>{0, 1});
  const Lines lines = make_lines(s, flat_charts(s, 2), nullptr, false, true);
  std::vector<std::vector<double>> lower, upper;  // distances from the corner
  for (const Line& l : lines.lines) {
    std::vector<double> d;
    double lowest = 1, highest = -1;
    for (int i = 0; i < l.count; ++i) {
      const Vec3 p = position(s, lines.points[l.first + i]);
      lowest = std::min(lowest, p.y), highest = std::max(highest, p.y);
      d.push_back(norm(p));
    }
    std::sort(d.begin(), d.end());
    if (lowest == 0 && highest == 0) lower.push_back(d);
    if (lowest == 0 && highest > 0 && d[0] == 0) upper.push_back(d);
  }
  ASSERT_EQ(lower.size(), 2u);
  ASSERT_EQ(upper.size(), 1u);
  EXPECT_EQ(lower[0], lower[1]);
  ASSERT_GT(lower[0].size(), 8u);
  for (std::size_t i = 1; i < 6; ++i) {
    EXPECT_NEAR(lower[0][i], upper[0][i], 1e-12);
    EXPECT_LT(lower[0][i + 1] - lower[0][i], 8.1 * width * lower[0][i]);
  }
}

TEST(Lines, PointsThatFallOnVerticesAreVertices) {
  const Surface s = grid(
      8, 4, flat, [](int, int) { return 0; }, 0.25);
  for (const LinePoint& p : make_lines(s, flat_charts(s, 1)).points) EXPECT_EQ(p.a, p.b) << p.t;
  const Surface r = grid(
      7, 1, flat, [](int, int) { return 0; }, 0.25);
  int inside = 0;
  for (const LinePoint& p : make_lines(r, flat_charts(r, 1)).points) {
    EXPECT_EQ(p.a == p.b, p.t == 0);
    inside += p.a != p.b;
  }
  EXPECT_GT(inside, 6);
}

// h grows linearly from 0.1 to 0.3 over length 1: the integral of 1/h is 5 log 3 = 5.493, and equal shares of
// it are equal ratios of h
TEST(Lines, AreEquidistributedInTheSizeField) {
  Surface s = grid(
      7, 1, flat, [](int, int) { return 0; }, 1);
  for (std::size_t v = 0; v < s.points.size(); ++v)
    s.vertex.get<double>("size")[v] = 0.1 + 0.2 * s.points[v].x;
  const Lines lines = make_lines(s, flat_charts(s, 1));
  const Line* bottom = nullptr;
  for (const Line& l : lines.lines)
    if (position(s, lines.points[l.first]).y == 0 && position(s, lines.points[l.first + l.count - 1]).y == 0)
      bottom = &l;
  ASSERT_TRUE(bottom);
  ASSERT_EQ(bottom->count, 6);
  for (int i = 0; i <= 5; ++i)
    EXPECT_NEAR(position(s, lines.points[bottom->first + i]).x, 0.5 * (std::pow(3, i / 5.0) - 1), 1e-12);
}

//   .--.      a strip bent to an arc, 1.3 sizes long: rounding down would cut the arc off, where one that is
//  '    '     straight is a single segment
TEST(Lines, BendsAreNotCutOff) {
  auto bent = [](double x, double y) {
    const double a = 1.3 * x - 0.65;
    return Vec3{std::sin(a), std::cos(a) + 2 * y, 0};
  };
  auto straight = [](double x, double y) { return Vec3{1.3 * x, 2 * y, 0}; };
  auto segments = [](const Surface& s) {
    const Lines lines = make_lines(s, flat_charts(s, 1));
    std::vector<int> count;
    for (const Line& l : lines.lines) count.push_back(l.count - 1);
    std::sort(count.begin(), count.end());
    return count;
  };
  auto all = [](int, int) { return 0; };
  EXPECT_EQ(segments(grid(20, 20, bent, all, 1)), (std::vector<int>{2, 2, 2, 2}));
  EXPECT_EQ(segments(grid(20, 20, straight, all, 1)), (std::vector<int>{1, 1, 2, 2}));
}

//   .----.    a model edge between two circles: its segments are as long as the size, but where they would be
//  / .--. \   more than h / 16 off it, shorter, and not below 0.8 h
// | (    ) |
TEST(Lines, ModelEdgesFollowTightBends) {
  const double R = 1.5;
  auto ring = [](double a, double r) {
    return Vec3{(2 - r) * std::cos(2 * pi * a), (2 - r) * std::sin(2 * pi * a), 0};
  };
  for (double h : {0.2, 0.5, 1.0, 1.3, 2.0}) {
    Surface s = grid(
        60, 2, ring, [](int, int) { return 0; }, h);
    for (Tri& t : s.tris)
      for (int& v : t)
        if (v % 61 == 60) v -= 60;
    s.face.set("model", std::vector<std::uint8_t>(s.tris.size()));
    for (int i = 0; i < 60; ++i) set_model_edge(s, 61 + i, 61 + (i + 1) % 60);
    const Lines lines = make_lines(s, flat_charts(s, 1));
    const auto model = std::find_if(lines.lines.begin(), lines.lines.end(),
                                    [](const Line& l) { return l.kind == model_line; });
    ASSERT_NE(model, lines.lines.end());
    const double segment = std::clamp(std::sqrt(8 * R * h / 16), 0.8 * h, h);
    EXPECT_NEAR(model->count, 2 * pi * R / segment, 0.6) << h;
  }
}

TEST(Lines, CircleIsClosedAndStartsAtItsSmallestVertex) {
  auto ring = [](double a, double r) {
    return Vec3{(1 + r) * std::cos(2 * pi * a), (1 + r) * std::sin(2 * pi * a), 0};
  };
  for (double h : {0.05, 0.5, 1.0, 30.0}) {
    // an annulus cut open at a = 0 and glued again
    Surface s = grid(
        60, 2, ring, [](int, int) { return 0; }, h);
    for (Tri& t : s.tris)
      for (int& v : t)
        if (v % 61 == 60) v -= 60;
    const Lines lines = make_lines(s, flat_charts(s, 1));
    ASSERT_EQ(lines.lines.size(), 2u) << h;
    for (const Line& l : lines.lines) {
      EXPECT_TRUE(l.closed);
      EXPECT_EQ(lines.points[l.first].a % 61, 0);
    }
    // the inner circle is 60 chords long
    EXPECT_EQ(lines.lines[0].count, std::max(3, (int)std::round(120 * std::sin(pi / 60) / h)));
  }
}

// a scan's border: every vertex turns by more than 40 degrees, but no corner is there at the scale of h
TEST(Lines, ZigZagIsNotBroken) {
  auto jagged = [](double x, double y) {
    const double zig = int(std::round(x * 200)) % 2 ? 0.004 : 0;
    return Vec3{x, y == 0 ? zig : y, 0};
  };
  const Surface s = grid(
      200, 4, jagged, [](int, int) { return 0; }, 0.05);
  const Lines lines = make_lines(s, flat_charts(s, 1));
  EXPECT_EQ(lines.lines.size(), 4u);
}

//  +-------+    an edge inside a part is used by it once, ends where it ends,
//  |  ---  |    and does not break the border
//  +-------+
TEST(Lines, EmbeddedModelEdge) {
  Surface s = grid(
      6, 6, flat, [](int, int) { return 0; }, 0.2);
  s.face.set("model", std::vector<std::uint8_t>(s.tris.size(), 0));
  for (int i = 1; i < 5; ++i) set_model_edge(s, 3 * 7 + i, 3 * 7 + i + 1);
  const Lines lines = make_lines(s, flat_charts(s, 1));
  ASSERT_EQ(lines.lines.size(), 5u);
  EXPECT_EQ(lines.uses.size(), 5u);
  int models = 0;
  for (const Line& l : lines.lines)
    if (l.kind == model_line) {
      ++models;
      EXPECT_EQ(l.count, 4);
    }
  EXPECT_EQ(models, 1);
}

// two parts between two vertices: three lines from the bottom to the top, at most one of a single segment
TEST(Lines, LinesBetweenTheSameEndsDoNotCollapse) {
  auto lens = [](double x, double y) { return Vec3{(x - 0.5) * std::sin(pi * y) * 0.2, y, 0}; };
  Surface s = grid(
      4, 12, lens, [](int i, int) { return i / 2; }, 5);
  // the bottom and the top row are one vertex each
  for (Tri& t : s.tris)
    for (int& v : t) v = v < 5 ? 0 : v >= 60 ? 60 : v;
  Surface clean;
  clean.points = s.points;
  std::vector<int> part;
  for (std::size_t t = 0; t < s.tris.size(); ++t) {
    const Tri& r = s.tris[t];
    if (r[0] == r[1] || r[1] == r[2] || r[2] == r[0]) continue;
    clean.tris.push_back(r);
    part.push_back(s.face.get<int>("part")[t]);
  }
  clean.vertex.set("size", std::vector<double>(s.points.size(), 5));
  clean.face.set("part", part);
  const Lines lines = make_lines(clean, flat_charts(clean, 2));
  ASSERT_EQ(lines.lines.size(), 3u);
  int single = 0;
  for (const Line& l : lines.lines) single += l.count == 2;
  EXPECT_EQ(single, 1);
}

namespace {

/// No two segments meet in a chart, and the border's polygons enclose at least `least` of its area.
void expect_embedded(const std::vector<Chart>& charts, const Lines& lines, int part, double least) {
  const Chart& c = charts[part];
  std::vector<int> local;
  for (int i = 0; i < (int)c.mesh.vertex.size(); ++i) {
    local.resize(std::max<std::size_t>(local.size(), c.mesh.vertex[i] + 1), -1);
    local[c.mesh.vertex[i]] = i;
  }
  std::vector<Segment> segments;
  for (const LineUse& u : lines.uses) {
    if (u.part != part) continue;
    const Line& l = lines.lines[u.line];
    auto end = [&](int i) {
      const LinePoint& p = lines.points[l.first + i % l.count];
      const int key = p.a == p.b ? p.a : 1000000 + l.first + i % l.count;
      return std::pair(lerp(c.uv[local[p.a]], c.uv[local[p.b]], p.t), key);
    };
    for (int i = 0; i + 1 < l.count + l.closed; ++i)
      segments.push_back({end(i).first, end(i + 1).first, end(i).second, end(i + 1).second});
  }
  EXPECT_TRUE(SegmentTree(segments).crossings().empty());
  double area = 0;
  for (const Tri& t : c.mesh.tris) area += 0.5 * cross(c.uv[t[1]] - c.uv[t[0]], c.uv[t[2]] - c.uv[t[0]]);
  // sample: points of the chart inside the polygons, by even-odd rule
  double inside = 0;
  const std::vector<int> weight(segments.size(), 1);
  const SegmentTree tree(segments);
  for (const Tri& t : c.mesh.tris) {
    const Vec2 m = (1.0 / 3) * (c.uv[t[0]] + c.uv[t[1]] + c.uv[t[2]]);
    if (tree.winding(m, weight) % 2 != 0)
      inside += 0.5 * cross(c.uv[t[1]] - c.uv[t[0]], c.uv[t[2]] - c.uv[t[0]]);
  }
  EXPECT_GE(inside, least * area);
}

}  // namespace

// a comb: two interlocking parts whose teeth are far thinner than h; the lines must be refined, not cross
//   +--+ +--+ +--
//   |  | |  | |
//  -+  +-+  +-+
TEST(Lines, AreRefinedUntilTheyDoNotCross) {
  auto wave = [](double x, double y) {
    const double bend = 0.3 * std::sin(6 * pi * x) * std::sin(pi * y);
    return Vec3{x, y + bend * (y - y * y) * 4 * 0.8, 0};
  };
  // a thin band between two borders that follows the wave: part 1 has three rows of twenty
  const Surface s = grid(
      120, 20, wave, [](int, int j) { return j < 9    ? 0
                                             : j < 11 ? 1
                                                      : 2; }, 0.5);
  const auto charts = flat_charts(s, 3);
  const Lines lines = make_lines(s, charts);
  for (int p = 0; p < 3; ++p) expect_embedded(charts, lines, p, 0.4);
  EXPECT_GT(lines.points.size(), 30u);   // the size alone would give 14
  EXPECT_LT(lines.points.size(), 300u);  // the input has 480 on its lines
}

// a hole under an arch of the border: the chord of the arch would leave the hole outside
TEST(Lines, HolesStayInside) {
  auto arch = [](double x, double y) {
    return Vec3{2 * x, y * (1 + 2 * std::max(0.0, std::sin(pi * x) - 0.3)), 0};
  };
  auto holes = [](int i, int j) { return j == 17 && i >= 18 && i < 22 ? -1 : 0; };
  const Surface s = grid(40, 20, arch, holes, 2.5);
  const auto charts = flat_charts(s, 1);
  const Lines lines = make_lines(s, charts);
  expect_embedded(charts, lines, 0, 0.6);
}

// a crescent's chords turn inside out when each arc is a single segment
TEST(Lines, LoopsKeepTheirOrientation) {
  auto crescent = [](double x, double y) {
    const double r = 1 + 0.3 * (y - 0.5) * std::sin(pi * x), a = 1.6 * pi * x;
    return Vec3{r * std::cos(a), -r * std::sin(a), 0};
  };
  const Surface s = grid(
      64, 2, crescent, [](int, int) { return 0; }, 40);
  Surface pinched = s;
  std::vector<Tri> tris;
  for (Tri t : s.tris) {
    for (int& v : t) v = v % 65 == 0 ? 0 : v % 65 == 64 ? 64 : v;
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) tris.push_back(t);
  }
  pinched.tris = tris;
  pinched.face = Table{"face", 0, {}};
  pinched.face.set("part", std::vector<int>(tris.size(), 0));
  const auto charts = flat_charts(pinched, 1);
  double area = 0;
  for (const Tri& t : charts[0].mesh.tris)
    area += cross(charts[0].uv[t[1]] - charts[0].uv[t[0]], charts[0].uv[t[2]] - charts[0].uv[t[0]]);
  ASSERT_GT(area, 0);
  expect_embedded(charts, make_lines(pinched, charts), 0, 0.3);
  pinched.points[64] = pinched.points[0];  // two fans of one vertex: its copies are no edge apart
  for (const Line& l : make_lines(pinched, charts).lines) EXPECT_GE(l.count, 4);
}

// the border of a square in two colors: it ends where the color changes, and the lines have their labels
TEST(Lines, EndWhereTheLabelChanges) {
  const Surface s = grid(
      6, 6, flat, [](int, int) { return 0; }, 0.2);
  const std::vector<int> opposite = opposite_halfedges(s.tris, (int)s.points.size());
  std::vector<int> tag(opposite.size(), 0);
  for (int h = 0; h < (int)tag.size(); ++h)
    if (opposite[h] < 0)
      tag[h] = 0.5 * (s.points[origin(s.tris, h)].x + s.points[target(s.tris, h)].x) < 0.5 ? 3 : 4;
  const Lines lines = make_lines(s, flat_charts(s, 1), &tag);
  ASSERT_EQ(lines.lines.size(), 6u);
  for (const Line& l : lines.lines)
    for (int i = l.first; i < l.first + l.count; ++i) {
      const LinePoint& p = lines.points[i];
      const double x = (1 - p.t) * s.points[p.a].x + p.t * s.points[p.b].x;
      EXPECT_TRUE(l.tag == 3 ? x <= 0.5 : x >= 0.5);
    }
}

TEST(Lines, SaysWhatIsMissing) {
  Surface s = grid(
      2, 2, flat, [](int, int) { return 0; }, 0.2);
  const auto charts = flat_charts(s, 1);
  s.vertex.get<double>("size")[3] = 0;
  EXPECT_THROW(make_lines(s, charts), BadInput);
  s.vertex.erase("size");
  EXPECT_THROW(make_lines(s, charts), NotAdmissible);
}

// the map has a corner of the square far beyond the opposite one
TEST(Lines, LinesThatMeetInAMapAreNamedWithTheirPlace) {
  Surface s = grid(
      2, 2, flat, [](int, int) { return 0; }, 0.2);
  auto charts = flat_charts(s, 1);
  charts[0].uv[0] = {30, 31};
  try {
    make_lines(s, charts);
    ADD_FAILURE() << "not refused";
  } catch (const GoalMissed& e) {
    EXPECT_NE(
        std::string(e.what()).find("lines 0 and 2 meet in the map of part 0, the first begins at (0 0 0)"),
        std::string::npos)
        << e.what();
  }
}

// Doubles near 1e14 are 1/64 apart, 16 of them a quarter.
TEST(Lines, RefusesSizesBelowTheSpacingOfCoordinates) {
  const Mesh mesh{{{1e14, 0, 0}, {1e14 + 1, 0, 0}, {1e14, 1, 0}}, {{0, 1, 2}}};
  EXPECT_NO_THROW(refuse_unresolved_sizes(mesh, {0.25, 0.25, 0.25}));
  EXPECT_NO_THROW(refuse_unresolved_sizes(mesh, {1, -1, 1}));
  try {
    refuse_unresolved_sizes(mesh, {1, 0.2, 1});
    ADD_FAILURE() << "not refused";
  } catch (const GoalMissed& e) {
    EXPECT_NE(std::string(e.what()).find("vertex 1 has size 0.2, but coordinates there are 0.015625 apart"),
              std::string::npos)
        << e.what();
  }
}
