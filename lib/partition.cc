// SPDX-License-Identifier: BSD-3-Clause
#include "lib/partition.h"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <numeric>
#include <string>
#include <tuple>

#include "lib/error.h"
#include "lib/forecast.h"
#include "lib/graph.h"
#include "lib/regions.h"
#include "lib/straighten.h"
#include "lib/topology.h"

namespace meshpipe {
namespace {

/// A component of the surface with its dual graph: triangles joined across edges, weighed by the edge's
/// length.
struct Component {
  SubMesh mesh;
  std::vector<int> opposite;
  std::vector<double> area;  // of each triangle
  std::vector<int> weight;   // of each half-edge, as in the graph: the cost of a cut along it
  Region whole;
};

/// How a labelling compares: fewer charts in the end first, then the cheaper cut.
struct Labelling {
  std::vector<int> label;
  int burden = 0, parts = 0;
  std::int64_t cost = 0;
  bool operator<(const Labelling& o) const { return std::tie(burden, cost) < std::tie(o.burden, o.cost); }
};

/// Cuts are to follow creases: a model edge costs a fifth of its length, a sharp edge less than a smooth one.
std::vector<int> cut_weights(const Mesh& mesh, const std::vector<int>& opposite,
                             const std::vector<std::uint8_t>& model) {
  constexpr double model_factor = 0.2, sharp_factor = 0.4, sharp = 40 * 3.14159265358979 / 180;
  std::vector<double> length(opposite.size(), 0);
  double sum = 0;
  std::size_t n = 0;
  std::vector<Vec3> normal(mesh.tris.size());
  for (std::size_t t = 0; t < normal.size(); ++t) {
    const Tri& v = mesh.tris[t];
    normal[t] = area_vector(mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]]);
  }
  for (int h = 0; h < (int)opposite.size(); ++h)
    if (opposite[h] >= 0) {
      length[h] = norm(mesh.points[target(mesh.tris, h)] - mesh.points[origin(mesh.tris, h)]);
      sum += length[h];
      ++n;
    }
  std::vector<int> weight(opposite.size(), 0);
  for (int h = 0; h < (int)opposite.size(); ++h) {
    int o = opposite[h];
    if (o < 0) continue;
    double f = 1;
    if (!model.empty() && model[h / 3] >> h % 3 & 1)
      f = model_factor;
    else if (angle(normal[h / 3], normal[o / 3]) > sharp)
      f = sharp_factor;
    weight[h] = (int)std::clamp(std::round(100 * f * length[h] * n / sum), 1.0, 1e5);
  }
  return weight;
}

/// The dual graph of the triangles with this label (all of them if `label` is empty), on their own numbers.
Graph dual_graph(const Component& c, const std::vector<int>& triangles, const std::vector<int>& local) {
  Graph g;
  g.start.push_back(0);
  double mean = 0;
  for (int t : triangles) mean += c.area[t];
  mean /= (double)triangles.size();
  for (int t : triangles) {
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      int o = c.opposite[h];
      if (o < 0 || local[o / 3] < 0) continue;
      g.adjacency.push_back(local[o / 3]);
      g.edge_weight.push_back(c.weight[h]);
    }
    g.start.push_back((int)g.adjacency.size());
    g.vertex_weight.push_back(mean > 0 ? (int)std::clamp(std::round(10 * c.area[t] / mean), 1.0, 1000.0) : 1);
  }
  return g;
}

/// Borders between labels: (a, b, weight), a < b, each pair once, sorted.
struct Shared {
  int a, b;
  std::int64_t weight;
};
std::vector<Shared> shared_borders(const Component& c, const std::vector<int>& label,
                                   const Regions& regions) {
  std::vector<Shared> s;
  for (const auto& border : regions.border)
    for (int h : border)
      if (int o = c.opposite[h]; o > h) {
        auto [a, b] = std::minmax(label[h / 3], label[o / 3]);
        s.push_back({a, b, c.weight[h]});
      }
  std::sort(s.begin(), s.end(),
            [](const Shared& p, const Shared& q) { return std::tie(p.a, p.b) < std::tie(q.a, q.b); });
  std::size_t n = 0;
  for (const Shared& x : s)
    if (n && s[n - 1].a == x.a && s[n - 1].b == x.b)
      s[n - 1].weight += x.weight;
    else
      s[n++] = x;
  s.resize(n);
  return s;
}

