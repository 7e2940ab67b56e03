// SPDX-License-Identifier: BSD-3-Clause
// All that is known of a result and of the surface it was made from.
#pragma once
#include <optional>
#include <string>
#include <utility>

#include "lib/check.h"
#include "lib/distance.h"
#include "lib/lines.h"

namespace meshpipe {

struct Findings {
  Connectivity mesh, reference;
  Quality quality, reference_quality;
  Distance distance;
  double boundary = 0;  ///< Hausdorff distance of the borders over the diagonal; infinite if only one has any
  std::optional<double> features;  ///< the same of borders and model edges, if both know their model edges
  std::vector<std::pair<int, int>> intersections;      ///< pairs of the mesh's triangles
  std::vector<std::pair<int, int>> new_intersections;  ///< those where the reference has none
  int reference_intersections = -1;                    ///< counted only when the mesh has some
  std::vector<int> folds;                              ///< half-edges of the mesh, see find_folds
  std::vector<double> off;      ///< of every vertex of the mesh: distance to the reference over its mean edge
  int farthest = -1;            ///< the vertex with the largest `off`
  std::vector<char> forced;     ///< per triangle, see forced_needles; empty if kappa is above 0.1
  int worst_unforced = -1;      ///< the triangle with the smallest kappa of those that are not forced
  double kappa_off_wedges = 0;  ///< see lib/check.h; kappa_min if no model edges are known
  int worst_off_wedges = -1;
  std::optional<double> kappa_by_cuts, kappa_elsewhere;  ///< see kappa_by_lines
  std::vector<std::string> lost_patches;
};

/// Everything but the patches. Of the result, vertex column `size` and face column `model` are used if they
/// are there, of the reference, face columns `model` and `origin`: the mesh that it was cut from is what the
/// result is compared with; `curved`: vertices with their place (ref_face) may lie on the smooth surface.
/// `lines`: those that the result was made with, or null. samples: see distance_between.
Findings examine(const Surface& result, const Surface& reference, const Lines* lines, int samples);

/// Edges where two triangles turn by more than 150 degrees while the reference, as far away as the edge is
/// long, faces only one of the two ways: thin walls and sharp ridges are no folds.
std::vector<int> find_folds(const Mesh& mesh, const std::vector<int>& opposite, const Mesh& reference,
                            const Bvh& reference_tree);

/// Mean kappa of the triangles whose centre is within an edge (their mean one) of an interface line, and of
/// all others; triangles that touch the border or a model edge (bit i of `model`, which may be empty) are in
/// neither, since those cost quality of their own; none where there are no such triangles. Where a result
/// shows no trace of the cuts the two means are the same. The lines lie on `surface`.
std::pair<std::optional<double>, std::optional<double>> kappa_by_lines(
    const Mesh& mesh, const Bvh& tree, const Quality& quality, const std::vector<int>& opposite,
    const std::vector<std::uint8_t>& model, const Lines& lines, const Mesh& surface);

}  // namespace meshpipe
