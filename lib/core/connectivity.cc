// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/connectivity.h"

namespace meshpipe {

const std::vector<std::uint8_t>& model_of(const Surface& surface) {
  return surface.face.has("model") ? surface.face.get<std::uint8_t>("model") : no_model;
}

ConnectedPart select_part(const Connectivity& whole, const std::vector<int>& label, int l) {
  ConnectedPart part;
  std::vector<int> vertex(whole.mesh.points.size(), -1), face(whole.mesh.tris.size(), -1);
  for (int t = 0; t < whole.n_tris(); ++t)
    if (label[t] == l) {
      face[t] = (int)part.face.size();
      part.face.push_back(t);
    }
  part.tris.reserve(part.face.size());
  part.opposite.reserve(3 * part.face.size());
  for (int t : part.face) {
    Tri& corner = part.tris.emplace_back();
    for (int i = 0; i < 3; ++i) {
      const int v = whole.mesh.tris[t][i], o = whole.opposite[3 * t + i];
      if (vertex[v] < 0) {
        vertex[v] = (int)part.vertex.size();
        part.vertex.push_back(v);
        part.points.push_back(whole.mesh.points[v]);
      }
      corner[i] = vertex[v];
      part.opposite.push_back(o < 0 || face[o / 3] < 0 ? -1 : 3 * face[o / 3] + o % 3);
    }
    if (!whole.model.empty()) part.model.push_back(whole.model[t]);
  }
  return part;
}

}  // namespace meshpipe
