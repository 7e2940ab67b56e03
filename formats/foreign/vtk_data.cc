// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/vtk_data.h"

#include "formats/text.h"
#include "lib/core/error.h"

namespace meshpipe {
namespace {

/// Cell arrays with labels of surfaces: of meshpipe, meshio, VMTK and SimVascular.
constexpr const char* labels[] = {"patch",       "gmsh:physical", "medit:ref",       "CellEntityIds",
                                  "ModelFaceID", "PhysicalIds",   "gmsh:geometrical"};

/// The corners of a volume of this type in the order of add_volume; none of other types. A voxel has its
/// corners in rows, and a prism the first base as seen from outside.
std::vector<int> volume_corners(int type) {
  switch (type) {
    case 10:
    case 24:
    case 71:
      return {0, 1, 2, 3};
    case 11:
      return {0, 1, 3, 2, 4, 5, 7, 6};
    case 12:
    case 25:
    case 29:
    case 33:
    case 72:
      return {0, 1, 2, 3, 4, 5, 6, 7};
    case 13:
    case 26:
    case 32:
    case 73:
      return {0, 2, 1, 3, 5, 4};
    case 14:
    case 27:
    case 74:
      return {0, 1, 2, 3, 4};
    default:
      return {};
  }
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
  auto element = [&](int n_corners) {
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
      expect(6, 6);
      element(3);
      break;
    case 23:
      expect(8, 8);
      element(4);
      break;
    case 28:
      expect(9, 9);
      element(4);
      break;
    case 34:
      expect(7, 7);
      element(3);
      break;
    case 69:  // Lagrange's triangles and quadrilaterals of any order
      expect(3, max_corners);
      element(3);
      break;
    case 70:
      expect(4, max_corners);
      element(4);
      break;
    default:  // volumes, vertices and lines
      if (std::vector<int> nodes = volume_corners(type); !nodes.empty() && polygons.ends.empty()) {
        expect(nodes.size(), max_corners);
        for (int& v : nodes) v = corners[v];
        add_volume(volumes, nodes.data(), static_cast<int>(nodes.size()), cells);
      }
      for (int curved : {30, 36, 61, 62, 63, 76, 77})
        if (type == curved)
          fail("is of type " + std::to_string(type) + ", a kind of curved cells that is not read");
      break;
  }
  ++cells;
}

Stream vtk_surface(VtkData data) {
  Stream stream;
  Surface& s = stream.surface;
  s.points = std::move(data.points);
  if (std::vector<int> cells = add_outer_faces(data.polygons, data.volumes, stream); !cells.empty())
    data.cell = std::move(cells);
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
    if (std::vector<int> v; a.size() == 2 && whole_numbers(a.data, v) && (v[1] == 1 || v[1] == 2))
      stream.names.push_back({v[1], v[0], a.name});
  set_faces(stream, data.polygons);
  return stream;
}

std::vector<Array> field_of_names(const Stream& stream) {
  std::vector<Array> field;
  for (const Name& n : stream.names) field.push_back({one_line(n.text), 1, std::vector<int>{n.tag, n.dim}});
  return field;
}

}  // namespace meshpipe
