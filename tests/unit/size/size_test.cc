// SPDX-License-Identifier: BSD-3-Clause
#include "lib/size/size.h"

#include <gtest/gtest.h>

#include <cmath>

#include "formats/foreign/size_table.h"
#include "lib/core/chart.h"
#include "lib/core/error.h"
#include "lib/core/split_edges.h"
#include "lib/core/topology.h"
#include "lib/feature/feature.h"
#include "lib/numeric/expression.h"
#include "lib/shape/shape.h"
#include "lib/size/local_feature_size.h"

using namespace meshpipe;

namespace {

//   3---2    a unit square, one part, with its chart
//   |  /|
//   | / |
//   |/  |
//   0---1
Surface square() {
  Surface s;
  s.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  s.tris = {{0, 1, 2}, {0, 2, 3}};
  s.vertex.set("size", std::vector<double>{1, 2, 3, 4});
  s.vertex.set("ref", std::vector<int>{10, 11, 12, 13});
  s.face.set("part", std::vector<int>{0, 1});
  s.face.set("model", std::vector<std::uint8_t>{1, 0});  // 0-1
  return s;
}

/// Both triangles are charts of their own, the second shifted by 5.
Table charts_of_square() {
  Table t{"chart_vertex", 0, {}};
  t.set("part", std::vector<int>{0, 0, 0, 1, 1, 1});
  t.set("vertex", std::vector<int>{0, 1, 2, 0, 2, 3});
  t.set("u", std::vector<double>{0, 1, 1, 5, 6, 5});
  t.set("v", std::vector<double>{0, 0, 1, 0, 1, 1});
  return t;
}

std::vector<double> curvature_of(const Mesh& m) {
  const std::vector<int> opposite = opposite_halfedges(m.tris, (int)m.points.size());
  return face_curvature({m, opposite});
}

void expect_graded(const Mesh& m, const std::vector<double>& h, double slope) {
  for (const Tri& t : m.tris)
    for (int i = 0; i < 3; ++i) {
      const double l = norm(m.points[t[i]] - m.points[t[(i + 1) % 3]]);
      ASSERT_LE(h[t[i]], h[t[(i + 1) % 3]] + slope * l * (1 + 1e-12));
    }
}

}  // namespace

TEST(SplitEdges, SplitsAnEdgeOnBothSides) {
  Surface s = square();
  Table charts = charts_of_square();
  auto opposite = opposite_halfedges(s.tris, 4);
  std::vector<char> mark(6, 0);
  mark[2] = 1;  // 2-0
  const std::vector<int> parent = split_edges({s, opposite}, mark, &charts);
  EXPECT_EQ(parent, (std::vector<int>{0, 0, 1, 1}));
  ASSERT_EQ(s.points.size(), 5u);
  EXPECT_EQ(s.points[4], (Vec3{0.5, 0.5, 0}));
  EXPECT_EQ(s.vertex.get<double>("size")[4], 2);
  EXPECT_EQ(s.vertex.get<int>("ref")[4], 10);
  EXPECT_EQ(s.face.get<int>("part"), (std::vector<int>{0, 0, 1, 1}));
  EXPECT_DOUBLE_EQ(total_area(s), 1);
  ASSERT_EQ(charts.rows, 8u);  // the new vertex is in both charts
  EXPECT_EQ(make_charts(s, charts, 2).size(), 2u);
  int bits = 0;
  for (std::size_t t = 0; t < 4; ++t)
    for (int i = 0; i < 3; ++i)
      if (s.face.get<std::uint8_t>("model")[t] >> i & 1) {
        ++bits;
        EXPECT_EQ(s.tris[t][i] + s.tris[t][(i + 1) % 3], 1);  // still the edge 0-1
      }
  EXPECT_EQ(bits, 1);
}

