// SPDX-License-Identifier: BSD-3-Clause
#include "lib/size.h"

#include <cmath>

namespace meshpipe {

double size_for_count(double area, double n) {
  // an equilateral triangle of edge h has area h^2 sqrt(3) / 4
  return std::sqrt(4 * area / (std::sqrt(3.0) * n));
}

}  // namespace meshpipe
