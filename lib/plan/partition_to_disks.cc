// SPDX-License-Identifier: BSD-3-Clause
// Cuts a surface until every part has genus 0 and a border.
#include <algorithm>

#include "lib/core/cut.h"
#include "lib/core/error.h"
#include "lib/core/progress.h"
#include "lib/partition/partition.h"
#include "lib/plan/plan.h"

namespace meshpipe {
namespace {

/// The most triangles that a part of a component may have; 0: any number.
int bound_of(int faces, const PartitionOptions& options) {
  return options.max_faces > 0            ? options.max_faces
         : faces > limit::large_component ? limit::faces_of_large
                                          : 0;
}

/// The best labeling of a component, within the bound on triangles. No parts if there is none.
Labeling label_component(Component& c, const PartitionOptions& options) {
  Labeling l;
  if (c.whole.maps_to_the_plane()) {
    l.label.assign(c.mesh.tris.size(), 0);
    l.parts = 1;
  } else {
    l = best_labeling(c, options.homology, options.seed);
  }
  const int bound = bound_of((int)c.mesh.tris.size(), options);
  if (l.parts == 0 || bound == 0) return l;
  Labeling bounded = l;
  bound_faces(c, bounded, bound, options.seed);
  return bounded.parts > 0 || options.max_faces > 0 ? bounded : l;
}

/// Labels the fans in which a region touches itself at a vertex, except the largest ones, as regions of their
/// own, n, n + 1, ... Returns the new number of regions.
int split_pinches(const Connectivity& mesh, std::vector<int>& label, int n) {
  const Regions regions = find_regions(mesh, label, n);
  for (int l = 0, n_regions = n; l < n_regions; ++l) {
    if (!regions.region[l].pinched) continue;
    for (const Fan& f : pinched_fans(mesh, label, l, regions.border[l])) {
      for (int k = 0, h = f.half_edge; k < f.size; ++k, h = mesh.opposite[prev(h)])
        if (label[h / 3] == l) label[h / 3] = n;
      ++n;
    }
  }
  return n;
}

/// Labels the faces that model edges bound, the natural first parts, for these edges stay in any case. Edges
/// that end inside a face do not divide it. Each face is edge-connected and touches itself nowhere.
int label_faces(const Connectivity& mesh, std::vector<int>& label) {
  std::vector<int> within = mesh.opposite;
  for (int h = 0; h < mesh.n_half_edges(); ++h)
    if (mesh.is_model(h)) within[h] = -1;
  int n = components(within, label);
  for (int before = 0; before != n;) {  // each round makes triangles of a face another one
    before = n;
    split_pinches(mesh, label, n);
    n = separate_pieces(mesh, label);
  }
  return n;
}

}  // namespace

int partition_to_disks(Surface& surface, const PartitionOptions& options, std::vector<int>* neighbors) {
  std::vector<int> opposite = opposite_halfedges(surface);
  if (int v = find_pinched_vertex({surface, opposite}); v >= 0)
    throw NotAdmissible("vertex " + std::to_string(v) + " is pinched; run mclean first");
  std::vector<int> component;
  const int n_components = label_faces({surface, opposite, model_of(surface)}, component);
  const Regions whole = find_regions({surface, opposite}, component, n_components);
  auto stays_whole = [&](int i) {
    return whole.region[i].maps_to_the_plane() && bound_of(whole.region[i].faces, options) == 0;
  };
  std::vector<int> part(component);
  for (int& i : part) i = stays_whole(i) ? -1 : i;
  constexpr double before = 0.05, searching = 0.6;
  add_progress(before);
  std::vector<SubMesh> subs = split_by_label(surface, part, n_components);
  std::vector<std::vector<int>> within = opposite_of_parts(subs, {surface, opposite}, part);
  int n_parts = 0;
  std::vector<int> first(n_components);
  for (int i = 0; i < n_components; ++i) {
    first[i] = n_parts;
    if (stays_whole(i)) {
      ++n_parts;
      continue;
    }
    ConnectedPart sub{std::move(subs[i]), std::move(within[i]), {}};
    const std::vector<int> face = std::move(sub.face);
    Component c = make_component(std::move(sub), whole.region[i]);
    c.share = searching * (double)face.size() / (double)part.size();
    const Labeling l = label_component(c, options);
    if (l.parts == 0)
      throw GoalMissed("component " + std::to_string(i) + " of " + std::to_string(c.mesh.tris.size()) +
                       " triangles and genus " + std::to_string(c.whole.genus()) +
                       " could not be cut into parts of genus 0");
    for (std::size_t t = 0; t < l.label.size(); ++t) part[face[t]] = l.label[t];
    n_parts += l.parts;
  }
  for (std::size_t t = 0; t < part.size(); ++t) part[t] = first[component[t]] + std::max(part[t], 0);
  surface.face.set("part", std::move(part));
  name_origins(surface);
  if (n_parts > n_components) {  // else each maps to the plane as it is
    straighten_interfaces({surface, opposite}, n_parts, limit::snap, options.max_faces);
    if (std::string fault = part_fault({surface, opposite}, surface.face.get<int>("part")); !fault.empty())
      throw GoalMissed(fault);
  }
  if (neighbors) *neighbors = std::move(opposite);
  return n_parts;
}

}  // namespace meshpipe
