// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "lib/core/error.h"
#include "lib/core/regions.h"
#include "lib/core/topology.h"
#include "lib/plan/plan.h"
#include "tests/unit/parts.h"

using namespace meshpipe;

namespace {

// n x m squares of two triangles, wrapped around in both directions where asked
Surface wrapped_grid(int n, int m, bool wrap_x, bool wrap_y, Vec3 (*place)(double, double)) {
  Surface s;
  int w = wrap_x ? n : n + 1, h = wrap_y ? m : m + 1;
  for (int j = 0; j < h; ++j)
    for (int i = 0; i < w; ++i) s.points.push_back(place((double)i / n, (double)j / m));
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      int a = j * w + i, b = j * w + (i + 1) % w, d = (j + 1) % h * w + i, c = (j + 1) % h * w + (i + 1) % w;
      s.tris.push_back({a, b, c});
      s.tris.push_back({a, c, d});
    }
  return s;
}

constexpr double tau = 6.283185307179586;

Surface torus(int n = 60, int m = 24) {
  return wrapped_grid(n, m, true, true, [](double x, double y) {
    double r = 2 + 0.7 * std::cos(tau * y);
    return Vec3{r * std::cos(tau * x), r * std::sin(tau * x), 0.7 * std::sin(tau * y)};
  });
}

Surface tube(int n = 20, int m = 30) {
  return wrapped_grid(n, m, true, false, [](double x, double y) {
    return Vec3{std::cos(tau * x), std::sin(tau * x), 6 * y};
  });
}

// k x k squares a side; vertices on the edges of the cube are shared
Surface cube(int k) {
  Surface s;
  std::map<std::array<int, 3>, int> number;
  auto vertex = [&](std::array<int, 3> p) {
    auto [it, added] = number.insert({p, (int)s.points.size()});
    if (added) s.points.push_back({(double)p[0], (double)p[1], (double)p[2]});
    return it->second;
  };
  std::vector<std::uint8_t> model;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < k; ++i)
        for (int j = 0; j < k; ++j) {
          auto at = [&](int x, int y) {
            std::array<int, 3> p;
            p[axis] = side * k;
            p[(axis + 1) % 3] = side ? x : y;
            p[(axis + 2) % 3] = side ? y : x;
            return vertex(p);
          };
          int a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
          s.tris.push_back({a, b, c});
          s.tris.push_back({a, c, d});
          model.push_back((std::uint8_t)((j == 0) | (i == k - 1) << 1));
          model.push_back((std::uint8_t)((j == k - 1) << 1 | (i == 0) << 2));
        }
  s.face.set("model", std::move(model));
  return s;
}

// a slab with g square holes in a row, all of unit squares; genus g
Surface slab(int g, int refine) {
  Surface s;
  int w = (2 * g + 1) * refine, d = 3 * refine;
  auto solid = [&](int x, int y) {
    return x >= 0 && x < w && y >= 0 && y < d && !(x / refine % 2 == 1 && y / refine == 1);
  };
  std::map<std::array<int, 3>, int> number;
  auto vertex = [&](int x, int y, int z) {
    auto [it, added] = number.insert({{x, y, z}, (int)s.points.size()});
    if (added) s.points.push_back({(double)x, (double)y, (double)z});
    return it->second;
  };
  auto quad = [&](int p, int q, int r, int t) {
    s.tris.push_back({p, q, r});
    s.tris.push_back({p, r, t});
  };
  for (int x = 0; x < w; ++x)
    for (int y = 0; y < d; ++y) {
      if (!solid(x, y)) continue;
      quad(vertex(x, y, refine), vertex(x + 1, y, refine), vertex(x + 1, y + 1, refine),
           vertex(x, y + 1, refine));
      quad(vertex(x, y, 0), vertex(x, y + 1, 0), vertex(x + 1, y + 1, 0), vertex(x + 1, y, 0));
      for (int z = 0; z < refine; ++z) {
        auto wall = [&](int x0, int y0, int x1, int y1) {
          quad(vertex(x0, y0, z), vertex(x1, y1, z), vertex(x1, y1, z + 1), vertex(x0, y0, z + 1));
        };
        if (!solid(x, y - 1)) wall(x, y, x + 1, y);
        if (!solid(x + 1, y)) wall(x + 1, y, x + 1, y + 1);
        if (!solid(x, y + 1)) wall(x + 1, y + 1, x, y + 1);
        if (!solid(x - 1, y)) wall(x, y + 1, x, y);
      }
    }
  return s;
}