/// Hands pieces of fewer triangles or less area than given to the neighbour with the longest shared border.
/// Returns true if there was one.
bool absorb_fragments(const Component& c, std::vector<int>& label, const Regions& regions, int min_faces,
                      double min_area) {
  std::vector<Region> piece = regions.region;
  auto small = [&](const Region& r) { return r.faces < min_faces || r.area < min_area; };
  if (std::none_of(piece.begin(), piece.end(), small)) return false;
  const int n = (int)piece.size();
  std::vector<int> into(n);
  std::iota(into.begin(), into.end(), 0);
  const std::vector<Shared> shared = shared_borders(c, label, regions);
  auto root = [&](int l) {
    while (into[l] != l) l = into[l] = into[into[l]];
    return l;
  };
  for (;;) {
    int smallest = -1;
    for (int l = 0; l < n; ++l)
      if (into[l] == l && small(piece[l]) && (smallest < 0 || piece[l].area < piece[smallest].area))
        smallest = l;
    if (smallest < 0) break;
    std::vector<std::int64_t> with(n, 0);
    for (const Shared& s : shared) {
      int a = root(s.a), b = root(s.b);
      if (a != b && (a == smallest || b == smallest)) with[a == smallest ? b : a] += s.weight;
    }
    int best = (int)(std::max_element(with.begin(), with.end()) - with.begin());
    if (with[best] == 0) break;  // it is all there is
    into[smallest] = best;
    piece[best].faces += piece[smallest].faces;
    piece[best].area += piece[smallest].area;
  }
  for (int& l : label) l = root(l);
  return true;
}

/// Where a region touches itself at a vertex, gives its smaller fan there to the neighbour. Returns true if
/// there was one.
bool open_pinches(const Component& c, std::vector<int>& label, const Regions& regions) {
  struct Fan {
    int vertex, size, half_edge;
  };
  bool changed = false;
  for (int l = 0; l < (int)regions.region.size(); ++l) {
    if (!regions.region[l].pinched) continue;
    auto inside = [&](int g) { return c.opposite[g] >= 0 && label[c.opposite[g] / 3] == l; };
    std::vector<Fan> fans;
    for (int h : regions.border[l]) {
      int size = 1;  // of the fan of triangles around the origin of border half-edge h
      for (int g = prev(h); inside(g); g = prev(c.opposite[g])) ++size;
      fans.push_back({origin(c.mesh.tris, h), size, h});
    }
    std::sort(fans.begin(), fans.end(), [](const Fan& p, const Fan& q) {
      return std::tie(p.vertex, p.size, p.half_edge) < std::tie(q.vertex, q.size, q.half_edge);
    });
    for (std::size_t i = 0; i + 1 < fans.size(); ++i) {
      const Fan& f = fans[i];
      if (f.vertex != fans[i + 1].vertex || label[f.half_edge / 3] != l) continue;
      // to what lies across the fan's first edge, or its last one where the first is on the border
      int last = prev(f.half_edge);
      while (inside(last)) last = prev(c.opposite[last]);
      const int o = c.opposite[f.half_edge] >= 0 ? c.opposite[f.half_edge] : c.opposite[last];
      if (o < 0 || label[o / 3] == l) continue;
      for (int k = 0, h = f.half_edge; k < f.size && h >= 0; ++k, h = c.opposite[prev(h)])
        label[h / 3] = label[o / 3];
      changed = true;
    }
  }
  return changed;
}

