// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "lib/check/check.h"
#include "lib/core/triangle_count.h"

namespace meshpipe {
namespace {

/// Pairs of triangles that cross, and do not only touch, for each triangle: a reference with more is a tangle
/// that no size unravels.
constexpr double most_pairs = 1;

/// Returns per triangle an error for refined_size with limit 1, at and next to offending faces, else 0.
/// Deviation does not count.
std::vector<double> errors_at_faults(const Surface& offending, const Mesh& mesh) {
  constexpr double of_kappa = 2, of_others = 1.7, of_patches = 1.2;  // sizes of 0.3, 0.35 and 0.5
  std::vector<double> at(mesh.points.size(), 0), error(mesh.tris.size(), 0);
  const auto& triangle = offending.face.get<int>("triangle");
  const auto& fault = offending.face.get<std::uint8_t>("fault");
  for (std::size_t i = 0; i < triangle.size(); ++i) {
    const int other = fault[i] & ~offends_deviation;  // its size follows from the distance
    if (!other) continue;
    const double most = other & offends_kappa ? of_kappa : other == offends_patches ? of_patches : of_others;
    for (int v : mesh.tris[triangle[i]]) at[v] = std::max(at[v], most);
  }
  // the next mesh has other triangles there: include the neighbors
  for (std::size_t t = 0; t < error.size(); ++t)
    for (int v : mesh.tris[t]) error[t] = std::max(error[t], at[v]);
  return error;
}

}  // namespace

std::vector<double> smaller_sizes(const Contract& contract, const Findings& findings, const Surface& result,
                                  const Mesh& reference) {
  std::vector<double> size = result.vertex.get<double>("size"), errors;
  if (findings.reference_pairs.apart > most_pairs * reference.tris.size()) return size;
  auto is_distance = [](const Requirement& r) { return r.name == "hausdorff" || r.name == "deviation"; };
  if (std::any_of(contract.begin(), contract.end(), is_distance))
    errors = triangle_errors(reference, Bvh(reference), result, Bvh(result));
  for (const Requirement& r : contract) {
    if (r.name == "hausdorff") size = refined_size(result, size, errors, r.limit * diagonal(reference));
    if (r.name != "deviation" || !(most_deviation * findings.distance.deviation.worst > r.limit)) continue;
    std::vector<double> deviation = errors;
    for (std::size_t t = 0; t < errors.size(); ++t)
      deviation[t] *= most_deviation / findings.distance.deviation.allowed[t];
    size = refined_size(result, size, deviation, r.limit);
  }
  return refined_size(result, size, errors_at_faults(offending_faces(contract, findings, result), result), 1);
}

double triangles_asked_for(const Mesh& result, const std::vector<double>& size, const Mesh& reference) {
  const Bvh tree(result);
  const int n = (int)reference.points.size();
  std::vector<double> there(n);
  std::vector<char> missed(n);
#pragma omp parallel for schedule(dynamic, 256)
  for (int v = 0; v < n; ++v) {
    const Bvh::Hit hit = tree.nearest(reference.points[v]);
    there[v] = value_at(hit.place, size, result.tris);
    missed[v] = hit.distance > there[v];
  }
  Mesh rest{reference.points, {}};
  for (const Tri& t : reference.tris)
    if (missed[t[0]] && missed[t[1]] && missed[t[2]]) rest.tris.push_back(t);
  return count_for_size(result, size) + count_for_size(rest, there);
}

}  // namespace meshpipe
