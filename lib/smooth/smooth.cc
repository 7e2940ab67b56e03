// SPDX-License-Identifier: BSD-3-Clause
#include "lib/smooth/smooth.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lib/core/error.h"
#include "lib/core/normals.h"
#include "lib/core/number.h"
#include "lib/core/topology.h"
#include "lib/smooth/separate.h"

namespace meshpipe {
namespace {

// Chosen on voxels of spheres, tubes and trees, 3 to 40 voxels wide: distances to the true surface fall by 3
// to 11 (root mean square); Taubin's own filter with twice the work gets 2.9 to 6.6. More rounds sharpen the
// limit between waves that stay and those that go, and a sharp one makes the surface swell next to sharp
// rims: five rounds of ten steps are 10 to 20 % worse. A third more steps spoil tubes of 6 voxels.
constexpr int rounds = 2;
/// Of smoothing in a round; fewer where these make the surface rougher, as they do if it bends by more than a
/// right angle within a few edges.
constexpr int steps[] = {15, 8, 3};
constexpr int spreading = 2;  ///< times as many steps of averaging the displacement, which is then taken back
constexpr double damping = 0.5;  ///< of a step: 1 would let the shortest waves oscillate
/// Of what is done inside: along a line of neighbors the same wave goes twice as fast as in a net of
/// equilateral triangles. At another pace than the tube behind it a rim makes it swell or shrink there.
constexpr double along_rim = 0.5;

constexpr double most_volume_change = 1e-3;  ///< relative; GoalMissed beyond
constexpr double volume_tolerance = 1e-6;    ///< relative; where the search for the offset ends
constexpr double planar = 1e-5;              ///< of the diagonal: single precision far from the origin
/// Of its radius, by which a border may be off its plane and is smoothed along it: the wobble of an
/// extraction.
constexpr double almost_planar = 0.1;
constexpr double least_gain = 0.1;  ///< of what smoothing without a bound does to the angles: less is no help
constexpr int worth_threads = 20000;  ///< vertices
constexpr int most_repairs = 4;       ///< of intersections and volume in turn

/// The surface while it moves.
struct Motion {
  Surface& s;
  const Connectivity& c;
  double within;
  std::vector<Vec3> start;
  Lists near;
  std::vector<std::array<int, 2>> along{};  ///< per vertex of a border: its two neighbors there
  std::vector<int> loop{};                  ///< per vertex, of the border it slides along; else -1
  std::vector<Vec3> plane{};                ///< per loop: the unit normal of its plane; zero if it stays
  std::vector<Vec3> center{};               ///< per loop
  std::vector<char> held{};                 ///< vertices that stay where they are
  std::vector<int> component{};             ///< per triangle
  int n_components = 0;

