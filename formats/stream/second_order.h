// SPDX-License-Identifier: BSD-3-Clause
// Triangles of second order: the stream's table mid_vertex, a node within each edge.
#pragma once
#include "formats/stream.h"
#include "lib/lift/lift.h"

namespace meshpipe {

/// Adds or replaces the table mid_vertex.
void write_mid_points(Stream& stream, const std::vector<MidPoint>& points);

/// Renumbers the vertices of table mid_vertex, if there is one (`number`: the new row of each); of equal
/// edges the first stays. Throws: BadInput for a vertex that does not exist.
void renumber_mid_points(Stream& stream, const std::vector<int>& number);

/// Views a stream as elements of first or second order, for writers.
class SecondOrder {
 public:
  /// Keeps a reference to the stream. Throws: BadInput if table mid_vertex is not in order or lacks an edge.
  explicit SecondOrder(const Stream& stream);
  /// Returns whether the stream has the table.
  explicit operator bool() const { return table_ != nullptr; }
  /// Returns the stream's surface; with the table, nodes within edges follow the vertices. The data of a node
  /// is the mean of the ends of its edge for doubles, else that of the first end.
  const Surface& surface() const { return table_ ? surface_ : stream_.surface; }
  /// Returns the row of the node within an edge. Requires: the table.
  int node(int a, int b) const;

 private:
  const Stream& stream_;
  const Table* table_;
  std::vector<std::array<int, 2>> edges_;
  Surface surface_;
};

}  // namespace meshpipe
