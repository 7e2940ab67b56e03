// SPDX-License-Identifier: BSD-3-Clause
#include "lib/wrap/fit.h"

#include "lib/core/connectivity.h"
#include "lib/core/lists.h"

namespace meshpipe {
namespace {

/// Rounds of fitting: the largest move of the last one is below a hundredth of the spacing on smooth
/// surfaces.
constexpr int rounds = 12;
/// Directions in which the planes differ by less (the eigenvalue of their normals' mean square, 0 to 1) are
/// smoothed; 0.05 is that of two planes at 26 degrees.
constexpr double least_eigenvalue = 0.05;
/// The same pull for each sample that is over a hole, per sample that is not.
constexpr double hole_pull = 0.3;
/// Farther than this from the offset, in voxels, a sample says nothing about the soup: it is over a hole.
constexpr double fit_reach = 2.5;
/// A point moves no farther in one round, in voxels.
constexpr double longest_move = 0.5;
/// Planes of triangles that meet in an edge or a corner are used up to 120 degrees between them, where they
/// meet at twice the offset; beyond, the surface is round.
constexpr double sharpest = 0.5;

/// Sum of squared distances from planes, as a quadratic form; `weight` is the number of planes.
struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  Vec3 right;
  double weight = 0;

  void add_plane(Vec3 n, double height, double w) {
    xx += w * n.x * n.x, xy += w * n.x * n.y, xz += w * n.x * n.z;
    yy += w * n.y * n.y, yz += w * n.y * n.z, zz += w * n.z * n.z;
    right = right + w * height * n;
    weight += w;
  }
  void add(const Quadric& q) {
    xx += q.xx, xy += q.xy, xz += q.xz, yy += q.yy, yz += q.yz, zz += q.zz;
    right = right + q.right;
    weight += q.weight;
  }
  /// Minimizes the form in the directions that the planes determine, and goes to the target in the others:
  /// a direction with eigenvalue e times the weight goes e^2 / (e^2 + pull) of the way to the minimum.
  /// Requires: pull > 0.
  Vec3 minimum(Vec3 target, double pull) const {
    if (!(weight > 0)) return target;
    const double s = 1 / (weight * weight);
    const double a = s * (xx * xx + xy * xy + xz * xz) + pull, d = s * (xy * xy + yy * yy + yz * yz) + pull,
                 f = s * (xz * xz + yz * yz + zz * zz) + pull, b = s * (xx * xy + xy * yy + xz * yz),
                 c = s * (xx * xz + xy * yz + xz * zz), e = s * (xy * xz + yy * yz + yz * zz);
    const Vec3 r =
        s * Vec3{xx * right.x + xy * right.y + xz * right.z, xy * right.x + yy * right.y + yz * right.z,
                 xz * right.x + yz * right.y + zz * right.z} +
        pull * target;
    const double c0 = d * f - e * e, c1 = c * e - b * f, c2 = b * e - c * d;
    return (1 / (a * c0 + b * c1 + c * c2)) * Vec3{c0 * r.x + c1 * r.y + c2 * r.z,
                                                   c1 * r.x + (a * f - c * c) * r.y + (b * c - a * e) * r.z,
                                                   c2 * r.x + (b * c - a * e) * r.y + (a * d - b * b) * r.z};
  }
};

/// The planes at the offset from the soup near a sample: that of the nearest triangle, or where the nearest
/// point is on an edge or corner, those of all triangles there that face the sample.
Quadric planes_at(Vec3 s, const Mesh& soup, const Bvh& tree, double offset, double reach, double tiny) {
  Quadric q;
  const auto hit = tree.nearest(s);
  if (hit.distance > reach || hit.distance <= 0) return q;
  const Vec3 near = value_at(hit.place, soup.points, soup.tris);
  const Vec3 direction = normalized(s - near);
  const Vec3 margin{tiny, tiny, tiny};
  const double least = std::min({hit.place.b0, hit.place.b1, hit.place.b2});
  if (least < 1e-9)
    tree.overlapping({near - margin, near + margin}, [&](int t) {
      const Vec3 n = area_vector(soup, t);
      const double size = norm(n);
      if (!(size > 0)) return;
      const double cosine = dot(n, direction) / size;
      if (std::abs(cosine) < sharpest) return;
      if (norm(closest_point(soup, t, near) - near) > tiny) return;
      const Vec3 unit = (cosine > 0 ? 1 / size : -1 / size) * n;
      q.add_plane(unit, dot(unit, near) + offset, 1);
    });
  if (q.weight == 0) {
    q.add_plane(direction, dot(direction, near) + offset, 1);
  } else {
    const double scale = 1 / q.weight;
    Quadric mean;
    mean.xx = scale * q.xx, mean.xy = scale * q.xy, mean.xz = scale * q.xz;
    mean.yy = scale * q.yy, mean.yz = scale * q.yz, mean.zz = scale * q.zz;
    mean.right = scale * q.right;
    mean.weight = 1;
    q = mean;
  }
  return q;
}

/// The quadrilaterals at each point, as 4 * quad + corner.
Lists corners_at_points(const QuadMesh& m) {
  return lists_of((int)m.points.size(), [&](auto use) {
    for (int c = 0; c < 4 * (int)m.quads.size(); ++c) use(m.quads[c / 4][c % 4], c);
  });
}

}  // namespace

