// SPDX-License-Identifier: BSD-3-Clause
// Values in the bytes of binary formats, of either byte order.
#pragma once
#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

namespace meshpipe {

static_assert(std::endian::native == std::endian::little);

/// Returns the value whose bytes begin at `at`, which need not be aligned; the bytes are reversed if `swap`.
template <class T>
T load(const char* at, bool swap = false) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, at, sizeof(T));
  if (swap) std::reverse(bytes, bytes + sizeof(T));
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

/// Appends the value's bytes, reversed if `swap`.
template <class T>
void put(std::string& out, T value, bool swap = false) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  if (swap) std::reverse(bytes, bytes + sizeof(T));
  out.append(bytes, sizeof(T));
}

}  // namespace meshpipe
