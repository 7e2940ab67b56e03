// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/number.h"

#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdlib>

#include "lib/core/vec.h"

namespace meshpipe {

std::string shown(const Vec3& place) { return shown(place.x) + ' ' + shown(place.y) + ' ' + shown(place.z); }

double rounded_up(double x) {
  const double unit = std::pow(10, std::floor(std::log10(x)) - 2);
  return std::ceil(x / unit) * unit;
}

#ifndef __cpp_lib_to_chars
std::from_chars_result from_chars(const char* first, const char* last, double& value) {
  auto may_belong = [](unsigned char c) { return std::isalnum(c) || c == '.' || c == '+' || c == '-'; };
  const char* end = first;
  while (end < last && may_belong(*end) && *end != 'x' && *end != 'X') ++end;  // hexadecimal ends with its 0
  const std::string text(first, end);  // strtod needs a zero at the end
  if (text.empty() || text[0] == '+') return {first, std::errc::invalid_argument};
  errno = 0;
  char* stop;
  const double x = std::strtod(text.c_str(), &stop);
  const char* const at = first + (stop - text.c_str());
  if (at == first) return {first, std::errc::invalid_argument};
  if (errno == ERANGE && (x == 0 || std::isinf(x))) return {at, std::errc::result_out_of_range};
  value = x;
  return {at, std::errc()};
}
#endif

}  // namespace meshpipe
