// SPDX-License-Identifier: BSD-3-Clause
#include "lib/smooth/smooth.h"

#include <gtest/gtest.h>

#include <numbers>

#include "lib/clean/clean.h"
#include "lib/core/error.h"
#include "lib/core/intersect.h"
#include "lib/core/random.h"
#include "lib/core/topology.h"
#include "lib/feature/feature.h"
#include "lib/shape/shape.h"

using namespace meshpipe;

namespace {

/// Rotates so that no plane or axis of the shape is one of the voxels.
Mesh slanted(Mesh mesh) {
  const Vec3 z = normalized({0.3, 0.5, 0.81}), x = normalized(cross({0, 1, 0}, z)), y = cross(z, x);
  for (Vec3& p : mesh.points) p = p.x * x + p.y * y + p.z * z;
  return mesh;
}

Surface cleaned(Mesh mesh) {
  Surface s = surface_of(std::move(mesh));
  CleanReport report;
  clean(s, {}, report);
  return s;
}

/// Root mean square of the distances from the truth, without flat ends where it is open.
double error(const Mesh& mesh, const Bvh& truth, double h) {
  double sum = 0;
  int n = 0;
  for (const Vec3& p : mesh.points)
    if (const double d = truth.nearest(p).distance; d < 1.5 * h) sum += d * d, ++n;
  return std::sqrt(sum / n);
}

double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double most = 0;
  for (std::size_t v = 0; v < a.size(); ++v) most = std::max(most, norm(a[v] - b[v]));
  return most;
}

/// A tube along z of this radius by voxels of side 1, without its ends.
Surface open_voxel_tube(double radius) {
  Mesh mesh = tube(10, 200, true);
  for (Vec3& p : mesh.points) p = 2 * radius * p;
  mesh = voxels(mesh, 1);
  double lo = 1e9, hi = -1e9;
  for (const Vec3& p : mesh.points) lo = std::min(lo, p.z), hi = std::max(hi, p.z);
  std::erase_if(mesh.tris, [&](const Tri& t) {
    for (double end : {lo, hi})
      if (mesh.points[t[0]].z == end && mesh.points[t[1]].z == end && mesh.points[t[2]].z == end) return true;
    return false;
  });
  return cleaned(mesh);
}

}  // namespace

TEST(smooth, VoxelsComeThreeTimesAsNearToTheTruth) {
  for (const auto& [truth, h] : {std::pair{slanted(sphere(20000)), 0.05},
                                 {slanted(torus(0.4, 20000)), 0.07},
                                 {slanted(tube(6, 200, true)), 0.1},
                                 {slanted(branching_tree(0, 13, 0.8, 25000, 1)), 0.05}}) {
    const Bvh tree(truth);
    Surface s = cleaned(voxels(truth, h));
    const double before = error(s, tree, h);
    const SmoothReport r = smooth(s, {});
    EXPECT_LT(error(s, tree, h), before / 3) << "voxels of " << h;
    EXPECT_LT(std::abs(r.volume_change), 1e-3 * r.volume);
    EXPECT_LT(r.angle_after, r.angle_before / 3);
    EXPECT_TRUE(self_intersections(s).empty());
  }
}

TEST(smooth, ThinTubesKeepTheirRadius) {
  for (double voxels_across : {3.0, 6.0, 10.0}) {  // of the diameter
    const Mesh truth = slanted(tube(12, 200, true));
    Surface s = cleaned(voxels(truth, 1 / voxels_across));
    smooth(s, {});
    const Vec3 axis = normalized({0.3, 0.5, 0.81});
    double sum = 0, area = 0;
    for (int t = 0; t < (int)s.tris.size(); ++t) {
      const Vec3 c = centroid(s, t);
      if (dot(c, axis) < 1 || dot(c, axis) > 11) continue;
      const double a = triangle_area(s, t);
      sum += a * norm(c - dot(c, axis) * axis), area += a;
    }
    EXPECT_NEAR(sum / area, 0.5, 0.025) << voxels_across << " voxels";
  }
}

