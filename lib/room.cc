// SPDX-License-Identifier: BSD-3-Clause
#include "lib/room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

#include "lib/neighbours.h"
#include "lib/topology.h"

namespace meshpipe {
namespace {

constexpr double pi = 3.14159265358979324;
constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double ring_edges = 4;  ///< at least, about a tube or along a closed line

/// Sets the room on closed lines: loops of border or model edges that no other such edge meets.
void room_on_lines(const Mesh& mesh, const std::vector<int>& opposite, const std::vector<std::uint8_t>& model,
                   std::vector<double>& room) {
  const int n = static_cast<int>(mesh.points.size());
  std::vector<std::array<int, 2>> beside(n, {-1, -1});  // the other ends of the first two edges
  std::vector<int> degree(n, 0);
  auto marked = [&](int h) { return h >= 0 && !model.empty() && (model[h / 3] >> (h % 3) & 1); };
  for (int h = 0; h < static_cast<int>(opposite.size()); ++h) {
    const int o = opposite[h], a = origin(mesh.tris, h), b = target(mesh.tris, h);
    if (o > h || (o >= 0 && !marked(h) && !marked(o))) continue;
    if (degree[a] < 2) beside[a][degree[a]] = b;
    if (degree[b] < 2) beside[b][degree[b]] = a;
    ++degree[a], ++degree[b];
  }
  std::vector<char> seen(n, 0);
  std::vector<int> loop;
  for (int first = 0; first < n; ++first) {
    if (seen[first] || degree[first] != 2) continue;
    loop.clear();
    double length = 0;
    int v = first, before = beside[first][0];
    do {
      seen[v] = 1;
      loop.push_back(v);
      const int u = beside[v][beside[v][0] == before];
      length += norm(mesh.points[u] - mesh.points[v]);
      before = v, v = u;
    } while (v != first && degree[v] == 2 && !seen[v]);
    if (v != first) continue;  // it ends in a junction
    for (int u : loop) room[u] = std::min(room[u], length / ring_edges);
  }
}

using Item = std::pair<double, int>;
using Queue = std::priority_queue<Item, std::vector<Item>, std::greater<>>;

/// Looks for the loops about tubes, from one vertex after the other.
class TubeFinder {
 public:
  TubeFinder(const Mesh& mesh, const Neighbours& next)
      : mesh_(mesh),
        next_(next),
        normal_(mesh.points.size()),
        distance_(mesh.points.size()),
        from_(mesh.points.size()),
        branch_(mesh.points.size()),
        reached_(mesh.points.size(), -1) {
    for (const Tri& t : mesh.tris) {
      const Vec3 n = area_vector(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
      for (int v : t) normal_[v] = normal_[v] + n;
    }
  }

  /// The shortest loop through v that is shorter than `below`, or `below`. Leaves the vertices that are
  /// nearer than half of it in near(), with their distances.
  double loop(int v, double below) {
    near_.clear();
    ++round_;
    queue_.push({0, v});
    distance_[v] = 0, from_[v] = branch_[v] = v, reached_[v] = round_;
    double shortest = below;
    while (!queue_.empty()) {
      const auto [d, a] = queue_.top();
      queue_.pop();
      if (d > distance_[a]) continue;
      if (d > 0.5 * shortest) continue;  // empties the queue
      near_.push_back(a);
      for (int k = next_.start[a]; k < next_.start[a + 1]; ++k) {
        const int b = next_.vertex[k];
        const double l = d + norm(mesh_.points[b] - mesh_.points[a]);
        if (reached_[b] == round_ && l + distance_[b] < shortest && from_[a] != b && from_[b] != a &&
            is_loop(v, a, b))
          shortest = l + distance_[b];
        if (reached_[b] == round_ && l >= distance_[b]) continue;
        distance_[b] = l, from_[b] = a, branch_[b] = a == v ? b : branch_[a], reached_[b] = round_;
        queue_.push({l, b});
      }
    }
    return shortest;
  }

  const std::vector<int>& near() const { return near_; }
  double distance(int v) const { return distance_[v]; }

 private:
  /// Do the paths to a and b leave v on opposite sides, and does the loop of both lie across the surface?
  bool is_loop(int v, int a, int b) const {
    const Vec3 p = mesh_.points[v];
    if (a == v || b == v || angle(mesh_.points[branch_[a]] - p, mesh_.points[branch_[b]] - p) < 0.6 * pi)
      return false;
    Vec3 area = cross(mesh_.points[a] - p, mesh_.points[b] - p);
    for (int x = a; x != v; x = from_[x])
      area = area + cross(mesh_.points[from_[x]] - p, mesh_.points[x] - p);
    for (int x = b; x != v; x = from_[x])
      area = area + cross(mesh_.points[x] - p, mesh_.points[from_[x]] - p);
    double along = 0;
    int n = 1;
    auto look = [&](int x) { along += std::abs(std::cos(angle(area, normal_[x]))), ++n; };
    look(v);
    for (int end : {a, b})
      for (int x = end; x != v; x = from_[x]) look(x);
    constexpr double least_area = 0.2;  // of that of a circle as long: not there and back the same way
    const double length = distance_[a] + distance_[b] + norm(mesh_.points[a] - mesh_.points[b]);
    return along < 0.4 * n && norm(area) > least_area * length * length / (2 * pi);
  }

  const Mesh& mesh_;
  const Neighbours& next_;
  std::vector<Vec3> normal_;
  std::vector<double> distance_;
  std::vector<int> from_, branch_, reached_, near_;
  int round_ = -1;
  Queue queue_;
};

}  // namespace

std::vector<double> edge_room(const Mesh& mesh, const std::vector<int>& opposite,
                              const std::vector<std::uint8_t>& model, const std::vector<double>& curvature,
                              const std::vector<double>& size) {
  const std::size_t n = mesh.points.size();
  std::vector<double> room(n, infinite), bend(n, 0);
  room_on_lines(mesh, opposite, model, room);
  const Neighbours next(mesh);

  for (std::size_t t = 0; t < mesh.tris.size(); ++t)
    for (int v : mesh.tris[t]) bend[v] = std::max(bend[v], curvature[t]);
  TubeFinder tubes(mesh, next);
  std::vector<char> done(n, 0);
  for (int v = 0; v < static_cast<int>(n); ++v) {
    constexpr double sure = 0.7;  // curvature is that of a neighbourhood
    const double below = ring_edges * size[v];
    if (done[v] || !(bend[v] * below > sure * 2 * pi)) continue;
    const double length = tubes.loop(v, below);
    for (int u : tubes.near()) {
      if (tubes.distance(u) > length / (length < below ? 4 : 16)) break;
      done[u] = 1;
      if (length < below) room[u] = std::min(room[u], length / ring_edges);
    }
  }
  return room;
}

}  // namespace meshpipe
