// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "lib/cap/steps.h"
#include "lib/core/bvh.h"
#include "lib/core/intersect.h"
#include "lib/core/shortest_paths.h"
#include "lib/core/split_edges.h"
#include "lib/core/topology.h"

namespace meshpipe {
namespace {

/// Width of the band in which a movement fades out, in its lengths. The wall is compressed by at most 1.5 / 8
/// of itself at first; wider bands are tried where triangles fold or intersect.
constexpr double first_width = 8;
constexpr int widenings = 3;  // by a factor of 2
/// And at least this much of the radius, so that the wall bends smoothly.
constexpr double least_width = 0.5;
/// Vertices of the rim to either side of the nearest one, among which the nearest edge is looked for.
constexpr int window = 6;

/// Share of the way to the wall by which the middle of an edge between vertices of a rim is moved.
constexpr double sink = 0.25;

/// From 1 at 0 to 0 at 1, with slope 0 at both and at most 1.5.
double fade(double x) { return x >= 1 ? 0 : (1 - x) * (1 - x) * (1 + 2 * x); }

/// A vertex of a rim, of which end, and where in it.
struct RimPlace {
  int end = -1, rim = 0, at = 0;
};

/// The movement of one mesh, all ends together: every vertex follows the rim that is nearest along edges.
class Flattener {
 public:
  Flattener(Mesh& mesh, const std::vector<End>& ends, const std::vector<std::optional<Plane>>& planes)
      : mesh_(mesh),
        ends_(ends),
        planes_(planes),
        before_(mesh.points),
        source_(mesh.points.size()),
        distance_(mesh.points.size(), infinity),
        height_(ends.size(), 0),
        gap_(ends.size(), infinity) {
    for (std::size_t i = 0; i < ends.size(); ++i)
      if (planes[i])
        for (const std::vector<int>& rim : ends[i].rims)
          for (int v : rim) height_[i] = std::max(height_[i], std::abs(planes[i]->height(before_[v])));
    find_nearest_rims();
  }

  std::vector<double> run() {
    const int n = (int)ends_.size();
    std::vector<double> width(n), moved(n, 0);
    for (int i = 0; i < n; ++i) width[i] = std::max(first_width * height_[i], least_width * ends_[i].radius);
    std::vector<char> todo(n, 0);
    for (int i = 0; i < n; ++i) todo[i] = planes_[i] && height_[i] > 0;
    for (int round = 0; round <= widenings; ++round) {
      if (std::count(todo.begin(), todo.end(), 1) == 0) break;
      for (int i = 0; i < n; ++i)
        if (todo[i]) move(i, width[i]);
      const std::vector<char> bad = faulty();
      for (int i = 0; i < n; ++i) {
        moved[i] = todo[i] && !bad[i] ? height_[i] : moved[i];
        if (bad[i]) restore(i), moved[i] = -1, width[i] *= 2;
        todo[i] = bad[i];
      }
    }
    return moved;
  }

 private:
  void find_nearest_rims() {
    std::vector<int> sources;
    std::vector<double> reach(ends_.size());
    double farthest = 0;
    for (int i = 0; i < (int)ends_.size(); ++i) {
      const double w = std::max(first_width * height_[i], least_width * ends_[i].radius);
      farthest = std::max(farthest, (1 << widenings) * w);
      for (int r = 0; r < (int)ends_[i].rims.size(); ++r)
        for (int k = 0; k < (int)ends_[i].rims[r].size(); ++k) {
          const int v = ends_[i].rims[r][k];
          source_[v] = {i, r, k};
          distance_[v] = 0;
          sources.push_back(v);
        }
    }
    const Lists neighbors = neighbors_of(mesh_);
    members_.resize(ends_.size());
    shortest_paths(sources, distance_, [&](int v, auto step) {
      const int i = source_[v].end;
      if (distance_[v] > farthest) return false;
      members_[i].push_back(v);
      for (int w : neighbors[v]) {
        if (step(w, distance_[v] + norm(before_[w] - before_[v])))
          source_[w] = source_[v];
        else if (source_[w].end >= 0 && source_[w].end != i)
          gap_[i] = std::min(gap_[i], distance_[v]),
          gap_[source_[w].end] = std::min(gap_[source_[w].end], distance_[w]);
      }
      return true;
    });
  }

  /// How far the rim is to move at its edge nearest to p, as seen along the normal.
  double height_at(Vec3 p, const RimPlace& near) const {
    const Plane& plane = *planes_[near.end];
    const std::vector<int>& rim = ends_[near.end].rims[near.rim];
    const int n = (int)rim.size();
    double best = infinity, height = 0;
    const int reach = std::min(window, n / 2);
    for (int k = -reach; k < reach; ++k) {
      const Vec3 a = before_[rim[((near.at + k) % n + n) % n]],
                 b = before_[rim[((near.at + k + 1) % n + n) % n]];
      const double ha = plane.height(a), hb = plane.height(b);
      const Vec3 along = b - a - (hb - ha) * plane.normal, to = p - a - (plane.height(p) - ha) * plane.normal;
      const double length = dot(along, along);
      const double s = length > 0 ? std::clamp(dot(to, along) / length, 0.0, 1.0) : 0;
      const double d = norm(to - s * along);
      if (d < best) best = d, height = ha + s * (hb - ha);
    }
    return height;
  }

