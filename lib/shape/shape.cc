// SPDX-License-Identifier: BSD-3-Clause
#include "lib/shape/shape.h"

#include <algorithm>
#include <numbers>

#include "lib/core/random.h"
#include "lib/core/take_rows.h"
#include "lib/core/topology.h"
#include "lib/core/weld.h"
#include "lib/shape/split_triangle.h"

namespace meshpipe {
namespace {

using std::numbers::pi;
const double row_height = std::sqrt(3) / 2;  // of equilateral triangles of side 1

Vec3 on_circle(double radius, double turn, double z) {
  return {radius * std::cos(2 * pi * turn), radius * std::sin(2 * pi * turn), z};
}

/// A ring of vertices: those from `first`, the i-th at (i + shift) / count of a full turn.
struct Ring {
  int first, count;
  double shift;
  int at(int i) const { return first + i % count; }
};

Ring add_ring(Mesh& mesh, double radius, double z, int count, double shift) {
  const Ring ring{(int)mesh.points.size(), count, shift};
  for (int i = 0; i < count; ++i) mesh.points.push_back(on_circle(radius, (i + shift) / count, z));
  return ring;
}

/// Joins two rings by a band of triangles, each next one of the two possible being that which lags in turn.
/// Counterclockwise if b lies inside a in the plane, or above it on a cylinder seen from outside.
void add_band(Mesh& mesh, const Ring& a, const Ring& b) {
  for (int i = 0, j = 0; i < a.count || j < b.count;) {
    const double next_a = (i + 1 + a.shift) / a.count, next_b = (j + 1 + b.shift) / b.count;
    if (j == b.count || (i < a.count && next_a <= next_b)) {
      mesh.tris.push_back({a.at(i), a.at(i + 1), b.at(j)});
      ++i;
    } else {
      mesh.tris.push_back({a.at(i), b.at(j + 1), b.at(j)});
      ++j;
    }
  }
}

/// Closes a ring by a flat disk of concentric rings, seen from above (or from below when `down`).
void add_disk(Mesh& mesh, Ring rim, double radius, double z, bool down) {
  const std::size_t first = mesh.tris.size();
  const int rings = std::max(1, (int)std::lround(rim.count / (2 * pi)));
  Ring outer = rim;
  for (int k = rings - 1; k > 0; --k) {
    const Ring inner = add_ring(mesh, radius * k / rings, z,
                                std::max(3, (int)std::lround((double)rim.count * k / rings)), 0);
    add_band(mesh, outer, inner);
    outer = inner;
  }
  const int center = (int)mesh.points.size();
  mesh.points.push_back({0, 0, z});
  for (int i = 0; i < outer.count; ++i) mesh.tris.push_back({outer.at(i), outer.at(i + 1), center});
  if (down)
    for (std::size_t t = first; t < mesh.tris.size(); ++t) std::swap(mesh.tris[t][1], mesh.tris[t][2]);
}

}  // namespace

Mesh tube(double aspect, int n, bool closed) {
  Mesh mesh;
  const int rows = std::max(1, (int)std::lround(aspect * n / (pi * row_height)));
  Ring below{}, bottom{};
  for (int k = 0; k <= rows; ++k) {
    const Ring ring = add_ring(mesh, 0.5, aspect * k / rows, n, k % 2 * 0.5);
    if (k)
      add_band(mesh, below, ring);
    else
      bottom = ring;
    below = ring;
  }
  if (closed) {
    add_disk(mesh, below, 0.5, aspect, false);
    add_disk(mesh, bottom, 0.5, 0, true);
  }
  return mesh;
}

Mesh sphere(int n) {
  const double g = std::numbers::phi;
  const Vec3 corner[12] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                           {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  const Tri face[20] = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                        {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                        {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  const int k = std::max(1, (int)std::ceil(std::sqrt(n / 20.0)));
  Mesh mesh;
  for (const Tri& f : face)
    add_split_triangle(mesh, k, f, [&](const CornerShares& shares) {
      Vec3 p;
      for (auto [c, share] : shares) p = p + (double)share * corner[c];
      return normalized(p);
    });
  weld(mesh);
  return mesh;
}

Mesh torus(double r, int n) {
  const int around = std::max(3, (int)std::lround(std::sqrt(n / 2.0 * r * row_height)));
  // an even number of rows, so that the rows shifted by half an edge meet at the end
  const int along = std::max(4, 2 * (int)std::lround(n / (4.0 * around)));
  Mesh mesh;
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < around; ++j) {
      const double u = 2 * pi * i / along, v = 2 * pi * (j + i % 2 * 0.5) / around;
      const double d = 1 + r * std::cos(v);
      mesh.points.push_back({d * std::cos(u), d * std::sin(u), r * std::sin(v)});
    }
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < around; ++j) {
      const int a = i * around, b = (i + 1) % along * around, next = (j + 1) % around;
      if (i % 2 == 0) {
        mesh.tris.push_back({a + j, b + j, a + next});
        mesh.tris.push_back({a + next, b + j, b + next});
      } else {
        mesh.tris.push_back({a + j, b + j, b + next});
        mesh.tris.push_back({a + j, b + next, a + next});
      }
    }
  return mesh;
}

Body cube(int n) {
  const int k = std::max(1, (int)std::lround(std::sqrt(n / 12.0)));
  Body body;
  body.names = {"left", "right", "front", "back", "bottom", "top"};
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      auto point = [&](int i, int j) {
        double x[3];
        x[axis] = side;
        x[(axis + 1) % 3] = (double)(side ? i : j) / k;
        x[(axis + 2) % 3] = (double)(side ? j : i) / k;
        return Vec3{x[0], x[1], x[2]};
      };
      const int first = (int)body.points.size();
      for (int j = 0; j <= k; ++j)
        for (int i = 0; i <= k; ++i) body.points.push_back(point(i, j));
      for (int j = 0; j < k; ++j)
        for (int i = 0; i < k; ++i) {
          const int a = first + j * (k + 1) + i, b = a + 1, c = a + k + 1, d = c + 1;
          if ((i + j) % 2) {
            body.tris.push_back({a, b, c});
            body.tris.push_back({b, d, c});
          } else {
            body.tris.push_back({a, b, d});
            body.tris.push_back({a, d, c});
          }
        }
      body.patch.resize(body.tris.size(), 2 * axis + side);
    }
  weld(body);
  return body;
}

Body cad_body(int columns, int rows, int segments) {
  constexpr double thickness = 0.4, hole = 0.25, boss = 0.38, bore = 0.15, height = 0.7;
  const int n = std::max(8, (segments + 7) / 8 * 8);  // a corner of the square takes an eighth on either side
  Body body;
  auto patch = [&](const std::string& name) {
    auto at = std::find(body.names.begin(), body.names.end(), name);
    if (at == body.names.end()) at = body.names.insert(at, name);
    return (int)(at - body.names.begin());
  };
  const int top = patch("top"), bottom = patch("bottom");
  auto add = [&](Vec3 a, Vec3 b, Vec3 c, int label, bool turn) {
    const int v = (int)body.points.size();
    body.points.insert(body.points.end(), {a, turn ? c : b, turn ? b : c});
    body.tris.push_back({v, v + 1, v + 2});
    body.patch.push_back(label);
  };
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int number = row * columns + column + 1;
      const Vec3 center{column + 0.5, row + 0.5, 0};
      auto circle = [&](double radius, int i, double z) {
        return center + on_circle(radius, (i % n) / (double)n + 0.125, z);
      };
      auto corner = [&](int k, double z) {
        static constexpr int x[4] = {1, 0, 0, 1}, y[4] = {1, 1, 0, 0};
        return Vec3{(double)(column + x[k % 4]), (double)(row + y[k % 4]), z};
      };
      // the square at height z around a circle: a fan at each corner, and a triangle at each side
      auto face = [&](double radius, double z, int label, bool down) {
        for (int k = 0; k < 4; ++k) {
          for (int i = 0; i < n / 4; ++i) {
            const int at = (k * n / 4 + i + n - n / 8) % n;
            add(corner(k, z), circle(radius, at + 1, z), circle(radius, at, z), label, down);
          }
          const int at = (k * n / 4 + n / 4 + n - n / 8) % n;
          add(corner(k, z), corner(k + 1, z), circle(radius, at, z), label, down);
        }
      };
      // a cylinder by full-length triangles, seen from outside (or from the axis)
      auto cylinder = [&](double radius, double z0, double z1, const std::string& name, bool inward) {
        const int label = patch(name);
        for (int i = 0; i < n; ++i) {
          add(circle(radius, i, z0), circle(radius, i + 1, z0), circle(radius, i + 1, z1), label, inward);
          add(circle(radius, i, z0), circle(radius, i + 1, z1), circle(radius, i, z1), label, inward);
        }
      };
      const std::string id = std::to_string(number);
      if ((row + column) % 2 == 0) {
        face(hole, thickness, top, false);
        face(hole, 0, bottom, true);
        cylinder(hole, 0, thickness, "hole" + id, true);
      } else {
        face(boss, thickness, top, false);
        face(bore, 0, bottom, true);
        cylinder(boss, thickness, height, "boss" + id, false);
        cylinder(bore, 0, height, "bore" + id, true);
        const int cap = patch("cap" + id);
        for (int i = 0; i < n; ++i) {
          add(circle(boss, i, height), circle(boss, i + 1, height), circle(bore, i, height), cap, false);
          add(circle(boss, i + 1, height), circle(bore, i + 1, height), circle(bore, i, height), cap, false);
        }
      }
      auto side = [&](int k, const std::string& name) {
        add(corner(k, 0), corner(k + 1, 0), corner(k + 1, thickness), patch(name), false);
        add(corner(k, 0), corner(k + 1, thickness), corner(k, thickness), patch(name), false);
      };
      if (row == rows - 1) side(0, "back");
      if (column == 0) side(1, "left");
      if (row == 0) side(2, "front");
      if (column == columns - 1) side(3, "right");
    }
  weld(body);
  return body;
}

