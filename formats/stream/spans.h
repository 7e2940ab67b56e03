// SPDX-License-Identifier: BSD-3-Clause
// Several meshes in one table, one after the other; for formats/stream/ only.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

/// Appends triangles, with the numbers of their vertices raised.
void append_tris(std::vector<Tri>& to, const std::vector<Tri>& from, std::size_t first);

/// Rows of a table, from `first` to before `last`.
struct Span {
  int first = 0, last = 0;
  int size() const { return last - first; }
  template <class T>
  std::vector<T> of(const std::vector<T>& column) const {
    return {column.begin() + first, column.begin() + last};
  }
};

/// Returns the rows that each row of a table stands for, by its column `counts`.
/// Throws: BadInput if they are not all of the `rows`.
std::vector<Span> spans_of(const Table& table, const char* counts, std::size_t rows);

/// Returns some triangles with the numbers of these vertices. Throws: BadInput for other vertices.
std::vector<Tri> tris_of(const std::vector<Tri>& tris, const Span& rows, const Span& vertices);

/// The points or the triangles as a table, and back.
Table table_of(const char* name, const Mesh& mesh, bool of_points);

Mesh mesh_from(const Table& points, const Table& faces);

}  // namespace meshpipe
