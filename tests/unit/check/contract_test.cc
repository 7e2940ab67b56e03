// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "lib/check/check.h"
#include "lib/core/error.h"
#include "lib/core/topology.h"
#include "lib/core/triangle_count.h"
#include "lib/shape/shape.h"

namespace meshpipe {
namespace {

/// What the default contract finds in a mesh that was made from `reference`.
std::vector<Failure> verdict(const Mesh& mesh, const Mesh& reference,
                             const std::string& contract = default_contract) {
  return judge(parse_contract(contract), examine(surface_of(mesh), surface_of(reference), nullptr, 2000),
               mesh);
}

bool fails(const std::vector<Failure>& failures, const std::string& requirement) {
  for (const Failure& f : failures)
    if (f.requirement == requirement) return true;
  return false;
}

/// Two spheres around each other, the normals of the inner one inward; `inside_out`: both the other way.
Mesh shell(int triangles, double gap, bool inside_out) {
  Mesh m = sphere(triangles);
  const int n = (int)m.points.size(), n_tris = (int)m.tris.size();
  for (int v = 0; v < n; ++v) m.points.push_back((1 - gap) * m.points[v]);
  for (int t = 0; t < n_tris; ++t) {
    const Tri c = m.tris[t];
    m.tris.push_back({c[0] + n, c[2] + n, c[1] + n});
  }
  if (inside_out)
    for (Tri& t : m.tris) std::swap(t[0], t[1]);
  return m;
}

TEST(contract, thin_bodies_that_are_inside_out_fail) {
  Mesh plate = cube(600);
  for (Vec3& p : plate.points) p.z *= 0.003;  // a twentieth of an edge
  Mesh reversed = plate;
  for (Tri& t : reversed.tris) std::swap(t[0], t[1]);
  EXPECT_FALSE(fails(verdict(plate, plate), "topology"));
  EXPECT_TRUE(fails(verdict(reversed, plate), "topology"));
  // chords sag to the other side and beyond
  for (double gap : {0.002, 0.006, 0.02}) {
    EXPECT_FALSE(fails(verdict(shell(600, gap, false), shell(6000, gap, false)), "topology")) << gap;
    EXPECT_TRUE(fails(verdict(shell(600, gap, true), shell(6000, gap, false)), "topology")) << gap;
  }
}

//          crease
//     a ------+.      the edge ab crosses a corner that is cut off at 45 degrees. Only one of 90 degrees
//              '.     would be a crease, and there is one: near to it, of another component or of this one
//                |
//                b
TEST(contract, creases_of_other_components_are_not_cut) {
  const Mesh result{{{-0.5, 0, 0}, {0, 0, -0.5}, {-0.05, 0.35, -0.05}, {-0.05, -0.35, -0.05}},
                    {{0, 1, 2}, {1, 0, 3}}};
  auto roof = [](std::vector<std::array<double, 2>> profile, Surface s = {}) {
    const int first = (int)s.points.size();
    for (const auto& [x, z] : profile)
      for (double y : {-1.0, 1.0}) s.points.push_back({x, y, z});
    for (int i = first; i + 3 < (int)s.points.size(); i += 2)
      s.tris.insert(s.tris.end(), {{i, i + 2, i + 3}, {i, i + 3, i + 1}});
    return s;
  };
  auto cut = [&](Surface reference, std::vector<int> halfedges) {
    std::vector<std::uint8_t> model(reference.tris.size());
    const std::vector<int> opposite = opposite_halfedges(reference);
    for (int crease : halfedges)
      for (int h : {crease, opposite[crease]}) model[h / 3] |= 1 << h % 3;
    reference.face.set("model", model);
    const std::vector<int> sides = opposite_halfedges(result);
    return find_cut_creases({result, sides}, reference).size();
  };
  const Surface own = roof({{-1, 0.02}, {0.02, 0.02}, {0.02, -1}});
  const std::vector<std::array<double, 2>> other{{0, 1}, {0, 0}, {1, 0}};  // nearer
  EXPECT_EQ(cut(own, {1}), 1u);
  EXPECT_EQ(cut(roof(other, roof({{-1, 0}, {-0.1, 0}, {0, -0.1}, {0, -1}})), {6 * 3 + 1}), 0u);
  EXPECT_EQ(cut(roof(other, own), {1, 4 * 3 + 1}), 1u);
  EXPECT_EQ(cut(roof({{-1, 0.02}, {0.02, 0.02}, {0.02, -1}}, roof(other)), {1, 4 * 3 + 1}), 1u);
}

TEST(contract, lists_are_read_and_refused) {
  const Contract c = parse_contract("topology,kappa=0.25,hausdorff=1e-3");
  ASSERT_EQ(c.size(), 3u);
  EXPECT_EQ(c[0].name, "topology");
  EXPECT_EQ(c[1].limit, 0.25);
  EXPECT_EQ(c[2].limit, 1e-3);
  for (const char* bad : {"", "topologie", "kappa", "kappa=", "kappa=x", "kappa=0.1x", "topology=1",
                          "kappa=-1", "hausdorff=inf", "mean=nan", "topology,", "angle=30 "})
    EXPECT_THROW(parse_contract(bad), BadUsage) << bad;
}

TEST(contract, what_is_not_a_number_fails_and_what_there_is_not_does_not) {
  const Surface m = surface_of(sphere(500));
  Findings f = examine(m, m, nullptr, 1000);
  const Contract c = parse_contract("features=1,trace=1,mean=1,boundary=1,vertices=1,size=1");
  EXPECT_TRUE(judge(c, f, m).empty());
  const double nan = std::nan("");
  f.features = f.kappa_by_cuts = f.kappa_elsewhere = f.distance.mean = f.boundary = f.quality.edge_deviation =
      f.off[f.farthest] = nan;
  EXPECT_EQ(judge(c, f, m).size(), c.size());
  EXPECT_FALSE(offending_faces(c, f, m).tris.empty());
}

TEST(contract, nothing_is_found_where_nothing_is) {
  for (const Mesh& m : {sphere(500), torus(0.4, 800), Mesh(cube(600)), tube(3, 40, false)})
    EXPECT_TRUE(verdict(m, m).empty()) << verdict(m, m)[0].fact;
  // every part of the sphere is there, in other triangles
  EXPECT_TRUE(
      verdict(sphere(900), sphere(2000), "topology,intersections,folds,patches,vertices=0.1").empty());
}

TEST(contract, a_flipped_triangle) {
  Mesh m = sphere(500);
  std::swap(m.tris[7][0], m.tris[7][1]);
  const auto f = verdict(m, sphere(500));
  ASSERT_TRUE(fails(f, "topology"));
  EXPECT_EQ(f[0].fact.rfind("3 edges whose triangles disagree on orientation, the first in triangle ", 0),
            0u);
}

TEST(contract, a_hole) {
  Mesh m = sphere(500);
  m.tris.erase(m.tris.begin());
  const auto f = verdict(m, sphere(500));
  ASSERT_EQ(f.size(), 1u);
  EXPECT_EQ(f[0].fact.rfind("boundary loops 1, the reference has 0; the shortest passes triangle ", 0), 0u);
}

TEST(contract, a_crack) {
  // the triangles on one side of two edges in a row get a middle vertex of their own: a slit without width
  const Mesh good = torus(0.4, 800);
  const Soundness c = soundness_of(good);
  Mesh m = good;
  const int v = m.tris[0][0], copy = (int)m.points.size();
  std::vector<int> fan;
  for (int h = 0;;) {
    fan.push_back(h);
    h = c.opposite[prev(h)];
    if (h == 0) break;
  }
  m.points.push_back(m.points[v]);
  for (int i = 0; i < 3; ++i) m.tris[fan[i] / 3][fan[i] % 3] = copy;
  const auto f = verdict(m, good);
  ASSERT_TRUE(fails(f, "topology"));
  EXPECT_NE(f[0].fact.find("boundary loops 1, the reference has 0"), std::string::npos) << f[0].fact;
}

TEST(contract, a_fold) {
  // a vertex pulled over the far side of one of its triangles, off the surface by so little that nothing
  // meets
  Mesh m;
  const int n = 6;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) m.points.push_back({(double)x, (double)y, 0});
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const int a = y * (n + 1) + x;
      m.tris.push_back({a, a + 1, a + n + 2});
      m.tris.push_back({a, a + n + 2, a + n + 1});
    }
  const Mesh good = m;
  Vec3& p = m.points[3 * (n + 1) + 3];
  p = {4.4, 3.6, 0.05};
  const auto f = verdict(m, good, "folds");
  ASSERT_TRUE(fails(f, "folds"));
  EXPECT_NE(f[0].fact.find(" folded, the first in triangle "), std::string::npos);
}