  Motion(Surface& surface, const Connectivity& connectivity, double bound)
      : s(surface), c(connectivity), within(bound), start(surface.points), near(neighbors_of(surface)) {}
  int n() const { return c.n_vertices(); }
};

template <class F>
void for_vertices(const Motion& m, F f) {
#pragma omp parallel for schedule(static) if (m.n() > worth_threads)
  for (int v = 0; v < m.n(); ++v)
    if (!m.held[v]) f(v);
}

/// Finds the borders, those almost in a plane, and what is held.
void find_borders(Motion& m, bool keep_features, SmoothReport& report) {
  m.held.assign(m.n(), 0);
  m.loop.assign(m.n(), -1);
  m.along.resize(m.n());
  for (int v = 0; v < m.n(); ++v) m.held[v] = m.near[v].empty();
  const double tolerance = planar * diagonal(m.s);
  for (const auto& loop : boundary_loops(m.c.opposite)) {
    Vec3 center, normal;
    for (int h : loop) center = center + (1.0 / loop.size()) * m.c.point(m.c.from(h));
    for (int h : loop)
      normal = normal + cross(m.c.point(m.c.from(h)) - center, m.c.point(m.c.to(h)) - center);
    const double radius = std::sqrt(norm(normal) / (2 * std::numbers::pi));
    const double most = std::max(tolerance, almost_planar * radius);
    normal = normalized(normal);
    bool flat = norm(normal) > 0;
    for (int h : loop) flat = flat && std::abs(dot(m.c.point(m.c.from(h)) - center, normal)) <= most;
    ++(flat ? report.planar_ends : report.kept_ends);
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int v = m.c.from(loop[i]);
      m.held[v] |= !flat || m.loop[v] >= 0;  // a second loop goes through it
      m.loop[v] = (int)m.plane.size();
      m.along[v] = {m.c.from(loop[(i + loop.size() - 1) % loop.size()]), m.c.to(loop[i])};
    }
    m.plane.push_back(flat ? normal : Vec3{});
    m.center.push_back(center);
  }
  if (!keep_features) return;
  for (int h = 0; h < m.c.n_half_edges(); ++h)
    if (m.c.is_model(h)) m.held[m.c.from(h)] = m.held[m.c.to(h)] = 1;
}

/// The part of a displacement that a vertex may take: along the plane of its end.
Vec3 allowed(const Motion& m, int v, Vec3 d) {
  return m.loop[v] < 0 ? d : d - dot(d, m.plane[m.loop[v]]) * m.plane[m.loop[v]];
}

/// Moves a vertex to a point as far as it may go.
void place(Motion& m, int v, Vec3 p) {
  Vec3 d = allowed(m, v, p - m.start[v]);
  const double l = norm(d);
  if (l > m.within) d = (m.within / l) * d;
  m.s.points[v] = m.start[v] + d;
  while (norm(m.s.points[v] - m.start[v]) > m.within) {  // by rounding
    d = (1 - 1e-9) * d;
    m.s.points[v] = m.start[v] + d;
  }
}

/// Unit normals of the vertices; those of ends in their planes.
std::vector<Vec3> normals_of(const Motion& m) {
  std::vector<Vec3> normal = vertex_normals(m.s);
  for (int v = 0; v < m.n(); ++v)
    if (m.loop[v] >= 0) normal[v] = normalized(allowed(m, v, normal[v]));
  return normal;
}

/// Moves every vertex towards the mean of its neighbors, along the border for those on it.
void smooth_steps(Motion& m, int count) {
  std::vector<Vec3> to = m.s.points;
  for (int i = 0; i < count; ++i) {
    for_vertices(m, [&](int v) {
      const auto& p = m.s.points;
      Vec3 mean;
      if (m.loop[v] >= 0) {
        mean = lerp(p[v], 0.5 * (p[m.along[v][0]] + p[m.along[v][1]]), along_rim);
      } else {
        for (int w : m.near[v]) mean = mean + p[w];
        mean = (1.0 / (double)m.near[v].size()) * mean;
      }
      to[v] = p[v] + allowed(m, v, damping * (mean - p[v]));
    });
    std::swap(m.s.points, to);
  }
}

/// Averages a value over a neighborhood: diffuses it, its integral kept (along borders: its sum).
void spread(const Motion& m, int count, std::vector<double>& value) {
  const std::vector<double> area = vertex_areas(m.s);
  std::vector<double> to = value, share(m.n(), 0);
  for (int v = 0; v < m.n(); ++v) share[v] = 1.0 / std::max(1.0, (double)m.near[v].size());
  for (int i = 0; i < count; ++i) {
    for_vertices(m, [&](int v) {
      double sum = 0;
      if (m.loop[v] >= 0) {
        sum = along_rim * (0.5 * (value[m.along[v][0]] + value[m.along[v][1]]) - value[v]);
      } else if (area[v] > 0) {
        // symmetric flows (Metropolis), at most the whole in a step
        for (int u : m.near[v]) {
          if (m.held[u]) continue;
          sum += std::min(area[u], area[v]) * std::min(share[u], share[v]) * (value[u] - value[v]);
        }
        sum /= area[v];
      }
      to[v] = value[v] + damping * sum;
    });
    std::swap(value, to);
  }
}

/// Smooths, and takes back what moved whole neighborhoods to one side, which shrinks tubes and balls.
void smooth_rounds(Motion& m, int count) {
  std::vector<double> moved(m.n(), 0);
  for (int round = 0; round < rounds; ++round) {
    smooth_steps(m, count);
    const std::vector<Vec3> normal = normals_of(m);
    for_vertices(m, [&](int v) { moved[v] = dot(m.start[v] - m.s.points[v], normal[v]); });
    spread(m, spreading * count, moved);
    for_vertices(m, [&](int v) { place(m, v, m.s.points[v] + moved[v] * normal[v]); });
  }
}

/// The volume of each component, its ends closed towards their centers.
std::vector<double> volumes_of(const Motion& m) {
  std::vector<double> volume(m.n_components, 0);
  const Vec3 middle = m.start[m.s.tris[0][0]];
  auto add = [&](int t, Vec3 a, Vec3 b, Vec3 p) {
    volume[m.component[t]] += dot(a - middle, cross(b - middle, p - middle)) / 6;
  };
  for (int t = 0; t < m.c.n_tris(); ++t) {
    const auto& [i, j, k] = m.s.tris[t];
    add(t, m.s.points[i], m.s.points[j], m.s.points[k]);
    for (int h = 3 * t; h < 3 * t + 3; ++h)
      if (m.c.is_border(h))
        add(t, m.c.point(m.c.to(h)), m.c.point(m.c.from(h)), m.center[m.loop[m.c.from(h)]]);
  }
  return volume;
}

/// What changes of a component's volume are measured by: of a sheet, that of a layer one edge thick.
std::vector<double> measures_of(const Motion& m, const std::vector<double>& volume, double edge) {
  std::vector<double> measure(m.n_components, 0);
  for (int t = 0; t < m.c.n_tris(); ++t) measure[m.component[t]] += edge * triangle_area(m.s, t);
  for (int k = 0; k < m.n_components; ++k) measure[k] = std::max(measure[k], std::abs(volume[k]));
  return measure;
}

/// Moves components along their normals until they have their volumes again.
void keep_volumes(Motion& m, const std::vector<double>& volume, const std::vector<double>& measure) {
  std::vector<int> component(m.n(), 0);
  for (int t = 0; t < m.c.n_tris(); ++t)
    for (int v : m.s.tris[t]) component[v] = m.component[t];
  for (int i = 0; i < 10; ++i) {
    const std::vector<double> now = volumes_of(m), area = vertex_areas(m.s);
    std::vector<double> free(m.n_components, 0), offset(m.n_components, 0);
    for (int v = 0; v < m.n(); ++v)
      if (!m.held[v]) free[component[v]] += area[v];
    bool off = false;
    for (int k = 0; k < m.n_components; ++k) {
      off |= std::abs(volume[k] - now[k]) > volume_tolerance * measure[k];
      if (free[k] > 0) offset[k] = (volume[k] - now[k]) / free[k];
    }
    if (!off) return;
    const std::vector<Vec3> normal = normals_of(m);
    for_vertices(m, [&](int v) { place(m, v, m.s.points[v] + offset[component[v]] * normal[v]); });
  }
}

/// Restores the volumes and separates what intersects, in turn. Returns the number of vertices moved back.
int finish(Motion& m, const std::vector<double>& volume, const std::vector<double>& measure) {
  int all = 0;
  for (int i = 0; i < most_repairs; ++i) {
    keep_volumes(m, volume, measure);
    const int back = separate(m.s, m.start, m.held);
    all += back;
    if (back == 0) break;
  }
  return all;
}

double mean_angle(const Connectivity& c) {
  std::vector<std::pair<int, int>> adjacent;
  for (int h = 0; h < c.n_half_edges(); ++h)
    if (h < c.opposite[h]) adjacent.push_back({h / 3, c.opposite[h] / 3});
  return mean_angle(c.mesh, adjacent);
}

std::vector<double> edge_lengths(const Mesh& mesh) {
  std::vector<double> lengths;
  for (int h = 0; h < 3 * (int)mesh.tris.size(); ++h) lengths.push_back(edge_length(mesh, h));
  return lengths;
}

/// Throws: GoalMissed if the bound leaves almost nothing of what smoothing does without one, if that is much.
void refuse_small_bound(Motion& m, const SmoothReport& r, double edge) {
  if (m.within >= edge || r.angle_after <= (1 - least_gain) * r.angle_before) return;
  const std::vector<Vec3> done = m.s.points;
  m.s.points = m.start;
  m.within = edge;
  smooth_rounds(m, steps[0]);
  const double gain = r.angle_before - mean_angle(m.c);
  if (gain < least_gain * r.angle_before || r.angle_before - r.angle_after >= least_gain * gain) {
    m.s.points = done;
    return;
  }
  std::vector<double> way(m.n());
  for (int v = 0; v < m.n(); ++v) way[v] = norm(m.s.points[v] - m.start[v]);
  const int most = (int)(std::max_element(way.begin(), way.end()) - way.begin());
  const double longest = way[most];
  std::nth_element(way.begin(), way.begin() + m.n() / 2, way.end());
  throw GoalMissed("a bound of " + shown(r.within) +
                   " is too small to smooth: angles between triangles fall from " + shown(r.angle_before) +
                   " to " + shown(r.angle_after) + " degrees, and without it to " +
                   shown(r.angle_before - gain) + "; half the vertices move by more than " +
                   shown(way[m.n() / 2]) + " then, that at " + shown(m.start[most].x) + ' ' +
                   shown(m.start[most].y) + ' ' + shown(m.start[most].z) + " by " + shown(longest));
}

}  // namespace

