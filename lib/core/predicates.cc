// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/predicates.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meshpipe {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon() / 2;  // half an ulp of 1, Shewchuk's epsilon
constexpr double orient2d_bound = (3 + 16 * eps) * eps;             // Shewchuk 1997, the A bounds
constexpr double incircle_bound = (10 + 96 * eps) * eps;
constexpr double orient3d_bound = (7 + 56 * eps) * eps;
// below this a product may have lost bits to underflow, and the filter proves nothing
constexpr double tiny = 1e-250;

// An exact number as a sum of doubles that do not overlap, smallest first, without zeros (so short where the
// data are simple).
template <int N>
struct Expansion {
  double e[N];
  int n = 0;
  int sign() const { return n == 0 ? 0 : (e[n - 1] > 0 ? 1 : -1); }
  void push(double x) {
    if (x != 0) e[n++] = x;
  }
};

// high + low = a + b exactly (Knuth)
double two_sum(double a, double b, double& low) {
  double s = a + b, bb = s - a;
  low = (a - (s - bb)) + (b - bb);
  return s;
}

Expansion<2> difference(double a, double b) {
  Expansion<2> r;
  double low, high = two_sum(a, -b, low);
  r.push(low);
  r.push(high);
  return r;
}

// Sum by merging in order of magnitude (Shewchuk's fast expansion sum, with zeros dropped).
template <int N, int M, int R>
void add(const Expansion<N>& a, const Expansion<M>& b, Expansion<R>& r) {
  r.n = 0;
  int i = 0, j = 0;
  double q = 0, low;
  while (i < a.n || j < b.n) {
    double x = j == b.n || (i < a.n && std::abs(a.e[i]) < std::abs(b.e[j])) ? a.e[i++] : b.e[j++];
    q = two_sum(q, x, low);
    r.push(low);
  }
  r.push(q);
}

template <int N, int M>
Expansion<N + M> operator+(const Expansion<N>& a, const Expansion<M>& b) {
  Expansion<N + M> r;
  add(a, b, r);
  return r;
}

template <int N>
Expansion<N> operator-(Expansion<N> a) {
  for (int i = 0; i < a.n; ++i) a.e[i] = -a.e[i];
  return a;
}

template <int N>
Expansion<2 * N> scale(const Expansion<N>& a, double s) {
  Expansion<2 * N> r;
  double q = 0, low;
  for (int i = 0; i < a.n; ++i) {
    double p = a.e[i] * s, p_low = std::fma(a.e[i], s, -p);
    q = two_sum(q, p_low, low);
    r.push(low);
    q = two_sum(p, q, low);
    r.push(low);
  }
  r.push(q);
  return r;
}

template <int N, int M>
Expansion<2 * N * M> operator*(const Expansion<N>& a, const Expansion<M>& b) {
  Expansion<2 * N * M> r, t;
  for (int j = 0; j < b.n; ++j) {
    add(r, scale(a, b.e[j]), t);
    r = t;
  }
  return r;
}

// A power of two that brings the largest coordinate near one, so that nothing overflows and little
// underflows.
template <class... Doubles>
double scale_to_one(Doubles... x) {
  double m = std::max({std::abs(x)...});
  constexpr int most = 1000;  // the power for the smallest doubles would be infinite itself
  return m > 0 ? std::ldexp(1.0, std::min(-std::ilogb(m), most)) : 1;
}

int exact_orient2d(Vec2 a, Vec2 b, Vec2 c) {
  double s = scale_to_one(a.x, a.y, b.x, b.y, c.x, c.y);
  a = s * a, b = s * b, c = s * c;
  return (difference(a.x, c.x) * difference(b.y, c.y) + -(difference(a.y, c.y) * difference(b.x, c.x)))
      .sign();
}

int exact_incircle(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  double s = scale_to_one(a.x, a.y, b.x, b.y, c.x, c.y, d.x, d.y);
  a = s * a, b = s * b, c = s * c, d = s * d;
  auto ax = difference(a.x, d.x), ay = difference(a.y, d.y), bx = difference(b.x, d.x),
       by = difference(b.y, d.y), cx = difference(c.x, d.x), cy = difference(c.y, d.y);
  return ((bx * cy + -(by * cx)) * (ax * ax + ay * ay) + (cx * ay + -(cy * ax)) * (bx * bx + by * by) +
          (ax * by + -(ay * bx)) * (cx * cx + cy * cy))
      .sign();
}

int exact_orient3d(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  auto same = [](double p, double q, double r, double s) { return p == q && q == r && r == s; };
  if (same(a.x, b.x, c.x, d.x) || same(a.y, b.y, c.y, d.y) || same(a.z, b.z, c.z, d.z)) return 0;
  double s = scale_to_one(a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, d.x, d.y, d.z);
  a = s * a, b = s * b, c = s * c, d = s * d;
  auto ax = difference(a.x, d.x), ay = difference(a.y, d.y), az = difference(a.z, d.z);
  auto bx = difference(b.x, d.x), by = difference(b.y, d.y), bz = difference(b.z, d.z);
  auto cx = difference(c.x, d.x), cy = difference(c.y, d.y), cz = difference(c.z, d.z);
  return ((bx * cy + -(by * cx)) * az + (cx * ay + -(cy * ax)) * bz + (ax * by + -(ay * bx)) * cz).sign();
}

bool certain(double det, double magnitude, double bound) {
  return magnitude > tiny && std::abs(det) > bound * magnitude;
}

int sign(double x) { return x > 0 ? 1 : -1; }

}  // namespace

int orient2d(Vec2 a, Vec2 b, Vec2 c) {
  double l = (a.x - c.x) * (b.y - c.y), r = (a.y - c.y) * (b.x - c.x);
  return certain(l - r, std::abs(l) + std::abs(r), orient2d_bound) ? sign(l - r) : exact_orient2d(a, b, c);
}

int incircle(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  double ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y, cx = c.x - d.x, cy = c.y - d.y;
  double bc = bx * cy, cb = by * cx, ca = cx * ay, ac = cy * ax, ab = ax * by, ba = ay * bx;
  double al = ax * ax + ay * ay, bl = bx * bx + by * by, cl = cx * cx + cy * cy;
  double det = al * (bc - cb) + bl * (ca - ac) + cl * (ab - ba);
  double magnitude = (std::abs(bc) + std::abs(cb)) * al + (std::abs(ca) + std::abs(ac)) * bl +
                     (std::abs(ab) + std::abs(ba)) * cl;
  return certain(det, magnitude, incircle_bound) ? sign(det) : exact_incircle(a, b, c, d);
}

int orient3d(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  double ax = a.x - d.x, ay = a.y - d.y, az = a.z - d.z;
  double bx = b.x - d.x, by = b.y - d.y, bz = b.z - d.z;
  double cx = c.x - d.x, cy = c.y - d.y, cz = c.z - d.z;
  double bc = bx * cy, cb = by * cx, ca = cx * ay, ac = cy * ax, ab = ax * by, ba = ay * bx;
  double det = az * (bc - cb) + bz * (ca - ac) + cz * (ab - ba);
  double magnitude = (std::abs(bc) + std::abs(cb)) * std::abs(az) +
                     (std::abs(ca) + std::abs(ac)) * std::abs(bz) +
                     (std::abs(ab) + std::abs(ba)) * std::abs(cz);
  return certain(det, magnitude, orient3d_bound) ? sign(det) : exact_orient3d(a, b, c, d);
}

}  // namespace meshpipe
