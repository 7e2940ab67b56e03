// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "lib/cap/steps.h"
#include "lib/core/cut.h"
#include "lib/core/eigenvectors.h"
#include "lib/core/lists.h"
#include "lib/core/neighborhood.h"
#include "lib/core/number.h"
#include "lib/core/shortest_paths.h"
#include "lib/core/topology.h"

namespace meshpipe {
namespace {

/// Radii between points of the axis: short enough to follow bends, long enough to hold a ring of triangles.
constexpr double axis_step = 0.5;
/// And at most this many, of ends that are very small.
constexpr double most_steps = 10000;
/// Radii to either side of a cut in which the wall determines its axis.
constexpr double axis_reach = 0.75;
/// Cosine between the axis by the wall's normals and that by the middles of rings, below which the latter
/// holds: where the wall is no tube.
constexpr double same_axis = 0.8;
/// Share of an edge within which a cut runs through its end, lest triangles get thin; flattening follows.
constexpr double snap = 0.02;

/// The triangles near an end, by their distance along edges from the rim.
struct Wall {
  std::vector<int> triangle;
  std::vector<double> distance;
};

/// Collects walls of ends; the arrays over all vertices serve one end after another.
class WallFinder {
 public:
  WallFinder(const Connectivity& c)
      : c_(c),
        neighbors_(neighbors_of(c.mesh)),
        distance_(c.n_vertices(), infinity),
        spoke_(c.n_vertices(), -1) {
    for (int h = c.n_half_edges() - 1; h >= 0; --h) spoke_[c.from(h)] = h;
  }

  Wall around(const End& end, double reach) {
    std::vector<int> sources, seen;
    for (const std::vector<int>& rim : end.rims) sources.insert(sources.end(), rim.begin(), rim.end());
    for (int v : sources) distance_[v] = 0;
    shortest_paths(sources, distance_, [&](int v, auto step) {
      seen.push_back(v);
      if (distance_[v] > reach) return false;
      for (int w : neighbors_[v]) {
        if (step(w, distance_[v] + norm(c_.point(w) - c_.point(v)))) reached_.push_back(w);
      }
      return true;
    });
    Wall wall;
    for (int v : seen)
      c_.for_each_spoke(spoke_[v], [&](int h) {
        const int t = h / 3;
        double sum = 0;
        for (int corner : c_.mesh.tris[t]) sum += distance_[corner];
        if (c_.mesh.tris[t][0] == v && sum < infinity) {
          wall.triangle.push_back(t);
          wall.distance.push_back(sum / 3);
        }
      });
    for (int v : sources) distance_[v] = infinity;
    for (int v : reached_) distance_[v] = infinity;
    reached_.clear();
    return wall;
  }

