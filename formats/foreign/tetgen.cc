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

/// The points, then the facets, each by write_facet(text, triangle), then holes and regions.
template <class F>
static std::string write_facets(const Stream& stream, F&& write_facet) {
  const Surface& s = stream.surface;
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
  for (std::size_t t = 0; t < s.tris.size(); ++t) write_facet(out, t);
  if (!has_sheets(stream)) return out + "0\n0\n";
  const RegionSeeds seeds = region_seeds(s);
  append_seeds(out, seeds, true);
  append_seeds(out, seeds, false);
  return out;
}

static void append_corners(std::string& out, const Tri& t) {
  out += '3';
  for (int v : t) {
    out += ' ';
    append(out, static_cast<long long>(v) + 1);
  }
}

std::string write_poly(const Stream& stream, bool) {
  const std::vector<int> patch = patches_of(stream);
  return write_facets(stream, [&](std::string& out, std::size_t t) {
    out += "1 0 ";
    append(out, static_cast<long long>(patch[t]));
    out += '\n';
    append_corners(out, stream.surface.tris[t]);
    out += '\n';
  });
}

std::string write_smesh(const Stream& stream, bool) {
  const std::vector<int> patch = patches_of(stream);
  return write_facets(stream, [&](std::string& out, std::size_t t) {
    append_corners(out, stream.surface.tris[t]);
    out += ' ';
    append(out, static_cast<long long>(patch[t]));
    out += '\n';
  });
}

}  // namespace meshpipe
