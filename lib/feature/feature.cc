// SPDX-License-Identifier: BSD-3-Clause
#include "lib/feature/feature.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "lib/core/error.h"
#include "lib/core/lists.h"
#include "lib/core/number.h"
#include "lib/core/shortest_paths.h"
#include "lib/core/topology.h"
#include "lib/core/triangle_count.h"
#include "lib/feature/planes.h"

namespace meshpipe {
namespace {

constexpr double corner_turn = 50 * degree;    ///< a chain that turns by more ends there
constexpr double continue_turn = 45 * degree;  ///< along weak edges it turns by less
constexpr double near_cosine = 0.8;            ///< of normals that turn by less than continue_turn: 0.71
constexpr double step = 60 * degree;  ///< a border that bends by more stays a crease when patches merge
constexpr double smooth_turn = 20 * degree;  ///< mean change of the turning vector from vertex to vertex
constexpr double design_share = 0.5;         ///< of the strong edges, by length, in smooth chains
constexpr double plane_share = 0.8;          ///< of the area, in plane faces of several triangles
constexpr double many_share = 0.1;           ///< the same of eight or more: parts 0.17, figures up to 0.03
constexpr double noise = 2.5;  ///< edges between weak and strong over the strong: parts up to 2, scans 3.2
constexpr double most_between = 0.7;  ///< the same: polyhedra up to 0.7, scans however rough from 0.9
constexpr double least_edge = 0.4;    ///< target lengths, of the mean edge: finer polyhedra are as others,
constexpr int few_triangles = 24;  ///< unless they have no more, as a hexagonal prism: they cost no triangles
constexpr double step_share = 0.85;  ///< of the creases; segmented images have 0.96 or more, parts up to 0.8
constexpr double gap = 0.05;         ///< edges between weak and strong, as a share of the strong ones' length
constexpr double spacing = 1.5, dense = 0.85;  ///< target lengths between creases, on average; struts: 0.75
/// Target lengths: thinner triangles do not show which way they face, and mfeature removes such features
/// unasked. (At 0.02, two lines along a needle forced needles: a third of the rounds that CAD had to repeat.)
constexpr double sliver = 0.06;
constexpr double slender = 0.05;     ///< height over length: other triangles have normals of their own
constexpr double widest_band = 0.5;  ///< times `sliver`, to either side
/// Times further across an edge, for each 1 - cosine of its angle. Creases of 12 CAD surfaces are the same
/// from 30 to 120; below it two of them lack some.
constexpr double far_turn = 30;
constexpr double in_plane = 0.999;     ///< cosine of the angle between triangles in one plane, at least
constexpr double rounding = 3e-6;      ///< of the diagonal: single-precision coordinates, with a margin
constexpr double long_chain = 5;       ///< mean edges of the input
constexpr double short_chain = 3;      ///< target lengths, or mean edges of the input
constexpr double elongated = 1.5;      ///< mean edge over that of equal triangles: long ones measure no width
constexpr double least_fading = 10;    ///< target lengths: of a crease that ends freely
constexpr double short_rim = 0.5;      ///< the same of the rim of a hole
constexpr double longest_chain = 0.1;  ///< of the diagonal: coarse models have no longer chains to judge by
constexpr double own_chain = 0.7;      ///< of the root of the area: so do bits; edges of tetrahedra have 0.76

/// The network of crease edges while it is chosen. Flags and angles are kept on both half-edges of an edge.
struct Network {
  const Surface& s;
  const std::vector<int>& opposite;
  std::vector<double> angle{};       ///< between the normals on either side
  std::vector<char> on{}, strong{};  ///< creases; those chosen by their angle alone
  std::vector<char> patch{};         ///< between two patches, or given
  std::vector<char> given{};         ///< by the caller
  std::vector<char> cap{};           ///< on the border of a patch that caps an end
  std::vector<char> merged{};        ///< between two patches that have become one
  std::vector<int> spoke{};          ///< a half-edge that leaves the vertex, on the border the border's
  std::vector<int> valence{};        ///< of the network of creases
  std::vector<char> anchor{};  ///< on a border of the surface or of a (former) patch: chains may end there
  double size = 0;             ///< target edge length
  double shortest = 0;         ///< pieces below this length are dropped
  double shortest_rim = 0;     ///< closed smooth chains below this one
  double telling = 0;          ///< chains above this length show whether the surface is designed

