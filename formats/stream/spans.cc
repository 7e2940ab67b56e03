// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream/spans.h"

#include "lib/core/error.h"

namespace meshpipe {

void append_tris(std::vector<Tri>& to, const std::vector<Tri>& from, std::size_t first) {
  for (const Tri& t : from)
    to.push_back(
        {t[0] + static_cast<int>(first), t[1] + static_cast<int>(first), t[2] + static_cast<int>(first)});
}

std::vector<Span> spans_of(const Table& table, const char* counts, std::size_t rows) {
  std::vector<Span> spans;
  long long sum = 0;
  for (int count : table.get<int>(counts)) {
    const long long first = sum;
    sum += count;
    if (count < 0 || sum > static_cast<long long>(rows)) break;
    spans.push_back({static_cast<int>(first), static_cast<int>(sum)});
  }
  if (spans.size() != table.rows || sum != static_cast<long long>(rows))
    throw BadInput(std::string("column '") + counts + "' of table '" + table.name +
                   "' counts others than the " + std::to_string(rows) + " that there are");
  return spans;
}

std::vector<Tri> tris_of(const std::vector<Tri>& tris, const Span& rows, const Span& vertices) {
  std::vector<Tri> own = rows.of(tris);
  for (std::size_t t = 0; t < own.size(); ++t)
    for (int& v : own[t]) {
      if (v < vertices.first || v >= vertices.last)
        throw BadInput("triangle " + std::to_string(rows.first + static_cast<int>(t)) +
                       " uses a vertex that is not its tile's or share's");
      v -= vertices.first;
    }
  return own;
}

Table table_of(const char* name, const Mesh& mesh, bool of_points) {
  Table table{name, 0, {}};
  for (int i = 0; i < 3; ++i) {
    std::vector<double> x;
    std::vector<int> corner;
    if (of_points)
      for (Vec3 p : mesh.points) x.push_back(i == 0 ? p.x : i == 1 ? p.y : p.z);
    else
      for (const Tri& t : mesh.tris) corner.push_back(t[i]);
    if (of_points)
      table.set(std::string(1, "xyz"[i]), std::move(x));
    else
      table.set(std::string(1, "abc"[i]), std::move(corner));
  }
  return table;
}

Mesh mesh_from(const Table& points, const Table& faces) {
  Mesh mesh;
  const auto &x = points.get<double>("x"), &y = points.get<double>("y"), &z = points.get<double>("z");
  const auto &a = faces.get<int>("a"), &b = faces.get<int>("b"), &c = faces.get<int>("c");
  for (std::size_t i = 0; i < points.rows; ++i) mesh.points.push_back({x[i], y[i], z[i]});
  for (std::size_t i = 0; i < faces.rows; ++i) mesh.tris.push_back({a[i], b[i], c[i]});
  return mesh;
}

}  // namespace meshpipe
