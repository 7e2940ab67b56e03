// SPDX-License-Identifier: BSD-3-Clause
#include "lib/param/conformal.h"

#include <algorithm>
#include <complex>
#include <numbers>
#include <string>
#include <utility>

#include "lib/core/error.h"

namespace meshpipe {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

/// Inner vertices are numbered, those of the longest loop are held.
std::vector<int> inner_unknowns(const SubMesh& part, const Disk& disk, const Filled& filled, int& n) {
  std::vector<int> unknown(filled.n_vertices, 0);
  for (int h : disk.loops[0]) unknown[origin(part.tris, h)] = -1;
  n = 0;
  for (int& u : unknown)
    if (u == 0) u = n++;
  return unknown;
}

/// Entries of the Hermitian matrix z^H M z = 2 (Dirichlet energy - area), lower triangle, and its diagonal.
/// The area is a sum over the border of the filled part.
std::vector<Entry<Complex>> conformal_energy(const SubMesh& part, const Disk& disk, const Filled& filled,
                                             std::vector<double>& diagonal) {
  std::vector<Entry<Complex>> matrix;
  std::vector<double> weights = cotangents(filled.shape);
  matrix.reserve(weights.size() + filled.n_vertices);
  diagonal.assign(filled.n_vertices, 0);
  for (int h = 0; h < (int)weights.size(); ++h) {
    int a = origin(filled.tris, h), b = target(filled.tris, h);
    if (a == b) continue;  // a loop of an intrinsic triangulation
    diagonal[a] += weights[h];
    diagonal[b] += weights[h];
    matrix.push_back({std::max(a, b), std::min(a, b), -weights[h]});
  }
  bool holes_filled = 3 * filled.tris.size() > disk.opposite.size();
  std::size_t loops = holes_filled ? 1 : disk.loops.size();
  for (std::size_t l = 0; l < loops; ++l)
    for (int h : disk.loops[l]) {
      int a = origin(part.tris, h), b = target(part.tris, h);
      matrix.push_back({std::max(a, b), std::min(a, b), {0, a > b ? 0.5 : -0.5}});
    }
  return matrix;
}

std::vector<Vec2> plane_points(const SubMesh& part, const std::vector<Complex>& z) {
  std::vector<Vec2> uv;
  for (std::size_t v = 0; v < part.points.size(); ++v) uv.push_back({z[v].real(), z[v].imag()});
  scale_to_area(part, uv);
  return uv;
}

}  // namespace

BoundaryFirst::BoundaryFirst(const SubMesh& part, const Disk& disk, Filled filled)
    : part_(part),
      disk_(disk),
      filled_(std::move(filled)),
      weights_(cotangents(std::exchange(filled_.shape, {}))),
      angle_sum_(angle_sums(filled_, weights_)),
      unknown_(inner_unknowns(part, disk, filled_, n_)),
      factorization_(laplacian(filled_, weights_, unknown_, n_)) {
  // The log of the scale, zero on the rim, that takes all curvature from the inside (the Yamabe equation) and
  // brings it into the rim, whose turns then add up to 2 pi
  std::vector<double> charge(filled_.n_vertices);
  for (std::size_t v = 0; v < charge.size(); ++v) charge[v] = angle_sum_[v] - 2 * pi;
  std::vector<double> scale = extend(charge, std::vector<double>(charge.size(), 0), 1);
  turn_ = turns(filled_, weights_, angle_sum_, scale);
  scale.resize(part.points.size());
  std::size_t few = scale.size() / 100, many = scale.size() - 1 - few;
  std::nth_element(scale.begin(), scale.begin() + few, scale.end());
  double low = scale[few];
  std::nth_element(scale.begin(), scale.begin() + many, scale.end());
  area_distortion_ = std::exp(2 * (scale[many] - low));
}