  int from(int h) const { return origin(s.tris, h); }
  int to(int h) const { return target(s.tris, h); }
  Vec3 along(int h) const { return s.points[to(h)] - s.points[from(h)]; }
  double length(int h) const { return norm(along(h)); }
  double turn(int in, int out) const { return meshpipe::angle(along(in), along(out)); }
  bool free_end(int v) const { return valence[v] == 1 && !anchor[v]; }

  void set(int h, char value) {
    on[h] = on[opposite[h]] = value;
    valence[from(h)] += value ? 1 : -1;
    valence[to(h)] += value ? 1 : -1;
  }

  /// Calls visit(h) for the half-edges that leave v, except those on the border.
  template <class Visit>
  void around(int v, Visit visit) const {
    int h = spoke[v];
    do {
      const int after = opposite[prev(h)];
      if (opposite[h] >= 0) visit(h);
      h = after;
    } while (h >= 0 && h != spoke[v]);
  }

  /// The first crease half-edge that leaves v, other than `except`; -1 if none.
  int leaving(int v, int except) const {
    int found = -1;
    around(v, [&](int h) {
      if (found < 0 && on[h] && h != except) found = h;
    });
    return found;
  }
};

using Chain = std::vector<int>;  ///< half-edges, end to end

double length(const Network& net, const Chain& chain) {
  double sum = 0;
  for (int h : chain) sum += net.length(h);
  return sum;
}

Network find_edges(const CutSurface& cut, const FeatureOptions& options, const std::vector<int>* before,
                   const std::vector<int>* given, int& slivers) {
  const Surface& s = cut.surface;
  Network net{.s = s, .opposite = cut.opposite};
  const int n = (int)net.opposite.size();
  net.size = options.size > 0 ? options.size : size_for_count(total_area(s), (double)s.tris.size());
  const std::vector<Vec3> normal = side_normals({s, net.opposite}, sliver * net.size);
  int thin = 0;
#pragma omp parallel for schedule(static) reduction(+ : thin)
  for (int t = 0; t < n / 3; ++t) {
    const Tri& v = s.tris[t];
    const Vec3 own = area_vector(s.points[v[0]], s.points[v[1]], s.points[v[2]]);
    if (!(dot(own, normal[t]) > near_cosine * norm(own))) thin += angle(own, normal[t]) > continue_turn;
  }
  slivers += thin;
  net.angle.assign(n, 0);
#pragma omp parallel for schedule(static)
  for (int h = 0; h < n; ++h)
    if (const int o = net.opposite[h]; o > h)
      net.angle[h] = net.angle[o] = angle(normal[h / 3], normal[o / 3]);
  for (auto* flags : {&net.on, &net.patch, &net.given, &net.cap, &net.merged}) flags->assign(n, 0);
  auto caps = [&](int label) { return options.first_cap <= label && label <= options.last_cap; };
  net.spoke.assign(s.points.size(), -1);
  net.valence.assign(s.points.size(), 0);
  net.anchor.assign(s.points.size(), 0);
  const std::vector<int>* patch = s.face.has("patch") ? &s.face.get<int>("patch") : nullptr;
  double sum = 0;
  for (int h = 0; h < n; ++h) {
    const int o = net.opposite[h], v = net.from(h);
    if (net.spoke[v] < 0 || o < 0) net.spoke[v] = h;
    sum += net.length(h);
    const bool border = o >= 0 && patch && (*patch)[h / 3] != (*patch)[o / 3];
    const bool merged = o >= 0 && !border && before && (*before)[h / 3] != (*before)[o / 3];
    net.given[h] = o >= 0 && !merged && given && (*given)[h] >= 0;
    net.patch[h] = border || net.given[h];
    net.cap[h] = border && (caps((*patch)[h / 3]) || caps((*patch)[o / 3]));
    net.merged[h] = merged && options.mode == FeatureOptions::automatic && net.angle[h] <= step;
    if (o < 0 || net.patch[h] || net.merged[h]) net.anchor[v] = net.anchor[net.to(h)] = 1;
  }
  // the input's own edges show whether it is designed, the target's which creases are worth keeping
  const double mean = n ? sum / n : 0, most = longest_chain * diagonal(s);
  net.telling = std::min(long_chain * mean, most);
  const double size = options.size > 0 ? options.size : std::min(mean, elongated * net.size);
  net.shortest = std::min(short_chain * size, most);
  net.shortest_rim = std::min(short_rim * size, most);
  return net;
}

/// Continues from the free end v along weak edges, as straight as they allow, until it meets the network.
void follow(Network& net, int v, double weak) {
  if (!net.free_end(v)) return;
  for (int in = net.opposite[net.leaving(v, -1)];;) {
    int best = -1;
    double least = continue_turn;
    net.around(v, [&](int h) {
      if (net.on[h] || net.patch[h] || net.merged[h] || net.angle[h] <= weak) return;
      if (double a = net.turn(in, h); a < least) {
        least = a;
        best = h;
      }
    });
    if (best < 0) return;
    v = net.to(best);
    const bool met = net.valence[v] > 0 || net.anchor[v];
    net.set(best, 1);
    if (met) return;
    in = best;
  }
}

std::vector<int> free_ends(const Network& net) {
  std::vector<int> ends;
  for (int v = 0; v < (int)net.valence.size(); ++v)
    if (net.free_end(v)) ends.push_back(v);
  return ends;
}

/// Chooses the edges above the strong angle, and those above the weak one that continue them.
void choose(Network& net, double strong, double weak) {
  for (int h = 0; h < (int)net.opposite.size(); ++h)
    if (net.opposite[h] > h && !net.patch[h] && !net.merged[h] && net.angle[h] > strong) net.set(h, 1);
  net.strong = net.on;
  for (int v : free_ends(net)) follow(net, v, weak);
}

/// Returns the chains between corners and junctions, then the closed ones without any.
std::vector<Chain> chains_of(const Network& net) {
  std::vector<Chain> all;
  std::vector<char> seen(net.on.size(), 0);
  auto after = [&](int in) {  // -1 at the end of the chain
    const int v = net.to(in);
    if (net.valence[v] != 2 || net.anchor[v]) return -1;
    const int out = net.leaving(v, net.opposite[in]);
    return net.turn(in, out) > corner_turn ? -1 : out;
  };
  for (bool closed : {false, true})
    for (int h = 0; h < (int)net.on.size(); ++h) {
      if (!net.on[h] || seen[h] || (!closed && after(net.opposite[h]) >= 0)) continue;
      Chain& chain = all.emplace_back();
      for (int g = h; g >= 0 && !seen[g]; g = after(g)) {
        seen[g] = seen[net.opposite[g]] = 1;
        chain.push_back(g);
      }
    }
  return all;
}

/// Returns the mean change of the turning vector (the angle times the axis) from vertex to vertex: 0 on
/// straight lines and circles however coarse, twice the angle on a zigzag.
double roughness(const Network& net, const Chain& chain) {
  double sum = 0;
  Vec3 last;
  for (std::size_t i = 1; i < chain.size(); ++i) {
    const Vec3 axis =
        net.turn(chain[i - 1], chain[i]) * normalized(cross(net.along(chain[i - 1]), net.along(chain[i])));
    if (i > 1) sum += norm(axis - last);
    last = axis;
  }
  return chain.size() > 2 ? sum / (double)(chain.size() - 2) : 0;
}

/// Drops chains with a free end unless `keeps` says so.
template <class Keeps>
void prune(Network& net, Keeps keeps) {
  std::vector<int> ends = free_ends(net);
  Chain chain;
  while (!ends.empty()) {
    const int v = take_last(ends);
    if (!net.free_end(v)) continue;
    chain.clear();
    int h = net.leaving(v, -1);
    for (;;) {
      chain.push_back(h);
      const int end = net.to(h);
      if (net.valence[end] != 2 || net.anchor[end]) break;
      h = net.leaving(end, net.opposite[h]);
    }
    if (keeps(chain)) continue;
    for (int g : chain) net.set(g, 0);
    if (net.free_end(net.to(h))) ends.push_back(net.to(h));
  }
}

/// Is a chain that ends freely a crease that fades out, as where a groove runs into a curved face? Those of
/// noise are short or rough.
bool fades_out(const Network& net, const Chain& chain) {
  double strong = 0;
  for (int h : chain)
    if (net.strong[h]) strong += net.length(h);
  const double whole = length(net, chain);
  return whole >= least_fading * net.size && strong > 0.5 * whole && roughness(net, chain) < smooth_turn;
}

/// What the edges of each component show; lengths and areas.
struct Components {
  std::vector<int> of{};  ///< per triangle
  int n = 0;
  std::vector<double> sharp{}, between{};  ///< strong edges; those between weak and strong
  std::vector<double> on_patches{};        ///< of the strong edges
  std::vector<double> area{};
  std::vector<double> edge{};  ///< mean length, over the target
  std::vector<int> triangles{};
  std::vector<PlaneShares> planes{};  ///< 0 where they show nothing

