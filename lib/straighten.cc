// SPDX-License-Identifier: BSD-3-Clause
#include "lib/straighten.h"

#include <algorithm>

#include "lib/cut.h"
#include "lib/regions.h"
#include "lib/sparse.h"
#include "lib/topology.h"

namespace meshpipe {
namespace {

/// The triangles of parts a and b near their interface, on their own numbers.
struct Band {
  SubMesh mesh;
  std::vector<char> rim;     // of the vertices: next to what is cut off
  std::vector<char> pinned;  // of the vertices: the interface is a model edge here
  std::vector<signed char>
      apex;         // of the vertices: the side (+1 a, -1 b) of a triangle on a pinned edge, or 0
  double edge = 0;  // mean length of an interface edge
};

bool is_model(const std::vector<std::uint8_t>* model, int h) { return model && (*model)[h / 3] >> h % 3 & 1; }

const std::vector<std::uint8_t>* model_of(const Surface& s) {
  return s.face.has("model") ? &s.face.get<std::uint8_t>("model") : nullptr;
}

/// Interface half-edges, with part a on their left.
std::vector<int> interface_of(const std::vector<int>& opposite, const std::vector<int>& part, int a, int b) {
  std::vector<int> r;
  for (int h = 0; h < (int)opposite.size(); ++h)
    if (part[h / 3] == a && opposite[h] >= 0 && part[opposite[h] / 3] == b) r.push_back(h);
  return r;
}

double length_of(const Mesh& m, const std::vector<int>& half_edges) {
  double l = 0;
  for (int h : half_edges) l += norm(m.points[target(m.tris, h)] - m.points[origin(m.tris, h)]);
  return l;
}

Band make_band(const Surface& s, const std::vector<int>& opposite, const std::vector<int>& interface, int a,
               int b) {
  constexpr int rings = 14;  // about 12 edges wide; the diffused indicator has its value there
  const std::vector<int>& part = s.face.get<int>("part");
  const std::vector<std::uint8_t>* model = model_of(s);
  std::vector<char> reached(s.points.size(), 0);
  std::vector<int> in_band(s.tris.size(), -1);
  for (int h : interface) reached[origin(s.tris, h)] = reached[target(s.tris, h)] = 1;
  std::vector<int> rest;
  for (int t = 0; t < (int)s.tris.size(); ++t)
    if (part[t] == a || part[t] == b) rest.push_back(t);
  for (int ring = 0; ring < rings && !rest.empty(); ++ring) {
    std::vector<int> found;
    std::erase_if(rest, [&](int t) {
      const Tri& v = s.tris[t];
      if (!reached[v[0]] && !reached[v[1]] && !reached[v[2]]) return false;
      found.push_back(t);
      in_band[t] = 0;
      return true;
    });
    for (int t : found)
      for (int v : s.tris[t]) reached[v] = 1;
  }
  Band band;
  band.mesh = std::move(split_by_label(s, in_band, 1)[0]);
  const int n = (int)band.mesh.vertex.size();
  std::vector<char> marks(s.points.size(), 0);
  for (int t : rest)
    for (int v : s.tris[t]) marks[v] |= 1;
  std::vector<signed char> apex(s.points.size(), 0);
  for (int h : interface)
    if (is_model(model, h)) {
      marks[origin(s.tris, h)] |= 2;
      marks[target(s.tris, h)] |= 2;
      apex[origin(s.tris, prev(h))] = 1;
      apex[origin(s.tris, prev(opposite[h]))] = -1;
    }
  for (int v = 0; v < n; ++v) {
    band.rim.push_back(marks[band.mesh.vertex[v]] & 1);
    band.pinned.push_back((marks[band.mesh.vertex[v]] & 2) != 0);
    band.apex.push_back(apex[band.mesh.vertex[v]]);
  }
  band.edge = length_of(s, interface) / (double)interface.size();
  return band;
}

/// Mean of the sign of a linear field over a triangle.
double mean_sign(double x, double y, double z) {
  // one corner alone: its share of the area is the product of the crossings' fractions
  if ((x >= 0) == (y >= 0)) std::swap(x, z);
  if ((x >= 0) == (y >= 0)) return x >= 0 ? 1 : -1;
  if ((x >= 0) == (z >= 0)) std::swap(x, y);
  double alone = x / (x - y) * (x / (x - z));
  return (x >= 0 ? 1 : -1) * (2 * alone - 1);
}

/// `steps` times: one implicit heat step (M + t K) s = M sign(s), M lumped, K with clamped cotangents.
std::vector<double> diffuse(const Band& band, std::vector<double> sign, double width, int steps) {
  const std::vector<Tri>& tris = band.mesh.tris;
  const std::vector<Vec3>& p = band.mesh.points;
  const int n = (int)p.size();
  const double t = width * width * band.edge * band.edge;
  std::vector<Entry<double>> entries;
  std::vector<double> area(tris.size());
  std::vector<double> diagonal(n, 0);
  for (std::size_t k = 0; k < tris.size(); ++k) {
    const Tri& v = tris[k];
    area[k] = 0.5 * norm(area_vector(p[v[0]], p[v[1]], p[v[2]]));
    std::array<double, 3> w = cotangent_weights(p[v[0]], p[v[1]], p[v[2]], 1e-3);
    for (int i = 0; i < 3; ++i) {
      int x = v[i], y = v[(i + 1) % 3];
      diagonal[x] += area[k] / 3 + t * w[i];
      diagonal[y] += t * w[i];
      entries.push_back({std::max(x, y), std::min(x, y), -t * w[i]});
    }
  }
  constexpr double stiff = 1e6;  // pinned to the level
  for (int v = 0; v < n; ++v) entries.push_back({v, v, diagonal[v] * (band.pinned[v] ? stiff : 1)});
  const Factorisation<double> heat(n, entries);
  std::vector<double> s;
  for (int step = 0; step < steps; ++step) {
    s.assign(n, 0);
    for (std::size_t k = 0; k < tris.size(); ++k)
      for (int v : tris[k]) s[v] += area[k] / 3 * sign[k];
    heat.solve(s);
    for (std::size_t k = 0; k < tris.size(); ++k)
      sign[k] = mean_sign(s[tris[k][0]], s[tris[k][1]], s[tris[k][2]]);
  }
  return s;
}

/// Hands all pieces of a but the largest to b, and the other way round.
void keep_largest_pieces(const Mesh& mesh, const std::vector<int>& opposite, std::vector<int>& part, int a,
                         int b) {
  std::vector<int> piece;
  const int n = components(opposite_within(mesh.tris, opposite, part), piece);
  std::vector<double> area(n, 0);
  std::vector<int> of(n);
  for (std::size_t t = 0; t < part.size(); ++t) {
    const Tri& v = mesh.tris[t];
    area[piece[t]] += norm(area_vector(mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]]));
    of[piece[t]] = part[t];
  }
  int largest[2] = {-1, -1};
  for (int i = 0; i < n; ++i)
    if (of[i] == a || of[i] == b)
      if (int& l = largest[of[i] == b]; l < 0 || area[i] > area[l]) l = i;
  for (std::size_t t = 0; t < part.size(); ++t)
    if ((part[t] == a || part[t] == b) && piece[t] != largest[part[t] == b]) part[t] = part[t] == a ? b : a;
}

