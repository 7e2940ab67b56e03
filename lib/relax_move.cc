// SPDX-License-Identifier: BSD-3-Clause
// Moving vertices: a Newton step on the energy of the star, walked to on the reference.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "lib/relaxer.h"

namespace meshpipe {
namespace {
constexpr double size_weight = 0.012;
constexpr double no_step = 3e-3;     ///< a step below this share of the size is none
constexpr int worth_threads = 2000;  ///< vertices of a colour
}  // namespace

/// Sum over the triangles of q^2 + w (s + 1/s), s the square of the area over the target's; without a root,
/// so that only one division a triangle is left.
double Star::energy(Vec3 p, double size) const {
  double sum = 0;
  const double a2 = 0.75 * size * size * size * size;  // (twice the target area)^2
  for (int i = 0; i < n; ++i) {
    const Vec3 u = y[i] - p, v = z[i] - p, w = v - u, normal = cross(u, v);
    const double n2 = dot(normal, normal), squares = dot(u, u) + dot(v, v) + dot(w, w);
    sum += n2 > 0 ? (squares * squares / 12 + size_weight * a2) / n2 + size_weight * n2 / a2 : 1e30;
  }
  return sum;
}

double Star::agreement(Vec3 p, Vec3 normal) const {
  double least = 1;
  for (int i = 0; i < n; ++i) least = std::min(least, meshpipe::agreement(p, y[i], z[i], normal + facing[i]));
  return least;
}

/// False for a star too large to be worth it.
bool Relaxer::gather(int v, Star& star) const {
  star.n = 0;
  if (m_.valence(v) > Star::most) return false;
  m_.star(v, [&](int h) {
    const int a = m_.to(h), b = m_.apex(h);
    star.y[star.n] = at(a), star.z[star.n] = at(b), star.facing[star.n] = facing_[a] + facing_[b];
    ++star.n;
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
  s = std::clamp(s, -0.4 * reach, 0.4 * reach);
  if (!(std::abs(s) >= no_step * size)) return false;
  const Place place = place_at(s);
  const Vec3 p = ground_->walk.point(place), facing = facing_on_line(v, place);
  if (star.energy(p, size) > now * (1 - 1e-4) ||
      folds(star.agreement(x, facing_[v]), star.agreement(p, facing)))
    return false;
  put(v, place, p, facing);
  return true;
}

/// One Newton step on the star's energy in the tangent plane, walked to on the reference and kept only if the
/// energy in space falls.
bool Relaxer::move(int v) {
  Star star;
  if (!gather(v, star)) return false;
  const Vec3 x = at(v);
  Vec3 n{};
  for (int i = 0; i < star.n; ++i) n = n + area_vector(x, star.y[i], star.z[i]);
  n = normalized(n);
  const Vec3 s = normalized(std::abs(n.x) < 0.6 ? cross(n, {1, 0, 0}) : cross(n, {0, 1, 0})), t = cross(n, s);
  const double size = size_at(v), l0 = sqrt3 / 2 * size * size;  // twice the target area
  Vec2 gradient{};
  double hxx = 0, hxy = 0, hyy = 0;
  bool flat = true;
  for (int i = 0; i < star.n; ++i) {
    const Vec3 py = star.y[i] - x, pz = star.z[i] - x;
    const Vec2 y{dot(py, s), dot(py, t)}, z{dot(pz, s), dot(pz, t)};
    // Twice the area, L, is linear in the vertex's position and S, the sum of the squared sides, quadratic
    // with S'' = 4 I; the energy is (S^2 / 12 + w l0^2) / L^2 + w L^2 / l0^2.
    const double L = cross(y, z);
    if (L <= 1e-3 * l0) {
      flat = false;
      break;
    }
    const Vec2 dL{y.y - z.y, z.x - y.x}, dS = -2.0 * (y + z);
    const double S = dot(y, y) + dot(z, z) + dot(z - y, z - y), u = 1 / (L * L);
    const double M = (S * S / 12 + size_weight * l0 * l0) * u, w = size_weight / (l0 * l0);
    const double a = S * u / 6, b = 2 * (w * L - M / L);
    gradient = gradient + a * dS + b * dL;
    const double ss = u / 6, sl = -2 * a / L, ll = 6 * M * u + 2 * w, same = 4 * a;
    hxx += ss * dS.x * dS.x + 2 * sl * dS.x * dL.x + ll * dL.x * dL.x + same;
    hyy += ss * dS.y * dS.y + 2 * sl * dS.y * dL.y + ll * dL.y * dL.y + same;
    hxy += ss * dS.x * dS.y + sl * (dS.x * dL.y + dS.y * dL.x) + ll * dL.x * dL.y;
  }
  Vec2 step;
  const double det = hxx * hyy - hxy * hxy;
  if (flat && det > 1e-12 * hxx * hyy && hxx > 0) {
    step = (-1 / det) * Vec2{hyy * gradient.x - hxy * gradient.y, hxx * gradient.y - hxy * gradient.x};
  } else {
    // a star with folded triangles: towards its centre
    Vec3 centre{};
    for (int i = 0; i < star.n; ++i) centre = centre + (star.y[i] - x);
    centre = (1.0 / star.n) * centre;
    step = {dot(centre, s), dot(centre, t)};
  }
  const double length = norm(step);
  if (length < no_step * size) return false;
  if (length > 0.5 * size) step = (0.5 * size / length) * step;
  const double now = star.energy(x, size), agreed = star.agreement(x, facing_[v]);
  for (int halving = 0; halving < 3; ++halving, step = 0.5 * step) {
    const Place place = ground_->walk.closest(lifted_.place[v], x + step.x * s + step.y * t);
    const Vec3 p = ground_->walk.point(place);
    if (star.energy(p, size) >= now) continue;
    const Vec3 facing = facing_at(place);
    if (folds(agreed, star.agreement(p, facing))) continue;
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
