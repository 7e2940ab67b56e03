// SPDX-License-Identifier: BSD-3-Clause
#include "lib/cap/cap.h"

#include <gtest/gtest.h>

#include <numbers>

#include "lib/core/error.h"
#include "lib/core/intersect.h"
#include "lib/core/topology.h"
#include "lib/shape/shape.h"

using namespace meshpipe;

namespace {

constexpr double pi = std::numbers::pi;

// open tube of diameter 1 along z
Surface open_tube(double aspect, int n) { return surface_of(tube(aspect, n, false)); }

// the same with a rim at the upper end that waves by `height`, `waves` times around
Surface wavy_tube(double height, int waves) {
  Surface s = open_tube(4, 32);
  for (Vec3& p : s.points)
    if (p.z > 3.99) p.z += height * std::sin(waves * std::atan2(p.y, p.x));
  return s;
}

// what a closed result has to be: one that encloses a volume, oriented outward, without intersections
double expect_sound(const Surface& s) {
  const std::vector<int> opposite = opposite_halfedges(s.tris, (int)s.points.size());
  EXPECT_EQ(std::count(opposite.begin(), opposite.end(), -1), 0);
  EXPECT_TRUE(self_intersections(s).empty());
  EXPECT_EQ(s.face.rows, s.tris.size());
  EXPECT_EQ(s.vertex.rows, s.points.size());
  double volume = 0;
  for (const auto& [a, b, c] : s.tris) volume += dot(s.points[a], cross(s.points[b], s.points[c])) / 6;
  EXPECT_GT(volume, 0);
  return volume;
}

double height_of_patch(const Surface& s, int patch, Vec3 point, Vec3 normal) {
  const auto& label = s.face.get<int>("patch");
  double height = 0;
  for (std::size_t t = 0; t < label.size(); ++t)
    if (label[t] == patch)
      for (int v : s.tris[t]) height = std::max(height, std::abs(dot(s.points[v] - point, normal)));
  return height;
}

std::string why(Surface s, const CapOptions& options) {
  std::vector<End> ends = find_ends(s);
  try {
    treat_ends(s, ends, options);
  } catch (const NotAdmissible& e) {
    return e.what();
  }
  return "";
}

TEST(cap, measures_ends) {
  Surface s = open_tube(3, 64);
  const std::vector<End> ends = find_ends(s);
  ASSERT_EQ(ends.size(), 2u);
  for (const End& e : ends) {
    EXPECT_NEAR(e.radius, 0.5, 0.5 * 0.01);
    EXPECT_NEAR(e.area, pi / 4, 0.01);
    EXPECT_NEAR(e.roundness, 1, 0.01);
    EXPECT_LT(e.planarity, 1e-12);
    EXPECT_NEAR(std::abs(e.normal.z), 1, 1e-12);
    EXPECT_GT(e.normal.z * (e.center.z - 1.5), 0);
  }
  EXPECT_EQ(ends[0].name, "inlet");
  EXPECT_EQ(ends[1].name, "outlet_1");
}

TEST(cap, closes_a_tube) {
  Surface s = open_tube(2, 48);
  std::vector<End> ends = find_ends(s);
  CapOptions o;
  o.cap = true;
  const std::vector<EndReport> r = treat_ends(s, ends, o);
  EXPECT_TRUE(r[0].flat && r[1].flat);
  EXPECT_NEAR(expect_sound(s), 2 * pi / 4, 0.01);
  EXPECT_EQ(r[0].cap_patch, 2);
  EXPECT_EQ(r[1].cap_patch, 3);
  const auto& model = s.face.get<std::uint8_t>("model");
  int edges = 0;
  for (std::uint8_t m : model) edges += (m & 1) + (m >> 1 & 1) + (m >> 2 & 1);
  EXPECT_EQ(edges, 2 * 2 * 48);  // both sides of both rims
}

TEST(cap, flattens_a_wavy_rim) {
  for (const auto& [height, waves] : {std::pair{0.02, 3}, {0.05, 8}, {0.08, 2}}) {
    Surface s = wavy_tube(height, waves);
    std::vector<End> ends = find_ends(s);
    CapOptions o;
    o.flatten = o.cap = true;
    const std::vector<EndReport> r = treat_ends(s, ends, o);
    expect_sound(s);
    for (int i = 0; i < 2; ++i) {
      EXPECT_TRUE(r[i].flat);
      EXPECT_LT(ends[i].planarity, 1e-12);
      EXPECT_LT(height_of_patch(s, r[i].cap_patch, ends[i].center, ends[i].normal), 1e-12);
      EXPECT_EQ(r[i].trimmed, 0);
      EXPECT_LE(r[i].moved, 1.01 * height);
    }
  }
}

TEST(cap, flattens_triangles_with_all_corners_on_the_rim) {
  Surface s = open_tube(3, 24);
  const std::vector<int> rim = find_ends(s)[0].rims[0];
  for (int k : {0, 5, 6}) {  // ears above the rim
    const int a = rim[k], b = rim[k + 1], n = (int)s.points.size();
    Vec3 p = lerp(s.points[a], s.points[b], 0.5);
    p.z += p.z > 1.5 ? 0.03 : -0.03;
    s.points.push_back(p);
    s.tris.push_back({a, b, n});
  }
  s.vertex.rows = s.points.size(), s.face.rows = s.tris.size();
  std::vector<End> ends = find_ends(s);
  CapOptions o;
  o.flatten = o.cap = true;
  const std::vector<EndReport> r = treat_ends(s, ends, o);
  expect_sound(s);
  EXPECT_TRUE(r[0].flat && r[1].flat);
}

TEST(cap, cuts_a_rim_that_is_far_out_of_plane) {
  Surface s = wavy_tube(0.35, 2);
  std::vector<End> ends = find_ends(s);
  CapOptions o;
  o.flatten = o.cap = true;
  const std::vector<EndReport> r = treat_ends(s, ends, o);
  expect_sound(s);
  EXPECT_GT(r[0].trimmed + r[1].trimmed, 0.35);
  EXPECT_TRUE(r[0].flat && r[1].flat);
}

TEST(cap, makes_the_wobble_of_a_rim_plane_only) {
  for (const auto& [height, waves] : {std::pair{0.045, 3}, {0.07, 3}, {0.085, 2}}) {
    Surface s = wavy_tube(height, waves);
    std::vector<End> ends = find_ends(s);
    const std::vector<Vec3> before = s.points;
    CapOptions o;
    o.cap = true;
    const std::vector<EndReport> r = treat_ends(s, ends, o);
    expect_sound(s);
    double moved = 0;
    for (std::size_t v = 0; v < before.size(); ++v) moved = std::max(moved, norm(s.points[v] - before[v]));
    const bool wobbles = height < 0.05;  // a tenth of the radius
    EXPECT_EQ(r[0].flat && r[1].flat, wobbles);
    EXPECT_NEAR(moved, wobbles ? height : 0, 1e-2 * height);
    EXPECT_NEAR(std::max(r[0].moved, r[1].moved), moved, 1e-12);
  }
}

// a tube with a hole in its side, half of the way around
Surface pierced_tube() {
  Surface s = open_tube(4, 24);
  std::erase_if(s.tris, [&](const Tri& t) {
    const Vec3 p = centroid(s, (int)(&t - s.tris.data()));
    return p.x > -0.05 && std::abs(p.z - 2) < 0.3 + 0.3 * p.x;
  });
  s.face.rows = s.tris.size();
  return s;
}

TEST(cap, ends_a_hole_in_a_side_by_a_stub) {
  for (const double extend : {0.0, 1.0}) {
    Surface s = pierced_tube();
    std::vector<double> height;
    for (const Vec3& p : s.points) height.push_back(p.z);
    s.vertex.set("height", height);
    std::vector<End> ends = find_ends(s);
    ASSERT_EQ(ends.size(), 3u);
    CapOptions o;
    o.flatten = o.cap = true;
    o.extend = extend;
    const std::vector<EndReport> r = treat_ends(s, ends, o);
    expect_sound(s);
    for (int i = 0; i < 3; ++i) {
      EXPECT_TRUE(r[i].flat && r[i].why_not.empty());
      EXPECT_LT(height_of_patch(s, r[i].cap_patch, ends[i].center, ends[i].normal), 1e-12);
      EXPECT_EQ(r[i].stub > 0, std::abs(ends[i].normal.z) < 0.9);
    }
    // vertices of all that was added have data of the rim
    for (const double h : s.vertex.get<double>("height")) EXPECT_TRUE(h >= 0 && h <= 4);
  }
}

TEST(cap, caps_a_hole_without_space_for_a_stub) {
  Surface s = pierced_tube();
  const int n = (int)s.points.size(), m = (int)s.tris.size();
  for (int v = 0; v < n; ++v) s.points.push_back(s.points[v] + Vec3{1.02, 0, 0});  // next to it
  for (int t = 0; t < m; ++t) {
    const auto [a, b, c] = s.tris[t];
    s.tris.push_back({a + n, b + n, c + n});
  }
  s.vertex.rows = s.points.size(), s.face.rows = s.tris.size();
  std::vector<End> ends = find_ends(s);
  CapOptions o;
  o.flatten = o.cap = true;
  CapOptions without = o;
  without.cap = false;
  EXPECT_NE(why(s, without).find("cannot be made planar"), std::string::npos);
  const std::vector<EndReport> r = treat_ends(s, ends, o);
  expect_sound(s);
  int flat = 0;
  for (const EndReport& e : r) {
    flat += e.flat;
    EXPECT_EQ(e.flat, e.why_not.empty()) << e.why_not;
    EXPECT_EQ(e.flat, e.why_not.find("a stub there would meet the surface near") == std::string::npos);
  }
  EXPECT_EQ(flat, 5);
}

TEST(cap, trims_by_a_length) {
  Surface s = open_tube(6, 40);
  // an oblique rim, which counts from its middle
  for (Vec3& p : s.points) p.z *= 1 + 0.05 * p.x;
  std::vector<End> ends = find_ends(s);
  CapOptions o;
  o.trim = 1.2;
  o.cap = true;
  treat_ends(s, ends, o);
  expect_sound(s);
  const double top = std::max(ends[0].center.z, ends[1].center.z);
  EXPECT_NEAR(top, 4.8, 0.05);
  EXPECT_NEAR(std::min(ends[0].center.z, ends[1].center.z), 1.2, 0.05);
  for (const End& e : ends) {
    EXPECT_LT(e.planarity, 1e-12);
    EXPECT_GT(std::abs(e.normal.z), 0.995);
    EXPECT_NEAR(e.radius, 0.5, 0.01);
  }
}

TEST(cap, extends_to_a_circle) {
  Surface s = open_tube(4, 48);
  for (Vec3& p : s.points) p.x *= 1.6;  // an ellipse
  std::vector<End> ends = find_ends(s);
  const double area = ends[0].area;
  CapOptions o;
  o.extend = 5;
  o.cap = true;
  const std::vector<EndReport> r = treat_ends(s, ends, o);
  expect_sound(s);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(ends[i].area, area, 0.01 * area);
    EXPECT_NEAR(ends[i].roundness, 1, 0.01);
    EXPECT_NEAR(r[i].extended, 5 * std::sqrt(area / pi), 1e-9);
    EXPECT_GT(r[i].extension_patch, r[i].cap_patch);
  }
  EXPECT_NEAR(std::abs(ends[0].center.z - ends[1].center.z), 4 + r[0].extended + r[1].extended, 1e-9);
}

