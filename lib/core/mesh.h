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

/// Makes a surface without columns of a mesh.
Surface surface_of(Mesh mesh);

/// One part of a surface on its own numbers; `vertex[i]`, `face[i]` are the numbers in the whole.
struct SubMesh : Mesh {
  std::vector<int> vertex;
  std::vector<int> face;
};

/// Returns the part of a mesh that these triangles are, in their order; vertices are numbered by first use.
/// `number`: -1 per point of the mesh, before and after the call (so that many calls share it).
SubMesh sub_mesh(const Mesh& mesh, std::vector<int> faces, std::vector<int>& number);

/// Splits a mesh by a label per triangle into n parts, in linear time; triangles with labels outside 0..n-1
/// are left out. Corners keep their order; vertices, which may be in several parts, are numbered by first
/// use.
std::vector<SubMesh> split_by_label(const Mesh& mesh, const std::vector<int>& label, int n);

/// Returns per point 1 if a triangle uses it, else 0.
std::vector<char> used_points(const Mesh& mesh);

/// Returns the diagonal of the bounding box of the points that triangles use, a length; 0 without any.
double diagonal(const Mesh& mesh);
/// Returns e such that the largest coordinate is from 2^(e-1) to 2^e; 0 if expect_measurable does not throw.
int measurable_unit(const Mesh& mesh);
/// Throws NotAdmissible, naming the size, if areas and volumes of the surface would overflow or vanish: if a
/// coordinate is beyond 1e50, or the surface is smaller than 1e-50 in all directions and not a point.
void expect_measurable(const Mesh& mesh);
/// Returns the sum of the areas of the triangles.
double total_area(const Mesh& mesh);
/// Returns the shape quality kappa = 4 sin a sin b sin c / (sin a + sin b + sin c), eq. (6) of the paper: 1
/// for the equilateral triangle, 0 for a degenerate one.
double kappa(Vec3 a, Vec3 b, Vec3 c);

}  // namespace meshpipe
