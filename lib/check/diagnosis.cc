// SPDX-License-Identifier: BSD-3-Clause
#include "lib/check/diagnosis.h"

#include <algorithm>

#include "lib/core/connectivity.h"
#include "lib/core/edges.h"
#include "lib/core/error.h"
#include "lib/core/intersect.h"
#include "lib/core/original_triangles.h"
#include "lib/core/segments.h"
#include "lib/core/topology.h"

namespace meshpipe {
namespace {

/// Edges are short if they are below this share of the median, and another one is not for a factor of `gap`.
constexpr double short_share = 0.01, gap = 10;

constexpr double tangent = 0.94;  ///< cosine, 20 degrees: patches that meet at less may be merged

bool has_sound_indices(const Mesh& mesh) {
  for (const Tri& t : mesh.tris)
    for (int v : t)
      if (v < 0 || v >= (int)mesh.points.size()) return false;
  return !mesh.tris.empty();
}

void look_at_edges(const Mesh& mesh, Diagnosis& d) {
  std::vector<double> length;
  for_each_edge(mesh.tris, (int)mesh.points.size(), [&](std::span<const EdgeUse> uses) {
    length.push_back(edge_length(mesh, half_edge(uses[0])));
    d.open |= uses.size() == 1;
  });
  std::sort(length.begin(), length.end());
  const double most = short_share * length[length.size() / 2];
  double widest = gap;
  for (std::size_t i = 0; i + 1 < length.size() && length[i] < most; ++i)
    if (length[i] > 0 && length[i + 1] >= widest * length[i]) {
      widest = length[i + 1] / length[i];
      d.weld = 2 * length[i];  // more than a chain of short edges, less than any other edge
      d.short_edges = i + 1;
      d.next_edge = length[i + 1];
    }
}

void find_lines_near(const Surface& s, Vec3 place, double reach, Diagnosis& d) {
  const std::vector<int> opposite = opposite_halfedges(s);
  const std::vector<int>* patch = s.face.has("patch") ? &s.face.get<int>("patch") : nullptr;
  const auto* model = s.face.has("model") ? &s.face.get<std::uint8_t>("model") : nullptr;
  for (int h = 0; h < (int)opposite.size(); ++h) {
    const int g = opposite[h];
    const Vec3 m = area_vector(s, h / 3), n = g < 0 ? m : area_vector(s, g / 3);
    const bool smooth = dot(m, n) >= tangent * norm(m) * norm(n);
    const bool patches = g >= 0 && smooth && patch && (*patch)[h / 3] != (*patch)[g / 3];
    const bool crease = g >= 0 && !patches && model && ((*model)[h / 3] >> h % 3 & 1);
    if (!(g < 0 || patches || crease) ||
        distance_to_segment(place, s.points[origin(s.tris, h)], s.points[target(s.tris, h)]) > reach)
      continue;
    d.at_border |= g < 0;
    d.at_patch_border |= patches;
    d.at_crease |= crease;
  }
}

}  // namespace

Diagnosis diagnose(const Surface& surface, Vec3 place, double reach) {
  Diagnosis d;
  if (!has_sound_indices(surface)) return d;
  const Mesh original = original_mesh(surface);
  if (const auto pairs = crossings(original, self_intersections(original)); !pairs.empty()) {
    d.intersections = pairs.size();
    d.intersection = contacts(original, {pairs[0]}).points.at(0);
  }
  look_at_edges(surface, d);
  try {
    if (reach > 0) find_lines_near(surface, place, reach, d);
  } catch (const NotAdmissible&) {  // not a manifold: it has no borders to be near to
  }
  return d;
}

}  // namespace meshpipe
