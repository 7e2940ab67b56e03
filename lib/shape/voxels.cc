// SPDX-License-Identifier: BSD-3-Clause
// The shape as a segmentation shows it: the faces between voxels inside and outside.
#include <algorithm>

#include "lib/core/bvh.h"
#include "lib/core/error.h"
#include "lib/core/number.h"
#include "lib/core/ray.h"
#include "lib/core/topology.h"
#include "lib/shape/shape.h"

namespace meshpipe {
namespace {

constexpr double most_voxels = 3e8;  ///< of memory: a byte each, and four for each of their corners

/// A grid of voxels around a box, with at least one outside on each side.
struct Grid {
  Vec3 lo;
  double h;
  int n[3];

  Grid(const Box& box, double side) : h(side) {
    // not whole voxels: centers on the planes and axes of a shape would be the rule
    lo = box.lo - side * Vec3{1.37, 1.41, 1.43};
    const Vec3 size = (1 / h) * (box.hi - lo);
    const double count[3] = {size.x + 2, size.y + 2, size.z + 2};
    if (!(count[0] * count[1] * count[2] < most_voxels))
      throw GoalMissed("voxels of " + shown(h) + " are " + shown(count[0] * count[1] * count[2]) +
                       ", but at most " + shown(most_voxels) + " are possible");
    for (int k = 0; k < 3; ++k) n[k] = (int)count[k];
  }
  std::size_t at(int x, int y, int z) const { return (static_cast<std::size_t>(z) * n[1] + y) * n[0] + x; }
};

/// Closes border loops by fans around their centers, for the test of what is inside.
void close_loops(Mesh& mesh) {
  for (const auto& loop : boundary_loops(opposite_halfedges(mesh))) {
    Vec3 center;
    for (int h : loop) center = center + (1.0 / loop.size()) * mesh.points[origin(mesh.tris, h)];
    const int c = (int)mesh.points.size();
    mesh.points.push_back(center);
    for (int h : loop) mesh.tris.push_back({target(mesh.tris, h), origin(mesh.tris, h), c});
  }
}

/// Which voxels have their center inside: by the parity of what the line along x has passed.
std::vector<char> inside(const Mesh& mesh, const Grid& g) {
  std::vector<char> in(g.at(0, 0, g.n[2]), 0);
  for (int t = 0; t < (int)mesh.tris.size(); ++t) {
    const auto& [i, j, k] = mesh.tris[t];
    const Vec3 a = mesh.points[i], b = mesh.points[j], c = mesh.points[k], normal = area_vector(a, b, c);
    const Box box = box_of(mesh, t);
    auto first = [&](double x, double from) { return (int)std::max(0.0, (x - from) / g.h - 1); };
    for (int z = first(box.lo.z, g.lo.z); g.lo.z + (z + 0.5) * g.h <= box.hi.z; ++z)
      for (int y = first(box.lo.y, g.lo.y); g.lo.y + (y + 0.5) * g.h <= box.hi.y; ++y) {
        const Vec3 p{0, g.lo.y + (y + 0.5) * g.h, g.lo.z + (z + 0.5) * g.h};
        if (!line_passes(p, a, b, c) || normal.x == 0) continue;
        const double x = a.x - (normal.y * (p.y - a.y) + normal.z * (p.z - a.z)) / normal.x;
        const double voxel = std::ceil((std::clamp(x, box.lo.x, box.hi.x) - g.lo.x) / g.h - 0.5);
        in[g.at((int)voxel, y, z)] ^= 1;
      }
  }
  for (std::size_t v = 1; v < in.size(); ++v) in[v] ^= in[v - 1];  // every line ends outside
  return in;
}

}  // namespace

Mesh voxels(Mesh mesh, double h) {
  close_loops(mesh);
  const Grid g(box_of(mesh), h);
  const std::vector<char> in = inside(mesh, g);
  Mesh faces;
  std::vector<int> number(in.size(), -1);  // of a voxel's lowest corner
  auto corner = [&](const int* p) {
    int& v = number[g.at(p[0], p[1], p[2])];
    if (v < 0) {
      v = (int)faces.points.size();
      faces.points.push_back(g.lo + g.h * Vec3{(double)p[0], (double)p[1], (double)p[2]});
    }
    return v;
  };
  for (int z = 1; z + 1 < g.n[2]; ++z)
    for (int y = 1; y + 1 < g.n[1]; ++y)
      for (int x = 1; x + 1 < g.n[0]; ++x) {
        if (!in[g.at(x, y, z)]) continue;
        for (int axis = 0; axis < 3; ++axis)
          for (int side = 0; side < 2; ++side) {
            int p[3] = {x, y, z}, q[3] = {x, y, z};
            q[axis] += 2 * side - 1;
            if (in[g.at(q[0], q[1], q[2])]) continue;
            const int u = (axis + 2 - side) % 3, v = (axis + 1 + side) % 3;  // u x v points outward
            p[axis] += side;
            int square[4] = {corner(p), 0, 0, 0};
            ++p[u], square[1] = corner(p);
            ++p[v], square[2] = corner(p);
            --p[u], square[3] = corner(p);
            faces.tris.push_back({square[0], square[1], square[2]});
            faces.tris.push_back({square[0], square[2], square[3]});
          }
      }
  if (faces.tris.empty()) throw GoalMissed("no voxel of " + shown(h) + " has its center inside the body");
  return faces;
}

}  // namespace meshpipe