// every set of marks leaves the same area, the same orientation and a manifold
TEST(SplitEdges, EveryPattern) {
  for (int marks = 1; marks < 32; ++marks) {
    Surface s = square();
    Table charts = charts_of_square();
    auto opposite = opposite_halfedges(s.tris, 4);
    const int edges[5] = {0, 1, 2, 4, 5};
    std::vector<char> mark(6, 0);
    int n = 0;
    for (int k = 0; k < 5; ++k)
      if (marks >> k & 1) mark[edges[k]] = 1, ++n;
    split_edges({s, opposite}, mark, &charts);
    EXPECT_EQ(s.points.size(), 4u + n);
    double area = 0;
    for (const Tri& t : s.tris) {
      const double a = area_vector(s.points[t[0]], s.points[t[1]], s.points[t[2]]).z;
      EXPECT_GT(a, 0);
      area += a / 2;
    }
    EXPECT_DOUBLE_EQ(area, 1);
    const Topology t = topology_of(s);
    EXPECT_EQ(t.loops, 1);
    EXPECT_EQ(make_charts(s, charts, 2).size(), 2u);
    int border = 0;  // the model edge is split with its edge
    for (std::uint8_t m : s.face.get<std::uint8_t>("model")) border += m != 0;
    EXPECT_EQ(border, marks & 1 ? 2 : 1);
  }
}

TEST(Curvature, SphereTubeAndPlane) {
  for (double k : curvature_of(sphere(3000))) EXPECT_NEAR(k, 1, 0.04);
  for (double k : curvature_of(tube(3, 40, false))) EXPECT_NEAR(k, 2, 0.05);
  Surface s = square();
  for (double k : curvature_of(s)) EXPECT_EQ(k, 0);
}

TEST(Curvature, IgnoresNoiseAndSlivers) {
  Mesh m = sphere(3000);
  add_noise(m, 0.1, 1);
  for (double k : curvature_of(m)) EXPECT_NEAR(k, 1, 0.12);
  Surface s = surface_of(sphere(3000));
  add_slivers(s, 0.3, 1);
  for (double k : curvature_of(s)) EXPECT_NEAR(k, 1, 0.12);
}

// full-length slivers on the bores, fans on the plate: no triangle alone shows the curvature
TEST(Curvature, OfABodyWithModelEdges) {
  const Body body = cad_body(1, 1, 48);
  const auto opposite = opposite_halfedges(body.tris, (int)body.points.size());
  std::vector<std::uint8_t> model(body.tris.size(), 0);
  for (int h = 0; h < (int)opposite.size(); ++h)
    if (body.patch[h / 3] != body.patch[opposite[h] / 3]) model[h / 3] |= 1 << h % 3;
  const auto k = face_curvature({body, opposite, model});
  std::vector<double> patch_least(body.names.size(), 1e300), patch_most(body.names.size(), 0);
  for (std::size_t t = 0; t < k.size(); ++t) {
    patch_least[body.patch[t]] = std::min(patch_least[body.patch[t]], k[t]);
    patch_most[body.patch[t]] = std::max(patch_most[body.patch[t]], k[t]);
  }
  for (std::size_t p = 0; p < body.names.size(); ++p)  // a plane or a cylinder, all over
    EXPECT_LE(patch_most[p], patch_least[p] * 1.001 + 1e-9) << body.names[p];
}

TEST(Size, GradationIsTheLargestFieldBelow) {
  const Mesh m = sphere(2000);
  std::vector<double> h(m.points.size(), 5);
  h[17] = 0.1;
  limit_gradation(m, neighbors_of(m), 0.3, h);
  expect_graded(m, h, 0.3);
  EXPECT_EQ(h[17], 0.1);
  double largest = 0;
  for (double x : h) largest = std::max(largest, x);
  EXPECT_GT(largest, 0.1 + 0.3 * 2);  // the far side of a unit sphere is pi away, over edges more
  EXPECT_LT(largest, 0.1 + 0.3 * 3.15 * 1.2);
}

