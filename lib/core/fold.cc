// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/fold.h"

namespace meshpipe {

bool faces_one_way(Vec3 a, Vec3 b, Vec3 m, Vec3 n, const Mesh& reference, const Bvh& reference_tree) {
  constexpr double along = 0.3;  // cosine: closer normals have one orientation
  const Vec3 middle = lerp(a, b, 0.5);
  const double r = norm(b - a);
  bool faces_m = false, faces_n = false;
  reference_tree.overlapping({middle - Vec3{r, r, r}, middle + Vec3{r, r, r}}, [&](int t) {
    const Vec3 face = area_vector(reference, t);
    const double length = norm(face);
    faces_m |= dot(face, m) > along * length;
    faces_n |= dot(face, n) > along * length;
  });
  return !(faces_m && faces_n);
}

}  // namespace meshpipe
