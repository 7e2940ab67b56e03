// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/number_source.h"

#include <cmath>
#include <limits>

#include "lib/core/error.h"

namespace meshpipe {

double NumberSource::real(const char* what) {
  return binary ? finite(get<double>(what), what) : text.number(what);
}

double NumberSource::finite(double x, const char* what) const {
  if (!std::isfinite(x)) fail("expected " + std::string(what) + ", found a number that is not finite");
  return x;
}

Vec3 NumberSource::point() {
  const double x = real("a coordinate"), y = real("a coordinate"), z = real("a coordinate");
  return {x, y, z};
}

int NumberSource::count(const char* what, bool is_wide, std::size_t least_binary, std::size_t least_text) {
  if (!binary) return text.count(what, least_text);
  const long long n = is_wide ? wide(what) : integer(what);
  if (n < 0) fail(std::string(what) + " is " + std::to_string(n));
  if (n > std::numeric_limits<int>::max() || n * least_binary > left())
    fail(std::string(what) + " is " + std::to_string(n) + ", but only " + std::to_string(left()) +
         " bytes follow");
  return static_cast<int>(n);
}

void NumberSource::skip(std::size_t n, const char* what) {
  if (n > left()) ends(what, n);
  text.skip(n);
}

void NumberSource::fail(const std::string& what) const {
  if (!binary) text.fail(what);
  throw BadInput(where_ + ":" + std::to_string(position()) + ": " + what);
}

void NumberSource::ends(const char* what, std::size_t n) const {
  fail("expected " + std::string(what) + " of " + std::to_string(n) + " bytes, but only " +
       std::to_string(left()) + " are left");
}

}  // namespace meshpipe