/// Solves for the inner vertices with the given charges (empty: none), for several columns of held values.
std::vector<double> BoundaryFirst::extend(const std::vector<double>& charge, const std::vector<double>& held,
                                          int columns) const {
  int n_vertices = filled_.n_vertices;
  std::vector<double> b((std::size_t)n_ * columns, 0), x = held;
  for (int v = 0; v < n_vertices && !charge.empty(); ++v)
    if (unknown_[v] >= 0) b[unknown_[v]] = charge[v];
  for (int h = 0; h < (int)weights_.size(); ++h) {
    int from = origin(filled_.tris, h), to = target(filled_.tris, h);
    if (unknown_[from] < 0) std::swap(from, to);
    if (unknown_[from] < 0 || unknown_[to] >= 0) continue;
    for (int c = 0; c < columns; ++c) b[c * n_ + unknown_[from]] += weights_[h] * held[c * n_vertices + to];
  }
  factorization_.solve(b);
  for (int c = 0; c < columns; ++c)
    for (int v = 0; v < n_vertices; ++v)
      if (unknown_[v] >= 0) x[c * n_vertices + v] = b[c * n_ + unknown_[v]];
  return x;
}

std::vector<Vec2> BoundaryFirst::polygon(double bend) {
  const auto& rim = disk_.loops[0];
  std::vector<double> turn = turn_, length;
  for (int h : rim) length.push_back(edge_length(part_, h));
  if (bend > 0) {
    // The turn of a circle at a vertex is half the share of its two edges in the border.
    std::vector<double> round(filled_.n_vertices, 0);
    for (std::size_t i = 0; i < rim.size(); ++i) {
      double share = pi * length[i] / disk_.length[0];
      round[origin(part_.tris, rim[i])] += share;
      round[target(part_.tris, rim[i])] += share;
    }
    if (scale_.empty()) {
      // the scale that gives the rim these turns: the Laplacian with fluxes given instead of values
      int held = origin(part_.tris, rim[0]);
      std::vector<int> unknown(filled_.n_vertices);
      std::vector<double> flux(filled_.n_vertices - 1);
      for (int v = 0; v < filled_.n_vertices; ++v) {
        unknown[v] = v == held ? -1 : v - (v > held);
        if (v == held) continue;
        flux[unknown[v]] = unknown_[v] < 0 ? round[v] - (pi - angle_sum_[v]) : angle_sum_[v] - 2 * pi;
      }
      laplacian(filled_, weights_, unknown, (int)flux.size()).solve(flux);
      scale_.assign(filled_.n_vertices, 0);
      for (int v = 0; v < filled_.n_vertices; ++v)
        if (unknown[v] >= 0) scale_[v] = flux[unknown[v]];
    }
    for (std::size_t i = 0; i < rim.size(); ++i) {
      int a = origin(part_.tris, rim[i]), b = target(part_.tris, rim[i]);
      turn[a] += bend * (round[a] - turn_[a]);
      length[i] *= std::exp(0.5 * bend * (scale_[a] + scale_[b]));
    }
  }
  return polygon_of(part_, rim, turn, length);
}

std::vector<Vec2> BoundaryFirst::map(const std::vector<Vec2>& polygon) const {
  int n_vertices = filled_.n_vertices;
  std::vector<double> x(2 * n_vertices, 0);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    int v = origin(part_.tris, disk_.loops[0][i]);
    x[v] = polygon[i].x;
    x[n_vertices + v] = polygon[i].y;
  }
  x = extend({}, x, 2);
  std::vector<Vec2> uv;
  for (int v = 0; v < (int)part_.points.size(); ++v) uv.push_back({x[v], x[n_vertices + v]});
  scale_to_area(part_, uv);
  return uv;
}

