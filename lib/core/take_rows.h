// SPDX-License-Identifier: BSD-3-Clause
// Rearranges the rows of a table.
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

}  // namespace meshpipe
