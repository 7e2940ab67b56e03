// SPDX-License-Identifier: BSD-3-Clause
// The rows of table chart_vertex by vertex.
#pragma once
#include <string>
#include <vector>

#include "lib/core/error.h"
#include "lib/core/lists.h"
#include "lib/core/mesh.h"

namespace meshpipe {

/// Where the charts have the vertices. Keeps references to the table's columns.
class ChartRows {
 public:
  ChartRows(Table& table, std::size_t n_vertices)
      : part_(table.get<int>("part")),
        vertex_(table.get<int>("vertex")),
        u_(table.get<double>("u")),
        v_(table.get<double>("v")),
        rows_(lists_by((int)n_vertices, vertex_)) {}
  /// Throws: BadInput if the part has no row for the vertex.
  Vec2 uv(int part, int vertex) const {
    for (int r : rows_[vertex])
      if (part_[r] == part) return {u_[r], v_[r]};
    throw BadInput("chart_vertex has no row for vertex " + std::to_string(vertex) + " in part " +
                   std::to_string(part));
  }

 private:
  const std::vector<int>&part_, &vertex_;
  const std::vector<double>&u_, &v_;
  const Lists rows_;
};

}  // namespace meshpipe
