// SPDX-License-Identifier: BSD-3-Clause
#include "lib/wrap/wrap.h"

#include "lib/core/error.h"
#include "lib/core/intersect.h"
#include "lib/core/number.h"
#include "lib/core/topology.h"
#include "lib/wrap/fit.h"
#include "lib/wrap/valid.h"
#include "lib/wrap/voxels.h"

namespace meshpipe {
namespace {

/// Divisions of a triangle that bound its distance to two percent of its size.
constexpr int pieces = 6;

/// Of the spacing, of fins and cracks: sides that are closer would intersect when they are meshed again.
constexpr double least_width = 0.25;

/// Bounds the distance of a triangle from the soup: at most that of its middle and the radius around it;
/// where that is not enough the triangle is divided in four, `depth` times at most.
double farthest_from(const Bvh& tree, Vec3 a, Vec3 b, Vec3 c, double enough, int depth) {
  const Vec3 middle = (1.0 / 3) * (a + b + c);
  const double radius = std::max({norm(a - middle), norm(b - middle), norm(c - middle)});
  const double bound = tree.nearest(middle).distance + radius;
  if (bound <= enough || depth == 0) return bound;
  const Vec3 ab = lerp(a, b, 0.5), bc = lerp(b, c, 0.5), ca = lerp(c, a, 0.5);
  return std::max({farthest_from(tree, a, ab, ca, enough, depth - 1),
                   farthest_from(tree, ab, b, bc, enough, depth - 1),
                   farthest_from(tree, ca, bc, c, enough, depth - 1),
                   farthest_from(tree, ab, bc, ca, enough, depth - 1)});
}

/// The largest bound over the triangles, and the smallest distance of a vertex.
void measure_distances(const Mesh& wrap, const Bvh& tree, WrapReport& r) {
  const int n = (int)wrap.tris.size(), n_points = (int)wrap.points.size();
  std::vector<double> bound(n), distance(n_points);
#pragma omp parallel for schedule(dynamic, 256)
  for (int t = 0; t < n; ++t) {
    const Tri& v = wrap.tris[t];
    bound[t] = farthest_from(tree, wrap.points[v[0]], wrap.points[v[1]], wrap.points[v[2]],
                             r.farthest_allowed, pieces);
  }
#pragma omp parallel for schedule(dynamic, 256)
  for (int p = 0; p < n_points; ++p) distance[p] = tree.nearest(wrap.points[p]).distance;
  r.farthest = *std::max_element(bound.begin(), bound.end());
  r.clearance = *std::min_element(distance.begin(), distance.end());
}

}  // namespace

void verify_wrap(const Mesh& wrap, const Mesh& soup, WrapReport& r) {
  const int n_points = (int)wrap.points.size();
  if (wrap.tris.empty()) throw ContractMissed("the wrap has no triangle");
  std::vector<int> opposite, component;
  try {
    opposite = opposite_halfedges(wrap.tris, n_points);
  } catch (const NotAdmissible& e) {
    throw ContractMissed(std::string("the wrap is not an oriented manifold: ") + e.what());
  }
  for (std::size_t h = 0; h < opposite.size(); ++h)
    if (opposite[h] < 0) throw ContractMissed("the wrap is open at triangle " + std::to_string(h / 3));
  if (const int v = find_pinched_vertex(wrap.tris, opposite, n_points); v >= 0)
    throw ContractMissed("the wrap is pinched at vertex " + std::to_string(v));
  r.components = components(opposite, component);
  const int chi = n_points - (int)wrap.tris.size() / 2;  // every vertex is used
  r.genus = r.components - chi / 2;
  std::vector<double> volume(r.components, 0);
  for (std::size_t t = 0; t < wrap.tris.size(); ++t)
    volume[component[t]] += volume6(wrap, (int)t, wrap.points[0]);
  for (int c = 0; c < r.components; ++c)
    if (!(volume[c] > 0))
      throw ContractMissed("component " + std::to_string(c) + " of the wrap is not outward");
  const Bvh tree(wrap), soup_tree(soup);
  if (const auto pairs = self_intersections(wrap, tree); !pairs.empty())
    throw ContractMissed("the wrap intersects itself at triangles " + std::to_string(pairs[0].first) +
                         " and " + std::to_string(pairs[0].second));
  const auto met = triangles_that_meet(wrap, {}, with_area(soup, 1e-6 * r.spacing));
  if (const auto hit = std::find(met.begin(), met.end(), 1); hit != met.end())
    throw ContractMissed("triangle " + std::to_string(hit - met.begin()) + " of the wrap meets the input");
  const InsideTest test({wrap, opposite}, tree);
  const int n = (int)soup.tris.size();
  int lost = n;
#pragma omp parallel for schedule(dynamic, 256) reduction(min : lost)
  for (int t = 0; t < n; ++t)
    if (!test.inside(soup.points[soup.tris[t][0]])) lost = std::min(lost, t);
  if (lost < n)
    throw ContractMissed("triangle " + std::to_string(lost) + " of the input is outside the wrap");
  measure_distances(wrap, soup_tree, r);
  if (!(r.farthest <= r.farthest_allowed))
    throw ContractMissed("the wrap is up to " + shown(r.farthest) +
                         " away from the input, expected at most " + shown(r.farthest_allowed));
}

Mesh wrap(const Mesh& soup, const WrapOptions& options, WrapReport& report) {
  if (soup.tris.empty()) throw NotAdmissible("there is no triangle to wrap");
  const Bvh tree(soup);
  const Voxels voxels = outside_voxels(soup, tree, options, report);
  const QuadMesh boundary = boundary_of(voxels);
  // the center of a voxel inside is at most this far away from the soup (see outside_voxels), its corners
  // half a diagonal more
  report.farthest_allowed = options.offset + 0.5 * options.alpha + 1.5 * report.spacing;
  Mesh mesh;
  mesh.points = fitted_points(boundary, soup, tree, options.offset, report.spacing);
  mesh.tris = divided(boundary, mesh.points, soup, tree, options.offset);
  const Mesh solid = with_area(soup, 1e-6 * report.spacing);
  const double least = std::min(options.offset, least_width * report.spacing);
  report.held = keep_valid(mesh, boundary.points, solid, options.offset + 3 * report.spacing, least);
  remove_slivers(mesh, solid, report.spacing, least, [&](const Mesh& m, int t) {
    const auto& [a, b, c] = m.tris[t];
    return farthest_from(tree, m.points[a], m.points[b], m.points[c], report.farthest_allowed, pieces) <=
           report.farthest_allowed;
  });
  verify_wrap(mesh, soup, report);
  return mesh;
}

}  // namespace meshpipe
