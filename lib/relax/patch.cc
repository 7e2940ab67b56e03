// SPDX-License-Identifier: BSD-3-Clause
#include "lib/relax/patch.h"

#include <mutex>
#include <numbers>
#include <queue>

#include "lib/core/bvh.h"
#include "lib/core/take_rows.h"
#include "lib/relax/junctions.h"

namespace meshpipe {
namespace {

/// The vertices of triangles, ascending: in this order a patch numbers them.
std::vector<int> vertices_of(const EditMesh& mesh, const std::vector<int>& triangles) {
  std::vector<int> vertices;
  for (int t : triangles) vertices.insert(vertices.end(), mesh.tris[t].begin(), mesh.tris[t].end());
  sort_unique(vertices);
  return vertices;
}

/// Is v inside, so that it or its neighbors may change?
bool loosely_held(const State& s, int v) { return s.hold[v] == loose || s.hold[v] == anchored; }

/// May triangles at v be expected to be acute? Between lines inside the surface often is no room for that.
bool may_be_acute(const State& s, int v) {
  return loosely_held(s, v) || (s.acute && s.hold[v] != frozen && s.mesh.on_border(v));
}

}  // namespace

double quality(const State& s, int t) {
  const auto [a, b, c] = s.mesh.tris[t];
  const Vec3 p = s.points[a], q = s.points[b], r = s.points[c];
  if (s.cosine(a, b, c) < 0 && !faces_reference(s, s.place[a], p, q, r)) return 0;
  double side[3] = {dot(q - p, q - p), dot(r - q, r - q), dot(p - r, p - r)};  // squared, ascending:
  std::sort(side, side + 3);
  // twice the area, and what times its half is the cosine of the angle between two sides
  const double area = norm(area_vector(p, q, r)), least = side[1] + side[2] - side[0],
               largest = side[0] + side[1] - side[2];
  double good = kappa(p, q, r) / rules::good_kappa;
  // angles that are good with a margin need not be known
  if (2 * area <= rules::tangent_with_margin * least)
    good = std::min(good, std::atan2(2 * area, least) / rules::good_angle);
  const bool acute = may_be_acute(s, a) && may_be_acute(s, b) && may_be_acute(s, c);
  if (acute && largest <= rules::cotangent_with_margin * 2 * area)
    good = std::min(
        good, (std::numbers::pi - std::atan2(2 * area, largest)) / (std::numbers::pi - rules::acute_angle));
  return good;
}

Vec3 nearest_point(const State& s, int t, Vec3 p) {
  const Tri& v = s.mesh.tris[t];
  const auto b = closest_on_triangle(p, s.points[v[0]], s.points[v[1]], s.points[v[2]]);
  return b[0] * s.points[v[0]] + b[1] * s.points[v[1]] + b[2] * s.points[v[2]];
}

int irregularity(const State& s, int v) {
  return s.mesh.out[v] >= 0 && loosely_held(s, v) ? std::max(0, std::abs(excess(s, v)) - 1) : 0;
}

double objective(const State& s) {
  double sum = 0;
  for (int v = 0; v < (int)s.mesh.out.size(); ++v) sum += rules::irregular_vertex * irregularity(s, v);
  for (int t = 0; t < (int)s.mesh.tris.size(); ++t) {
    if (s.mesh.dead(t)) continue;
    const double q = quality(s, t), lack = std::max(0.0, rules::margin - q);
    sum += lack * lack * lack / (q + rules::needle);
  }
  return sum;
}

int worst(const State& s) {
  std::pair<double, int> least{1e300, -1};
  for (int t = 0; t < (int)s.mesh.tris.size(); ++t)
    if (!s.mesh.dead(t)) least = std::min(least, {quality(s, t), t});
  return least.second;
}

double deviation(const State& s, int t) {
  const EditMesh& m = s.mesh;
  const SurfaceWalk& walk = s.reference->walk;
  double most = 0;
  // from each corner, whose sheet may end before the nearest place; one on a model edge knows but one side
  auto look = [&](std::initializer_list<int> corners, Vec3 p) {
    double least = 1e300;
    for (int v : corners)
      least = std::min(least, norm(walk.point(walk.closest(s.place[v], p, true)) - p) / s.target(v));
    most = std::max(most, least);
  };
  const auto [a, b, c] = m.tris[t];
  look({a, b, c}, (1.0 / 3) * (s.points[a] + s.points[b] + s.points[c]));
  for (int h = 3 * t; h < 3 * t + 3; ++h)
    if (m.opp[h] < h) look({m.from(h), m.to(h)}, 0.5 * (s.points[m.from(h)] + s.points[m.to(h)]));
  return most;
}

double deviation(const State& s) {
  double most = 0;
  for (int t = 0; t < (int)s.mesh.tris.size(); ++t)
    if (!s.mesh.dead(t)) most = std::max(most, deviation(s, t));
  return most;
}

std::vector<int> triangles_around(const State& s, int t, int rings) {
  std::vector<int> found{t}, sorted{t};
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<int> more;
    for (int v : vertices_of(s.mesh, found))
      for_copies(s, v, [&](int c) {
        s.mesh.star(c, [&](int h) {
          if (!std::binary_search(sorted.begin(), sorted.end(), h / 3)) more.push_back(h / 3);
        });
      });
    sort_unique(more);
    found.insert(found.end(), more.begin(), more.end());
    sorted = found;
    std::sort(sorted.begin(), sorted.end());
  }
  return found;
}

