// SPDX-License-Identifier: BSD-3-Clause
#include "lib/param/optimize.h"

#include <algorithm>

#include "lib/core/error.h"
#include "lib/param/injective.h"

namespace meshpipe {
namespace {

constexpr double bound = 8;           // on the distortion of a triangle that one step works on
constexpr double flattest = 0.01;     // height over length: a flatter triangle counts as one of this shape
constexpr double hold_weight = 1e-6;  // of the term that keeps the matrix definite, over the proxy's
constexpr double least_gain = 1e-3;   // relative: a step that gains less is the last one
constexpr double margin = 0.8;        // of the step at which the first triangle becomes flat
constexpr double armijo = 1e-4;       // share of the gain that the slope promises
constexpr int most_halvings = 20;     // a step of 1e-6 gains nothing

/// A triangle in its own plane: the gradients of its corners' hat functions, and its share of the area.
struct Rest {
  std::array<Vec2, 3> gradient;
  double area;
};

/// J = [xx xy; yx yy], the derivative of the map.
struct Jacobian {
  double xx = 0, xy = 0, yx = 0, yy = 0;
};

std::vector<Rest> rest_shapes(const SubMesh& part) {
  std::vector<Rest> rest;
  double total = total_area(part);
  for (const Tri& t : part.tris) {
    // along its longest edge, from it to the third corner
    int first = 0;
    double l = -1;
    for (int i = 0; i < 3; ++i)
      if (double e = norm(part.points[t[(i + 1) % 3]] - part.points[t[i]]); e > l) l = e, first = i;
    if (!(l > 0)) l = 1e-6 * std::sqrt(total / (double)part.tris.size());
    Vec3 a = part.points[t[first]], e = part.points[t[(first + 1) % 3]] - a;
    Vec3 f = part.points[t[(first + 2) % 3]] - a;
    double x = std::clamp(dot(e, f) / l, 0.0, l), y = std::max(norm(cross(e, f)) / l, flattest * l);
    Rest r;
    r.area = 0.5 * l * y / total;
    r.gradient[first] = {-1 / l, (x / l - 1) / y};
    r.gradient[(first + 1) % 3] = {1 / l, -x / l / y};
    r.gradient[(first + 2) % 3] = {0, 1 / y};
    rest.push_back(r);
  }
  return rest;
}

Jacobian jacobian(const Rest& r, const Tri& t, const std::vector<Vec2>& uv) {
  Jacobian j;
  for (int i = 0; i < 3; ++i) {
    Vec2 p = uv[t[i]], g = r.gradient[i];
    j.xx += p.x * g.x;
    j.xy += p.x * g.y;
    j.yx += p.y * g.x;
    j.yy += p.y * g.y;
  }
  return j;
}

/// Returns the energy, infinite for a map that is not locally one-to-one.
double energy(const std::vector<Tri>& tris, const std::vector<Rest>& rest, const std::vector<Vec2>& uv) {
  double sum = 0;
  for (std::size_t t = 0; t < tris.size(); ++t) {
    Jacobian j = jacobian(rest[t], tris[t], uv);
    double det = j.xx * j.yy - j.xy * j.yx;
    if (!(det > 0)) return infinity;
    sum += rest[t].area * (j.xx * j.xx + j.xy * j.xy + j.yx * j.yx + j.yy * j.yy) * (1 + 1 / (det * det));
  }
  return sum;
}

/// Returns the rest shapes, moved part of the way to their images where the map distorts them by more than a
/// factor of `bound` (progressive parameterizations): the energy stays finite, and a step does not follow the
/// worst triangles alone. `bounded`: whether there are any.
std::vector<Rest> nearer_shapes(const std::vector<Tri>& tris, const std::vector<Rest>& rest,
                                const std::vector<Vec2>& uv, double bound, bool& bounded) {
  std::vector<Rest> nearer = rest;
  bounded = false;
  for (std::size_t t = 0; t < tris.size(); ++t) {
    Jacobian j = jacobian(rest[t], tris[t], uv);
    double a = 0.5 * (j.xx + j.yy), b = 0.5 * (j.yx - j.xy), c = 0.5 * (j.xx - j.yy), d = 0.5 * (j.yx + j.xy);
    double s1 = std::hypot(a, b) + std::hypot(c, d), s2 = (j.xx * j.yy - j.xy * j.yx) / s1;
    double most = std::max(std::abs(std::log(s1)), std::abs(std::log(s2)));
    if (most <= std::log(bound)) continue;
    bounded = true;
    // J = U S V^T becomes U S^share V^T: gradients are multiplied by V S^(share - 1) V^T
    double share = std::log(bound) / most, e1 = std::pow(s1, share - 1), e2 = std::pow(s2, share - 1);
    double turn = std::atan2(d, c) - std::atan2(b, a), mean = 0.5 * (e1 + e2), half = 0.5 * (e1 - e2);
    double xx = mean + half * std::cos(turn), xy = half * std::sin(turn), yy = mean - half * std::cos(turn);
    for (Vec2& g : nearer[t].gradient) g = {xx * g.x + xy * g.y, xy * g.x + yy * g.y};
  }
  return nearer;
}

/// The quadratic proxy of the energy around a map: sum of area |W (J - R)|^2 with the nearest rotation R and
/// the W that gives the proxy the energy's gradient, as a matrix and a right-hand side for x and y in turn. A
/// small weight holds every vertex where it is.
struct Proxy {
  std::vector<Entry<double>> matrix;
  std::vector<double> b;
};

void set_proxy(const std::vector<Tri>& tris, const std::vector<Rest>& rest, const std::vector<Vec2>& uv,
               Proxy& proxy) {
  proxy.matrix.clear();
  proxy.b.assign(2 * uv.size(), 0);
  std::vector<double> hold(uv.size(), 0);
  for (std::size_t t = 0; t < tris.size(); ++t) {
    const Rest& r = rest[t];
    Jacobian j = jacobian(r, tris[t], uv);
    // J = the part that keeps angles + the part that reverses them: singular values are the sum and the
    // difference of their norms, the nearest rotation is the first part's
    double a = 0.5 * (j.xx + j.yy), b = 0.5 * (j.yx - j.xy), c = 0.5 * (j.xx - j.yy), d = 0.5 * (j.yx + j.xy);
    double keep = std::hypot(a, b), reverse = std::hypot(c, d), s1 = keep + reverse;
    double s2 = (j.xx * j.yy - j.xy * j.yx) / s1;  // exact where keep and reverse nearly cancel
    double cosine = a / keep, sine = b / keep;
    // W^2 = U diag((s - s^-3) / (s - 1)) U^T
    auto stiffness = [](double s) {
      double q = 1 / s;  // (s^4 - 1) / (s^3 (s - 1)) = (s^3 + s^2 + s + 1) / s^3
      return 1 + q + q * q + q * q * q;
    };
    double w1 = stiffness(s1), w2 = stiffness(s2), mean = 0.5 * (w1 + w2), half = 0.5 * (w1 - w2);
    // the direction of the larger value in the image: half the sum of the angles of the two parts
    double turn = std::atan2(b, a) + std::atan2(d, c), co = std::cos(turn), si = std::sin(turn);
    double gxx = r.area * (mean + half * co), gxy = r.area * half * si, gyy = r.area * (mean - half * co);
    for (int i = 0; i < 3; ++i) {
      int v = tris[t][i];
      Vec2 g = r.gradient[i];
      Vec2 rg{cosine * g.x - sine * g.y, sine * g.x + cosine * g.y};
      proxy.b[2 * v] += gxx * rg.x + gxy * rg.y;
      proxy.b[2 * v + 1] += gxy * rg.x + gyy * rg.y;
      double gg = dot(g, g);
      proxy.matrix.push_back({2 * v, 2 * v, gxx * gg});
      proxy.matrix.push_back({2 * v + 1, 2 * v, gxy * gg});
      proxy.matrix.push_back({2 * v + 1, 2 * v + 1, gyy * gg});
      hold[v] += hold_weight * r.area * gg;
      int w = tris[t][(i + 1) % 3];
      double gh = dot(g, r.gradient[(i + 1) % 3]);
      int p = std::max(v, w), q = std::min(v, w);
      proxy.matrix.push_back({2 * p, 2 * q, gxx * gh});
      proxy.matrix.push_back({2 * p + 1, 2 * q, gxy * gh});
      proxy.matrix.push_back({2 * p, 2 * q + 1, gxy * gh});
      proxy.matrix.push_back({2 * p + 1, 2 * q + 1, gyy * gh});
    }
  }
  for (int v = 0; v < (int)uv.size(); ++v) {
    proxy.matrix.push_back({2 * v, 2 * v, hold[v]});
    proxy.matrix.push_back({2 * v + 1, 2 * v + 1, hold[v]});
    proxy.b[2 * v] += hold[v] * uv[v].x;
    proxy.b[2 * v + 1] += hold[v] * uv[v].y;
  }
}

/// Returns the largest step, at most 1, along which no triangle becomes flat, less a margin.
double longest_step(const std::vector<Tri>& tris, const std::vector<Vec2>& uv,
                    const std::vector<Vec2>& move) {
  double step = 1 / margin;
  for (const Tri& t : tris) {
    Vec2 p = uv[t[1]] - uv[t[0]], q = uv[t[2]] - uv[t[0]];
    Vec2 dp = move[t[1]] - move[t[0]], dq = move[t[2]] - move[t[0]];
    // area(s) = c + b s + a s^2
    double a = cross(dp, dq), b = cross(dp, q) + cross(p, dq), c = cross(p, q);
    double root = b * b - 4 * a * c;
    if (root < 0) continue;
    root = std::sqrt(root);
    // the smallest positive root, in the form that does not cancel
    double low = b <= 0 ? 2 * c / (-b + root) : a < 0 ? (-b - root) / (2 * a) : infinity;
    if (low > 0 && low < step) step = low;
  }
  return margin * step;
}

}  // namespace

int lower_distortion(const SubMesh& part, const Disk& disk, int steps, std::vector<Vec2>& uv) {
  const std::vector<Rest> shapes = rest_shapes(part);
  int n = (int)uv.size();
  scale_to_area(part, uv);
  Proxy proxy;
  std::unique_ptr<Factorization<double>> factorization;
  std::vector<Vec2> move(n), trial(n);
  for (int taken = 0; taken < steps; ++taken) {
    bool bounded;
    const std::vector<Rest> rest = nearer_shapes(part.tris, shapes, uv, bound, bounded);
    double before = energy(part.tris, rest, uv);
    set_proxy(part.tris, rest, uv, proxy);
    try {
      if (factorization)
        factorization->refactor(proxy.matrix);
      else
        factorization = std::make_unique<Factorization<double>>(2 * n, proxy.matrix);
    } catch (const GoalMissed&) {  // distortion beyond what doubles hold: the map stays as it is
      return taken;
    }
    factorization->solve(proxy.b);
    for (int v = 0; v < n; ++v) move[v] = Vec2{proxy.b[2 * v], proxy.b[2 * v + 1]} - uv[v];
    double slope = 0, after = 0, step = longest_step(part.tris, uv, move);
    for (std::size_t t = 0; t < part.tris.size(); ++t) {
      Jacobian j = jacobian(rest[t], part.tris[t], uv), d = jacobian(rest[t], part.tris[t], move);
      double det = j.xx * j.yy - j.xy * j.yx, q = 1 + 1 / (det * det);
      double square = j.xx * j.xx + j.xy * j.xy + j.yx * j.yx + j.yy * j.yy;
      double d_square = 2 * (j.xx * d.xx + j.xy * d.xy + j.yx * d.yx + j.yy * d.yy);
      double d_det = d.xx * j.yy + j.xx * d.yy - d.xy * j.yx - j.xy * d.yx;
      slope += rest[t].area * (d_square * q - 2 * square * d_det / (det * det * det));
    }
    bool found = false;
    for (int halving = 0; halving < most_halvings && slope < 0 && !found;
         ++halving, step *= found ? 1 : 0.5) {
      for (int v = 0; v < n; ++v) trial[v] = uv[v] + step * move[v];
      after = energy(part.tris, rest, trial);
      found = after <= before + armijo * step * slope && count_inverted(part.tris, trial) == 0 &&
              border_is_simple({part, disk.opposite}, trial);
    }
    if (!found) return taken;
    uv.swap(trial);
    if (!bounded && before - after < least_gain * after) return taken + 1;
  }
  return steps;
}

}  // namespace meshpipe