TEST(smooth, MovesNoVertexBeyondTheBound) {
  const Surface before = cleaned(voxels(slanted(torus(0.4, 20000)), 0.1));
  for (double within : {0.02, 0.05, 0.1, 0.3}) {
    Surface s = before;
    const SmoothReport r = smooth(s, {.within = within});
    EXPECT_LE(farthest(s.points, before.points), within);
    EXPECT_EQ(farthest(s.points, before.points), r.farthest);
    EXPECT_EQ(r.bounded > 0, within < 0.3);
  }
}

TEST(smooth, ABoundThatIsTooSmallIsRefusedWithTheNumberThatHelps) {
  Surface s = cleaned(voxels(slanted(sphere(2000)), 0.1));
  try {
    smooth(s, {.within = 1e-3});
    FAIL();
  } catch (const GoalMissed& e) {
    EXPECT_NE(std::string(e.what()).find("a bound of 0.001 is too small to smooth"), std::string::npos)
        << e.what();
  }
  Surface smooth_already = surface_of(sphere(2000));
  EXPECT_NO_THROW(smooth(smooth_already, {.within = 1e-3}));  // nothing to be gained by any
}

TEST(smooth, SmallBoundsOfSmoothSurfacesHold) {
  const Surface before = surface_of(tube(3, 40, false));
  for (double within : {1e-5, 1e-4, 5e-4, 1e-3, 1e-2}) {
    Surface s = before;
    const SmoothReport r = smooth(s, {.within = within});
    EXPECT_LE(farthest(s.points, before.points), within);
    EXPECT_EQ(farthest(s.points, before.points), r.farthest);
  }
}

TEST(smooth, SmoothSurfacesStay) {
  const Mesh before = sphere(5000);
  Surface s = surface_of(before);
  smooth(s, {});
  for (const Vec3& p : s.points) EXPECT_NEAR(norm(p), 1, 5e-3);  // a tenth of an edge
}

TEST(smooth, OpenEndsKeepTheirPlaneAndRadius) {
  for (double radius : {3.0, 8.0}) {
    Surface s = open_voxel_tube(radius);
    const std::vector<Vec3> before = s.points;
    const SmoothReport r = smooth(s, {});
    EXPECT_EQ(r.planar_ends, 2);
    EXPECT_EQ(r.kept_ends, 0);
    double off = 0, sum = 0;
    int n = 0;
    for (const auto& loop : boundary_loops(opposite_halfedges(s.tris, (int)s.points.size())))
      for (int h : loop) {
        const int v = origin(s.tris, h);
        EXPECT_EQ(s.points[v].z, before[v].z);
        const double d = std::hypot(s.points[v].x, s.points[v].y);
        off = std::max(off, std::abs(d - radius)), sum += d, ++n;
      }
    EXPECT_NEAR(sum / n, radius, 0.05 * radius);
    EXPECT_LT(off, 0.4) << "corners of voxels are up to 0.7 off";
  }
}

TEST(smooth, TubesNeitherSwellNorShrinkNextToTheirEnds) {
  Surface s = surface_of(tube(5, 12, false));
  smooth(s, {});
  for (const Vec3& p : s.points) EXPECT_NEAR(std::hypot(p.x, p.y), 0.5, 0.5e-3) << p.z;
}

