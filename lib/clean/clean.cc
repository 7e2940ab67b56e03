// SPDX-License-Identifier: BSD-3-Clause
#include "lib/clean/clean.h"

#include <algorithm>

#include "lib/clean/repair.h"
#include "lib/core/error.h"
#include "lib/core/intersect.h"
#include "lib/core/largest_patch.h"
#include "lib/core/lists.h"
#include "lib/core/spatial_order.h"
#include "lib/core/take_rows.h"
#include "lib/core/topology.h"
#include "lib/core/weld.h"
#include "lib/solids/solids.h"

namespace meshpipe {
namespace {

/// Wider slits may be meant; sizes take no notice of strips below this width.
constexpr double slit_of_diagonal = 1e-5;

/// Drops all components except the `keep` largest by area; returns whether there were more.
bool keep_largest(Repair& r, const std::vector<Vec3>& points, int keep, CleanReport& report) {
  std::vector<int> component;
  const int n = components(r.opposite, component);
  if (n <= keep) return false;
  std::vector<double> area(n, 0);
  for (int t = 0; t < (int)r.tris.size(); ++t) area[component[t]] += norm(area_vector(r, points, t));
  std::vector<int> order = identity(n);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return area[a] > area[b]; });
  std::vector<char> small(n, 0), gone(r.tris.size(), 0);
  for (int i = keep; i < n; ++i) small[order[i]] = 1;
  for (std::size_t t = 0; t < r.tris.size(); ++t)
    if (small[component[t]]) {
      gone[t] = 1;
      ++report.dropped_triangles;
      record(report, r.face[t], Fault::small);
    }
  report.dropped_components += n - keep;
  r.opposite.clear();
  drop(r, gone);
  return true;
}

/// Whether the repairs undid each other: copies of vertices were welded and split again, and the triangles
/// are as they were.
bool as_it_was(const Repair& r, const Surface& surface) {
  if (r.tris.size() != surface.tris.size()) return false;
  std::vector<int> now(surface.points.size(), -1), before(r.vertex.size(), -1);
  for (std::size_t t = 0; t < r.tris.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const int v = surface.tris[t][i], w = r.tris[t][i];
      if (now[v] < 0) now[v] = w;
      if (before[w] < 0) before[w] = v;
      if (now[v] != w || before[w] != v) return false;
    }
  return std::find(now.begin(), now.end(), -1) == now.end();
}

/// Connects, orients and splits the surface, and drops components as the options say.
void join_and_split(Repair& r, const std::vector<Vec3>& points, const CleanOptions& options,
                    CleanReport& report) {
  std::vector<char> gone;
  for (;;) {  // where a triangle goes, two others may become neighbors and disagree: then once again
    join(r, points, options, report);
    const std::size_t before = report.nonorientable.size();
    orient(r, points, options, gone, report);
    if (report.nonorientable.size() > before) {
      r.opposite.clear();
      drop(r, gone);
      continue;
    }
    if (options.sheets == CleanOptions::pair) {
      report.paired_edges = pair_edges(r, points);
      report.opened_edges -= report.paired_edges;
    }
    split_fans(r, report);
    if (!options.keep_components || !keep_largest(r, points, options.keep_components, report)) return;
    unite(r);
  }
}

/// Does all repairs that change neighbors once. Returns false if there may be more to repair: where triangles
/// are dropped or added, an edge may have got two triangles, or more than two.
bool make_manifold(Repair& r, const std::vector<Vec3>& points, const CleanOptions& options,
                   CleanReport& report) {
  join_and_split(r, points, options, report);
  if (options.keep_flat) return true;
  FlatCounts flat = remove_flat(r, points);
  bool changed = !flat.removed.empty();
  for (int t : flat.removed) {
    report.degenerate += t >= 0;
    record(report, t, Fault::degenerate);
  }
  if (options.fill_holes) {
    const HoleCounts holes = fill_holes(r, points, options.fill_holes);
    report.holes.filled += holes.filled;
    report.holes.triangles += holes.triangles;
    report.holes.left = holes.left;
    changed = changed || holes.filled;
    if (holes.filled) flat = remove_flat(r, points);  // where a hole's corners are in line
  }
  report.flat = flat.left;
  return !changed || (r.copied.empty() && !options.fill_holes);
}

