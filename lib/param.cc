// SPDX-License-Identifier: BSD-3-Clause
#include "lib/param.h"

#include <algorithm>
#include <complex>
#include <exception>
#include <numbers>
#include <string>

#include "lib/bisect.h"
#include "lib/error.h"
#include "lib/injective.h"
#include "lib/sparse.h"
#include "lib/topology.h"

namespace meshpipe {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

/// A part's connectivity, and its loops with the longest first.
struct Disk {
  std::vector<int> opposite;
  std::vector<std::vector<int>> loops;
  std::vector<double> length;
};

double edge_length(const Mesh& mesh, int h) {
  return norm(mesh.points[target(mesh.tris, h)] - mesh.points[origin(mesh.tris, h)]);
}

Disk disk_of(const SubMesh& part) {
  Disk d;
  int n = (int)part.points.size();
  d.opposite = opposite_halfedges(part.tris, n);
  if (int v = find_pinched_vertex(part.tris, d.opposite, n); v >= 0)
    throw NotAdmissible("the part touches itself at vertex " + std::to_string(part.vertex[v]) +
                        "; run mpartition first");
  std::vector<int> component;
  int n_components = components(d.opposite, component);
  d.loops = boundary_loops(d.opposite);
  int n_border = 0;
  std::size_t longest = 0;
  for (const auto& loop : d.loops) {
    double length = 0;
    for (int h : loop) length += edge_length(part, h);
    d.length.push_back(length);
    n_border += (int)loop.size();
    if (length > d.length[longest]) longest = d.length.size() - 1;
  }
  int n_loops = (int)d.loops.size(), n_tris = (int)part.tris.size();
  int euler = n - (3 * n_tris + n_border) / 2 + n_tris;
  if (n_components != 1 || n_loops == 0 || euler != 2 - n_loops)
    throw NotAdmissible("not a disk with holes: components " + std::to_string(n_components) + ", genus " +
                        std::to_string((2 * n_components - euler - n_loops) / 2) + ", loops " +
                        std::to_string(n_loops) + "; run mpartition first");
  std::swap(d.loops[0], d.loops[longest]);
  std::swap(d.length[0], d.length[longest]);
  return d;
}

void scale_to_area(const SubMesh& part, std::vector<Vec2>& uv) {
  double area = 0;
  for (const Tri& t : part.tris) area += 0.5 * cross(uv[t[1]] - uv[t[0]], uv[t[2]] - uv[t[0]]);
  if (!(area > 0)) return;
  double s = std::sqrt(total_area(part) / area);
  for (Vec2& p : uv) p = s * p;
}

/// Two border vertices far apart: the one farthest from the first, and the one farthest from that.
std::array<int, 2> pins(const SubMesh& part, const std::vector<int>& loop) {
  auto farthest_from = [&](int v) {
    int best = v;
    for (int h : loop) {
      int w = origin(part.tris, h);
      if (norm(part.points[w] - part.points[v]) > norm(part.points[best] - part.points[v])) best = w;
    }
    return best;
  };
  int a = farthest_from(origin(part.tris, loop[0])), b = farthest_from(a);
  if (a == b) throw GoalMissed("the border is a single point in space");
  return {a, b};
}

std::vector<Vec2> conformal_map(const SubMesh& part, const Disk& disk) {
  // With z = u + i v the conformal energy E_D(z) - A(z) is 1/2 z* M z for the Hermitian M = K + Q: K holds
  // the cotangents, Q the signed area enclosed by the border, A = 1/2 sum Im(conj(z_a) z_b) over its edges a
  // -> b. M is positive semidefinite whatever the angles, and definite once two vertices are held (at 0 and
  // 1).
  int n_points = (int)part.points.size();
  auto [at_zero, at_one] = pins(part, disk.loops[0]);
  std::vector<int> unknown(n_points + disk.loops.size() - 1);  // the virtual centres come last
  int n = 0;
  for (int v = 0; v < (int)unknown.size(); ++v) unknown[v] = v == at_zero || v == at_one ? -1 : n++;

  std::vector<Entry<Complex>> matrix;
  matrix.reserve(2 * disk.opposite.size());
  std::vector<double> diagonal(n, 0);
  std::vector<Complex> z(n, 0);
  auto add = [&](int a, int b, Complex m) {  // m at row a, column b, its conjugate at row b, column a
    int i = unknown[a], j = unknown[b];
    if (i >= 0 && j >= 0)
      matrix.push_back(i > j ? Entry<Complex>{i, j, m} : Entry<Complex>{j, i, std::conj(m)});
    else if (i >= 0 && b == at_one)
      z[i] -= m;
    else if (j >= 0 && a == at_one)
      z[j] -= std::conj(m);
  };
  auto spring = [&](int a, int b, double w) {
    if (unknown[a] >= 0) diagonal[unknown[a]] += w;
    if (unknown[b] >= 0) diagonal[unknown[b]] += w;
    add(a, b, -w);
  };
  for (const Tri& t : part.tris) {
    auto w = cotangent_weights(part.points[t[0]], part.points[t[1]], part.points[t[2]]);
    for (int i = 0; i < 3; ++i) spring(t[i], t[(i + 1) % 3], w[i]);
  }
  for (int h : disk.loops[0]) add(origin(part.tris, h), target(part.tris, h), Complex(0, 0.5));
  for (std::size_t l = 1; l < disk.loops.size(); ++l)
    for (int h : disk.loops[l]) {
      // the isosceles triangle on this edge whose angle at the centre is the edge's share of the loop
      int a = origin(part.tris, h), b = target(part.tris, h), centre = n_points + (int)l - 1;
      double angle = std::clamp(2 * pi * edge_length(part, h) / disk.length[l], 1e-4, 0.75 * pi);
      spring(a, b, 0.5 / std::tan(angle));
      spring(a, centre, 0.5 * std::tan(angle / 2));
      spring(b, centre, 0.5 * std::tan(angle / 2));
    }
  for (int i = 0; i < n; ++i) matrix.push_back({i, i, diagonal[i]});
  Factorisation<Complex>(n, matrix).solve(z);

  std::vector<Vec2> uv(n_points);
  for (int v = 0; v < n_points; ++v)
    if (unknown[v] >= 0) uv[v] = {z[unknown[v]].real(), z[unknown[v]].imag()};
  uv[at_one] = {1, 0};
  scale_to_area(part, uv);
  return uv;
}

std::vector<Vec2> convex_map(const SubMesh& part, const Disk& disk) {
  const auto& rim = disk.loops[0];
  std::vector<Vec2> uv(part.points.size());
  std::vector<char> fixed(part.points.size(), 0);
  // Arc length, but no edge so short that the circle is straight to rounding there: an ear needs its bulge
  double shortest = 0.01 * disk.length[0] / (double)rim.size(), length = 0, at = 0;
  for (int h : rim) length += std::max(edge_length(part, h), shortest);
  for (int h : rim) {
    double angle = 2 * pi * at / length;
    uv[origin(part.tris, h)] = {std::cos(angle), std::sin(angle)};
    fixed[origin(part.tris, h)] = 1;
    at += std::max(edge_length(part, h), shortest);
  }
  // positive weights make it one-to-one; bounded ones keep it so in floating point
  std::vector<double> weights;
  weights.reserve(disk.opposite.size());
  for (const Tri& t : part.tris)
    for (double w : cotangent_weights(part.points[t[0]], part.points[t[1]], part.points[t[2]], 0.01))
      weights.push_back(std::min(w, 50.0));
  std::vector<std::vector<int>> fans;
  for (std::size_t l = 1; l < disk.loops.size(); ++l) {
    auto& fan = fans.emplace_back();
    for (int h : disk.loops[l]) fan.push_back(origin(part.tris, h));
  }
  solve_dirichlet(part.tris, weights, fixed, fans, uv);
  scale_to_area(part, uv);
  return uv;
}

bool one_to_one(const SubMesh& part, const Disk& disk, const std::vector<Vec2>& uv) {
  return count_inverted(part.tris, uv) == 0 && border_is_simple(part.tris, disk.opposite, uv);
}

/// The element at the fraction q of the order.
double quantile(std::vector<double>& values, double q) {
  auto at = values.begin() + (std::ptrdiff_t)(q * (double)(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

std::vector<Vec2> conformal_map(const SubMesh& part) { return conformal_map(part, disk_of(part)); }
std::vector<Vec2> convex_map(const SubMesh& part) { return convex_map(part, disk_of(part)); }

void measure_distortion(const SubMesh& part, const std::vector<Vec2>& uv, ParamReport& report) {
  std::vector<double> anisotropy, scale;
  double chart_area = 0, smallest = HUGE_VAL;
  for (const Tri& t : part.tris) {
    Vec3 e = part.points[t[1]] - part.points[t[0]], f = part.points[t[2]] - part.points[t[0]];
    Vec2 p = uv[t[1]] - uv[t[0]], q = uv[t[2]] - uv[t[0]];
    double image = 0.5 * cross(p, q), l = norm(e), area = 0.5 * norm(cross(e, f));
    chart_area += image;
    smallest = std::min(smallest, image);
    if (!(area > 0)) continue;
    // the derivatives along the first edge and across it, and from them the two parts of the map that keep
    // and that reverse angles; sigma1 and sigma2 are the sum and the difference of their norms
    Vec2 x = (1 / l) * p, y = (l / (2 * area)) * (q - (dot(e, f) / (l * l)) * p);
    double keep = 0.5 * std::hypot(x.x + y.y, x.y - y.x), reverse = 0.5 * std::hypot(x.x - y.y, x.y + y.x);
    anisotropy.push_back(keep > reverse ? (keep + reverse) / (keep - reverse) : HUGE_VAL);
    scale.push_back(image / area);
  }
  if (anisotropy.empty()) return;
  report.anisotropy_median = quantile(anisotropy, 0.5);
  report.anisotropy_p99 = quantile(anisotropy, 0.99);
  report.anisotropy_max = quantile(anisotropy, 1);
  report.area_scale = quantile(scale, 0.99) / quantile(scale, 0.01);
  report.smallest_area = smallest / chart_area;
}

std::vector<Vec2> map_part(const SubMesh& part, MapKind kind, bool strict, ParamReport& report) {
  if (kind == MapKind::harmonic) throw BadUsage("the harmonic map is not built yet");
  Disk disk = disk_of(part);
  report = {};
  report.used = kind;
  std::vector<Vec2> uv;
  try {
    uv = kind == MapKind::conformal ? conformal_map(part, disk) : convex_map(part, disk);
    report.flips_before = count_inverted(part.tris, uv);
    report.overlap_before = !border_is_simple(part.tris, disk.opposite, uv);
  } catch (const GoalMissed&) {  // singular to rounding
    report.flips_before = (int)part.tris.size();
  }
  bool valid = report.flips_before == 0 && !report.overlap_before;
  if (!valid && strict)
    throw GoalMissed("the map is not one-to-one: " + std::to_string(report.flips_before) + " of " +
                     std::to_string(part.tris.size()) + " triangles inverted or flat" +
                     (report.overlap_before ? ", the border crosses itself" : ""));
  constexpr int sweeps = 10;
  auto repair = [&] {
    return repair_stars(part.tris, disk.opposite, sweeps, uv) == 0 && one_to_one(part, disk, uv);
  };
  if (!valid && !uv.empty() && !report.overlap_before) valid = repair();
  if (!valid && kind == MapKind::conformal) {
    report.used = MapKind::convex;
    uv = convex_map(part, disk);
    valid = one_to_one(part, disk, uv) || repair();
  }
  if (!valid)
    throw GoalMissed("no one-to-one map: " + std::to_string(count_inverted(part.tris, uv)) + " of " +
                     std::to_string(part.tris.size()) + " triangles of the convex map inverted or flat");
  measure_distortion(part, uv, report);
  return uv;
}

std::vector<Chart> map_surface(Surface& surface, int n_parts, MapKind kind, bool strict,
                               std::vector<ParamReport>& reports) {
  constexpr int most_rounds = 8;
  constexpr double too_anisotropic = 20;
  std::vector<Chart> charts;
  std::vector<char> waiting;
  reports.clear();
  for (int round = 0;; ++round) {
    // a part is mapped anew if it was cut, or got vertices from the cut of a neighbour
    std::vector<SubMesh> parts = split_by_label(surface, surface.face.get<int>("part"), n_parts);
    charts.resize(n_parts);
    reports.resize(n_parts);
    waiting.resize(n_parts, 1);
    for (int p = 0; p < n_parts; ++p) {
      if (parts[p].vertex != charts[p].mesh.vertex) waiting[p] = 1;
      charts[p].mesh = std::move(parts[p]);
    }

    std::vector<std::exception_ptr> failure(n_parts);
#pragma omp parallel for schedule(dynamic)
    for (int p = 0; p < n_parts; ++p) {
      if (!waiting[p]) continue;
      try {
        charts[p].uv = map_part(charts[p].mesh, kind, strict, reports[p]);
      } catch (const GoalMissed& e) {
        failure[p] = std::make_exception_ptr(GoalMissed("part " + std::to_string(p) + ": " + e.what()));
      } catch (const NotAdmissible& e) {
        failure[p] = std::make_exception_ptr(NotAdmissible("part " + std::to_string(p) + ": " + e.what()));
      } catch (...) {
        failure[p] = std::current_exception();
      }
    }
    int n_before = n_parts;
    for (int p = 0; p < n_before; ++p) {
      if (!waiting[p]) continue;
      waiting[p] = 0;
      bool missed = false;
      if (failure[p]) try {
          std::rethrow_exception(failure[p]);
        } catch (const GoalMissed&) {
          missed = true;
        }
      bool poor = reports[p].used != kind && reports[p].anisotropy_p99 > too_anisotropic;
      if (!missed && !poor) continue;
      if (!strict && round < most_rounds && bisect_part(surface, p, n_parts)) {
        waiting[p] = 1;
        ++n_parts;
      } else if (missed) {
        std::rethrow_exception(failure[p]);
      }
    }
    if (n_parts == n_before) break;
  }
  for (Chart& chart : charts) index_chart(chart);
  return charts;
}

}  // namespace meshpipe