TEST(smooth, EndsThatWobbleSlideAlongTheirPlane) {
  Surface s = open_voxel_tube(8);
  const auto loops = boundary_loops(opposite_halfedges(s.tris, (int)s.points.size()));
  std::vector<int> rim;
  for (int h : loops[0]) rim.push_back(origin(s.tris, h));
  auto turning = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < rim.size(); ++i) {
      const Vec3 p = s.points[rim[i]];
      sum += angle(p - s.points[rim[(i + rim.size() - 1) % rim.size()]],
                   s.points[rim[(i + 1) % rim.size()]] - p);
    }
    return sum;
  };
  std::vector<double> z;
  for (std::size_t i = 0; i < rim.size(); ++i) z.push_back(s.points[rim[i]].z += i % 3 == 0 ? 0.1 : 0);
  const double before = turning();
  EXPECT_EQ(smooth(s, {}).planar_ends, 2);
  EXPECT_LT(turning(), 0.5 * before);
  for (std::size_t i = 0; i < rim.size(); ++i) EXPECT_NEAR(s.points[rim[i]].z, z[i], 0.02);
}

TEST(smooth, EndsThatAreNotPlanarStay) {
  Surface s = open_voxel_tube(4);
  s.points[origin(s.tris, boundary_loops(opposite_halfedges(s.tris, (int)s.points.size()))[0][3])].z += 1.5;
  const std::vector<Vec3> before = s.points;
  const SmoothReport r = smooth(s, {});
  EXPECT_EQ(r.kept_ends, 1);
  const auto loops = boundary_loops(opposite_halfedges(s.tris, (int)s.points.size()));
  for (int h : loops[0]) EXPECT_EQ(s.points[origin(s.tris, h)], before[origin(s.tris, h)]);
}

TEST(smooth, ModelEdgesAreKeptOnRequest) {
  const Mesh before = cube(1200);
  for (bool keep : {true, false}) {
    Surface s = surface_of(before);
    mark_features(s, {.mode = FeatureOptions::angles});
    smooth(s, {.keep_features = keep});
    double off = 0;  // of the nearest side
    for (const Vec3& p : s.points)
      off = std::max(off, std::min({std::abs(p.x), std::abs(p.x - 1), std::abs(p.y), std::abs(p.y - 1),
                                    std::abs(p.z), std::abs(p.z - 1)}));
    EXPECT_EQ(off < 1e-12, keep) << off;
  }
}

TEST(smooth, NothingIntersectsThatDidNotBefore) {
  // two voxels across, the bars of this ring get thinner at its bends
  Surface s = cleaned(voxels(torus(0.1, 5000), 0.1));
  const Mesh before = s;
  const SmoothReport r = smooth(s, {});
  EXPECT_GT(r.moved_back, 0);
  const Mesh known = contacts(before, self_intersections(before));  // of voxels that touch diagonally
  EXPECT_TRUE(new_intersections(s, self_intersections(s), known).empty());
  EXPECT_LE(farthest(s.points, before.points), r.within);
  EXPECT_LT(std::abs(r.volume_change), 1e-3 * r.volume);
}

TEST(smooth, CoarseSurfacesDoNotGetRougher) {
  for (const Mesh& before : {sphere(20), Mesh(cube(12)), torus(0.1, 100), genus_surface(4, 300)}) {
    Surface s = surface_of(before);
    const SmoothReport r = smooth(s, {});
    EXPECT_LE(r.angle_after, r.angle_before);
    EXPECT_TRUE(self_intersections(s).empty());
  }
}

TEST(smooth, OneVertexFarOutDoesNotRaiseTheBound) {
  const Surface plain = surface_of(sphere(500));
  for (auto smoothed : {smooth, smooth_sheets}) {
    Surface s = plain, spike = plain;
    spike.points[7] = 1e23 * spike.points[7];
    EXPECT_LT(smoothed(spike, {}).within, 15 * smoothed(s, {}).within);
  }
}

TEST(smooth, RefusesWhatIsNoSurface) {
  Surface none;
  EXPECT_THROW(smooth(none, {}), NotAdmissible);
  Surface twice = surface_of({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}, {0, 1, 3}}});
  EXPECT_THROW(smooth(twice, {}), NotAdmissible);
  Surface point = surface_of({{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {{0, 1, 2}}});
  EXPECT_THROW(smooth(point, {}), NotAdmissible);
}
