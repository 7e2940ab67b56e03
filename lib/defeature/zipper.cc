// SPDX-License-Identifier: BSD-3-Clause
#include "lib/defeature/zipper.h"

#include <algorithm>

#include "lib/core/lists.h"
#include "lib/core/topology.h"

namespace meshpipe {
namespace {

/// The surface folds back where normals differ by more: what is between is the rim of a thin plate or the
/// bottom of a slot, and closing it would bring two sheets together.
constexpr double fold_angle = 160 * degree;
constexpr double most_turn = 60 * degree;  ///< of a triangle that is higher than the tolerance
constexpr double off_plane = 1e-7;         ///< of the tolerance: rounding of vertices that stay in a plane
/// Least distance of a new vertex on an edge from the ends of that, of the tolerance: what is merged there
/// has often moved as far as it may, and so could never be merged with them, but sizes fall to that distance.
constexpr double least_end = 0.25;
constexpr double flattest = 1e-6;  ///< least height of a triangle over its length, above rounding errors

double turn(Vec3 a, Vec3 b) { return norm(a) > 0 && norm(b) > 0 ? angle(a, b) : 0; }

double longest_edge(Vec3 a, Vec3 b, Vec3 c) { return std::max({norm(b - a), norm(c - b), norm(a - c)}); }

bool is_flat(Vec3 a, Vec3 b, Vec3 c) {
  const double l = longest_edge(a, b, c);
  return !(norm(area_vector(a, b, c)) > flattest * l * l);
}

}  // namespace

Vec3 MergedSurface::normal(int t) const {
  const Tri& v = mesh.tris[t];
  return area_vector(points[v[0]], points[v[1]], points[v[2]]);
}

bool MergedSurface::is_sharp(int h) const {
  return mesh.opp[h] >= 0 && turn(normal(h / 3), normal(mesh.opp[h] / 3)) > sharp_edge_of_step;
}

Zipper::Zipper(const Surface& surface, EditMesh edited, const DefeatureOptions& options,
               const std::vector<int>* given, const std::vector<char>& banned)
    : MergedSurface{.mesh = std::move(edited),
                    .points = surface.points,
                    .drift = std::vector<double>(surface.points.size(), 0),
                    .origin = identity(surface.tris.size()),
                    .added = {},
                    .merges = {},
                    .lines = {}},
      options_(options),
      banned_(banned),
      region_(points.size(), -1) {
  lines = find_lines(mesh, surface, given, add_wrinkles());
}

/// Makes sharp edges of triangles lower than the tolerance hard, as bounds of steps too narrow for model
/// edges. Flags their half-edges. Components without model edges, such as scans, stay as they are.
std::vector<char> Zipper::add_wrinkles() {
  std::vector<char> added_edges(mesh.opp.size(), 0);
  std::vector<int> component, model_edges;
  for (int h = 0; h < (int)mesh.opp.size(); ++h)
    if (mesh.hard[h] && mesh.opp[h] >= 0 && !mesh.dead(h / 3)) model_edges.push_back(h);
  if (model_edges.empty()) return added_edges;
  std::vector<char> designed(components(mesh.opp, component), 0);
  for (int h : model_edges) designed[component[h / 3]] = 1;
  for (int h = 0; h < (int)mesh.opp.size(); ++h) {
    const int o = mesh.opp[h];
    if (o < h || mesh.dead(h / 3) || mesh.hard[h] || !designed[component[h / 3]]) continue;
    if (std::min(height(h / 3), height(o / 3)) > options_.tolerance) continue;
    if (is_sharp(h)) added_edges[h] = added_edges[o] = 1;
  }
  for (int h = 0; h < (int)mesh.opp.size(); ++h) mesh.hard[h] |= added_edges[h];
  return added_edges;
}

double MergedSurface::height(int t) const {
  const Tri& v = mesh.tris[t];
  return norm(normal(t)) / longest_edge(points[v[0]], points[v[1]], points[v[2]]);
}

bool MergedSurface::on_line(int v) const {
  bool found = mesh.on_border(v);
  if (!found) mesh.star(v, [&](int h) { found |= mesh.hard[h] != 0; });
  return found;
}

std::vector<char> MergedSurface::vertices_on_lines() const {
  std::vector<char> flags(points.size(), 0);
  for (int h = 0; h < (int)mesh.opp.size(); ++h)
    if (mesh.hard[h] && !mesh.dead(h / 3)) flags[mesh.from(h)] = flags[mesh.to(h)] = 1;
  return flags;
}

/// On the left of h: the edge that runs to its start, the first counterclockwise, and that from its end.
Zipper::Side Zipper::side_of(int h) const {
  Side s;
  if (h < 0) return s;
  for (s.a = prev(h); !mesh.hard[s.a]; s.a = prev(mesh.opp[s.a]))
    if (s.a == mesh.opp[h]) return {};
  for (s.b = next(h); !mesh.hard[s.b]; s.b = next(mesh.opp[s.b]))
    if (s.b == mesh.opp[h]) return {};
  if (s.a == mesh.opp[h] || s.b == mesh.opp[h]) return {};  // all around
  s.along_a = points[mesh.from(s.a)] - points[mesh.from(h)];
  s.along_b = points[mesh.to(s.b)] - points[mesh.to(h)];
  return s;
}

/// The normal beyond h, of the first triangle that is higher than the tolerance. Each lower one may face
/// anywhere: of them, the mean of all up to the tolerance if they face one way, else up to the next line.
Vec3 Zipper::normal_beyond(int h) const {
  constexpr int most_steps = 64;
  Vec3 sum, first;
  double across = 0, areas = 0;
  for (int steps = 0; steps < most_steps && mesh.opp[h] >= 0; ++steps) {
    const int o = mesh.opp[h], t = o / 3;
    if (height(t) > options_.tolerance) return normal(t);
    if (steps > 0 && mesh.hard[h] && norm(first) == 0) first = sum;
    sum = sum + normal(t), areas += norm(normal(t));
    if ((across += height(t)) > options_.tolerance) break;
    const bool longer =
        norm(points[mesh.apex(o)] - points[mesh.to(o)]) > norm(points[mesh.apex(o)] - points[mesh.from(o)]);
    h = longer ? next(o) : prev(o);
  }
  return across > options_.tolerance && norm(sum) > 0.9 * areas ? sum : first;
}

bool Zipper::folded(const Side& s) const { return turn(normal_beyond(s.a), normal_beyond(s.b)) > fold_angle; }

/// Is the edge of h a rung that may go: between two lines, to a corner, or to the end of a line?
bool Zipper::is_strip(int h) const {
  bool any = false;
  for (int e : {h, mesh.opp[h]}) {
    const Side s = side_of(e);
    if (!s.parallel()) continue;
    if (folded(s)) return false;
    any = true;
  }
  return any || mesh.hard[h] || is_corner(mesh.from(h)) || is_corner(mesh.to(h));
}

/// The strengths of the lines at both ends of h: of those that bound the strip with rung h, so that one of
/// them is kept all along it, else of any that leave the ends.
std::array<Zipper::Strength, 2> Zipper::strengths(int h) const {
  std::array<Strength, 2> best{};
  auto see = [&](int end, int e) {
    const int l = lines.of[e];
    best[end] = std::max(best[end], Strength{(double)lines.rank[l], lines.length[l], -(double)l});
  };
  bool strip = false;
  for (const int e : {h, mesh.opp[h]}) {
    const Side s = side_of(e);
    if (!s.parallel()) continue;
    strip = true;
    see(e == h ? 0 : 1, s.a), see(e == h ? 1 : 0, s.b);
  }
  if (strip) return best;
  for (int end : {0, 1})
    mesh.star(end ? mesh.to(h) : mesh.from(h), [&](int e) {
      if (mesh.hard[e] && e != h && e != mesh.opp[h]) see(end, e);
      if (const int b = prev(e); mesh.opp[b] < 0 && b != h) see(end, b);
    });
  return best;
}

bool Zipper::may_merge(int h, int gone) const {
  const int kept = mesh.from(h) == gone ? mesh.to(h) : mesh.from(h), g = mesh.opp[h];
  if (mesh.on_border(gone) && (g >= 0 || options_.keep_borders)) return false;
  if (!mesh.can_collapse(h, gone, true)) return false;
  if (drift[gone] + norm(points[gone] - points[kept]) > options_.tolerance) return false;
  const Vec3 to = points[kept];
  bool ok = true;
  auto moved = [&](int t) {
    Vec3 p[3];
    for (int i = 0; i < 3; ++i) p[i] = mesh.tris[t][i] == gone ? to : points[mesh.tris[t][i]];
    return area_vector(p[0], p[1], p[2]);
  };
  auto vanishes = [&](int t) { return t == h / 3 || (g >= 0 && t == g / 3); };
  auto beyond = [&](int e) {  // the neighbor across e once the triangles at h are gone
    int o = mesh.opp[e];
    if (o < 0 || !vanishes(o / 3)) return o;
    const int rung = o / 3 == h / 3 ? h : g;
    return mesh.opp[next(rung) == o ? prev(rung) : next(rung)];
  };
  auto at = [&](int v) { return v == gone ? to : points[v]; };
  auto is_ear = [&](int t) {  // afterwards, without height: it goes, too
    for (int k = 3 * t; k < 3 * t + 3; ++k)
      if (beyond(k) < 0 && beyond(prev(k)) < 0 && mesh.from(k) != gone)
        return is_flat_ear(mesh.from(k), at(mesh.from(k)), at(mesh.to(k)), at(mesh.apex(k)));
    return false;
  };
  mesh.star(gone, [&](int e) {
    const int t = e / 3;
    const Vec3 old_normal = normal(t), new_normal = moved(t);
    if (!options_.plane.empty() && options_.plane[origin[t]])
      ok = ok &&
           std::abs(dot(to - points[gone], old_normal)) <= off_plane * options_.tolerance * norm(old_normal);
    if (vanishes(t) || is_ear(t)) return;
    ok = ok && !is_flat(to, points[mesh.to(e)], points[mesh.apex(e)]);
    ok = ok && (height(t) <= options_.tolerance || turn(old_normal, new_normal) < most_turn);
    double before = 0, after = 0;  // the sharpest fold at t
    for (int k : {e, next(e), prev(e)}) {
      if (const int o = mesh.opp[k]; o >= 0) before = std::max(before, turn(old_normal, normal(o / 3)));
      if (const int o = beyond(k); o >= 0 && !is_ear(o / 3))
        after = std::max(after, turn(new_normal, moved(o / 3)));
    }
    ok = ok && after <= std::max(fold_angle, before + degree);
  });
  return ok;
}

void Zipper::collapse(int h, int gone) {
  auto strength = [&](int e) {
    const int l = lines.of[e];
    return l < 0 ? std::pair(-1, 0.0) : std::pair((int)lines.rank[l], lines.length[l]);
  };
  for (int e : {h, mesh.opp[h]}) {
    if (e < 0) continue;
    int strong = next(e), weak = prev(e);
    if (strength(weak) > strength(strong)) std::swap(strong, weak);
    const int line = lines.of[strong], given = lines.given[lines.given[strong] >= 0 ? strong : weak];
    const bool seam = lines.of[weak] >= 0 || lines.seam[strong] > 0;
    for (int side : {strong, weak})
      if (const int o = mesh.opp[side]; o >= 0)
        lines.of[o] = line, lines.given[o] = given, lines.seam[o] = seam ? 1 : -1;
  }
  mesh.collapse(h, gone);
}

bool Zipper::merge(int h) {
  int gone = mesh.from(h), kept = mesh.to(h);
  if (banned_[gone] || banned_[kept]) return false;
  auto [weak, strong] = strengths(h);
  if (weak > strong) std::swap(gone, kept), std::swap(weak, strong);
  if (!may_merge(h, gone)) {
    std::swap(gone, kept);
    const bool along_border = mesh.opp[h] < 0;  // both are on it, however weak their other lines are
    if ((weak[0] < strong[0] && !along_border) || !may_merge(h, gone)) return false;
  }
  const double width = norm(points[gone] - points[kept]);
  merges.push_back({gone, kept, width, points[gone]});
  drift[kept] = std::max(drift[kept], drift[gone] + width);
  collapse(h, gone);
  cut_flat_ears(kept);
  return true;
}

/// Has the triangle of an ear no height, its outer corner v, at p, between its other corners?
bool Zipper::is_flat_ear(int v, Vec3 p, Vec3 a, Vec3 b) const {
  if (options_.keep_borders || banned_[v] || !is_flat(p, a, b)) return false;
  const double t = nearest_fraction(p, a, b);
  return t > 0 && t < 1;
}

/// Removes flat ears at v, triangles with two border edges: the border goes straight there.
void Zipper::cut_flat_ears(int v) {
  int ear = -1;  // from its outer corner
  auto find = [&] {
    ear = -1;
    mesh.star(v, [&](int e) {
      for (int k : {e, next(e), prev(e)})
        if (const int u = mesh.from(k); mesh.opp[k] < 0 && mesh.opp[prev(k)] < 0 && u != v &&
                                        is_flat_ear(u, points[u], points[mesh.to(k)], points[mesh.apex(k)]))
          ear = k;
    });
    return ear >= 0 && mesh.can_collapse(ear, mesh.from(ear), true);
  };
  while (find()) {
    const int outer = mesh.from(ear), kept = mesh.to(ear);
    const double width = height(ear / 3);
    merges.push_back({outer, kept, width, points[outer], true});
    for (int end : {kept, mesh.apex(ear)}) drift[end] = std::max(drift[end], drift[outer] + width);
    collapse(ear, outer);
  }
}

int Zipper::split(int h, double t) {
  const int a = mesh.from(h), b = mesh.to(h), g = mesh.opp[h];
  for (std::vector<int>* column :
       {&lines.of, &lines.given, &lines.seam}) {  // as EditMesh::split numbers half-edges
    std::vector<int>& c = *column;
    c.insert(c.end(), {c[h], c[next(h)], -1});
    c[next(h)] = -1;
    if (g < 0) continue;
    c.insert(c.end(), {c[g], -1, c[prev(g)]});
    c[prev(g)] = -1;
  }
  const int m = mesh.split(h);
  points.push_back(lerp(points[a], points[b], t));
  drift.push_back((1 - t) * drift[a] + t * drift[b]);
  region_.push_back(-1);
  banned_.push_back(banned_[a] || banned_[b]);
  added.push_back({a, b, t});
  origin.push_back(origin[h / 3]);
  if (g >= 0) origin.push_back(origin[g / 3]);
  return m;
}

/// Merges the apex of the triangle of h with the nearest point of h, if that is not next to an end of h.
bool Zipper::close_cap(int h) {
  const int a = mesh.from(h), b = mesh.to(h), apex = mesh.apex(h);
  const Vec3 edge = points[b] - points[a];
  const double t = dot(points[apex] - points[a], edge) / dot(edge, edge);
  const double end = least_end * options_.tolerance / norm(edge);
  if (!(t > end && t < 1 - end) || banned_[a] || banned_[b]) return false;
  const int m = split(h, t), rung = next(h);  // from m to the apex
  if (is_strip(rung) && merge(rung)) return true;
  collapse(h, m);
  return false;
}

void Zipper::consider(std::vector<Candidate>& heap, int t) const {
  auto length = [&](int h) { return norm(points[mesh.to(h)] - points[mesh.from(h)]); };
  auto is_short = [&](int h) {  // a candidate itself, so that no cap next to it needs to be one
    const int a = mesh.from(h), b = mesh.to(h), l = lines.of[h];
    if (length(h) > options_.tolerance) return false;
    if (region_[a] >= 0 && region_[a] == region_[b]) return true;
    return mesh.hard[h] ? lines.open[l] && lines.length[l] <= options_.tolerance : on_line(a) && on_line(b);
  };
  // a rung of a strip, though it may be a part of a long line
  auto is_end_of_strip = [&](int h) {
    return mesh.hard[h] && (side_of(h).parallel() || side_of(mesh.opp[h]).parallel());
  };
  for (int h = 3 * t; h < 3 * t + 3; ++h) {
    Candidate c{length(h), h, mesh.from(h), mesh.to(h), -1};
    if (length(h) > options_.tolerance) {
      c.width = norm(normal(t)) / length(h), c.apex = mesh.apex(h);
      if (!mesh.hard[h] || c.width > options_.tolerance || !on_line(c.apex)) continue;
      if (is_short(next(h)) || is_short(prev(h))) continue;
    } else if (!is_short(h) && !is_end_of_strip(h)) {
      continue;
    }
    heap.push_back(c);
    std::push_heap(heap.begin(), heap.end());
  }
}

int Zipper::run(std::vector<Candidate> heap) {
  int count = 0;
  const int most =
      4 * (int)points.size() + 100;  // each merge shortens the lines or takes a vertex: a backstop
  while (!heap.empty() && count < most) {
    std::pop_heap(heap.begin(), heap.end());
    const Candidate c = take_last(heap);
    if (mesh.dead(c.h / 3) || mesh.from(c.h) != c.from || mesh.to(c.h) != c.to) continue;
    if (c.apex >= 0 && mesh.apex(c.h) != c.apex) continue;
    const std::size_t before = merges.size();
    if (c.apex >= 0) {
      close_cap(c.h);
    } else if ((region_[c.from] >= 0 && region_[c.from] == region_[c.to]) || is_strip(c.h)) {
      merge(c.h);
    }
    if (merges.size() == before) continue;
    ++count;
    mesh.star(merges[before].kept, [&](int h) { consider(heap, h / 3); });
  }
  return count;
}

/// Folds that merges have made are lines of their own, which are not contracted along.
void Zipper::add_folds() {
  const std::vector<char> added_edges = add_wrinkles();
  for (int h = 0; h < (int)added_edges.size(); ++h) {
    if (!added_edges[h] || mesh.opp[h] < h) continue;
    lines.of[h] = lines.of[mesh.opp[h]] = (int)lines.length.size();
    lines.length.push_back(norm(points[mesh.to(h)] - points[mesh.from(h)]));
    lines.open.push_back(0), lines.rank.push_back(0);
  }
}

int Zipper::close_strips() {
  if (!merges.empty()) add_folds();
  std::fill(region_.begin(), region_.end(), -1);
  std::vector<Candidate> heap;
  const std::vector<char> on_line = vertices_on_lines();
  for (int t = 0; t < (int)mesh.tris.size(); ++t) {
    const Tri& v = mesh.tris[t];
    // both ends of each candidate are on lines
    if (!mesh.dead(t) && on_line[v[0]] + on_line[v[1]] + on_line[v[2]] > 1) consider(heap, t);
  }
  return run(std::move(heap));
}

}  // namespace meshpipe
