// SPDX-License-Identifier: BSD-3-Clause
#include "lib/check/patches.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <optional>

#include "lib/core/boxes.h"
#include "lib/core/number.h"
#include "lib/core/topology.h"

namespace meshpipe {
namespace {

/// How far the sides of two boxes are apart at most.
double apart(const Box& a, const Box& b) {
  double most = 0;
  for (const Vec3& d : {a.lo - b.lo, a.hi - b.hi})
    for (double x : {d.x, d.y, d.z}) most = std::max(most, std::abs(x));
  return most;
}

}  // namespace

std::vector<Patch> patches_of(const Surface& surface, const std::vector<int>& opposite,
                              const std::function<std::string(int)>& name) {
  std::vector<Patch> patches;
  if (!surface.face.has("patch")) return patches;
  const std::vector<int>& label = surface.face.get<int>("patch");
  std::vector<int> labels;
  std::unique_copy(label.begin(), label.end(), std::back_inserter(labels));  // few are left to sort
  sort_unique(labels);
  std::map<std::string, int> number;  // in the order of the names
  for (int l : labels) number[name(l)];
  for (auto& [text, i] : number) {
    i = (int)patches.size();
    patches.push_back({text, {}});
  }
  std::vector<int> patch_of_label;
  for (int l : labels) {
    patch_of_label.push_back(number[name(l)]);
    patches[patch_of_label.back()].labels.push_back(l);
  }
  for (int t = 0; t < (int)label.size(); ++t) {
    const auto at = std::lower_bound(labels.begin(), labels.end(), label[t]);
    Patch& p = patches[patch_of_label[at - labels.begin()]];
    p.box = p.triangles++ ? join(p.box, box_of(surface, t)) : box_of(surface, t);
    p.area += triangle_area(surface, t);
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      const double length = edge_length(surface, h);
      p.edge = std::max(p.edge, length);
      if (!opposite.empty() && (opposite[h] < 0 || label[opposite[h] / 3] != label[t])) p.perimeter += length;
    }
  }
  return patches;
}

std::vector<PatchFault> compare_patches(const std::vector<Patch>& reference,
                                        const std::vector<Patch>& result) {
  constexpr double rough = 0.5;  // of the area: steps of voxels have up to sqrt(3) times the smooth one
  std::vector<PatchFault> faults;
  auto by_name = [](const Patch& p, const Patch& q) { return p.name < q.name; };
  for (const Patch& p : reference) {
    const auto q = std::lower_bound(result.begin(), result.end(), p, by_name);
    if (q == result.end() || q->name != p.name) {
      faults.push_back({"patch " + p.name + " is lost"});
      continue;
    }
    if (const double d = apart(p.box, q->box); !(d <= q->edge))
      faults.push_back({"patch " + p.name + " ends " + shown(d) +
                            " from where the reference's does, edges are " + shown(q->edge) + " at most",
                        q->labels});
    else if (!(std::abs(p.area - q->area) <= rough * p.area + 0.5 * q->edge * q->perimeter))
      faults.push_back(
          {"patch " + p.name + " has area " + shown(q->area) + ", the reference's " + shown(p.area),
           q->labels});
  }
  for (const Patch& q : result)
    if (!std::binary_search(reference.begin(), reference.end(), q, by_name))
      faults.push_back({"patch " + q.name + " is not in the reference", q.labels});
  return faults;
}

std::vector<int> unmarked_borders(const Connectivity& surface, const std::vector<int>& patch) {
  std::vector<int> borders;
  for (int h = 0; h < surface.n_half_edges(); ++h) {
    const int g = surface.opposite[h];
    if (g > h && patch[h / 3] != patch[g / 3] && !surface.is_model(h)) borders.push_back(h);
  }
  return borders;
}

