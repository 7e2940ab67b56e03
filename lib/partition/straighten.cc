// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <map>
#include <span>

#include "lib/core/connectivity.h"
#include "lib/core/cut.h"
#include "lib/core/lists.h"
#include "lib/core/parallel.h"
#include "lib/core/progress.h"
#include "lib/core/regions.h"
#include "lib/core/topology.h"
#include "lib/numeric/threshold.h"
#include "lib/partition/curve_neighborhood.h"
#include "lib/partition/curves.h"
#include "lib/partition/partition.h"

namespace meshpipe {
namespace {

enum class Role { moves, stays, other };

/// How far to diffuse, in mean edge lengths of the curve, and how often; then how often to pull straight, and
/// whether the ends on a border stay at or between their vertices.
struct Attempt {
  double width;
  int steps, sweeps;
  bool ends_stay;
};
// all together, those at fault again and more gently
constexpr Attempt attempts[] = {{4, 5, 30, false}, {3, 1, 30, false}, {0, 0, 100, false}, {0, 0, 100, true}};

constexpr int rings = 14;  // of a band on each side: the diffused indicator has its value there

/// What happens near the curves that are straightened together: each has a band of triangles of its own.
struct Bands {
  SubMesh mesh;                   // of all bands
  std::vector<int> opposite;      // of the bands' half-edges
  std::vector<int> curve;         // of each triangle of the surface: its band, or -1
  std::vector<double> held;       // of each vertex of the bands: the value it is held at, or not_held
  std::vector<signed char> apex;  // the side (+1 a, -1 b) of a triangle on an interface edge that stays, or 0
};

/// Vertices go to the curve that reaches them first through its own two parts; a triangle is in the band of
/// its vertices.
Bands make_bands(const CutSurface& cut, const std::vector<Curve>& curves, const std::vector<Role>& role) {
  const Surface& s = cut.surface;
  const std::vector<int>& opposite = cut.opposite;
  constexpr int nobody = -1, blocked = -2;
  const std::vector<int>& part = s.face.get<int>("part");
  std::vector<int> owner(s.points.size(), nobody);
  for (int c = 0; c < (int)curves.size(); ++c)
    if (role[c] != Role::other)
      for (int h : curves[c].half_edges)
        owner[origin(s.tris, h)] = owner[target(s.tris, h)] = role[c] == Role::moves ? c : blocked;
  auto of = [&](int t, int c) { return part[t] == curves[c].a || part[t] == curves[c].b; };

  std::vector<int> leaving;
  for (int c = 0; c < (int)curves.size(); ++c)
    if (role[c] == Role::moves)
      for (int h : curves[c].half_edges) leaving.insert(leaving.end(), {h, next(h)});
  grow_owners(cut.connectivity(), std::move(leaving), rings, owner, of);

  Bands bands;
  bands.curve.assign(s.tris.size(), -1);
  std::vector<int> in_band(s.tris.size(), -1);
  for (std::size_t t = 0; t < s.tris.size(); ++t) {
    const Tri& v = s.tris[t];
    const int c = owner[v[0]];
    if (c >= 0 && owner[v[1]] == c && owner[v[2]] == c && of((int)t, c)) bands.curve[t] = c, in_band[t] = 0;
  }
  bands.mesh = std::move(split_by_label(s, in_band, 1)[0]);

  // at the rim the sides stay what they are, and the curve stays where it leaves the band or is a model edge
  enum { rim = 1, side_a = 2, side_b = 4, on_level = 8 };
  std::vector<char> marks(s.points.size(), 0);
  std::vector<signed char> apex(s.points.size(), 0);
  for (std::size_t t = 0; t < s.tris.size(); ++t)
    for (int v : s.tris[t]) {
      const int c = owner[v];
      if (c < 0 || !of((int)t, c)) continue;
      if (bands.curve[t] < 0) marks[v] |= rim;
      marks[v] |= part[t] == curves[c].a ? side_a : side_b;
    }
  for (int c = 0; c < (int)curves.size(); ++c) {
    if (role[c] != Role::moves) continue;
    for (int h : curves[c].half_edges)
      if (cut.connectivity().is_model(h) || bands.curve[h / 3] < 0 || bands.curve[opposite[h] / 3] < 0) {
        marks[origin(s.tris, h)] |= on_level;
        marks[target(s.tris, h)] |= on_level;
        apex[origin(s.tris, prev(h))] = 1;
        apex[origin(s.tris, prev(opposite[h]))] = -1;
      }
  }
  // where two fans of a band meet in a vertex, the line could move in one of them only
  bands.opposite = opposite_halfedges(bands.mesh);
  std::vector<int> fans(bands.mesh.points.size(), 0);
  for (int h = 0; h < (int)bands.opposite.size(); ++h)
    if (bands.opposite[h] < 0 && ++fans[origin(bands.mesh.tris, h)] > 1)
      marks[bands.mesh.vertex[origin(bands.mesh.tris, h)]] |= rim;
  for (int v : bands.mesh.vertex) {
    const int m = marks[v];
    const bool both = (m & side_a) && (m & side_b);
    bands.held.push_back(m & on_level || (m & rim && both) ? 0.0
                         : !(m & rim)                      ? not_held
                         : m & side_a                      ? 1.0
                                                           : -1.0);
    bands.apex.push_back(apex[v]);
  }
  return bands;
}

/// The sides of the bands' vertices: +1 or -1, or 0 where triangles of both sides meet.
std::vector<double> sides(const Bands& bands, const std::vector<double>& sign) {
  std::vector<double> least(bands.mesh.points.size(), 1), most(least.size(), -1);
  for (std::size_t k = 0; k < sign.size(); ++k)
    for (int v : bands.mesh.tris[k]) {
      least[v] = std::min(least[v], sign[k]);
      most[v] = std::max(most[v], sign[k]);
    }
  for (std::size_t v = 0; v < least.size(); ++v) least[v] = (least[v] + most[v]) / 2;
  return least;
}

/// The zero level of the bands' field, pulled straight, as a line of the surface, which has n vertices.
LevelLine straight_line(const Bands& bands, std::vector<double> field, double snap, const Attempt& attempt,
                        std::size_t n) {
  std::vector<LineVertex> hold;
  for (std::size_t v = 0; v < field.size(); ++v) {
    double& f = field[v];
    if (bands.held[v] != not_held) f = bands.held[v];
    if (bands.apex[v] != 0 && f != 0) f = bands.apex[v] * std::max(1e-3, bands.apex[v] * f);
    hold.push_back(bands.held[v] == not_held && bands.apex[v] == 0 ? LineVertex::moves : LineVertex::stays);
  }
  for (int h = 0; attempt.ends_stay && h < (int)bands.opposite.size(); ++h)
    if (bands.opposite[h] < 0) hold[origin(bands.mesh.tris, h)] = LineVertex::stays;
  LevelLine line = zero_level(bands.mesh, field);
  pull_straight({bands.mesh, bands.opposite}, line, hold, snap, attempt.sweeps);
  return in_whole(line, bands.mesh.vertex, n);
}

/// Gives the pieces of a part that are not attached to the rest of it to the other part of the band that they
/// lie in. A part of which no piece is attached keeps its largest.
void give_away_fragments(const Connectivity& mesh, const std::vector<int>& anchors,
                         const std::vector<int>& band, const std::vector<Curve>& curves, int n_parts,
                         std::vector<int>& part) {
  std::vector<int> piece = part;
  const int n = separate_pieces(mesh, piece);
  std::vector<double> area(n, 0);
  std::vector<int> of(n), largest(n_parts, -1);
  for (std::size_t t = 0; t < part.size(); ++t) {
    area[piece[t]] += norm(mesh.area_vector((int)t));
    of[piece[t]] = part[t];
  }
  std::vector<char> stays(n, 0);
  for (int h : anchors) stays[piece[h / 3]] = 1;
  for (int i = 0; i < n; ++i)
    if (int& l = largest[of[i]]; l < 0 || std::pair(stays[i], area[i]) > std::pair(stays[l], area[l])) l = i;
  for (int l : largest)
    if (l >= 0) stays[l] = 1;
  for (std::size_t t = 0; t < part.size(); ++t)
    if (band[t] >= 0 && !stays[piece[t]]) part[t] = curves[band[t]].a + curves[band[t]].b - part[t];
}

/// Length of each curve inside its band, and the number of its model edges.
struct Measure {
  std::vector<double> length;
  std::vector<int> model_edges;
};
Measure measure(const CutSurface& cut, const std::vector<int>& band, std::size_t n_curves) {
  const std::vector<int>& part = cut.surface.face.get<int>("part");
  const Connectivity mesh = cut.connectivity();
  Measure m{std::vector<double>(n_curves, 0), std::vector<int>(n_curves, 0)};
  for (int h = 0; h < mesh.n_half_edges(); ++h) {
    const int o = mesh.opposite[h];
    if (o < h || part[h / 3] == part[o / 3] || band[h / 3] < 0 || band[h / 3] != band[o / 3]) continue;
    m.length[band[h / 3]] += mesh.length(h);
    m.model_edges[band[h / 3]] += mesh.is_model(h);
  }
  return m;
}

/// A curve that cannot be straightened with the others; with other means it might.
struct Fault {
  int curve;
  bool again;
};

/// The line of the bands: their interfaces diffused, or as they are, then pulled straight.
LevelLine line_of(const Surface& surface, const std::vector<Curve>& curves, const Bands& bands,
                  const Attempt& attempt, double snap) {
  std::vector<double> sign, time, scale(curves.size(), 0);
  for (std::size_t c = 0; c < curves.size(); ++c) {
    for (int h : curves[c].half_edges)
      scale[c] += edge_length(surface, h) / (double)curves[c].half_edges.size();
    scale[c] *= scale[c] * attempt.width * attempt.width;
  }
  for (int t : bands.mesh.face) {
    sign.push_back(surface.face.get<int>("part")[t] == curves[bands.curve[t]].a ? 1 : -1);
    time.push_back(scale[bands.curve[t]]);
  }
  const std::vector<double> level =
      attempt.steps > 0 ? threshold_dynamics(bands.mesh, std::move(sign), time, bands.held, attempt.steps)
                        : sides(bands, sign);
  return straight_line(bands, level, snap, attempt, surface.points.size());
}

/// The curves at fault for what has become longer, lost model edges, or broken; those next to a broken part
/// if there is no other.
std::vector<Fault> find_faults(const std::vector<Curve>& curves, const std::vector<Role>& role,
                               const std::vector<char>& broken, const Measure& before, const Measure& now) {
  constexpr double as_long = 3e-3;  // an increase of the length, as a fraction: it was straight
  std::vector<Fault> at_fault, near_fault;
  for (int c = 0; c < (int)curves.size(); ++c) {
    if (role[c] != Role::moves) continue;
    const bool fewer = now.model_edges[c] < before.model_edges[c];
    if (now.length[c] > (1 + 1e-9) * before.length[c] || fewer)
      at_fault.push_back({c, fewer || now.length[c] > (1 + as_long) * before.length[c]});
    else if (broken[curves[c].a] || broken[curves[c].b])
      near_fault.push_back({c, true});
  }
  if (at_fault.empty()) at_fault = near_fault;
  if (at_fault.empty() && std::find(broken.begin(), broken.end(), 1) != broken.end())
    for (int c = 0; c < (int)curves.size(); ++c)  // a bound on the triangles of a third part
      if (role[c] == Role::moves) at_fault.push_back({c, true});
  return at_fault;
}

/// Straightens the chosen curves at once. If all is well, changes the surface, its `opposite` too, and
/// returns an empty list; otherwise returns the curves at fault.
std::vector<Fault> try_straighten(CurveNeighborhood& near, const PartTopologies& topology,
                                  const std::vector<Curve>& curves, const std::vector<Role>& role,
                                  const Attempt& attempt, double snap) {
  const CutSurface cut = near.cut();
  Surface& surface = cut.surface;
  Bands bands = make_bands(cut, curves, role);
  if (bands.mesh.tris.empty()) return {};
  const LevelLine line = line_of(surface, curves, bands, attempt, snap);
  std::vector<char> active(surface.tris.size(), 0);
  for (int t : bands.mesh.face) {  // one with all corners held on the level stays on its side
    const Tri& v = surface.tris[t];
    active[t] = line.sign[v[0]] != 0 || line.sign[v[1]] != 0 || line.sign[v[2]] != 0;
  }
  const Measure before = measure(cut, bands.curve, curves.size());

  Surface s = surface;
  std::vector<int> after = cut.opposite;
  constexpr auto band_column = "straighten band";
  s.face.set(band_column, std::move(bands.curve));
  std::vector<int> side;
  cut_along_line({s, after}, line, active, side);
  const std::vector<int> band = s.face.get<int>(band_column);
  s.face.erase(band_column);
  std::vector<int>& part = s.face.get<int>("part");
  for (std::size_t t = 0; t < part.size(); ++t)
    if (side[t] >= 0) part[t] = side[t] ? curves[band[t]].a : curves[band[t]].b;
  give_away_fragments({s, after}, near.anchors, band, curves, near.n_parts(), part);
  const std::vector<char> broken =
      broken_parts(topology, topology_of_parts_in(near, {s, after}, part), part, near);
  const Measure now = measure({s, after}, band, curves.size());
  const std::vector<Fault> faults = find_faults(curves, role, broken, before, now);
  if (faults.empty()) surface = std::move(s), cut.opposite = std::move(after);
  return faults;
}

/// Straightens the curves at once, without those that turn out to be at fault, and keeps the handles of the
/// latter that may do better by other means.
void straighten_together(CurveNeighborhood& near, const Attempt& attempt, double snap) {
  if (near.handles.empty()) return;
  const Surface& s = near.surface;
  const std::vector<Curve> curves = find_curves(near.cut());
  std::vector<Role> role(curves.size(), Role::other);
  std::vector<Pair> pairs;
  for (std::size_t c = 0; c < curves.size(); ++c)
    if (has_handle(s, curves[c], near.handles)) {
      role[c] = Role::moves;
      pairs.push_back({curves[c].a, curves[c].b});
    }
  std::sort(pairs.begin(), pairs.end());
  for (std::size_t c = 0; c < curves.size(); ++c)
    if (role[c] == Role::other &&
        std::binary_search(pairs.begin(), pairs.end(), Pair(curves[c].a, curves[c].b)))
      role[c] = Role::stays;
  const PartTopologies before =
      topology_of_parts_in(near, near.cut().connectivity(), s.face.get<int>("part"));
  near.handles.clear();
  while (std::find(role.begin(), role.end(), Role::moves) != role.end()) {
    const std::vector<Fault> faults = try_straighten(near, before, curves, role, attempt, snap);
    if (faults.empty()) break;
    for (auto [c, again] : faults) {
      role[c] = Role::stays;
      if (again) near.handles.push_back(handle_of(s, curves[c]));
    }
  }
  std::sort(near.handles.begin(), near.handles.end());
}

/// Straightens curves, those near each other together, with one attempt after another for those still at
/// fault.
void straighten_curves(const CutSurface& cut, const std::vector<Curve>& curves,
                       std::span<const Attempt> tries, double snap, int max_faces) {
  if (curves.empty()) return;
  std::vector<CurveNeighborhood> sets = take_curve_neighborhoods(cut, curves, rings, max_faces);
  parallel_for((int)sets.size(), [&](int i) {
    for (const Attempt& attempt : tries) straighten_together(sets[i], attempt, snap);
  });
  for (CurveNeighborhood& s : sets) put_back(std::move(s), cut);
}

/// Triangles with two edges on an interface with one other part change to that, unless along creases: the
/// interface takes the third edge. Neither part's topology changes.
void trim_ears(const CutSurface& cut, int n_parts, int max_faces) {
  Surface& s = cut.surface;
  const std::vector<int>& opposite = cut.opposite;
  std::vector<int>& part = s.face.get<int>("part");
  std::vector<int> faces(n_parts, 0);
  for (int p : part) ++faces[p];
  const Connectivity view = cut.connectivity();
  auto other = [&](int h) { return opposite[h] < 0 ? -1 : part[opposite[h] / 3]; };
  // h leaves the apex, where all other triangles are the other part's
  auto is_ear = [&](int h) {
    const int mine = part[h / 3], theirs = other(h);
    if (theirs < 0 || theirs == mine || other(prev(h)) != theirs || other(next(h)) != mine) return false;
    if (max_faces > 0 && faces[theirs] >= max_faces) return false;
    if (is_crease(view, h) || is_crease(view, prev(h))) return false;
    int g = opposite[prev(h)];
    while (g >= 0 && g != h && part[g / 3] == theirs) g = opposite[prev(g)];
    return g == h;
  };
  std::vector<int> ears;
  for (int h = 0; h < (int)opposite.size(); ++h)
    if (is_ear(h)) ears.push_back(h);
  while (!ears.empty()) {
    const int h = take_last(ears);
    if (!is_ear(h)) continue;
    --faces[part[h / 3]];
    ++faces[other(h)];
    part[h / 3] = other(h);
    const int behind = opposite[next(h)];
    for (int g : {behind, next(behind), prev(behind)})
      if (is_ear(g)) ears.push_back(g);
  }
}

/// Straightens what is still bent, one curve at a time: on fans of large triangles the bands of neighbors may
/// have left no triangles to move in.
void straighten_corners(const CutSurface& cut, double snap, int max_faces) {
  const Surface& surface = cut.surface;
  constexpr double bent = 0.5;
  constexpr std::size_t most_work = 2000000;  // triangles: each curve costs a pass over all
  std::vector<std::pair<double, Handle>> corners;
  auto crease = [&](int h) { return is_crease(cut.connectivity(), h); };
  for (const Curve& c : find_curves(cut))
    if (const double turn = sharpest_turn(cut, c, crease); turn > bent)
      corners.push_back({-turn, handle_of(surface, c)});
  std::sort(corners.begin(), corners.end());
  corners.resize(std::min(corners.size(), most_work / (surface.tris.size() + 1)));
  for (const std::pair<double, Handle>& corner : corners) {
    std::vector<Curve> curves = find_curves(cut);
    std::erase_if(curves, [&](const Curve& c) { return !has_handle(surface, c, {corner.second}); });
    straighten_curves(cut, curves, std::span(attempts).subspan(2), snap, max_faces);
  }
}

}  // namespace

void straighten_interfaces(const CutSurface& cut, int n_parts, double snap, int max_faces) {
  name_origins(cut.surface);
  const std::map<Pair, int> colors = color_pairs(cut.surface, find_curves(cut));
  constexpr double straight = 0.05;  // as a closed shortest line is
  const Surface& surface = cut.surface;
  auto model = [&](int h) { return cut.connectivity().is_model(h); };
  int n_colors = 0;
  for (const auto& [pair, color] : colors) n_colors = std::max(n_colors, color + 1);
  for (int color = 0; color < n_colors; ++color) {
    std::vector<Curve> open = find_curves(cut);
    std::erase_if(open, [&](const Curve& c) {
      const auto found = colors.find({c.a, c.b});
      return found == colors.end() || found->second != color ||
             std::all_of(c.half_edges.begin(), c.half_edges.end(), model) ||
             (is_closed(surface, c) && sharpest_turn(cut, c, model) < straight);
    });
    straighten_curves(cut, open, attempts, snap, max_faces);
    add_progress(0.2 / n_colors);
  }
  trim_ears(cut, n_parts, max_faces);
  straighten_corners(cut, snap, max_faces);
}

}  // namespace meshpipe
