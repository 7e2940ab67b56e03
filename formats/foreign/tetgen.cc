// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/tetgen.h"

#include "formats/foreign/polygons.h"
#include "formats/stream/region_tables.h"
#include "formats/text.h"

namespace meshpipe {

/// Appends the points of the outside within the surface, as holes, or those of the regions with their labels.
static void append_seeds(std::string& out, const RegionSeeds& seeds, bool outside) {
  std::string rows;
  long long count = 0;
  for (std::size_t i = 0; i < seeds.label.size(); ++i) {
    if ((seeds.label[i] <= 0) != outside) continue;
    append(rows, ++count);
    for (double x : {seeds.point[i].x, seeds.point[i].y, seeds.point[i].z}) {
      rows += ' ';
      append(rows, x);
    }
    if (!outside) {
      rows += ' ';
      append(rows, static_cast<long long>(seeds.label[i]));
    }
    rows += '\n';
  }
  append(out, count);
  out += '\n' + rows;
}

std::string write_poly(const Stream& stream, bool) {
  const Surface& s = stream.surface;
  const std::vector<int> patch = patches_of(stream);
  std::string out;
  out.reserve(s.points.size() * 70 + s.tris.size() * 40);
  append(out, static_cast<long long>(s.points.size()));
  out += " 3 0 0\n";
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    append(out, static_cast<long long>(i) + 1);
    append_point(out, " ", s.points[i]);
  }
  append(out, static_cast<long long>(s.tris.size()));
  out += " 1\n";
  for (std::size_t t = 0; t < s.tris.size(); ++t) {
    out += "1 0 ";
    append(out, static_cast<long long>(patch[t]));
    out += "\n3";
    for (int v : s.tris[t]) {
      out += ' ';
      append(out, static_cast<long long>(v) + 1);
    }
    out += '\n';
  }
  if (!has_sheets(stream)) return out + "0\n0\n";
  const RegionSeeds seeds = region_seeds(s);
  append_seeds(out, seeds, true);
  append_seeds(out, seeds, false);
  return out;
}

}  // namespace meshpipe
