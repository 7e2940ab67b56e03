// SPDX-License-Identifier: BSD-3-Clause
#include "lib/edit_mesh.h"

#include "lib/topology.h"

namespace meshpipe {
namespace {
constexpr int max_collapse_valence = 64;
}

EditMesh::EditMesh(std::vector<Tri> triangles, int n_vertices, const std::vector<std::uint8_t>& model)
    : tris(std::move(triangles)),
      opp(opposite_halfedges(tris, n_vertices)),
      hard(opp.size()),
      out(n_vertices, -1),
      live((int)tris.size()) {
  for (int h = 0; h < (int)opp.size(); ++h) {
    hard[h] = opp[h] < 0 || (!model.empty() && (model[h / 3] >> (h % 3) & 1));
    int v = from(h);
    if (out[v] < 0 || opp[h] < 0) out[v] = h;
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
}

int EditMesh::split(int h) {
  const int m = (int)out.size(), h1 = next(h), g = opp[h], g2 = prev(g);
  const int b = to(h), c = apex(h), d = apex(g);
  const int e = 3 * (int)tris.size(), f = e + 3;  // triangles m b c and b m d
  const int right = opp[h1], low = opp[g2];
  tris.push_back({m, b, c});
  tris.push_back({b, m, d});
  tris[h / 3][(h + 1) % 3] = m;
  tris[g / 3][g % 3] = m;
  opp.insert(opp.end(), {f, right, h1, e, g2, low});
  hard.insert(hard.end(), {0, hard[h1], 0, 0, 0, hard[g2]});
  if (right >= 0) opp[right] = e + 1;
  if (low >= 0) opp[low] = f + 2;
  opp[h1] = e + 2, opp[g2] = f + 1;
  hard[h1] = hard[g2] = 0;
  out.push_back(e);
  if (out[b] == h1 || out[b] == g) out[b] = out[b] == h1 ? e + 1 : f;
  if (out[d] == g2) out[d] = f + 2;
  live += 2;
  return m;
}

bool EditMesh::can_collapse(int h) const {
  const int a = from(h), b = to(h), g = opp[h];
  if (g < 0 || on_border(a)) return false;
  const int c = apex(h), d = apex(g);
  bool ok = true;
  // the only neighbours of both ends are the two apexes
  star(a, [&](int e) {
    ok = ok && !hard[e];
    int v = to(e);
    if (v != b && v != c && v != d && joined(b, v)) ok = false;
  });
  return ok && valence(a) <= max_collapse_valence && valence(b) > 3 && valence(c) > 3 && valence(d) > 3;
}

void EditMesh::collapse(int h) {
  const int a = from(h), b = to(h), g = opp[h], h1 = next(h), h2 = prev(h), g1 = next(g), g2 = prev(g);
  const int c = apex(h), d = apex(g);
  const int right = opp[h1], left = opp[h2], low_left = opp[g1], low_right = opp[g2];
  int leaving[max_collapse_valence], n = 0;
  star(a, [&](int e) { leaving[n++] = e; });
  for (int i = 0; i < n; ++i) tris[leaving[i] / 3][leaving[i] % 3] = b;
  opp[left] = right, opp[low_left] = low_right;
  hard[left] = hard[h1], hard[low_left] = hard[g2];
  if (right >= 0) opp[right] = left;
  if (low_right >= 0) opp[low_right] = low_left;
  // left now runs from b to c, low_left from d to b
  if (out[b] == h1 || out[b] / 3 == h / 3 || out[b] / 3 == g / 3) out[b] = left;
  if (out[c] == h2) out[c] = right;
  if (out[d] == g2) out[d] = low_left;
  out[a] = -1;
  tris[h / 3] = tris[g / 3] = {-1, -1, -1};
  live -= 2;
}

}  // namespace meshpipe
