// SPDX-License-Identifier: BSD-3-Clause
#include "lib/partition/labeling.h"

#include <algorithm>
#include <cstdint>
#include <numbers>

#include "lib/core/coarsen.h"
#include "lib/core/connectivity.h"
#include "lib/core/lists.h"
#include "lib/core/parallel.h"
#include "lib/core/progress.h"
#include "lib/core/topology.h"
#include "lib/core/union_find.h"
#include "lib/partition/graph.h"
#include "lib/partition/handles.h"
#include "lib/partition/merge.h"
#include "lib/partition/partition.h"

namespace meshpipe {
namespace {

/// Cuts are to follow creases: a sharp edge costs less than a smooth one.
std::vector<int> cut_weights(const Connectivity& c) {
  constexpr double sharp_factor = 0.4;
  const double flat = std::cos(sharp_edge);
  double sum = 0;
  std::size_t n = 0;
  for (int h = 0; h < c.n_half_edges(); ++h)
    if (!c.is_border(h)) sum += c.length(h), ++n;
  std::vector<int> weight(c.n_half_edges(), 0);
#pragma omp parallel for schedule(static) if (n > 100000)
  for (int h = 0; h < c.n_half_edges(); ++h) {
    if (c.is_border(h)) continue;
    const Vec3 mine = c.area_vector(h / 3), other = c.area_vector(c.opposite[h] / 3);
    const double f = dot(mine, other) < flat * norm(mine) * norm(other) ? sharp_factor : 1;
    weight[h] = (int)std::clamp(std::round(100 * f * c.length(h) * n / sum), 1.0, 1e5);
  }
  return weight;
}

/// What the parts of a cut have about as much of.
enum class Balance { area, triangles };

/// Cuts the triangles of a label into k parts by METIS, along borders of aggregates: the first part keeps the
/// label, the others get next, next + 1, ... False if METIS leaves them together.
bool cut_label(const Component& c, std::vector<int>& label, int mine, int k, double imbalance, int seed,
               int next, Balance balance = Balance::area) {
  std::vector<int> node(c.aggregates.n, -1);
  std::vector<double> load(c.aggregates.n, 0);
  int n = 0;
  double total = 0;
  for (std::size_t t = 0; t < label.size(); ++t)
    if (label[t] == mine) {
      const int g = c.aggregates.of[t];
      if (node[g] < 0) node[g] = n++;
      const double own = balance == Balance::area ? c.area[t] : 1;
      load[g] += own;
      total += own;
    }
  struct Link {
    int a, b, weight;
  };
  std::vector<Link> links;
  for (int h : c.aggregates.crossing) {
    const int o = c.opposite[h];
    if (label[h / 3] != mine || label[o / 3] != mine) continue;
    const int a = node[c.aggregates.of[h / 3]], b = node[c.aggregates.of[o / 3]];
    if (links.empty() || links.back().a != a || links.back().b != b) links.push_back({a, b, 0});
    links.back().weight += c.weight[h];
  }
  const Lists arcs = lists_of(n, [&](auto use) {
    for (int i = 0; i < (int)links.size(); ++i) use(links[i].a, i), use(links[i].b, i);
  });
  Graph graph{arcs.start, {}, {}, std::vector<int>(n, 1)};
  for (int g = 0; g < n; ++g)
    for (int i : arcs[g]) {
      graph.adjacency.push_back(links[i].a == g ? links[i].b : links[i].a);
      graph.edge_weight.push_back(links[i].weight);
    }
  for (int g = 0; g < c.aggregates.n; ++g)
    if (node[g] >= 0 && total > 0)
      graph.vertex_weight[node[g]] = (int)std::clamp(std::round(10 * load[g] * n / total), 1.0, 1000.0);
  const std::vector<int> part = partition_graph(graph, k, imbalance, seed);
  for (std::size_t t = 0; t < label.size(); ++t)
    if (label[t] == mine)
      if (int p = part[node[c.aggregates.of[t]]]; p > 0) label[t] = next + p - 1;
  return std::adjacent_find(part.begin(), part.end(), std::not_equal_to<>()) != part.end();
}

/// Borders between labels, the most expensive first.
std::vector<SharedBorder> shared_borders(const Component& c, const std::vector<int>& label,
                                         const Regions& regions) {
  return shared_borders({c.mesh, c.opposite}, label, regions, [&](int h) { return (double)c.weight[h]; });
}

/// Hands pieces of fewer triangles or less area than given to the neighbor with the longest shared border.
/// Returns true if there was one.
bool absorb_fragments(const Component& c, std::vector<int>& label, const Regions& regions, int min_faces,
                      double min_area) {
  std::vector<Region> piece = regions.region;
  auto small = [&](const Region& r) { return r.faces < min_faces || r.area < min_area; };
  if (std::none_of(piece.begin(), piece.end(), small)) return false;
  const int n = (int)piece.size();
  UnionFind into(n);
  const std::vector<SharedBorder> shared = shared_borders(c, label, regions);
  for (;;) {
    int smallest = -1;
    for (int l = 0; l < n; ++l)
      if (into.find(l) == l && small(piece[l]) && (smallest < 0 || piece[l].area < piece[smallest].area))
        smallest = l;
    if (smallest < 0) break;
    std::vector<double> with(n, 0);
    for (const SharedBorder& s : shared) {
      const int a = into.find(s.a), b = into.find(s.b);
      if (a != b && (a == smallest || b == smallest)) with[a == smallest ? b : a] += s.length;
    }
    const int best = (int)(std::max_element(with.begin(), with.end()) - with.begin());
    if (with[best] == 0) break;  // it is all there is
    into.merge_into(smallest, best);
    piece[best].faces += piece[smallest].faces;
    piece[best].area += piece[smallest].area;
  }
  for (int& l : label) l = into.find(l);
  return true;
}

/// Where a region touches itself at a vertex, gives its smaller fan there to the neighbor. Returns true if
/// there was one.
bool open_pinches(const Component& c, std::vector<int>& label, const Regions& regions) {
  bool changed = false;
  for (int l = 0; l < (int)regions.region.size(); ++l) {
    if (!regions.region[l].pinched) continue;
    auto inside = [&](int g) { return c.opposite[g] >= 0 && label[c.opposite[g] / 3] == l; };
    for (const Fan& f : pinched_fans({c.mesh, c.opposite}, label, l, regions.border[l])) {
      if (label[f.half_edge / 3] != l) continue;
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

/// Halves the triangles of a label by METIS, or by their numbers if it leaves them together.
void bisect(const Component& c, std::vector<int>& label, int mine, int new_label, int seed) {
  if (cut_label(c, label, mine, 2, 0.3, seed, new_label)) return;
  const auto all = std::count(label.begin(), label.end(), mine);
  std::ptrdiff_t seen = 0;
  for (int& l : label)
    if (l == mine && 2 * seen++ < all) l = new_label;
}

/// Turns any labeling into one whose parts all map to the plane: fragments are absorbed, pinches opened,
/// parts of the wrong topology bisected. `fragment`: the share of the area that a part has to have at first.
/// Returns the parts, or 0 regions if it does not get there.
Regions make_admissible(const Component& c, std::vector<int>& label, int seed,
                        double fragment = limit::fragment) {
  const int n_faces = (int)c.mesh.tris.size();
  double min_area = fragment * c.whole.area;
  int min_faces = std::min(limit::fragment_triangles, n_faces / 10);
  auto regions_of_pieces = [&] {
    const int n = separate_pieces({c.mesh, c.opposite}, label);
    return find_regions({c.mesh, c.opposite}, label, n);
  };
  for (int round = 0; round < 60; ++round, min_area *= 0.25, min_faces /= 2) {
    Regions r = regions_of_pieces();
    if (absorb_fragments(c, label, r, min_faces, min_area)) r = regions_of_pieces();
    for (int i = 0; i < 8 && open_pinches(c, label, r); ++i) r = regions_of_pieces();
    int n = (int)r.region.size();
    for (int l = 0; l < (int)r.region.size(); ++l)
      if (!r.region[l].maps_to_the_plane()) bisect(c, label, l, n++, seed);
    if (n == (int)r.region.size()) return r;
  }
  return {};
}

/// The parts that one comes to: what is too long will be cut in two.
int parts_of(const Region& r) { return r.faces == 0 ? 0 : r.aspect() > limit::aspect ? 2 : 1; }

/// Joins neighbors, those with the longest shared border first, while their union maps to the plane and comes
/// to fewer parts.
Regions merge(const Component& c, std::vector<int>& label, Regions regions) {
  Joiner joiner({c.mesh, c.opposite}, label, std::move(regions));
  const std::vector<Region>& region = joiner.regions().region;
  auto weight = [&](int h) { return (double)c.weight[h]; };
  join_neighbors(joiner, {c.mesh, c.opposite}, label, weight, [&](int a, int b) {
    const Region r = joiner.joined(a, b);
    return r.maps_to_the_plane() && parts_of(r) < parts_of(region[a]) + parts_of(region[b]);
  });
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

Labeling finish(const Component& c, std::vector<int> label, int seed) {
  Labeling l;
  Regions r = make_admissible(c, label, seed);
  if (r.region.empty()) return l;
  r = merge(c, label, std::move(r));
  for (const SharedBorder& s : shared_borders(c, label, r)) l.cost += (std::int64_t)s.length;
  l.cost += bridge_cost(c, label, r);
  for (const Region& region : r.region) l.cut_parts += parts_of(region);
  l.parts = separate_pieces({c.mesh, c.opposite}, label);
  l.label = std::move(label);
  return l;
}

/// The two sides of the surface as seen from far away: the sign of the normal's component along `axis`,
/// smoothed over a few per cent of the surface. Each limb is divided lengthwise, so that neither side has one
/// that would shrink to nothing in the plane.
std::vector<int> two_sides(const Component& c, Vec3 axis) {
  const int n = (int)c.mesh.tris.size(), steps = std::clamp((int)std::sqrt(n) / 8, 4, 60);
  std::vector<double> toward(n), smooth(n);
  for (int t = 0; t < n; ++t) toward[t] = dot(normalized(area_vector(c.mesh, t)), axis);
  for (int step = 0; step < steps; ++step) {
    for (int t = 0; t < n; ++t) {
      double sum = c.area[t] * toward[t], weight = c.area[t];
      for (int h = 3 * t; h < 3 * t + 3; ++h)
        if (int o = c.opposite[h] / 3; c.opposite[h] >= 0) {
          sum += c.area[o] * toward[o];
          weight += c.area[o];
        }
      smooth[t] = weight > 0 ? sum / weight : 0;
    }
    toward.swap(smooth);
  }
  std::vector<int> label(n);
  for (int t = 0; t < n; ++t) label[t] = toward[t] < 0;
  return label;
}

/// Tries several numbers of parts, balances and seeds, and keeps the best labeling.
Labeling search(const Component& c, bool homology, int seed) {
  const int n = (int)c.mesh.tris.size();
  // Joining neighbors afterwards makes the number of parts asked for uncritical: about G + 2 does best. On
  // a large surface the trials end with a labeling that is good enough
  const int genus = c.whole.genus();
  const int most_trials = std::clamp(500000 / (n * (1 + genus / 16)), 3, 12),
            enough = c.of_fine > 0 ? 2 + genus / 2
                     : n > 20000   ? std::max(2, genus + 1)
                                   : 2;
  std::vector<int> ks{genus + 2};
  for (int d = 1; d <= genus && d <= 6; ++d) ks.insert(ks.end(), {genus + 2 + d, genus + 2 - d});
  const double balances[] = {0.3, 0.1, 0.5};
  constexpr int worth_threads = 3000;                  // triangles
  constexpr int batch = 2, first_side = 2, sides = 3;  // the sides of the surface come after two trials
  const Vec3 axes[sides] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  auto candidate = [&](int i) {
    if (i >= first_side && i < first_side + sides) return two_sides(c, axes[i - first_side]);
    const int trial = i < first_side ? i : i - sides;
    std::vector<int> label(n, 0);
    cut_label(c, label, 0, ks[trial % ks.size()], balances[trial / ks.size() % 3], seed + trial, 1);
    return label;
  };
  Labeling best;
  for (int tried = 0; tried < most_trials + sides && (best.parts == 0 || best.cut_parts > enough);
       tried += batch) {
    Labeling found[batch];
    auto try_one = [&](int i) { found[i] = finish(c, candidate(tried + i), seed + tried + i); };
    parallel_for(batch, try_one, n > worth_threads);
    for (Labeling& l : found)
      if (l.parts > 0 && (best.parts == 0 || l < best)) best = std::move(l);
    add_progress(c.share * batch / (most_trials + sides));
  }
  if (genus > 0 && (homology || best.cut_parts > genus + 2)) {
    const auto loops = handle_loops({c.mesh, c.opposite}, genus);
    if ((int)loops.size() == genus) {
      Labeling l = finish(c, label_by_sides({c.mesh, c.opposite}, loops), seed);
      if (l.parts > 0 && (best.parts == 0 || l < best)) best = std::move(l);
    }
  }
  return best;
}

/// What all but the labeling of a component needs; once.
void weigh(Component& c) {
  if (!c.weight.empty()) return;
  c.weight = cut_weights({c.mesh, c.opposite});
  // METIS takes 0.7 us a node: aggregates of 32 triangles do as well as of 8 on a million, for the interface
  // is straightened afterwards
  const int wanted = std::max(c.of_fine > 0 ? 6000 : 20000, (int)c.mesh.tris.size() / 32);
  c.aggregates = grow_aggregates({c.mesh, c.opposite}, c.area, wanted);
}

/// The labels of a coarse model on the surface: each triangle has that of the nearest one that is left, over
/// the fewest edges.
std::vector<int> refine_labels(const Component& c, const Coarse& coarse, const std::vector<int>& of_coarse) {
  std::vector<int> label(c.mesh.tris.size(), -1), queue = coarse.face;
  for (std::size_t i = 0; i < coarse.face.size(); ++i) label[coarse.face[i]] = of_coarse[i];
  for (std::size_t i = 0; i < queue.size(); ++i)
    for (int h = 3 * queue[i]; h < 3 * queue[i] + 3; ++h)
      if (const int o = c.opposite[h]; o >= 0 && label[o / 3] < 0) {
        label[o / 3] = label[queue[i]];
        queue.push_back(o / 3);
      }
  return label;
}

}  // namespace

Component make_component(ConnectedPart part, const Region& whole) {
  Component c;
  c.whole = whole;
  c.mesh = std::move(part);
  c.opposite = std::move(part.opposite);
  c.area.resize(c.mesh.tris.size());
  for (int t = 0; t < (int)c.mesh.tris.size(); ++t) c.area[t] = triangle_area(c.mesh, t);
  return c;
}

Labeling best_labeling(Component& c, bool homology, int seed) {
  constexpr int enough = 8000, a_handle = 600, most = 30000, at_most = 8;  // triangles; of them for one
  constexpr double worth = 2, most_turn = 60 * std::numbers::pi / 180;
  const int n = (int)c.mesh.tris.size(), least = std::min(enough + a_handle * c.whole.genus(), most);
  Coarse coarse;
  if (n > 2 * least)
    coarse = coarsen({c.mesh, c.opposite}, std::clamp(n / at_most, least, most), {most_turn});
  Labeling l;
  if (!coarse.tris.empty() && n > worth * (double)coarse.tris.size()) {
    ConnectedPart part;
    static_cast<Mesh&>(part) = coarse;
    part.opposite = opposite_halfedges(coarse);
    Component small = make_component(std::move(part), c.whole);
    small.of_fine = n;
    small.share = c.share;
    weigh(small);
    l = search(small, homology, seed);
  }
  if (l.parts > 0) {
    l.label = refine_labels(c, coarse, l.label);
    std::vector<int> label = l.label;
    const int pieces = separate_pieces({c.mesh, c.opposite}, label);
    const Regions r = find_regions({c.mesh, c.opposite}, label, pieces);
    if (pieces == l.parts && std::all_of(r.region.begin(), r.region.end(),
                                         [](const Region& x) { return x.maps_to_the_plane(); })) {
      l.label = std::move(label);
      return l;
    }
  }
  weigh(c);
  return l.parts > 0 ? finish(c, l.label, seed) : search(c, homology, seed);
}

void bound_faces(Component& c, Labeling& l, int max_faces, int seed) {
  weigh(c);
  const int limit = std::max(1, (int)(0.9 * max_faces));
  for (int round = 0; round < 60; ++round) {
    bool again = false;
    std::vector<int> faces(l.parts, 0);
    for (int x : l.label) ++faces[x];
    int n = l.parts;
    for (int p = 0; p < (int)faces.size(); ++p) {
      if (faces[p] <= limit) continue;
      const int k = (int)std::ceil(1.25 * faces[p] / limit);  // none is much larger than the others
      if (!cut_label(c, l.label, p, k, 0.1, seed, n, Balance::triangles)) bisect(c, l.label, p, n, seed);
      n += k - 1;
      again = true;
    }
    if (!again) return;
    l.parts = (int)make_admissible(c, l.label, seed, 0).region.size();
    if (l.parts == 0) return;
  }
  l.parts = 0;
}

}  // namespace meshpipe
