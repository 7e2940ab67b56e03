// SPDX-License-Identifier: BSD-3-Clause
#include "lib/lines/sharp_corners.h"

#include <algorithm>
#include <cmath>

#include "lib/core/union_find.h"
#include "lib/lines/lines.h"

namespace meshpipe {
namespace {

constexpr double per_width = 8;  ///< length of segments over width; sizes ask for 7, 10 makes kappa 0.1
constexpr double widest = 1 / per_width;  ///< radians: in wider sectors the first segments are good
constexpr double most_of_line = 0.7;      ///< of the shortest line: its other end may be sharp, too
constexpr int most_cuts = 300;            ///< of a line: corners that need more are left as they are

/// The end of an open line.
struct LineEnd {
  int vertex, next;  ///< of its first edge
  int line;
  bool back;  ///< is it the line's end, not its start?
  auto operator<=>(const LineEnd&) const = default;
};

/// A line as seen from one of its ends.
class FromEnd {
 public:
  FromEnd(const Mesh& mesh, const Chains& chains, const LineEnd& end)
      : chains_(chains), chain_(chains.chain[end.line]), back_(end.back), along_(chain_.count, 0) {
    auto point = [&](int i) { return mesh.points[chains.vertex[chain_.first + i]]; };
    for (int i = 1; i < chain_.count; ++i) along_[i] = along_[i - 1] + norm(point(i) - point(i - 1));
  }

  double length() const { return along_.back(); }
  /// Returns the length of the segment at a distance.
  double segment_at(const std::vector<Cut>& cuts, double d) const {
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
      const auto [near, far] = std::minmax({distance(cuts[k]), distance(cuts[k + 1])});
      if (near <= d && d < far) return far - near;
    }
    return 0;
  }
  /// Puts cuts at these distances, ascending, instead of those up to `reach`.
  void replace(std::vector<Cut>& cuts, const std::vector<double>& distances, double reach) const {
    std::vector<Cut> all;
    for (const Cut& c : cuts)
      if (const double d = distance(c); d <= 0 || d >= length() || d > reach) all.push_back(c);
    for (double d : distances) all.push_back(cut_at(back_ ? length() - d : d));
    std::sort(all.begin(), all.end(), [](const Cut& a, const Cut& b) { return a.measure < b.measure; });
    cuts = std::move(all);
  }

 private:
  double distance(const Cut& c) const {
    const double d = along_[c.piece] + (c.t > 0 ? c.t * (along_[c.piece + 1] - along_[c.piece]) : 0);
    return back_ ? length() - d : d;
  }
  Cut cut_at(double d) const {
    int i = (int)(std::upper_bound(along_.begin(), along_.end(), d) - along_.begin()) - 1;
    i = std::clamp(i, 0, chain_.count - 2);
    const double t = (d - along_[i]) / (along_[i + 1] - along_[i]), x = chains_.ratio[chain_.first + i];
    const double share = std::abs(x) < 1e-8 ? t : std::log1p(x * t) / std::log1p(x);  // of 1/h, h linear
    const double* measure = &chains_.measure[chain_.first + i];
    return {i, t, measure[0] + share * (measure[1] - measure[0])};
  }