QuadMesh boundary_of(const Voxels& v) {
  QuadMesh m;
  std::vector<int> number(v.state.size(), -1);  // of the grid point at a voxel's low corner
  auto point = [&](const std::array<int, 3>& p) {
    int& n = number[v.at(p[0], p[1], p[2])];
    if (n < 0) {
      n = (int)m.points.size();
      m.points.push_back(v.low + v.spacing * Vec3{(double)p[0], (double)p[1], (double)p[2]});
    }
    return n;
  };
  for (std::int64_t voxel = 0; voxel < (std::int64_t)v.state.size(); ++voxel) {
    if (v.is_outside(voxel)) continue;
    const auto p = v.position(voxel);
    for (int axis = 0; axis < 3; ++axis)
      for (int side : {0, 1}) {
        std::array<int, 3> q = p;
        q[axis] += side ? 1 : -1;
        if (!v.is_outside(v.at(q[0], q[1], q[2]))) continue;
        std::array<int, 3> corner[4];
        for (auto& c : corner) c = p, c[axis] += side;
        ++corner[1][(axis + 1) % 3], ++corner[2][(axis + 1) % 3];
        ++corner[2][(axis + 2) % 3], ++corner[3][(axis + 2) % 3];
        if (!side) std::swap(corner[1], corner[3]);
        m.quads.push_back({point(corner[0]), point(corner[1]), point(corner[2]), point(corner[3])});
        m.bridge.push_back(v.state[voxel] == Voxels::open);
      }
  }
  return m;
}

std::vector<Vec3> fitted_points(const QuadMesh& m, const Mesh& soup, const Bvh& tree, double offset,
                                double spacing) {
  const Lists corners = corners_at_points(m);
  const int n = (int)m.points.size(), n_quads = (int)m.quads.size();
  const double reach = offset + fit_reach * spacing, tiny = 1e-7 * spacing;
  std::vector<Vec3> points = m.points, moved(n);
  std::vector<Quadric> at_quad(n_quads);
  for (int round = 0; round < rounds; ++round) {
#pragma omp parallel for schedule(dynamic, 256)
    for (int i = 0; i < n_quads; ++i) {
      const auto& q = m.quads[i];
      const Vec3 center = 0.25 * (points[q[0]] + points[q[1]] + points[q[2]] + points[q[3]]);
      if (!m.bridge[i]) at_quad[i] = planes_at(center, soup, tree, offset, reach, tiny);
    }
#pragma omp parallel for schedule(dynamic, 256)
    for (int p = 0; p < n; ++p) {
      Quadric sum;
      Vec3 middle;
      const int degree = (int)corners[p].size();
      bool fitted = true;
      for (int c : corners[p]) {
        const int quad = c / 4, corner = c % 4;
        sum.add(at_quad[quad]);
        fitted &= !m.bridge[quad];
        middle = middle + (1.0 / degree) * points[m.quads[quad][(corner + 1) % 4]];
      }
      if (fitted) sum.add(planes_at(points[p], soup, tree, offset, reach, tiny));
      const double missing = degree + 1 - sum.weight;
      const double pull = least_eigenvalue * least_eigenvalue + hole_pull * missing / (sum.weight + 1e-9);
      const Vec3 step = sum.minimum(middle, pull) - points[p];
      const double length = norm(step);
      moved[p] = points[p] + (length > longest_move * spacing ? longest_move * spacing / length : 1.0) * step;
    }
    points.swap(moved);
  }
  return points;
}

std::vector<Tri> divided(const QuadMesh& m, const std::vector<Vec3>& points, const Mesh& soup,
                         const Bvh& tree, double offset) {
  const int n = (int)m.quads.size();
  std::vector<Tri> tris(2 * (std::size_t)n);
#pragma omp parallel for schedule(dynamic, 256)
  for (int i = 0; i < n; ++i) {
    const auto& [a, b, c, d] = m.quads[i];
    const Vec3 &pa = points[a], &pb = points[b], &pc = points[c], &pd = points[d];
    const Vec3 normal = cross(pc - pa, pd - pb);
    auto error = [&](Vec3 p) {
      const auto hit = tree.nearest(p);
      const Vec3 near = value_at(hit.place, soup.points, soup.tris);
      return std::abs((dot(p - near, normal) < 0 ? -hit.distance : hit.distance) - offset);
    };
    // on flat ground both are equal up to rounding, and at a sharp edge three of the corners may be in line
    const double ac = error(0.5 * (pa + pc)), bd = error(0.5 * (pb + pd));
    const double kappa_ac = std::min(kappa(pa, pb, pc), kappa(pa, pc, pd));
    const double kappa_bd = std::min(kappa(pb, pc, pd), kappa(pb, pd, pa));
    const bool by_shape = std::abs(ac - bd) < 0.02 * (norm(pc - pa) + norm(pd - pb));
    const bool first = by_shape ? kappa_ac >= kappa_bd : ac < bd;
    tris[2 * i] = first ? Tri{a, b, c} : Tri{b, c, d};
    tris[2 * i + 1] = first ? Tri{a, c, d} : Tri{b, d, a};
  }
  return tris;
}

}  // namespace meshpipe