namespace {

/// Returns the component of the normal of triangle t along that of the nearest triangle of the reference.
/// Where sheets are back to back, the corners of t say which one it is on: they are nearer to it.
double towards_nearest(const Mesh& mesh, int t, const Mesh& reference, const Bvh& tree) {
  constexpr double around = 0.1, as_near = 1e-3;  // of an edge
  const Vec3 normal = area_vector(mesh, t);
  const double edge = edge_length(mesh, 3 * t);
  const auto hit = tree.nearest(centroid(mesh, t));
  auto along = [&](int u) { return dot(normal, normalized(area_vector(reference, u))); };
  double most = along(hit.place.face);
  const double reach = hit.distance + around * edge, least = most;
  double to[2] = {0, 0};  // sums of the distances from triangles that face as t does, and from others
  for (int v : mesh.tris[t]) {
    if (least >= 0) break;
    const Vec3 p = mesh.points[v], r{reach, reach, reach};
    double nearest[2] = {reach, reach};
    tree.overlapping({p - r, p + r}, [&](int u) {
      const double d = norm(closest_point(reference, u, p) - p);
      nearest[along(u) < 0] = std::min(d, nearest[along(u) < 0]);
      if (d <= reach) most = std::max(most, along(u));
    });
    for (int i : {0, 1}) to[i] += nearest[i];
  }
  return to[0] <= to[1] + as_near * edge ? most : least;
}

}  // namespace

void leave_out_as_labeled(std::vector<int>& reversed, const Connectivity& result, const Surface& labeled,
                          const Surface& reference) {
  constexpr double closed = 1e-3;  // of the area: what is left of the sum of area vectors
  if (reversed.empty() || !labeled.face.has("patch") || !reference.face.has("patch")) return;
  const std::vector<int>* patch[2] = {&labeled.face.get<int>("patch"), &reference.face.get<int>("patch")};
  const Mesh* surface[2] = {&result.mesh, &reference};
  struct Sum {
    Vec3 vector{};
    double area = 0, volume = 0;
  };
  std::vector<int> component;
  std::vector<std::array<Sum, 2>> sums(components(result.opposite, component));
  std::vector<char> shared(sums.size(), 0);  // has a label that another one has, too
  std::map<int, int> of_label;
  for (std::size_t t = 0; t < component.size(); ++t) {
    const auto at = of_label.try_emplace((*patch[0])[t], component[t]).first;
    if (at->second != component[t]) shared[at->second] = shared[component[t]] = 1;
  }
  const Vec3 center = result.mesh.points[result.mesh.tris[0][0]];
  for (int side : {0, 1})
    for (int t = 0; t < (int)surface[side]->tris.size(); ++t) {
      const auto at = of_label.find((*patch[side])[t]);
      if (at == of_label.end()) continue;
      Sum& sum = sums[at->second][side];
      const Vec3 v = area_vector(*surface[side], t);
      sum.vector = sum.vector + v;
      sum.area += norm(v);
      sum.volume += dot(v, surface[side]->points[surface[side]->tris[t][0]] - center);
    }
  std::erase_if(reversed, [&](int t) {
    const auto& [a, b] = sums[component[t]];
    if (shared[component[t]]) return false;
    const bool volumes = norm(a.vector) <= closed * a.area && norm(b.vector) <= closed * b.area;
    return volumes ? a.volume * b.volume > 0 : dot(a.vector, b.vector) > 0;
  });
}

std::vector<int> reversed_components(const Connectivity& result, const Mesh& reference, const Bvh* tree) {
  std::vector<int> component, reversed, voters;
  constexpr double majority = 0.5;  // less is undecided: between sheets closer than the result is rough
  constexpr double around = 2;      // edges: a voter farther from the reference is far off anyway
  const int n = components(result.opposite, component), faces = (int)component.size();
  std::vector<int> count(n, 0), first(n, -1), seen(n, 0);
  for (int t = faces; t-- > 0;) ++count[component[t]], first[component[t]] = t;
  const int most = std::max(9, (tree ? 2000 : 200) / std::max(1, n));  // voters of a component
  for (int t = 0; t < faces; ++t)
    if (seen[component[t]]++ % (1 + count[component[t]] / most) == 0) voters.push_back(t);
  Mesh near;
  if (!tree) near = part_of(reference, around_tiles(result.mesh, {voters}, around, &reference).row);
  const Mesh& surface = tree ? reference : near;
  std::optional<Bvh> own;
  if (surface.tris.empty()) return {};
  if (!tree) tree = &own.emplace(surface);
  std::vector<double> vote(n, 0), all(n, 0);
  for (int t : voters) {
    vote[component[t]] += towards_nearest(result.mesh, t, surface, *tree);
    all[component[t]] += norm(result.area_vector(t));
  }
  for (int c = 0; c < n; ++c)
    if (vote[c] < -majority * all[c]) reversed.push_back(first[c]);
  return reversed;
}

}  // namespace meshpipe