 private:
  const Connectivity c_;
  const Lists neighbors_;
  std::vector<double> distance_;
  std::vector<int> spoke_, reached_;
};

/// A point of the axis, the distance along edges of the ring whose middle it is, and along the axis.
struct AxisPoint {
  Vec3 point;
  double ring, length;
};

/// Returns the axis of the vessel behind an end: middles of rings of triangles, from the rim inwards.
std::vector<AxisPoint> axis_of(const Mesh& mesh, const End& end, const Wall& wall) {
  const double farthest =
      wall.distance.empty() ? 0 : *std::max_element(wall.distance.begin(), wall.distance.end());
  const double step = std::max(axis_step * end.radius, farthest / most_steps);
  std::vector<Vec3> sum;
  std::vector<double> area, distance;
  for (std::size_t i = 0; i < wall.triangle.size(); ++i) {
    const std::size_t k = (std::size_t)(wall.distance[i] / step);
    if (k >= sum.size()) sum.resize(k + 1), area.resize(k + 1), distance.resize(k + 1);
    const double a = triangle_area(mesh, wall.triangle[i]);
    sum[k] = sum[k] + a * (centroid(mesh, wall.triangle[i]) - end.center);
    area[k] += a;
    distance[k] += a * wall.distance[i];
  }
  std::vector<AxisPoint> axis{{end.center, 0, 0}};
  for (std::size_t k = 0; k < sum.size(); ++k) {
    if (!(area[k] > 0)) continue;
    const Vec3 p = end.center + (1 / area[k]) * sum[k];
    axis.push_back({p, distance[k] / area[k], axis.back().length + norm(p - axis.back().point)});
  }
  return axis;
}

/// Returns the direction to which the normals of the wall are most nearly perpendicular, near one ring.
Vec3 axis_by_normals(const Mesh& mesh, const Wall& wall, double ring, double reach, Vec3 rough) {
  Matrix3 m{};
  for (std::size_t i = 0; i < wall.triangle.size(); ++i) {
    if (std::abs(wall.distance[i] - ring) > reach) continue;
    const Vec3 area = area_vector(mesh, wall.triangle[i]), n = normalized(area);
    const double x[3] = {n.x, n.y, n.z}, weight = norm(area);
    for (int r = 0; r < 3; ++r)
      for (int s = 0; s < 3; ++s) m[r][s] += weight * x[r] * x[s];
  }
  Vec3 best = rough;
  double least = infinity;
  for (const Vec3& e : eigenvectors(m)) {
    const double x[3] = {e.x, e.y, e.z};
    double value = 0;
    for (int r = 0; r < 3; ++r)
      for (int s = 0; s < 3; ++s) value += m[r][s] * x[r] * x[s];
    if (value < least) least = value, best = e;
  }
  if (dot(best, rough) < 0) best = -1 * best;
  return dot(best, rough) < same_axis ? rough : best;
}

/// Flags what is connected with the rims of end i and lies above its plane: owner[t] = i. Returns why that
/// cannot be cut off, if so.
std::string flood(const Connectivity& c, const std::vector<End>& ends, int i, const Plane& plane,
                  const std::vector<int>& border_at, std::vector<int>& owner) {
  auto above = [&](int v) { return plane.height(c.point(v)) > 0; };
  std::vector<int> stack;
  // what is farther away than the piece is long and wide is behind the cut
  const double reach = 2 * (norm(plane.point - ends[i].center) + 2 * ends[i].radius);
  auto away = [&](int v) { return norm(c.point(v) - ends[i].center); };
  bool ends_there = false, far = false;
  int met = -1;
  auto take = [&](int t) {
    const Tri& v = c.mesh.tris[t];
    const int n = above(v[0]) + above(v[1]) + above(v[2]);
    ends_there |= n < 3;
    if (n == 0 || owner[t] == i) return;
    if (owner[t] >= 0) {
      met = owner[t];
    } else if (std::min({away(v[0]), away(v[1]), away(v[2])}) > reach) {
      far = true;
    } else {
      owner[t] = i;
      stack.push_back(t);
    }
  };
  for (const std::vector<int>& rim : ends[i].rims)
    for (int v : rim) take(border_at[v] / 3);
  while (!stack.empty()) {
    const int t = take_last(stack);
    for (int h = 3 * t; h < 3 * t + 3; ++h)
      if (!c.is_border(h) && (above(c.from(h)) || above(c.to(h)))) take(c.opposite[h] / 3);
  }
  if (far) return "cutting at " + shown(plane.point) + " would remove a branch";
  if (met >= 0) return "the piece to be cut off meets that of " + title_of(ends, met);
  return ends_there ? "" : "cutting at " + shown(plane.point) + " would leave nothing of the vessel";
}

/// Returns per piece cut off the Euler number, and how many border loops it has.
struct Piece {
  int euler = 0, loops = 0;
};
std::vector<Piece> pieces_cut_off(const Mesh& mesh, const std::vector<int>& owner, int n) {
  std::vector<Piece> pieces(n);
  const std::vector<SubMesh> parts = split_by_label(mesh, owner, n);
  for (int i = 0; i < n; ++i) {
    if (parts[i].tris.empty()) continue;
    const auto opposite = opposite_halfedges(parts[i]);
    const int border = (int)std::count(opposite.begin(), opposite.end(), -1);
    const int faces = (int)parts[i].tris.size();
    pieces[i] = {(int)parts[i].points.size() - (3 * faces + border) / 2 + faces,
                 (int)boundary_loops(opposite).size()};
  }
  return pieces;
}

using Planes = std::vector<std::optional<Plane>>;

/// Cuts the triangles with an owner along its plane; `owner` then is that of what lies above.
void cut_above(Surface& surface, const Planes& planes, std::vector<int>& owner) {
  std::vector<double> field(surface.points.size(), -1);
  std::vector<char> active(owner.size(), 0);
  for (std::size_t t = 0; t < owner.size(); ++t)
    if (owner[t] >= 0) {
      active[t] = 1;
      for (int v : surface.tris[t]) field[v] = planes[owner[t]]->height(surface.points[v]);
    }
  surface.face.set("cut_end", owner);
  std::vector<int> side;
  cut_by_scalar_field(surface, field, active, side, snap);
  owner = surface.face.get<int>("cut_end");
  surface.face.erase("cut_end");
  for (std::size_t t = 0; t < side.size(); ++t)
    if (side[t] != 1) owner[t] = -1;
}

/// Gives the ends with a plane the new border loops as rims, and measures all. `near`: per vertex the end at
/// whose cut it is, or -1.
void take_rims(const Surface& surface, const Planes& planes, const std::vector<int>& near,
               std::vector<End>& ends) {
  const std::vector<int> opposite = opposite_halfedges(surface);
  for (std::size_t i = 0; i < ends.size(); ++i)
    if (planes[i]) ends[i].rims.clear();
  for (std::vector<int>& rim : rims_of({surface, opposite}))
    if (const int i = near[rim[0]]; i >= 0 && planes[i]) ends[i].rims.push_back(std::move(rim));
  for (End& end : ends) {
    if (end.rims.size() == 2 && end_of(surface, end.rims[0]).area < end_of(surface, end.rims[1]).area)
      std::swap(end.rims[0], end.rims[1]);
    measure(surface, end);
  }
}

}  // namespace

std::vector<std::optional<Plane>> planes_within(const Mesh& mesh, const std::vector<End>& ends,
                                                const std::vector<double>& length,
                                                std::vector<std::string>& why) {
  const std::vector<int> opposite = opposite_halfedges(mesh);
  WallFinder walls({mesh, opposite});
  std::vector<std::optional<Plane>> planes(ends.size());
  for (int i = 0; i < (int)ends.size(); ++i) {
    const End& end = ends[i];
    if (!(length[i] > 0)) continue;
    // paths along edges are longer than the axis, by a factor of two at most
    const Wall wall = walls.around(end, 2 * length[i] + 2 * end.radius);
    const std::vector<AxisPoint> axis = axis_of(mesh, end, wall);
    std::size_t k = 1;
    while (k < axis.size() && axis[k].length < length[i]) ++k;
    if (k >= axis.size()) {
      why[i] = "cannot be cut back by " + shown(length[i]) + ": the vessel behind it is " +
               shown(axis.back().length) + " long";
      continue;
    }
    const AxisPoint &a = axis[k - 1], &b = axis[k];
    const double s = (length[i] - a.length) / (b.length - a.length);
    const Vec3 rough = normalized(axis[k - (k > 1)].point - axis[std::min(k + 1, axis.size() - 1)].point);
    Plane plane{lerp(a.point, b.point, s), rough};
    plane.normal =
        axis_by_normals(mesh, wall, a.ring + s * (b.ring - a.ring), axis_reach * end.radius, rough);
    // all of the rim goes
    double lowest = 0;
    for (const std::vector<int>& rim : end.rims)
      for (int v : rim) lowest = std::min(lowest, plane.height(mesh.points[v]));
    if (lowest < 0) plane.point = plane.point + (lowest - below_rim * end.radius) * plane.normal;
    planes[i] = plane;
  }
  return planes;
}

std::vector<std::string> cut_ends(Surface& whole, std::vector<End>& ends,
                                  const std::vector<std::optional<Plane>>& planes) {
  const int n = (int)ends.size();
  std::vector<std::string> why(n);
  auto possible = [&] { return std::all_of(why.begin(), why.end(), [](auto& w) { return w.empty(); }); };
  if (std::none_of(planes.begin(), planes.end(), [](const auto& p) { return p.has_value(); })) return why;
  Surface surface = whole;
  const std::vector<int> opposite = opposite_halfedges(surface);
  const Connectivity c{surface, opposite};
  std::vector<int> border_at(c.n_vertices(), -1), owner(c.n_tris(), -1);
  for (int h = 0; h < c.n_half_edges(); ++h)
    if (c.is_border(h)) border_at[c.from(h)] = h;
  for (int i = 0; i < n; ++i)
    if (planes[i]) why[i] = flood(c, ends, i, *planes[i], border_at, owner);
  if (!possible()) return why;
  cut_above(surface, planes, owner);
  const std::vector<Piece> pieces = pieces_cut_off(surface, owner, n);
  for (int i = 0; i < n; ++i)
    if (const int rims = (int)ends[i].rims.size();
        planes[i] && (pieces[i].euler != 0 || pieces[i].loops != 2 * rims))
      why[i] = "cutting at " + shown(planes[i]->point) + " would remove a branch: the piece " +
               (pieces[i].loops == 2 * rims
                    ? "is not a tube"
                    : "has " + std::to_string(pieces[i].loops) + " borders, not " + std::to_string(2 * rims));
  if (!possible()) return why;
  std::vector<int> near(surface.points.size(), -1);  // which end a vertex of the cut belongs to
  std::vector<int> left;                             // triangles
  for (int t = 0; t < (int)owner.size(); ++t) {
    if (owner[t] < 0) left.push_back(t);
    for (int v : surface.tris[t])
      if (owner[t] >= 0) near[v] = owner[t];
  }
  for (int i = 0; i < n; ++i)
    for (const std::vector<int>& rim : ends[i].rims)
      for (int v : rim)
        if (const int by = near[v]; by >= 0 && by != i)
          why[by] = "cutting at " + shown(planes[by]->point) + " would remove " + title_of(ends, i);
  if (!possible()) return why;
  SurfacePart rest = take_faces(surface, std::move(left));
  std::vector<int> number(surface.points.size(), -1), near_new;
  for (int v : rest.vertex) {
    number[v] = (int)near_new.size();
    near_new.push_back(near[v]);
  }
  surface = std::move(rest.surface);
  for (int i = 0; i < n; ++i)
    for (std::vector<int>& rim : ends[i].rims)
      for (int& v : rim) v = number[v];
  take_rims(surface, planes, near_new, ends);
  whole = std::move(surface);
  return why;
}

void cut_possible_ends(Surface& surface, std::vector<End>& ends, std::vector<std::optional<Plane>>& planes,
                       std::vector<std::string>& why) {
  for (bool again = true; again;) {
    const std::vector<std::string> now = cut_ends(surface, ends, planes);
    again = false;
    for (std::size_t i = 0; i < now.size(); ++i)
      if (!now[i].empty()) {
        why[i] = now[i];
        planes[i].reset();
        again = true;
      }
  }
}

}  // namespace meshpipe
