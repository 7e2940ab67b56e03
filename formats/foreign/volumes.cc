// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/volumes.h"

#include <algorithm>
#include <array>
#include <climits>

#include "lib/core/error.h"
#include "lib/core/lists.h"

namespace meshpipe {
namespace {

using Faces = std::vector<std::vector<int>>;

/// The faces of an element of this many corners, counterclockwise seen from outside.
const Faces& faces_of(int n_corners) {
  static const Faces tetrahedron = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}},
                     pyramid = {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}},
                     prism = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}},
                     hexahedron = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                   {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  return n_corners == 4 ? tetrahedron : n_corners == 5 ? pyramid : n_corners == 6 ? prism : hexahedron;
}

/// Per point the first one at its place.
std::vector<int> first_at_place(const std::vector<Vec3>& points) {
  std::vector<int> order = identity((int)points.size()), first = order;
  auto key = [&](int v) { return std::array{points[v].x, points[v].y, points[v].z}; };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (points[order[i]] == points[order[i - 1]]) first[order[i]] = first[order[i - 1]];
  return first;
}

/// Corners in ascending order, and what they are of.
template <int N>
struct Key {
  std::array<int, N> corners;
  int of;
  Key(const int* begin, const int* end, int number) : of(number) {
    corners.fill(INT_MAX);
    std::copy(begin, end, corners.begin());
    std::sort(corners.begin(), corners.end());
  }
  bool operator<(const Key& o) const { return corners != o.corners ? corners < o.corners : of < o.of; }
};

}  // namespace

void add_volume(Volumes& volumes, const int* nodes, int n_corners, int n_nodes, int cell) {
  volumes.corners.insert(volumes.corners.end(), nodes, nodes + n_corners);
  volumes.kind.push_back((char)n_corners);
  volumes.cell.push_back(cell);
  volumes.curved += n_nodes > n_corners;
}

std::vector<int> add_outer_faces(Polygons& polygons, const Volumes& volumes, Stream& stream) {
  std::vector<int> cells;
  if (!polygons.ends.empty()) return cells;
  if (!volumes.unread.empty()) throw BadInput(volumes.unread);
  if (volumes.kind.empty()) return cells;
  std::vector<int> corner = volumes.corners;
  const std::vector<int> first = first_at_place(stream.surface.points);
  for (int& v : corner) v = first[v];
  std::vector<Key<8>> elements;
  std::vector<std::size_t> start;
  std::size_t end = 0;
  for (int e = 0; e < (int)volumes.kind.size(); ++e) {
    start.push_back(end), end += volumes.kind[e];
    elements.emplace_back(&corner[start[e]], &corner[start[e]] + volumes.kind[e], e);
  }
  std::sort(elements.begin(), elements.end());
  std::vector<int> once;
  for (std::size_t i = 0; i < elements.size(); ++i)
    if (i == 0 || elements[i].corners != elements[i - 1].corners) once.push_back(elements[i].of);
  std::sort(once.begin(), once.end());
  // faces of collapsed elements have the same corner twice; edges are none
  std::vector<int> of_faces, element;
  std::vector<std::size_t> ends;
  std::vector<Key<4>> faces;
  for (int e : once)
    for (const std::vector<int>& face : faces_of(volumes.kind[e])) {
      const std::size_t begin = of_faces.size();
      for (int k : face)
        if (const int v = corner[start[e] + k];
            std::find(of_faces.begin() + (std::ptrdiff_t)begin, of_faces.end(), v) == of_faces.end())
          of_faces.push_back(v);
      if (of_faces.size() < begin + 3) {
        of_faces.resize(begin);
        continue;
      }
      faces.emplace_back(&of_faces[begin], &of_faces[begin] + (of_faces.size() - begin), (int)ends.size());
      ends.push_back(of_faces.size()), element.push_back(e);
    }
  std::sort(faces.begin(), faces.end());
  std::vector<int> outer;
  for (std::size_t i = 0, next = 0; i < faces.size(); i = next) {
    for (next = i + 1; next < faces.size() && faces[next].corners == faces[i].corners;) ++next;
    if (next == i + 1) outer.push_back(faces[i].of);
  }
  std::sort(outer.begin(), outer.end());
  for (int f : outer) {
    for (std::size_t i = f == 0 ? 0 : ends[f - 1]; i < ends[f]; ++i) polygons.corners.push_back(of_faces[i]);
    polygons.ends.push_back(polygons.corners.size());
    cells.push_back(volumes.cell[element[f]]);
  }
  polygons.higher_order += volumes.curved;
  stream.remarks.push_back("no faces, but " + std::to_string(once.size()) + " volume elements: their " +
                           std::to_string(outer.size()) + " outer faces are the surface");
  return cells;
}

}  // namespace meshpipe