TEST(Size, CountIsMetWithEverySource) {
  SizeOptions o;
  o.triangles = 5000;
  o.at = [](Vec3 p, double) { return 0.05 + 0.2 * std::abs(p.z); };
  Surface s = surface_of(sphere(3000));
  SizeReport r = set_size(s, nullptr, o);
  EXPECT_NEAR(count_for_size(s, s.vertex.get<double>("size")), 5000, 25);
  EXPECT_EQ(r.scale, 1);
  expect_graded(s, s.vertex.get<double>("size"), 0.3);
  o.triangles = 2000;  // fewer than the formula alone asks for
  s = surface_of(sphere(3000));
  r = set_size(s, nullptr, o);
  EXPECT_NEAR(r.triangles, 2000, 10);
  EXPECT_GT(r.scale, 1);
  o = {};
  o.triangles = 7000;
  o.per_turn = 30;
  s = surface_of(torus(0.3, 3000));
  EXPECT_NEAR(set_size(s, nullptr, o).triangles, 7000, 35);
}

TEST(Size, CurvatureAndChord) {
  Surface s = surface_of(sphere(3000));
  SizeOptions o;
  o.per_turn = 20;
  o.max = 10;
  set_size(s, nullptr, o);
  for (double h : s.vertex.get<double>("size")) EXPECT_NEAR(h, 2 * std::acos(-1) / 20, 0.01);
  o = {};
  o.chord = 0.01;
  set_size(s, nullptr, o);
  for (double h : s.vertex.get<double>("size")) EXPECT_NEAR(h, 2 * std::sqrt(0.02 - 0.0001), 0.01);
}

TEST(Size, SourcesAreBoundedAndTheSmallestCounts) {
  Surface s = surface_of(sphere(1000));
  std::vector<double> data(s.points.size(), 0.5);
  data[3] = 0.01;
  s.vertex.set("wanted", data);
  SizeOptions o;
  o.data = "wanted";
  o.size = 0.4;
  o.min = 0.05;
  o.gradation = 10;
  set_size(s, nullptr, o, false);
  const auto& h = s.vertex.get<double>("size");
  EXPECT_EQ(h[3], 0.05);
  EXPECT_EQ(h[400], 0.4);
  s.vertex.get<double>("wanted")[5] = 0;
  EXPECT_THROW(set_size(s, nullptr, o), BadInput);
}

// a cube of twelve triangles has no vertex where the formula is small: edges are split until it is seen
TEST(Size, CoarseSurfacesFollowTheField) {
  const Body c = cube(12);
  Surface s = surface_of(c);
  s.face.set("part", std::vector<int>(c.tris.size(), 0));
  SizeOptions o;
  const Vec3 q{0.3, 0.4, 1};
  o.at = [&](Vec3 p, double) { return 0.01 + 0.1 * norm(p - q); };
  const SizeReport r = set_size(s, nullptr, o);
  EXPECT_GT(r.added, 100);
  EXPECT_LT(r.smallest, 0.013);
  EXPECT_DOUBLE_EQ(total_area(s), 6);
  const auto& h = s.vertex.get<double>("size");
  for (const Tri& t : s.tris) {
    const Vec3 m = (1. / 3) * (s.points[t[0]] + s.points[t[1]] + s.points[t[2]]);
    const double linear = (h[t[0]] + h[t[1]] + h[t[2]]) / 3;
    EXPECT_NEAR(linear, o.at(m, 0), 0.35 * linear);
  }
}

TEST(Size, RefusesTooManyTriangles) {
  Surface s = surface_of(sphere(100));
  SizeOptions o;
  o.size = 1e-6;
  EXPECT_THROW(set_size(s, nullptr, o), GoalMissed);
  o.size = 0.1;
  o.most_triangles = 2000;  // the unit sphere has 2900 triangles of this size
  EXPECT_THROW(set_size(s, nullptr, o), GoalMissed);
  o.most_triangles = 4000;
  EXPECT_NO_THROW(set_size(s, nullptr, o));
}

