// SPDX-License-Identifier: BSD-3-Clause
// Moving vertices: a Newton step on the energy of the star, walked to on the reference.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "lib/relaxer.h"

namespace meshpipe {
namespace {
constexpr double size_weight = 0.012;
constexpr double no_step = 3e-3;  ///< a step below this share of the size is none
// over-relaxation: what is uneven over many edges evens out sooner
constexpr double beyond = 1.5, beyond_along = 1.3;
constexpr double longest_on_line = 1.2;  ///< segment, over the size, that moving makes
constexpr int worth_threads = 800;       ///< vertices of a colour
}  // namespace

void Star::look(Vec3 p) {
  for (int i = 0; i < n; ++i) {
    const double ux = y[0][i] - p.x, uy = y[1][i] - p.y, uz = y[2][i] - p.z;
    const double vx = z[0][i] - p.x, vy = z[1][i] - p.y, vz = z[2][i] - p.z;
    normal[0][i] = uy * vz - uz * vy;
    normal[1][i] = uz * vx - ux * vz;
    normal[2][i] = ux * vy - uy * vx;
  }
}

/// Sum over the triangles of q^2 + w (s + 1/s), s the square of the area over the target's; without a root,
/// so that only one division a triangle is left.
double Star::energy(Vec3 p, double size) {
  look(p);
  const double a2 = 0.75 * size * size * size * size;  // (twice the target area)^2
  const double squeezed = size_weight * a2, stretched = size_weight / a2;
  double each[most];
  for (int i = 0; i < n; ++i) {
    const double ux = y[0][i] - p.x, uy = y[1][i] - p.y, uz = y[2][i] - p.z;
    const double vx = z[0][i] - p.x, vy = z[1][i] - p.y, vz = z[2][i] - p.z;
    const double wx = vx - ux, wy = vy - uy, wz = vz - uz;
    const double squares =
        ux * ux + uy * uy + uz * uz + vx * vx + vy * vy + vz * vz + wx * wx + wy * wy + wz * wz;
    const double n2 = normal[0][i] * normal[0][i] + normal[1][i] * normal[1][i] + normal[2][i] * normal[2][i];
    const double e = (squares * squares / 12 + squeezed) / n2 + stretched * n2;
    each[i] = n2 > 0 ? e : 1e30;
  }
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += each[i];
  return sum;
}

bool Star::unfolded(Vec3 f) const {
  double room[most];
  for (int i = 0; i < n; ++i) {
    const double fx = f.x + facing[0][i], fy = f.y + facing[1][i], fz = f.z + facing[2][i];
    const double n2 = normal[0][i] * normal[0][i] + normal[1][i] * normal[1][i] + normal[2][i] * normal[2][i];
    const double along = normal[0][i] * fx + normal[1][i] * fy + normal[2][i] * fz;
    room[i] =
        along * std::abs(along) - least_agreement * least_agreement * n2 * (fx * fx + fy * fy + fz * fz);
  }
  bool all = true;
  for (int i = 0; i < n; ++i) all &= room[i] >= 0;
  return all;
}

double Star::agreement(Vec3 p, Vec3 facing_p) const {
  double least = 1;
  for (int i = 0; i < n; ++i)
    least = std::min(least, meshpipe::agreement(p, {y[0][i], y[1][i], y[2][i]}, {z[0][i], z[1][i], z[2][i]},
                                                facing_p + Vec3{facing[0][i], facing[1][i], facing[2][i]}));
  return least;
}

/// False for a star too large to be worth it.
bool Relaxer::gather(int v, Star& star) const {
  star.n = 0;
  if (m_.valence(v) > Star::most) return false;
  m_.star(v, [&](int h) {
    const int i = star.n++, a = m_.to(h), b = m_.apex(h);
    const Vec3 &y = points_[a], &z = points_[b], f = facing_[a] + facing_[b];
    star.y[0][i] = y.x, star.y[1][i] = y.y, star.y[2][i] = y.z;
    star.z[0][i] = z.x, star.z[1][i] = z.y, star.z[2][i] = z.z;
    star.facing[0][i] = f.x, star.facing[1][i] = f.y, star.facing[2][i] = f.z;
  });
  return true;
}

/// For a vertex on a border or model edge, which slides along it: a parabola through three energies.
bool Relaxer::slide(int v) {
  Star star;
  if (!gather(v, star)) return false;
  Vec3 ahead{}, behind{};
  m_.star(v, [&](int e) {
    if (m_.hard[e]) ahead = at(m_.to(e));
    if (m_.hard[prev(e)]) behind = at(m_.from(prev(e)));
  });
  const Vec3 x = at(v);
  const double size = size_at(v), reach = std::min(norm(ahead - x), norm(behind - x)), probe = 0.1 * reach;
  const Vec3 direction = normalized(ahead - behind);
  if (reach <= 0) return false;
  auto place_at = [&](double s) { return ground_->walk.slide(lifted_.place[v], x + s * direction); };
  auto energy = [&](double s) { return star.energy(ground_->walk.point(place_at(s)), size); };
  const double now = star.energy(x, size), left = energy(-probe), right = energy(probe);
  const double bend = left - 2 * now + right;
  double s = bend > 0 ? 0.5 * probe * (left - right) / bend : left < right ? -2 * probe : 2 * probe;
  s = std::clamp(beyond_along * s, -0.4 * reach, 0.4 * reach);
  if (!(std::abs(s) >= no_step * size)) return false;
  const Place place = place_at(s);
  const Vec3 p = ground_->walk.point(place), facing = facing_on_line(v, place);
  if (star.energy(p, size) > now * (1 - 1e-4)) return false;
  // a long segment of a line is far off a bend
  for (const Vec3& end : {ahead, behind})
    if (norm(end - p) > std::max(longest_on_line * size, norm(end - x))) return false;
  if (!star.unfolded(facing) && folds(star.agreement(x, facing_[v]), star.agreement(p, facing))) return false;
  put(v, place, p, facing);
  return true;
}

/// One Newton step on the star's energy along the tangent plane, walked to on the reference and kept only if
/// the energy falls.
bool Relaxer::move(int v) {
  Star star;
  if (!gather(v, star)) return false;
  const Vec3 x = at(v);
  star.look(x);
  Vec3 n{};
  for (int i = 0; i < star.n; ++i) n = n + Vec3{star.normal[0][i], star.normal[1][i], star.normal[2][i]};
  n = normalized(n);
  const Vec3 s = normalized(std::abs(n.x) < 0.6 ? cross(n, {1, 0, 0}) : cross(n, {0, 1, 0})), t = cross(n, s);
  const double size = size_at(v), l0 = sqrt3 / 2 * size * size;  // twice the target area
  const double squeezed = size_weight * l0 * l0, stretched = size_weight / (l0 * l0);
  // The square of twice the area, A, and the sum of the squared sides, S, are quadratic in the vertex's
  // position, A'' = 2 (e x s) (e x t) with the opposite side e, S'' = 4 I; the energy is Q / A + w A / l0^2
  // with Q = S^2 / 12 + w l0^2.
  double energy[Star::most], gx[Star::most], gy[Star::most], xx[Star::most], xy[Star::most], yy[Star::most],
      up[Star::most];
  for (int i = 0; i < star.n; ++i) {
    const double ux = star.y[0][i] - x.x, uy = star.y[1][i] - x.y, uz = star.y[2][i] - x.z;
    const double vx = star.z[0][i] - x.x, vy = star.z[1][i] - x.y, vz = star.z[2][i] - x.z;
    const double nx = star.normal[0][i], ny = star.normal[1][i], nz = star.normal[2][i];
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
  double now = 0, hxx = 0, hxy = 0, hyy = 0;
  Vec2 gradient{};
  bool flat = true;
  for (int i = 0; i < star.n; ++i) {
    now += energy[i];
    gradient = gradient + Vec2{gx[i], gy[i]};
    hxx += xx[i], hxy += xy[i], hyy += yy[i];
    flat &= up[i] > 1e-3 * l0;
  }
  Vec2 step;
  const double det = hxx * hyy - hxy * hxy;
  if (flat && det > 1e-12 * hxx * hyy && hxx > 0) {
    step = (-1 / det) * Vec2{hyy * gradient.x - hxy * gradient.y, hxx * gradient.y - hxy * gradient.x};
  } else {
    // a star with folded triangles: towards its centre
    Vec3 centre{};
    for (int i = 0; i < star.n; ++i) centre = centre + (Vec3{star.y[0][i], star.y[1][i], star.y[2][i]} - x);
    centre = (1.0 / star.n) * centre;
    step = {dot(centre, s), dot(centre, t)};
    now = star.energy(x, size);
  }
  const double length = norm(step);
  if (length < no_step * size) return false;
  step = std::min(beyond, 0.5 * size / length) * step;
  for (int halving = 0; halving < 3; ++halving, step = 0.5 * step) {
    const Place place = ground_->walk.closest(lifted_.place[v], x + step.x * s + step.y * t);
    const Vec3 p = ground_->walk.point(place);
    if (star.energy(p, size) >= now) continue;
    const Vec3 facing = facing_at(place);
    if (!star.unfolded(facing) && folds(star.agreement(x, facing_[v]), star.agreement(p, facing))) continue;
    put(v, place, p, facing);
    return true;
  }
  return false;
}

/// Is v held, or has nothing changed in its star since it was last tried?
bool Relaxer::settled(int v) const {
  if (held_[v] >= fixed) return true;
  if (tried_[v] <= changed_[v]) return false;
  bool quiet = true;
  m_.neighbours(v, [&](int w) { quiet &= changed_[w] < tried_[v]; });
  return quiet;
}

/// Moves v unless it is held or nothing round it has changed.
bool Relaxer::improve(int v) {
  if (m_.out[v] < 0 || settled(v)) return false;
  tried_[v] = ++clock_;
  const bool moved = held_[v] == slides ? slide(v) : move(v);
  if (moved) touch(v), ++report_.moves;
  return moved;
}

/// The first colour that no neighbour of v has; none if it has too many.
signed char Relaxer::free_color(int v) const {
  std::uint64_t taken = 0;
  m_.neighbours(v, [&](int w) {
    if (color_[w] >= 0) taken |= std::uint64_t(1) << color_[w];
  });
  for (int c = 0; c < 63; ++c)
    if (!(taken >> c & 1)) return (signed char)c;
  return -1;
}

/// To be called for every vertex whose neighbours are others than before.
void Relaxer::edited(int v) {
  touch(v);
  edited_[v] = clock_;
  bool clash = color_[v] < 0;
  m_.neighbours(v, [&](int w) { clash |= color_[w] == color_[v]; });
  if (clash) color_[v] = free_color(v);
  listed_ = false;
}

/// The vertices that may move, by colour.
void Relaxer::list_by_color() {
  const int n = (int)m_.out.size();
  auto moves = [&](int v) { return m_.out[v] >= 0 && held_[v] < fixed && color_[v] >= 0; };
  color_start_.assign(65, 0);
  for (int v = 0; v < n; ++v)
    if (moves(v)) ++color_start_[color_[v] + 1];
  std::partial_sum(color_start_.begin(), color_start_.end(), color_start_.begin());
  std::vector<int> next(color_start_.begin(), color_start_.end() - 1);
  by_color_.resize(color_start_.back());
  for (int v = 0; v < n; ++v)
    if (moves(v)) by_color_[next[color_[v]]++] = v;
  listed_ = true;
}

/// One of a colour: moves it unless it is held or nothing round it has changed since.
bool Relaxer::advance(int v, int now) {
  if (settled(v)) return false;
  tried_[v] = now;
  if (!(held_[v] == slides ? slide(v) : move(v))) return false;
  changed_[v] = now;
  return true;
}

/// Every vertex once a sweep, colour by colour: the vertices of a colour do not see each other, so that they
/// can move at the same time and the result does not depend on who comes first.
void Relaxer::smooth(int sweeps) {
  if (!listed_) list_by_color();
  for (int i = 0; i < sweeps; ++i) {
    int moves = 0;
    for (int c = 0; c < 64 && color_start_[c] < color_start_[64]; ++c) {
      const int now = ++clock_, first = color_start_[c], last = color_start_[c + 1];
      if (last - first > worth_threads) {
#pragma omp parallel for schedule(static) reduction(+ : moves)
        for (int k = first; k < last; ++k) moves += advance(by_color_[k], now);
      } else {  // not even a team of one: patches of a hundred triangles are smoothed hundreds of times
        for (int k = first; k < last; ++k) moves += advance(by_color_[k], now);
      }
    }
    report_.moves += moves;
  }
}

}  // namespace meshpipe
