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
/// Of triangles, over their longest edge: contractions of regular grids leave 1/5 and more.
constexpr double least_height = 0.15;
constexpr double less_high = 0.9;  ///< of the height that a thin triangle had, squared

/// A sum of weighted squares of distances from planes: x' a x + 2 b x + c (Garland and Heckbert 1997).
struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  Vec3 b{};
  double c = 0, weight = 0;

  /// Adds the plane through p with this unit normal.
  void add_plane(Vec3 normal, Vec3 p, double w) {
    const double d = -dot(normal, p);
    const Vec3 n = w * normal;
    xx += n.x * normal.x, xy += n.x * normal.y, xz += n.x * normal.z;
    yy += n.y * normal.y, yz += n.y * normal.z, zz += n.z * normal.z;
    b = b + d * n;
    c += d * d * w;
    weight += w;
  }
  void add(const Quadric& o) {
    xx += o.xx, xy += o.xy, xz += o.xz, yy += o.yy, yz += o.yz, zz += o.zz;
    b = b + o.b;
    c += o.c;
    weight += o.weight;
  }
  double at(Vec3 p) const {
    return dot(p, {xx * p.x + xy * p.y + xz * p.z, xy * p.x + yy * p.y + yz * p.z,
                   xz * p.x + yz * p.y + zz * p.z}) +
           2 * dot(b, p) + c;
  }
};

/// Returns per vertex the planes of its triangles, and those through its borders and model edges at a right
/// angle to the surface. `center`: their origin, near the surface for the sake of rounding.
std::vector<Quadric> planes_of(const Connectivity& c, Vec3 center) {
  std::vector<Quadric> planes(c.n_vertices());
  for (int t = 0; t < c.n_tris(); ++t) {
    const Vec3 n = c.area_vector(t);
    if (!(norm(n) > 0)) continue;
    Quadric plane;
    plane.add_plane(normalized(n), c.point(c.mesh.tris[t][0]) - center, norm(n));
    for (int v : c.mesh.tris[t]) planes[v].add(plane);
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      if (!c.is_border(h) && !c.is_model(h)) continue;
      const Vec3 along = c.point(c.to(h)) - c.point(c.from(h)), across = normalized(cross(n, along));
      for (int v : {c.from(h), c.to(h)}) planes[v].add_plane(across, c.point(v) - center, dot(along, along));
    }
  }
  return planes;
}

/// The contractions of a mesh that its limits permit.
struct Contraction {
  const EditMesh& m;
  const std::vector<Vec3>& points;
  const CoarsenLimits& limits;
  std::vector<Vec3> normal;     ///< per vertex
  double least_cosine;          ///< of the turn
  std::vector<char> on_line;    ///< per vertex: on a model edge; empty: none is known
  Vec3 center;                  ///< of `planes`
  std::vector<Quadric> planes;  ///< per vertex, of all that has become it; empty: no limit on the deviation