SmoothReport smooth(Surface& surface, const SmoothOptions& options) {
  if (surface.tris.empty()) throw NotAdmissible("the surface has no triangles");
  const std::vector<int> opposite = opposite_halfedges(surface);
  const auto model = model_of(surface);
  const Connectivity c{surface, opposite, model};
  const double edge = default_bound(edge_lengths(surface));
  if (!(edge > 0)) throw NotAdmissible("the surface has no area");
  SmoothReport r;
  r.within = options.within > 0 ? options.within : edge;
  Motion m(surface, c, r.within);
  m.n_components = components(opposite, m.component);
  find_borders(m, options.keep_features, r);
  const std::vector<double> volume = volumes_of(m), measure = measures_of(m, volume, edge);
  r.angle_before = mean_angle(c);

  const std::vector<char> held = m.held;
  r.angle_after = infinity;
  for (std::size_t i = 0; i < std::size(steps) && !(r.angle_after < r.angle_before); ++i) {
    surface.points = m.start;
    m.held = held;
    smooth_rounds(m, steps[i]);
    r.moved_back = finish(m, volume, measure);
    r.angle_after = mean_angle(c);
  }
  if (!(r.angle_after < r.angle_before)) {
    surface.points = m.start;
    r.angle_after = r.angle_before;
    r.moved_back = 0;
  }
  const std::vector<double> now = volumes_of(m);
  for (int k = 0; k < m.n_components; ++k) {
    r.volume += volume[k];
    r.volume_change += now[k] - volume[k];
    if (const double change = (now[k] - volume[k]) / measure[k]; std::abs(change) > most_volume_change)
      throw GoalMissed("the volume of a component changes by " + shown(100 * change) + " %, but at most " +
                       shown(100 * most_volume_change) + " % are allowed; give a larger bound than " +
                       shown(r.within));
  }
  for (int v = 0; v < m.n(); ++v) {
    const double way = norm(surface.points[v] - m.start[v]);
    r.bounded += way > 0.999 * r.within;
    if (way > r.farthest) r.farthest = way, r.farthest_at = m.start[v];
  }
  refuse_small_bound(m, r, edge);
  return r;
}

