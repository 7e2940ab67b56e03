// SPDX-License-Identifier: BSD-3-Clause
// Cutting a part of genus 0 in two of about the same area, whatever its shape.
#pragma once
#include "lib/mesh.h"

namespace meshpipe {

/// Cuts the triangles of `part` (face column `part`) across its long direction: along a level of its Fiedler
/// vector (the slowest vibration of the free part), the shortest among those that leave 30 to 70 % of the
/// area on either side and two connected halves without pinched vertices. The triangles above the level get
/// the label `new_part`. Neighbours are split conformingly. Returns false, and changes nothing, if there is
/// no such level.
bool bisect_part(Surface& surface, int part, int new_part);

}  // namespace meshpipe
