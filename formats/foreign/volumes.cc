// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/volumes.h"

#include <algorithm>
#include <array>
#include <climits>

namespace meshpipe {

void add_volume(Volumes& volumes, const int* nodes, int n_corners, int cell) {
  using Faces = std::vector<std::vector<int>>;
  static const Faces tetrahedron = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}},
                     pyramid = {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}},
                     prism = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}},
                     hexahedron = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                   {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  for (const auto& face : n_corners == 4   ? tetrahedron
                          : n_corners == 5 ? pyramid
                          : n_corners == 6 ? prism
                                           : hexahedron) {
    for (int k : face) volumes.corners.push_back(nodes[k]);
    volumes.ends.push_back(volumes.corners.size());
    volumes.cell.push_back(cell);
  }
  ++volumes.count;
}

std::vector<int> add_outer_faces(Polygons& polygons, const Volumes& volumes, Stream& stream) {
  std::vector<int> cells;
  if (!polygons.ends.empty() || volumes.count == 0) return cells;
  struct Face {
    std::array<int, 4> corners;  // ascending
    int number;
    bool same(const Face& other) const { return corners == other.corners; }
  };
  std::vector<Face> faces;
  faces.reserve(volumes.ends.size());
  auto first = [&](int f) { return f == 0 ? 0 : volumes.ends[f - 1]; };
  for (int f = 0; f < (int)volumes.ends.size(); ++f) {
    Face face{{INT_MAX, INT_MAX, INT_MAX, INT_MAX}, f};
    for (std::size_t i = first(f); i < volumes.ends[f]; ++i) face.corners[i - first(f)] = volumes.corners[i];
    std::sort(face.corners.begin(), face.corners.end());
    faces.push_back(face);
  }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
    return a.corners != b.corners ? a.corners < b.corners : a.number < b.number;
  });
  std::vector<int> outer;
  for (std::size_t i = 0, end = 0; i < faces.size(); i = end) {
    for (end = i + 1; end < faces.size() && faces[end].same(faces[i]);) ++end;
    if (end == i + 1) outer.push_back(faces[i].number);
  }
  std::sort(outer.begin(), outer.end());
  for (int f : outer) {
    for (std::size_t i = first(f); i < volumes.ends[f]; ++i) polygons.corners.push_back(volumes.corners[i]);
    polygons.ends.push_back(polygons.corners.size());
    cells.push_back(volumes.cell[f]);
  }
  stream.remarks.push_back("no faces, but " + std::to_string(volumes.count) + " volume elements: their " +
                           std::to_string(outer.size()) + " outer faces are the surface");
  return cells;
}

}  // namespace meshpipe
