// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>

#include "lib/size/size.h"

namespace meshpipe {
namespace {

/// Angle of the surface around a peak: three good triangles fill half a turn, and a mesh without a vertex
/// there ends where four edges fit around, more than half a size away.
constexpr double widest = std::numbers::pi;
constexpr double steep = 0.6;           ///< length of the mean normal; 0.5 at the widest cone
constexpr double scale = 0.5;           ///< of the size: what is sharp only below it is noise
constexpr int looks_per_triangle = 10;  ///< at triangles, for each triangle of the surface

/// The angle around a vertex at a distance.
class Around {
 public:
  explicit Around(const Connectivity& surface) : surface_(surface) {}

  /// Returns the length of the curve in which the surface that is connected with the origin of h has distance
  /// r from it, over r. Infinite where a border is nearer, or the curve empty.
  double angle(int h, double r) {
    if (seen_.empty()) seen_.assign(surface_.n_tris(), -1);
    const int center = surface_.from(h);
    const Vec3 p = surface_.point(center);
    double length = 0;
    queue_.assign(1, h / 3);
    seen_[h / 3] = center;
    for (std::size_t i = 0; i < queue_.size(); ++i, ++looks) {
      Vec3 end[2];
      int ends = 0;
      for (int g = 3 * queue_[i]; g < 3 * queue_[i] + 3; ++g) {
        const Vec3 a = surface_.point(surface_.from(g)) - p, b = surface_.point(surface_.to(g)) - p;
        const bool inside = dot(a, a) < r * r, ends_inside = dot(b, b) < r * r;
        if (!inside && !ends_inside) continue;
        if (surface_.is_border(g)) return infinity;
        if (inside != ends_inside && ends < 2) end[ends++] = inside ? crossing(a, b, r) : crossing(b, a, r);
        const int t = surface_.opposite[g] / 3;
        if (seen_[t] != center) seen_[t] = center, queue_.push_back(t);
      }
      if (ends == 2) length += norm(end[1] - end[0]);
    }
    return length > 0 ? length / r : infinity;
  }

  long long looks = 0;

 private:
  /// Where the way from a to b leaves the sphere of radius r around the origin.
  static Vec3 crossing(Vec3 a, Vec3 b, double r) {
    const Vec3 d = b - a;
    const double k = dot(a, d), l = dot(d, d);
    return a + (std::sqrt(std::max(0.0, k * k + l * (r * r - dot(a, a)))) - k) / l * d;
  }

  const Connectivity& surface_;
  std::vector<int> seen_, queue_;
};

}  // namespace

std::vector<Peak> sharp_peaks(const Connectivity& surface, const std::vector<double>& size) {
  const int n = surface.n_vertices();
  std::vector<Vec3> sum(n);          // of normals, each times the sine of its angle,
  std::vector<double> weight(n, 0);  // and of these
  for (int t = 0; t < surface.n_tris(); ++t) {
    const Vec3 a = surface.area_vector(t);
    const double l = norm(a),
                 length[3] = {surface.length(3 * t), surface.length(3 * t + 1), surface.length(3 * t + 2)};
    for (int i = 0; i < 3; ++i) {
      const int v = surface.mesh.tris[t][i];
      const double s = 1 / (length[i] * length[(i + 2) % 3]);
      if (std::isfinite(s)) sum[v] = sum[v] + s * a, weight[v] += s * l;
    }
  }
  for (int h = 0; h < surface.n_half_edges(); ++h)
    if (surface.is_border(h) || surface.is_model(h)) weight[surface.from(h)] = weight[surface.to(h)] = 0;
  std::vector<Peak> peaks;
  Around around(surface);
  for (int h = 0; h < surface.n_half_edges(); ++h) {
    const int v = surface.from(h);
    if (!(norm(sum[v]) < steep * weight[v])) continue;
    weight[v] = 0;
    double total = 0, nearest = infinity;
    surface.for_each_spoke(h, [&](int g) {
      const Vec3 a = surface.point(surface.to(g)) - surface.point(v);
      total += angle(a, surface.point(surface.apex(g)) - surface.point(v));
      nearest = std::min(nearest, norm(a));
    });
    if (total < widest && nearest < scale * size[v])
      total = around.looks < (long long)looks_per_triangle * surface.n_tris()
                  ? around.angle(h, scale * size[v])
                  : infinity;
    if (total < widest) peaks.push_back({v, total});
  }
  return peaks;
}

}  // namespace meshpipe
