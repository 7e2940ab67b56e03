// SPDX-License-Identifier: BSD-3-Clause
// Rearranges and repeats rows of a table.
#pragma once
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Makes row i of a table what row rows[i] was; rows may be left out or repeated.
inline void take_rows(Table& table, const std::vector<int>& rows) {
  for (Column& c : table.columns)
    std::visit(
        [&](auto& old) {
          std::remove_reference_t<decltype(old)> values(rows.size());
          for (std::size_t i = 0; i < rows.size(); ++i) values[i] = old[rows[i]];
          old = std::move(values);
        },
        c.data);
  table.rows = rows.size();
}

/// A row between two others, t = 0: a, 1: b.
struct RowBetween {
  int a, b;
  double t;
};
/// Appends rows between others: numbers are interpolated, labels those of the nearer row.
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
/// Appends copies of rows.
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
