// SPDX-License-Identifier: BSD-3-Clause
// OBJ, the Wavefront format: vertices and polygons in text, in groups, objects and materials.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

bool is_obj(std::string_view bytes);
/// Patches, numbered from 1 in order of appearance, are the groups ('g') if these tell faces apart, else the
/// objects ('o'), else the materials ('usemtl'); faces before the first one are patch 0. Colours after the
/// coordinates of all vertices are kept.
Stream read_obj(std::string_view bytes, const std::string& where);
/// A group for each patch, unless there is only one and it has no name.
std::string write_obj(const Stream& stream, bool ascii);

}  // namespace meshpipe