/// Returns for each vertex the first one that it is welded with.
std::vector<int> weld_vertices(const Surface& surface, const CleanOptions& options, CleanReport& report) {
  const std::vector<char> used = used_points(surface);
  std::vector<int> same = first_equal(surface.points, used);
  for (int v = 0; v < report.input_vertices; ++v) report.welded += same[v] != v;
  report.tolerance = options.weld < 0 ? coordinate_noise(surface, used) : options.weld;
  report.holes.slit = std::max(slit_of_diagonal * diagonal(surface), report.tolerance);
  if (options.weld < 0) {
    const double noise = report.tolerance;
    report.welded_near = merge_noise(surface, ends_of_short_edges(surface, same, noise), noise, same);
    report.welded_near += merge_clusters(surface, same, report.tolerance);
  } else if (options.weld > 0) {
    report.welded_near = merge_near(surface.points, used, options.weld, same);
  }
  return same;
}

/// Starts the repair on welded vertices, without the triangles that have lost a corner.
Repair start(const Surface& surface, std::vector<int> number, CleanReport& report) {
  Repair r;  // on the vertices that are left, in their order
  for (int v = 0; v < report.input_vertices; ++v)
    if (number[v] == v) {
      number[v] = (int)r.vertex.size();
      r.vertex.push_back(v);
    } else {
      number[v] = number[number[v]];  // which came before
    }
  r.tris.reserve(surface.tris.size());
  r.face.reserve(surface.tris.size());
  std::vector<char> used(r.vertex.size(), 0);
  for (int t = 0; t < report.input_triangles; ++t) {
    const Tri s = surface.tris[t], w{number[s[0]], number[s[1]], number[s[2]]};
    if (w[0] == w[1] || w[1] == w[2] || w[2] == w[0]) {
      ++report.degenerate;
      record(report, t, Fault::degenerate);
      continue;
    }
    r.tris.push_back(w);
    r.face.push_back(t);
    for (int v : w) used[v] = 1;
  }
  report.unreferenced = (int)std::count(used.begin(), used.end(), 0);
  r.flipped.assign(r.tris.size(), 0);
  return r;
}

/// Repairs neighbors and orientation until nothing changes.
void repair(Repair& r, const std::vector<Vec3>& points, const CleanOptions& options, CleanReport& report) {
  // three rounds suffice in practice; that filling holes and splitting sheets always end is not proved
  constexpr int most_rounds = 50, most_passes = 3;
  std::vector<int> component;
  for (int pass = 1;; ++pass) {
    for (int round = 1; !make_manifold(r, points, options, report) && round < most_rounds; ++round) unite(r);
    report.components = components(r.opposite, component);
    if (options.keep_orientation) return;
    const std::vector<char> before = r.flipped;
    report.sheets.nested = face_outward(r, points, component, report.components);  // when holes are filled
    // solids are on the other side now of triangles that were paired
    if (pass == most_passes || report.paired_edges == 0 || r.flipped == before) return;
    unite(r);
  }
}

bool has_border(const Repair& r) {
  return std::find(r.opposite.begin(), r.opposite.end(), -1) != r.opposite.end();
}

/// Whether the triangles are still those of the surface, whose vertices are welded.
bool is_unchanged(const Repair& r, const Surface& surface, const std::vector<int>& same) {
  bool equal = r.copied.empty() && r.tris.size() == surface.tris.size();
  for (std::size_t t = 0; equal && t < r.tris.size(); ++t)
    for (int i = 0; i < 3; ++i) equal = equal && r.vertex[r.tris[t][i]] == same[surface.tris[t][i]];
  return equal;
}

