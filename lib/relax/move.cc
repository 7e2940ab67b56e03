// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <span>

#include "lib/relax/junctions.h"
#include "lib/relax/operations.h"

namespace meshpipe {
namespace {

constexpr double sqrt3 = 1.7320508075688772;

/// What the energy of a vertex depends on, gathered: its triangles (p, y[i], z[i]). By coordinates, so that
/// the compiler takes several triangles at a time.
struct Star {
  static constexpr int most = rules::largest_star;
  int n = 0;
  double y[3][most], z[3][most];
  double normal[3][most];  ///< sum of the reference normals at the two other corners
  double area[3][most];    ///< area vectors of the triangles with the last p
  void look(Vec3 p);
  double energy(Vec3 p, double size);
  double energy_on_line(Vec3 p, double size);
  /// Are all normal deviations at p, whose reference normal is `normal_p`, certainly within the limit?
  /// Without roots and branches: it is asked of every move.
  bool upright(Vec3 p, Vec3 normal_p) const;
  /// The least cosine of the normal deviations.
  double worst_cosine(Vec3 p, Vec3 normal_p) const;
};

void Star::look(Vec3 p) {
  for (int i = 0; i < n; ++i) {
    const double ux = y[0][i] - p.x, uy = y[1][i] - p.y, uz = y[2][i] - p.z;
    const double vx = z[0][i] - p.x, vy = z[1][i] - p.y, vz = z[2][i] - p.z;
    area[0][i] = uy * vz - uz * vy;
    area[1][i] = uz * vx - ux * vz;
    area[2][i] = ux * vy - uy * vx;
  }
}

/// Sum over the triangles of q^2 + w (s + 1/s), s the square of the area over the target's; without a root,
/// so that only one division a triangle is left.
double Star::energy(Vec3 p, double size) {
  look(p);
  const double a2 = 0.75 * size * size * size * size;  // (twice the target area)^2
  const double squeezed = rules::size_weight * a2, stretched = rules::size_weight / a2;
  double each[most];
  for (int i = 0; i < n; ++i) {
    const double ux = y[0][i] - p.x, uy = y[1][i] - p.y, uz = y[2][i] - p.z;
    const double vx = z[0][i] - p.x, vy = z[1][i] - p.y, vz = z[2][i] - p.z;
    const double wx = vx - ux, wy = vy - uy, wz = vz - uz;
    const double squares =
        ux * ux + uy * uy + uz * uz + vx * vx + vy * vy + vz * vz + wx * wx + wy * wy + wz * wz;
    const double n2 = area[0][i] * area[0][i] + area[1][i] * area[1][i] + area[2][i] * area[2][i];
    const double e = (squares * squares / 12 + squeezed) / n2 + stretched * n2;
    each[i] = std::min(e, 1e30);
  }
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += each[i];
  return sum;
}

/// The same and a share of 1 / kappa^2 for each triangle. In a strip narrower than its segments are long, the
/// energy is least where vertices are opposite to the middle of a segment, but kappa is best where they are
/// opposite to each other: the two lines become divided alike.
double Star::energy_on_line(Vec3 p, double size) {
  double sum = energy(p, size);
  for (int i = 0; i < n; ++i) {
    const double q = kappa(p, {y[0][i], y[1][i], y[2][i]}, {z[0][i], z[1][i], z[2][i]});
    sum += q > 0 ? rules::strip_weight / (q * q) : 1e30;
  }
  return sum;
}

bool Star::upright(Vec3 p, Vec3 normal_p) const {
  constexpr double least = rules::least_cosine * rules::least_cosine * (1 + 1e-9);
  double lack[most];
  for (int i = 0; i < n; ++i) {
    const double ux = y[0][i] - p.x, uy = y[1][i] - p.y, uz = y[2][i] - p.z;
    const double vx = z[0][i] - p.x, vy = z[1][i] - p.y, vz = z[2][i] - p.z;
    const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    const double rx = normal_p.x + normal[0][i], ry = normal_p.y + normal[1][i],
                 rz = normal_p.z + normal[2][i];
    const double d = nx * rx + ny * ry + nz * rz;
    lack[i] = least * (nx * nx + ny * ny + nz * nz) * (rx * rx + ry * ry + rz * rz) - d * std::abs(d);
  }
  return std::all_of(lack, lack + n, [](double l) { return l <= 0; });
}

double Star::worst_cosine(Vec3 p, Vec3 normal_p) const {
  double least = 1;
  for (int i = 0; i < n; ++i)
    least = std::min(least, normal_cosine(p, {y[0][i], y[1][i], y[2][i]}, {z[0][i], z[1][i], z[2][i]},
                                          normal_p + Vec3{normal[0][i], normal[1][i], normal[2][i]}));
  return least;
}

/// Adds the triangles of v. False if there are too many to be worth it.
bool gather(const State& s, int v, Star& star) {
  if (star.n + s.mesh.valence(v) > Star::most) return false;
  s.mesh.star(v, [&](int h) {
    const int i = star.n++, a = s.mesh.to(h), b = s.mesh.apex(h);
    const Vec3 &y = s.points[a], &z = s.points[b], f = s.normal[a] + s.normal[b];
    star.y[0][i] = y.x, star.y[1][i] = y.y, star.y[2][i] = y.z;
    star.z[0][i] = z.x, star.z[1][i] = z.y, star.z[2][i] = z.z;
    star.normal[0][i] = f.x, star.normal[1][i] = f.y, star.normal[2][i] = f.z;
  });
  return true;
}

/// Does a move of v from x to p, where the reference normal is `normal`, fold its star?
bool folds_star(const State& s, const Star& star, int v, Vec3 x, Vec3 p, Vec3 normal) {
  if (star.upright(p, normal)) return false;
  const double after = star.worst_cosine(p, normal);
  return after < rules::least_cosine && folds(star.worst_cosine(x, s.normal[v]), after);
}

/// The energy of a star, and its derivatives by steps along two unit vectors.
struct Derivatives {
  double energy = 0;
  Vec2 gradient{};
  double xx = 0, xy = 0, yy = 0;
  bool flat = true;  ///< is no triangle folded or almost degenerate?
};

/// Derivatives at x by steps along s and t, for normal n. The square of twice the area, A, and the sum of the
/// squared sides, S, are quadratic in the vertex's position, A'' = 2 (e x s) (e x t) with the opposite side
/// e, S'' = 4 I; the energy is Q / A + w A / l0^2 with Q = S^2 / 12 + w l0^2, l0 twice the target area.
Derivatives derivatives(const Star& star, Vec3 x, Vec3 n, Vec3 s, Vec3 t, double l0) {
  const double squeezed = rules::size_weight * l0 * l0, stretched = rules::size_weight / (l0 * l0);
  double energy[Star::most], gx[Star::most], gy[Star::most], xx[Star::most], xy[Star::most], yy[Star::most],
      up[Star::most];
  for (int i = 0; i < star.n; ++i) {
    const double ux = star.y[0][i] - x.x, uy = star.y[1][i] - x.y, uz = star.y[2][i] - x.z;
    const double vx = star.z[0][i] - x.x, vy = star.z[1][i] - x.y, vz = star.z[2][i] - x.z;
    const double nx = star.area[0][i], ny = star.area[1][i], nz = star.area[2][i];
    const double ex = vx - ux, ey = vy - uy, ez = vz - uz, mx = ux + vx, my = uy + vy, mz = uz + vz;
    const double S = ux * ux + uy * uy + uz * uz + vx * vx + vy * vy + vz * vz + ex * ex + ey * ey + ez * ez;
    const double A = nx * nx + ny * ny + nz * nz, u = 1 / A, Q = S * S / 12 + squeezed;
    const double sx = ey * s.z - ez * s.y, sy = ez * s.x - ex * s.z, sz = ex * s.y - ey * s.x;
    const double tx = ey * t.z - ez * t.y, ty = ez * t.x - ex * t.z, tz = ex * t.y - ey * t.x;
    const double Ss = -2 * (mx * s.x + my * s.y + mz * s.z), St = -2 * (mx * t.x + my * t.y + mz * t.z);
    const double As = 2 * (nx * sx + ny * sy + nz * sz), At = 2 * (nx * tx + ny * ty + nz * tz);
    const double q = S * u / 6, a = stretched - Q * u * u, qa = -q * u, aa = 2 * Q * u * u * u;
    up[i] = nx * n.x + ny * n.y + nz * n.z;
    energy[i] = Q * u + stretched * A;
    gx[i] = q * Ss + a * As;
    gy[i] = q * St + a * At;
    xx[i] = u / 6 * Ss * Ss + 4 * q + 2 * qa * Ss * As + aa * As * As + 2 * a * (sx * sx + sy * sy + sz * sz);
    yy[i] = u / 6 * St * St + 4 * q + 2 * qa * St * At + aa * At * At + 2 * a * (tx * tx + ty * ty + tz * tz);
    xy[i] = u / 6 * Ss * St + qa * (Ss * At + St * As) + aa * As * At + 2 * a * (sx * tx + sy * ty + sz * tz);
  }
  Derivatives d;
  for (int i = 0; i < star.n; ++i) {
    d.energy += energy[i];
    d.gradient = d.gradient + Vec2{gx[i], gy[i]};
    d.xx += xx[i], d.xy += xy[i], d.yy += yy[i];
    d.flat &= up[i] > rules::flat * l0;
  }
  return d;
}

/// Is v held, or has nothing changed in its star since it was last tried?
bool settled(const State& s, int v) {
  if (s.hold[v] >= fixed) return true;
  const std::vector<int>&tried = s.clocks.tried, &changed = s.clocks.changed;
  bool quiet = true;
  for_copies(s, v, [&](int c) {
    quiet &= tried[c] > changed[c];
    if (quiet) s.mesh.neighbors(c, [&](int w) { quiet &= changed[w] < tried[c]; });
  });
  return quiet;
}

/// Moves v at time `now` unless it is settled.
bool advance(State& s, int v, int now) {
  if (settled(s, v)) return false;
  for_copies(s, v, [&](int c) { s.clocks.tried[c] = now; });
  return s.hold[v] == slides ? slide_vertex(s, v) : move_vertex(s, v);
}

/// Lists the vertices that may move by themselves, by the level of the blocks that have their neighbors.
void list_by_level(State& s) {
  const int n = (int)s.mesh.out.size();
  auto moves = [&](int v) { return s.mesh.out[v] >= 0 && s.hold[v] < fixed && !is_shared(s, v); };
  auto level = [&](int v) {
    return std::max(0, s.schedule.span[v] - rules::block_bits + rules::level_bits - 1) / rules::level_bits;
  };
  s.schedule.order = lists_of(1 + 32 / rules::level_bits, [&](auto use) {
    for (int v = 0; v < n; ++v)
      if (moves(v)) use(level(v), v);
  });
  s.schedule.listed = true;
}

/// Moves vertices of one level: the blocks of 2^bits in parallel, each in order. Returns how many moved.
int smooth_level(State& s, std::span<const int> vertices, int bits) {
  if (vertices.empty()) return 0;
  // times within a block are in order, and those of other blocks do not matter to it
  const bool worth_threads = (int)vertices.size() > rules::vertices_worth_threads;
  const int before = s.clocks.now, all = (int)vertices.size();
  s.clocks.now += worth_threads ? (int)std::min<std::int64_t>(all, std::int64_t(1) << bits) : all;
  auto run = [&](auto first, auto last) {
    int moves = 0, now = before;
    for (auto v = first; v != last; ++v) {
      ++now;
      if (!advance(s, *v, now)) continue;
      s.clocks.changed[*v] = now;
      ++moves;
    }
    return moves;
  };
  // not even a team of one: patches of a hundred triangles are smoothed hundreds of times
  if (!worth_threads) return run(vertices.begin(), vertices.end());
  const int first = vertices.front() >> bits, last = vertices.back() >> bits;
  int moves = 0;
#pragma omp parallel for schedule(dynamic) reduction(+ : moves)
  for (int block = first; block <= last; ++block) {
    auto start = [&](int b) {
      return std::lower_bound(vertices.begin(), vertices.end(), std::int64_t(b) << bits);
    };
    moves += run(start(block), start(block + 1));
  }
  return moves;
}

/// Moves vertices with copies, one after the other: they are few. Returns how many moved.
int slide_shared(State& s) {
  int moves = 0;
  for (int v = 0; v < (int)s.copy.size(); ++v) {
    if (!is_shared(s, v) || s.mesh.out[v] < 0 || s.hold[v] != slides) continue;
    bool first = true;
    for_copies(s, v, [&](int c) { first &= c >= v; });
    const int now = ++s.clocks.now;
    if (!first || !advance(s, v, now)) continue;
    for_copies(s, v, [&](int c) { s.clocks.changed[c] = now; });
    ++moves;
  }
  return moves;
}

/// Returns where v and its copies are when v is at `place`, at p; none if a star folds or copies part.
std::vector<CopyPlace> places_at(const State& s, int v, const Place& place, Vec3 p) {
  std::vector<CopyPlace> places = copies_at(s, v, place, p);
  for (const CopyPlace& c : places) {
    Star star;
    if (!gather(s, c.at, star) || folds_star(s, star, c.at, s.points[c.at], p, c.normal)) return {};
  }
  return places;
}

}  // namespace

bool slide_vertex(State& s, int v) {
  Star star;
  bool small = true;
  for_copies(s, v, [&](int c) { small = small && gather(s, c, star); });
  if (!small) return false;
  Vec3 ahead{}, behind{};
  s.mesh.star(v, [&](int e) {
    if (s.mesh.hard[e]) ahead = s.points[s.mesh.to(e)];
    if (s.mesh.hard[prev(e)]) behind = s.points[s.mesh.from(prev(e))];
  });
  const SurfaceWalk& walk = s.reference->walk;
  const Vec3 x = s.points[v], direction = normalized(ahead - behind);
  const double size = s.target(v), reach = std::min(norm(ahead - x), norm(behind - x)),
               probe = rules::probe * reach;
  if (reach <= 0) return false;
  auto place_at = [&](double step) { return walk.slide(s.place[v], x + step * direction); };
  auto energy = [&](double step) { return star.energy_on_line(walk.point(place_at(step)), size); };
  const double now = star.energy_on_line(x, size), left = energy(-probe), right = energy(probe);
  const double bend = left - 2 * now + right;
  double step = bend > 0 ? 0.5 * probe * (left - right) / bend : left < right ? -2 * probe : 2 * probe;
  step = std::clamp(rules::line_relaxation * step, -rules::reach * reach, rules::reach * reach);
  if (!(std::abs(step) >= rules::shortest_step * size)) return false;
  const Place place = place_at(step);
  const Vec3 p = walk.point(place);
  if (star.energy_on_line(p, size) > now * (1 - rules::least_gain)) return false;
  auto sag = [&](const Place& from, Vec3 q, Vec3 end) {  // of the segment from q, which is at `from`
    const Vec3 middle = lerp(end, q, 0.5);
    return norm(walk.point(walk.slide(from, middle)) - middle);
  };
  for (const Vec3& end : {ahead, behind}) {
    if (norm(end - p) <= norm(end - x)) continue;
    const double sags = sag(place, p, end);
    if (norm(end - p) > rules::longest_segment * size) {
      if (sags > rules::straight * size) return false;
    } else if (sags > rules::line_deviation * size &&
               sags > std::max(sag(s.place[v], x, ahead), sag(s.place[v], x, behind))) {
      return false;
    }
  }
  const std::vector<CopyPlace> places = places_at(s, v, place, p);
  for (const CopyPlace& c : places) put(s, c.at, c.place, p, c.normal);
  return !places.empty();
}

bool move_vertex(State& state, int v) {
  Star star;
  if (!gather(state, v, star)) return false;
  const SurfaceWalk& walk = state.reference->walk;
  const Vec3 x = state.points[v];
  star.look(x);
  Vec3 n{};
  for (int i = 0; i < star.n; ++i) n = n + Vec3{star.area[0][i], star.area[1][i], star.area[2][i]};
  n = normalized(n);
  const Vec3 s = normalized(std::abs(n.x) < 0.6 ? cross(n, {1, 0, 0}) : cross(n, {0, 1, 0})), t = cross(n, s);
  const double size = state.target(v);
  const Derivatives d = derivatives(star, x, n, s, t, sqrt3 / 2 * size * size);
  double now = d.energy;
  Vec2 step;
  const double det = d.xx * d.yy - d.xy * d.xy;
  if (d.flat && det > 1e-12 * d.xx * d.yy && d.xx > 0) {
    step = (-1 / det) *
           Vec2{d.yy * d.gradient.x - d.xy * d.gradient.y, d.xx * d.gradient.y - d.xy * d.gradient.x};
  } else {
    // a star with folded triangles: towards its center
    Vec3 center{};
    for (int i = 0; i < star.n; ++i) center = center + (Vec3{star.y[0][i], star.y[1][i], star.y[2][i]} - x);
    center = (1.0 / star.n) * center;
    step = {dot(center, s), dot(center, t)};
    now = star.energy(x, size);
  }
  const double length = norm(step);
  if (length < rules::shortest_step * size) return false;
  step = std::min(rules::overrelaxation, rules::longest_step * size / length) * step;
  for (int halving = 0; halving < rules::halvings; ++halving, step = 0.5 * step) {
    const Place place = walk.closest(state.place[v], x + step.x * s + step.y * t);
    const Vec3 p = walk.point(place);
    if (star.energy(p, size) >= now) continue;
    const Vec3 normal = state.reference->normal(place);
    if (folds_star(state, star, v, x, p, normal)) continue;
    put(state, v, place, p, normal);
    return true;
  }
  return false;
}

bool improve_vertex(State& s, int v) {
  if (s.mesh.out[v] < 0 || !advance(s, v, ++s.clocks.now)) return false;
  for_copies(s, v, [&](int c) { mark_changed(s, c); });
  ++s.counts.moves;
  return true;
}

void smooth(State& s, int sweeps) {
  if (!s.schedule.listed) list_by_level(s);
  const Lists& order = s.schedule.order;
  for (int i = 0; i < sweeps; ++i) {
    int moves = 0;
    for (int level = 0; level + 1 < (int)order.start.size(); ++level)
      moves += smooth_level(s, order[level], std::min(31, rules::block_bits + rules::level_bits * level));
    s.counts.moves += moves + slide_shared(s);
  }
}

}  // namespace meshpipe
