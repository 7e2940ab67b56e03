// SPDX-License-Identifier: BSD-3-Clause
#include "lib/mesh2d/mesh2d.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "lib/core/cdt.h"
#include "lib/core/error.h"
#include "lib/core/predicates.h"
#include "lib/core/topology.h"
#include "lib/mesh2d/plane_metric.h"
#include "lib/mesh2d/refine.h"

using namespace meshpipe;

namespace {

using Map3 = std::function<Vec3(Vec2)>;
const Map3 flat = [](Vec2 p) { return Vec3{p.x, p.y, 0}; };

// A chart over the squares (i, j) of an n x m grid that `keep` wants, with corners at place(i, j).
Chart grid_chart(int n, int m, std::function<Vec2(int, int)> place, std::function<bool(int, int)> keep,
                 Map3 lift, bool round = false) {
  Mesh mesh;
  std::vector<Vec2> uv;
  int columns = round ? n : n + 1;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i < columns; ++i) uv.push_back(place(i, j));
  for (Vec2 p : uv) mesh.points.push_back(lift(p));
  auto id = [&](int i, int j) { return j * columns + i % columns; };
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i)
      if (keep(i, j)) {
        mesh.tris.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
        mesh.tris.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
      }
  Chart chart;
  chart.mesh = split_by_label(mesh, std::vector<int>(mesh.tris.size(), 0), 1)[0];
  for (int v : chart.mesh.vertex) chart.uv.push_back(uv[v]);
  index_chart(chart);
  return chart;
}

Chart square(int n, Map3 lift = flat) {
  return grid_chart(
      n, n,
      [=](int i, int j) {
        return Vec2{(double)i / n, (double)j / n};
      },
      [](int, int) { return true; }, lift);
}

Chart annulus(int n, int m, double inner, Map3 lift = flat) {
  return grid_chart(
      n, m,
      [=](int i, int j) {
        double r = 1 + (inner - 1) * j / m, a = 2 * M_PI * i / n;
        return Vec2{r * cos(a), r * sin(a)};
      },
      [](int, int) { return true; }, lift, true);
}

// Divides a chain of chart vertices (closed: the first is not repeated) into n segments of equal length in
// space.
void add_line(Lines& lines, const Chart& chart, std::vector<int> chain, int kind, bool closed, double h) {
  if (closed) chain.push_back(chain[0]);
  std::vector<double> at{0};
  for (std::size_t i = 1; i < chain.size(); ++i)
    at.push_back(at.back() + norm(chart.mesh.points[chain[i]] - chart.mesh.points[chain[i - 1]]));
  int n = std::max(closed ? 3 : 1, (int)std::lround(at.back() / h)), first = (int)lines.points.size();
  std::size_t e = 0;
  for (int k = 0; k < n + !closed; ++k) {
    double s = at.back() * k / n;
    while (e + 2 < at.size() && at[e + 1] <= s) ++e;
    double t = (s - at[e]) / (at[e + 1] - at[e]);
    int a = chart.mesh.vertex[chain[e]], b = chart.mesh.vertex[chain[e + 1]];
    if (t < 1e-9) b = a;
    if (t > 1 - 1e-9) a = b;
    lines.points.push_back({a, b, a == b ? 0 : t});
  }
  lines.uses.push_back({(int)lines.lines.size(), 0});
  lines.lines.push_back({kind, 0, first, n + !closed, closed});
}

// The border loops, broken where they turn by more than 30 degrees, and at the vertices `breaks`.
Lines border_lines(const Chart& chart, double h, const std::vector<int>& breaks = {}) {
  Lines lines;
  for (const auto& loop : boundary_loops(chart.opposite)) {
    std::vector<int> v;
    for (int e : loop) v.push_back(origin(chart.mesh.tris, e));
    int n = (int)v.size();
    std::vector<int> corners;
    for (int i = 0; i < n; ++i) {
      Vec3 d = chart.mesh.points[v[i]] - chart.mesh.points[v[(i + n - 1) % n]],
           e = chart.mesh.points[v[(i + 1) % n]] - chart.mesh.points[v[i]];
      if (angle(d, e) > M_PI / 6 || std::count(breaks.begin(), breaks.end(), v[i])) corners.push_back(i);
    }
    if (corners.empty()) {
      add_line(lines, chart, v, border_line, true, h);
      continue;
    }
    for (std::size_t c = 0; c < corners.size(); ++c) {
      int to = c + 1 < corners.size() ? corners[c + 1] : corners[0] + n;
      std::vector<int> chain;
      for (int i = corners[c]; i <= to; ++i) chain.push_back(v[i % n]);
      add_line(lines, chart, chain, border_line, false, h);
    }
  }
  return lines;
}

