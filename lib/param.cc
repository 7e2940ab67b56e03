// SPDX-License-Identifier: BSD-3-Clause
#include "lib/param.h"

#include <algorithm>
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

/// A surface known by its angles only: the part, with its holes filled or not.
struct Angles {
  std::vector<Tri> tris;
  std::vector<double> weights;  ///< of half-edges: half the cotangent of the opposite angle
  std::vector<double> sum;      ///< of the angles around each vertex
};

void add_triangle(Angles& angles, const Tri& t, const std::array<double, 3>& weights) {
  angles.tris.push_back(t);
  for (int i = 0; i < 3; ++i) {
    angles.weights.push_back(weights[i]);
    angles.sum[t[(i + 2) % 3]] += std::atan2(1, 2 * weights[i]);
  }
}

template <class Visit>
void for_each_spring(const Angles& angles, Visit visit) {
  for (int h = 0; h < (int)angles.weights.size(); ++h)
    visit(origin(angles.tris, h), target(angles.tris, h), angles.weights[h]);
}

/// The Laplacian of the unknowns 0..n-1; unknown[v] < 0: v is held; vertices may share an unknown.
Factorisation<double> laplacian(const Angles& angles, const std::vector<int>& unknown, int n) {
  std::vector<Entry<double>> matrix;
  std::vector<double> diagonal(n, 0);
  matrix.reserve(2 * angles.weights.size());
  for_each_spring(angles, [&](int a, int b, double w) {
    int i = unknown[a], j = unknown[b];
    if (i == j) return;
    if (i >= 0) diagonal[i] += w;
    if (j >= 0) diagonal[j] += w;
    if (i >= 0 && j >= 0) matrix.push_back({std::max(i, j), std::min(i, j), -w});
  });
  for (int i = 0; i < n; ++i) matrix.push_back({i, i, diagonal[i]});
  return Factorisation<double>(n, matrix);
}

/// How much the border turns at its vertices once the metric is scaled by exp(scale): its own turn and the
/// flux of the scale (the Cherrier formula).
std::vector<double> turns(const Angles& angles, const std::vector<double>& scale) {
  std::vector<double> turn(scale.size());
  for (std::size_t v = 0; v < turn.size(); ++v) turn[v] = pi - angles.sum[v];
  for_each_spring(angles, [&](int a, int b, double w) {
    turn[a] += w * (scale[a] - scale[b]);
    turn[b] += w * (scale[b] - scale[a]);
  });
  return turn;
}

/// The polygon of a loop with these turns and the lengths it has in space; places in the order of the loop.
/// It closes but for discretisation: the lengths l are changed to l (1 - c . direction), the least change
/// over l that closes it. Empty if a length would not stay positive.
std::vector<Vec2> polygon_of(const SubMesh& part, const std::vector<int>& loop,
                             const std::vector<double>& turn) {
  std::vector<Vec2> direction, polygon;
  double heading = 0, xx = 0, xy = 0, yy = 0;
  Vec2 gap, at;
  for (int h : loop) {
    heading += turn[origin(part.tris, h)];
    Vec2 d{std::cos(heading), std::sin(heading)};
    double l = edge_length(part, h);
    xx += l * d.x * d.x;
    xy += l * d.x * d.y;
    yy += l * d.y * d.y;
    gap = gap + l * d;
    direction.push_back(d);
  }
  double det = xx * yy - xy * xy;
  Vec2 c{(yy * gap.x - xy * gap.y) / det, (xx * gap.y - xy * gap.x) / det};
  for (std::size_t i = 0; i < loop.size(); ++i) {
    polygon.push_back(at);
    double stretch = 1 - dot(c, direction[i]);
    if (!(stretch > 0)) return {};
    at = at + stretch * edge_length(part, loop[i]) * direction[i];
  }
  return polygon;
}