void add_noise(Mesh& mesh, double amount, int seed) {
  double sum = 0;
  for (const Tri& t : mesh.tris)
    for (int i = 0; i < 3; ++i) sum += norm(mesh.points[t[i]] - mesh.points[t[(i + 1) % 3]]);
  const double length = mesh.tris.empty() ? 0 : amount * sum / (3.0 * mesh.tris.size());
  Random random(seed);
  for (Vec3& p : mesh.points) p = p + length * random.in_ball();
}

void add_slivers(Surface& s, double fraction, int seed) {
  const std::vector<int> opposite = opposite_halfedges(s);
  Random random(seed);
  std::vector<char> done(s.tris.size(), 0);
  std::vector<Tri> tris;
  std::vector<int> from;
  const int n = (int)opposite.size();
  // a triangle is split once at most; each has three chances, on two sides
  for (int h = 0; h < n; ++h) {
    const int g = opposite[h];
    if (g > h || random.uniform() >= fraction || done[h / 3] || (g >= 0 && done[g / 3])) continue;
    const double t = 0.02 + 0.03 * random.uniform();
    const int v = (int)s.points.size();
    s.points.push_back(lerp(s.points[origin(s.tris, h)], s.points[target(s.tris, h)], t));
    for (int e : {h, g}) {
      if (e < 0) continue;
      Tri rest = s.tris[e / 3];
      rest[e % 3] = v;
      s.tris[e / 3][(e + 1) % 3] = v;
      tris.push_back(rest);
      from.push_back(e / 3);
      done[e / 3] = 1;
    }
  }
  s.tris.insert(s.tris.end(), tris.begin(), tris.end());
  append_rows(s.face, from);
  s.vertex.rows = s.points.size();
}