/// Halves the triangles by METIS, or by their numbers if it leaves them together.
void bisect(const Component& c, const std::vector<int>& triangles, std::vector<int>& label, int new_label,
            int seed) {
  std::vector<int> local(c.mesh.tris.size(), -1);
  for (std::size_t i = 0; i < triangles.size(); ++i) local[triangles[i]] = (int)i;
  std::vector<int> part = partition_graph(dual_graph(c, triangles, local), 2, 0.3, seed);
  if (std::adjacent_find(part.begin(), part.end(), std::not_equal_to<>()) == part.end())
    for (std::size_t i = 0; i < part.size(); ++i) part[i] = 2 * i < part.size();
  for (std::size_t i = 0; i < triangles.size(); ++i)
    if (part[i]) label[triangles[i]] = new_label;
}

/// Turns any labelling into one whose parts all map to the plane: fragments are absorbed, pinches opened,
/// parts of the wrong topology bisected. Returns the parts, or 0 regions if it does not get there.
Regions make_admissible(const Component& c, std::vector<int>& label, int seed) {
  const int n_faces = (int)c.mesh.tris.size();
  double min_area = 0.01 * c.whole.area;
  int min_faces = std::min(20, n_faces / 10);
  auto regions_of_pieces = [&] {
    const int n = separate_pieces(c.opposite, label);
    return find_regions(c.mesh, c.opposite, label, n);
  };
  for (int round = 0; round < 60; ++round, min_area *= 0.25, min_faces /= 2) {
    Regions r = regions_of_pieces();
    if (absorb_fragments(c, label, r, min_faces, min_area)) r = regions_of_pieces();
    for (int i = 0; i < 8 && open_pinches(c, label, r); ++i) r = regions_of_pieces();
    int n = (int)r.region.size();
    std::vector<int> bad(n, -1);
    std::vector<std::vector<int>> triangles;
    for (int l = 0; l < n; ++l)
      if (!r.region[l].maps_to_the_plane()) bad[l] = (int)triangles.size(), triangles.emplace_back();
    if (triangles.empty()) return r;
    for (int t = 0; t < n_faces; ++t)
      if (bad[label[t]] >= 0) triangles[bad[label[t]]].push_back(t);
    for (const auto& ts : triangles) bisect(c, ts, label, n++, seed);
  }
  return {};
}

/// How many charts a part will come to: the multiscale partitioner halves one whose map would be too uneven,
/// if it is a tree or tube and no sponge, and mparam cuts one whose map overlaps until it does not. The limit
/// is below what is admissible, since the forecast is for a border along the triangles' edges.
int burden(const Region& r, const Forecast& f) {
  constexpr double uneven = 1e7;
  constexpr int holes_of_a_cut = 4;
  return 1 + f.crossings + (f.unevenness > uneven ? 1 + r.loops / holes_of_a_cut : 0);
}

/// Joins neighbours, those with the longest shared border first, while their union maps to the plane and is a
/// lesser burden. Leaves the burden of each label in `load`, 0 where there is none any more.
Regions merge(const Component& c, const Forecaster& forecaster, std::vector<int>& label, Regions regions,
              std::vector<int>& load) {
  std::vector<Shared> shared = shared_borders(c, label, regions);
  load.clear();
  for (int l = 0; l < (int)regions.region.size(); ++l)
    load.push_back(burden(regions.region[l], forecaster.of(label, l, l, regions.border[l])));
  Joiner joiner(c.mesh, c.opposite, label, std::move(regions));
  std::vector<std::pair<int, int>> refused;  // sorted
  for (;;) {
    std::sort(shared.begin(), shared.end(), [](const Shared& p, const Shared& q) {
      return std::tuple(-p.weight, p.a, p.b) < std::tuple(-q.weight, q.a, q.b);
    });
    int together = 0;
    auto found = std::find_if(shared.begin(), shared.end(), [&](const Shared& s) {
      auto place = std::lower_bound(refused.begin(), refused.end(), std::pair(s.a, s.b));
      if (place != refused.end() && *place == std::pair(s.a, s.b)) return false;
      if (const Region r = joiner.joined(s.a, s.b); r.maps_to_the_plane()) {
        together = burden(r, forecaster.of(label, s.a, s.b, joiner.border_of_union()));
        if (together < load[s.a] + load[s.b]) return true;
      }
      refused.insert(place, {s.a, s.b});
      return false;
    });
    if (found == shared.end()) break;
    const int a = found->a, b = found->b;
    joiner.join(a, b);
    load[a] = together;
    load[b] = 0;
    std::erase_if(refused,
                  [&](auto& p) { return p.first == a || p.second == a || p.first == b || p.second == b; });
    shared = shared_borders(c, label, joiner.regions());
  }
  return joiner.regions();
}

