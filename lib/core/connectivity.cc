// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/connectivity.h"

#include "lib/core/take_rows.h"
#include "lib/core/topology.h"

namespace meshpipe {

const std::vector<std::uint8_t>& model_of(const Surface& surface) {
  return surface.face.has("model") ? surface.face.get<std::uint8_t>("model") : no_model;
}

ConnectedPart select_part(const Connectivity& whole, std::vector<int> label, int l) {
  for (int& x : label) x = x == l ? 0 : -1;
  std::vector<SubMesh> parts = split_by_label(whole.mesh, label, 1);
  std::vector<int> opposite = std::move(opposite_of_parts(parts, whole, label)[0]);
  std::vector<std::uint8_t> model;
  if (!whole.model.empty()) model = rearranged(whole.model, parts[0].face);
  return {std::move(parts[0]), std::move(opposite), std::move(model)};
}

}  // namespace meshpipe
