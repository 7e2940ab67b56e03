// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/triangle_count.h"

#include <cmath>

namespace meshpipe {

double size_for_count(double area, double n) {
  // an equilateral triangle of edge h has area h^2 sqrt(3) / 4
  return std::sqrt(4 * area / (std::sqrt(3.0) * n));
}

double count_for_size(const Mesh& mesh, const std::vector<double>& size) {
  double n = 0;
  for (const Tri& t : mesh.tris) {
    const double h = (size[t[0]] + size[t[1]] + size[t[2]]) / 3;
    n += norm(area_vector(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]])) / (h * h);
  }
  return 2 / std::sqrt(3.0) * n;
}

}  // namespace meshpipe