TEST(cap, caps_an_annulus) {
  Surface s = open_tube(3, 48);
  const int n = (int)s.points.size(), m = (int)s.tris.size();
  for (int v = 0; v < n; ++v) s.points.push_back({0.7 * s.points[v].x, 0.7 * s.points[v].y, s.points[v].z});
  for (int t = 0; t < m; ++t) s.tris.push_back({s.tris[t][0] + n, s.tris[t][2] + n, s.tris[t][1] + n});
  s.vertex.rows = s.points.size(), s.face.rows = s.tris.size();
  std::vector<End> ends = find_ends(s);
  ASSERT_EQ(ends.size(), 2u);
  EXPECT_EQ(ends[0].rims.size(), 2u);
  const double disk = 24 * 0.25 * std::sin(2 * pi / 48);
  EXPECT_NEAR(ends[0].area, (1 - 0.49) * disk, 1e-9);
  CapOptions o;
  o.cap = true;
  o.trim = 0.5;
  treat_ends(s, ends, o);
  EXPECT_NEAR(expect_sound(s), 2 * (1 - 0.49) * disk, 0.001);
}

TEST(cap, orients_outward) {
  Surface s = open_tube(2, 24);
  EXPECT_EQ(orient_outward(s), 0);
  for (Tri& t : s.tris) std::swap(t[0], t[1]);
  EXPECT_LT(find_ends(s)[0].normal.z * (find_ends(s)[0].center.z - 1), 0);
  EXPECT_EQ(orient_outward(s), 1);
  EXPECT_GT(find_ends(s)[0].normal.z * (find_ends(s)[0].center.z - 1), 0);
}

