// SPDX-License-Identifier: BSD-3-Clause
#include "lib/partition.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <string>

#include "lib/error.h"
#include "lib/labelling.h"
#include "lib/progress.h"
#include "lib/regions.h"
#include "lib/sliver.h"
#include "lib/straighten.h"
#include "lib/topology.h"

namespace meshpipe {
namespace {

/// The bound on a component's parts: solves stay near linear, and there is work for all threads.
int bound_of(int faces, const PartitionOptions& options) {
  constexpr int large = 300000, bound = 100000;
  return options.max_faces > 0 ? options.max_faces : faces > large ? bound : 0;
}

}  // namespace

int partition_to_disks(Surface& surface, const PartitionOptions& options, std::vector<int>* neighbours) {
  std::vector<int> opposite = opposite_halfedges(surface.tris, (int)surface.points.size());
  if (int v = find_pinched_vertex(surface.tris, opposite, (int)surface.points.size()); v >= 0)
    throw NotAdmissible("vertex " + std::to_string(v) + " is pinched; run mclean first");
  std::vector<int> component;
  const int n_components = components(opposite, component);
  const Regions whole = find_regions(surface, opposite, component, n_components);
  auto stays_whole = [&](int i) {
    return whole.region[i].maps_to_the_plane() && bound_of(whole.region[i].faces, options) == 0;
  };
  std::vector<int> part(component);
  for (int& i : part) i = stays_whole(i) ? -1 : i;
  constexpr double before = 0.05, searching = 0.6;
  add_progress(before);
  std::vector<SubMesh> subs = split_by_label(surface, part, n_components);
  std::vector<std::vector<int>> within = opposite_of_parts(subs, opposite, part);
  int n_parts = 0;
  std::vector<int> first(n_components);
  for (int i = 0; i < n_components; ++i) {
    first[i] = n_parts;
    if (stays_whole(i)) {
      ++n_parts;
      continue;
    }
    const std::vector<int> face = std::move(subs[i].face);
    std::vector<std::uint8_t> model;
    if (surface.face.has("model"))
      for (int t : face) model.push_back(surface.face.get<std::uint8_t>("model")[t]);
    Component c = make_component(std::move(subs[i]), std::move(model), std::move(within[i]), whole.region[i]);
    c.share = searching * (double)face.size() / (double)part.size();
    Labelling l;
    if (c.whole.maps_to_the_plane()) {
      l.label.assign(c.mesh.tris.size(), 0);
      l.parts = 1;
    } else {
      l = best_labelling(c, options);
    }
    const int bound = bound_of((int)c.mesh.tris.size(), options);
    if (l.parts > 0 && bound > 0) {
      Labelling bounded = l;
      bound_faces(c, bounded, bound, options.seed);
      if (bounded.parts > 0 || options.max_faces > 0) l = std::move(bounded);
    }
    if (l.parts == 0)
      throw GoalMissed("component " + std::to_string(i) + " of " + std::to_string(c.mesh.tris.size()) +
                       " triangles and genus " + std::to_string(c.whole.genus()) +
                       " could not be cut into parts of genus 0");
    for (std::size_t t = 0; t < l.label.size(); ++t) part[face[t]] = l.label[t];
    n_parts += l.parts;
  }
  for (std::size_t t = 0; t < part.size(); ++t) part[t] = first[component[t]] + std::max(part[t], 0);
  surface.face.set("part", std::move(part));
  if (!surface.face.has("origin")) {
    std::vector<int> identity(surface.tris.size());
    std::iota(identity.begin(), identity.end(), 0);
    surface.face.set("origin", std::move(identity));
  }
  if (n_parts > n_components) {  // else each maps to the plane as it is
    straighten_interfaces(surface, opposite, n_parts, options.snap, options.max_faces);
    hand_over_slivers(surface, opposite, n_parts, options.max_faces);
    if (std::string fault = part_fault(surface, opposite); !fault.empty()) throw GoalMissed(fault);
  }
  if (neighbours) *neighbours = std::move(opposite);
  return n_parts;
}

Interfaces measure_interfaces(const Surface& surface) {
  return measure_interfaces(surface, opposite_halfedges(surface.tris, (int)surface.points.size()));
}

Interfaces measure_interfaces(const Surface& surface, const std::vector<int>& opposite) {
  const std::vector<int>& part = surface.face.get<int>("part");
  const std::vector<Tri>& tris = surface.tris;
  const std::vector<Vec3>& points = surface.points;
  Interfaces r;
  const bool has_model = surface.face.has("model");
  auto is_interface = [&](int h) { return opposite[h] >= 0 && part[h / 3] != part[opposite[h] / 3]; };
  auto normal = [&](int t) {
    return area_vector(points[tris[t][0]], points[tris[t][1]], points[tris[t][2]]);
  };
  auto is_crease = [&](int h) {
    return (has_model && surface.face.get<std::uint8_t>("model")[h / 3] >> h % 3 & 1) ||
           angle(normal(h / 3), normal(opposite[h] / 3)) > sharp_edge;
  };
  std::vector<int> count(points.size(), 0), leaving(points.size(), -1);
  std::vector<char> crease(points.size(), 0);
  for (int h = 0; h < (int)opposite.size(); ++h) {
    if (!is_interface(h)) continue;
    const int a = origin(tris, h), b = target(tris, h);
    ++count[a];
    leaving[a] = h;
    if (opposite[h] < h) continue;
    r.length += norm(points[b] - points[a]);
    if (is_crease(h)) crease[a] = crease[b] = 1;
  }
  if (r.length > 0) r.length /= diagonal(surface);
  constexpr double pi = 3.14159265358979323846;
  std::vector<double> turning;
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (count[v] > 2) ++r.junctions;
    if (count[v] != 2 || crease[v]) continue;
    double sides[2] = {0, 0};
    int side = 0, h = leaving[v];
    do {
      sides[side] += angle(points[target(tris, h)] - points[v], points[origin(tris, prev(h))] - points[v]);
      h = opposite[prev(h)];
      if (h >= 0 && is_interface(h)) side = 1;
    } while (h >= 0 && h != leaving[v]);
    if (h >= 0) turning.push_back(pi * std::abs(sides[0] - sides[1]) / (sides[0] + sides[1]));
  }
  if (turning.empty()) return r;
  auto quantile = turning.begin() + (std::ptrdiff_t)(turning.size() * 9 / 10);
  std::nth_element(turning.begin(), quantile, turning.end());
  r.turning_angle = *quantile * 180 / pi;
  r.largest_angle = *std::max_element(quantile, turning.end()) * 180 / pi;
  return r;
}