/// Closes the slits of a repaired surface: the repair begins again if there are any, since they have torn
/// fans apart, and goes on where it has opened some. `same`, `welded`: what repairs begin with.
void close_all_slits(const Surface& surface, const std::vector<int>& same, const CleanReport& welded,
                     const CleanOptions& options, Repair& r, CleanReport& report) {
  constexpr int most_passes = 6;  // five suffice on 241 surfaces with borders
  for (int pass = 0; pass < most_passes && has_border(r); ++pass) {
    // the first begins with the input, for repairs have torn fans apart at slits
    const bool begins = pass == 0 && !is_unchanged(r, surface, same);
    CleanReport after = pass ? report : welded;
    after.unreferenced = report.unreferenced;
    Repair divided = begins ? start(surface, same, after) : r;
    if (pass) unite(divided), divided.opposite.clear();
    if (close_slits(divided, surface.points, after)) {
      report = std::move(after);
      r = std::move(divided);
      repair(r, surface.points, options, report);
    } else if (!begins) {
      return;
    }
  }
}

/// Flags the vertices of the input on the border of the result.
std::vector<char> border_vertices(const Repair& r, std::size_t n) {
  std::vector<char> border;
  for (int h = 0; h < (int)r.opposite.size(); ++h) {
    if (r.opposite[h] >= 0) continue;
    border.resize(n, 0);
    border[r.vertex[origin(r.tris, h)]] = border[r.vertex[target(r.tris, h)]] = 1;
  }
  return border;
}

/// Replaces the surface by the repaired one, unless that is the same.
void take_over(Repair& r, Surface& surface, const CleanOptions& options, CleanReport& report) {
  const bool renumber = report.welded || report.welded_near || report.holes.slit_ends ||
                        report.unreferenced || report.degenerate || report.dropped_triangles ||
                        !report.nonorientable.empty();
  report.nothing = !(renumber || report.duplicate || report.flipped || report.nonmanifold_edges ||
                     report.nonmanifold_vertices || report.sheets.flips.edges || report.holes.filled ||
                     report.holes.slit_vertices);
  if (report.nothing) return;
  if (as_it_was(r, surface)) {
    report.nothing = options.sheets != CleanOptions::keep || !mark_sheets(surface, r, report);
    report.welded = report.welded_near = 0;
    return;
  }
  if (renumber) r.vertex = rearranged(r.vertex, number_by_first_use(r.tris, r.vertex.size()));
  surface.points = rearranged(surface.points, r.vertex);
  surface.tris = std::move(r.tris);
  surface.face.erase("model");
  take_rows(surface.vertex, r.vertex);
  take_rows(surface.face, r.face);
  if (options.sheets == CleanOptions::keep) mark_sheets(surface, r, report);
}

/// Gives each filled hole the next free patch. `cap` is per triangle: which hole it fills, or -1.
void label_caps(Surface& surface, const std::vector<int>& cap, CleanReport& report) {
  const int holes = cap.empty() ? 0 : *std::max_element(cap.begin(), cap.end()) + 1;
  if (holes == 0) return;
  if (!surface.face.has("patch")) surface.face.set("patch", std::vector<int>(surface.tris.size(), 1));
  std::vector<int>& patch = surface.face.get<int>("patch");
  const int most = largest_patch(patch, holes);
  for (int i = 1; i <= holes; ++i) report.holes.patches.push_back(most + i);
  for (std::size_t t = 0; t < cap.size(); ++t)
    if (cap[t] >= 0) patch[t] = report.holes.patches[cap[t]];
}

/// Repairs a copy of the surface where sheets are kept, into `r`. Returns whether they are better kept than
/// paired: if pairs leave borders, or if sheets divide space into regions, which is only known where they do
/// not intersect.
bool keep_sheets(const Surface& surface, const std::vector<int>& same, const CleanOptions& options,
                 bool pairs_leave_borders, Repair& r, CleanReport& report) {
  r = start(surface, same, report);
  repair(r, surface.points, options, report);
  if (pairs_leave_borders) return true;
  Repair whole = r;
  unite(whole);
  const Mesh mesh{rearranged(surface.points, whole.vertex), std::move(whole.tris)};
  return divides_space(find_solids(mesh)) && self_intersections(mesh).empty();
}