TEST(contract, thin_walls_and_ridges_are_no_folds) {
  // a coarse ridge of 20 degrees, whose reference is finer
  const Mesh ridge{{{0, 0, 0}, {0, 3, 0}, {-0.2, 0, 1}, {-0.2, 3, 1}, {0.2, 0, 1}, {0.2, 3, 1}},
                   {{0, 1, 3}, {0, 3, 2}, {1, 0, 4}, {1, 4, 5}}};
  EXPECT_TRUE(verdict(ridge, ridge, "folds").empty());
}

TEST(contract, a_doubled_triangle) {
  Mesh m = sphere(500);
  m.tris.push_back(m.tris[5]);
  const auto f = verdict(m, sphere(500));
  ASSERT_TRUE(fails(f, "topology"));
  EXPECT_NE(f[0].fact.find("3 edges with more than two triangles, the first in triangle "),
            std::string::npos);
  EXPECT_TRUE(fails(f, "intersections"));
}

TEST(contract, a_moved_vertex) {
  const Mesh good = sphere(2000);
  Mesh m = good;
  const Tri& t = m.tris[3];
  const double edge = norm(m.points[t[0]] - m.points[t[1]]);
  m.points[t[0]] = m.points[t[0]] + 0.4 * edge * normalized(m.points[t[0]]);
  auto f = verdict(m, good);
  ASSERT_EQ(f.size(), 1u);
  EXPECT_EQ(f[0].requirement, "vertices");
  EXPECT_NE(f[0].fact.find("vertex " + std::to_string(t[0]) + " lies off the reference, at ("),
            std::string::npos);
  f = verdict(m, good, "hausdorff=0.001");
  ASSERT_EQ(f.size(), 1u);
  EXPECT_NE(f[0].fact.find(" the distance found at ("), std::string::npos);
}

