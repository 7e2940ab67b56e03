// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/geo.h"

#include <algorithm>

#include "formats/foreign/polygons.h"
#include "formats/stream/region_tables.h"

namespace meshpipe {

std::string write_geo(const Stream& stream, bool) {
  const long long shift = shift_to_positive(by_patch(stream));
  struct Side {
    int label, patch;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  for (const SheetPatch& s : read_sheets(stream))
    for (int label : {s.front, s.back})
      if (s.front != s.back && label > 0) sides.push_back({label, s.patch});
  std::sort(sides.begin(), sides.end());
  std::string out = "// after the .msh file of this surface: gmsh -3 FILE.msh FILE.geo -o VOLUME.msh\n";
  if (sides.empty())
    return out + "Surface Loop(1) = Surface{:};\nVolume(1) = {1};\nPhysical Volume(\"region-1\", 1) = {1};\n";
  for (std::size_t i = 0; i < sides.size();) {
    const std::string label = std::to_string(sides[i].label);
    out += "Surface Loop(" + label + ") = {";
    for (const char* between = ""; i < sides.size() && std::to_string(sides[i].label) == label;
         ++i, between = ", ")
      out += between + std::to_string(sides[i].patch + shift);
    out += "};\nVolume(" + label + ") = {" + label + "};\nPhysical Volume(\"region-" + label + "\", " +
           label + ") = {" + label + "};\n";
  }
  return out;
}

}  // namespace meshpipe
