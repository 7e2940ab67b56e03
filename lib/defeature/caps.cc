// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <variant>

#include "lib/core/connectivity.h"
#include "lib/core/topology.h"
#include "lib/defeature/defeature.h"

namespace meshpipe {
namespace {

constexpr double rounding = 3e-6;   ///< of the diagonal: single-precision coordinates, with a margin
constexpr double slender = 0.05;    ///< height over length: others are small, not flat
constexpr double least_end = 1e-3;  ///< of the edge: a corner nearer to its end makes no better triangles
constexpr int most_passes = 20;     ///< one for each row of caps that lean on each other

/// The half-edges around an edge h, its opposite o, and their vertices.
//         c
//      ca/ \bc
//     a --h-- b
//      ad\ /db
//         d
struct Diamond {
  int h, bc, ca, o, ad, db, a, b, c, d;
};

class Caps {
 public:
  Caps(Surface& surface, const std::vector<int>& line)
      : s_(surface),
        opposite_(opposite_halfedges(surface)),
        fixed_(opposite_.size(), 0),
        least_(rounding * diagonal(surface)) {
    for (int h = 0; h < (int)fixed_.size(); ++h)
      if (const int o = opposite_[h]; o >= 0) fixed_[h] = line[h] >= 0 || line[o] >= 0;
    for (const char* name : {"patch", "part"}) {
      if (!s_.face.has(name)) continue;
      const auto& label = s_.face.get<int>(name);
      for (int h = 0; h < (int)fixed_.size(); ++h)
        if (const int o = opposite_[h]; o >= 0 && label[h / 3] != label[o / 3]) fixed_[h] = 1;
    }
  }

  int flip_all() {
    int all = 0;
    for (int pass = 0; pass < most_passes; ++pass) {
      int flips = 0;
      for (int t = 0; t < (int)s_.tris.size(); ++t)
        if (const int h = longest(t); may_flip(h)) flip(h), ++flips;
      all += flips;
      if (flips == 0) break;
    }
    return all;
  }

 private:
  Diamond around(int h) const {
    const int o = opposite_[h], bc = next(h), ca = prev(h), ad = next(o), db = prev(o);
    const std::vector<Tri>& t = s_.tris;
    return {h, bc, ca, o, ad, db, origin(t, h), target(t, h), origin(t, ca), origin(t, db)};
  }

  int longest(int t) const {
    int h = 3 * t;
    for (int g : {3 * t + 1, 3 * t + 2})
      if (edge_length(s_, g) > edge_length(s_, h)) h = g;
    return h;
  }

  /// Height of a triangle over the longest of its edges.
  double height(Vec3 a, Vec3 b, Vec3 c) const {
    const double l = std::max({norm(b - a), norm(c - b), norm(a - c)});
    return l > 0 ? norm(area_vector(a, b, c)) / l : 0;
  }

  bool may_flip(int h) const {
    if (opposite_[h] < 0 || fixed_[h]) return false;
    const Diamond q = around(h);
    const Vec3 a = s_.points[q.a], b = s_.points[q.b], c = s_.points[q.c], d = s_.points[q.d];
    const double low = height(a, b, c), at = dot(c - a, b - a) / dot(b - a, b - a);
    if (!(low < least_ && low < slender * norm(b - a) && at > least_end && at < 1 - least_end)) return false;
    const Vec3 up = area_vector(b, a, d);
    if (!(dot(area_vector(c, a, d), up) > 0 && dot(area_vector(d, b, c), up) > 0)) return false;
    if (!(std::min(height(c, a, d), height(d, b, c)) > low)) return false;
    for (int g : {q.bc, q.ca, q.ad, q.db})
      if (const int o = opposite_[g]; o >= 0 && (o / 3 == h / 3 || o / 3 == q.o / 3)) return false;
    bool joined = false;
    for_each_neighbor(s_.tris, opposite_, q.ca, [&](int v) { joined |= v == q.d; });
    return !joined && q.c != q.d;
  }

  void flip(int h) {
    const Diamond q = around(h);
    const int t = h / 3, u = q.o / 3;
    const int from[4] = {q.ca, q.ad, q.db, q.bc}, to[4] = {3 * t, 3 * t + 1, 3 * u, 3 * u + 1};
    int beyond[4];
    char fixed[4];
    for (int i = 0; i < 4; ++i) beyond[i] = opposite_[from[i]], fixed[i] = fixed_[from[i]];
    s_.tris[t] = {q.c, q.a, q.d};
    s_.tris[u] = {q.d, q.b, q.c};
    for (int i = 0; i < 4; ++i) {
      opposite_[to[i]] = beyond[i], fixed_[to[i]] = fixed[i];
      if (beyond[i] >= 0) opposite_[beyond[i]] = to[i];
    }
    opposite_[3 * t + 2] = 3 * u + 2, opposite_[3 * u + 2] = 3 * t + 2;
    fixed_[3 * t + 2] = fixed_[3 * u + 2] = 0;
    for (Column& column : s_.face.columns)
      std::visit([&](auto& values) { values[t] = values[u]; }, column.data);
  }

  Surface& s_;
  std::vector<int> opposite_;
  std::vector<char> fixed_;  ///< per half-edge
  double least_;
};

}  // namespace

int flip_caps(Surface& surface, const std::vector<int>& line) { return Caps(surface, line).flip_all(); }

}  // namespace meshpipe
