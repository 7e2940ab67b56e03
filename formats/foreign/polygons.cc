// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/polygons.h"

#include <algorithm>
#include <numeric>

namespace meshpipe {
namespace {

/// Returns the quality of a triangle as a piece of a polygon of this normal: negative if it is inverted.
double worth(Vec3 a, Vec3 b, Vec3 c, Vec3 normal) {
  double k = kappa(a, b, c);
  return dot(area_vector(a, b, c), normal) >= 0 ? k : -k;
}

class Triangulation {
 public:
  explicit Triangulation(Mesh& mesh) : mesh_(mesh) {}

  void add(const int* v, int n) {
    if (n == 3)
      mesh_.tris.push_back({v[0], v[1], v[2]});
    else if (n == 4)
      quad(v);
    else if (n > 4)
      ears(v, n);
  }

 private:
  Vec3 normal(const int* v, int n) const {
    Vec3 sum;  // Newell's: twice the vector area
    for (int i = 2; i < n; ++i)
      sum = sum + area_vector(mesh_.points[v[0]], mesh_.points[v[i - 1]], mesh_.points[v[i]]);
    return sum;
  }

  void quad(const int* v) {
    const Vec3 n = normal(v, 4), a = mesh_.points[v[0]], b = mesh_.points[v[1]], c = mesh_.points[v[2]],
               d = mesh_.points[v[3]];
    if (std::min(worth(a, b, c, n), worth(a, c, d, n)) >= std::min(worth(a, b, d, n), worth(b, c, d, n))) {
      mesh_.tris.push_back({v[0], v[1], v[2]});
      mesh_.tris.push_back({v[0], v[2], v[3]});
    } else {
      mesh_.tris.push_back({v[0], v[1], v[3]});
      mesh_.tris.push_back({v[1], v[2], v[3]});
    }
  }

  /// Returns twice the signed area of corners i, j, k in the plane.
  double turn(int i, int j, int k) const { return cross(flat_[j] - flat_[i], flat_[k] - flat_[i]); }

  void ears(const int* v, int n) {
    // drop the coordinate along which the face is thinnest, keeping it counter-clockwise
    const Vec3 m = normal(v, n);
    const Vec3 size{std::abs(m.x), std::abs(m.y), std::abs(m.z)};
    flat_.clear();
    for (int i = 0; i < n; ++i) {
      const Vec3& p = mesh_.points[v[i]];
      if (size.z >= size.x && size.z >= size.y)
        flat_.push_back(m.z >= 0 ? Vec2{p.x, p.y} : Vec2{p.y, p.x});
      else if (size.x >= size.y)
        flat_.push_back(m.x >= 0 ? Vec2{p.y, p.z} : Vec2{p.z, p.y});
      else
        flat_.push_back(m.y >= 0 ? Vec2{p.z, p.x} : Vec2{p.x, p.z});
    }
    next_.resize(n);
    prev_.resize(n);
    reflex_.clear();
    for (int i = 0; i < n; ++i) {
      next_[i] = (i + 1) % n;
      prev_[i] = (i + n - 1) % n;
      if (turn((i + n - 1) % n, i, (i + 1) % n) <= 0) reflex_.push_back(i);
    }
    int at = 0, tried = 0;
    work_ = static_cast<std::size_t>(n) * n;
    int left = n;
    while (left > 3 && tried < left && work_ > 0) {
      if (!is_ear(at)) {
        at = next_[at];
        ++tried;
        continue;
      }
      mesh_.tris.push_back({v[prev_[at]], v[at], v[next_[at]]});
      next_[prev_[at]] = next_[at];
      prev_[next_[at]] = prev_[at];
      std::erase_if(reflex_, [&](int r) {
        return r == at || ((r == prev_[at] || r == next_[at]) && turn(prev_[r], r, next_[r]) > 0);
      });
      // skip a corner, so that ears are taken all around and not as one fan
      at = next_[next_[at]];
      --left;
      tried = 0;
    }
    // one triangle is left, or a face without ears, which crosses itself: a fan, for mclean to repair
    for (int i = next_[at]; next_[i] != at; i = next_[i]) mesh_.tris.push_back({v[at], v[i], v[next_[i]]});
  }

  bool is_ear(int at) {
    const int a = prev_[at], c = next_[at];
    if (turn(a, at, c) <= 0) return false;
    work_ -= std::min(work_, reflex_.size());
    // a corner at the same place as one of the ear's does not block it: faces with holes visit corners twice
    return std::none_of(reflex_.begin(), reflex_.end(), [&](int r) {
      return turn(a, at, r) >= 0 && turn(at, c, r) >= 0 && turn(c, a, r) >= 0 && !(flat_[r] == flat_[a]) &&
             !(flat_[r] == flat_[at]) && !(flat_[r] == flat_[c]);
    });
  }

