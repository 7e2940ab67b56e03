// SPDX-License-Identifier: BSD-3-Clause
// Exact signs of the geometric determinants (Shewchuk 1997): a floating-point filter, then expansion
// arithmetic.
#pragma once
#include "lib/core/vec.h"

namespace meshpipe {

/// +1 if a, b, c turn left, -1 right, 0 collinear.
int orient2d(Vec2 a, Vec2 b, Vec2 c);
/// +1 if d lies inside the circle through a, b, c (which turn left), -1 outside, 0 on it.
int incircle(Vec2 a, Vec2 b, Vec2 c, Vec2 d);
/// +1 if d lies below the plane of a, b, c (seen from above a, b, c turn left), -1 above, 0 coplanar.
int orient3d(Vec3 a, Vec3 b, Vec3 c, Vec3 d);

}  // namespace meshpipe