std::vector<double> permitted(const Mesh& m, double size) {
  const std::vector<int> opposite = opposite_halfedges(m.tris, (int)m.points.size());
  return local_feature_size({m, opposite}, face_curvature({m, opposite}),
                            std::vector<double>(m.points.size(), size));
}

double least(const std::vector<double>& x) { return *std::min_element(x.begin(), x.end()); }
double largest(const std::vector<double>& x) { return *std::max_element(x.begin(), x.end()); }

TEST(LocalFeatureSize, AQuarterOfATubesCircumference) {
  const double quarter = 0.25 * 3.14159265358979324;  // of a diameter of 1
  for (bool closed : {false, true}) {
    const Mesh m = tube(6, 24, closed);
    const std::vector<double> size = permitted(m, 1.2);
    const double ends = closed ? 1.5 : -1;  // ends are curved the other way as well
    for (std::size_t v = 0; v < size.size(); ++v) {
      if (m.points[v].z < ends || m.points[v].z > 6 - ends) continue;
      ASSERT_GT(size[v], 0.98 * quarter);
      ASSERT_LT(size[v], 1.15 * quarter);
    }
  }
  EXPECT_EQ(least(permitted(tube(6, 24, true), 0.6)), INFINITY);
}

TEST(LocalFeatureSize, BoundsNothingOnBallsBodiesAndRims) {
  EXPECT_EQ(least(permitted(sphere(2000), 0.9)), INFINITY);
  EXPECT_EQ(least(permitted(cube(3000), 0.4)), INFINITY);
}

TEST(LocalFeatureSize, TwelveTrianglesOfAClosedComponent) {
  const Mesh octahedron{
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  for (double x : permitted(octahedron, 50)) EXPECT_NEAR(x, size_for_count(4 * std::sqrt(3), 12), 1e-12);
  Mesh open = octahedron;
  open.tris.pop_back();
  EXPECT_GT(largest(permitted(open, 50)), 50);
}

TEST(Size, IsLoweredOnTubesAndReported) {
  Surface s;
  static_cast<Mesh&>(s) = tube(20, 24, false);
  SizeOptions o;
  o.at = [](Vec3 p, double) { return 0.1 + 0.2 * p.z; };
  const SizeReport r = set_size(s, nullptr, o);
  const std::vector<double>& h = s.vertex.get<double>("size");
  EXPECT_GT(r.lowered.places, 0);
  EXPECT_GT(r.lowered.from, 1.9);
  EXPECT_NEAR(r.lowered.to, 0.25 * 3.14159, 0.1);
  EXPECT_GT(r.lowered.at.z, 9);
  EXPECT_LT(largest(h), 0.95);
  for (std::size_t v = 0; v < h.size(); ++v)
    if (s.points[v].z < 2) {
      EXPECT_NEAR(h[v], 0.1 + 0.2 * s.points[v].z, 0.02);
    }
}

/// A plate with rounded corners, of size 40 and thickness 3; corners have 16 edges, sides one.
Surface plate() {
  Surface s;
  const int n = 4 * 17;
  for (double z : {0.0, 3.0})
    for (int i = 0; i < n; ++i) {
      const double a = M_PI / 2 * (i / 17 + i % 17 / 16.0), middle = M_PI / 2 * (i / 17 + 0.5);
      s.points.push_back({2 * cos(a) + 25 * cos(middle), 2 * sin(a) + 25 * sin(middle), z});
    }
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    s.tris.push_back({i, j, j + n});
    s.tris.push_back({i, j + n, i + n});
    if (i == 0 || j == 0) continue;
    s.tris.push_back({0, j, i});
    s.tris.push_back({n, i + n, j + n});
  }
  s.vertex.rows = s.points.size();
  FeatureOptions sharp;
  sharp.mode = FeatureOptions::angles;
  mark_features(s, sharp);
  return s;
}