/// Parts only an edge wide somewhere make bad charts: an edge inside a part with both ends on borders costs
/// twice its length.
std::int64_t bridge_cost(const Component& c, const std::vector<int>& label, const Regions& regions) {
  std::vector<char> on_border(c.mesh.points.size(), 0);
  for (const auto& border : regions.border)
    for (int h : border) on_border[origin(c.mesh.tris, h)] = 1;
  std::int64_t cost = 0;
  for (int h = 0; h < (int)c.opposite.size(); ++h)
    if (on_border[origin(c.mesh.tris, h)] && on_border[target(c.mesh.tris, h)])
      if (int o = c.opposite[h]; o > h && label[o / 3] == label[h / 3]) cost += 2 * c.weight[h];
  return cost;
}

/// Halves the parts whose maps would overlap. Returns true if there was one.
bool halve_tangled(const Component& c, const Forecaster& forecaster, std::vector<int>& label,
                   const Regions& regions, int seed) {
  constexpr int few = 100;  // triangles
  int n = (int)regions.region.size();
  std::vector<int> tangled(n, -1);
  std::vector<std::vector<int>> triangles;
  for (int l = 0; l < (int)tangled.size(); ++l)
    if (regions.region[l].faces > few && forecaster.of(label, l, l, regions.border[l]).crossings > 0)
      tangled[l] = (int)triangles.size(), triangles.emplace_back();
  for (std::size_t t = 0; t < label.size(); ++t)
    if (tangled[label[t]] >= 0) triangles[tangled[label[t]]].push_back((int)t);
  for (const auto& ts : triangles) bisect(c, ts, label, n++, seed);
  return !triangles.empty();
}

Labelling finish(const Component& c, const Forecaster& forecaster, std::vector<int> label, int seed) {
  Labelling l;
  Regions r = make_admissible(c, label, seed);
  for (int round = 0; round < 4 && halve_tangled(c, forecaster, label, r, seed); ++round)
    r = make_admissible(c, label, seed);
  if (r.region.empty()) return l;
  std::vector<int> load;
  r = merge(c, forecaster, label, std::move(r), load);
  for (int x : load) {
    l.parts += x > 0;
    l.burden += x;
  }
  for (const Shared& s : shared_borders(c, label, r)) l.cost += s.weight;
  l.cost += bridge_cost(c, label, r);
  separate_pieces(c.opposite, label);
  l.label = std::move(label);
  return l;
}

/// The two sides of the surface as seen from far away: the sign of the normal's component along `axis`,
/// smoothed over a few per cent of the surface. Each limb is divided lengthwise, so that neither side has one
/// that would shrink to nothing in the plane.
std::vector<int> two_sides(const Component& c, Vec3 axis) {
  const int n = (int)c.mesh.tris.size(), steps = std::clamp((int)std::sqrt(n) / 8, 4, 60);
  std::vector<double> facing(n), smooth(n);
  for (int t = 0; t < n; ++t) {
    const Tri& v = c.mesh.tris[t];
    facing[t] =
        dot(normalized(area_vector(c.mesh.points[v[0]], c.mesh.points[v[1]], c.mesh.points[v[2]])), axis);
  }
  for (int step = 0; step < steps; ++step) {
    for (int t = 0; t < n; ++t) {
      double sum = c.area[t] * facing[t], weight = c.area[t];
      for (int h = 3 * t; h < 3 * t + 3; ++h)
        if (int o = c.opposite[h] / 3; c.opposite[h] >= 0) {
          sum += c.area[o] * facing[o];
          weight += c.area[o];
        }
      smooth[t] = weight > 0 ? sum / weight : 0;
    }
    facing.swap(smooth);
  }
  std::vector<int> label(n);
  for (int t = 0; t < n; ++t) label[t] = facing[t] < 0;
  return label;
}

