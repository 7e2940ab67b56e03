// SPDX-License-Identifier: BSD-3-Clause
// What the header of a stream declares.
#pragma once
#include <bit>
#include <charconv>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "lib/core/number.h"

namespace meshpipe {

static_assert(std::endian::native == std::endian::little, "the binary stream is little endian");

/// Types of values, in the order of the alternatives of Column::data.
enum class Type { uchar, integer, real };
constexpr const char* type_names[] = {"uchar", "int", "double"};
constexpr std::size_t type_sizes[] = {1, 4, 8};
/// Rows of an element: half-edges 3 t + i must fit into an int.
constexpr long long max_rows = 715827882;
constexpr int most_unit = 1074;  // exponent of the smallest double

struct Property {
  Type type;
  std::string name;
};
struct Element {
  std::string name;
  long long rows = 0;
  bool has_list = false;
  std::vector<Property> properties;
  std::size_t first = 0;   ///< line (ascii) or byte (binary) of the first row, for messages
  std::size_t stride = 0;  ///< bytes per row of a binary stream
};

/// Returns the words of a line, separated by blanks.
std::vector<std::string_view> words(std::string_view line);
/// Parses the whole of a word as a number; returns whether it is one.
template <class T>
bool parse(std::string_view word, T& value) {
  const auto r = from_chars(word.data(), word.data() + word.size(), value);
  return r.ec == std::errc() && r.ptr == word.data() + word.size();
}

}  // namespace meshpipe
