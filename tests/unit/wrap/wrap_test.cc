// SPDX-License-Identifier: BSD-3-Clause
#include "lib/wrap/wrap.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>

#include "lib/core/error.h"
#include "lib/shape/shape.h"
#include "lib/wrap/valid.h"

namespace meshpipe {
namespace {

double volume(const Mesh& m) {
  double v = 0;
  for (const Tri& t : m.tris) v += dot(m.points[t[0]], cross(m.points[t[1]], m.points[t[2]])) / 6;
  return v;
}

/// Adds a box of 12 triangles between two corners.
void add_box(Mesh& m, Vec3 lo, Vec3 hi) {
  const int n = (int)m.points.size();
  for (int c = 0; c < 8; ++c)
    m.points.push_back({c & 1 ? hi.x : lo.x, c & 2 ? hi.y : lo.y, c & 4 ? hi.z : lo.z});
  const int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& [a, b, c, d] : quads) {
    m.tris.push_back({n + a, n + b, n + c});
    m.tris.push_back({n + a, n + c, n + d});
  }
}

/// A rectangle of two triangles in the plane of `height` along z.
void add_rectangle(Mesh& m, Vec2 lo, Vec2 hi, double height) {
  const int n = (int)m.points.size();
  m.points.insert(m.points.end(),
                  {{lo.x, lo.y, height}, {hi.x, lo.y, height}, {hi.x, hi.y, height}, {lo.x, hi.y, height}});
  m.tris.insert(m.tris.end(), {{n, n + 1, n + 2}, {n, n + 2, n + 3}});
}

/// An open box of side 4 whose lid has a square hole.
Mesh box_with_hole(double width) {
  Mesh m;
  add_box(m, {-2, -2, -2}, {2, 2, 2});
  m.tris.resize(10);  // the last two are the side z = 2
  const double w = width / 2;
  add_rectangle(m, {-2, -2}, {2, -w}, 2);
  add_rectangle(m, {-2, w}, {2, 2}, 2);
  add_rectangle(m, {-2, -w}, {-w, w}, 2);
  add_rectangle(m, {w, -w}, {2, w}, 2);
  return m;
}

double distance_of_nearest_vertex(const Mesh& m, Vec3 p) {
  double nearest = 1e300;
  for (Vec3 x : m.points) nearest = std::min(nearest, norm(x - p));
  return nearest;
}

struct Wrapped {
  Mesh mesh;
  WrapReport report;
};
/// `wrap` throws unless its result passes verify_wrap.
Wrapped wrapped(const Mesh& soup, double alpha, double offset) {
  Wrapped w;
  w.mesh = wrap(soup, {alpha, offset}, w.report);
  return w;
}

TEST(wrap, sphere_with_holes_and_flipped_triangles_is_closed) {
  Mesh soup = sphere(1000);
  for (std::size_t t = 0; t < soup.tris.size(); t += 3) std::swap(soup.tris[t][0], soup.tris[t][1]);
  for (std::size_t t = 0; t < soup.tris.size(); t += 40) soup.tris[t] = soup.tris[t + 1];
  const auto [mesh, r] = wrapped(soup, 0.3, 0.05);
  EXPECT_EQ(r.components, 1);
  EXPECT_EQ(r.genus, 0);
  for (Vec3 p : mesh.points) {
    EXPECT_GT(norm(p), 0.99);
    EXPECT_LT(norm(p), 1.08);
  }
}

TEST(wrap, interpenetrating_boxes_become_one_body_with_sharp_edges) {
  Mesh soup;
  add_box(soup, {0, 0, 0}, {2, 1, 1});
  add_box(soup, {0.5, 0.5, 0.5}, {1.5, 1.5, 1.7});
  const auto [mesh, r] = wrapped(soup, 0.2, 0.02);
  EXPECT_EQ(r.components, 1);
  EXPECT_EQ(r.genus, 0);
  // the union with 0.02 around it
  EXPECT_NEAR(volume(mesh), 2 + 1.2 - 0.25 + 0.02 * 14.3, 0.02);
  EXPECT_LT(distance_of_nearest_vertex(mesh, {-0.02, -0.02, -0.02}), 2e-3);
  EXPECT_LT(distance_of_nearest_vertex(mesh, {1.52, 1.52, 1.72}), 2e-3);
}

TEST(wrap, open_plane_gets_two_sides) {
  Mesh soup;
  add_rectangle(soup, {0, 0}, {2, 1}, 0);
  const auto [mesh, r] = wrapped(soup, 0.2, 0.03);
  EXPECT_EQ(r.components, 1);
  EXPECT_EQ(r.genus, 0);
  for (Vec3 p : mesh.points)
    if (p.x > 0.2 && p.x < 1.8 && p.y > 0.2 && p.y < 0.8) {
      EXPECT_NEAR(std::abs(p.z), 0.03, 1e-3);
    }
}

TEST(wrap, triangle_segment_and_point_are_wrapped) {
  const std::vector<Vec3> corners[] = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                       {{0, 0, 0}, {1, 1, 0.5}, {0.5, 0.5, 0.25}},
                                       {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}};
  for (const auto& points : corners) {
    Mesh soup;
    soup.points = points;
    soup.tris.push_back({0, 1, 2});
    const auto [mesh, r] = wrapped(soup, 0.2, 0.05);
    EXPECT_EQ(r.components, 1);
    EXPECT_EQ(r.genus, 0);
    EXPECT_GT(r.clearance, 0);
    EXPECT_LE(r.farthest, r.farthest_allowed);
  }
}

