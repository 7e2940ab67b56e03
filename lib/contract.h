// SPDX-License-Identifier: BSD-3-Clause
// What a result must meet, and where it does not.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lib/check.h"

namespace meshpipe {

struct Contract {
  bool topology = false;       ///< sound, and components, genus and loops as the reference
  bool intersections = false;  ///< no more pairs of triangles than the reference has
  bool patches = false;        ///< every patch of the reference is there
  std::optional<double> kappa, kappa_mean, angle;  ///< more than
  std::optional<double> hausdorff, boundary;       ///< no more than, over the diagonal
};

/// From a list as "topology,intersections,patches,kappa=0.1". Throws BadUsage naming what is wrong in it.
Contract parse_contract(const std::string& list);

/// All that is known of a result and its reference.
struct Findings {
  Connectivity mesh, reference;
  Quality quality, reference_quality;
  Distance distance;
  std::vector<std::pair<int, int>> intersections;  ///< pairs of the mesh's triangles
  int reference_intersections = -1;                ///< counted only when the mesh has some
  std::vector<std::string> lost_patches;
};

struct Failure {
  std::string requirement, fact;  ///< "kappa", "smallest is 0.03 in triangle 12 at (0 1 2), not above 0.1"
};

/// What fails, in the order of the contract's fields.
std::vector<Failure> judge(const Contract& contract, const Findings& findings, const Mesh& mesh);

}  // namespace meshpipe
