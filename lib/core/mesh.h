// SPDX-License-Identifier: BSD-3-Clause
// The data everything works on: a triangulated surface in flat columns.
//
// Half-edge h = 3*t + i runs from corner i to corner i+1 (mod 3) of triangle t. `opposite[h]` is the
// half-edge of the neighboring triangle along the same edge, or -1 on the border.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "lib/core/vec.h"

namespace meshpipe {

using Tri = std::array<int, 3>;

struct Mesh {
  std::vector<Vec3> points;
  std::vector<Tri> tris;
};

inline int next(int h) { return h % 3 == 2 ? h - 2 : h + 1; }
inline int prev(int h) { return h % 3 == 0 ? h + 2 : h - 1; }
inline int origin(const std::vector<Tri>& tris, int h) { return tris[h / 3][h % 3]; }
inline int target(const std::vector<Tri>& tris, int h) { return tris[h / 3][(h + 1) % 3]; }

/// A named column of one of the stream's three types.
struct Column {
  std::string name;
  std::variant<std::vector<std::uint8_t>, std::vector<int>, std::vector<double>> data;
  std::size_t size() const;
};

/// Columns of equal length, addressed by name.
/// `get<T>(name)` needs the column to be there with this type and throws NotAdmissible otherwise;
/// `set(name, values)` adds or replaces; T is std::uint8_t, int or double.
struct Table {
  std::string name;
  std::size_t rows = 0;
  std::vector<Column> columns;

  const Column* find(std::string_view column) const;
  bool has(std::string_view column) const { return find(column) != nullptr; }
  template <class T>
  std::vector<T>& get(std::string_view column);
  template <class T>
  const std::vector<T>& get(std::string_view column) const;
  /// Requires: values.size() == rows, unless the table has no columns yet (then rows is set).
  template <class T>
  std::vector<T>& set(std::string_view column, std::vector<T> values);
  void erase(std::string_view column);
};

/// A mesh with its vertex and face columns (x y z and the corner indices live in the mesh itself).
/// Usual face columns: int patch, int part, int origin, uchar model. Usual vertex columns: double size.
struct Surface : Mesh {
  Table vertex{"vertex", 0, {}};
  Table face{"face", 0, {}};
};

/// The mesh without columns: its tables have a row for each point and triangle.
Surface surface_of(Mesh mesh);

/// One part of a surface on its own numbers; `vertex[i]`, `face[i]` are the numbers in the whole.
struct SubMesh : Mesh {
  std::vector<int> vertex;
  std::vector<int> face;
};

/// Returns the part of these triangles. `number` is -1 for each point of the mesh, before and after.
SubMesh sub_mesh(const Mesh& mesh, std::vector<int> faces, std::vector<int>& number);

/// Splits a mesh by a label per triangle (0 <= label < n; other labels are left out) in linear time.
/// Corners keep their order; vertices are numbered by first use; a vertex on two parts is in both.
std::vector<SubMesh> split_by_label(const Mesh& mesh, const std::vector<int>& label, int n);

/// Returns per point whether a triangle uses it.
std::vector<char> used_points(const Mesh& mesh);

/// Length of the bounding box's diagonal of the points that are used by a triangle.
double diagonal(const Mesh& mesh);
/// Throws NotAdmissible naming the size of a surface whose areas and volumes would overflow or vanish: with a
/// coordinate beyond 1e50, or smaller than 1e-50 in all directions (but not a point).
void expect_measurable(const Mesh& mesh);
/// Sum of triangle areas.
double total_area(const Mesh& mesh);
/// kappa = 4 sin a sin b sin c / (sin a + sin b + sin c), the paper's eq. (6); 1 equilateral, 0 degenerate.
double kappa(Vec3 a, Vec3 b, Vec3 c);

}  // namespace meshpipe
