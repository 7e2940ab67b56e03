// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/least_area.h"

#include "lib/core/lists.h"

namespace meshpipe {
namespace {

/// Weight of squared edge lengths against the area, over the squared number of corners: decides between
/// triangulations of a plane hole, which all have the same area unless they fold. A fold at the rim of n
/// corners costs an area of 1/n of what it saves in lengths, times the angle of the rim there, about 1/n.
constexpr double edge_weight = 1e-3;

/// The best triangulation of a loop by dynamic programming: best[i][j] is the least cost of the polygon i,
/// i+1 ... j.
class Polygon {
 public:
  Polygon(const std::vector<Vec3>& corners, const std::vector<char>& joined)
      : p_(corners),
        n_((int)corners.size()),
        joined_(joined),
        edge_weight_(edge_weight / n_ / n_),
        cost_(n_ * n_, 0),
        apex_(n_ * n_, -1) {}

  std::vector<Tri> triangles() {
    for (int span = 2; span < n_; ++span)
      for (int i = 0; i + span < n_; ++i) {
        const int j = i + span;
        double least = infinity;
        const bool chord = span < n_ - 1;  // the last edge, n-1 to 0, is the loop's own
        if (!chord || !joined_[i * n_ + j])
          for (int k = i + 1; k < j; ++k) {
            const double c = cost_[i * n_ + k] + cost_[k * n_ + j] + cost(i, k, j);
            if (c < least) {
              least = c;
              apex_[i * n_ + j] = k;
            }
          }
        cost_[i * n_ + j] = least;
      }
    std::vector<Tri> tris;
    if (cost_[n_ - 1] == infinity) return tris;
    std::vector<std::array<int, 2>> stack{{0, n_ - 1}};
    while (!stack.empty()) {
      const auto [i, j] = take_last(stack);
      if (j - i < 2) continue;
      const int k = apex_[i * n_ + j];
      tris.push_back({i, k, j});
      stack.push_back({i, k});
      stack.push_back({k, j});
    }
    return tris;
  }

 private:
  double cost(int i, int k, int j) const {
    const Vec3 a = p_[k] - p_[i], b = p_[j] - p_[k], c = p_[i] - p_[j];
    return 0.5 * norm(cross(a, c)) + edge_weight_ * (dot(a, a) + dot(b, b) + dot(c, c));
  }

  const std::vector<Vec3>& p_;
  const int n_;
  const std::vector<char>& joined_;
  const double edge_weight_;
  std::vector<double> cost_;
  std::vector<int> apex_;
};

}  // namespace

std::vector<Tri> least_area_triangles(const std::vector<Vec3>& corners, const std::vector<char>& joined) {
  return Polygon(corners, joined).triangles();
}

}  // namespace meshpipe