  Mesh& mesh_;
  std::vector<Vec2> flat_;
  std::vector<int> next_, prev_, reflex_;
  std::size_t work_ = 0;  ///< comparisons left: n^2 suffices unless a face crosses itself
};

}  // namespace

int add_element(Polygons& polygons, const int* nodes, int n_corners, int n_nodes) {
  using Faces = std::vector<std::vector<int>>;
  static const Faces triangle = {{0, 1, 2}}, quad = {{0, 1, 2, 3}},
                     triangle_6 = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}},
                     quad_8 = {{0, 4, 7}, {4, 1, 5}, {5, 2, 6}, {7, 6, 3}, {4, 5, 6, 7}},
                     quad_9 = {{0, 4, 8, 7}, {4, 1, 5, 8}, {8, 5, 2, 6}, {7, 8, 6, 3}};
  constexpr std::uint8_t inner_of_triangle_6[] = {2, 4, 1, 7};
  const bool of_triangle = n_corners == 3;
  const Faces& faces = of_triangle    ? (n_nodes == 6 || n_nodes == 7 ? triangle_6 : triangle)
                       : n_nodes == 8 ? quad_8
                       : n_nodes == 9 ? quad_9
                                      : quad;
  if (&faces == &triangle_6)
    for (int i = 0; i < 4; ++i)
      polygons.inner.push_back({static_cast<int>(polygons.ends.size()) + i, inner_of_triangle_6[i]});
  for (const std::vector<int>& face : faces) {
    for (int k : face) polygons.corners.push_back(nodes[k]);
    polygons.ends.push_back(polygons.corners.size());
  }
  polygons.second_order += faces.size() > 1;
  polygons.higher_order += faces.size() == 1 && n_nodes > n_corners;
  return static_cast<int>(faces.size());
}

void set_faces(Stream& stream, const Polygons& polygons) {
  Surface& s = stream.surface;
  Triangulation triangulation(s);
  s.tris.reserve(polygons.corners.size() / 3);
  std::vector<int> from;  // the face of each triangle
  std::size_t first = 0;
  for (std::size_t f = 0; f < polygons.ends.size(); ++f) {
    triangulation.add(polygons.corners.data() + first, static_cast<int>(polygons.ends[f] - first));
    from.resize(s.tris.size(), static_cast<int>(f));
    first = polygons.ends[f];
  }
  s.vertex.rows = s.points.size();
  if (polygons.second_order)
    stream.remarks.push_back("read flat between their nodes: " + std::to_string(polygons.second_order) +
                             " curved elements of second order");
  if (polygons.higher_order)
    stream.remarks.push_back("read by their corners alone: " + std::to_string(polygons.higher_order) +
                             " curved elements of higher order");
  auto of_triangles = [&](const auto& of_faces) {
    std::decay_t<decltype(of_faces)> v(from.size());
    for (std::size_t t = 0; t < v.size(); ++t) v[t] = of_faces[from[t]];
    return v;
  };
  s.face.set("patch", of_triangles(polygons.patch));
  for (const Column& c : polygons.columns.columns)
    std::visit([&](const auto& v) { s.face.set(c.name, of_triangles(v)); }, c.data);
  const Column* model = s.face.find("model");
  if (model && std::holds_alternative<std::vector<std::uint8_t>>(model->data))
    for (auto& bits = s.face.get<std::uint8_t>("model"); const auto& [face, inner] : polygons.inner)
      bits[std::lower_bound(from.begin(), from.end(), face) - from.begin()] &= ~inner;
}

std::vector<int> patches_of(const Stream& stream) {
  const Surface& s = stream.surface;
  return s.face.has("patch") ? s.face.get<int>("patch") : std::vector<int>(s.tris.size(), 0);
}

ByPatch by_patch(const Stream& stream) {
  const std::vector<int> patch = patches_of(stream);
  ByPatch by;
  by.order.resize(patch.size());
  std::iota(by.order.begin(), by.order.end(), 0);
  std::stable_sort(by.order.begin(), by.order.end(), [&](int a, int b) { return patch[a] < patch[b]; });
  for (std::size_t i = 0; i < by.order.size(); ++i)
    if (i == 0 || patch[by.order[i]] != by.tags.back()) {
      by.tags.push_back(patch[by.order[i]]);
      by.first.push_back(i);
    }
  by.first.push_back(by.order.size());
  return by;
}

long long shift_to_positive(const ByPatch& by) {
  return by.tags.empty() || by.tags[0] > 0 ? 0 : 1 - static_cast<long long>(by.tags[0]);
}

}  // namespace meshpipe
