// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>

#include "lib/clean/repair.h"
#include "lib/core/spatial_order.h"

namespace meshpipe {

std::string describe_nothing_left(const CleanReport& r) {
  if (r.input_triangles == 0) return "the input has no triangle";
  int dropped = 0;
  for (const auto& [first, triangles] : r.nonorientable) dropped += triangles;
  std::string what = "no triangle is left of " + std::to_string(r.input_triangles) + ":";
  const char* between = " ";
  for (const auto& [count, why] :
       {std::pair{r.degenerate, " degenerate"}, {r.duplicate, " duplicate"}, {dropped, " not orientable"}}) {
    if (count) what += between + std::to_string(count) + why;
    if (count) between = ", ";
  }
  return what;
}

namespace {

std::vector<RepairRow> repairs(const CleanReport& r) {
  char within[64], narrow[96], ends[96];
  std::snprintf(within, sizeof within, "vertices merged with one within %g", r.tolerance);
  std::snprintf(ends, sizeof ends, "vertices merged across the ends of slits, at most %g apart",
                r.holes.slit);
  std::snprintf(narrow, sizeof narrow, "vertices put on edges across slits, at most %g away", r.holes.slit);
  const bool keep = r.sheets.kept;
  return {
      {"welded", r.welded, "vertices welded with an equal one"},
      {"welded_near", r.welded_near, within},
      {"slit_vertices", r.holes.slit_vertices, narrow},
      {"slit_ends", r.holes.slit_ends, ends},
      {"unreferenced", r.unreferenced, "unreferenced vertices dropped"},
      {"degenerate", r.degenerate, "degenerate triangles removed"},
      {"duplicate", r.duplicate, "duplicate triangles dropped"},
      {"flipped", r.flipped, "triangles reversed"},
      {"nonorientable", (int)r.nonorientable.size(), "non-orientable components dropped"},
      {"flip_edges", r.sheets.flips.edges, "edges across which the orientation changes"},
      {"contacts", r.contacts, "triangles where solids touch, one for each of them"},
      {"nonmanifold_edges", r.nonmanifold_edges,
       keep ? "edges of more than two triangles, where sheets meet" : "non-manifold edges"},
      {"paired_edges", r.paired_edges, "of them closed, by pairs of triangles that bound the same solid"},
      {"opened_edges", r.opened_edges, "of them opened into borders of sheets"},
      {"nonmanifold_vertices", r.nonmanifold_vertices,
       keep ? "vertices of several sheets or fans"
            : "vertices of several fans split into a copy for each fan"},
      {"copies", r.copies, "copies of vertices that keep sheets and fans apart"},
      {"sheet_patches", (int)r.sheets.patches.size(), "patches added, one for each further sheet"},
      {"flat", r.flat, "triangles of zero area left in"},
      {"dropped_components", r.dropped_components, "smaller components dropped"},
      {"dropped_triangles", r.dropped_triangles, "triangles dropped with them"},
      {"holes_filled", r.holes.filled, "holes filled"},
      {"hole_triangles", r.holes.triangles, "triangles added in holes"},
      {"cap_patches", (int)r.holes.patches.size(), "patches added, one for each filled hole"},
      {"holes_left", r.holes.left,
       "holes left open, along non-manifold edges or where filling would double an edge"},
  };
}

}  // namespace

std::vector<RepairRow> table_of(const CleanReport& r, const CleanOptions& options) {
  std::vector<RepairRow> table = repairs(r);
  if (options.resolve == CleanOptions::none) return table;
  char area[96];
  std::snprintf(area, sizeof area, "pieces dropped that do not bound the outside, of area %.4g",
                r.resolved.dropped_area);
  for (RepairRow row :
       {RepairRow{"intersecting_pairs", r.resolved.pairs, "pairs of triangles that intersect"},
        {"intersection_vertices", r.resolved.new_vertices, "vertices added where they do"},
        {"dropped_pieces", r.resolved.dropped, area},
        {"subtracted", r.resolved.subtracted, "bodies inside out, subtracted from those that they overlap"},
        {"crumbs", r.resolved.crumbs, "bits of almost no volume dropped that were cut off"},
        {"intersecting_left", r.resolved.left, "pairs that still intersect"}})
    table.push_back(std::move(row));
  return table;
}

std::string remark_of(const CleanReport& r) {
  int dropped = r.duplicate + r.dropped_triangles;
  for (const auto& [first, triangles] : r.nonorientable) dropped += triangles;
  if (r.opened_edges + r.nonmanifold_vertices + dropped == 0) return "";
  return "clean opened " + std::to_string(r.opened_edges) + " split " +
         std::to_string(r.nonmanifold_vertices) + " dropped " + std::to_string(dropped);
}

Remark parse_remark(const std::string& text) {
  Remark r;
  const char* pattern = "clean opened %d split %d dropped %d";
  return std::sscanf(text.c_str(), pattern, &r.opened, &r.split, &r.dropped) == 3 ? r : Remark{};
}

Surface offending_faces(const CleanReport& report, const Mesh& input) {
  Surface s;
  std::vector<int> patch, origin;
  for (const OffendingFace& c : report.offending) {
    s.tris.push_back(input.tris[c.triangle]);
    patch.push_back((int)c.fault + 1);
    origin.push_back(c.triangle);
  }
  s.points = rearranged(input.points, number_by_first_use(s.tris, input.points.size()));
  s.vertex.rows = s.points.size();
  s.face.set("patch", std::move(patch));
  s.face.set("origin", std::move(origin));
  return s;
}

}  // namespace meshpipe
