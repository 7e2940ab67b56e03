// SPDX-License-Identifier: BSD-3-Clause
// Data of vertices and faces: arrays of foreign formats, with any number of components, and columns of the
// stream, with one component of type uchar, int or double and a name without blanks.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "formats/stream.h"

namespace meshpipe {

using Data = decltype(Column::data);

/// Values row by row, `components` per row.
struct Array {
  std::string name;
  int components = 1;
  Data data;
  std::size_t size() const {
    return std::visit([](const auto& v) { return v.size(); }, data);
  }
  std::size_t rows() const { return size() / components; }
};

/// Converts n values at(i) of any arithmetic type T to one of the stream: bytes to uchar, other whole numbers
/// to int if all fit, all else to double.
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

/// Converts values to ints; returns false if one is not whole or does not fit.
bool whole_numbers(const Data& data, std::vector<int>& out);

/// Returns the rows row[0], row[1] ... of an array.
Array gather(const Array& array, const std::vector<int>& row);

/// Adds an array to a table of the stream as columns NAME, or NAME.0, NAME.1, ... for components, or red
/// green blue for three bytes named `color`. Blanks in names become %20; names that are taken get _2, _3, ...
/// Columns that the stream specifies get their type if the values allow. An array with a number that is not
/// finite is left out, with a remark in the stream.
void add_columns(Stream& stream, Table& table, std::size_t rows, Array array);

/// Adds a remark to the stream on data that was left out, and why.
void leave_out(Stream& stream, const Table& table, std::string_view name, const std::string& why);

/// The columns of a table that are the components of one array, or a single column: the inverse of
/// add_columns.
struct Group {
  std::string name;
  std::vector<const Column*> columns;
};
std::vector<Group> groups_of(const Table& table);

/// Returns the values of a group, row by row.
Array array_of(const Group& group);

}  // namespace meshpipe