TEST(contract, a_lost_limb_a_lost_end_and_another_size) {
  // a sphere with a spike that the result has not, and the other way round
  const Mesh good = sphere(2000);
  Mesh spiked = good;
  const int tip = spiked.tris[3][0];
  spiked.points[tip] = 1.3 * spiked.points[tip];
  for (const auto& [mesh, reference] : {std::pair{good, spiked}, std::pair{spiked, good}}) {
    const auto f = verdict(mesh, reference, "deviation=1");
    ASSERT_EQ(f.size(), 1u);
    EXPECT_GT(f[0].value, 1);
    EXPECT_NEAR(norm(f[0].place - spiked.points[tip]), 0, 0.1);
  }
  EXPECT_TRUE(fails(verdict(tube(3, 20, false), tube(4, 20, false)), "deviation"));
  // two components far apart, one of them twice: the topology is the same
  Mesh two = sphere(500), twice = sphere(500);
  for (auto [m, shift] : {std::pair{&two, 5.0}, std::pair{&twice, 0.0}}) {
    const int n = (int)m->points.size(), faces = (int)m->tris.size();
    for (int v = 0; v < n; ++v) m->points.push_back(m->points[v] + Vec3{shift, 0, 0});
    for (int t = 0; t < faces; ++t)
      m->tris.push_back({m->tris[t][0] + n, m->tris[t][1] + n, m->tris[t][2] + n});
  }
  EXPECT_TRUE(fails(verdict(twice, two, "deviation=1"), "deviation"));
  // far coarser, but nothing is lost
  EXPECT_TRUE(verdict(sphere(60), sphere(2000), "deviation=0.3").empty());
}

TEST(contract, sizes_are_smaller_where_the_distance_is_missed) {
  const Mesh good = sphere(2000);
  Mesh spiked = good;
  const int tip = spiked.tris[3][0];
  spiked.points[tip] = 1.3 * spiked.points[tip];
  Surface result = surface_of(good);
  result.vertex.set("size", std::vector<double>(good.points.size(), 0.1));
  const Contract contract = parse_contract("deviation=1");
  Findings f = examine(result, surface_of(spiked), nullptr, 2000);
  const std::vector<double> size = smaller_sizes(contract, f, result, spiked);
  EXPECT_LT(size[tip], 0.05);
  EXPECT_GT(std::count(size.begin(), size.end(), 0.1), 900);
  f.reference_pairs.apart = (int)spiked.tris.size() + 1;
  EXPECT_EQ(smaller_sizes(contract, f, result, spiked), result.vertex.get<double>("size")) << "a tangle";
}