  /// Is the kept vertex within the deviation of the planes of both?
  bool deviates(int gone, int kept) const {
    if (planes.empty()) return false;
    const Vec3 p = points[kept] - center;
    const double most = std::min(limits.deviation[gone], limits.deviation[kept]);
    return planes[gone].at(p) + planes[kept].at(p) >
           most * most * (planes[gone].weight + planes[kept].weight);
  }
  /// Returns the deviation of a vertex from the planes of all that has become it.
  double deviation(int v) const {
    const Quadric& q = planes[v];
    return q.weight > 0 ? std::sqrt(std::max(0.0, q.at(points[v] - center) / q.weight)) : 0;
  }
  /// The cosine between the normals at a vertex and of a triangle; 1 on lines of a model, which has no
  /// normal.
  double along(int v, Vec3 n) const { return on_line.empty() || !on_line[v] ? dot(normal[v], n) : 1; }
  /// Would it leave a triangle that turns away from the surface at its corners, or is thin, more than the one
  /// it was, or an edge that is too long?
  bool spoils(int gone, int kept) const {
    bool spoils = false;
    m.star(gone, [&](int e) {
      const int b = m.to(e), c = m.apex(e);
      if (spoils || b == kept || c == kept) return;
      const Vec3 side = points[c] - points[b];
      auto normal_with = [&](int a) { return normalized(cross(side, points[a] - points[b])); };
      const Vec3 after = normal_with(kept), before = normal_with(gone);
      auto least = [&](Vec3 n, int a) { return std::min({along(a, n), along(b, n), along(c, n)}); };
      const double cosine = least(after, kept);
      spoils |= (cosine < least_cosine && cosine < least(before, gone)) ||
                (!planes.empty() && dot(after, before) < least_cosine);
      if (!(limits.length < infinity)) return;
      auto squares = [&](int a) {
        const Vec3 x = points[a] - points[b], y = points[a] - points[c], n = cross(side, x);
        const double longest = std::max({dot(side, side), dot(x, x), dot(y, y)});
        return std::pair(longest, dot(n, n) / longest);
      };
      const auto [longest, height] = squares(kept);
      const auto [longest_before, height_before] = squares(gone);
      const double most = limits.length * limits.length;
      spoils |= longest > (longest_before > most ? longest_before + most : most) ||
                (height < least_height * least_height * longest && height < less_high * height_before);
    });
    return spoils;
  }
};

}  // namespace

Coarse coarsen(const Connectivity& c, int wanted, const CoarsenLimits& limits) {
  constexpr int tries = 3;
  constexpr double least_progress = 0.2;  // of a round
  const Mesh& mesh = c.mesh;
  const int n = c.n_vertices();
  EditMesh m(c);
  UnionFind into(n);
  std::vector<int> round_of(n, -1), left;
  for (int v = 0; v < n; ++v)
    if (m.out[v] >= 0) left.push_back(v);
  Contraction contraction{m, mesh.points, limits, vertex_normals(mesh), std::cos(limits.turn), {}, {}, {}};
  if (!limits.deviation.empty()) {
    contraction.center = mesh.points[mesh.tris[0][0]];
    contraction.planes = planes_of(c, contraction.center);
    contraction.on_line.assign(n, 0);
    for (int h = 0; h < c.n_half_edges(); ++h)
      if (c.is_model(h)) contraction.on_line[c.from(h)] = contraction.on_line[c.to(h)] = 1;
  }
  for (int round = 0; m.live > wanted; ++round) {
    const int before = m.live;
    for (int v : left) {
      if (round_of[v] == round || (!limits.fixed.empty() && limits.fixed[v])) continue;
      // its shortest edges to those that have taken in no other yet
      struct Edge {
        double square;
        int half_edge, to;
      };
      std::array<Edge, tries> shortest;
      int found = 0;
      auto consider = [&](int h, int w) {
        const int most =
            limits.length < infinity ? std::max({most_valence, m.valence(v), m.valence(w)}) : most_valence;
        if (round_of[w] == round || m.valence(v) + m.valence(w) - 4 > most) return;
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
        if (contraction.deviates(v, w) || !m.can_collapse(h, v) || contraction.spoils(v, w)) continue;
        m.collapse(h, v);
        if (!contraction.planes.empty()) contraction.planes[w].add(contraction.planes[v]);
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
    if (!contraction.planes.empty()) coarse.deviation.push_back(contraction.deviation(v));
  }
  coarse.of.resize(n);
  for (int v = 0; v < n; ++v) coarse.of[v] = number[into.find(v)];
  for (int t = 0; t < (int)m.tris.size(); ++t) {
    if (m.dead(t)) continue;
    coarse.face.push_back(t);
    const Tri& v = m.tris[t];
    coarse.tris.push_back({number[v[0]], number[v[1]], number[v[2]]});
    if (c.model.empty()) continue;
    std::uint8_t model = 0;
    for (int i = 0; i < 3; ++i)
      if (m.hard[3 * t + i] && m.opp[3 * t + i] >= 0) model |= static_cast<std::uint8_t>(1 << i);
    coarse.model.push_back(model);
  }
  return coarse;
}

}  // namespace meshpipe