TEST(Size, RimsOfPlatesAreNoTubes) {
  Surface s = plate();
  SizeOptions o;
  o.triangles = 400;
  const SizeReport r = set_size(s, nullptr, o);
  EXPECT_EQ(r.lowered.places, 0);
  EXPECT_NEAR(r.triangles, 400, 1);
}

/// A closed cone of height 1 with its apex, vertex 0, at the origin; `rings` divide its side.
Surface cone(double radius, int sides, int rings) {
  Surface s;
  s.points = {{0, 0, 0}, {0, 0, 1}};
  auto at = [&](int ring, int i) { return 2 + (ring - 1) * sides + i % sides; };
  for (int ring = 1; ring <= rings; ++ring)
    for (int i = 0; i < sides; ++i) {
      const double a = 2 * M_PI * i / sides, z = (double)ring / rings;
      s.points.push_back({radius * z * cos(a), radius * z * sin(a), z});
    }
  for (int i = 0; i < sides; ++i) {
    s.tris.push_back({0, at(1, i + 1), at(1, i)});
    s.tris.push_back({1, at(rings, i), at(rings, i + 1)});
    for (int ring = 1; ring < rings; ++ring) {
      s.tris.push_back({at(ring, i), at(ring, i + 1), at(ring + 1, i + 1)});
      s.tris.push_back({at(ring, i), at(ring + 1, i + 1), at(ring + 1, i)});
    }
  }
  s.vertex.rows = s.points.size();
  return s;
}

std::vector<Peak> peaks_of(const Surface& s, double size) {
  const std::vector<int> opposite = opposite_halfedges(s.tris, (int)s.points.size());
  return sharp_peaks({s, opposite, model_of(s)}, std::vector<double>(s.points.size(), size));
}

TEST(Peaks, AreTheApexesOfSharpCones) {
  for (int rings : {1, 30}) {
    const std::vector<Peak> found = peaks_of(cone(0.3, 12, rings), 0.2);
    ASSERT_EQ(found.size(), 1u) << rings;
    EXPECT_EQ(found[0].vertex, 0);
    EXPECT_NEAR(found[0].angle, 2 * M_PI * 0.3 / sqrt(1.09), 0.1);
    EXPECT_TRUE(peaks_of(cone(0.8, 12, rings), 0.2).empty());
  }
  Surface s = cone(0.3, 12, 1);
  s.face.set("model", std::vector<std::uint8_t>(s.tris.size(), 7));
  EXPECT_TRUE(peaks_of(s, 0.2).empty());  // where model edges meet is a corner in any case
}

TEST(Peaks, AreNoSpikesOfNoise) {
  Surface s = surface_of(sphere(20000));
  s.points[100] = 1.2 * s.points[100];
  EXPECT_EQ(peaks_of(s, 0.02).size(), 1u);
  EXPECT_TRUE(peaks_of(s, 0.5).empty());
}

TEST(Size, IsLoweredAtPeaksSoThatFourEdgesFitAroundThem) {
  Surface s = cone(0.1, 12, 1);
  SizeOptions o;
  o.size = 0.2;
  set_size(s, nullptr, o);
  // the section a size away from the point lowers the size there before the ring around the point does
  const double around = 2 * M_PI * 0.1 / sqrt(1.01) / 4, there = 0.2 * around + 0.3 * 0.2;
  EXPECT_NEAR(s.vertex.get<double>("size")[0], there * around, 0.002);
  // a field that was lowered already is lowered again, but not for ever
  SizeOptions again;
  again.data = "before";
  for (int i = 0; i < 4; ++i) {
    s.vertex.set("before", std::vector<double>(s.vertex.get<double>("size")));
    set_size(s, nullptr, again);
  }
  EXPECT_GT(s.vertex.get<double>("size")[0], 0.0005);
}

