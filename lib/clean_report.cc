// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>

#include "lib/clean.h"

namespace meshpipe {

std::string describe(const Nonorientable& c) {
  char place[96];
  std::snprintf(place, sizeof place, " (%.6g %.6g %.6g)", c.place.x, c.place.y, c.place.z);
  return "the component of triangle " + std::to_string(c.triangle) + " (" + std::to_string(c.triangles) +
         " triangles) is not orientable: triangles " + std::to_string(c.a) + " and " + std::to_string(c.b) +
         " cannot agree at" + place;
}

std::string describe_nothing_left(const CleanReport& r) {
  if (r.input_triangles == 0) return "the input has no triangle";
  int dropped = 0;
  for (const Nonorientable& c : r.nonorientable) dropped += c.triangles;
  std::string what = "no triangle is left of " + std::to_string(r.input_triangles) + ":";
  const char* between = " ";
  for (const auto& [count, why] :
       {std::pair{r.degenerate, " degenerate"}, {r.duplicate, " duplicate"}, {dropped, " not orientable"}}) {
    if (count) what += between + std::to_string(count) + why;
    if (count) between = ", ";
  }
  return what;
}

std::vector<RepairRow> table_of(const CleanReport& r, const CleanOptions& options) {
  char within[64];
  std::snprintf(within, sizeof within, "vertices merged with one within %g", options.weld);
  const bool keep = options.keep_sheets;
  return {
      {"welded", r.welded, "vertices welded with an equal one"},
      {"welded_near", r.welded_near, within},
      {"unreferenced", r.unreferenced, "unreferenced vertices dropped"},
      {"degenerate", r.degenerate, "degenerate triangles removed"},
      {"duplicate", r.duplicate, "duplicate triangles dropped"},
      {"flipped", r.flipped, "triangles turned round"},
      {"nonorientable", (int)r.nonorientable.size(), "non-orientable components dropped"},
      {"nonmanifold_edges", r.nonmanifold_edges,
       keep ? "non-manifold edges kept as model edges" : "non-manifold edges split into sheets"},
      {"nonmanifold_vertices", r.nonmanifold_vertices,
       keep ? "vertices of several fans kept" : "vertices of several fans split into a copy for each"},
      {"copies", r.copies, "copies of vertices, which keep sheets and fans apart"},
      {"sheet_patches", (int)r.sheet_patches.size(), "patches more, one for each of the sheets that meet"},
      {"flat", r.flat, "triangles of zero area left in"},
      {"dropped_components", r.dropped_components, "smaller components dropped"},
      {"dropped_triangles", r.dropped_triangles, "triangles dropped with them"},
      {"holes_filled", r.holes_filled, "holes filled"},
      {"hole_triangles", r.hole_triangles, "triangles added in holes"},
      {"holes_left", r.holes_left,
       "holes left open, along non-manifold edges or where filling would double an edge"},
  };
}

Surface surface_of_culprits(const CleanReport& report, const Mesh& input) {
  Surface s;
  std::vector<int> number(input.points.size(), -1), patch, origin;
  for (const Culprit& c : report.culprits) {
    Tri t = input.tris[c.triangle];
    for (int& v : t) {
      if (number[v] < 0) {
        number[v] = (int)s.points.size();
        s.points.push_back(input.points[v]);
      }
      v = number[v];
    }
    s.tris.push_back(t);
    patch.push_back((int)c.fault + 1);
    origin.push_back(c.triangle);
  }
  s.vertex.rows = s.points.size();
  s.face.set("patch", std::move(patch));
  s.face.set("origin", std::move(origin));
  return s;
}

}  // namespace meshpipe