  const Chains& chains_;
  const Chain& chain_;
  bool back_;
  std::vector<double> along_;
};

std::vector<LineEnd> ends_of_lines(const Chains& chains) {
  std::vector<LineEnd> ends;
  for (int l = 0; l < (int)chains.chain.size(); ++l) {
    const Chain& c = chains.chain[l];
    if (c.closed || c.kind == interface_line) continue;
    const int* v = &chains.vertex[c.first];
    ends.push_back({v[0], v[1], l, false});
    ends.push_back({v[c.count - 1], v[c.count - 2], l, true});
  }
  std::sort(ends.begin(), ends.end());
  return ends;
}

/// Two ends of lines with a sharp sector between them.
struct Sector {
  int right, left;
  double angle;
};

std::vector<Sector> sharp_sectors(const Connectivity& mesh, const std::vector<LineEnd>& ends) {
  std::vector<char> is_end(mesh.n_vertices(), 0);
  for (const LineEnd& e : ends) is_end[e.vertex] = 1;
  auto end_at = [&](int v, int next) {
    const auto e = std::lower_bound(ends.begin(), ends.end(), LineEnd{v, next, -1, false});
    return e != ends.end() && e->vertex == v && e->next == next ? (int)(e - ends.begin()) : -1;
  };
  std::vector<Sector> sectors;
  for (int h = 0; h < mesh.n_half_edges(); ++h) {
    const int v = mesh.from(h), right = is_end[v] ? end_at(v, mesh.to(h)) : -1;
    if (right < 0) continue;
    double sum = 0;
    int left = -1;
    for (int g = h; g >= 0 && left < 0 && sum < widest; g = mesh.opposite[prev(g)]) {
      sum += angle(mesh.point(mesh.to(g)) - mesh.point(v), mesh.point(mesh.apex(g)) - mesh.point(v));
      left = end_at(v, mesh.apex(g));
    }
    if (left >= 0 && sum < widest && sum > 0 && ends[left].line != ends[right].line)
      sectors.push_back({right, left, sum});
  }
  return sectors;
}

}  // namespace

void divide_at_sharp_corners(const Connectivity& mesh, const std::vector<double>& size, const Chains& chains,
                             Division& division) {
  const std::vector<LineEnd> ends = ends_of_lines(chains);
  const std::vector<Sector> sectors = sharp_sectors(mesh, ends);
  auto leader = [&](int e) { return chains.leader.empty() ? ends[e].line : chains.leader[ends[e].line]; };
  // a fan of sectors, and all that share lines with it where sheets meet, is divided as the sharpest of them
  UnionFind fans((int)ends.size());
  for (const Sector& s : sectors) fans.join(s.right, s.left);
  std::vector<std::array<int, 2>> first(chains.chain.size(), {-1, -1});  // of the ends of copies of a line
  for (int e = 0; e < (int)ends.size(); ++e) {
    int& f = first[leader(e)][ends[e].back];
    if (f < 0) f = e;
    fans.join(f, e);
  }
  std::vector<double> sharpest(ends.size(), infinity);
  for (const Sector& s : sectors)
    sharpest[fans.find(s.left)] = std::min(sharpest[fans.find(s.left)], s.angle);
  std::vector<std::vector<int>> members(ends.size());
  for (int e = 0; e < (int)ends.size(); ++e)
    if (leader(e) == ends[e].line && sharpest[fans.find(e)] < widest) members[fans.find(e)].push_back(e);
  for (const std::vector<int>& fan : members) {
    if (fan.empty()) continue;
    const double growth = per_width * sharpest[fans.find(fan[0])];
    std::vector<FromEnd> lines;
    double shortest = infinity;
    for (int e : fan) {
      lines.emplace_back(mesh.mesh, chains, ends[e]);
      shortest = std::min(shortest, lines.back().length());
    }
    std::vector<double> distances;
    bool good = false;
    for (double d = size[ends[fan[0]].vertex]; d < most_of_line * shortest && !good; d *= 1 + growth) {
      good = (int)distances.size() == most_cuts;
      bool as_short = true;
      for (std::size_t i = 0; i < fan.size(); ++i)
        as_short &= lines[i].segment_at(division[ends[fan[i]].line], d) <= growth * d;
      good |= as_short;
      distances.push_back(d);
    }
    if (distances.size() < 2 || (int)distances.size() > most_cuts) continue;
    const double reach = distances.back() * (1 + 0.5 * growth);
    for (std::size_t i = 0; i < fan.size(); ++i)
      lines[i].replace(division[ends[fan[i]].line], distances, reach);
  }
}

}  // namespace meshpipe
