// SPDX-License-Identifier: BSD-3-Clause
// Numbers as text.
#pragma once
#include <charconv>
#include <cstdio>
#include <string>

namespace meshpipe {

/// Six digits, without zeros that say nothing: "0.25", "2e-08"; lengths have any unit.
inline std::string shown(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

struct Vec3;
/// The coordinates: "0.25 0 -1".
std::string shown(const Vec3& place);

/// As std::from_chars, also for doubles where the library reads integers only (libc++ before 20).
template <class T>
std::from_chars_result from_chars(const char* first, const char* last, T& value) {
  return std::from_chars(first, last, value);
}
#ifndef __cpp_lib_to_chars
std::from_chars_result from_chars(const char* first, const char* last, double& value);
#endif

}  // namespace meshpipe
