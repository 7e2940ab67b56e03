// SPDX-License-Identifier: BSD-3-Clause
#include "lib/check/check.h"

#include <gtest/gtest.h>

#include "lib/core/cut.h"
#include "lib/core/intersect.h"
#include "lib/core/original_triangles.h"
#include "lib/core/weld.h"
#include "lib/shape/shape.h"

namespace meshpipe {
namespace {

TEST(check, soundness_of_sound_meshes) {
  const Soundness a = soundness_of(tube(3, 20, false)), b = soundness_of(torus(0.4, 500));
  EXPECT_TRUE(a.sound());
  EXPECT_EQ(a.loops, 2);
  EXPECT_EQ(a.genus, 0);
  EXPECT_TRUE(b.sound());
  EXPECT_EQ(b.loops, 0);
  EXPECT_EQ(b.genus, 1);
  EXPECT_EQ(b.components, 1);
}

TEST(check, connectivity_finds_every_fault) {
  const Mesh good = sphere(100);
  Mesh reversed = good, doubled = good, repeated = good;
  std::swap(reversed.tris[7][0], reversed.tris[7][1]);
  doubled.tris.push_back(doubled.tris[5]);
  repeated.tris[9][1] = repeated.tris[9][0];
  EXPECT_EQ(soundness_of(reversed).misoriented.size(), 3u);
  EXPECT_EQ(soundness_of(doubled).nonmanifold, std::vector<int>(3, (int)good.tris.size()));
  EXPECT_EQ(soundness_of(repeated).degenerate, std::vector<int>{9});
}

//  0---1       two triangles that touch in vertex 2 only
//   \ /
//    2
//   / \.
//  3---4
TEST(check, connectivity_finds_a_pinched_vertex) {
  const Mesh m{{{0, 2, 0}, {2, 2, 0}, {1, 1, 0}, {0, 0, 0}, {2, 0, 0}}, {{0, 2, 1}, {3, 4, 2}}};
  const Soundness c = soundness_of(m);
  EXPECT_EQ(c.pinched, std::vector<int>{1});
  EXPECT_FALSE(c.sound());
}

TEST(check, quality_of_a_known_mesh) {
  //  3---2    unit square
  //  | / |
  //  0---1
  const Mesh m{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const std::vector<int> opposite = soundness_of(m).opposite;
  const Quality q = quality_of({m, opposite}, {0.5, 0.5, 0.5, 0.5});
  EXPECT_NEAR(q.min_angle, 45, 1e-12);
  EXPECT_NEAR(q.max_angle, 90, 1e-12);
  EXPECT_NEAR(q.kappa_mean, 4 * 0.5 / (1 + std::sqrt(2)), 1e-12);
  EXPECT_NEAR(q.edge_min, 2, 1e-12);
  EXPECT_NEAR(q.edge_max, 2 * std::sqrt(2), 1e-12);
  EXPECT_NEAR(q.edge_mean, (8 + 2 * std::sqrt(2)) / 5, 1e-12);
  EXPECT_NEAR(quality_of({m, opposite}, {}).edge_mean, 1, 1e-12);
  EXPECT_EQ(bins(q.kappas, 0, 1, 50)[(int)(50 * q.kappa_mean)], 2);
  EXPECT_EQ(q.angle_histogram[45], 2);
}

TEST(check, quality_is_that_of_the_definitions) {
  const Mesh m = torus(0.4, 700);
  const std::vector<int> opposite = soundness_of(m).opposite;
  const Quality q = quality_of({m, opposite}, {});
  double sum = 0, least = 180, largest = 0;
  for (const Tri& t : m.tris) {
    const Vec3 &a = m.points[t[0]], &b = m.points[t[1]], &c = m.points[t[2]];
    sum += kappa(a, b, c);
    for (double x : {angle(b - a, c - a), angle(c - b, a - b), angle(a - c, b - c)}) {
      least = std::min(least, x * 180 / M_PI);
      largest = std::max(largest, x * 180 / M_PI);
    }
  }
  EXPECT_NEAR(q.kappa_mean, sum / (double)m.tris.size(), 1e-6);
  EXPECT_NEAR(q.min_angle, least, 1e-9);
  EXPECT_NEAR(q.max_angle, largest, 1e-9);
}

// A tube with a rhombus for a section and a cap: between its sharp corners 1 and 3, the cap has an edge. The
// result has the chord 0 2 below it, where rounding keeps it apart from the cap.
TEST(check, chords_of_a_rim_intersect_its_cap) {
  Surface reference = surface_of(
      Mesh{{{0, -1, 0}, {3, 0, 0}, {0, 1, 0}, {-3, 0, 0}, {3, 0, -2}, {0, -1, -2}, {0, 1, -2}, {-3, 0, -2}},
           {{0, 1, 3},
            {1, 2, 3},
            {1, 0, 4},
            {2, 1, 4},
            {0, 5, 4},
            {2, 4, 6},
            {2, 6, 7},
            {2, 7, 3},
            {3, 7, 0},
            {0, 7, 5}}});
  reference.face.set("model", std::vector<std::uint8_t>{5, 3, 1, 1, 0, 0, 0, 4, 4, 0});
  Surface result = reference;
  for (int v : {0, 2}) result.points[v].z = -1e-8;
  EXPECT_EQ(examine(result, reference, nullptr, 10).new_intersections.size(), 0u);
  result.tris[2] = {0, 4, 2}, result.tris[3] = {0, 2, 1};  // 1 4 becomes 0 2
  result.face.set("model", std::vector<std::uint8_t>{5, 3, 0, 6, 0, 0, 0, 4, 4, 0});
  EXPECT_TRUE(self_intersections(result).empty());
  EXPECT_GT(examine(result, reference, nullptr, 10).new_intersections.size(), 0u);
  EXPECT_EQ(examine(result, result, nullptr, 10).new_intersections.size(), 0u);
  // a triangle through the rim: the reference intersects itself there, too
  for (Vec3 p : {Vec3{-1, -1, -1}, Vec3{1, 1, -1}, Vec3{0, 0, 1}}) reference.points.push_back(p);
  reference.tris.push_back({8, 9, 10});
  reference.vertex.rows = reference.points.size(), reference.face.rows = reference.tris.size();
  reference.face.set("model", std::vector<std::uint8_t>{5, 3, 1, 1, 0, 0, 0, 4, 4, 0, 0});
  const Findings f = examine(result, reference, nullptr, 10);
  EXPECT_GT(f.intersections.size(), 0u);
  EXPECT_EQ(f.new_intersections.size(), 0u);
}

//  3---2
//  |\ /|   A square in the plane z = 0, and a cone above it, open at the top,
//  | 4 |   whose tip is where the middle of the square is, another vertex. The
//  |/ \|   result has no vertex there: the tip is on a triangle.
//  0---1
TEST(check, a_tip_that_touches_a_sheet_may_touch_it_in_the_result) {
  auto with_cone = [](double tip, const std::vector<Tri>& square) {
    Surface s;
    s.points = {{0, 0, 0},   {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 0},
                {1, 1, tip}, {2, 1, 1}, {1, 2, 1}, {0, 1, 1}, {1, 0, 1}};
    s.tris = square;
    for (int i = 0; i < 4; ++i) s.tris.push_back({5, 6 + i, 6 + (i + 1) % 4});
    return s;
  };
  const std::vector<Tri> middle{{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}, none{{0, 1, 2}, {0, 2, 3}};
  for (const bool sheets_meet : {false, true}) {
    auto found = [&](double tip_of_reference) {
      return examine(with_cone(0, none), with_cone(tip_of_reference, middle), nullptr, 10, infinity,
                     sheets_meet)
          .new_intersections.size();
    };
    EXPECT_EQ(found(0), 0);
    EXPECT_GT(found(0.3), 0);
  }
}

TEST(check, cuts_are_undone) {
  Surface s = surface_of(torus(0.4, 900));
  const Mesh before = s;
  std::vector<int> origin(s.tris.size());
  for (std::size_t t = 0; t < origin.size(); ++t) origin[t] = (int)t;
  s.vertex.rows = s.points.size();
  s.face.rows = s.tris.size();
  s.face.set("origin", origin);
  std::vector<double> field;
  for (Vec3 p : s.points) field.push_back(p.x + 0.3 * p.y - 0.137);
  std::vector<int> side;
  cut_by_scalar_field(s, field, {}, side, 1e-3);
  ASSERT_GT(s.tris.size(), before.tris.size() + 20);
  const Mesh after = recover_triangles(s, s.face.get<int>("origin"));
  EXPECT_EQ(after.tris.size(), before.tris.size());
  EXPECT_NEAR(total_area(after), total_area(before), 1e-9);
  const Soundness c = soundness_of(after);
  EXPECT_TRUE(c.sound());
  EXPECT_EQ(c.genus, 1);
  EXPECT_EQ(c.loops, 0);
}

//         3
//       / | \        two triangles around 0-2, cut at 4 in its middle, with others around. 0 2 3 has
//  5---0--4--2---6   hardly any area, and 4 is rounded: only the pieces of 0 1 2 make a triangle again, but
//       \ | /        that opens no border
//         1
TEST(check, what_cannot_be_recovered_opens_no_border) {
  Surface s;
  s.points = {{0, 0, 0}, {0.5, -1, 0}, {1, 0, 0}, {0.5, 1e-9, 0}, {0.5, 2e-10, 0}, {-1, 0, 0}, {2, 0, 0}};
  s.tris = {{0, 1, 4}, {1, 2, 4}, {0, 4, 3}, {4, 2, 3}, {5, 1, 0}, {1, 6, 2}, {0, 3, 5}, {2, 6, 3}};
  s.vertex.rows = 7, s.face.rows = 8;
  s.face.set("origin", std::vector<int>{0, 0, 1, 1, 2, 3, 4, 5});
  ASSERT_EQ(soundness_of(original_mesh(s)).loops, 2);
  EXPECT_EQ(examine(s, s, nullptr, 10).reference.loops, 1);
}

//   3 - 2     two pieces of one triangle, by what a damaged stream may say of them
//   | / |
//   0 - 1
TEST(check, pieces_that_are_none_stay) {
  const Mesh square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  for (int origin : {-1, 0, 2147483647})
    EXPECT_EQ(recover_triangles(square, {origin, origin}).tris, square.tris);
  const Mesh twice{square.points, {{0, 1, 2}, {0, 2, 1}}};  // their areas cancel out
  EXPECT_EQ(recover_triangles(twice, {0, 0}).tris, twice.tris);
}

//        3      a sharp corner at vertex 0 of a fan: its triangles, and their neighbors, do not count
//      / |
//    0 --2      beyond 2-3 comes a strip of good triangles and one bad one
//      \ |
//        1
TEST(check, sharp_corners_do_not_count) {
  Mesh m{{{0, 0, 0}, {10, -0.2, 0}, {10, 0.2, 0}}, {{0, 1, 2}}};
  // the strip: points 1,2 then pairs every 1 in x
  for (int i = 1; i <= 5; ++i) {
    const int a = (int)m.points.size() - 2, b = a + 1;
    m.points.push_back({10.0 + i, -1.0, 0});
    m.points.push_back({10.0 + i, i == 5 ? 0.2 : 1.0, 0});
    m.tris.push_back({a, a + 2, b});
    m.tris.push_back({b, a + 2, a + 3});
  }
  const Soundness c = soundness_of(m);
  const Quality q = quality_of({m, c.opposite}, {});
  EXPECT_EQ(q.worst, 0);
  int worst = -1;
  const double k = kappa_off_corners({m, c.opposite}, q, worst);
  EXPECT_GT(worst, 4);  // two rings away from the corner
  EXPECT_GT(k, q.kappa_min);
}

//   3-------2    a needle 0 1 2 of 1 degree, whose other side is a large triangle
//    \    /|
//     \ /  |
//      0---1
TEST(check, needles_at_sharp_tips_are_forced) {
  const double thin = std::tan(1 / 57.29577951308232);
  const Mesh m{{{0, 0, 0}, {1, 0, 0}, {1, thin, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const Soundness c = soundness_of(m);
  // without a mark the angle at 0 is right, with one on the edge 2-0 it is a degree
  EXPECT_TRUE(needle_sectors({m, c.opposite}).empty());
  const std::vector<std::uint8_t> model{4, 1};
  const Connectivity marked{m, c.opposite, model};
  const std::vector<Sector> sharp = needle_sectors(marked);
  ASSERT_EQ(sharp.size(), 1u);
  EXPECT_NEAR(sharp[0].angle, 1 / 57.2957795, 1e-6);
  const std::vector<float> kappas{0.03F, 0.8F};
  EXPECT_EQ(forced_needles(marked, kappas, marked), (std::vector<char>{1, 0}));
  // the isosceles triangle of one degree has 0.0346: no corner forces this
  EXPECT_EQ(forced_needles(marked, {0.016F, 0.8F}, marked), (std::vector<char>{0, 0}));
  // nor does a corner elsewhere, or none
  Mesh far = m;
  for (Vec3& p : far.points) p.x += 0.3;
  EXPECT_EQ(forced_needles(marked, kappas, {far, c.opposite, model}), (std::vector<char>{0, 0}));
  EXPECT_EQ(forced_needles(marked, kappas, {m, c.opposite}), (std::vector<char>{0, 0}));
}

//  two needles at 0, of 2 degrees and of half a degree: each is excused as its own sector forces
TEST(check, needles_of_a_fan_are_forced_each_by_its_own_sector) {
  Mesh m{{{0, 0, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  for (double a : {0.0, 2.0, 2.5})
    m.points.push_back({std::cos(a / 57.29577951308232), std::sin(a / 57.29577951308232), 0});
  const Soundness c = soundness_of(m);
  const std::vector<std::uint8_t> model{7, 7};
  const Connectivity fan{m, c.opposite, model};
  EXPECT_EQ(forced_needles(fan, quality_of(fan, {}).kappas, fan), (std::vector<char>{1, 1}));
  EXPECT_EQ(forced_needles(fan, {0.01F, 0.01F}, fan), (std::vector<char>{0, 1}));
}

//  0 <: strip of 8 triangles that opens by a degree: only the first is forced to be as it is
TEST(check, strips_beyond_a_sharp_tip_are_not_forced) {
  Mesh m{{{0, 0, 0}}, {}};
  const double opening = 1 / 57.29577951308232;
  for (int i = 1; i <= 5; ++i) {
    m.points.push_back({(double)i, 0, 0});
    m.points.push_back({(double)i, i * opening, 0});
  }
  m.tris.push_back({0, 1, 2});
  for (int i = 1; i < 5; ++i) {
    const int a = 2 * i - 1;
    m.tris.push_back({a, a + 2, a + 3});
    m.tris.push_back({a, a + 3, a + 1});
  }
  const Soundness c = soundness_of(m);
  const Quality q = quality_of({m, c.opposite}, {});
  std::vector<char> first(m.tris.size(), 0);
  first[0] = 1;
  EXPECT_EQ(forced_needles({m, c.opposite}, q.kappas, {m, c.opposite}), first);
}

TEST(check, needles_of_a_spike_are_forced) {
  Mesh spike{{{0, 0, 100}}, {}};
  for (int i = 0; i < 6; ++i) spike.points.push_back({std::cos(i * 1.0472), std::sin(i * 1.0472), 0});
  for (int i = 0; i < 6; ++i) spike.tris.push_back({0, 1 + i, 1 + (i + 1) % 6});
  const Soundness c = soundness_of(spike);
  const Connectivity cone{spike, c.opposite};
  ASSERT_EQ(needle_sectors(cone).size(), 1u);
  EXPECT_EQ(forced_needles(cone, quality_of(cone, {}).kappas, cone), std::vector<char>(6, 1));
  EXPECT_EQ(forced_needles(cone, std::vector<float>(6, 0.01F), cone), std::vector<char>(6, 0));
  spike.points[0].z = 3;
  EXPECT_TRUE(needle_sectors(cone).empty());
}

TEST(check, weld_joins_what_is_at_one_place) {
  Mesh soup;
  const Mesh good = sphere(100);
  for (const Tri& t : good.tris) {
    const int v = (int)soup.points.size();
    for (int x : t) soup.points.push_back(good.points[x]);
    soup.tris.push_back({v, v + 1, v + 2});
  }
  weld(soup);
  EXPECT_EQ(soup.points.size(), good.points.size());
  EXPECT_TRUE(soundness_of(soup).sound());
}

}  // namespace
}  // namespace meshpipe
