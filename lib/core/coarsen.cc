// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/coarsen.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lib/core/edit_mesh.h"
#include "lib/core/normals.h"
#include "lib/core/union_find.h"

namespace meshpipe {
namespace {

constexpr int most_valence = 10;

/// Would contracting an edge leave a triangle that turns away from the surface at its corners, further than
/// the one it was?
bool turns_away(const EditMesh& m, const std::vector<Vec3>& points, const std::vector<Vec3>& normal, int gone,
                int kept, double least_cosine) {
  bool turns = false;
  m.star(gone, [&](int e) {
    const int b = m.to(e), c = m.apex(e);
    if (turns || b == kept || c == kept) return;
    const Vec3 side = points[c] - points[b];
    auto least = [&](int a) {
      const Vec3 n = normalized(cross(side, points[a] - points[b]));
      return -std::min({dot(n, normal[a]), dot(n, normal[b]), dot(n, normal[c])});
    };
    const double after = least(kept);
    turns |= after > -least_cosine && after > least(gone);
  });
  return turns;
}

}  // namespace

Coarse coarsen(const Connectivity& c, int wanted, double most_turn) {
  constexpr int tries = 3;
  constexpr double least_progress = 0.2;  // of a round
  const Mesh& mesh = c.mesh;
  const int n = c.n_vertices();
  EditMesh m(c);
  UnionFind into(n);
  std::vector<int> round_of(n, -1), left;
  for (int v = 0; v < n; ++v)
    if (m.out[v] >= 0) left.push_back(v);
  const std::vector<Vec3> normal = vertex_normals(mesh);
  for (int round = 0; m.live > wanted; ++round) {
    const int before = m.live;
    for (int v : left) {
      if (round_of[v] == round) continue;
      // its shortest edges to those that have taken in no other yet
      struct Edge {
        double square;
        int half_edge, to;
      };
      std::array<Edge, tries> shortest;
      int found = 0;
      auto consider = [&](int h, int w) {
        if (round_of[w] == round || m.valence(v) + m.valence(w) - 4 > most_valence) return;
        const Vec3 d = mesh.points[w] - mesh.points[v];
        const Edge edge{dot(d, d), h, w};
        int at = found < tries ? found++ : tries;
        for (; at > 0 && shortest[at - 1].square > edge.square; --at)
          if (at < tries) shortest[at] = shortest[at - 1];
        if (at < tries) shortest[at] = edge;
      };
      int last = 0;
      m.star(v, [&](int h) { consider(h, m.to(h)), last = h; });
      if (m.opp[prev(last)] < 0) consider(prev(last), m.apex(last));
      for (int i = 0; i < found; ++i) {
        const auto [square, h, w] = shortest[i];
        if (!m.can_collapse(h, v) || turns_away(m, mesh.points, normal, v, w, std::cos(most_turn))) continue;
        m.collapse(h, v);
        into.merge_into(v, w);
        round_of[w] = round;
        break;
      }
    }
    std::erase_if(left, [&](int v) { return m.out[v] < 0; });
    if (m.live > (1 - least_progress) * before) break;
  }
  Coarse coarse;
  std::vector<int> number(n, -1);
  for (int v : left) {
    number[v] = (int)coarse.vertex.size();
    coarse.vertex.push_back(v);
    coarse.points.push_back(mesh.points[v]);
  }
  coarse.of.resize(n);
  for (int v = 0; v < n; ++v) coarse.of[v] = number[into.find(v)];
  for (int t = 0; t < (int)m.tris.size(); ++t) {
    if (m.dead(t)) continue;
    coarse.face.push_back(t);
    const Tri& v = m.tris[t];
    coarse.tris.push_back({number[v[0]], number[v[1]], number[v[2]]});
  }
  return coarse;
}

}  // namespace meshpipe
