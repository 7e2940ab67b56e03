// SPDX-License-Identifier: BSD-3-Clause
// Rearranges and repeats rows of columns and tables.
#pragma once
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Returns a column whose row i is row rows[i] of another; rows may be left out or repeated.
template <class T>
std::vector<T> rearranged(const std::vector<T>& column, const std::vector<int>& rows) {
  std::vector<T> taken;
  taken.reserve(rows.size());
  for (int row : rows) taken.push_back(column[row]);
  return taken;
}

/// Returns a table whose row i is row rows[i] of another.
inline Table rows_of(const Table& table, const std::vector<int>& rows) {
  Table taken{table.name, rows.size(), {}};
  for (const Column& c : table.columns)
    std::visit([&](const auto& from) { taken.columns.push_back({c.name, rearranged(from, rows)}); }, c.data);
  return taken;
}
/// Makes row i of a table what row rows[i] was.
inline void take_rows(Table& table, const std::vector<int>& rows) { table = rows_of(table, rows); }

/// A row between two others, t = 0: a, 1: b.
struct RowBetween {
  int a, b;
  double t;
};
/// Appends rows between others: doubles interpolated, other types copied from the nearer row (t = 0.5: b).
inline void interpolate_rows(Table& table, const std::vector<RowBetween>& rows) {
  for (Column& c : table.columns)
    std::visit(
        [&]<class T>(std::vector<T>& values) {
          for (const RowBetween& r : rows)
            if constexpr (std::is_same_v<T, double>)
              values.push_back((1 - r.t) * values[r.a] + r.t * values[r.b]);
            else
              values.push_back(values[r.t < 0.5 ? r.a : r.b]);
        },
        c.data);
  table.rows += rows.size();
}
/// Appends copies of these rows.
inline void append_rows(Table& table, const std::vector<int>& rows) {
  for (Column& c : table.columns)
    std::visit(
        [&](auto& values) {
          for (int row : rows) values.push_back(values[row]);
        },
        c.data);
  table.rows += rows.size();
}

}  // namespace meshpipe
