// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/bvh.h"
#include "lib/core/triangle_count.h"
#include "lib/relax/repair.h"

namespace meshpipe {
namespace {

/// The distance of p from the triangle that a walk from t, which becomes that, ends at: the nearest, as far
/// as a walk can tell, or the first that is within `enough`.
double walk_near(const State& s, Vec3 p, int& t, double enough) {
  double least = 1e300;
  for (int at = t;;) {
    const auto [a, b, c] = s.mesh.tris[at];
    const Vec3 x = s.points[a], y = s.points[b], z = s.points[c];
    const auto w = closest_on_triangle(p, x, y, z);
    const double d = norm(w[0] * x + w[1] * y + w[2] * z - p);
    if (!(d < least)) return least;
    least = d, t = at;
    const int i = w[0] <= 0 ? 1 : w[1] <= 0 ? 2 : 0;  // the edge opposite to a corner without weight
    if (d <= enough || w[(i + 2) % 3] > 0 || s.mesh.opp[3 * at + i] < 0) return least;
    at = s.mesh.opp[3 * at + i] / 3;
  }
}

/// The point of triangle t nearest to p.
Vec3 nearest_point(const State& s, int t, Vec3 p) {
  const Tri& v = s.mesh.tris[t];
  const auto b = closest_on_triangle(p, s.points[v[0]], s.points[v[1]], s.points[v[2]]);
  return b[0] * s.points[v[0]] + b[1] * s.points[v[1]] + b[2] * s.points[v[2]];
}

/// Measures the samples that are not known to be within `enough`, from where `distance` is infinite.
void measure(const State& s, const Bvh& tree, const std::vector<int>& number, std::vector<Sample>& samples,
             std::vector<double>& distance, double enough) {
  const int n = (int)samples.size();
  constexpr int chunk = 256;
#pragma omp parallel for schedule(dynamic) if (n > 10000)
  for (int first = 0; first < n; first += chunk)
    for (int i = first; i < std::min(n, first + chunk); ++i) {
      if (distance[i] <= enough) continue;
      Sample& sample = samples[i];
      const Vec3 p = s.reference->walk.point(sample.place);
      // most are still near to the triangle that they were near to, or to that of the sample before
      if ((sample.near < 0 || s.mesh.dead(sample.near)) && i > first) sample.near = samples[i - 1].near;
      if (sample.near >= 0 && !s.mesh.dead(sample.near)) {
        distance[i] = walk_near(s, p, sample.near, enough);
        if (distance[i] <= enough) continue;
      }
      const Bvh::Hit hit = tree.nearest(p, distance[i], enough);
      sample.near = number[hit.place.face];
      distance[i] = hit.distance;
    }
}

/// The samples farther from the mesh than `wanted`, which is set, and at least `least` times its size; the
/// farthest first, with distances, negative.
std::vector<std::pair<double, int>> farthest_samples(const State& s, std::vector<Sample>& samples,
                                                     double least, double& wanted) {
  std::vector<int> number;
  const Mesh mesh = without_gaps(s, number);
  const Bvh tree(mesh);
  const double h = size_for_count(total_area(mesh), mesh.tris.size());
  const int n = (int)samples.size();
  std::vector<double> distance(n, 1e300);
  // only the farthest are wanted: the others need not be known any better
  for (double enough = 0.5 * h;; enough = std::max(least * h, 0.5 * enough)) {
    measure(s, tree, number, samples, distance, enough);
    const double most = *std::max_element(distance.begin(), distance.end());
    wanted = std::max(least * h, rules::farthest_share * most);
    if (!(enough > wanted)) break;
  }
  std::vector<std::pair<double, int>> farthest;
  for (int i = 0; i < n; ++i) {
    if (distance[i] <= wanted) continue;
    // where the size is larger than elsewhere, so is the distance that it stands for
    const double here = s.target(s.mesh.tris[samples[i].near][0]) / h;
    if (distance[i] > wanted * (here > rules::larger_size ? here : 1)) farthest.push_back({-distance[i], i});
  }
  std::sort(farthest.begin(), farthest.end());
  return farthest;
}

/// The neighborhood of the first triangle with a vertex of that at `place`, or a new one on one of its edges,
/// whichever leaves the better mesh when all around it has settled. None if the place cannot be walked to,
/// would spoil the mesh, or if then the mesh would be farther from the reference than `least`.
std::optional<State> reached_at(const State& s, const Place& place, double least,
                                const std::vector<int>& triangles) {
  const int t = triangles.front();
  const double size = s.target(s.mesh.tris[t][0]);
  const double spoils =
      rules::spoils * std::pow(std::clamp(least / (rules::missed * size), 1.0, rules::spoils_farther), 1.5);
  const SurfaceWalk& walk = s.reference->walk;
  const Vec3 p = walk.point(place);
  auto reaches = [&](int v, bool on_line) {
    const Place to = on_line ? walk.slide(s.place[v], p) : walk.closest(s.place[v], p);
    return norm(walk.point(to) - p) < rules::reached * s.target(v);
  };
  if (has_double_edge(s.mesh, triangles)) return {};
  const State before = extract(s, triangles);
  const double near_enough = std::max(deviation(before), least / size);
  const double bearable = objective(before) + spoils;
  std::vector<Trial> trials;
  // by a vertex of the triangle nearest to it, then by a new one on an edge of that
  for (int i = 0; i < 6; ++i) {
    const int h = i % 3, from = s.mesh.tris[t][h], to = s.mesh.tris[t][(h + 1) % 3];
    const bool insert = i >= 3, hard = before.mesh.hard[h],
               seam = s.hold[from] == paired && s.hold[to] == paired;
    const bool stays = !insert ? s.hold[from] != loose && s.hold[from] != slides
                               : hard && (seam || (before.mesh.opp[h] >= 0 && end_on_line(s, from, to) < 0));
    const bool on_line = insert ? hard : s.hold[from] == slides;
    if (stays || !(reaches(from, on_line) || (insert && hard && reaches(to, true)))) continue;
    State& after = trials.emplace_back(Trial{0, before}).state;
    const int v = insert ? (int)after.mesh.out.size() : after.mesh.from(h);
    if (insert) insert_vertex(after, h, place, p, {});
    put(after, v, place, p, on_line && !after.mesh.on_border(v) ? Vec3{} : s.reference->normal(place));
    after.hold[v] = on_line ? fixed : anchored;
    after.coloring.listed = false;
    settle(after, 1);
  }
  keep_best(trials, rules::promising_features);
  for (Trial& trial : trials) settle(trial.state, 1);
  keep_best(trials, rules::promising_features);
  for (Trial& trial : trials)
    if (trial.objective < bearable && deviation(trial.state) <= near_enough) return std::move(trial.state);
  return {};
}

/// The same for a sample; one of the farthest that would spoil the mesh is gone half way to.
std::optional<State> reached(const State& s, const Place& sample, double wanted,
                             const std::vector<int>& triangles) {
  const SurfaceWalk& walk = s.reference->walk;
  const Vec3 p = walk.point(sample), q = nearest_point(s, triangles.front(), p);
  const double least = norm(q - p);
  if (auto state = reached_at(s, sample, least, triangles)) return state;
  if (least < rules::retry * wanted) return {};
  const Vec3 half = lerp(q, p, 0.5);
  const Place along = walk.slide(sample, half);  // stays if the sample is on no border
  const bool moved = norm(walk.point(along) - p) > rules::along_border * least;
  return reached_at(s, moved ? along : walk.closest(sample, half), least, triangles);
}

}  // namespace

std::vector<Sample> feature_samples(const Reference& reference, double h) {
  const Surface& surface = reference.surface;
  const std::vector<Vec3>& p = surface.points;
  std::vector<Sample> samples(p.size());
  for (int t = 0; t < (int)surface.tris.size(); ++t)
    for (int i = 0; i < 3; ++i)
      samples[surface.tris[t][i]] = {{t, i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0}};
  std::erase_if(samples, [](const Sample& s) { return s.place.face < 0; });  // of no triangle
  for (int t = 0; t < (int)surface.tris.size(); ++t) {
    const Tri& v = surface.tris[t];
    const Vec3 n = normalized(area_vector(p[v[0]], p[v[1]], p[v[2]]));
    auto bends_at = [&](int w) { return !(dot(n, normalized(reference.normals[w])) > rules::bent); };
    for (int i = 0; i < 3; ++i) {
      const int a = v[i], b = v[(i + 1) % 3];
      const int pieces =
          (int)std::min(rules::most_samples, std::ceil(rules::samples_per_edge * norm(p[b] - p[a]) / h));
      if (a > b || pieces < 2 || !(bends_at(a) || bends_at(b))) continue;
      for (int k = 1; k < pieces; ++k) {
        double at[3] = {0, 0, 0};
        at[(i + 1) % 3] = (double)k / pieces, at[i] = 1 - at[(i + 1) % 3];
        samples.push_back({{t, at[0], at[1], at[2]}});
      }
    }
  }
  samples.shrink_to_fit();
  return samples;
}

std::vector<double> sample_distances(const State& s, std::vector<Sample>& samples, double enough) {
  std::vector<int> number;
  const Mesh mesh = without_gaps(s, number);
  std::vector<double> distance(samples.size(), 1e300);
  measure(s, Bvh(mesh), number, samples, distance, enough);
  return distance;
}

bool reach_features(State& s, std::vector<Sample>& samples, double least, int most) {
  if (s.mesh.live == 0 || samples.empty()) return false;
  double wanted = 0;
  const auto farthest = farthest_samples(s, samples, least, wanted);
  using Item = std::pair<double, int>;
  auto around = [&](const Item& item, std::vector<int> before) -> std::vector<int> {
    if (!before.empty()) return before;
    const Sample& sample = samples[item.second];
    const Vec3 p = s.reference->walk.point(sample.place);
    int t = sample.near;
    if (s.mesh.dead(t) || walk_near(s, p, t, wanted) <= wanted) return {};
    t = sample.near;
    double least = 1e300;
    for (int near : triangles_around(s.mesh, sample.near, rules::rings))
      if (const double d = norm(nearest_point(s, near, p) - p); d < least) least = d, t = near;
    if (least <= wanted) return {};
    return triangles_around(s.mesh, t, rules::rings);
  };
  auto attempt = [&](const Item& item, const std::vector<int>& patch) {
    return reached(s, samples[item.second].place, wanted, patch);
  };
  return change_neighborhoods(s, farthest, most, rules::tries_per_feature * most, around, attempt,
                              [](const std::vector<int>&) {}) > 0;
}

}  // namespace meshpipe