/// Repairs a copy of the surface into `r`. Returns the options with sheets as they are treated where the
/// choice is left. `restart`: what the report begins with.
CleanOptions repair_sheets(const Surface& surface, const std::vector<int>& same, CleanOptions options,
                           const CleanReport& restart, Repair& r, CleanReport& report) {
  const bool automatic = options.sheets == CleanOptions::automatic;
  if (automatic) options.sheets = CleanOptions::pair;
  report = restart;
  r = start(surface, same, report);
  repair(r, surface.points, options, report);
  if (!automatic || !(report.nonmanifold_edges || report.sheets.nested || report.sheets.flips.edges))
    return options;
  CleanOptions keep = options;
  keep.sheets = CleanOptions::keep;
  CleanReport kept = restart;
  Repair whole;
  const bool open = report.opened_edges + report.sheets.flips.edges > 0;
  if (!keep_sheets(surface, same, keep, open, whole, kept)) return options;
  r = std::move(whole);
  report = std::move(kept);
  return keep;
}

void clean_once(Surface& surface, const CleanOptions& given, CleanReport& report) {
  report = {};
  report.input_vertices = (int)surface.points.size();
  report.input_triangles = (int)surface.tris.size();
  std::vector<int> same = weld_vertices(surface, given, report);
  CleanReport restart = report;
  Repair r;
  CleanOptions options = repair_sheets(surface, same, given, restart, r, report);
  if (options.weld < 0 && has_border(r)) {
    const double noise = coordinate_noise(surface, used_points(surface));
    int n = merge_noise(surface, border_vertices(r, same.size()), noise, same);
    const bool known = n == 0 && is_unchanged(r, surface, same);
    n += merge_seams(surface, known ? border_half_edges(r) : open_edges(surface, same), same,
                     restart.tolerance);
    if (n > 0) {
      restart.welded_near += n;
      options = repair_sheets(surface, same, given, restart, r, report);
    }
  }
  if (!options.keep_flat && !options.keep_slits) close_all_slits(surface, same, restart, options, r, report);
  for (std::size_t t = 0; t < r.tris.size(); ++t) {
    if (!r.flipped[t] || r.face[t] < 0) continue;  // triangles that fill a hole had no orientation before
    ++report.flipped;
    record(report, r.face[t], Fault::misoriented);
  }
  const std::vector<int> cap = options.cap_patches ? caps_of(r) : std::vector<int>();
  for (int t = 0; t < (int)r.tris.size(); ++t) r.face[t] = source(r, t);
  std::sort(report.offending.begin(), report.offending.end(), [](const auto& a, const auto& b) {
    return a.fault != b.fault ? a.fault < b.fault : a.triangle < b.triangle;
  });
  if (r.tris.empty()) throw NotAdmissible(describe_nothing_left(report));
  report.sheets.kept = options.sheets == CleanOptions::keep;
  if (report.sheets.kept) {
    unite(r);
    report.copies = report.opened_edges = 0;
    report.sheets.solids = solids_of_patches(r, surface, report.sheets.doubles);
  }
  take_over(r, surface, options, report);
  label_caps(surface, cap, report);
  // flips at slits alone repair nothing, and the surface stays as it was
  report.sheets.border =
      report.nothing && r.tris != surface.tris ? open_edges(surface, same) : border_half_edges(r);
}

void drop_crumbs(Surface& surface, const Mesh& input, CleanReport& report) {
  int n = 0;
  const std::vector<char> gone = find_crumbs(surface, input, n);
  if (n == 0) return;
  std::vector<Tri> tris;
  std::vector<int> face;
  for (int t = 0; t < (int)gone.size(); ++t)
    if (!gone[t]) tris.push_back(surface.tris[t]), face.push_back(t);
  const std::vector<int> vertex = number_by_first_use(tris, surface.points.size());
  surface.points = rearranged(surface.points, vertex);
  surface.tris = std::move(tris);
  take_rows(surface.vertex, vertex);
  take_rows(surface.face, face);
  report.resolved.crumbs = n;
  report.sheets.border = open_edges(surface, identity(surface.points.size()));
  report.components -= n;
}