bool has_double_edge(const EditMesh& mesh, const std::vector<int>& triangles) {
  std::vector<std::pair<int, int>> edges;
  for (int t : triangles)
    for (int h = 3 * t; h < 3 * t + 3; ++h) edges.push_back({mesh.from(h), mesh.to(h)});
  std::sort(edges.begin(), edges.end());
  return std::adjacent_find(edges.begin(), edges.end()) != edges.end();
}

State extract(const State& s, const std::vector<int>& triangles) {
  const std::vector<int> vertices = vertices_of(s.mesh, triangles);
  auto local = [&](int v) {
    return (int)(std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin());
  };
  std::vector<Tri> tris;
  std::vector<std::uint8_t> model;
  for (int t : triangles) {
    const Tri& v = s.mesh.tris[t];
    const std::uint8_t* hard = &s.mesh.hard[3 * t];
    tris.push_back({local(v[0]), local(v[1]), local(v[2])});
    model.push_back(hard[0] | hard[1] << 1 | hard[2] << 2);
  }
  auto pick = [&](const auto& column) { return rearranged(column, vertices); };
  const int n = (int)vertices.size();
  State patch(*s.reference, EditMesh(std::move(tris), n, model), pick(s.points), pick(s.place), pick(s.size));
  patch.normal = pick(s.normal), patch.refinement = pick(s.refinement), patch.hold = pick(s.hold);
  patch.keep_border = s.keep_border, patch.acute = s.acute;
  patch.recording = true;
  for (int h = 0; h < (int)patch.mesh.opp.size(); ++h)
    if (patch.mesh.opp[h] < 0 && s.mesh.opp[3 * triangles[h / 3] + h % 3] >= 0)
      patch.hold[patch.mesh.from(h)] = patch.hold[patch.mesh.to(h)] = frozen;
  if (!s.copy.empty()) extract_copies(s, triangles, vertices, patch);
  return patch;
}

void settle(State& s, int times) {
  for (int i = 0; i < times; ++i) {
    flip_to_shape(s);
    smooth(s, rules::sweeps_to_settle);
  }
}

void rest(State& s) {
  s.clocks.flipped = ++s.clocks.now;
  s.clocks.tried.assign(s.clocks.tried.size(), s.clocks.now);
}

void adopt(State& s, const State& patch, std::vector<int> triangles) {
  std::vector<int> vertices = vertices_of(s.mesh, triangles);
  for (const Edit& e : patch.edits) {
    const int h = 3 * triangles[e.h / 3] + e.h % 3;
    if (e.kind == Edit::flip) {
      flip_edge(s, h);
    } else if (e.kind == Edit::split) {
      const int v = (int)vertices.size();
      for (int i = 0; i < (s.mesh.opp[h] < 0 ? 1 : 2); ++i) triangles.push_back((int)s.mesh.tris.size() + i);
      vertices.push_back((int)s.mesh.out.size());
      insert_vertex(s, h, patch.place[v], patch.points[v], patch.normal[v]);
    } else {
      remove_vertex(s, h, vertices[e.end]);
    }
  }
  for (int i = 0; i < (int)vertices.size(); ++i) {
    const int v = vertices[i];
    const Hold held = patch.hold[i];
    if (patch.mesh.out[i] < 0 || held == frozen || (held == fixed && s.hold[v] == fixed)) continue;
    s.hold[v] = held;
    if (!s.copy.empty()) s.copy[v] = vertices[patch.copy[i]];
    put(s, v, patch.place[i], patch.points[i], patch.normal[i]);
    mark_changed(s, v);
  }
  s.schedule.listed = false;
}

void keep_best(std::vector<Trial>& trials, std::size_t most, const Judge& judge) {
  std::priority_queue<double> least;  // of those judged so far, `most` at most
  std::mutex one_at_a_time;
  parallel_for((int)trials.size(), [&](int i) {
    std::unique_lock lock(one_at_a_time);
    const double bound = least.size() < most ? infinity : least.top();
    lock.unlock();
    trials[i].objective = judge.of(trials[i].state, bound);
    lock.lock();
    least.push(trials[i].objective);
    if (least.size() > most) least.pop();
  });
  std::stable_sort(trials.begin(), trials.end(),
                   [](const Trial& a, const Trial& b) { return a.objective < b.objective; });
  if (trials.size() > most) trials.erase(trials.begin() + (std::ptrdiff_t)most, trials.end());
}

}  // namespace meshpipe