TEST(Expression, ValuesAndFailures) {
  Expression e("0.1 + x^2 * max(y, 2) + (z > 0 ? pi : 0)", {"x", "y", "z"});
  EXPECT_DOUBLE_EQ(e({3, 1, 0}), 18.1);
  EXPECT_DOUBLE_EQ(e({3, 1, 1}), 18.1 + std::acos(-1));
  EXPECT_EQ(Expression("x == 1 || x != 2 && x <= 3 ? 4 : 5", {"x"})({1}), 4);
  EXPECT_TRUE(e.uses("x"));
  EXPECT_FALSE(Expression("x", {"x", "y"}).uses("y"));
  for (const char* bad : {"", "x +", "w", "1, 2", "(x", "system(1)", "x = 0.1", "0.1 = x"})
    EXPECT_THROW(Expression(bad, {"x"}), BadUsage) << bad;
}

//  a needle around which the size does not fit
TEST(Size, RefusesWhatIsFarMoreSlenderThanTheSize) {
  Surface s = surface_of(cube(12));
  for (Vec3& p : s.points) p.x *= 1e5;
  SizeOptions options;
  options.size = 30;
  Surface copy = s;
  EXPECT_THROW(set_size(copy, nullptr, options), GoalMissed);
  options.size = 1.5;
  EXPECT_NO_THROW(set_size(s, nullptr, options));
}

//  a sphere in another
Surface shells(double ratio) {
  Mesh both = sphere(2000);
  const int n = (int)both.points.size(), m = (int)both.tris.size();
  for (int v = 0; v < n; ++v) both.points.push_back(ratio * both.points[v]);
  for (int t = 0; t < m; ++t) {
    const auto [a, b, c] = both.tris[t];
    both.tris.push_back({a + n, b + n, c + n});
  }
  return surface_of(both);
}

TEST(Size, RefusesSheetsThatAskForManyTimesAsManyTriangles) {
  SizeOptions options;
  options.triangles = 2000;
  Surface near = shells(1.0001), apart = shells(1.1);
  const std::vector<Tri> before = near.tris;
  EXPECT_THROW(set_size(near, nullptr, options), GoalMissed);
  EXPECT_EQ(near.tris, before);
  EXPECT_NO_THROW(set_size(apart, nullptr, options));
}

TEST(SizeField, SmallSizesOfOtherSheetsGrowOnTheWay) {
  // a flake of size 0.01 at 0 0 0, and a plate of size 2 below
  SizeField f;
  f.points = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {-9, -9, -2}, {9, -9, -2}, {0, 9, -2}};
  f.tris = {{0, 1, 2}, {3, 4, 5}};
  f.size = {0.01, 0.01, 0.01, 2, 2, 2};
  const Bvh tree(f);
  auto at = [&](double z) { return size_near(f, tree, {0, 0, z}, 0.5); };
  EXPECT_NEAR(at(0), 0.01, 1e-12);
  EXPECT_NEAR(at(9), 0.01, 1e-12);                             // nothing else is near
  EXPECT_NEAR(at(-1.0004), 0.01, 1e-12);                       // 0.0008 farther than the plate
  EXPECT_NEAR(at(-1.09), 0.01 + 0.5 * (0.18 - 0.001), 1e-12);  // 0.18 farther, less than a tenth of 2
  EXPECT_NEAR(at(-1.2), 2, 1e-12);
}

