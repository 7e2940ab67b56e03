// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/edit_mesh.h"

#include "lib/core/topology.h"

namespace meshpipe {
namespace {
constexpr int max_collapse_valence = 64;
}

EditMesh::EditMesh(std::vector<Tri> triangles, int n_vertices, const std::vector<std::uint8_t>& model)
    : tris(std::move(triangles)), opp(opposite_halfedges(tris, n_vertices)) {
  start(n_vertices, model);
}

EditMesh::EditMesh(const Connectivity& c) : tris(c.mesh.tris), opp(c.opposite) {
  start(c.n_vertices(), c.model);
}

void EditMesh::start(int n_vertices, const std::vector<std::uint8_t>& model) {
  hard.resize(opp.size());
  out.assign(n_vertices, -1);
  degree.assign(n_vertices, 0);
  live = (int)tris.size();
  for (int h = 0; h < (int)opp.size(); ++h) {
    hard[h] = opp[h] < 0 || (!model.empty() && (model[h / 3] >> (h % 3) & 1));
    int v = from(h);
    if (out[v] < 0 || opp[h] < 0) out[v] = h;
    ++degree[v];
    if (opp[h] < 0) ++degree[to(h)];
  }
  for (int h = 0; h < (int)opp.size(); ++h)
    if (hard[h] && opp[h] >= 0) hard[opp[h]] = 1;
}

bool EditMesh::joined(int a, int b) const {
  bool found = false;
  star(a, [&](int h) { found |= to(h) == b || apex(h) == b; });
  return found;
}

//      c                c
//    h2 h1             /|\.
//   a --h-> b   ->    a | b      triangles a d c and b c d
//    g1 g2             \|/
//      d                d
void EditMesh::flip(int h) {
  const int h1 = next(h), h2 = prev(h), g = opp[h], g1 = next(g), g2 = prev(g);
  const int a = from(h), b = to(h), c = apex(h), d = apex(g);
  const int above = opp[h1], below = opp[g1];
  const std::uint8_t hard_above = hard[h1], hard_below = hard[g1];
  auto corner = [&](int e, int v) { tris[e / 3][e % 3] = v; };
  corner(h, a), corner(h1, d), corner(h2, c);
  corner(g, b), corner(g1, c), corner(g2, d);
  auto join = [&](int x, int y) {
    opp[x] = y;
    if (y >= 0) opp[y] = x;
  };
  join(h, below), join(g, above), join(h1, g1);
  hard[h] = hard_below, hard[g] = hard_above, hard[h1] = hard[g1] = 0;
  if (out[a] == g1) out[a] = h;
  if (out[b] == h1) out[b] = g;
  --degree[a], --degree[b], ++degree[c], ++degree[d];
}

int EditMesh::split(int h) {
  const int m = (int)out.size(), h1 = next(h), g = opp[h];
  const int b = to(h), c = apex(h), e = 3 * (int)tris.size(), right = opp[h1];
  tris.push_back({m, b, c});
  tris[h / 3][(h + 1) % 3] = m;
  opp.insert(opp.end(), {-1, right, h1});
  hard.insert(hard.end(), {hard[h], hard[h1], 0});
  if (right >= 0) opp[right] = e + 1;
  opp[h1] = e + 2;
  hard[h1] = 0;
  out.push_back(e);
  if (out[b] == h1) out[b] = e + 1;
  degree.push_back(3), ++degree[c];
  ++live;
  if (g < 0) return m;
  const int f = e + 3, g2 = prev(g), d = apex(g), low = opp[g2];
  tris.push_back({b, m, d});
  tris[g / 3][g % 3] = m;
  opp.insert(opp.end(), {e, g2, low});
  opp[e] = f;
  hard.insert(hard.end(), {hard[h], 0, hard[g2]});
  if (low >= 0) opp[low] = f + 2;
  opp[g2] = f + 1;
  hard[g2] = 0;
  if (out[b] == g) out[b] = f;
  if (out[d] == g2) out[d] = f + 2;
  ++degree[m], ++degree[d];
  ++live;
  return m;
}

bool EditMesh::can_collapse(int h, int gone, bool merge) const {
  const int kept = from(h) == gone ? to(h) : from(h), g = opp[h];
  const int c = apex(h), d = g < 0 ? -1 : apex(g);
  int hard_edges = 0, last = 0;
  star(gone, [&](int e) { hard_edges += hard[e], last = e; });
  const bool border = opp[prev(last)] < 0;
  hard_edges += border;
  if (!merge && hard_edges != 0 && (hard_edges != 2 || !hard[h])) return false;
  if (border && g >= 0) return false;
  const int fewest = merge && border ? 2 : 3;  // a border may bend around a single triangle
  if (valence(gone) < fewest || valence(gone) > max_collapse_valence) return false;
  auto enough = [&](int v, int lost) { return v < 0 || valence(v) - lost >= (on_border(v) ? 2 : 3); };
  if (!enough(kept, g < 0 ? 1 : 4 - valence(gone)) || !enough(c, 1) || !enough(d, 1)) return false;
  // the only neighbors of both ends are the apexes
  bool ok = true;
  if (valence(kept) > max_collapse_valence) {
    neighbors(gone, [&](int v) { ok = ok && (v == kept || v == c || v == d || !joined(kept, v)); });
    return ok;
  }
  int near[max_collapse_valence], n = 0;
  neighbors(kept, [&](int v) {
    if (v != gone && v != c && v != d) near[n++] = v;
  });
  neighbors(gone, [&](int v) {
    for (int i = 0; i < n; ++i) ok = ok && near[i] != v;
  });
  return ok;
}

void EditMesh::collapse(int h, int gone) {
  const int kept = from(h) == gone ? to(h) : from(h), g = opp[h];
  int leaving[max_collapse_valence + 1], n = 0;
  star(gone, [&](int e) { leaving[n++] = e; });
  for (int i = 0; i < n; ++i) tris[leaving[i] / 3][leaving[i] % 3] = kept;

  auto dead_soon = [&](int e) { return e < 0 || e / 3 == h / 3 || (g >= 0 && e / 3 == g / 3); };
  // a leaving half-edge for v among the candidates: the border's if there is one
  auto lead = [&](int v, std::initializer_list<int> candidates) {
    int best = -1;
    for (int e : candidates)
      if (!dead_soon(e) && from(e) == v && (best < 0 || (opp[best] >= 0 && opp[e] < 0))) best = e;
    out[v] = best;
  };
  int sides[4] = {-1, -1, -1, -1};  // half-edges that lose their neighbor, and find each other
  int apexes[2] = {-1, -1};
  for (int side = 0; side < 2; ++side) {
    const int e = side ? g : h;
    if (e < 0) continue;
    const int x = opp[next(e)], y = opp[prev(e)];
    const std::uint8_t is_hard = hard[next(e)] | hard[prev(e)];
    if (x >= 0) opp[x] = y, hard[x] = is_hard;
    if (y >= 0) opp[y] = x, hard[y] = is_hard;
    sides[2 * side] = x, sides[2 * side + 1] = y;
    apexes[side] = apex(e);
  }
  auto after = [](int e) { return e < 0 ? -1 : next(e); };
  lead(kept, {out[kept], out[gone], sides[0], sides[1], sides[2], sides[3], after(sides[0]), after(sides[1]),
              after(sides[2]), after(sides[3])});
  for (int side = 0; side < 2; ++side)
    if (int v = apexes[side]; v >= 0)
      lead(v, {out[v], sides[2 * side], sides[2 * side + 1], after(sides[2 * side]),
               after(sides[2 * side + 1])});
  // the edges of `gone` become edges of `kept`, except the one between them and those to the apexes
  degree[kept] += degree[gone] - 2;
  for (int v : apexes)
    if (v >= 0) --degree[v], --degree[kept];
  degree[gone] = 0;
  out[gone] = -1;
  tris[h / 3] = {-1, -1, -1};
  if (g >= 0) tris[g / 3] = {-1, -1, -1};
  live -= g >= 0 ? 2 : 1;
}

}  // namespace meshpipe