TEST(contract, sizes_count_where_the_result_misses_the_reference) {
  const Mesh result = sphere(500);
  std::vector<double> size(result.points.size(), 0.2);
  size[0] = 0.01;
  EXPECT_DOUBLE_EQ(triangles_asked_for(result, size, sphere(60)), count_for_size(result, size));
  Mesh limb{{2 * result.points[0]}, {{0, 1, 2}}};  // that small size is nearest to all of it
  limb.points.push_back(limb.points[0] + Vec3{0, 0.1, 0});
  limb.points.push_back(limb.points[0] + Vec3{0, 0, 0.1});
  EXPECT_NEAR(triangles_asked_for(result, size, limb) - count_for_size(result, size),
              0.005 / (0.25 * std::sqrt(3.0) * 1e-4), 1);
}

TEST(contract, a_crossing_and_a_lost_name) {
  Surface good = surface_of(sphere(500));
  std::vector<int> patch(good.tris.size(), 1);
  patch[20] = 2;
  good.face.set("patch", std::move(patch));
  Findings f = examine(good, good, nullptr, 2000);
  f.patch_faults = {{"patch inlet is lost"}, {"patch 2 is short", {2}}};
  f.intersections = {{4, 9}, {5, 8}};
  f.new_intersections = {{4, 9}};
  f.reference_pairs.all = 1;
  const Contract contract = parse_contract(default_contract);
  const auto failures = judge(contract, f, good);
  ASSERT_EQ(failures.size(), 3u);
  EXPECT_EQ(failures[0].requirement, "intersections");
  EXPECT_NE(failures[0].fact.find("triangle 9 with triangle 4 at ("), std::string::npos);
  EXPECT_EQ(failures[1].fact, "patch inlet is lost");
  const Surface faulty = offending_faces(contract, f, good);
  EXPECT_EQ(faulty.face.get<int>("triangle"), (std::vector<int>{4, 9, 20}));
  EXPECT_EQ(faulty.face.get<std::uint8_t>("fault"),
            (std::vector<std::uint8_t>{offends_intersections, offends_intersections, offends_patches}));
  good.vertex.set("size", std::vector<double>(good.points.size(), 1));
  f.new_intersections.clear();
  const std::vector<double> size = smaller_sizes(contract, f, good, good);
  for (int v : good.tris[20]) EXPECT_NEAR(size[v], 0.5, 1e-12);
  EXPECT_GT(std::count(size.begin(), size.end(), 1), (int)size.size() / 2);
}

TEST(contract, figures_by_the_cuts) {
  // interface x = 0 of a plane: there the triangles are worse
  Surface m;
  for (int y = 0; y <= 20; ++y)
    for (int x = -20; x <= 20; ++x)
      m.points.push_back({(double)x, std::sqrt(0.75) * (y + (std::abs(x) <= 1 ? 0.3 * (x % 2) : 0)), 0});
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 40; ++x) {
      const int a = y * 41 + x;
      m.tris.push_back({a, a + 1, a + 42});
      m.tris.push_back({a, a + 42, a + 41});
    }
  m.vertex.rows = m.points.size();
  m.face.rows = m.tris.size();
  Lines lines;
  lines.lines.push_back({interface_line, 0, 0, 21, 0});
  for (int y = 0; y <= 20; ++y) lines.points.push_back({y * 41 + 20, y * 41 + 20, 0});
  const Findings f = examine(m, m, &lines, 1000);
  EXPECT_LT(*f.kappa_by_cuts, *f.kappa_elsewhere - 0.003);
  EXPECT_TRUE(fails(judge(parse_contract("trace=0.003"), f, m), "trace"));
  lines.lines[0].kind = model_line;
  EXPECT_FALSE(examine(m, m, &lines, 1000).kappa_by_cuts);
}

}  // namespace
}  // namespace meshpipe
