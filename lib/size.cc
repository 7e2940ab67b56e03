// SPDX-License-Identifier: BSD-3-Clause
#include "lib/size.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "lib/curvature.h"
#include "lib/error.h"
#include "lib/neighbours.h"
#include "lib/number.h"
#include "lib/room.h"
#include "lib/split_edges.h"
#include "lib/topology.h"

namespace meshpipe {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// The field while it is made: wishes at the vertices, edges split where they are not linear.
class FieldMaker {
 public:
  FieldMaker(Surface& surface, Table* chart, const SizeOptions& options)
      : s_(surface), chart_(chart), o_(options), diagonal_(diagonal(surface)) {
    cap_ = o_.max > 0 ? o_.max : infinite;
    if (o_.size > 0) cap_ = std::min(cap_, o_.size);
    if (!(o_.size > 0 || o_.triangles > 0 || o_.max > 0 || o_.at || !o_.data.empty())) cap_ = 0.1 * diagonal_;
    connect();
    if (o_.per_turn > 0 || o_.chord > 0 || (o_.at && o_.at_curvature))
      curvature_ = face_curvature(
          s_, opposite_,
          s_.face.has("model") ? s_.face.get<std::uint8_t>("model") : std::vector<std::uint8_t>());
  }

  SizeReport make(bool may_split) {
    SizeReport report;
    const std::size_t n_before = s_.points.size();
    if (may_split && o_.at)  // a field may have its detail anywhere
      while (split([&](int h) { return length(h) > diagonal_ / 16; })) {
      }
    for (int pass = 0;; ++pass) {
      wish();
      if (o_.triangles > 0)
        meet_count();
      else
        size_ = field(infinite, 1);
      if (!may_split || pass == 12 || !split([&](int h) { return bends(h); })) break;
    }
    lower_where_narrow(report);
    report.added = static_cast<int>(s_.points.size() - n_before);
    report.scale = scale_;
    return report;
  }

  std::vector<double>& size() { return size_; }

 private:
  double length(int h) const { return norm(s_.points[target(s_.tris, h)] - s_.points[origin(s_.tris, h)]); }
  void connect() { opposite_ = opposite_halfedges(s_.tris, static_cast<int>(s_.points.size())); }

  /// The size that a curvature asks for.
  double by_curvature(double k) const {
    if (!(k > 0)) return infinite;
    double h = infinite;
    if (o_.per_turn > 0) h = 2 * 3.14159265358979324 / (o_.per_turn * k);
    // a chord of length h over an arc of radius r is r - sqrt(r^2 - h^2 / 4) away from it
    if (o_.chord > 0)
      h = std::min(h, o_.chord * k < 1 ? 2 * std::sqrt(2 * o_.chord / k - o_.chord * o_.chord) : 2 / k);
    return h;
  }

  double asked(Vec3 p, double curvature) const {
    const double h = o_.at(p, curvature);
    if (!(h > 0))
      throw BadInput("the size at " + shown(p.x) + ' ' + shown(p.y) + ' ' + shown(p.z) + " is " + shown(h) +
                     ", but sizes are positive");
    return h;
  }

  /// What the sources ask for at the vertices.
  void wish() {
    const std::size_t n = s_.points.size();
    wish_.assign(n, infinite);
    std::vector<double> most(n, 0);
    if (!curvature_.empty())
      for (std::size_t t = 0; t < s_.tris.size(); ++t) {
        const double h = by_curvature(curvature_[t]);
        for (int v : s_.tris[t]) {
          wish_[v] = std::min(wish_[v], h);
          most[v] = std::max(most[v], curvature_[t]);
        }
      }
    if (!o_.data.empty()) {
      const auto& data = s_.vertex.get<double>(o_.data);
      for (std::size_t v = 0; v < n; ++v) {
        if (!(data[v] > 0))
          throw BadInput("vertex " + std::to_string(v) + " has " + o_.data + ' ' + shown(data[v]) +
                         ", but sizes are positive");
        wish_[v] = std::min(wish_[v], data[v]);
      }
    }
    if (o_.at)
      for (std::size_t v = 0; v < n; ++v) wish_[v] = std::min(wish_[v], asked(s_.points[v], most[v]));
  }