std::string part_fault(const Surface& surface) {
  return part_fault(surface, opposite_halfedges(surface.tris, (int)surface.points.size()));
}

std::string part_fault(const Surface& surface, const std::vector<int>& opposite) {
  const std::vector<int>& part = surface.face.get<int>("part");
  if (part.empty()) return {};
  const auto [least, most] = std::minmax_element(part.begin(), part.end());
  if (*least < 0) return "part " + std::to_string(*least) + " is negative";
  const int n = *most + 1;
  if (n > (int)part.size())
    return "part " + std::to_string(*most) + ", but there are " + std::to_string(part.size()) + " triangles";
  const Regions regions = find_regions(surface, opposite, part, n);
  std::vector<int> piece;
  const int n_pieces = components(opposite_within(surface.tris, opposite, part), piece);
  std::vector<int> first(n_pieces, -1), pieces(n, 0);
  for (std::size_t t = 0; t < part.size(); ++t)
    if (first[piece[t]] < 0) first[piece[t]] = part[t], ++pieces[part[t]];
  for (int p = 0; p < n; ++p) {
    const Region& r = regions.region[p];
    const std::string name = "part " + std::to_string(p);
    if (r.faces == 0) return name + " of " + std::to_string(n) + " has no triangles";
    if (pieces[p] > 1) return name + " has " + std::to_string(pieces[p]) + " pieces";
    if (r.pinched) {
      std::vector<int> v;
      for (int h : regions.border[p]) v.push_back(origin(surface.tris, h));
      std::sort(v.begin(), v.end());
      return name + " touches itself at vertex " + std::to_string(*std::adjacent_find(v.begin(), v.end()));
    }
    if (r.loops == 0) return name + " has no boundary";
    if (r.genus() != 0) return name + " has genus " + std::to_string(r.genus());
  }
  return {};
}

}  // namespace meshpipe
