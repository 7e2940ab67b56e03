// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/feature_edges.h"

#include <algorithm>
#include <array>

#include "formats/formats.h"
#include "formats/stream/model_lines.h"
#include "formats/text.h"
#include "lib/core/error.h"

namespace meshpipe {
namespace {

/// Segments between points of their own, sorted by label.
struct Segments {
  std::vector<Vec3> points;
  std::vector<std::array<long long, 2>> ends;
  std::vector<int> tags;
};

Segments segments_of_lines(const Stream& stream) {
  std::vector<LineEdge> edges = model_lines(stream);
  std::stable_sort(edges.begin(), edges.end(),
                   [](const LineEdge& x, const LineEdge& y) { return x.tag < y.tag; });
  Segments s;
  std::vector<long long> number(stream.surface.points.size(), -1);
  for (const LineEdge& e : edges) {
    for (int v : {e.a, e.b})
      if (number[v] < 0) {
        number[v] = static_cast<long long>(s.points.size());
        s.points.push_back(stream.surface.points[v]);
      }
    s.ends.push_back({number[e.a], number[e.b]});
    s.tags.push_back(e.tag);
  }
  return s;
}

void append_pair(std::string& out, const char* before, long long a, long long b, const char* after) {
  out += before;
  append(out, a);
  out += ' ';
  append(out, b);
  out += after;
}

/// One group per label, named like the line.
std::string obj_lines(const Segments& s, const Stream& stream) {
  std::string out;
  for (const Vec3& p : s.points) append_point(out, "v ", p);
  for (std::size_t i = 0; i < s.ends.size(); ++i) {
    if (i == 0 || s.tags[i] != s.tags[i - 1]) {
      const std::string name = one_line(stream.name_of(1, s.tags[i]));
      out += "g " + (name.empty() ? "line_" + std::to_string(s.tags[i]) : name) + '\n';
    }
    append_pair(out, "l ", s.ends[i][0] + 1, s.ends[i][1] + 1, "\n");
  }
  return out;
}

std::string vtk_lines(const Segments& s) {
  const std::string n = std::to_string(s.ends.size());
  std::string out = "# vtk DataFile Version 3.0\nmeshpipe\nASCII\nDATASET POLYDATA\nPOINTS " +
                    std::to_string(s.points.size()) + " double\n";
  for (const Vec3& p : s.points) append_point(out, "", p);
  out += "LINES " + n + ' ' + std::to_string(3 * s.ends.size()) + '\n';
  for (const auto& [a, b] : s.ends) append_pair(out, "2 ", a, b, "\n");
  out += "CELL_DATA " + n + "\nSCALARS tag int 1\nLOOKUP_TABLE default\n";
  for (int tag : s.tags) out += std::to_string(tag) + '\n';
  return out;
}

std::string emesh(const Segments& s) {
  std::string out =
      "FoamFile\n{\n    version 2.0;\n    format ascii;\n    class featureEdgeMesh;\n    object "
      "edges;\n}\n\n" +
      std::to_string(s.points.size()) + "\n(\n";
  for (const Vec3& p : s.points) {
    append_point(out, "(", p);
    out.back() = ')';
    out += '\n';
  }
  out += ")\n\n" + std::to_string(s.ends.size()) + "\n(\n";
  for (const auto& [a, b] : s.ends) append_pair(out, "(", a, b, ")\n");
  return out + ")\n";
}

}  // namespace

std::string write_feature_edges(const Stream& stream, const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension != ".obj" && extension != ".vtk" && extension != ".emesh")
    throw BadUsage("'" + path + "' has extension '" + extension +
                   "', expected .obj, .vtk or .eMesh for lines");
  const Segments s = segments_of_lines(stream);
  if (s.ends.empty()) throw NotAdmissible("the surface has no model edges; run mfeature first");
  if (extension == ".obj") return obj_lines(s, stream);
  return extension == ".vtk" ? vtk_lines(s) : emesh(s);
}

}  // namespace meshpipe
