// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/tetgen.h"

#include "formats/foreign/polygons.h"
#include "formats/text.h"

namespace meshpipe {

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
  return out + "0\n0\n";
}

}  // namespace meshpipe