/// Fills a hole by a fan of triangles around `centre`: of its polygon, if that is star-shaped, else of
/// isosceles triangles whose angle at the centre is the edge's share of the loop.
void fill_hole(const SubMesh& part, const std::vector<int>& loop, double length,
               const std::vector<double>& turn, int centre, Angles& angles) {
  std::vector<Vec2> polygon = polygon_of(part, loop, turn);
  Vec2 middle;
  for (Vec2 p : polygon) middle = middle + (1 / (double)loop.size()) * p;
  bool star = !polygon.empty();
  for (std::size_t i = 0; star && i < loop.size(); ++i) {
    // the part is on the left of the loop and the hole on its right
    Vec2 a = polygon[i] - middle, b = polygon[(i + 1) % loop.size()] - middle;
    star = cross(b, a) > 0.01 * dot(b - a, b - a);
  }
  for (std::size_t i = 0; i < loop.size(); ++i) {
    Tri t{target(part.tris, loop[i]), origin(part.tris, loop[i]), centre};
    if (star) {
      Vec2 a = polygon[i], b = polygon[(i + 1) % loop.size()];
      add_triangle(angles, t, cotangent_weights({b.x, b.y, 0}, {a.x, a.y, 0}, {middle.x, middle.y, 0}));
    } else {
      double angle = std::clamp(2 * pi * edge_length(part, loop[i]) / length, 1e-4, 0.75 * pi);
      double spoke = 0.5 * std::tan(angle / 2);
      add_triangle(angles, t, {0.5 / std::tan(angle), spoke, spoke});
    }
  }
}

/// The part's angles, and those of its holes filled by what they would be in the plane if each were scaled as
/// a whole: the flat metric that has one scale on each hole's border, and lets it turn by one round.
Angles filled_angles(const SubMesh& part, const Disk& disk) {
  Angles angles;
  int n_holes = (int)disk.loops.size() - 1, n_points = (int)part.points.size();
  angles.sum.assign(n_points + n_holes, 0);
  for (const Tri& t : part.tris)
    add_triangle(angles, t, cotangent_weights(part.points[t[0]], part.points[t[1]], part.points[t[2]]));
  if (n_holes == 0) return angles;

  std::vector<int> unknown(n_points + n_holes, n_holes);
  std::vector<double> scale(n_holes, -2 * pi);  // the turns that are missing, then the scale
  for (int h : disk.loops[0]) unknown[origin(part.tris, h)] = -1;
  for (int l = 0; l < n_holes; ++l) {
    unknown[n_points + l] = -1;
    for (int h : disk.loops[l + 1]) {
      unknown[origin(part.tris, h)] = l;
      scale[l] -= pi - angles.sum[origin(part.tris, h)];
    }
  }
  for (int v = 0; v < n_points; ++v)
    if (unknown[v] == n_holes) {
      unknown[v] = (int)scale.size() + 1;  // past n_holes, so that it is not taken for one that has none yet
      scale.push_back(angles.sum[v] - 2 * pi);
    }
  for (int& u : unknown)
    if (u > n_holes) --u;
  laplacian(angles, unknown, (int)scale.size()).solve(scale);
  std::vector<double> at(n_points + n_holes, 0);
  for (std::size_t v = 0; v < at.size(); ++v)
    if (unknown[v] >= 0) at[v] = scale[unknown[v]];
  std::vector<double> turn = turns(angles, at);
  for (int l = 0; l < n_holes; ++l)
    fill_hole(part, disk.loops[l + 1], disk.length[l + 1], turn, n_points + l, angles);
  return angles;
}

