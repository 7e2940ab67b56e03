// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/bvh.h"
#include "lib/relax/junctions.h"
#include "lib/relax/repair.h"

namespace meshpipe {
namespace {

/// For each triangle of the reference one of the mesh that should be near: of a vertex on it or around it.
std::vector<int> first_guesses(const State& s) {
  const Mesh& surface = s.reference->surface;
  std::vector<int> at(surface.points.size(), -1), guess(surface.tris.size(), -1);
  for (int v = 0; v < (int)s.mesh.out.size(); ++v)
    if (s.mesh.out[v] >= 0) guess[s.place[v].face] = s.mesh.out[v] / 3;
  for (int round = 0; round < rules::guess_rounds; ++round)
    for (std::size_t t = 0; t < guess.size(); ++t) {
      for (int v : surface.tris[t])
        if (guess[t] < 0) guess[t] = at[v];
      for (int v : surface.tris[t])
        if (at[v] < 0) at[v] = guess[t];
    }
  return guess;
}

/// Measures the samples that are not known to be within `enough`, from where `distance` is infinite.
void measure(const State& s, Samples& samples, std::vector<double>& distance, double enough) {
  const int n = (int)distance.size(), now = s.clocks.now;
  constexpr int chunk = 256, worth_threads = 10000;
  std::vector<Sample>& list = samples.list;
  std::vector<int> guess;
  if (list.front().near < 0) guess = first_guesses(s);
#pragma omp parallel for schedule(dynamic) if (n > worth_threads)
  for (int first = 0; first < n; first += chunk)
    for (int i = first; i < std::min(n, first + chunk); ++i) {
      if (distance[i] <= enough) continue;
      Sample& x = list[i];
      // most are as they were, or still near to the same triangle, or to that of the sample before
      if (x.near < 0 && !guess.empty()) x.near = guess[x.place.face];
      const bool lost = x.near < 0 || s.mesh.dead(x.near);
      if (lost && i > first &&
          s.reference->component_of(x.place) == s.reference->component_of(list[i - 1].place))
        x.near = list[i - 1].near;
      if (x.near < 0 || s.mesh.dead(x.near)) continue;
      if (lost || !(x.distance <= enough) || changed_since(s, x.near, x.time)) {
        x.distance =
            walk_to(s.reference->walk.point(x.place), s.points, s.mesh.tris, s.mesh.opp, x.near, enough);
        x.time = now;
      }
      distance[i] = x.distance;
    }
  std::vector<int> far;
  for (int i = 0; i < n; ++i)
    if (!(distance[i] <= enough)) far.push_back(i);
  if (far.empty()) return;
  samples.search.renew(s);
#pragma omp parallel for schedule(dynamic, chunk) if (far.size() > chunk)
  for (int i : far) {
    Sample& x = list[i];
    const Bvh::Hit hit = samples.search.nearest(s.reference->walk.point(x.place),
                                                s.reference->component_of(x.place), distance[i], enough);
    x.near = hit.place.face;
    x.time = now;
    distance[i] = x.distance = hit.distance;
  }
}

/// The samples farther from the mesh than `wanted`, which is set, and at least `least` times its size; the
/// farthest first, with distances, negative.
std::vector<std::pair<double, int>> farthest_samples(const State& s, Samples& samples, double least,
                                                     double& wanted) {
  const double h = mean_size(s);
  const int n = (int)samples.list.size();
  std::vector<double> distance(n, 1e300);
  // only the farthest are wanted: the others need not be known any better
  for (double enough = 0.5 * h;; enough = std::max(least * h, 0.5 * enough)) {
    measure(s, samples, distance, enough);
    const double most = *std::max_element(distance.begin(), distance.end());
    wanted = std::max(least * h, rules::farthest_share * most);
    if (!(enough > wanted)) break;
  }
  std::vector<std::pair<double, int>> farthest;
  for (int i = 0; i < n; ++i) {
    if (distance[i] <= wanted) continue;
    // where the size is larger than elsewhere, so is the distance that it stands for
    const double here = s.target(s.mesh.tris[samples.list[i].near][0]) / h;
    if (distance[i] > wanted * (here > rules::larger_size ? here : 1)) farthest.push_back({-distance[i], i});
  }
  std::sort(farthest.begin(), farthest.end());
  return farthest;
}

/// The neighborhood of the first triangle with a vertex of that at `place`, or a new one on one of its edges,
/// whichever leaves the better mesh when all around it has settled. None if the place cannot be walked to,
/// would spoil the mesh (`lost`: much), or if then the mesh would be farther from the reference than `least`.
std::optional<State> reached_at(const State& s, const Place& place, double least, bool lost,
                                const std::vector<int>& triangles) {
  const int t = triangles.front();
  const double size = s.target(s.mesh.tris[t][0]);
  const double farther = std::clamp(least / (rules::missed * size), 1.0, rules::spoils_farther);
  const double spoils =
      lost && least > rules::too_far * size ? rules::spoils_if_lost : rules::spoils * std::pow(farther, 1.5);
  const SurfaceWalk& walk = s.reference->walk;
  const Vec3 p = walk.point(place);
  // a vertex on a line may know the other side of it
  const std::vector<int>* patches = s.reference->patches;
  const bool same_side = dot(walk.normal(place), s.face_normal(t)) > rules::same_side &&
                         (!patches || s.labels.patch.empty() || (*patches)[place.face] == s.labels.patch[t]);
  if (has_double_edge(s.mesh, triangles)) return {};
  const State before = extract(s, triangles);
  const double near_enough = std::max(deviation(before), least / size);
  const double bearable = objective(before) + spoils;
  std::vector<Trial> trials;
  // by a vertex of the triangle nearest to it, then by a new one on an edge of that
  for (int i = 0; i < 6; ++i) {
    const int h = i % 3, from = s.mesh.tris[t][h], to = s.mesh.tris[t][(h + 1) % 3];
    const bool insert = i >= 3, hard = before.mesh.hard[h],
               seam = s.hold[from] >= frozen && s.hold[to] >= frozen;  // or the rim of a tile
    const bool stays = !insert ? s.hold[from] != loose && s.hold[from] != slides
                               : hard && (seam || (before.mesh.opp[h] >= 0 && end_on_line(s, from, to) < 0));
    const bool on_line = insert ? hard : s.hold[from] == slides;
    const bool reached = reaches(s, from, p, on_line) || (insert && hard && reaches(s, to, p, true));
    if (insert && !hard && s.hold[from] != loose && !same_side) continue;
    if (stays || !reached) continue;
    State& after = trials.emplace_back(Trial{0, before}).state;
    const int v = insert ? (int)after.mesh.out.size() : after.mesh.from(h);
    const std::vector<CopyPlace> places =
        insert ? places_on_edge(after, h, place, p) : copies_at(after, v, place, p);
    if (places.empty()) {
      trials.pop_back();
      continue;
    }
    if (insert) insert_copies(after, places, p);
    if (!insert)
      for (const CopyPlace& c : places) put(after, c.at, c.place, p, c.normal);
    for_copies(after, v, [&](int c) { after.hold[c] = on_line ? fixed : anchored; });
    after.schedule.listed = false;
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
std::optional<State> reached(const State& s, const Place& sample, double wanted, bool lost,
                             const std::vector<int>& triangles) {
  const SurfaceWalk& walk = s.reference->walk;
  const Vec3 p = walk.point(sample), q = nearest_point(s, triangles.front(), p);
  const double least = norm(q - p);
  if (auto state = reached_at(s, sample, least, lost, triangles)) return state;
  if (least < rules::retry * wanted) return {};
  const Vec3 half = lerp(q, p, 0.5);
  const Place along = walk.slide(sample, half);  // stays if the sample is on no border
  const bool moved = norm(walk.point(along) - p) > rules::along_border * least;
  return reached_at(s, moved ? along : walk.closest(sample, half), least, lost, triangles);
}

}  // namespace

void Samples::go_back(std::vector<Sample> earlier) {
  auto is_inside = [](const Sample& x) { return std::min({x.place.b0, x.place.b1, x.place.b2}) > 0; };
  std::vector<int> faces;  // with a place inside
  for (const Sample& x : earlier)
    if (is_inside(x)) faces.push_back(x.place.face);
  sort_unique(faces);
  std::swap(list, earlier);
  for (Sample& x : earlier)
    if (is_inside(x) && !std::binary_search(faces.begin(), faces.end(), x.place.face)) {
      x.near = x.time = -1;
      list.push_back(x);
    }
  search.forget();
}

std::vector<Sample> feature_samples(const Reference& reference, double h) {
  const Surface& surface = reference.surface;
  const std::vector<Vec3>& p = surface.points;
  std::vector<Sample> samples(p.size());
  const int n = 3 * (int)surface.tris.size();
  for (int e = 0; e < n; ++e)
    samples[origin(surface.tris, e)] = {{e / 3, 1.0 * (e % 3 == 0), 1.0 * (e % 3 == 1), 1.0 * (e % 3 == 2)}};
  std::erase_if(samples, [](const Sample& s) { return s.place.face < 0; });  // of no triangle
  constexpr int chunk = 1 << 14;
  std::vector<std::vector<Sample>> inside((n + chunk - 1) / chunk);  // of edges
  parallel_for((int)inside.size(), [&](int c) {
    for (int e = c * chunk; e < std::min(n, (c + 1) * chunk); ++e) {
      const int a = origin(surface.tris, e), b = target(surface.tris, e), i = e % 3;
      const double length = norm(p[b] - p[a]) / h;
      if (a > b || rules::samples_per_edge * length <= 1) continue;
      const Vec3 area = area_vector(surface, e / 3);
      // triangles of this height per size, where edges are long: a bend spread over them counts as one
      const double across = rules::samples_per_flat_edge * length > 1 ? length * h * h / norm(area) : 1;
      auto bends_at = [&](int w) {
        return !(angle(area, reference.normals[w]) * std::max(1.0, across) < rules::bent);
      };
      const double rate = bends_at(a) || bends_at(b) ? rules::samples_per_edge : rules::samples_per_flat_edge;
      const int pieces = (int)std::min(rules::most_samples, std::ceil(rate * length));
      for (int k = 1; k < pieces; ++k) {
        double at[3] = {0, 0, 0};
        at[(i + 1) % 3] = (double)k / pieces, at[i] = 1 - at[(i + 1) % 3];
        inside[c].push_back({{e / 3, at[0], at[1], at[2]}});
      }
    }
  });
  for (const auto& list : inside) samples.insert(samples.end(), list.begin(), list.end());
  return samples;
}

std::vector<double> sample_distances(const State& s, Samples& samples, double enough) {
  std::vector<double> distance(samples.list.size(), 1e300);
  if (!distance.empty()) measure(s, samples, distance, enough);
  return distance;
}

bool reach_features(State& s, Samples& samples, double least, int most) {
  if (s.mesh.live == 0 || samples.list.empty()) return false;
  double wanted = 0;
  std::vector<int> guess;
  auto farthest = farthest_samples(s, samples, least, wanted);
  if (const std::size_t looked_at = (std::size_t)rules::places_per_feature * most;
      farthest.size() > looked_at) {
    std::vector<char> seen(s.mesh.tris.size());  // one place per triangle, so that no long edge takes all
    std::erase_if(farthest,
                  [&](const auto& f) { return std::exchange(seen[samples.list[f.second].near], 1); });
    farthest.resize(std::min(farthest.size(), looked_at));
  }
  using Item = std::pair<double, int>;
  auto around = [&](const Item& item, std::vector<int> before) -> std::vector<int> {
    if (!before.empty()) return before;
    const Sample& sample = samples.list[item.second];
    const Vec3 p = s.reference->walk.point(sample.place);
    int t = sample.near;
    if (s.mesh.dead(t) || walk_to(p, s.points, s.mesh.tris, s.mesh.opp, t, wanted) <= wanted) return {};
    auto leads_to_it = [&](int near) {
      const Tri& v = s.mesh.tris[near];
      return std::any_of(v.begin(), v.end(), [&](int i) { return reaches(s, i, p, false); });
    };
    // the nearest triangle may be of another sheet
    for (bool own_sheet : {false, true}) {
      if (own_sheet && guess.empty()) guess = first_guesses(s);
      const int from = own_sheet ? guess[sample.place.face] : sample.near;
      if (from < 0 || s.mesh.dead(from)) return {};
      double least = 1e300;
      for (int near : triangles_around(s, from, rules::rings))
        if (const double d = norm(nearest_point(s, near, p) - p);
            d < least && (!own_sheet || leads_to_it(near)))
          least = d, t = near;
      if (least <= wanted) return {};
      if (least < 1e300 && leads_to_it(t)) return triangles_around(s, t, rules::rings);
    }
    return {};
  };
  auto attempt = [&](const Item& item, const std::vector<int>& patch) {
    return reached(s, samples.list[item.second].place, wanted, least >= rules::too_far, patch);
  };
  return change_neighborhoods(s, farthest, most, rules::tries_per_feature * most, around, attempt,
                              [](const std::vector<int>&) {}) > 0;
}

}  // namespace meshpipe
