// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/vtk_data.h"

#include <algorithm>
#include <string_view>

#include "formats/stream/model_lines.h"
#include "formats/text.h"
#include "lib/core/error.h"

namespace meshpipe {
namespace {

/// Cell arrays with labels of surfaces: of meshpipe, meshio, VMTK and SimVascular.
constexpr const char* labels[] = {"patch",       "gmsh:physical", "medit:ref",       "CellEntityIds",
                                  "ModelFaceID", "PhysicalIds",   "gmsh:geometrical"};

/// The corners of volume elements of this type in the order of add_volume, as digits; "" of other types. A
/// voxel has its corners in rows, and a prism the first base as seen from outside. Quadratic elements,
/// Lagrange's, Bezier's and others have their corners first.
const char* volume_corners(int type) {
  static const std::vector<int> kinds[] = {{10, 24, 64, 71, 78},
                                           {12, 25, 29, 33, 67, 72, 79},
                                           {13, 26, 31, 32, 65, 73, 80},
                                           {14, 27, 37, 66, 74, 81},
                                           {11}};
  constexpr const char* corners[] = {"0123", "01234567", "021354", "01234", "01324576"};
  for (std::size_t k = 0; k < std::size(corners); ++k)
    if (std::find(kinds[k].begin(), kinds[k].end(), type) != kinds[k].end()) return corners[k];
  return "";
}

/// Is it a volume of another kind: a prism over a pentagon or a hexagon, a set of points, a polyhedron?
bool is_other_volume(int type) { return type == 15 || type == 16 || type == 41 || type == 42; }

/// A cell by its type, number and points.
struct Cell {
  int type, number;
  const int* points;
  std::size_t n;
};

/// Adds a cell if it is a volume, whose corners are in this order.
void add_cell_to(Volumes& volumes, const Cell& cell, std::string_view order, const std::string& place) {
  if (is_other_volume(cell.type) && volumes.unread.empty())
    volumes.unread = place + ": cell " + std::to_string(cell.number) + " is a volume of type " +
                     std::to_string(cell.type) + ", a kind whose faces are not read, and there are no others";
  if (order.empty()) return;
  int corners[8];
  for (std::size_t k = 0; k < order.size(); ++k) corners[k] = cell.points[order[k] - '0'];
  add_volume(volumes, corners, static_cast<int>(order.size()), static_cast<int>(cell.n), cell.number);
}

/// Makes model edges of the lines of a file without faces, with labels by cell array `tag`, which
/// write_feature_edges writes.
void set_lines(Stream& stream, const VtkData& data) {
  std::vector<int> tag(static_cast<std::size_t>(data.cells), 0), given;
  for (const Array& a : data.cell_data)
    if (a.name == "tag" && a.components == 1 && a.rows() == tag.size() && whole_numbers(a.data, given))
      tag = given;
  std::vector<LineEdge> edges;
  for (const auto& [a, b, cell] : data.lines) edges.push_back({a, b, tag[static_cast<std::size_t>(cell)]});
  set_model_lines(stream, edges);
}

}  // namespace

void VtkData::add_cell(int type, const int* corners, std::size_t n, const std::string& place) {
  auto fail = [&](const std::string& what) {
    throw BadInput(place + ": cell " + std::to_string(cells) + ' ' + what);
  };
  for (std::size_t i = 0; i < n; ++i)
    if (corners[i] < 0 || corners[i] >= static_cast<int>(points.size()))
      fail("uses point " + std::to_string(corners[i]) + ", but there are " + std::to_string(points.size()));
  auto add = [&](std::initializer_list<int> polygon) {
    polygons.corners.insert(polygons.corners.end(), polygon);
    polygons.ends.push_back(polygons.corners.size());
    cell.push_back(cells);
  };
  auto expect = [&](std::size_t least, std::size_t most) {
    if (n < least || n > most)
      fail("of type " + std::to_string(type) + " has " + std::to_string(n) + " points, expected " +
           std::to_string(n < least ? least : most));
  };
  auto element = [&](int n_corners, std::size_t least, std::size_t most) {
    expect(least, most);
    const int added = add_element(polygons, corners, n_corners, static_cast<int>(n));
    cell.insert(cell.end(), added, cells);
  };
  switch (type) {
    case vtk_triangle:
      expect(3, 3);
      add({corners[0], corners[1], corners[2]});
      break;
    case vtk_strip:
      for (std::size_t i = 2; i < n; ++i) add({corners[i - 2 + i % 2], corners[i - 1 - i % 2], corners[i]});
      break;
    case vtk_polygon:
      expect(0, max_corners);
      polygons.corners.insert(polygons.corners.end(), corners, corners + n);
      polygons.ends.push_back(polygons.corners.size());
      cell.push_back(cells);
      break;
    case 8:  // a pixel has its corners in rows
      expect(4, 4);
      add({corners[0], corners[1], corners[3], corners[2]});
      break;
    case 9:
      expect(4, 4);
      add({corners[0], corners[1], corners[2], corners[3]});
      break;
    case 22:  // quadratic triangles and quadrilaterals, with or without a node in the middle
      element(3, 6, 6);
      break;
    case 23:
      element(4, 8, 8);
      break;
    case 28:
      element(4, 9, 9);
      break;
    case 34:
      element(3, 7, 7);
      break;
    case 69:  // Lagrange's triangles and quadrilaterals of any order
      element(3, 3, max_corners);
      break;
    case 70:
      element(4, 4, max_corners);
      break;
    case vtk_line:
    case vtk_polyline:
      for (std::size_t i = 1; i < n; ++i) lines.push_back({corners[i - 1], corners[i], cells});
      break;
    default:  // volumes and vertices
      if (const std::string_view order = volume_corners(type); polygons.ends.empty()) {
        if (!order.empty()) expect(order.size(), max_corners);
        add_cell_to(volumes, {type, cells, corners, n}, order, place);
      }
      for (int curved : {30, 36, 61, 62, 63, 76, 77})
        if (type == curved)
          fail("is of type " + std::to_string(type) + ", a kind of curved cells that is not read");
      break;
  }
  ++cells;
  if (!polygons.ends.empty() && !volumes.kind.empty()) volumes = {};
}

Stream vtk_surface(VtkData data) {
  Stream stream;
  Surface& s = stream.surface;
  s.points = std::move(data.points);
  if (data.polygons.ends.empty() && data.volumes.kind.empty()) set_lines(stream, data);
  const std::vector<int> volumes = add_outer_faces(data.polygons, data.volumes, stream);
  if (!volumes.empty()) data.cell = volumes;
  const int dimension = volumes.empty() ? 2 : 3;  // of what has the names of patches
  const std::size_t n_polygons = data.polygons.ends.size();
  std::vector<int> patch;
  for (const char* label : labels)
    for (Array& a : data.cell_data) {
      if (!patch.empty() || a.name != label || a.components != 1 ||
          a.rows() != static_cast<std::size_t>(data.cells) || !whole_numbers(a.data, patch))
        continue;
      Array of_polygons = gather({a.name, 1, std::move(patch)}, data.cell);
      patch = std::get<std::vector<int>>(std::move(of_polygons.data));
      if (a.name == "patch") a.name.clear();  // it is no column of its own
    }
  for (const Array& a : data.cell_data)
    if (a.name == "patch") leave_out(stream, s.face, a.name, "as labels, which are whole numbers of 32 bits");
  data.polygons.patch = std::move(patch);
  data.polygons.patch.resize(n_polygons, 0);
  auto fits = [&](const Table& table, const Array& a, std::size_t rows) {
    if (a.rows() == rows) return true;
    leave_out(stream, table, a.name, "given for " + std::to_string(a.rows()) + " of " + std::to_string(rows));
    return false;
  };
  for (Array& a : data.point_data)
    if (fits(s.vertex, a, s.points.size())) add_columns(stream, s.vertex, s.points.size(), std::move(a));
  for (Array& a : data.cell_data)
    if (!a.name.empty() && fits(s.face, a, static_cast<std::size_t>(data.cells)))
      add_columns(stream, data.polygons.columns, n_polygons, gather(a, data.cell));
  for (const Array& a : data.field_data)
    if (std::vector<int> v; a.size() == 2 && whole_numbers(a.data, v) && (v[1] == 1 || v[1] == dimension))
      stream.names.push_back({std::min(v[1], 2), v[0], a.name});
  set_faces(stream, data.polygons);
  return stream;
}

std::vector<Array> field_of_names(const Stream& stream) {
  std::vector<Array> field;
  for (const Name& n : stream.names) field.push_back({one_line(n.text), 1, std::vector<int>{n.tag, n.dim}});
  return field;
}

}  // namespace meshpipe
