// SPDX-License-Identifier: BSD-3-Clause
// Points and vectors of the plane and of space: plain structs, value semantics, no dependencies.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace meshpipe {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Vec2 {
  double x = 0, y = 0;
};
struct Vec3 {
  double x = 0, y = 0, z = 0;
};

inline Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
inline Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
inline Vec2 operator*(double s, Vec2 a) { return {s * a.x, s * a.y}; }
inline bool operator==(Vec2 a, Vec2 b) { return a.x == b.x && a.y == b.y; }
inline double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
inline double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }
inline double norm(Vec2 a) { return std::sqrt(dot(a, a)); }
inline Vec2 lerp(Vec2 a, Vec2 b, double t) { return (1 - t) * a + t * b; }
inline Vec2 lower(Vec2 a, Vec2 b) { return {std::min(a.x, b.x), std::min(a.y, b.y)}; }
inline Vec2 upper(Vec2 a, Vec2 b) { return {std::max(a.x, b.x), std::max(a.y, b.y)}; }

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline bool operator==(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm(Vec3 a) { return std::sqrt(dot(a, a)); }
inline Vec3 lerp(Vec3 a, Vec3 b, double t) { return (1 - t) * a + t * b; }
inline Vec3 lower(Vec3 a, Vec3 b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
inline Vec3 upper(Vec3 a, Vec3 b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }
/// Returns a over its length; the zero vector stays zero.
inline Vec3 normalized(Vec3 a) {
  double l = norm(a);
  return l > 0 ? (1 / l) * a : a;
}
/// Returns the normal of triangle abc with twice its area as length.
inline Vec3 area_vector(Vec3 a, Vec3 b, Vec3 c) { return cross(b - a, c - a); }
constexpr double degree = std::numbers::pi / 180;  ///< in radians
/// Returns the angle between two vectors, 0 to pi; by atan2, as acos loses half the digits near both.
inline double angle(Vec3 a, Vec3 b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }
/// Returns where the segment from a to b is nearest to p, as a fraction of it from a; 0 if it has no length.
template <class Point>
double nearest_fraction(Point p, Point a, Point b) {
  const Point d = b - a;
  const double l2 = dot(d, d);
  return l2 > 0 ? std::clamp(dot(p - a, d) / l2, 0.0, 1.0) : 0;
}

}  // namespace meshpipe