std::vector<std::string> describe(const SmoothReport& r) {
  auto count = [](int n, const char* one, const char* many) {
    return std::to_string(n) + ' ' + (n == 1 ? one : many);
  };
  if (r.farthest == 0)
    return {"nothing moved: smoothing would not lower the angles between triangles, " +
            shown(r.angle_before) + " degrees"};
  std::vector<std::string> lines;
  lines.push_back("angle between adjacent triangles " + shown(r.angle_before) + " -> " +
                  shown(r.angle_after) + " degrees; moved by at most " + shown(r.farthest) + ", at " +
                  shown(r.farthest_at));
  lines.push_back("volume " + shown(r.volume) + ", changed by " +
                  shown(r.volume != 0 ? 100 * r.volume_change / r.volume : 0) + " %");
  if (r.region_change > 0)
    lines.push_back("the volume of a region changes by at most " + shown(100 * r.region_change) + " %");
  if (r.bounded)
    lines.push_back(count(r.bounded, "vertex is", "vertices are") + " held back by the bound of " +
                    shown(r.within));
  if (r.moved_back)
    lines.push_back(count(r.moved_back, "vertex", "vertices") +
                    " moved back where triangles would intersect");
  if (r.kept_ends)
    lines.push_back(count(r.kept_ends, "border is", "borders are") + " not moved, far from planar");
  return lines;
}

}  // namespace meshpipe