  void move(int i, double width) {
    const Plane& plane = *planes_[i];
    width = std::min(width, gap_[i]);
    for (int v : members_[i]) {
      if (distance_[v] >= width && distance_[v] > 0) break;
      const Vec3 p = before_[v];
      const double h =
          distance_[v] == 0 ? plane.height(p) : height_at(p, source_[v]) * fade(distance_[v] / width);
      mesh_.points[v] = p - h * plane.normal;
    }
    for (const std::vector<int>& rim : ends_[i].rims)  // once more, against rounding
      for (int v : rim) mesh_.points[v] = mesh_.points[v] - plane.height(mesh_.points[v]) * plane.normal;
  }

  void restore(int i) {
    for (int v : members_[i]) mesh_.points[v] = before_[v];
  }

  /// Flags the ends whose movement folds a triangle, or makes some intersect that did not before.
  std::vector<char> faulty() const {
    std::vector<char> bad(ends_.size(), 0), moved(mesh_.tris.size(), 0);
    auto blame = [&](int t) {
      for (int v : mesh_.tris[t])
        if (!(mesh_.points[v] == before_[v])) bad[source_[v].end] = 1;
    };
    for (std::size_t t = 0; t < moved.size(); ++t) {
      const auto& [a, b, c] = mesh_.tris[t];
      for (int v : mesh_.tris[t]) moved[t] |= !(mesh_.points[v] == before_[v]);
      if (moved[t] && dot(area_vector(mesh_, (int)t), area_vector(before_[a], before_[b], before_[c])) <= 0)
        blame((int)t);
    }
    const Mesh before{before_, mesh_.tris};
    for (const Collision& c : collisions(mesh_, moved))
      if (!triangles_intersect(before, c.triangle, c.other)) blame(c.triangle), blame(c.other);
    return bad;
  }

  Mesh& mesh_;
  const std::vector<End>& ends_;
  const std::vector<std::optional<Plane>>& planes_;
  const std::vector<Vec3> before_;
  std::vector<RimPlace> source_;           ///< per vertex: the nearest of a rim
  std::vector<double> distance_;           ///< from that, along edges
  std::vector<std::vector<int>> members_;  ///< per end: its vertices, by distance
  std::vector<double> height_;             ///< per end: farthest from its plane
  std::vector<double> gap_;                ///< per end: distance at which another one is nearer
};

}  // namespace

std::vector<Collision> collisions(const Mesh& mesh, const std::vector<char>& flagged) {
  std::vector<Collision> found;
  if (std::count(flagged.begin(), flagged.end(), 0) == (std::ptrdiff_t)flagged.size()) return found;
  const Bvh tree(mesh);
  for (int t = 0; t < (int)flagged.size(); ++t) {
    if (!flagged[t] || norm(area_vector(mesh, t)) == 0) continue;
    const Box box = box_of(mesh, t);
    tree.overlapping(box, [&](int s) {
      if (s == t || (flagged[s] && s < t)) return;
      const Box other = box_of(mesh, s);
      if (!overlap(box, other) || norm(area_vector(mesh, s)) == 0 || !triangles_intersect(mesh, t, s)) return;
      found.push_back({t, s, lerp(upper(box.lo, other.lo), lower(box.hi, other.hi), 0.5)});
    });
  }
  std::sort(found.begin(), found.end(), [](const Collision& a, const Collision& b) {
    return std::pair(a.triangle, a.other) < std::pair(b.triangle, b.other);
  });
  return found;
}

std::vector<Collision> collisions_of_new(const Mesh& mesh, const std::vector<int>& owner) {
  std::vector<char> flagged;
  for (int i : owner) flagged.push_back(i >= 0);
  return collisions(mesh, flagged);
}

void split_chords(Surface& surface, const std::vector<End>& ends) {
  std::vector<int> opposite = opposite_halfedges(surface);
  std::vector<char> rim(surface.points.size(), 0), mark(3 * surface.tris.size(), 0);
  for (const End& end : ends)
    for (const std::vector<int>& loop : end.rims)
      for (int v : loop) rim[v] = 1;
  for (std::size_t h = 0; h < mark.size(); ++h)
    mark[h] = opposite[h] >= 0 && rim[origin(surface.tris, (int)h)] && rim[target(surface.tris, (int)h)];
  if (std::count(mark.begin(), mark.end(), 1) == 0) return;
  const int before = (int)rim.size();
  split_edges({surface, opposite}, mark, nullptr);
  // each new vertex leaves the rim's plane for the vertices of the wall that are opposite, or for those that
  // have left it: parts of the wall may lie in the plane
  std::vector<char> left(surface.points.size(), 0);
  for (int v = 0; v < before; ++v) left[v] = !rim[v];
  for (bool again = true; again;) {
    std::vector<Vec3> sum(surface.points.size() - rim.size());
    std::vector<int> count(sum.size(), 0);
    for (const Tri& t : surface.tris)
      for (int v : t)
        for (int w : t)
          if (!left[v] && v >= before && left[w]) {
            sum[v - before] = sum[v - before] + surface.points[w];
            ++count[v - before];
          }
    again = false;
    for (std::size_t k = 0; k < sum.size(); ++k)
      if (count[k] > 0) {
        Vec3& p = surface.points[rim.size() + k];
        p = lerp(p, (1.0 / count[k]) * sum[k], sink);
        left[rim.size() + k] = again = true;
      }
  }
}

std::vector<double> flatten_ends(Mesh& mesh, const std::vector<End>& ends,
                                 const std::vector<std::optional<Plane>>& planes) {
  return Flattener(mesh, ends, planes).run();
}

}  // namespace meshpipe
