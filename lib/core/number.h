// SPDX-License-Identifier: BSD-3-Clause
// Numbers as text.
#pragma once
#include <charconv>
#include <cstdio>
#include <string>

namespace meshpipe {

/// Returns a number with at most six digits: "0.25", "2e-08".
inline std::string shown(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

/// Returns a positive number of three digits that is not below x.
double rounded_up(double x);

struct Vec3;
/// Returns the coordinates as text: "0.25 0 -1".
std::string shown(const Vec3& place);

/// Parses a number as std::from_chars, also doubles where the library (libc++ before 20) has integers only.
template <class T>
std::from_chars_result from_chars(const char* first, const char* last, T& value) {
  return std::from_chars(first, last, value);
}
#ifndef __cpp_lib_to_chars
std::from_chars_result from_chars(const char* first, const char* last, double& value);
#endif

}  // namespace meshpipe
