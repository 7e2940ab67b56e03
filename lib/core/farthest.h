// SPDX-License-Identifier: BSD-3-Clause
// The point of a triangle that is farthest from another surface, by halving.
#pragma once
#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

#include "lib/core/bvh.h"

namespace meshpipe {

/// A part of a triangle, with the triangles of another surface that are nearest to its corners.
struct Piece {
  std::array<Vec3, 3> corner;
  std::array<int, 3> face;
  std::array<double, 3> distance;

  double side(int i) const { return norm(corner[next(i)] - corner[i]); }
  int longest() const {
    return std::max({0, 1, 2}, [&](int i, int k) { return side(i) < side(k); });
  }
  /// Returns whether no point is farther than `limit`: none is farther from a corner than the longest side
  /// over sqrt(3), and distance from one triangle of the other surface is convex.
  bool within(double limit, const Mesh& other) const {
    const double most = *std::max_element(distance.begin(), distance.end());
    if (most + side(longest()) / std::numbers::sqrt3 <= limit) return true;
    return std::any_of(face.begin(), face.end(), [&](int f) {
      return std::all_of(corner.begin(), corner.end(),
                         [&](Vec3 p) { return norm(closest_point(other, f, p) - p) <= limit; });
    });
  }
};

constexpr double farther_by = 1.02;  ///< than the farthest so far: less is not looked for

struct Farthest {
  Vec3 point;
  Bvh::Hit hit;          ///< what is nearest to it
  bool complete = true;  ///< false: halving has ended before all was searched
  int halvings = 0;
};

/// Returns the point of the piece that is farthest from the other surface over allowed(f), where triangle f
/// of that is nearest, and more than that; corners are not looked at. `nearest` returns the hit of a point.
template <class Allowed, class Nearest>
Farthest farthest(const Piece& whole, const Mesh& other, Allowed allowed, Nearest nearest,
                  int most_halvings = 400) {
  std::vector<Piece> pieces{whole};
  Farthest most;
  double most_over = 0;  // its distance over what is allowed
  for (; !pieces.empty() && most.halvings < most_halvings; ++most.halvings) {
    const Piece piece = pieces.back();
    pieces.pop_back();
    const double least = std::min({allowed(piece.face[0]), allowed(piece.face[1]), allowed(piece.face[2])});
    if (piece.within(std::max(1.0, farther_by * most_over) * least, other)) continue;
    const int k = piece.longest();
    const Vec3 middle = lerp(piece.corner[k], piece.corner[next(k)], 0.5);
    const Bvh::Hit hit = nearest(middle);
    if (const double over = hit.distance / allowed(hit.place.face); over > most_over)
      most.point = middle, most.hit = hit, most_over = over;
    for (int end : {k, next(k)}) {
      Piece& half = pieces.emplace_back(piece);
      half.corner[end] = middle, half.distance[end] = hit.distance, half.face[end] = hit.place.face;
    }
  }
  most.complete = pieces.empty();
  return most;
}

}  // namespace meshpipe