void add_dirt(Surface& s, double fraction, int seed) {
  Random random(seed);
  const int n = (int)s.tris.size(), each = std::max(1, (int)std::lround(fraction * n));
  std::vector<Tri> tris;
  std::vector<int> from;
  auto any = [&] { return random.below(n); };
  for (int i = 0; i < each; ++i) {
    const int copy = any(), flipped = any(), flat = any(), line = any(), loose = any();
    tris.push_back(s.tris[copy]);
    from.push_back(copy);
    std::swap(s.tris[flipped][1], s.tris[flipped][2]);
    tris.push_back({s.tris[flat][0], s.tris[flat][1], s.tris[flat][1]});
    from.push_back(flat);
    // two corners and a copy of the second: without area once it is welded
    const int v = (int)s.points.size();
    s.points.push_back(s.points[s.tris[line][1]]);
    tris.push_back({s.tris[line][0], s.tris[line][1], v});
    from.push_back(line);
    s.points.push_back(s.points[s.tris[loose][0]]);
    s.tris[loose][0] = v + 1;
    s.points.push_back(random.in_ball());
  }
  s.tris.insert(s.tris.end(), tris.begin(), tris.end());
  append_rows(s.face, from);
  s.vertex.rows = s.points.size();
}

}  // namespace meshpipe
