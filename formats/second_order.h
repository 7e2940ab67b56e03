// SPDX-License-Identifier: BSD-3-Clause
// Triangles of second order: the stream's table mid_vertex, a node within each edge.
#pragma once
#include "formats/stream.h"
#include "lib/curved.h"

namespace meshpipe {

/// Adds or replaces the table mid_vertex.
void write_mid_points(Stream& stream, const std::vector<MidPoint>& points);

/// write_lifted for a mesh on its reference, whose vertices are first raised to the smooth surface if the
/// reference has face column `curved`; then the table mid_vertex, if `second_order`. Returns what had to stay
/// flat or straight, in words; empty if nothing.
std::string write_on_reference(Stream& stream, LiftedMesh& mesh, const Surface& reference, bool second_order);

/// What writers of elements need.
class SecondOrder {
 public:
  /// Throws BadInput if the table is there, but not in order, or an edge of the surface is not in it. Keeps a
  /// reference to the stream.
  explicit SecondOrder(const Stream& stream);
  /// False if the stream has no such table.
  explicit operator bool() const { return table_ != nullptr; }
  /// The stream's surface; with a table, the nodes within edges follow its vertices. Their data is the mean
  /// of that at the ends of the edge, or that of its first end where it is no double.
  const Surface& surface() const { return table_ ? surface_ : stream_.surface; }
  /// The node within an edge. Precondition: there is a table.
  int node(int a, int b) const;

 private:
  const Stream& stream_;
  const Table* table_;
  std::vector<std::array<int, 2>> edges_;
  Surface surface_;
};

}  // namespace meshpipe