  /// What the sources ask for in the middle of an edge.
  double wish_between(int h) const {
    const int a = origin(s_.tris, h), b = target(s_.tris, h), o = opposite_[h];
    double least = infinite, most = 0;
    if (!curvature_.empty()) {
      most = o >= 0 ? std::max(curvature_[h / 3], curvature_[o / 3]) : curvature_[h / 3];
      least = by_curvature(most);
    }
    if (!o_.data.empty()) {
      const auto& data = s_.vertex.get<double>(o_.data);
      least = std::min(least, 0.5 * (data[a] + data[b]));
    }
    if (o_.at) least = std::min(least, asked(lerp(s_.points[a], s_.points[b], 0.5), most));
    return least;
  }

  /// Lowers sizes where the surface has no room for such edges; the report has the place where that is most.
  void lower_where_narrow(SizeReport& report) {
    const auto model =
        s_.face.has("model") ? s_.face.get<std::uint8_t>("model") : std::vector<std::uint8_t>();
    if (curvature_.empty()) curvature_ = face_curvature(s_, opposite_, model);
    const std::vector<double> before = size_;
    const std::vector<double> room = edge_room(s_, opposite_, model, curvature_, before);
    double most = 1;
    for (std::size_t v = 0; v < room.size(); ++v) {
      const double r = std::max(room[v], o_.min);
      if (!(r < before[v])) continue;
      ++report.lowered;
      if (before[v] / r > most)
        most = before[v] / r, report.lowered_at = s_.points[v], report.asked = before[v], report.room = r;
    }
    if (report.lowered == 0) return;
    room_ = room;
    if (o_.triangles > 0)
      meet_count();
    else
      size_ = field(infinite, 1);
  }

  double bounded(double wish) const {
    return std::max(std::min({uniform_, cap_, diagonal_, scale_ * wish}), o_.min);
  }

  std::vector<double> field(double uniform, double scale) {
    uniform_ = uniform;
    scale_ = scale;
    std::vector<double> h(wish_.size());
    for (std::size_t v = 0; v < h.size(); ++v) {
      h[v] = bounded(wish_[v]);
      if (!room_.empty()) h[v] = std::min(h[v], std::max(room_[v], o_.min));
    }
    limit_gradation(s_, o_.gradation, h);
    return h;
  }

  /// True if interpolation along the edge misses the field in its middle, on a scale that a mesh would show.
  bool bends(int h) const {
    const int a = origin(s_.tris, h), b = target(s_.tris, h), o = opposite_[h];
    const double l = length(h);
    if (l < 0.5 * std::min(size_[a], size_[b])) return false;
    const Vec3 middle = lerp(s_.points[a], s_.points[b], 0.5);
    double m = std::min(bounded(wish_between(h)), std::min(size_[a], size_[b]) + 0.5 * o_.gradation * l);
    for (int side : {h, o}) {
      if (side < 0) continue;
      const int apex = target(s_.tris, next(side));
      m = std::min(m, size_[apex] + o_.gradation * norm(s_.points[apex] - middle));
    }
    const double linear = 0.5 * (size_[a] + size_[b]);
    return l > m && std::abs(m - linear) > 0.15 * m;
  }

  template <class Test>
  bool split(const Test& test) {
    std::vector<char> mark(opposite_.size(), 0);
    for (int h = 0; h < static_cast<int>(mark.size()); ++h)
      if (opposite_[h] < h) mark[h] = test(h);
    const std::vector<int> parent = split_edges(s_, opposite_, std::move(mark), chart_);
    if (parent.empty()) return false;
    connect();
    if (!curvature_.empty()) {
      std::vector<double> k;
      k.reserve(parent.size());
      for (int t : parent) k.push_back(curvature_[t]);
      curvature_ = std::move(k);
    }
    return true;
  }

