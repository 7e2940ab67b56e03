// SPDX-License-Identifier: BSD-3-Clause
#include "lib/threshold.h"

#include <Eigen/IterativeLinearSolvers>
#include <utility>

#include "lib/sparse.h"

namespace meshpipe {
namespace {

/// Mean of the sign of a linear field over a triangle.
double mean_sign(double x, double y, double z) {
  // one corner alone: its share of the area is the product of the crossings' fractions
  if ((x >= 0) == (y >= 0)) std::swap(x, z);
  if ((x >= 0) == (y >= 0)) return x >= 0 ? 1 : -1;
  if ((x >= 0) == (z >= 0)) std::swap(x, y);
  const double alone = x / (x - y) * (x / (x - z));
  return (x >= 0 ? 1 : -1) * (2 * alone - 1);
}

using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// M + t K. Rows of held vertices are those of the unit matrix; what they give their neighbours is `given`.
Matrix heat_step(const Mesh& mesh, const std::vector<double>& area, const std::vector<double>& time,
                 const std::vector<double>& held, Eigen::VectorXd& given) {
  const std::vector<Vec3>& p = mesh.points;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(12 * mesh.tris.size() + p.size());
  given = Eigen::VectorXd::Zero((Eigen::Index)p.size());
  for (std::size_t k = 0; k < mesh.tris.size(); ++k) {
    const Tri& v = mesh.tris[k];
    const auto weight = cotangent_weights(p[v[0]], p[v[1]], p[v[2]], 1e-3);
    for (int i = 0; i < 3; ++i) {
      const int a = v[i], b = v[(i + 1) % 3];
      const double w = time[k] * weight[i];
      if (held[a] == not_held) entries.emplace_back(a, a, area[k] / 3 + w);
      if (held[b] == not_held) entries.emplace_back(b, b, w);
      for (const auto& [to, from] : {std::pair(a, b), std::pair(b, a)})
        if (held[to] == not_held && held[from] == not_held)
          entries.emplace_back(to, from, -w);
        else if (held[to] == not_held)
          given[to] += w * held[from];
    }
  }
  for (int v = 0; v < (int)p.size(); ++v)
    if (held[v] != not_held) entries.emplace_back(v, v, 1);
  Matrix step((Eigen::Index)p.size(), (Eigen::Index)p.size());
  step.setFromTriplets(entries.begin(), entries.end());
  return step;
}

}  // namespace

std::vector<double> threshold_dynamics(const Mesh& mesh, std::vector<double> sign,
                                       const std::vector<double>& time, const std::vector<double>& held,
                                       int steps) {
  constexpr double accuracy = 0.002;
  constexpr int most = 200;
  const std::vector<Vec3>& p = mesh.points;
  const auto n = (Eigen::Index)p.size();
  std::vector<double> area;
  for (const Tri& v : mesh.tris) area.push_back(0.5 * norm(area_vector(p[v[0]], p[v[1]], p[v[2]])));
  Eigen::VectorXd given, right(n), mass = Eigen::VectorXd::Zero(n), s;
  const Matrix heat = heat_step(mesh, area, time, held, given);
  Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper> solver;
  solver.setTolerance(accuracy).setMaxIterations(most).compute(heat);
  for (std::size_t k = 0; k < sign.size(); ++k)
    for (int v : mesh.tris[k]) mass[v] += area[k] / 3;
  for (int step = 0; step < steps; ++step) {
    right.setZero();
    for (std::size_t k = 0; k < sign.size(); ++k)
      for (int v : mesh.tris[k]) right[v] += area[k] / 3 * sign[k];
    if (step == 0) s = (mass.array() > 0).select(right.cwiseQuotient(mass), 0);
    for (Eigen::Index v = 0; v < n; ++v)
      if (held[v] != not_held) right[v] = s[v] = 0;
    s = solver.solveWithGuess(right + given, s).eval();
    for (Eigen::Index v = 0; v < n; ++v)
      if (held[v] != not_held) s[v] = held[v];
    for (std::size_t k = 0; k < sign.size(); ++k)
      sign[k] = mean_sign(s[mesh.tris[k][0]], s[mesh.tris[k][1]], s[mesh.tris[k][2]]);
  }
  return {s.begin(), s.end()};
}

}  // namespace meshpipe
