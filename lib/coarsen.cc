// SPDX-License-Identifier: BSD-3-Clause
#include "lib/coarsen.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "lib/edit_mesh.h"

namespace meshpipe {
namespace {

constexpr int most_valence = 10;

/// Sums of the normals of each vertex' triangles, weighed by area, of length 1.
std::vector<Vec3> vertex_normals(const Mesh& mesh) {
  std::vector<Vec3> normal(mesh.points.size());
  for (const Tri& t : mesh.tris) {
    const Vec3 n = area_vector(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
    for (int v : t) normal[v] = normal[v] + n;
  }
  for (Vec3& n : normal) n = normalized(n);
  return normal;
}

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

Coarse coarsen(const Mesh& mesh, const std::vector<int>& opposite, const std::vector<std::uint8_t>& model,
               int wanted, double most_turn) {
  constexpr int tries = 3;
  constexpr double least_progress = 0.2;  // of a round
  const int n = (int)mesh.points.size();
  EditMesh m(mesh.tris, opposite, n, model);
  std::vector<int> into(n), round_of(n, -1), left;
  std::iota(into.begin(), into.end(), 0);
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
        into[v] = w;
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
  for (int v = 0; v < n; ++v) {
    int last = v;
    while (into[last] != last) last = into[last] = into[into[last]];
    into[v] = last;
    coarse.of[v] = number[last];
  }
  for (int t = 0; t < (int)m.tris.size(); ++t) {
    if (m.dead(t)) continue;
    coarse.face.push_back(t);
    const Tri& v = m.tris[t];
    coarse.tris.push_back({number[v[0]], number[v[1]], number[v[2]]});
    if (model.empty()) continue;
    std::uint8_t bits = 0;
    for (int i = 0; i < 3; ++i) bits |= (m.hard[3 * t + i] && m.opp[3 * t + i] >= 0) << i;
    coarse.model.push_back(bits);
  }
  return coarse;
}

}  // namespace meshpipe
