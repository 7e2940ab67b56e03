// SPDX-License-Identifier: BSD-3-Clause
// What a result must meet, and where it does not.
#pragma once
#include <string>
#include <vector>

#include "lib/examine.h"

namespace meshpipe {

/// One figure of the report; NaN where a mesh has none.
struct Figure {
  std::string key, label;
  int decimals;  ///< or one of the two below
  double reference, result;
};
/// Instead of decimals: a whole number; three significant digits.
constexpr int count_figure = -1, short_figure = -2;
/// All figures, in the order of the table; distances over the reference's diagonal.
std::vector<Figure> figures(const Findings& findings);

/// A kind of requirement, and its limit where it has one.
struct Requirement {
  std::string name;
  double limit = 0;
};
using Contract = std::vector<Requirement>;
/// What mcheck asks for by default.
extern const char* const default_contract;

/// From a list as "topology,intersections,kappa=0.1". Throws BadUsage naming what is wrong in it.
/// topology: sound, and components, genus and loops as the reference; intersections, folds: none where the
/// reference has none (new_intersections), no folds (find_folds); patches: every patch of the reference is
/// there. More than the limit: kappa, kappa_off_wedges, kappa_mean, angle (degrees). No more than the limit:
/// hausdorff (of the upper bound), boundary, features, mean and rms (over the diagonal), vertices (the
/// largest Findings::off), size (edge deviation), trace (kappa_elsewhere - kappa_by_cuts).
Contract parse_contract(const std::string& list);

struct Failure {
  std::string requirement, fact;  ///< "kappa", "smallest is 0.03 in triangle 12 at (0 1 2), not above 0.1"
};
/// What fails, in the order of the contract.
std::vector<Failure> judge(const Contract& contract, const Findings& findings, const Mesh& mesh);

/// Why a triangle is at fault: bits.
enum CulpritFault {
  fault_topology = 1,
  fault_intersects = 2,
  fault_folded = 4,
  fault_kappa = 8,
  fault_vertex = 16
};
/// The triangles in which the contract finds a fault, with face columns int `triangle`, their number in the
/// mesh, and uchar `fault`. Vertices stay, some unused.
Surface culprits(const Contract& contract, const Findings& findings, const Mesh& mesh);
/// For each triangle, by what it is too large for a sound mesh, in the sense of the errors of refined_size
/// with limit 1; 0 where neither it nor one that shares a vertex with it is a culprit.
std::vector<double> severity_of(const Surface& culprits, const Mesh& mesh);

}  // namespace meshpipe
