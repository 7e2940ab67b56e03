// SPDX-License-Identifier: BSD-3-Clause
// Data of vertices and faces as foreign formats hold them (named arrays of any number of components and any
// type) and the stream's columns: one component, type uchar, int or double, names without blanks.
#pragma once
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "formats/stream.h"

namespace meshpipe {

using Data = decltype(Column::data);

/// Values row by row, `components` a row.
struct Array {
  std::string name;
  int components = 1;
  Data data;
  std::size_t size() const {
    return std::visit([](const auto& v) { return v.size(); }, data);
  }
  std::size_t rows() const { return size() / components; }
};

/// Values of any arithmetic type as the type of the stream that holds them: bytes as uchar, other whole
/// numbers as int if all fit, all else as double. `at(i)` is value i of n.
template <class T, class At>
Data as_data(std::size_t n, const At& at) {
  if constexpr (std::is_same_v<T, std::uint8_t>) {
    std::vector<std::uint8_t> v(n);
    for (std::size_t i = 0; i < n; ++i) v[i] = at(i);
    return v;
  } else {
    if constexpr (std::is_integral_v<T>) {
      std::vector<int> v(n);
      std::size_t i = 0;
      for (; i < n; ++i) {
        const T x = at(i);
        v[i] = static_cast<int>(x);
        if (static_cast<T>(v[i]) != x || (v[i] < 0) != (x < 0)) break;
      }
      if (i == n) return v;
    }
    std::vector<double> v(n);
    for (std::size_t i = 0; i < n; ++i) v[i] = static_cast<double>(at(i));
    return v;
  }
}

/// The values as whole numbers: false if one is not, or is beyond int.
bool whole_numbers(const Data& data, std::vector<int>& out);

/// Rows `row[i]` of an array, one after the other.
Array gather(const Array& array, const std::vector<int>& row);

/// Adds an array to a table of `rows` rows: blanks in its name as %20, components as NAME.0, NAME.1, ...;
/// an array `color` of three bytes as red green blue; a name that is taken with _2, _3, ... after it. Columns
/// the stream knows get the type it wants if their values allow. Numbers that are not finite cannot be held:
/// then the array is left out, which a remark of the stream says.
void add_columns(Stream& stream, Table& table, std::size_t rows, Array array);

/// What the stream says of data that was left out, and why.
void leave_out(Stream& stream, const Table& table, std::string_view name, const std::string& why);

/// Columns that are the components of one array, the inverse of add_columns; other columns alone.
struct Group {
  std::string name;
  std::vector<const Column*> columns;
};
std::vector<Group> groups_of(const Table& table);

/// The values of a group, row by row.
Array array_of(const Group& group);

}  // namespace meshpipe
