// SPDX-License-Identifier: BSD-3-Clause
#include "lib/resolve/exact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lib/core/error.h"
#include "lib/core/predicates.h"

namespace meshpipe {
namespace {

using Int = boost::multiprecision::cpp_int;

constexpr double eps = std::numeric_limits<double>::epsilon() / 2;  // half an ulp of 1

double coordinate(Vec3 p, int k) { return k == 0 ? p.x : k == 1 ? p.y : p.z; }
Vec2 seen(Vec3 p, Projection v) { return {coordinate(p, v.i), coordinate(p, v.j)}; }

/// The exponent of the lowest bit that is set.
int lowest_bit(double x) {
  int e;
  std::int64_t m = (std::int64_t)std::ldexp(std::frexp(x, &e), 53);
  return e - 53 + std::countr_zero((std::uint64_t)m);
}

Int to_integer(double x, int exponent) {
  if (x == 0) return 0;
  int e;
  Int m = (std::int64_t)std::ldexp(std::frexp(x, &e), 53);
  const int shift = e - 53 - exponent;
  if (shift >= 0)
    m <<= shift;
  else
    m = x < 0 ? Int(-(-m >> -shift)) : Int(m >> -shift);  // trailing zeros go
  return m;
}

/// x / w rounded to the nearest double, whatever factors the two have in common.
double quotient(const Int& x, const Int& w, int exponent) {
  if (x == 0) return 0;
  Int a = abs(x), b = w;
  const int shift = 56 + (int)msb(b) - (int)msb(a);
  if (shift > 0)
    a <<= shift;
  else
    b <<= -shift;
  Int q, r;
  divide_qr(a, b, q, r);  // of 56 or 57 bits, the last of which stands for all that follow
  const std::uint64_t bits = static_cast<std::uint64_t>(q) | (r != 0);
  return std::ldexp(x < 0 ? -(double)bits : (double)bits, exponent - shift);
}

}  // namespace

ExactPoints::ExactPoints(std::vector<Vec3> vertices, const std::vector<char>& used)
    : vertices_((int)vertices.size()), near_(std::move(vertices)), places_(near_.size()) {
  exponent_ = std::numeric_limits<int>::max();
  double largest = 0;
  next_at_.assign(vertices_, -1);
  for (int p = 0; p < vertices_; ++p) {
    if (!used[p]) continue;
    for (int k = 0; k < 3; ++k) {
      const double x = coordinate(near_[p], k);
      largest = std::max(largest, std::abs(x));
      if (x != 0) exponent_ = std::min(exponent_, lowest_bit(x));
    }
    int place;
    places_.add(&near_[p], 1, &place);
    first_at_.push_back(p);
  }
  if (largest == 0) exponent_ = 0;
  error_ = eps * largest;
}

auto ExactPoints::exact(int p) const -> Homogeneous {
  if (!is_vertex(p)) return new_[p - vertices_];
  const Vec3 v = near_[p];
  return {to_integer(v.x, exponent_), to_integer(v.y, exponent_), to_integer(v.z, exponent_), 1};
}

auto ExactPoints::plane(const Tri& t) const -> Homogeneous {
  const Homogeneous a = exact(t[0]), b = exact(t[1]), c = exact(t[2]);
  Int u[3], v[3];
  for (int k = 0; k < 3; ++k) u[k] = b[k] - a[k], v[k] = c[k] - a[k];
  Homogeneous n;
  for (int k = 0; k < 3; ++k) n[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
  n[3] = -(n[0] * a[0] + n[1] * a[1] + n[2] * a[2]);
  return n;
}

Vec3 ExactPoints::rounded(const Homogeneous& h) const {
  return {quotient(h[0], h[3], exponent_), quotient(h[1], h[3], exponent_), quotient(h[2], h[3], exponent_)};
}

int ExactPoints::number(Homogeneous h) {
  if (h[3] < 0)
    for (Int& x : h) x = -x;
  unsigned twos = std::numeric_limits<unsigned>::max();  // common factors, so that numbers stay short
  for (const Int& x : h)
    if (x != 0) twos = std::min(twos, (unsigned)lsb(Int(abs(x))));
  if (twos)
    for (Int& x : h) x = x < 0 ? Int(-(-x >> twos)) : Int(x >> twos);
  const Vec3 at = rounded(h);
  int place;
  places_.add(&at, 1, &place);
  if (place == (int)first_at_.size()) first_at_.push_back(-1);
  int last = -1;
  for (int p = first_at_[place]; p >= 0; p = next_at_[last = p]) {
    const Homogeneous g = exact(p);
    if (h[0] * g[3] == g[0] * h[3] && h[1] * g[3] == g[1] * h[3] && h[2] * g[3] == g[2] * h[3]) return p;
  }
  const int p = size();
  (last < 0 ? first_at_[place] : next_at_[last]) = p;
  near_.push_back(at);
  next_at_.push_back(-1);
  new_.push_back(std::move(h));
  return p;
}

namespace {

template <class H>
H between(const H& p, const H& q, const Int& at_p, const Int& at_q) {
  H r;
  for (int k = 0; k < 4; ++k) r[k] = at_q * p[k] - at_p * q[k];
  return r;
}

}  // namespace

int ExactPoints::line_and_plane(int p, int q, const Tri& t) {
  const Homogeneous n = plane(t), a = exact(p), b = exact(q);
  auto value = [&](const Homogeneous& x) -> Int {
    return n[0] * x[0] + n[1] * x[1] + n[2] * x[2] + n[3] * x[3];
  };
  return number(between(a, b, value(a), value(b)));
}

int ExactPoints::line_and_line(int p, int q, int a, int b, Projection view) {
  const Homogeneous u = exact(p), v = exact(q), x = exact(a), y = exact(b);
  const int i = view.i, j = view.j;
  const Int l = x[j] * y[3] - x[3] * y[j], m = x[3] * y[i] - x[i] * y[3], n = x[i] * y[j] - x[j] * y[i];
  auto value = [&](const Homogeneous& z) -> Int { return l * z[i] + m * z[j] + n * z[3]; };
  return number(between(u, v, value(u), value(v)));
}

Projection ExactPoints::view(const Tri& t) const {
  // the coordinate left out is that of the normal's largest component, if exact arithmetic agrees
  const Vec3 n = area_vector(near_[t[0]], near_[t[1]], near_[t[2]]);
  std::array<std::pair<double, int>, 3> size{{{-std::abs(n.x), 0}, {-std::abs(n.y), 1}, {-std::abs(n.z), 2}}};
  std::sort(size.begin(), size.end());
  for (const auto& [minus, k] : size) {
    const Projection view{(k + 1) % 3, (k + 2) % 3};
    if (const int sense = turn(t[0], t[1], t[2], view); sense != 0)
      return sense > 0 ? view : Projection{view.j, view.i};
  }
  throw Error("a triangle without area in an arrangement");
}

int ExactPoints::turn(int a, int b, int c, Projection view) const {
  const Vec2 p = seen(near_[a], view), q = seen(near_[b], view), r = seen(near_[c], view);
  if (is_vertex(a) && is_vertex(b) && is_vertex(c)) return orient2d(p, q, r);
  const Vec2 u = p - r, v = q - r;
  const double left = u.x * v.y, right = u.y * v.x, det = left - right;
  const double bound =
      4 * error_ * (std::abs(u.x) + std::abs(u.y) + std::abs(v.x) + std::abs(v.y) + 4 * error_) +
      8 * eps * (std::abs(left) + std::abs(right));
  if (std::abs(det) > bound) return det > 0 ? 1 : -1;
  const Homogeneous x = exact(a), y = exact(b), z = exact(c);
  const auto [i, j] = view;
  const Int d = x[i] * (y[j] * z[3] - y[3] * z[j]) - x[j] * (y[i] * z[3] - y[3] * z[i]) +
                x[3] * (y[i] * z[j] - y[j] * z[i]);
  return d.sign();
}

int ExactPoints::side(const Tri& t, int p) const {
  const Vec3 a = near_[t[0]], b = near_[t[1]], c = near_[t[2]], x = near_[p];
  if (is_vertex(p)) return -orient3d(a, b, c, x);
  const Vec3 u = b - a, v = c - a, w = x - a;
  const double yz = u.y * v.z, zy = u.z * v.y, zx = u.z * v.x, xz = u.x * v.z, xy = u.x * v.y, yx = u.y * v.x;
  const double det = (yz - zy) * w.x + (zx - xz) * w.y + (xy - yx) * w.z;
  const double l = std::abs(yz) + std::abs(zy), m = std::abs(zx) + std::abs(xz),
               n = std::abs(xy) + std::abs(yx);
  const double bound =
      4 * error_ * (l + m + n) + 16 * eps * (l * std::abs(w.x) + m * std::abs(w.y) + n * std::abs(w.z));
  if (std::abs(det) > bound) return det > 0 ? 1 : -1;
  const Homogeneous e = plane(t), h = exact(p);
  const Int d = e[0] * h[0] + e[1] * h[1] + e[2] * h[2] + e[3] * h[3];
  return d.sign();
}

int ExactPoints::compare(int p, int q, int k) const {
  const double a = coordinate(near_[p], k), b = coordinate(near_[q], k);
  if (a != b || (is_vertex(p) && is_vertex(q))) return (b > a) - (b < a);  // rounding keeps the order
  const Homogeneous x = exact(p), y = exact(q);
  const Int d = y[k] * x[3] - x[k] * y[3];
  return d.sign();
}

}  // namespace meshpipe