  /// Whether it is a polyhedron, however rough, and the target short enough for its edges, or these few:
  /// noise has every angle, and segmented images have steps.
  bool angular(int c) const {
    return between[c] < most_between * sharp[c] && planes[c].steps < step_share &&
           (edge[c] > least_edge || triangles[c] <= few_triangles);
  }
  /// Whether plane faces of several triangles cover enough of its area, or those of many.
  bool plane(int c, double several, double many, double size) const {
    return several >= plane_share ||
           (many >= many_share && between[c] < noise * sharp[c] && area[c] > dense * size * sharp[c]);
  }
};

Components look_at(const Network& net, double strong, double weak) {
  Components look;
  const int n = look.n = components(net.opposite, look.of), m = (int)net.opposite.size();
  for (auto* sum : {&look.sharp, &look.between, &look.on_patches, &look.area, &look.edge}) sum->assign(n, 0);
  look.triangles.assign(n, 0);
  std::vector<double> in_planes(n, 0);  // area of triangles in plane faces of several
  for (int t = 0; t < m / 3; ++t) {
    const double area = triangle_area(net.s, t);
    bool plane = false;
    for (int h = 3 * t; h < 3 * t + 3; ++h) plane |= net.opposite[h] >= 0 && net.angle[h] < flat_angle;
    ++look.triangles[look.of[t]];
    look.area[look.of[t]] += area;
    if (plane) in_planes[look.of[t]] += area;
  }
  for (int h = 0; h < m; ++h) {
    if (net.opposite[h] < h || net.cap[h]) continue;
    const int c = look.of[h / 3];
    if (net.angle[h] > weak && net.angle[h] <= strong) look.between[c] += net.length(h);
    if (!net.strong[h] && !(net.patch[h] && net.angle[h] > strong)) continue;
    look.sharp[c] += net.length(h);
    if (net.patch[h]) look.on_patches[c] += net.length(h);
  }
  look.planes.resize(n);
  bool planes_matter = false;
  for (int c = 0; c < n; ++c) {
    const double most = 1.01 * in_planes[c] / look.area[c];  // which is summed in another order
    planes_matter |= look.between[c] < most_between * look.sharp[c] || look.plane(c, most, most, net.size);
  }
  if (!planes_matter) return look;
  look.planes = plane_shares({net.s, net.opposite}, {net.angle, net.strong, look.of, n});
  for (int h = 0; h < m; ++h) look.edge[look.of[h / 3]] += net.length(h) / (3 * net.size);
  for (int c = 0; c < n; ++c) look.edge[c] /= look.triangles[c];
  return look;
}

/// Drops the creases of components that do not look designed. A component looks designed if half of its
/// strong edges, by length, are in long smooth chains; or if almost no edges are between weak and strong and
/// creases leave space for triangles; or if it is angular or made of planes, or has large ones, less noise
/// and more space; or if it did, as `known` says.
void keep_designed(Network& net, const Components& look, const std::vector<std::uint8_t>& known) {
  const int m = (int)net.opposite.size();
  const auto& [component, n, sharp, between, on_patches, area, edge, triangles, planes] = look;
  std::vector<double> smooth = on_patches;
  for (const Chain& chain : chains_of(net)) {
    // a rim of many edges is long, however long edges are elsewhere
    const bool rim = net.to(chain.back()) == net.from(chain[0]) && (double)chain.size() > long_chain;
    const int c = component[chain[0] / 3];
    const bool tells = length(net, chain) > std::min(net.telling, own_chain * std::sqrt(area[c]));
    if (!((rim || tells) && roughness(net, chain) < smooth_turn)) continue;
    for (int h : chain)
      if (net.strong[h]) smooth[c] += net.length(h);
  }
  std::vector<char> designed(n, 0);
  for (int c = 0; c < n; ++c)
    designed[c] = look.angular(c) || (planes[c].steps < step_share &&
                                      look.plane(c, planes[c].several, planes[c].many, net.size));
  for (int h = 0; !known.empty() && h < m; ++h)
    if (known[h / 3] >> h % 3 & 1 && !net.patch[h] && !net.given[h]) designed[component[h / 3]] = 1;
  for (int h = 0; h < m; ++h) {
    if (!net.on[h]) continue;
    const int c = component[h / 3];
    const bool kept = designed[c] || smooth[c] >= design_share * sharp[c] ||
                      (between[c] < gap * sharp[c] && area[c] > spacing * net.size * sharp[c]);
    if (!kept) net.set(h, 0);
  }
}

/// Drops connected pieces of the network that are short in all and touch no border, as noise makes them, of
/// components that are not angular. The rim of a hole is none: a smooth closed chain, which may be shorter.
void drop_small_pieces(Network& net, const Components& look) {
  const int n = (int)net.s.points.size();
  std::vector<char> rim(n, 0);
  for (const Chain& chain : chains_of(net)) {
    const bool closed = net.to(chain.back()) == net.from(chain[0]);
    if (closed && length(net, chain) >= net.shortest_rim && roughness(net, chain) < smooth_turn)
      for (int h : chain) rim[net.to(h)] = 1;
  }
  std::vector<char> seen(n, 0);
  std::vector<int> piece;
  for (int seed = 0; seed < n; ++seed) {
    if (seen[seed] || !net.valence[seed]) continue;
    piece.assign(1, seed);
    seen[seed] = 1;
    double twice = 0;
    bool held = look.angular(look.of[net.spoke[seed] / 3]);
    for (std::size_t i = 0; i < piece.size(); ++i) {
      held = held || net.anchor[piece[i]] || rim[piece[i]];
      net.around(piece[i], [&](int h) {
        if (!net.on[h]) return;
        twice += net.length(h);
        if (!seen[net.to(h)]) piece.push_back(net.to(h));
        seen[net.to(h)] = 1;
      });
    }
    if (held || twice >= 2 * net.shortest) continue;
    for (int v : piece)
      net.around(v, [&](int h) {
        if (net.on[h]) net.set(h, 0);
      });
  }
}

/// Writes the model bits and counts edges and corners.
void mark(const Network& net, std::vector<std::uint8_t>& model, FeatureReport& r) {
  std::vector<int> lines(net.s.points.size(), 0);
  for (int h = 0; h < (int)net.opposite.size(); ++h) {
    if (!net.on[h] && !net.patch[h]) continue;
    model[h / 3] |= 1 << h % 3;
    if (net.opposite[h] < h) continue;
    (net.given[h] ? r.given_edges : net.patch[h] ? r.patch_edges : r.crease_edges) += 1;
    ++lines[net.from(h)];
    ++lines[net.to(h)];
  }
  r.model_edges = r.patch_edges + r.given_edges + r.crease_edges;
  for (int v = 0; v < (int)lines.size(); ++v) {
    if (!lines[v]) continue;
    bool corner = lines[v] != 2;
    if (!corner) {
      int two[2], k = 0;
      net.around(v, [&](int h) {
        if (net.on[h] || net.patch[h]) two[k++] = h;
      });
      corner = net.turn(net.opposite[two[0]], two[1]) > corner_turn;
    }
    r.corners += corner;
  }
}

}  // namespace

void parse_angles(const std::string& text, FeatureOptions& options) {
  options.mode = text == "auto"   ? FeatureOptions::automatic
                 : text == "none" ? FeatureOptions::none
                                  : FeatureOptions::angles;
  if (options.mode != FeatureOptions::angles) return;
  const char *at = text.data(), *end = at + text.size();
  auto [after, error] = from_chars(at, end, options.strong);
  options.weak = options.strong / 2;
  if (error == std::errc() && after < end && *after == ',') {
    auto second = from_chars(after + 1, end, options.weak);
    after = second.ptr;
    error = second.ec;
  }
  if (error != std::errc() || after != end ||
      !(0 < options.weak && options.weak <= options.strong && options.strong < 180))
    throw BadUsage("--feature-angle " + text + " is not auto, none, A or A,B with 0 < B <= A < 180 degrees");
}

std::vector<Vec3> side_normals(const Connectivity& surface, double thin) {
  const double least_height = rounding * diagonal(surface.mesh);
  const int n = surface.n_tris();
  std::vector<Vec3> normal(n);
  std::vector<char> is_thin(n), has_none(n);
#pragma omp parallel for schedule(static)
  for (int t = 0; t < n; ++t) {
    const Vec3 a = surface.area_vector(t);
    const double length =
        std::max({surface.length(3 * t), surface.length(3 * t + 1), surface.length(3 * t + 2)});
    normal[t] = normalized(a);
    has_none[t] = norm(a) < least_height * length;
    is_thin[t] = has_none[t] || norm(a) < std::min(thin, slender * length) * length;
  }
  // from center to center, across the edges: sharp ones are far, since there one side ends
  auto half_way = [&](int h) {
    return norm(surface.area_vector(h / 3)) / std::max(surface.length(h), 1e-300) / 3;
  };
  auto farther = [&](int h) {
    const int t = h / 3, o = surface.opposite[h] / 3;
    return has_none[t] || has_none[o] ? 1 : 1 + far_turn * (1 - dot(normal[t], normal[o]));
  };
  // those without a normal of their own first, as they are next to thin ones that have one
  auto take_nearest = [&](const std::vector<char>& takes) {
    if (std::find(takes.begin(), takes.end(), 1) == takes.end()) return;
    std::vector<int> out(n, -1), order, seeds;  // the half-edge through which the nearest side is reached
    std::vector<double> way(n, infinity), width(n, 0);
    for (int h = 0; h < 3 * n; ++h) {
      const int t = h / 3, o = surface.opposite[h];
      if (!takes[t] || o < 0 || takes[o / 3] || !(farther(h) * half_way(h) < way[t])) continue;
      if (out[t] < 0) seeds.push_back(t);
      way[t] = farther(h) * half_way(h);
      out[t] = h;
    }
    shortest_paths(seeds, way, [&](int t, auto reach) {
      order.push_back(t);
      for (int h = 3 * t; h < 3 * t + 3; ++h)
        if (const int o = surface.opposite[h];
            o >= 0 && takes[o / 3] && reach(o / 3, way[t] + farther(h) * (half_way(h) + half_way(o))))
          out[o / 3] = o;
    });
    auto from = [&](int t) { return surface.opposite[out[t]] / 3; };
    for (int t : order) {
      const int o = surface.opposite[out[t]];
      width[t] = half_way(out[t]) + (takes[o / 3] ? half_way(o) + width[o / 3] : 0);
    }
    std::vector<double> whole = width;  // of the widest branch through t
    for (auto t = order.rbegin(); t != order.rend(); ++t)
      whole[from(*t)] = std::max(whole[from(*t)], whole[*t]);
    for (int t : order)
      if (has_none[t] || whole[t] <= widest_band * thin) normal[t] = normal[from(t)];
  };
  take_nearest(has_none);
  std::fill(has_none.begin(), has_none.end(), 0);
  // a side of which a part is not thin faces as that does, however far it goes on in its plane
  std::vector<int> wide, root;  // wide: those next to thin ones
  for (int h = 0; h < 3 * n; ++h)
    if (const int o = surface.opposite[h]; is_thin[h / 3] && o >= 0 && !is_thin[o / 3]) wide.push_back(o / 3);
  sort_unique(wide);
  if (!wide.empty()) root = identity(n);
  for (std::size_t i = 0; i < wide.size(); ++i)
    for (int h = 3 * wide[i]; h < 3 * wide[i] + 3; ++h) {
      const int t = surface.opposite[h] / 3, r = root[wide[i]];
      if (surface.opposite[h] < 0 || !is_thin[t] || dot(normal[t], normal[r]) < in_plane) continue;
      is_thin[t] = 0, root[t] = r;
      wide.push_back(t);
    }
  take_nearest(is_thin);
  return normal;
}

FeatureReport mark_features(CutSurface cut, const FeatureOptions& options, const std::vector<int>* before,
                            const std::vector<int>* given) {
  Surface& surface = cut.surface;
  FeatureReport report;
  Network net = find_edges(cut, options, before, given, report.slivers);
  if (options.mode != FeatureOptions::none) {
    const double strong = options.strong * degree, weak = options.weak * degree;
    choose(net, strong, weak);
    auto is_long = [&](const Chain& chain) { return length(net, chain) >= net.shortest; };
    if (options.mode == FeatureOptions::automatic) {
      const Components look = look_at(net, strong, weak);
      prune(net, [&](const Chain& chain) {
        return look.angular(look.of[chain[0] / 3]) ? is_long(chain) : fades_out(net, chain);
      });
      keep_designed(net, look,
                    options.again ? surface.face.get<std::uint8_t>("model") : std::vector<std::uint8_t>());
      drop_small_pieces(net, look);
    } else {
      prune(net, is_long);
    }
  }
  std::vector<std::uint8_t> model(surface.tris.size(), 0);
  mark(net, model, report);
  surface.face.set("model", std::move(model));
  return report;
}

}  // namespace meshpipe