/// Tries several numbers of parts, balances and seeds, and keeps the best labelling.
Labelling best_labelling(const Component& c, const PartitionOptions& options) {
  const int n = (int)c.mesh.tris.size();
  std::vector<int> all(n);
  std::iota(all.begin(), all.end(), 0);
  const Graph graph = dual_graph(c, all, all);

  // METIS takes about 0.3 us a triangle; the budget keeps large surfaces near linear. Joining neighbours
  // afterwards makes the number of parts asked for uncritical: about G + 2 does best
  const int most_trials = std::clamp(500000 / n, 3, 40), genus = c.whole.genus();
  std::vector<int> ks{genus + 2};
  for (int d = 1; genus > 0 && d <= genus && d <= 6; ++d) {
    ks.push_back(genus + 2 + d);
    ks.push_back(genus + 2 - d);
  }
  const double balances[] = {0.3, 0.1, 0.5};
  const Forecaster forecaster(c.mesh, c.opposite);
  constexpr int batch = 3, bound = 2;  // one part does not do
  const Vec3 axes[batch] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Labelling best;
  for (int tried = 0; tried < most_trials && best.burden != bound; tried += batch) {
    Labelling found[2 * batch];
    std::exception_ptr failure;  // must not leave the parallel region by itself
#pragma omp parallel for schedule(dynamic, 1)
    for (int i = 0; i < batch; ++i) try {
        const int trial = tried + i, seed = options.seed + trial, k = ks[trial % ks.size()];
        found[i] =
            finish(c, forecaster, partition_graph(graph, k, balances[trial / ks.size() % 3], seed), seed);
        if (tried == 0) found[batch + i] = finish(c, forecaster, two_sides(c, axes[i]), seed);
      } catch (...) {
#pragma omp critical
        failure = std::current_exception();
      }
    if (failure) std::rethrow_exception(failure);
    for (Labelling& l : found)
      if (l.parts > 0 && (best.parts == 0 || l < best)) best = std::move(l);
  }
  return best;
}

Component make_component(const Surface& surface, SubMesh sub) {
  Component c;
  c.mesh = std::move(sub);
  c.opposite = opposite_halfedges(c.mesh.tris, (int)c.mesh.points.size());
  for (const Tri& v : c.mesh.tris)
    c.area.push_back(0.5 * norm(area_vector(c.mesh.points[v[0]], c.mesh.points[v[1]], c.mesh.points[v[2]])));
  std::vector<std::uint8_t> model;
  if (surface.face.has("model"))
    for (int t : c.mesh.face) model.push_back(surface.face.get<std::uint8_t>("model")[t]);
  c.weight = cut_weights(c.mesh, c.opposite, model);
  c.whole = find_regions(c.mesh, c.opposite, std::vector<int>(c.mesh.tris.size(), 0), 1).region[0];
  return c;
}

/// Cuts parts of too many triangles, with some room for those that smoothing adds.
void bound_faces(const Component& c, Labelling& l, const PartitionOptions& options) {
  const int limit = std::max(1, (int)(0.9 * options.max_faces));
  for (int round = 0; round < 60; ++round) {
    bool again = false;
    std::vector<std::vector<int>> triangles(l.parts);
    for (std::size_t t = 0; t < l.label.size(); ++t) triangles[l.label[t]].push_back((int)t);
    int n = l.parts;
    for (const auto& ts : triangles)
      if ((int)ts.size() > limit) bisect(c, ts, l.label, n++, options.seed), again = true;
    if (!again) return;
    l.parts = (int)make_admissible(c, l.label, options.seed).region.size();
    if (l.parts == 0) return;
  }
  l.parts = 0;
}

}  // namespace

