// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/regions.h"

#include <algorithm>
#include <tuple>

#include "lib/core/lists.h"
#include "lib/core/pieces.h"

namespace meshpipe {
namespace {

/// Counts the loops of a region's border half-edges and finds pinched vertices. `inside(t)` returns
/// whether a triangle is in the region; `outgoing` is scratch, -1 for every vertex before and after.
template <class Inside>
void walk_border(const Connectivity& c, const std::vector<int>& border, std::vector<int>& outgoing,
                 Inside inside, Region& region) {
  region.border = (int)border.size();
  region.loops = 0;
  region.pinched = false;
  region.longest_loop = 0;
  for (int i = 0; i < (int)border.size(); ++i) {
    int& o = outgoing[c.from(border[i])];
    region.pinched |= o >= 0;
    o = i;
  }
  double length = 0;
  auto close = [&] {
    ++region.loops;
    region.longest_loop = std::max(region.longest_loop, length);
    length = 0;
  };
  auto following = [&](int h) { return next_on_border(c.opposite, h, inside); };
  if (region.pinched) {  // vertices do not name the half-edges: sort these
    std::vector<int> sorted = border;
    std::sort(sorted.begin(), sorted.end());
    std::vector<char> seen(sorted.size(), 0);
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      if (seen[i]) continue;
      for (std::size_t k = i; !seen[k];) {
        seen[k] = 1;
        length += c.length(sorted[k]);
        k = std::lower_bound(sorted.begin(), sorted.end(), following(sorted[k])) - sorted.begin();
      }
      close();
    }
  } else {
    for (int h : border) {
      if (outgoing[c.from(h)] < 0) continue;
      for (int g = h; outgoing[c.from(g)] >= 0; g = following(g)) {
        outgoing[c.from(g)] = -1;
        length += c.length(g);
      }
      close();
    }
  }
  for (int h : border) outgoing[c.from(h)] = -1;
}

}  // namespace

Regions find_regions(const Connectivity& c, const std::vector<int>& label, int n) {
  const Mesh& mesh = c.mesh;
  const std::vector<int>& opposite = c.opposite;
  Regions r;
  r.region.resize(n);
  r.border.resize(n);
  std::vector<int> of_vertex(mesh.points.size(), -1);
  constexpr int on_border = -2;
  for (int t = 0; t < (int)mesh.tris.size(); ++t) {
    if (label[t] < 0) continue;
    const Tri& corner = mesh.tris[t];
    ++r.region[label[t]].faces;
    r.region[label[t]].area += triangle_area(mesh, t);
    for (int i = 0; i < 3; ++i) {
      int h = 3 * t + i, v = corner[i];
      if (of_vertex[v] != on_border) of_vertex[v] = label[t];
      if (opposite[h] >= 0 && label[opposite[h] / 3] == label[t]) continue;
      r.border[label[t]].push_back(h);
      of_vertex[v] = of_vertex[corner[(i + 1) % 3]] = on_border;
    }
  }
  for (int l : of_vertex)
    if (l >= 0) ++r.region[l].inside;
  std::vector<int> outgoing(mesh.points.size(), -1);
  for (int l = 0; l < n; ++l)
    walk_border(
        c, r.border[l], outgoing, [&](int t) { return label[t] == l; }, r.region[l]);
  return r;
}

std::vector<Fan> pinched_fans(const Connectivity& c, const std::vector<int>& label, int l,
                              const std::vector<int>& border) {
  auto inside = [&](int g) { return c.opposite[g] >= 0 && label[c.opposite[g] / 3] == l; };
  std::vector<Fan> fans;
  for (int h : border) {
    if (label[h / 3] != l || inside(h)) continue;  // no border any more since another region's fan changed
    int size = 1;
    for (int g = prev(h); inside(g); g = prev(c.opposite[g])) ++size;
    fans.push_back({c.from(h), size, h});
  }
  std::sort(fans.begin(), fans.end(), [](const Fan& p, const Fan& q) {
    return std::tie(p.vertex, p.size, p.half_edge) < std::tie(q.vertex, q.size, q.half_edge);
  });
  std::size_t n = 0;
  for (std::size_t i = 0; i + 1 < fans.size(); ++i)
    if (fans[i].vertex == fans[i + 1].vertex) fans[n++] = fans[i];
  fans.resize(n);
  return fans;
}

int separate_pieces(const Connectivity& c, std::vector<int>& label) {
  std::vector<int> piece;
  const int n = number_pieces(c.opposite, piece, [&](int t, int u) { return label[t] == label[u]; });
  label.swap(piece);
  return n;
}

Joiner::Joiner(const Connectivity& c, std::vector<int>& label, Regions regions)
    : c_(c), label_(label), regions_(std::move(regions)), outgoing_(c.mesh.points.size(), -1) {}

Region Joiner::joined(int a, int b) {
  auto inside = [&](int t) { return label_[t] == a || label_[t] == b; };
  shared_.clear();
  outer_.clear();
  for (int l : {a, b})
    for (int h : regions_.border[l])
      (c_.opposite[h] >= 0 && inside(c_.opposite[h] / 3) ? shared_ : outer_).push_back(h);
  Region r;
  r.faces = regions_.region[a].faces + regions_.region[b].faces;
  r.area = regions_.region[a].area + regions_.region[b].area;
  r.inside = regions_.region[a].inside + regions_.region[b].inside;
  // a vertex of the shared border comes inside unless the outer border passes it; each is the origin of one
  // shared half-edge of either region then
  for (int h : outer_) outgoing_[c_.from(h)] = 0;
  for (int h : shared_)
    if (int& o = outgoing_[c_.from(h)]; o == -1) ++r.inside, o = -2;
  for (int h : outer_) outgoing_[c_.from(h)] = -1;
  for (int h : shared_) outgoing_[c_.from(h)] = -1;
  walk_border(c_, outer_, outgoing_, inside, r);
  return r;
}

void Joiner::join(int a, int b) {
  regions_.region[a] = joined(a, b);
  // outer_ still holds the union's border
  std::vector<int> stack;
  for (int h : regions_.border[b])
    if (label_[h / 3] == b) label_[h / 3] = a, stack.push_back(h / 3);
  while (!stack.empty()) {
    int t = take_last(stack);
    for (int i = 0; i < 3; ++i)
      if (int o = c_.opposite[3 * t + i]; o >= 0 && label_[o / 3] == b)
        label_[o / 3] = a, stack.push_back(o / 3);
  }
  regions_.border[a] = outer_;
  regions_.border[b].clear();
  regions_.region[b] = {};
}

}  // namespace meshpipe