//  |  |   |  |   each by itself, and its model edge with it
TEST(cap, orients_each_of_two_tubes_outward) {
  Surface s = open_tube(2, 24);
  const int n = (int)s.points.size(), m = (int)s.tris.size();
  for (int v = 0; v < n; ++v) s.points.push_back(s.points[v] + Vec3{5, 0, 0});
  for (int t = 0; t < m; ++t) s.tris.push_back({s.tris[t][0] + n, s.tris[t][2] + n, s.tris[t][1] + n});
  s.vertex.rows = s.points.size(), s.face.rows = s.tris.size();
  std::vector<std::uint8_t> model(s.tris.size(), 0);
  model[m] = 1;
  s.face.set("model", model);
  EXPECT_EQ(orient_outward(s), 1);
  for (const End& e : find_ends(s)) EXPECT_GT(e.normal.z * (e.center.z - 1), 0) << e.name;
  EXPECT_EQ(s.tris[m], (Tri{s.tris[0][0] + n, s.tris[0][1] + n, s.tris[0][2] + n}));
  EXPECT_EQ(s.face.get<std::uint8_t>("model")[m], 4);
}

TEST(cap, names_by_place_and_by_area) {
  Surface s = surface_of(branching_tree(0, 5, 0.8, 2500, 1));
  std::vector<End> ends = find_ends(s);
  ASSERT_EQ(ends.size(), 5u);
  const Vec3 third = ends[2].center;
  name_ends(ends, {{"aorta"}, {"left", true, third + Vec3{0.01, 0, 0}}, {"outlet_4"}});
  EXPECT_EQ(ends[0].name, "aorta");
  EXPECT_EQ(ends[1].name, "outlet_4");
  EXPECT_EQ(ends[2].name, "left");
  EXPECT_EQ(ends[3].name, "outlet_3");
  EXPECT_EQ(ends[4].name, "outlet_5");
  EXPECT_THROW(name_ends(ends, {{"a", true, third}, {"b", true, third}}), NotAdmissible);
  EXPECT_THROW(name_ends(ends, std::vector<EndName>(6)), NotAdmissible);
}

