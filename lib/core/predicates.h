// SPDX-License-Identifier: BSD-3-Clause
// Exact signs of the geometric determinants (Shewchuk 1997): a floating-point filter, then expansion
// arithmetic.
#pragma once
#include "lib/core/vec.h"

namespace meshpipe {

/// Returns +1 if a, b, c turn left, -1 if they turn right, 0 if they are collinear.
int orient2d(Vec2 a, Vec2 b, Vec2 c);
/// Returns +1 if d lies inside the circle through a, b, c, which turn left, -1 if outside, 0 if on it.
int incircle(Vec2 a, Vec2 b, Vec2 c, Vec2 d);
/// Returns +1 if d lies below the plane of a, b, c (above is where a, b, c are seen to turn left), -1 if
/// above, 0 if in it.
int orient3d(Vec3 a, Vec3 b, Vec3 c, Vec3 d);

}  // namespace meshpipe