TEST(wrap, enters_holes_wider_than_alpha_only) {
  constexpr double alpha = 0.5, offset = 0.1;
  const double closed = volume(wrapped(box_with_hole(alpha + 2 * offset), alpha, offset).mesh);
  EXPECT_NEAR(closed, 4.2 * 4.2 * 4.2, 2);
  // as documented: always if it is wider than 2.1 alpha plus twice the offset
  const double open = volume(wrapped(box_with_hole(2.1 * alpha + 2 * offset), alpha, offset).mesh);
  EXPECT_LT(open, 30);
}

TEST(wrap, closed_gaps_end_in_no_fins) {
  // between the nearest edges of two boxes, where the gap is narrower than alpha
  Mesh soup;
  add_box(soup, {0, 0, 0}, {1, 1, 1});
  add_box(soup, {1.1, 1.1, 0}, {2, 2, 1});
  const auto [mesh, r] = wrapped(soup, 0.2, 0.04);
  const auto thin =
      triangles_that_meet_others(mesh, std::vector<std::uint8_t>(mesh.tris.size(), 1), 0.25 * r.spacing);
  EXPECT_EQ(std::count(thin.begin(), thin.end(), 1), 0);
}

TEST(wrap, components_stay_apart_and_cavities_are_filled) {
  Mesh soup;
  add_box(soup, {0, 0, 0}, {1, 1, 1});
  add_box(soup, {0.3, 0.3, 0.3}, {0.7, 0.7, 0.7});
  add_box(soup, {3, 0, 0}, {4, 1, 1});
  const auto [mesh, r] = wrapped(soup, 0.2, 0.05);
  EXPECT_EQ(r.components, 2);
  EXPECT_EQ(r.genus, 0);
}

TEST(wrap, is_the_same_at_any_number_of_threads) {
  Mesh soup = sphere(500);
  add_box(soup, {0, 0, 0}, {1, 1, 1});
  const int usual = omp_get_max_threads();
  omp_set_num_threads(1);
  const Mesh one = wrapped(soup, 0.2, 0.01).mesh;
  omp_set_num_threads(3);
  const Mesh three = wrapped(soup, 0.2, 0.01).mesh;
  omp_set_num_threads(usual);
  EXPECT_EQ(one.points, three.points);
  EXPECT_EQ(one.tris, three.tris);
}

TEST(wrap, refuses_an_empty_soup_and_too_small_an_alpha) {
  WrapReport r;
  EXPECT_THROW(wrap({}, {1, 1}, r), NotAdmissible);
  try {
    wrap(sphere(100), {1e-5, 1e-6}, r);
    FAIL();
  } catch (const BadUsage& e) {
    EXPECT_NE(std::string(e.what()).find("the limit of 4 GiB; try --alpha "), std::string::npos) << e.what();
  }
  EXPECT_THROW(wrap(sphere(100), {0.1, 0.02, 5 << 20}, r), BadUsage);
}

TEST(verify_wrap, finds_what_is_broken) {
  const Mesh soup = sphere(100);
  const auto [good, report] = wrapped(soup, 0.5, 0.1);
  WrapReport r = report;
  EXPECT_NO_THROW(verify_wrap(good, soup, r));
  Mesh open = good;
  open.tris.pop_back();
  EXPECT_THROW(verify_wrap(open, soup, r), ContractMissed);
  Mesh inward = good;
  for (Tri& t : inward.tris) std::swap(t[0], t[1]);
  EXPECT_THROW(verify_wrap(inward, soup, r), ContractMissed);
  Mesh small = good;
  for (Vec3& p : small.points) p = 0.7 * p;
  EXPECT_THROW(verify_wrap(small, soup, r), ContractMissed);
  Mesh elsewhere = good;
  for (Vec3& p : elsewhere.points) p = p + Vec3{5, 0, 0};
  EXPECT_THROW(verify_wrap(elsewhere, soup, r), ContractMissed);
  Mesh large = good;
  for (Vec3& p : large.points) p = 3 * p;
  EXPECT_THROW(verify_wrap(large, soup, r), ContractMissed);
  Mesh spiked = good;
  spiked.points[0] = -1.5 * spiked.points[0];
  EXPECT_THROW(verify_wrap(spiked, soup, r), ContractMissed);
}

}  // namespace
}  // namespace meshpipe