/// Tries one smoothing of the interface; leaves the surface changed and returns true if the result is
/// admissible and shorter.
bool try_straighten(Surface& s, const Band& band, int a, int b, double old_length, int n_pinned, int n_parts,
                    double snap, int max_faces, double width, int steps) {
  std::vector<double> sign;
  for (int t : band.mesh.face) sign.push_back(s.face.get<int>("part")[t] == a ? 1 : -1);
  std::vector<double> level = diffuse(band, std::move(sign), width, steps);

  std::vector<double> field(s.points.size(), 1);
  std::vector<char> active(s.tris.size(), 0), of_a(s.points.size(), 0);
  for (int t : band.mesh.face) {
    active[t] = 1;
    if (s.face.get<int>("part")[t] == a)
      for (int v : s.tris[t]) of_a[v] = 1;
  }
  for (std::size_t i = 0; i < level.size(); ++i) {
    double f = level[i];
    int v = band.mesh.vertex[i];
    if (band.rim[i] && (f >= 0) != of_a[v]) return false;  // it ran out of the band
    if (band.pinned[i])
      f = 0;
    else if (band.apex[i] != 0)
      f = band.apex[i] * std::max(1e-3, band.apex[i] * f);
    field[v] = f;
  }
  std::vector<int> side;
  cut_by_scalar_field(s, field, active, side, snap);
  std::vector<int>& part = s.face.get<int>("part");
  for (std::size_t t = 0; t < part.size(); ++t)
    if (side[t] >= 0) part[t] = side[t] ? a : b;

  const std::vector<int> opposite = opposite_halfedges(s.tris, (int)s.points.size());
  keep_largest_pieces(s, opposite, part, a, b);
  const Regions r = find_regions(s, opposite, part, n_parts);
  if (!r.region[a].maps_to_the_plane() || !r.region[b].maps_to_the_plane()) return false;
  if (max_faces > 0)
    for (const Region& x : r.region)
      if (x.faces > max_faces) return false;
  const std::vector<int> interface = interface_of(opposite, part, a, b);
  int pinned = 0;
  for (int h : interface) pinned += is_model(model_of(s), h);
  return pinned >= n_pinned && length_of(s, interface) < old_length;
}

void straighten_pair(Surface& s, int a, int b, int n_parts, double snap, int max_faces) {
  const std::vector<int> opposite = opposite_halfedges(s.tris, (int)s.points.size());
  const std::vector<int> interface = interface_of(opposite, s.face.get<int>("part"), a, b);
  int pinned = 0;
  for (int h : interface) pinned += is_model(model_of(s), h);
  if (pinned == (int)interface.size()) return;
  const Band band = make_band(s, opposite, interface, a, b);
  const double length = length_of(s, interface);
  struct Attempt {
    double width;  // in edges
    int steps;
  };
  for (Attempt t : {Attempt{4, 5}, Attempt{3, 1}, Attempt{1.5, 1}}) {
    Surface copy = s;
    if (!try_straighten(copy, band, a, b, length, pinned, n_parts, snap, max_faces, t.width, t.steps))
      continue;
    s = std::move(copy);
    return;
  }
}

}  // namespace

void straighten_interfaces(Surface& surface, int n_parts, double snap, int max_faces) {
  const std::vector<int> opposite = opposite_halfedges(surface.tris, (int)surface.points.size());
  const std::vector<int>& part = surface.face.get<int>("part");
  std::vector<std::pair<int, int>> pairs;
  for (int h = 0; h < (int)opposite.size(); ++h)
    if (opposite[h] >= 0 && part[h / 3] < part[opposite[h] / 3])
      pairs.push_back({part[h / 3], part[opposite[h] / 3]});
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  for (auto [a, b] : pairs) straighten_pair(surface, a, b, n_parts, snap, max_faces);
}

}  // namespace meshpipe
