// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/normals.h"

#include "lib/core/connectivity.h"

namespace meshpipe {

std::vector<Vec3> face_normals(const Mesh& mesh) {
  constexpr std::size_t worth_threads = 30000;  // triangles: 0.3 ms on one thread
  std::vector<Vec3> normal(mesh.tris.size());
#pragma omp parallel for schedule(static) if (normal.size() > worth_threads)
  for (std::size_t t = 0; t < normal.size(); ++t) normal[t] = normalized(area_vector(mesh, (int)t));
  return normal;
}

std::vector<Vec3> vertex_area_vectors(const Mesh& mesh) {
  std::vector<Vec3> sum(mesh.points.size());
  for (std::size_t t = 0; t < mesh.tris.size(); ++t) {
    const Vec3 n = area_vector(mesh, (int)t);
    for (int v : mesh.tris[t]) sum[v] = sum[v] + n;
  }
  return sum;
}

std::vector<double> vertex_areas(const Mesh& mesh) {
  std::vector<double> area(mesh.points.size(), 0);
  for (std::size_t t = 0; t < mesh.tris.size(); ++t)
    for (int v : mesh.tris[t]) area[v] += triangle_area(mesh, (int)t) / 3;
  return area;
}

std::vector<Vec3> vertex_normals(const Mesh& mesh) {
  std::vector<Vec3> normal = vertex_area_vectors(mesh);
  for (Vec3& n : normal) n = normalized(n);
  return normal;
}

}  // namespace meshpipe
