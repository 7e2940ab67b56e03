// SPDX-License-Identifier: BSD-3-Clause
// Volumes of regions that are met exactly, by the least motion of the sheets between them.
#include <algorithm>
#include <cmath>

#include "lib/core/connectivity.h"
#include "lib/numeric/sparse.h"
#include "lib/solids/solids.h"

namespace meshpipe {
namespace {

constexpr int most_steps = 6;    // Newton's method: the first leaves what the sheets' curvature makes of it
constexpr double enough = 1e-7;  // relative difference of a volume
constexpr double compliant = 1e-9;  // of the largest, added to all, for regions that nothing may move around

/// By how much the volume of a region grows as a vertex moves.
struct Gradient {
  int vertex, region;
  Vec3 by;
};

/// One row per vertex that may move and region around it, ascending.
std::vector<Gradient> gradients(const Mesh& mesh, const std::vector<std::array<int, 2>>& sides,
                                const Compliance& compliance) {
  std::vector<Gradient> rows;
  for (int t = 0; t < (int)mesh.tris.size(); ++t) {
    if (sides[t][0] == sides[t][1]) continue;
    const Vec3 third = (1.0 / 6) * area_vector(mesh, t);
    for (int v : mesh.tris[t])
      for (int i : {0, 1})
        if (sides[t][i] != 0 && compliance.share[v] > 0)
          rows.push_back({v, sides[t][i], (i == 0 ? -1.0 : 1.0) * third});
  }
  std::stable_sort(rows.begin(), rows.end(), [](const Gradient& a, const Gradient& b) {
    return a.vertex != b.vertex ? a.vertex < b.vertex : a.region < b.region;
  });
  std::size_t n = 0;
  for (const Gradient& row : rows) {
    if (n > 0 && rows[n - 1].vertex == row.vertex && rows[n - 1].region == row.region)
      rows[n - 1].by = rows[n - 1].by + row.by;
    else
      rows[n++] = row;
  }
  rows.resize(n);
  return rows;
}

/// The pressure in each region that makes its volume grow by `growth`; `ease` is per vertex, its share over
/// the area around it.
std::vector<double> pressures(const std::vector<Gradient>& rows, const std::vector<double>& ease,
                              std::vector<double> growth) {
  const int n = (int)growth.size();
  std::vector<Entry<double>> matrix;
  std::vector<double> diagonal(n, 0);
  for (std::size_t i = 0, end; i < rows.size(); i = end)
    for (end = i; end < rows.size() && rows[end].vertex == rows[i].vertex; ++end)
      for (std::size_t j = i; j <= end; ++j) {
        const double value = ease[rows[i].vertex] * dot(rows[end].by, rows[j].by);
        if (j == end)
          diagonal[rows[j].region] += value;
        else
          matrix.push_back({rows[end].region, rows[j].region, value});
      }
  const double least = compliant * *std::max_element(diagonal.begin(), diagonal.end());
  for (int r = 0; r < n; ++r) matrix.push_back({r, r, diagonal[r] + (least > 0 ? least : 1)});
  growth[0] = 0;
  Factorization<double>(n, std::move(matrix)).solve(growth);
  return growth;
}

}  // namespace

std::vector<double> region_volumes(const Mesh& mesh, const std::vector<std::array<int, 2>>& sides,
                                   std::size_t n) {
  std::vector<double> volume(n, 0);
  const Vec3 from = mesh.points[0];
  for (std::size_t t = 0; t < sides.size(); ++t) {
    const double v = volume6(mesh, (int)t, from) / 6;
    volume[sides[t][0]] -= v;
    volume[sides[t][1]] += v;
  }
  return volume;
}

double match_volumes(Mesh& mesh, const std::vector<std::array<int, 2>>& sides,
                     const std::vector<double>& volume, Compliance compliance) {
  const std::vector<Vec3> start = compliance.from.empty() ? mesh.points : std::move(compliance.from);
  for (int step = 0;; ++step) {
    std::vector<double> growth = region_volumes(mesh, sides, volume.size());
    double most = 0;
    for (std::size_t r = 1; r < growth.size(); ++r) {
      growth[r] = volume[r] - growth[r];
      if (volume[r] != 0) most = std::max(most, std::abs(growth[r] / volume[r]));
    }
    if (step == most_steps || most <= enough) return most;
    std::vector<double> ease(start.size(), 0);
    for (int t = 0; t < (int)mesh.tris.size(); ++t)
      for (int v : mesh.tris[t]) ease[v] += norm(area_vector(mesh, t)) / 6;
    for (std::size_t v = 0; v < ease.size(); ++v) ease[v] = ease[v] > 0 ? compliance.share[v] / ease[v] : 0;
    const std::vector<Gradient> rows = gradients(mesh, sides, compliance);
    const std::vector<double> pressure = pressures(rows, ease, std::move(growth));
    for (const auto& [v, r, by] : rows) mesh.points[v] = mesh.points[v] + ease[v] * pressure[r] * by;
    for (std::size_t v = 0; v < start.size(); ++v)
      if (const double way = norm(mesh.points[v] - start[v]); way > compliance.farthest[v]) {
        mesh.points[v] = start[v] + compliance.farthest[v] / way * (mesh.points[v] - start[v]);
        compliance.share[v] = 0;
      }
  }
}

}  // namespace meshpipe
