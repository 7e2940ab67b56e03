// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <utility>

#include "lib/core/bvh.h"
#include "lib/core/coarsen.h"
#include "lib/core/error.h"
#include "lib/core/intersect.h"
#include "lib/core/normals.h"
#include "lib/core/take_rows.h"
#include "lib/core/topology.h"
#include "lib/lift/lift.h"

namespace meshpipe {
namespace {

constexpr double most_deviation = 0.02;    ///< of the size: less than what mfeature removes
constexpr double most_turn = 25 * degree;  ///< tubes keep about seven edges around
constexpr double of_gap = 1.0 / 40;  ///< deviation over the distance of the next sheet: sizes depend on it
constexpr double few = 0.01;  ///< of the vertices: where so few are too near, sizes are a little smaller
constexpr double faces_other = -0.7;  ///< largest cosine between the normals of sheets that do
constexpr double few_pairs = 0.001;   ///< of triangles that intersect, over all: with more nothing is safe
constexpr int most_rounds = 4;        ///< of which each keeps more vertices where triangles intersect

/// Flags the vertices that stay: corners of the model, and on request all of the border.
std::vector<char> fixed_vertices(const CutSurface& cut, double size, bool border) {
  Surface& s = cut.surface;
  Table vertex = std::exchange(s.vertex, {"vertex", s.points.size(), {}});  // may have other sizes
  Table face = std::exchange(s.face, {"face", s.tris.size(), {}});          // and parts
  if (face.has("model")) s.face.set("model", face.get<std::uint8_t>("model"));
  s.vertex.set("size", std::vector<double>(s.points.size(), size));
  s.face.set("part", std::vector<int>(s.tris.size(), 0));
  std::vector<char> fixed = model_corners(s);
  s.vertex = std::move(vertex);
  s.face = std::move(face);
  const Connectivity c = cut.connectivity();
  for (int h = 0; border && h < c.n_half_edges(); ++h)
    if (c.is_border(h)) fixed[c.from(h)] = fixed[c.to(h)] = 1;
  return fixed;
}

/// Lowers the deviation where a sheet that faces another, inside or outside, is too near for it, as seen from
/// the coarse vertices. Returns whether more than a few deviate by more.
bool heed_sheets(const Coarse& coarse, std::vector<double>& deviation) {
  const Bvh tree(coarse);
  const std::vector<Vec3> normal = vertex_normals(coarse);
  std::vector<double> most(coarse.points.size(), deviation[0]);
#pragma omp parallel for schedule(static)
  for (int v = 0; v < (int)most.size(); ++v)
    for (int side : {1, -1}) {  // a ray leaves its own body at the far side, and enters another
      const Bvh::RayHit hit = tree.first_hit(coarse.points[v], -side * normal[v], side);
      if (hit.face >= 0 && dot(normalized(area_vector(coarse, hit.face)), normal[v]) < faces_other)
        most[v] = std::min(most[v], of_gap * hit.distance);
    }
  std::vector<double> around = most;
  for (const Tri& t : coarse.tris)
    for (int v : t) around[v] = std::min({around[v], most[t[0]], most[t[1]], most[t[2]]});
  for (std::size_t v = 0; v < deviation.size(); ++v)
    if (coarse.of[v] >= 0) deviation[v] = around[coarse.of[v]];
  int deviate = 0;
  for (std::size_t v = 0; v < around.size(); ++v) deviate += coarse.deviation[v] > around[v];
  return deviate > few * (double)around.size();
}

/// Returns the pairs of triangles that intersect, unless both are triangles of the surface as it was.
std::vector<std::pair<int, int>> new_intersections(const Mesh& fine, const Coarse& coarse) {
  auto as_it_was = [&](int t) {
    const auto [a, b, c] = coarse.tris[t];
    return Tri{coarse.vertex[a], coarse.vertex[b], coarse.vertex[c]} == fine.tris[coarse.face[t]];
  };
  auto pairs = self_intersections(coarse);
  std::erase_if(pairs, [&](const auto& p) { return as_it_was(p.first) && as_it_was(p.second); });
  return pairs;
}

/// Fixes the vertices of the triangles that intersect, and those around them.
void fix(const Coarse& coarse, const std::vector<std::pair<int, int>>& pairs, std::vector<char>& fixed) {
  std::vector<char> meets(coarse.points.size(), 0);
  for (const auto& [t, u] : pairs)
    for (int face : {t, u})
      for (int v : coarse.tris[face]) meets[v] = 1;
  std::vector<char> near = meets;
  for (const Tri& t : coarse.tris)
    if (meets[t[0]] || meets[t[1]] || meets[t[2]])
      for (int v : t) near[v] = 1;
  for (std::size_t v = 0; v < fixed.size(); ++v)
    if (coarse.of[v] >= 0) fixed[v] |= near[coarse.of[v]];
}

}  // namespace

std::optional<Surface> coarse_surface(Surface& s, double size, bool keep_border, std::string& reason) {
  std::vector<int> opposite = opposite_halfedges(s);
  if (const int v = find_pinched_vertex({s, opposite}); v >= 0)
    throw NotAdmissible("vertex " + std::to_string(v) +
                        " joins triangles that share no edge; run mclean first");
  CoarsenLimits limits{most_turn, size, std::vector<double>(s.points.size(), most_deviation * size),
                       fixed_vertices({s, opposite}, size, keep_border)};
  const Connectivity fine{s, opposite, model_of(s)};
  int own = -1;  // pairs of its triangles that intersect
  for (int round = 0; round < most_rounds; ++round) {
    Coarse coarse = coarsen(fine, 0, limits);
    if (2 * (int)coarse.tris.size() > fine.n_tris()) {
      reason = std::to_string(coarse.tris.size()) + " of its " + std::to_string(fine.n_tris()) +
               " triangles would stay";
      return std::nullopt;
    }
    if (round == 0 && heed_sheets(coarse, limits.deviation)) continue;
    if (const auto pairs = new_intersections(s, coarse); !pairs.empty()) {
      if (own < 0) own = (int)self_intersections(s).size();
      if (own > few_pairs * fine.n_tris()) break;
      fix(coarse, pairs, limits.fixed);
      continue;
    }
    Surface r;
    r.points = std::move(coarse.points);
    r.tris = std::move(coarse.tris);
    r.vertex = rows_of(s.vertex, coarse.vertex);
    r.face = rows_of(s.face, coarse.face);
    if (!coarse.model.empty()) r.face.set("model", std::move(coarse.model));
    return r;
  }
  reason = "it intersects itself, or coarse models of it do";
  return std::nullopt;
}

}  // namespace meshpipe
