// SPDX-License-Identifier: BSD-3-Clause
#include "lib/check/soundness.h"

#include <algorithm>

#include "lib/core/edges.h"
#include "lib/core/topology.h"

namespace meshpipe {
namespace {

void find_components(Soundness& c) {
  std::vector<int> component;
  c.components = components(c.opposite, component);
  std::vector<int> faces(c.components, 0);
  for (int x : component) ++faces[x];
  const int smallest = (int)(std::min_element(faces.begin(), faces.end()) - faces.begin());
  if (c.components)
    c.small_component = (int)(std::find(component.begin(), component.end(), smallest) - component.begin());
}

void find_loops(const Mesh& mesh, Soundness& c) {
  double shortest = 0;
  for (const std::vector<int>& loop : boundary_loops(c.opposite)) {
    const double length = loop_length(mesh, loop);
    if (c.loops++ == 0 || length < shortest) {
      shortest = length;
      c.loop = loop[0];
    }
  }
}

}  // namespace

Soundness soundness_of(const Mesh& mesh) {
  Soundness c;
  c.faces = (int)mesh.tris.size();
  const int n = (int)mesh.points.size();
  std::vector<char> used(n, 0);
  for (int t = 0; t < c.faces; ++t) {
    const Tri& v = mesh.tris[t];
    for (int x : v) used[x] = 1;
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) c.degenerate.push_back(t);
  }
  c.vertices = (int)std::count(used.begin(), used.end(), 1);
  c.opposite.assign(3 * mesh.tris.size(), -1);
  for_each_edge(mesh.tris, n, [&](std::span<const EdgeUse> uses) {
    ++c.edges;
    const int h = half_edge(uses[0]);
    if (uses.size() > 2) return c.nonmanifold.push_back(half_edge(uses.back()) / 3);
    if (uses.size() < 2) return;
    const int g = half_edge(uses[1]);
    if (origin(mesh.tris, h) == origin(mesh.tris, g)) return c.misoriented.push_back(h / 3);
    c.opposite[h] = g;
    c.opposite[g] = h;
  });
  if (c.sound())
    for (int h : further_fans(mesh.tris, c.opposite, n)) c.pinched.push_back(h / 3);
  if (!c.sound()) return c;
  find_components(c);
  find_loops(mesh, c);
  c.genus = (2 * c.components - (c.vertices - c.edges + c.faces) - c.loops) / 2;  // the paper's eq. (2)
  return c;
}

}  // namespace meshpipe
