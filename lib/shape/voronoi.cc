// SPDX-License-Identifier: BSD-3-Clause
// Voronoi diagrams in a cube or a ball of plane facets, polygon by polygon.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "lib/core/connectivity.h"
#include "lib/core/lists.h"
#include "lib/core/random.h"
#include "lib/core/weld.h"
#include "lib/shape/shape.h"
#include "lib/shape/split_triangle.h"

namespace meshpipe {
namespace {

/// A corner by the seeds it is equally far from, ascending; numbers from that of seeds on: sides of the body.
using Key = std::array<int, 4>;

struct Plane {
  Vec3 normal;
  double offset;
};

/// A convex body, within 4 of all its points.
class Diagram {
 public:
  Diagram(int n, std::vector<Plane> sides, int seed) : n_(n), sides_(std::move(sides)) { spread(seed); }
  void set_sides(std::vector<Plane> sides) { sides_ = std::move(sides); }
  /// The polygon between seed i and seed or side j, by corners in order; empty if they are not adjacent.
  std::vector<Key> polygon(int i, int j) const;
  /// All polygons that are not empty.
  std::vector<std::vector<Key>> polygons() const;
  Vec3 corner(const Key& key) const;
  int sides() const { return n_ + (int)sides_.size(); }

 private:
  /// Half the difference of the squared distances from seed i and c, or the distance outside of side c.
  double beyond(int i, int c, Vec3 p) const {
    if (c < n_) return 0.5 * (dot(p - seeds_[i], p - seeds_[i]) - dot(p - seeds_[c], p - seeds_[c]));
    return dot(sides_[c - n_].normal, p) - sides_[c - n_].offset;
  }
  void spread(int seed);
  int n_;
  std::vector<Plane> sides_;
  std::vector<Vec3> seeds_;
};

/// Random seeds, which then move to the middle of their regions a few times (Lloyd), by samples.
void Diagram::spread(int seed) {
  Random random(seed);
  auto anywhere = [&] {
    for (;;) {
      const Vec3 p{2 * random.uniform() - 1, 2 * random.uniform() - 1, 2 * random.uniform() - 1};
      if (std::all_of(sides_.begin(), sides_.end(),
                      [&](const Plane& s) { return dot(s.normal, p) < s.offset; }))
        return p;
    }
  };
  for (int s = 0; s < n_; ++s) seeds_.push_back(anywhere());
  constexpr int rounds = 5, samples = 20000;
  for (int round = 0; round < rounds; ++round) {
    std::vector<Vec3> sum(n_);
    std::vector<int> count(n_, 0);
    for (int i = 0; i < samples; ++i) {
      const Vec3 p = anywhere();
      int best = 0;
      double least = infinity;
      for (int s = 0; s < n_; ++s)
        if (const double d = dot(p - seeds_[s], p - seeds_[s]); d < least) least = d, best = s;
      sum[best] = sum[best] + p;
      ++count[best];
    }
    for (int s = 0; s < n_; ++s)
      if (count[s]) seeds_[s] = (1.0 / count[s]) * sum[s];
  }
}

std::vector<Key> Diagram::polygon(int i, int j) const {
  struct Corner {
    Vec3 p;
    int line;  ///< what bounds the edge that follows
  };
  // a square in the plane, larger than what the body leaves of it
  Vec3 middle, normal;
  if (j < n_)
    middle = lerp(seeds_[i], seeds_[j], 0.5), normal = normalized(seeds_[j] - seeds_[i]);
  else
    normal = sides_[j - n_].normal, middle = sides_[j - n_].offset * normal;
  const Vec3 off = std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u = 4 * normalized(cross(normal, off)), v = cross(normal, u);
  std::vector<Corner> now{
      {middle - u - v, -1}, {middle + u - v, -1}, {middle + u + v, -1}, {middle - u + v, -1}},
      next;
  for (int c = 0; c < sides() && !now.empty(); ++c) {
    if (c == i || c == j) continue;
    next.clear();
    for (std::size_t k = 0; k < now.size(); ++k) {
      const Corner &a = now[k], &b = now[(k + 1) % now.size()];
      const double x = beyond(i, c, a.p), y = beyond(i, c, b.p);
      if (x <= 0) next.push_back(a);
      if ((x <= 0) != (y <= 0)) next.push_back({lerp(a.p, b.p, x / (x - y)), x <= 0 ? c : a.line});
    }
    now.swap(next);
  }
  std::vector<Key> keys;
  for (std::size_t k = 0; k < now.size(); ++k) {
    Key key{i, j, now[(k + now.size() - 1) % now.size()].line, now[k].line};
    std::sort(key.begin(), key.end());
    keys.push_back(key);
  }
  return keys;
}

std::vector<std::vector<Key>> Diagram::polygons() const {
  std::vector<std::vector<Key>> all;
  for (int i = 0; i < n_; ++i)
    for (int j = i + 1; j < sides(); ++j)
      if (std::vector<Key> p = polygon(i, j); p.size() >= 3) all.push_back(std::move(p));
  return all;
}

Vec3 Diagram::corner(const Key& key) const {
  Vec3 row[3];
  double right[3];
  for (int k = 0; k < 3; ++k) {
    const int c = key[k + 1];
    if (c < n_) {
      row[k] = seeds_[c] - seeds_[key[0]];
      right[k] = 0.5 * (dot(seeds_[c], seeds_[c]) - dot(seeds_[key[0]], seeds_[key[0]]));
    } else {
      row[k] = sides_[c - n_].normal;
      right[k] = sides_[c - n_].offset;
    }
  }
  const double det = dot(row[0], cross(row[1], row[2]));
  return (1 / det) * (right[0] * cross(row[1], row[2]) + right[1] * cross(row[2], row[0]) +
                      right[2] * cross(row[0], row[1]));
}

/// The unit cube around the origin, or facets around the unit ball, at the points of a spherical Fibonacci
/// lattice.
std::vector<Plane> body(bool ball, int n_facets) {
  if (!ball)
    return {{{1, 0, 0}, 0.5},  {{-1, 0, 0}, 0.5}, {{0, 1, 0}, 0.5},
            {{0, -1, 0}, 0.5}, {{0, 0, 1}, 0.5},  {{0, 0, -1}, 0.5}};
  std::vector<Plane> facets;
  for (int i = 0; i < n_facets; ++i) {
    const double z = (2 * i + 1.0) / n_facets - 1, r = std::sqrt(1 - z * z);
    const double angle = 2 * std::numbers::pi * i / std::numbers::phi;
    facets.push_back({{r * std::cos(angle), r * std::sin(angle), z}, 1});
  }
  return facets;
}

}  // namespace

Mesh voronoi(int seeds, bool ball, int n, int seed) {
  // a facet has about 6 edges; above 1000 they are seen no longer, and cost their square
  constexpr int least_facets = 50, most_facets = 1000, tries = 4;
  constexpr double per_facet = 6.5, enough = 0.03;  // edges; relative difference of their number
  int facets = std::clamp(n / 12, least_facets, most_facets);
  Diagram diagram(seeds, body(ball, facets), seed);
  std::vector<std::vector<Key>> polygons;
  std::vector<Key> keys;
  double edges = 0;
  int k = 0;  // each triangle of an edge and the middle of its polygon becomes k^2
  for (int i = 0; i < tries; ++i) {
    polygons = diagram.polygons();
    keys.clear();
    for (const std::vector<Key>& polygon : polygons) keys.insert(keys.end(), polygon.begin(), polygon.end());
    edges = (double)keys.size();
    if (!ball) k = std::max(1, (int)std::lround(std::sqrt(n / edges)));
    if (k == 0) k = std::max(1, (int)std::ceil(std::sqrt(n / (edges + per_facet * (most_facets - facets)))));
    const double more = (double)n / k / k - edges;
    const int next = std::clamp(facets + (int)(more / per_facet), least_facets, most_facets);
    if (!ball || next == facets || std::abs(more) < enough * edges || i + 1 == tries) break;
    diagram.set_sides(body(ball, facets = next));
  }
  sort_unique(keys);
  std::vector<Vec3> corners;
  for (const Key& key : keys) corners.push_back(diagram.corner(key));
  Mesh mesh;
  for (const std::vector<Key>& polygon : polygons) {
    std::vector<int> number;
    Vec3 middle;
    for (const Key& key : polygon) {
      number.push_back((int)(std::lower_bound(keys.begin(), keys.end(), key) - keys.begin()));
      middle = middle + (1.0 / (double)polygon.size()) * corners[number.back()];
    }
    corners.push_back(middle);
    for (std::size_t e = 0; e < number.size(); ++e)
      add_split_triangle(mesh, k, {number[e], number[(e + 1) % number.size()], (int)corners.size() - 1},
                         [&](const CornerShares& shares) {
                           Vec3 p;
                           for (auto [c, share] : shares) p = p + (double)share / k * corners[c];
                           return p;
                         });
  }
  weld(mesh);
  return mesh;
}

}  // namespace meshpipe