TEST(cap, refuses_to_remove_a_branch) {
  const Surface s = surface_of(branching_tree(0, 3, 0.8, 2500, 1));
  CapOptions o;
  o.trim = 12;
  o.trim_by_radius = true;
  EXPECT_NE(why(s, o).find("cut"), std::string::npos);
  o.trim = 1;
  EXPECT_EQ(why(s, o), "");
}

TEST(cap, leaves_out_the_ends_that_it_should) {
  Surface s = surface_of(branching_tree(0, 5, 0.8, 2500, 1));
  const std::vector<End> before = find_ends(s);
  EXPECT_EQ(ends_in(before, "outlet_1,5"), (std::vector<char>{0, 1, 0, 0, 1}));
  for (const char* list : {"", "6", "0", "inlet,", "outlet_5", "1,,2"})
    EXPECT_THROW(ends_in(before, list), NotAdmissible) << list;
  CapOptions o;
  o.trim = 0.1;
  o.extend = 1;
  o.cap = true;
  o.kept = ends_in(before, "inlet,3");
  std::vector<End> ends = before;
  const std::vector<EndReport> r = treat_ends(s, ends, o);
  expect_sound(s);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(r[i].trimmed > 0, !o.kept[i]);
    EXPECT_EQ(r[i].extension > 0, !o.kept[i]);
    EXPECT_TRUE(r[i].flat);
    EXPECT_EQ(norm(ends[i].center - before[i].center) < 1e-9, o.kept[i] != 0);
  }
}

TEST(cap, lists_all_ends_that_cannot_be_cut_back) {
  const Surface s = surface_of(branching_tree(0, 5, 0.8, 2500, 1));
  CapOptions o;
  o.trim = 2.4;  // the branches are shorter than that before they meet the next one, the trunk is not
  o.cap = true;
  const std::string text = why(s, o);
  const std::size_t at = text.find("--except ");
  ASSERT_NE(at, std::string::npos) << text;
  o.kept = ends_in(find_ends(s), text.substr(at + 9));
  EXPECT_EQ(why(s, o), "");
}

TEST(cap, refuses_a_rim_that_crosses_itself) {
  Surface s = open_tube(3, 32);
  for (Vec3& p : s.points)
    if (p.z > 2.99 && p.x > 0) p = {p.x, -0.5 * p.y, p.z};  // an eight
  CapOptions o;
  o.cap = true;
  EXPECT_NE(why(s, o).find("crosses itself"), std::string::npos);
}

TEST(cap, refuses_an_extension_into_another_vessel) {
  Surface s = open_tube(3, 32);
  const int n = (int)s.points.size(), m = (int)s.tris.size();
  for (int v = 0; v < n; ++v) {  // across the axis, above
    const Vec3 p = s.points[v];
    s.points.push_back({p.z - 1.5, p.x, p.y + 4.5});
  }
  for (int t = 0; t < m; ++t) s.tris.push_back({s.tris[t][0] + n, s.tris[t][1] + n, s.tris[t][2] + n});
  s.vertex.rows = s.points.size(), s.face.rows = s.tris.size();
  CapOptions o;
  o.extend = 1;
  EXPECT_EQ(why(s, o), "");
  o.extend = 4;
  EXPECT_NE(why(s, o).find("its extension meets the surface near"), std::string::npos);
  EXPECT_NE(why(s, o).find("--except "), std::string::npos) << why(s, o);
}

TEST(cap, does_nothing_to_a_closed_surface) {
  Surface s = surface_of(sphere(500));
  std::vector<End> ends = find_ends(s);
  EXPECT_TRUE(ends.empty());
  CapOptions o;
  o.cap = true;
  EXPECT_TRUE(treat_ends(s, ends, o).empty());
}

}  // namespace
