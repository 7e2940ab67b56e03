// SPDX-License-Identifier: BSD-3-Clause
// OBJ, the Wavefront format: vertices and polygons in text, in groups, objects and materials.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

bool is_obj(std::string_view bytes);
/// Reads faces of any number of corners, lines as model edges, and colors after the coordinates if all
/// vertices have one. Patches are the groups ('g') if these distinguish faces, else the objects ('o'), else
/// the materials
/// ('usemtl'), numbered from 1 in order of appearance; faces before the first are patch 0.
Stream read_obj(std::string_view bytes, const std::string& where);
/// Writes one group per patch, unless there is only one and it has no name.
std::string write_obj(const Stream& stream, bool ascii);

}  // namespace meshpipe
