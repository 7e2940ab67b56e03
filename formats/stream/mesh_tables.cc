// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream/mesh_tables.h"

namespace meshpipe {

Table point_table(const char* name, const Mesh& mesh) {
  Table table{name, 0, {}};
  for (const auto& [column, axis] : {std::pair("x", &Vec3::x), {"y", &Vec3::y}, {"z", &Vec3::z}}) {
    std::vector<double> values(mesh.points.size());
    for (std::size_t v = 0; v < values.size(); ++v) values[v] = mesh.points[v].*axis;
    table.set(column, std::move(values));
  }
  return table;
}

Table triangle_table(const char* name, const Mesh& mesh) {
  Table table{name, 0, {}};
  for (int i = 0; i < 3; ++i) {
    std::vector<int> corner(mesh.tris.size());
    for (std::size_t t = 0; t < corner.size(); ++t) corner[t] = mesh.tris[t][i];
    table.set(std::string(1, "abc"[i]), std::move(corner));
  }
  return table;
}

Mesh mesh_from(const Table& points, const Table& triangles) {
  Mesh mesh;
  const auto &x = points.get<double>("x"), &y = points.get<double>("y"), &z = points.get<double>("z");
  const auto &a = triangles.get<int>("a"), &b = triangles.get<int>("b"), &c = triangles.get<int>("c");
  mesh.points.resize(points.rows);
  mesh.tris.resize(triangles.rows);
  for (std::size_t i = 0; i < points.rows; ++i) mesh.points[i] = {x[i], y[i], z[i]};
  for (std::size_t i = 0; i < triangles.rows; ++i) mesh.tris[i] = {a[i], b[i], c[i]};
  return mesh;
}

}  // namespace meshpipe