std::vector<Vec2> conformal_map(const SubMesh& part, const Disk& disk) {
  const Angles angles = filled_angles(part, disk);
  const auto& rim = disk.loops[0];
  int n_points = (int)angles.sum.size(), n = 0;
  std::vector<int> unknown(n_points, 0);
  for (int h : rim) unknown[origin(part.tris, h)] = -1;
  for (int& u : unknown)
    if (u == 0) u = n++;
  Factorisation<double> factorisation = laplacian(angles, unknown, n);
  // x is harmonic but for the `charge` of inner vertices, with the values that it has on the rim
  auto extend = [&](const std::vector<double>& charge, std::vector<double>& x) {
    std::vector<double> b(n);
    for (int v = 0; v < n_points; ++v)
      if (unknown[v] >= 0) b[unknown[v]] = charge[v];
    for_each_spring(angles, [&](int v, int w, double weight) {
      if (unknown[v] >= 0 && unknown[w] < 0) b[unknown[v]] += weight * x[w];
      if (unknown[w] >= 0 && unknown[v] < 0) b[unknown[w]] += weight * x[v];
    });
    factorisation.solve(b);
    for (int v = 0; v < n_points; ++v)
      if (unknown[v] >= 0) x[v] = b[unknown[v]];
  };

  // The log of the scale, zero on the rim, that takes all curvature from the inside (the Yamabe equation) and
  // brings it into the rim, whose turns then add up to one round; and harmonic coordinates within the rim's
  // polygon
  std::vector<double> scale(n_points, 0), charge(n_points), x(n_points), y(n_points);
  for (int v = 0; v < n_points; ++v) charge[v] = angles.sum[v] - 2 * pi;
  extend(charge, scale);
  std::vector<Vec2> polygon = polygon_of(part, rim, turns(angles, scale));
  if (polygon.empty()) throw GoalMissed("the border of the conformal map does not close");
  for (std::size_t i = 0; i < rim.size(); ++i) {
    x[origin(part.tris, rim[i])] = polygon[i].x;
    y[origin(part.tris, rim[i])] = polygon[i].y;
  }
  charge.assign(n_points, 0);
  extend(charge, x);
  extend(charge, y);
  std::vector<Vec2> uv(part.points.size());
  for (std::size_t v = 0; v < uv.size(); ++v) uv[v] = {x[v], y[v]};
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

/// A few of the pairs of vertices whose border edges cross.
std::vector<std::array<int, 2>> sample(const std::vector<std::array<int, 2>>& crossings) {
  constexpr std::size_t most = 4;
  std::vector<std::array<int, 2>> few;
  for (std::size_t k = 0; k < std::min(most, crossings.size()); ++k)
    few.push_back(crossings[(2 * k + 1) * crossings.size() / (2 * std::min(most, crossings.size()))]);
  return few;
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
  double chart_area = 0, smallest = HUGE_VAL, least = HUGE_VAL, most = 0;
  std::array<int, 2> extremes{0, 0};
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
    if (scale.back() < least) least = scale.back(), extremes[0] = t[0];
    if (scale.back() > most) most = scale.back(), extremes[1] = t[0];
  }
  if (anisotropy.empty()) return;
  report.anisotropy_median = quantile(anisotropy, 0.5);
  report.anisotropy_p99 = quantile(anisotropy, 0.99);
  report.anisotropy_max = quantile(anisotropy, 1);
  report.area_scale = quantile(scale, 0.99) / quantile(scale, 0.01);
  report.smallest_area = smallest / chart_area;
  if (report.apart.empty()) report.apart.push_back(extremes);
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
    report.border_was_simple = border_is_simple(part.tris, disk.opposite, uv);
    if (!report.border_was_simple) report.apart = sample(border_crossings(part.tris, disk.opposite, uv));
  } catch (const GoalMissed&) {  // singular to rounding, or a border that does not close
    report.flips_before = (int)part.tris.size();
  }
  bool valid = report.flips_before == 0 && report.border_was_simple;
  if (!valid && strict)
    throw GoalMissed("the map is not one-to-one: " + std::to_string(report.flips_before) + " of " +
                     std::to_string(part.tris.size()) + " triangles inverted or flat" +
                     (report.border_was_simple ? "" : ", the border crosses itself"));
  constexpr int sweeps = 10;
  auto repair = [&] {
    return repair_stars(part.tris, disk.opposite, sweeps, uv) == 0 && one_to_one(part, disk, uv);
  };
  if (!valid && !uv.empty() && report.border_was_simple) valid = repair();
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
  constexpr int most_rounds = 8,
                uneven_rounds = 3;  // unevenness is no failure: three cuts deep, then it stays
  constexpr double too_anisotropic = 4, too_uneven = 1e6;
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
      bool uneven = !missed && round < uneven_rounds && reports[p].area_scale > too_uneven;
      bool poor = !missed && reports[p].used != kind && reports[p].anisotropy_p99 > too_anisotropic;
      if (!missed && !poor && !uneven) continue;
      int n = n_parts;
      if (!strict && round < most_rounds) {
        if (uneven) n_parts = cut_along_limbs(surface, p, n_parts);
        if (n_parts == n && bisect_part(surface, p, n_parts, reports[p].apart)) ++n_parts;
      }
      if (n_parts > n)
        waiting[p] = 1;
      else if (missed)
        std::rethrow_exception(failure[p]);
    }
    if (n_parts == n_before) break;
  }
  for (Chart& chart : charts) index_chart(chart);
  return charts;
}

}  // namespace meshpipe
