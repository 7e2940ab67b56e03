// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream/model_edges.h"

#include <algorithm>

#include "formats/stream/model_lines.h"

namespace meshpipe {
namespace {

constexpr const char* end_columns[6] = {"xa", "ya", "za", "xb", "yb", "zb"};

void add(ModelSegments& s, Vec3 a, Vec3 b, int tag, int ridge, int required) {
  const int n = static_cast<int>(s.points.size());
  s.points.push_back(a);
  s.points.push_back(b);
  s.tris.push_back({n, n + 1, n + 1});
  s.tag.push_back(tag);
  s.ridge.push_back(ridge);
  s.required.push_back(required);
}

}  // namespace

ModelSegments segments_between(const std::vector<Vec3>& points, const std::vector<LineEdge>& edges) {
  ModelSegments s;
  for (const LineEdge& e : edges) add(s, points[e.a], points[e.b], e.tag, e.ridge, e.required);
  return s;
}

ModelSegments segments_of(const Stream& mesh) {
  if (mesh.surface.tris.empty()) return read_model_edges(mesh);
  return segments_between(mesh.surface.points, model_lines(mesh));
}

ModelSegments read_model_edges(const Stream& stream) {
  ModelSegments s;
  const Table* table = stream.find("model_edge");
  if (!table) return s;
  const auto& tag = table->get<int>("tag");
  const std::vector<double>* c[6];
  for (int k = 0; k < 6; ++k) c[k] = &table->get<double>(end_columns[k]);
  const auto* ridge = table->has("ridge") ? &table->get<int>("ridge") : nullptr;
  const auto* required = table->has("required") ? &table->get<int>("required") : nullptr;
  for (std::size_t i = 0; i < table->rows; ++i)
    add(s, {(*c[0])[i], (*c[1])[i], (*c[2])[i]}, {(*c[3])[i], (*c[4])[i], (*c[5])[i]}, tag[i],
        ridge ? (*ridge)[i] : 1, required ? (*required)[i] : 0);
  return s;
}

void write_model_edges(Stream& stream, const ModelSegments& segments) {
  stream.erase("model_edge");
  if (segments.tris.empty()) return;
  std::vector<double> c[6];
  for (const Tri& t : segments.tris)
    for (int end = 0; end < 2; ++end) {
      const Vec3 p = segments.points[t[end]];
      const double x[3] = {p.x, p.y, p.z};
      for (int k = 0; k < 3; ++k) c[3 * end + k].push_back(x[k]);
    }
  Table table{"model_edge", 0, {}};
  table.set("tag", segments.tag);
  for (int k = 0; k < 6; ++k) table.set(end_columns[k], std::move(c[k]));
  if (std::count(segments.ridge.begin(), segments.ridge.end(), 0)) table.set("ridge", segments.ridge);
  if (std::count(segments.required.begin(), segments.required.end(), 1))
    table.set("required", segments.required);
  stream.set(std::move(table));
}

void append(ModelSegments& segments, const ModelSegments& more) {
  for (std::size_t i = 0; i < more.tris.size(); ++i)
    add(segments, more.points[more.tris[i][0]], more.points[more.tris[i][1]], more.tag[i], more.ridge[i],
        more.required[i]);
}

}  // namespace meshpipe
