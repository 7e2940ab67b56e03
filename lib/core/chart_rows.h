// SPDX-License-Identifier: BSD-3-Clause
// The rows of table chart_vertex by vertex.
#pragma once
#include <numeric>
#include <string>
#include <vector>

#include "lib/core/error.h"
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
        start_(n_vertices + 1, 0),
        row_(vertex_.size()) {
    for (int v : vertex_) ++start_[v + 1];
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    std::vector<int> at(start_.begin(), start_.end() - 1);
    for (int i = 0; i < static_cast<int>(vertex_.size()); ++i) row_[at[vertex_[i]]++] = i;
  }
  /// Throws: BadInput if the part has no row for the vertex.
  Vec2 uv(int part, int vertex) const {
    for (int k = start_[vertex]; k < start_[vertex + 1]; ++k)
      if (part_[row_[k]] == part) return {u_[row_[k]], v_[row_[k]]};
    throw BadInput("chart_vertex has no row for vertex " + std::to_string(vertex) + " in part " +
                   std::to_string(part));
  }

 private:
  const std::vector<int>&part_, &vertex_;
  const std::vector<double>&u_, &v_;
  std::vector<int> start_, row_;
};

}  // namespace meshpipe
