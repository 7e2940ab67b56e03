// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/eigenvectors.h"

namespace meshpipe {

std::array<Vec3, 3> eigenvectors(Matrix3 m) {
  constexpr int sweeps = 12;  // of which about six change anything
  double axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int turn = 0; turn < 3 * sweeps; ++turn) {
    const int p = turn % 3, q = (p + 1) % 3;
    if (m[p][q] == 0) continue;
    const double angle = 0.5 * std::atan2(2 * m[p][q], m[p][p] - m[q][q]);
    const double c = std::cos(angle), s = std::sin(angle);
    auto rotate = [&](double& x, double& y) {
      const double before = x;
      x = c * before + s * y;
      y = c * y - s * before;
    };
    for (int k = 0; k < 3; ++k) rotate(m[k][p], m[k][q]);
    for (int k = 0; k < 3; ++k) rotate(m[p][k], m[q][k]);
    for (int k = 0; k < 3; ++k) rotate(axes[p][k], axes[q][k]);
  }
  std::array<Vec3, 3> vectors;
  for (int k = 0; k < 3; ++k) vectors[k] = {axes[k][0], axes[k][1], axes[k][2]};
  return vectors;
}

}  // namespace meshpipe