/// Repairs a resolved surface: `report` is that of the repair before, and keeps what concerns the input.
void clean_resolved(Surface& surface, const Mesh& input, CleanOptions options, CleanReport& report) {
  options.weld = 0;  // vertices at intersections may be as close as rounding permits
  options.fill_holes = 0;
  options.keep_slits = true;
  CleanReport after;
  clean_once(surface, options, after);
  if (!after.sheets.kept) drop_crumbs(surface, input, after);
  after.input_vertices = report.input_vertices;
  after.input_triangles = report.input_triangles;
  after.welded = report.welded;
  after.welded_near = report.welded_near;
  after.tolerance = report.tolerance;
  after.unreferenced = report.unreferenced;
  after.degenerate += report.degenerate;
  after.duplicate += report.duplicate;
  after.flipped += report.flipped;
  after.holes = report.holes;
  after.nonorientable = std::move(report.nonorientable);
  after.offending = std::move(report.offending);
  after.nothing = false;
  report = std::move(after);
}

/// Resolves a surface whose vertices are welded, but whose triangles are the input's: where sheets are
/// counted with their orientation, even doubled ones and edges of many triangles may add up to something
/// closed. Returns false if they do not.
bool resolve_as_it_is(Surface& s, const CleanOptions& options, const ResolveOptions& how, CleanReport& report,
                      ResolveReport& resolved) {
  if (options.resolve != CleanOptions::outer) return false;
  report = {};
  report.input_vertices = (int)s.points.size();
  report.input_triangles = (int)s.tris.size();
  const std::vector<int> same = weld_vertices(s, options, report);
  for (std::size_t v = 0; v < same.size(); ++v) s.points[v] = s.points[same[v]];
  try {
    resolved = resolve(s, how);
  } catch (const NotAdmissible&) {  // after a repair this may be different
    return false;
  }
  return resolved.closed;
}

/// Moves points that are one up to noise, or within the tolerance given, to the first of them, also those of
/// sheets that do not meet: where one is divided along the other, slivers would be left between them.
void join_points(Surface& s, const CleanOptions& options) {
  const std::vector<char> used = used_points(s);
  std::vector<int> same = first_equal(s.points, used);
  const double within = options.weld < 0 ? coordinate_noise(s, used) : options.weld;
  if (within > 0) merge_near(s.points, used, within, same);
  for (std::size_t v = 0; v < same.size(); ++v) s.points[v] = s.points[same[v]];
}

}  // namespace

void clean(Surface& surface, const CleanOptions& options, CleanReport& report) {
  expect_measurable(surface);
  if (options.resolve == CleanOptions::none) return clean_once(surface, options, report);
  const ResolveOptions how{options.resolve == CleanOptions::all ? ResolveOptions::all
                                                                : ResolveOptions::outer};
  Surface s = surface;
  ResolveReport resolved;
  if (!resolve_as_it_is(s, options, how, report, resolved)) {
    CleanOptions first = options;
    first.keep_components = 0;
    first.sheets = CleanOptions::pair;
    s = surface;
    if (how.keep == ResolveOptions::all) join_points(s, options);
    clean_once(s, first, report);
    resolved = resolve(s, how);
  }
  if (s.tris.empty())
    throw NotAdmissible("none of " + std::to_string(report.input_triangles) +
                        " triangles bounds a solid, so that no outer surface is left: mwrap makes one");
  if (resolved.nothing) {
    clean_once(surface, options, report);
  } else {
    clean_resolved(s, surface, options, report);
    resolved.crumbs = report.resolved.crumbs;
    surface = std::move(s);
  }
  report.resolved = resolved;
}

CleanReport clean(Surface& surface, const CleanOptions& options) {
  CleanReport report;
  clean(surface, options, report);
  return report;
}

void split_sheets(Surface& surface) {
  const CleanReport r =
      clean(surface, {.weld = 0, .keep_orientation = true, .keep_flat = true, .sheets = CleanOptions::split});
  if ((int)surface.tris.size() != r.input_triangles || r.degenerate || r.duplicate)
    throw NotAdmissible("the surface has " + std::to_string(r.degenerate) + " degenerate and " +
                        std::to_string(r.duplicate) + " duplicate triangles; run mclean first");
}

}  // namespace meshpipe