void expect_same_surface(const Surface& before, const Surface& after) {
  ASSERT_GE(after.points.size(), before.points.size());
  EXPECT_TRUE(std::equal(before.points.begin(), before.points.end(), after.points.begin()));
  EXPECT_NEAR(total_area(after), total_area(before), 1e-9 * total_area(before));
  Topology a = topology_of(before), b = topology_of(after);
  EXPECT_EQ(a.genus, b.genus);
  EXPECT_EQ(a.loops, b.loops);
  EXPECT_EQ(after.face.get<int>("origin").size(), after.tris.size());
}

}  // namespace

//  +-----+     the corners 0, 1, 2 of a strip of three triangles; 1 in the middle
//  |\ 1 /|
//  |0\ /2|
//  +--+--+
TEST(Regions, CountFansLoopsAndPinches) {
  Mesh m{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}, {{0, 1, 4}, {1, 3, 4}, {1, 2, 3}}};
  auto opposite = opposite_halfedges(m.tris, 5);
  std::vector<int> label{0, 1, 0};
  Regions r = find_regions({m, opposite}, label, 2);
  EXPECT_TRUE(r.region[0].pinched);  // at vertex 1
  EXPECT_EQ(r.region[0].loops, 2);
  EXPECT_TRUE(r.region[1].maps_to_the_plane());
  label = {0, 1, 2};
  Joiner joiner({m, opposite}, label, find_regions({m, opposite}, label, 3));
  EXPECT_TRUE(joiner.joined(0, 2).pinched);
  EXPECT_TRUE(joiner.joined(0, 1).maps_to_the_plane());
  joiner.join(0, 1);
  EXPECT_EQ(label, (std::vector<int>{0, 0, 2}));
  EXPECT_TRUE(joiner.joined(0, 2).maps_to_the_plane());
  EXPECT_EQ(joiner.joined(0, 2).border, 5);
}

TEST(Regions, JoinedIsWhatCountingAgainFinds) {
  Surface s = torus(12, 9);
  auto opposite = opposite_halfedges(s.tris, (int)s.points.size());
  std::vector<int> label;
  for (int t = 0; t < (int)s.tris.size(); ++t) label.push_back(t / 2 % 12 / 3 + 4 * (t / 24 / 3));
  Joiner joiner({s, opposite}, label, find_regions({s, opposite}, label, 12));
  for (int b :
       {1, 2, 3, 4, 8, 5}) {  // a ring, then across; in the end a piece of genus 0 with holes, or pinched
    Region joined = joiner.joined(0, b);
    joiner.join(0, b);
    Region counted = find_regions({s, opposite}, label, 12).region[0];
    EXPECT_EQ(joined.faces, counted.faces);
    EXPECT_EQ(joined.border, counted.border);
    EXPECT_EQ(joined.inside, counted.inside);
    EXPECT_EQ(joined.loops, counted.loops);
    EXPECT_EQ(joined.pinched, counted.pinched);
  }
}

TEST(Partition, LeavesAPartThatMapsToThePlaneAlone) {
  Surface s = tube();
  const auto before = s.tris;
  EXPECT_EQ(partition_to_disks(s), 1);
  EXPECT_EQ(s.tris, before);
  EXPECT_EQ(s.face.get<int>("part"), std::vector<int>(before.size(), 0));
}

TEST(Partition, CutsATorusIntoTwoRings) {
  Surface s = torus();
  const Surface before = s;
  EXPECT_EQ(partition_to_disks(s), 2);
  EXPECT_EQ(part_fault(s), "");
  expect_same_surface(before, s);
  Interfaces i = measure_interfaces(s);
  EXPECT_EQ(i.junctions, 0);
  // along the outer and the inner equator, or the highest and the lowest circle: two rings that are nearly
  // flat in the plane, where two halves of the tube would have to be cut lengthwise again
  EXPECT_LT(i.length * diagonal(s), 2 * tau * 2 * 1.05);
  EXPECT_LT(i.turning_angle, 30);
}

TEST(Partition, HalvesAClosedSurfaceOfGenus0) {
  Surface s = cube(8), without = s;
  without.face.erase("model");
  const Surface before = s;
  EXPECT_EQ(partition_to_disks(without), 2);
  EXPECT_EQ(part_fault(without), "");
  expect_same_surface(before, without);
  EXPECT_EQ(partition_to_disks(s), 6);  // cut along model edges only
  expect_same_surface(before, s);
  const auto& part = s.face.get<int>("part");
  const auto& model = s.face.get<std::uint8_t>("model");
  auto opposite = opposite_halfedges(s.tris, (int)s.points.size());
  int on = 0, off = 0;
  for (int h = 0; h < (int)opposite.size(); ++h)
    if (part[h / 3] != part[opposite[h] / 3]) (model[h / 3] >> h % 3 & 1 ? on : off) += 1;
  EXPECT_GT(on, 0);
  EXPECT_EQ(off, 0);
}