std::vector<Vec2> least_squares_map(const SubMesh& part, const Disk& disk, const Filled& filled) {
  // two vertices of the longest loop that are far apart, by two sweeps
  int held[2] = {origin(part.tris, disk.loops[0][0]), -1};
  for (int sweep = 0; sweep < 2; ++sweep) {
    int from = sweep == 0 ? held[0] : held[1], far = -1;
    double apart = -1;
    for (int h : disk.loops[0]) {
      int v = origin(part.tris, h);
      double d = norm(part.points[v] - part.points[from]);
      if (v != from && d > apart) apart = d, far = v;
    }
    held[0] = from;
    held[1] = far;
  }
  std::vector<Complex> z(filled.n_vertices, 0);
  z[held[1]] = 1;

  std::vector<double> diagonal;
  std::vector<Entry<Complex>> energy = conformal_energy(part, disk, filled, diagonal), matrix;
  std::vector<int> unknown(filled.n_vertices, 0);
  unknown[held[0]] = unknown[held[1]] = -1;
  int n = 0;
  for (int& u : unknown)
    if (u == 0) u = n++;
  std::vector<Complex> b(n, 0);
  matrix.reserve(energy.size() + n);
  for (const auto& e : energy) {  // unknowns keep the order of the vertices: the lower triangle stays it
    int i = unknown[e.row], j = unknown[e.col];
    if (i >= 0 && j >= 0) matrix.push_back({i, j, e.value});
    if (i >= 0 && j < 0) b[i] -= e.value * z[e.col];
    if (i < 0 && j >= 0) b[j] -= std::conj(e.value) * z[e.row];
  }
  for (int v = 0; v < filled.n_vertices; ++v)
    if (unknown[v] >= 0) matrix.push_back({unknown[v], unknown[v], diagonal[v]});
  if (n > 0) Factorization<Complex>(n, std::move(matrix)).solve(b);
  for (int v = 0; v < filled.n_vertices; ++v)
    if (unknown[v] >= 0) z[v] = b[unknown[v]];
  return plane_points(part, z);
}

std::vector<Vec2> spectral_map(const SubMesh& part, const Disk& disk, const Filled& filled) {
  int n = filled.n_vertices;
  std::vector<double> diagonal, moment(n, 0);
  std::vector<Entry<Complex>> matrix = conformal_energy(part, disk, filled, diagonal);
  double total = 0;
  for (int h : disk.loops[0]) {
    double half = 0.5 * edge_length(part, h) / disk.length[0];
    moment[origin(part.tris, h)] += half;
    moment[target(part.tris, h)] += half;
    total += 2 * half;
  }
  // translations are in the kernel, and the map itself nearly: a shift by the moment, which changes no
  // eigenvector, makes the matrix definite
  constexpr double shift = 1e-6;
  for (int v = 0; v < n; ++v) matrix.push_back({v, v, diagonal[v] + shift * moment[v]});
  Factorization<Complex> factorization(n, std::move(matrix));

  std::vector<Complex> z(n, 0), before;
  double at = 0;
  for (int h : disk.loops[0]) {  // from the circle
    z[origin(part.tris, h)] = std::polar(1.0, 2 * pi * at / disk.length[0]);
    at += edge_length(part, h);
  }
  constexpr int most = 200;
  double change = infinity;
  for (int iteration = 0; iteration < most && change > 1e-8; ++iteration) {
    Complex center = 0;
    for (int v = 0; v < n; ++v) center += moment[v] * z[v] / total;
    double size = 0;
    for (int v = 0; v < n; ++v) {
      z[v] -= center;
      size += moment[v] * std::norm(z[v]);
    }
    // rotated like the one before: a rotation of the plane is no change
    Complex along = 0;
    for (int v = 0; v < n && !before.empty(); ++v) along += moment[v] * std::conj(z[v]) * before[v];
    Complex turn = std::abs(along) > 0 ? along / std::abs(along) : 1;
    for (Complex& p : z) p *= turn / std::sqrt(size);
    if (!before.empty()) {
      change = 0;
      for (int v = 0; v < n; ++v) change += moment[v] * std::norm(z[v] - before[v]);
      change = std::sqrt(change);
    }
    if (change <= 1e-8) break;
    before = z;
    for (int v = 0; v < n; ++v) z[v] *= moment[v];
    factorization.solve(z);
  }
  if (!(change < 1e-4))
    throw GoalMissed("the spectral conformal map did not converge: change " + std::to_string(change) +
                     " after " + std::to_string(most) + " iterations");
  return plane_points(part, z);
}

}  // namespace meshpipe