TEST(SizeField, Tables) {
  EXPECT_TRUE(is_size_table("# sizes\n0 0 0 1\n"));
  EXPECT_TRUE(is_size_table("x,y,z,h\r\n0,0,0,1\r\n"));
  EXPECT_FALSE(is_size_table("solid a\nfacet normal 0 0 1\n"));
  EXPECT_FALSE(is_size_table("OFF\n3 1 0\n0 0 0\n"));
  const SizeField f = read_size_table("x;y;z;h\n0;0;0;1\n\n# more\n1;2;3;0.5\n", "", "t");
  ASSERT_EQ(f.points.size(), 2u);
  EXPECT_EQ(f.points[1], (Vec3{1, 2, 3}));
  EXPECT_EQ(f.size[1], 0.5);
  EXPECT_EQ(f.tris.size(), 2u);  // points alone
  EXPECT_EQ(read_size_table("x y z fine\n0 0 0 1\n1 1 1 2\n", "fine", "t").size, (std::vector<double>{1, 2}));
  EXPECT_THROW(read_size_table("x y z fine\n0 0 0 1\n", "coarse", "t"), BadInput);
  EXPECT_THROW(read_size_table("0 0 0 1\n", "fine", "t"), BadInput);
  EXPECT_THROW(read_size_table("0 0 0 1\n0 0 0\n", "", "t"), BadInput);
  EXPECT_THROW(read_size_table("0 0 0 1\n0 0 a 1\n", "", "t"), BadInput);
  EXPECT_THROW(read_size_table("0 0 0 -1\n", "", "t"), BadInput);
  for (const char* first : {"0 0 0", "0 0 0 1 5", "0 0 0 nan"})  // is no line of names
    EXPECT_THROW(read_size_table(std::string(first) + "\n1 1 1 0.4\n", "", "t"), BadInput) << first;
}

TEST(Size, GeometryIsDividedAsAsked) {
  Surface around = surface_of(tube(5, 60, false)), across = around;
  SizeOptions o;
  o.around = 20;
  SizeReport r = set_size(around, nullptr, o);
  for (double h : around.vertex.get<double>("size")) EXPECT_NEAR(h, 3.14159 / 20, 0.05 * 3.14159 / 20);
  EXPECT_TRUE(around.vertex.has("radius"));
  ASSERT_EQ(r.measured.size(), 1u);
  EXPECT_NEAR(r.measured[0].value, 0.5, 0.01);
  o.around = 0, o.across = 20;
  r = set_size(across, nullptr, o);
  for (double h : across.vertex.get<double>("size")) EXPECT_NEAR(h, 0.05, 0.0025);
  // a plate of two triangles a side: its rim is split, as it asks for more than the edges around it
  Body body = cube(12);
  for (Vec3& p : body.points) p.z *= 0.1;
  Surface plate = surface_of(body);
  o.across = 2;
  r = set_size(plate, nullptr, o);
  EXPECT_GT(r.added, 0);
  for (std::size_t v = 0; v < plate.points.size(); ++v) {
    if (std::abs(plate.points[v].z - 0.05) < 0.049) continue;
    EXPECT_NEAR(plate.vertex.get<double>("size")[v], 0.05, 0.0025);
  }
  o.across = 0, o.gap = 2;
  EXPECT_EQ(set_size(plate, nullptr, o).measured[0].vertices, 0);
}

// A small end in the wall of a wide tube: all of its rim is divided by its own length, also where it is
// split.
TEST(Size, PartsOfOtherProgramsAreNotCounted) {
  for (const auto& labels : {std::vector{0, 1, 2, 3}, {-1, -1, -1, -1}, {0, 2'000'000'000, -5, 1}}) {
    Surface s = surface_of(
        {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}});
    s.face.set("part", labels);
    SizeOptions options;
    options.size = 0.2;
    const SizeReport r = set_size(s, nullptr, options);
    EXPECT_GE(r.least, r.triangles);
  }
}

TEST(Size, RimsOfSmallEndsAreDividedAsAsked) {
  Surface s = surface_of(tube(4, 24, false));
  int hole = 0;
  while (std::abs(centroid(s, hole).z - 2) > 0.1) ++hole;
  s.tris.erase(s.tris.begin() + hole);
  s.face.rows = s.tris.size();
  SizeOptions o;
  o.around = 40;
  EXPECT_GT(set_size(s, nullptr, o).added, 0);
  const auto& size = s.vertex.get<double>("size");
  const std::vector<int> opposite = opposite_halfedges(s.tris, (int)s.points.size());
  for (const auto& loop : boundary_loops(opposite)) {
    double length = 0;
    for (int h : loop) length += edge_length(s, h);
    for (int h : loop) EXPECT_LT(size[origin(s.tris, h)], 1.05 * length / o.around);
  }
}