TEST(Partition, NeedsAtMostTwoMorePartsThanHandles) {
  for (int g : {1, 2, 4}) {
    Surface s = slab(g, 3);
    const Surface before = s;
    ASSERT_EQ(topology_of(s).genus, g);
    int n = partition_to_disks(s);
    EXPECT_LE(n, g + 2);
    EXPECT_EQ(part_fault(s), "");
    expect_same_surface(before, s);
  }
}

TEST(Partition, CutsAlongHandlesAreNoWorse) {
  Surface s = slab(3, 3), t = s;
  const Surface before = s;
  PartitionOptions options;
  const int n = partition_to_disks(s, options);
  options.homology = true;
  EXPECT_LE(partition_to_disks(t, options), n + 1);  // charts count, and a part may come to two
  EXPECT_EQ(part_fault(t), "");
  expect_same_surface(before, t);
}

TEST(Partition, CutsTheSmallestSurfaces) {
  Surface s = cube(1);
  s.face.erase("model");
  EXPECT_EQ(partition_to_disks(s), 2);
  EXPECT_EQ(part_fault(s), "");
  //  tetrahedron
  s = {};
  s.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  s.tris = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  EXPECT_EQ(partition_to_disks(s), 2);
  EXPECT_EQ(part_fault(s), "");
  s = {};
  EXPECT_EQ(partition_to_disks(s), 0);
}

TEST(Partition, TreatsComponentsOneByOne) {
  Surface s = torus(30, 12);
  const Surface t = tube();
  const int n = (int)s.points.size();
  for (Vec3 p : t.points) s.points.push_back(p + Vec3{10, 0, 0});
  for (Tri v : t.tris) s.tris.push_back({v[0] + n, v[1] + n, v[2] + n});
  EXPECT_EQ(partition_to_disks(s), 3);
  EXPECT_EQ(part_fault(s), "");
}

TEST(Partition, BoundsTheTrianglesOfAPart) {
  Surface s = torus();
  PartitionOptions options;
  options.max_faces = 500;
  int n = partition_to_disks(s, options);
  EXPECT_EQ(part_fault(s), "");
  std::vector<int> count(n, 0);
  for (int p : s.face.get<int>("part")) ++count[p];
  EXPECT_LE(*std::max_element(count.begin(), count.end()), 500);
}

TEST(Partition, BoundsThemEachBelowAHundredthOfTheSurface) {
  Surface s = torus(80, 30);
  PartitionOptions options;
  options.max_faces = 55;
  const int n = partition_to_disks(s, options);
  EXPECT_EQ(part_fault(s), "");
  std::vector<int> count(n, 0);
  for (int p : s.face.get<int>("part")) ++count[p];
  EXPECT_LE(*std::max_element(count.begin(), count.end()), 55);
}

TEST(Partition, GivesTheSameForTheSameSeed) {
  Surface a = slab(2, 3), b = a;
  partition_to_disks(a);
  partition_to_disks(b);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.tris, b.tris);
  EXPECT_EQ(a.face.get<int>("part"), b.face.get<int>("part"));
}

TEST(Partition, RefusesWhatIsNotAManifold) {
  Surface s;  // a bow tie
  s.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  s.tris = {{0, 1, 2}, {0, 3, 4}};
  EXPECT_THROW(partition_to_disks(s), NotAdmissible);
}

TEST(Partition, FaultsAreNamed) {
  Surface s = tube(6, 4);
  std::vector<int> part(s.tris.size(), 0);
  auto fault = [&] {
    s.face.set("part", part);
    return part_fault(s);
  };
  EXPECT_EQ(fault(), "");
  part.back() = 2;
  EXPECT_EQ(fault(), "part 1 of 3 has no triangles");
  part.front() = part.back() = 1;
  EXPECT_EQ(fault(), "part 1 has 2 pieces");
  part.assign(s.tris.size(), 0);
  part[2 * 6] = 1, part[2 * 13] = 2;  // two triangles with a corner in common
  EXPECT_EQ(fault(), "part 0 touches itself at vertex 13");
  part.front() = -1;
  EXPECT_EQ(fault(), "part -1 is negative");
  s = torus(6, 6);
  part.assign(s.tris.size(), 0);
  EXPECT_EQ(fault(), "part 0 has no boundary");
  part.front() = 1;
  EXPECT_EQ(fault(), "part 0 has genus 1");
}
