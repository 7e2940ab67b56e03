// SPDX-License-Identifier: BSD-3-Clause
// Numbers in messages and pictures.
#pragma once
#include <cstdio>
#include <string>

namespace meshpipe {

/// Six digits, without zeros that say nothing: "0.25", "2e-08"; lengths have any unit.
inline std::string shown(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

}  // namespace meshpipe