int partition_to_disks(Surface& surface, const PartitionOptions& options) {
  const std::vector<int> opposite = opposite_halfedges(surface.tris, (int)surface.points.size());
  if (int v = find_pinched_vertex(surface.tris, opposite, (int)surface.points.size()); v >= 0)
    throw NotAdmissible("vertex " + std::to_string(v) + " is pinched; run mclean first");
  std::vector<int> component;
  const int n_components = components(opposite, component);
  std::vector<int> part(surface.tris.size(), 0);
  int n_parts = 0;
  std::vector<SubMesh> subs = split_by_label(surface, component, n_components);
  for (int i = 0; i < n_components; ++i) {
    Component c = make_component(surface, std::move(subs[i]));
    Labelling l;
    if (c.whole.maps_to_the_plane()) {
      l.label.assign(c.mesh.tris.size(), 0);
      l.parts = 1;
    } else {
      l = best_labelling(c, options);
    }
    if (l.parts > 0 && options.max_faces > 0) bound_faces(c, l, options);
    if (l.parts == 0)
      throw GoalMissed("component " + std::to_string(i) + " of " + std::to_string(c.mesh.tris.size()) +
                       " triangles and genus " + std::to_string(c.whole.genus()) +
                       " could not be cut into parts of genus 0");
    for (std::size_t t = 0; t < l.label.size(); ++t) part[c.mesh.face[t]] = n_parts + l.label[t];
    n_parts += l.parts;
  }
  surface.face.set("part", std::move(part));
  if (!surface.face.has("origin")) {
    std::vector<int> identity(surface.tris.size());
    std::iota(identity.begin(), identity.end(), 0);
    surface.face.set("origin", std::move(identity));
  }
  straighten_interfaces(surface, n_parts, options.snap, options.max_faces);
  if (std::string fault = part_fault(surface); !fault.empty()) throw GoalMissed(fault);
  return n_parts;
}

Interfaces measure_interfaces(const Surface& surface) {
  const std::vector<int>& part = surface.face.get<int>("part");
  const std::vector<int> opposite = opposite_halfedges(surface.tris, (int)surface.points.size());
  Interfaces r;
  const bool has_model = surface.face.has("model");
  std::vector<std::pair<int, int>> ends;  // (vertex, the vertex at the other end, or -1 across a model edge)
  for (int h = 0; h < (int)opposite.size(); ++h)
    if (opposite[h] > h && part[h / 3] != part[opposite[h] / 3]) {
      int a = origin(surface.tris, h), b = target(surface.tris, h);
      r.length += norm(surface.points[b] - surface.points[a]);
      const bool model = has_model && surface.face.get<std::uint8_t>("model")[h / 3] >> h % 3 & 1;
      ends.push_back({a, model ? -1 : b});
      ends.push_back({b, model ? -1 : a});
    }
  if (ends.empty()) return r;
  r.length /= diagonal(surface);
  std::sort(ends.begin(), ends.end());
  std::vector<double> turning;
  for (std::size_t i = 0, j; i < ends.size(); i = j) {
    for (j = i + 1; j < ends.size() && ends[j].first == ends[i].first;) ++j;
    const Vec3 p = surface.points[ends[i].first];
    if (j - i == 2 && ends[i].second >= 0)
      turning.push_back(angle(p - surface.points[ends[i].second], surface.points[ends[i + 1].second] - p));
    if (j - i > 2) ++r.junctions;
  }
  if (turning.empty()) return r;
  auto quantile = turning.begin() + (std::ptrdiff_t)(turning.size() * 9 / 10);
  std::nth_element(turning.begin(), quantile, turning.end());
  constexpr double degrees = 180 / 3.14159265358979323846;
  r.turning_angle = *quantile * degrees;
  r.largest_angle = *std::max_element(quantile, turning.end()) * degrees;
  return r;
}

std::string part_fault(const Surface& surface) {
  const std::vector<int>& part = surface.face.get<int>("part");
  if (part.empty()) return {};
  const auto [least, most] = std::minmax_element(part.begin(), part.end());
  if (*least < 0) return "part " + std::to_string(*least) + " is negative";
  const int n = *most + 1;
  if (n > (int)part.size())
    return "part " + std::to_string(*most) + ", but there are " + std::to_string(part.size()) + " triangles";
  const std::vector<int> opposite = opposite_halfedges(surface.tris, (int)surface.points.size());
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