int vertex_at(const Chart& chart, Vec2 p) {
  int best = 0;
  for (std::size_t v = 0; v < chart.uv.size(); ++v)
    if (norm(chart.uv[v] - p) < norm(chart.uv[best] - p)) best = (int)v;
  return best;
}

struct Figures {
  double area = 0, area_uv = 0, kappa_mean = 0, kappa_min = 1, edge_mean = 0, edge_min = 1e300, edge_max = 0;
};

// Checks what mesh_chart promises, and measures the result in space through `lift`.
Figures examine(const PlaneMesh& mesh, const Lines& lines, const Map3& lift) {
  Figures f;
  std::set<std::pair<int, int>> edges;
  std::map<int, int> vertex_of_row;
  std::map<int, int> row_of_surface_vertex;
  for (std::size_t r = 0; r < lines.points.size(); ++r)
    if (lines.points[r].a == lines.points[r].b) row_of_surface_vertex.insert({lines.points[r].a, (int)r});
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    if (mesh.points[v].line_point >= 0) vertex_of_row[mesh.points[v].line_point] = (int)v;
  std::vector<Vec2> uv;
  for (const ChartPoint& p : mesh.points) uv.push_back(p.uv);
  for (const Tri& t : mesh.tris) {
    EXPECT_EQ(orient2d(uv[t[0]], uv[t[1]], uv[t[2]]), 1);
    f.area_uv += 0.5 * cross(uv[t[1]] - uv[t[0]], uv[t[2]] - uv[t[0]]);
    Vec3 x[3] = {lift(uv[t[0]]), lift(uv[t[1]]), lift(uv[t[2]])};
    f.area += 0.5 * norm(area_vector(x[0], x[1], x[2]));
    double k = kappa(x[0], x[1], x[2]);
    f.kappa_mean += k / mesh.tris.size();
    f.kappa_min = std::min(f.kappa_min, k);
    for (int i = 0; i < 3; ++i) {
      edges.insert({std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])});
      double l = norm(x[(i + 1) % 3] - x[i]);
      f.edge_mean += l / (3.0 * mesh.tris.size());
      f.edge_min = std::min(f.edge_min, l);
      f.edge_max = std::max(f.edge_max, l);
    }
  }
  EXPECT_NO_THROW(opposite_halfedges(mesh.tris, (int)uv.size()));
  for (const Line& l : lines.lines)
    for (int k = 0; k < l.count - !l.closed; ++k) {
      int ends[2] = {l.first + k, l.first + (k + 1) % l.count};
      for (int& e : ends) {
        const LinePoint& p = lines.points[e];
        if (p.a == p.b) e = row_of_surface_vertex[p.a];
        EXPECT_TRUE(vertex_of_row.count(e));
        e = vertex_of_row[e];
      }
      EXPECT_TRUE(edges.count({std::min(ends[0], ends[1]), std::max(ends[0], ends[1])})) << "segment " << k;
    }
  return f;
}

PlaneMesh mesh_with(const Chart& chart, const Lines& lines, double h, Mesher mesher = Mesher::frontal) {
  return mesh_chart(chart, std::vector<double>(chart.uv.size(), h), PartLines(lines, 1), 0, mesher);
}

constexpr Mesher all_meshers[] = {Mesher::frontal, Mesher::delaunay, Mesher::meshadapt};

double count_of(double area, double h) { return area / (std::sqrt(3.0) / 4 * h * h); }

}  // namespace