  /// Sets size_ to the field that asks for o_.triangles. Its count falls as one number x grows: while x < 0
  /// the uniform length is e^x diagonals; beyond, the other sources are multiplied by e^x.
  void meet_count() {
    auto count_at = [&](double x) {
      size_ = field(x < 0 ? diagonal_ * std::exp(x) : infinite, x > 0 ? std::exp(x) : 1);
      return std::log(count_for_size(s_, size_) / o_.triangles);
    };
    double low = std::min(0.0, std::log(size_for_count(total_area(s_), o_.triangles) / diagonal_)),
           high = low;
    double above = count_at(low), below = above;
    while (below > 0 && high < 20) {
      if (high > low) low = high, above = below;
      high += 0.3;
      below = count_at(high);
      if (low > 0 && above - below < 1e-6) break;  // bounds let the sizes grow no more
    }
    if (below > 0) count_at(low);
    if (above <= 0 || below > 0)
      return;  // already the uniform length asks for no more, or all sizes are too small
    for (int i = 0; i < 30 && std::abs(below) > 1e-3 && high - low > 1e-6; ++i) {
      // regula falsi, halved when it creeps
      double x = low + (high - low) * std::clamp(above / (above - below), 0.05, 0.95);
      if (i % 3 == 2) x = 0.5 * (low + high);
      const double c = count_at(x);
      if (c > 0)
        low = x, above = c;
      else
        high = x, below = c;
      if (std::abs(c) < 1e-3) return;
    }
    count_at(high);
  }

  Surface& s_;
  Table* chart_;
  const SizeOptions& o_;
  double diagonal_, cap_ = 0, uniform_ = 0, scale_ = 1;
  std::vector<int> opposite_;
  std::vector<double> curvature_;  ///< per triangle
  std::vector<double> wish_, size_, room_;
};

}  // namespace

double size_for_count(double area, double n) {
  // an equilateral triangle of edge h has area h^2 sqrt(3) / 4
  return std::sqrt(4 * area / (std::sqrt(3.0) * n));
}

double count_for_size(const Mesh& mesh, const std::vector<double>& size) {
  double n = 0;
  for (const Tri& t : mesh.tris) {
    const double h = (size[t[0]] + size[t[1]] + size[t[2]]) / 3;
    n += norm(area_vector(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]])) / (h * h);
  }
  return 2 / std::sqrt(3.0) * n;
}

void refuse_more_triangles(const Mesh& mesh, const std::vector<double>& size, double limit) {
  const double smallest = *std::min_element(size.begin(), size.end());
  if (!(smallest > 0)) return;
  const double triangles = count_for_size(mesh, size);
  if (triangles <= limit) return;
  char why[120];
  std::snprintf(why, sizeof why, "size %.6g asks for %.3g triangles, but memory holds about %.2g", smallest,
                triangles, limit);
  throw GoalMissed(why);
}

void limit_gradation(const Mesh& mesh, double slope, std::vector<double>& size) {
  const Neighbours next(mesh);
  using Item = std::pair<double, int>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
  auto lower = [&](int v, const auto& found) {
    for (int k = next.start[v]; k < next.start[v + 1]; ++k) {
      const int u = next.vertex[k];
      if (size[u] <= size[v]) continue;
      const double most = size[v] + slope * norm(mesh.points[u] - mesh.points[v]);
      if (most < size[u] && found(u, most)) return;
    }
  };
  for (int v = 0; v < (int)size.size(); ++v)
    lower(v, [&](int, double) {
      queue.push({size[v], v});
      return true;
    });
  while (!queue.empty()) {
    const auto [h, v] = queue.top();
    queue.pop();
    if (h > size[v]) continue;
    lower(v, [&](int u, double most) {
      size[u] = most;
      queue.push({most, u});
      return false;
    });
  }
}

SizeReport set_size(Surface& surface, Table* chart, const SizeOptions& options, bool may_split) {
  if (surface.tris.empty()) throw NotAdmissible("the surface has no triangles");
  const double area = total_area(surface);
  if (!(area > 0)) throw NotAdmissible("the surface has no area");
  const bool uniform = !(options.per_turn > 0 || options.chord > 0 || !options.data.empty() || options.at);
  SizeReport report;
  std::vector<double> size;
  if (uniform) {
    double h = options.size > 0 ? options.size : infinite;
    if (options.triangles > 0) h = std::min(h, size_for_count(area, options.triangles));
    if (options.max > 0) h = std::min(h, options.max);
    size.assign(surface.points.size(), std::max(h, options.min));
  } else {
    FieldMaker maker(surface, chart, options);
    report = maker.make(may_split);
    size = std::move(maker.size());
  }
  report.triangles = count_for_size(surface, size);
  const auto [least, most] = std::minmax_element(size.begin(), size.end());
  report.smallest = *least;
  report.largest = *most;
  refuse_more_triangles(surface, size, options.most_triangles);
  surface.vertex.set("size", std::move(size));
  return report;
}

}  // namespace meshpipe