//  3-------2    two crossing diagonals; a segment through a vertex
//  | \   / |
//  |   4   |
//  | /   \ |
//  0-------1
TEST(Cdt, KeepsSegmentsAndRefusesCrossings) {
  std::vector<Vec2> corners{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  std::vector<FixedEdge> frame{{0, 1, true}, {1, 2, true}, {2, 3, true}, {3, 0, true}};
  auto with = [&](std::vector<Vec2> p, std::vector<FixedEdge> more) {
    std::vector<FixedEdge> s = frame;
    s.insert(s.end(), more.begin(), more.end());
    return Cdt(p, s);
  };
  EXPECT_EQ(Cdt(corners, frame).tris.size(), 2u);
  EXPECT_THROW(with(corners, {{0, 2, false}, {1, 3, false}}), GoalMissed);
  std::vector<Vec2> five = corners;
  five.push_back({0.5, 0.5});
  EXPECT_THROW(with(five, {{0, 2, false}}), GoalMissed);
  EXPECT_EQ(with(five, {{0, 4, false}, {4, 2, false}}).tris.size(), 4u);
  EXPECT_THROW(Cdt(corners, {{0, 1, true}, {1, 2, true}, {2, 3, true}}), GoalMissed);
  five[4] = {0, 0};
  EXPECT_THROW(with(five, {}), GoalMissed);
  five[4] = {2, 2};
  EXPECT_THROW(with(five, {}), GoalMissed);
}

// A comb whose long teeth force many flips; the hole of a frame is left out.
TEST(Cdt, RecoversLongSegmentsAndCarvesHoles) {
  std::vector<Vec2> p;
  std::vector<FixedEdge> s;
  int teeth = 40;
  for (int i = 0; i < teeth; ++i) {
    p.push_back({(double)i, 0.0});
    p.push_back({i + 0.5, 100.0 + i % 3});
  }
  p.push_back({teeth + 0.0, -1});
  p.push_back({-1, -1});
  int n = (int)p.size();
  for (int i = 0; i < n; ++i) s.push_back({i, (i + 1) % n, true});
  Cdt comb(p, s);
  EXPECT_EQ(comb.tris.size(), n - 2u);
  for (const Tri& t : comb.tris) EXPECT_EQ(orient2d(p[t[0]], p[t[1]], p[t[2]]), 1);

  std::vector<Vec2> q{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {1, 1}, {3, 1}, {3, 3}, {1, 3}};
  std::vector<FixedEdge> frame;
  for (int k : {0, 4})
    for (int i = 0; i < 4; ++i) frame.push_back({k + i, k + (i + 1) % 4, true});
  Cdt hole(q, frame);
  double area = 0;
  for (const Tri& t : hole.tris) area += 0.5 * cross(q[t[1]] - q[t[0]], q[t[2]] - q[t[0]]);
  EXPECT_DOUBLE_EQ(area, 12);
  EXPECT_EQ(hole.tris.size(), 8u);
}

//   4---3    the inner vertices collapse one after the other until two triangles are left
//   |\\ /|    (drawn with one inner vertex)
//   | 5 |
//   |/ \\|
//   1---2
TEST(Cdt, CollapsesInnerVerticesOntoOthers) {
  std::vector<Vec2> p{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  std::vector<FixedEdge> frame{{0, 1, true}, {1, 2, true}, {2, 3, true}, {3, 0, true}};
  for (int i = 0; i < 60; ++i) p.push_back({0.05 + 0.9 * std::fmod(0.618 * i, 1), 0.05 + 0.9 * i / 60});
  Cdt cdt(p, frame);
  for (int h = 0; h < 3 * (int)cdt.tris.size(); ++h)
    EXPECT_FALSE(cdt.can_collapse(h) && (cdt.origin(h) < 4 || cdt.fixed[h]));
  std::size_t left = cdt.tris.size();
  for (bool any = true; any;) {
    any = false;
    for (int h = 0; h < 3 * (int)cdt.tris.size() && !any; ++h) {
      if (!cdt.can_collapse(h)) continue;
      cdt.collapse(h);
      any = true;
      left -= 2;
      ASSERT_EQ(cdt.tris.size(), left);
      EXPECT_EQ(cdt.opposite, opposite_halfedges(cdt.tris, 64));
      for (const Tri& t : cdt.tris) EXPECT_EQ(orient2d(p[t[0]], p[t[1]], p[t[2]]), 1);
      for (int v = 0; v < 64; ++v) {
        const int t = cdt.at[v];
        EXPECT_TRUE(t < 0 || std::count(cdt.tris[t].begin(), cdt.tris[t].end(), v) == 1);
      }
    }
  }
  EXPECT_EQ(left, 2u);
}

TEST(PlaneMetric, FrameUndoesTheLogarithm) {
  // the map (u, v) -> (3 u, v, 2 u) has M = [13 0; 0 1]; sheared by v -> u + v the off-diagonal is not zero
  for (double shear : {0.0, 1.0, -2.0}) {
    Chart chart = square(4, [&](Vec2 p) { return Vec3{3 * p.x, p.y + shear * p.x, 2 * p.x}; });
    std::vector<double> size(chart.uv.size(), 0.5);
    SizeMetric field(chart, size);
    MetricFactor f = factor_of(field.at({3, 0.2, 0.3, 0.5}).metric);
    for (Vec2 d : {Vec2{1, 0}, Vec2{0, 1}, Vec2{1, 1}, Vec2{2, -1}}) {
      double l = norm(Vec3{3 * d.x, d.y + shear * d.x, 2 * d.x}) / 0.5;
      EXPECT_NEAR(norm(f.to(d)), l, 1e-12 * l);
      EXPECT_NEAR(norm(f.back(f.to(d)) - d), 0, 1e-12);
    }
  }
}

TEST(Mesh2d, FlatSquareHasTheCountItsSizeAsksFor) {
  Chart chart = square(10);
  for (double h : {0.05, 0.02}) {
    Lines lines = border_lines(chart, h);
    PlaneMesh mesh = mesh_with(chart, lines, h);
    Figures f = examine(mesh, lines, flat);
    EXPECT_NEAR(f.area_uv, 1, 1e-12);
    EXPECT_NEAR(mesh.tris.size() / count_of(1, h), 1, 0.03);
    EXPECT_GT(f.kappa_mean, 0.95);
    EXPECT_GT(f.kappa_min, 0.5);
    EXPECT_NEAR(f.edge_mean / h, 1, 0.05);
  }
}

// What every mesher promises, flat, curved, sheared and with holes; the frontal one makes the best triangles.
TEST(Mesh2d, AllMeshersMeetSizeAndShape) {
  const Map3 shear = [](Vec2 p) { return Vec3{4 * p.x + 1.5 * p.y, p.y, 0}; };
  const Map3 dome = [](Vec2 p) { return Vec3{p.x, p.y, 1.5 * (p.x * p.x + p.y * p.y)}; };
  struct Case {
    Chart chart;
    Map3 lift;
    double h;
  };
  const Case cases[] = {{square(10), flat, 0.03},
                        {square(10, shear), shear, 0.06},
                        {annulus(60, 6, 0.3), flat, 0.05},
                        {annulus(120, 40, 0.02, dome), dome, 0.06}};
  for (Mesher mesher : all_meshers)
    for (const Case& c : cases) {
      SCOPED_TRACE((int)mesher);
      Lines lines = border_lines(c.chart, c.h);
      PlaneMesh mesh = mesh_with(c.chart, lines, c.h, mesher);
      Figures f = examine(mesh, lines, c.lift);
      EXPECT_GT(f.kappa_mean, mesher == Mesher::frontal ? 0.965 : 0.945);
      EXPECT_GT(f.kappa_min, 0.3);
      EXPECT_NEAR(f.edge_mean / c.h, 1, 0.05);
      EXPECT_NEAR(mesh.tris.size() / count_of(total_area(c.chart.mesh), c.h), 1, 0.08);
    }
}

TEST(Mesh2d, FewVerticesAreIrregularUnlessMostAreNearLines) {
  auto irregular = [](double h) {
    const Chart chart = annulus(60, 20, 0.2);
    const PlaneMesh mesh = mesh_with(chart, border_lines(chart, h), h);
    std::vector<int> valence(mesh.points.size());
    for (const Tri& t : mesh.tris)
      for (int v : t) ++valence[v];
    int inside = 0, count = 0;
    for (std::size_t v = 0; v < valence.size(); ++v)
      if (mesh.points[v].line_point < 0) ++inside, count += valence[v] != 6;
    return (double)count / inside;
  };
  EXPECT_LT(irregular(0.02), 0.1);
  EXPECT_GT(irregular(0.1), 0.1);  // rows from both borders meet everywhere
}

// Doubles near 1e12 are 1.2e-4 apart: 8 times that is too little for a size, 400 times is not.
TEST(Mesh2d, RefusesSizesThatTheMapDoesNotResolve) {
  Chart chart = square(10);
  const Lines lines = border_lines(chart, 0.05);
  for (Vec2& p : chart.uv) p = p + Vec2{1e12, 0};
  index_chart(chart);
  EXPECT_GT(mesh_with(chart, lines, 0.05).tris.size(), 800u);
  try {
    mesh_with(chart, lines, 0.001);
    ADD_FAILURE() << "not refused";
  } catch (const GoalMissed& e) {
    EXPECT_NE(std::string(e.what()).find("size 0.001, but points of the map are 0.000122"), std::string::npos)
        << e.what();
  }
}

// The bound that ends a meshing whose points would not.
TEST(Mesh2d, RefusesMorePointsThanTheBound) {
  const Chart chart = square(4);
  const std::vector<double> size(chart.uv.size(), 0.05);
  const SizeMetric field(chart, size);
  const std::vector<Vec2> corners{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  std::vector<Site> site;
  for (Vec2 p : corners) site.push_back(field.at(p, 0));
  SiteMesh mesh{Cdt(corners, {{0, 1, true}, {1, 2, true}, {2, 3, true}, {3, 0, true}}), site, 4, 50, {}};
  EXPECT_THROW(refine_delaunay(mesh, field), GoalMissed);
  EXPECT_EQ(mesh.cdt.points.size(), 50u);
}

TEST(Mesh2d, ScaleDoesNotMatter) {
  Chart chart = square(10);
  Lines lines = border_lines(chart, 0.05);
  double count = (double)mesh_with(chart, lines, 0.05).tris.size();
  for (double s : {std::ldexp(1, -23), std::ldexp(1, 20)}) {
    Chart scaled = chart;
    for (Vec3& p : scaled.mesh.points) p = s * p;
    for (Vec2& p : scaled.uv) p = s * p;
    EXPECT_NEAR((double)mesh_with(scaled, lines, s * 0.05).tris.size() / count, 1, 0.02);
  }
}

TEST(Mesh2d, AnnulusAndReentrantCorner) {
  Chart ring = annulus(60, 6, 0.3);
  Lines lines = border_lines(ring, 0.05);
  ASSERT_EQ(lines.lines.size(), 2u);
  PlaneMesh mesh = mesh_with(ring, lines, 0.05);
  Figures f = examine(mesh, lines, flat);
  EXPECT_GT(f.kappa_mean, 0.95);
  EXPECT_GT(f.kappa_min, 0.5);
  EXPECT_NEAR(mesh.tris.size() / count_of(f.area, 0.05), 1, 0.04);

  Chart bracket = grid_chart(
      8, 8,
      [](int i, int j) {
        return Vec2{i / 8.0, j / 8.0};
      },
      [](int i, int j) { return i < 4 || j < 4; }, flat);
  lines = border_lines(bracket, 0.04);
  EXPECT_EQ(lines.lines.size(), 6u);
  f = examine(mesh_with(bracket, lines, 0.04), lines, flat);
  EXPECT_NEAR(f.area_uv, 0.75, 1e-12);
  EXPECT_GT(f.kappa_mean, 0.95);
  EXPECT_GT(f.kappa_min, 0.4);
}

//  +-----------+   a dangling crease, a closed one, and one from the border to a junction of three
//  |  --    _  |
//  |       |_| |
//  |----<      |
//  +-----------+
TEST(Mesh2d, EmbeddedLinesAreEdges) {
  int n = 20;
  Chart chart = square(n);
  auto v = [&](int i, int j) { return vertex_at(chart, {(double)i / n, (double)j / n}); };
  double h = 0.033;
  Lines lines = border_lines(chart, h, {v(0, 6)});
  std::vector<int> dangling, stem, up, down, loop;
  for (int i = 3; i <= 9; ++i) dangling.push_back(v(i, 16));
  for (int i = 0; i <= 6; ++i) stem.push_back(v(i, 6));
  for (int i = 0; i <= 4; ++i) up.push_back(v(6 + i, 6 + i));
  for (int i = 0; i <= 4; ++i) down.push_back(v(6 + i, 6));
  for (int i = 0; i < 4; ++i) loop.push_back(v(13 + i, 10));
  for (int i = 0; i < 4; ++i) loop.push_back(v(17, 10 + i));
  for (int i = 0; i < 4; ++i) loop.push_back(v(17 - i, 14));
  for (int i = 0; i < 4; ++i) loop.push_back(v(13, 14 - i));
  for (const auto& chain : {dangling, stem, up, down}) add_line(lines, chart, chain, model_line, false, h);
  add_line(lines, chart, loop, model_line, true, h);
  for (Mesher mesher : all_meshers) {
    PlaneMesh mesh = mesh_with(chart, lines, h, mesher);
    Figures f = examine(mesh, lines, flat);
    EXPECT_NEAR(f.area_uv, 1, 1e-12);
    EXPECT_GT(f.kappa_mean, 0.93);
    EXPECT_GT(f.kappa_min, 0.25);
  }
}

TEST(Mesh2d, JudgesInSpaceUnderAShearedAndStretchedMap) {
  Map3 lift = [](Vec2 p) { return Vec3{4 * p.x + 1.5 * p.y, p.y, 0}; };
  Chart chart = square(10, lift);
  Lines lines = border_lines(chart, 0.07);
  PlaneMesh mesh = mesh_with(chart, lines, 0.07);
  Figures f = examine(mesh, lines, lift);
  EXPECT_NEAR(f.area, 4, 1e-12);
  EXPECT_GT(f.kappa_mean, 0.95);
  EXPECT_NEAR(mesh.tris.size() / count_of(4, 0.07), 1, 0.04);
}

// A tall cap mapped flat: the metric changes by 20 along a radius, and is 10 : 1 at the rim.
TEST(Mesh2d, FollowsAStronglyGradedMetric) {
  Map3 lift = [](Vec2 p) { return Vec3{p.x, p.y, 5 * (p.x * p.x + p.y * p.y)}; };
  Chart chart = annulus(120, 40, 0.02, lift);
  Lines lines = border_lines(chart, 0.1);
  PlaneMesh mesh = mesh_with(chart, lines, 0.1);
  Figures f = examine(mesh, lines, lift);
  EXPECT_GT(f.kappa_mean, 0.96);
  EXPECT_GT(f.kappa_min, 0.3);
  EXPECT_NEAR(mesh.tris.size() / count_of(total_area(chart.mesh), 0.1), 1, 0.1);
}

// A cylinder six diameters long, mapped to a ring conformally: areas differ by 1e6 over the chart, and it has
// two hundred holes much smaller than the size.
TEST(Mesh2d, MeetsSizeAtAMillionfoldAreaScaleWithSmallHoles) {
  const double height = std::log(1e3);
  const Map3 lift = [](Vec2 p) { return Vec3{p.x / norm(p), p.y / norm(p), std::log(norm(p))}; };
  const int n = 120, m = 132;
  Chart chart = grid_chart(
      n, m,
      [=](int i, int j) {
        const double r = std::exp(-height * j / m), a = 2 * M_PI * i / n;
        return Vec2{r * cos(a), r * sin(a)};
      },
      [](int i, int j) { return i % 8 != 3 || j % 10 != 4; }, lift, true);
  const double h = 0.25;
  Lines lines = border_lines(chart, h);
  EXPECT_GT(lines.lines.size(), 190u);
  for (Mesher mesher : all_meshers) {
    SCOPED_TRACE((int)mesher);
    Figures f = examine(mesh_with(chart, lines, h, mesher), lines, lift);
    EXPECT_NEAR(f.area / total_area(chart.mesh), 1, 0.03);
    EXPECT_LT(f.edge_max, 2 * h);
    EXPECT_GT(f.kappa_mean, 0.65);
  }
}

// A ball on a neck whose border is much shorter than an edge: what is near in space is far in the chart.
TEST(Mesh2d, FillsABallBehindANarrowBorder) {
  // the stereographic image of the unit sphere down to 0.05 round its south pole
  const Map3 lift = [](Vec2 p) {
    const double s = 2 / (1 + dot(p, p));
    return Vec3{s * p.x, s * p.y, s - 1};
  };
  Chart chart = grid_chart(
      40, 40,
      [](int i, int j) {
        // the square's rings as circles, ever farther apart
        const double x = (i - 20) / 20.0, y = (j - 20) / 20.0, ring = std::max(std::abs(x), std::abs(y));
        const double r = std::tan(0.5 * M_PI * ring * 0.968), l = std::hypot(x, y);
        return ring > 0 ? Vec2{r * x / l, r * y / l} : Vec2{};
      },
      [](int, int) { return true; }, lift);
  const auto loops = boundary_loops(chart.opposite);
  ASSERT_EQ(loops.size(), 1u);
  std::vector<int> loop;
  for (int e : loops[0]) loop.push_back(origin(chart.mesh.tris, e));
  for (double h : {0.3, 1.0, 1.5}) {
    Lines lines;
    add_line(lines, chart, loop, border_line, true, h);
    for (Mesher mesher : all_meshers) {
      if (h > 1 && mesher == Mesher::meshadapt) continue;  // it collapses short edges again, as at the neck
      SCOPED_TRACE((int)mesher);
      Figures f = examine(mesh_with(chart, lines, h, mesher), lines, lift);
      EXPECT_GT(f.area, (h <= 1 ? 0.5 : 0.25) * total_area(chart.mesh));
      EXPECT_GT(f.area, h < 0.5 ? 0.95 * total_area(chart.mesh) : 0);
      EXPECT_LT(f.edge_max, 2 * h);
    }
  }
}

TEST(Mesh2d, HasTheVerticesThatAreKept) {
  const Chart chart = square(20);
  const Lines lines = border_lines(chart, 0.1);
  std::vector<char> keep(chart.mesh.vertex.size(), 0);
  std::vector<Vec2> wanted;
  for (int v = 0; v < (int)chart.uv.size(); v += 37) {
    keep[chart.mesh.vertex[v]] = 1;
    const Vec2 p = chart.uv[v];
    if (std::min({p.x, p.y, 1 - p.x, 1 - p.y}) > 0) wanted.push_back(p);
  }
  ASSERT_GT(wanted.size(), 5u);
  for (Mesher mesher : all_meshers) {
    const PlaneMesh mesh =
        mesh_chart(chart, std::vector<double>(chart.uv.size(), 0.1), PartLines(lines, 1), 0, mesher, keep);
    examine(mesh, lines, flat);
    for (Vec2 p : wanted)
      EXPECT_TRUE(std::any_of(mesh.points.begin(), mesh.points.end(),
                              [&](const ChartPoint& q) { return norm(q.uv - p) == 0; }));
  }
}

//  a sheet whose left and right borders are at the same place, as those of a pocket: no edge between them,
//  and none along one of their segments
TEST(Mesh2d, KeepsPocketsOpen) {
  const Map3 pocket = [](Vec2 p) {
    return Vec3{0.1 * std::abs(p.x - 0.5), p.y, 0.05 * std::sin(M_PI * p.x)};
  };
  const Chart chart = square(20, pocket);
  for (double h : {0.5, 1.0}) {
    const Lines lines = border_lines(chart, h);
    for (Mesher mesher : all_meshers) {
      const PlaneMesh mesh = mesh_with(chart, lines, h, mesher);
      examine(mesh, lines, pocket);
      for (std::size_t e = 0; e < mesh.opposite.size(); ++e) {
        const Vec2 a = mesh.points[origin(mesh.tris, (int)e)].uv,
                   b = mesh.points[target(mesh.tris, (int)e)].uv;
        EXPECT_FALSE(!mesh.on_line[e] && a.x == 0 && b.x == 1 && std::abs(a.y - b.y) < 1.5 * h)
            << h << ": " << a.y << " to " << b.y;
      }
    }
  }
}

TEST(Mesh2d, FollowsAGradedSize) {
  Chart chart = square(20);
  std::vector<double> size;
  for (Vec2 p : chart.uv) size.push_back(0.01 + 0.06 * p.x);
  // the lines have the finest size throughout, so the mesh must coarsen from them without crowding
  Lines lines = border_lines(chart, 0.03);
  PlaneMesh mesh = mesh_chart(chart, size, PartLines(lines, 1), 0);
  Figures f = examine(mesh, lines, flat);
  EXPECT_GT(f.kappa_mean, 0.9);
  EXPECT_NEAR(f.area_uv, 1, 1e-12);
}

TEST(Mesh2d, RefusesLinesThatDoNotCloseOrAreElsewhere) {
  Chart chart = square(4);
  Lines lines = border_lines(chart, 0.2);
  lines.uses.pop_back();
  try {
    mesh_with(chart, lines, 0.2);
    FAIL();
  } catch (const GoalMissed& e) {
    EXPECT_EQ(std::string(e.what()).find("part 0: "), 0u) << e.what();
  }
  lines = border_lines(chart, 0.2);
  lines.points[1] = {1000, 1000, 0};
  EXPECT_THROW(mesh_with(chart, lines, 0.2), NotAdmissible);
}
