// SPDX-License-Identifier: BSD-3-Clause
// OFF, the Geomview format: vertices and polygons, in text or binary.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

/// Recognizes OFF with or without colors, normals and texture coordinates (COFF, NOFF, STOFF ...).
bool is_off(std::string_view bytes);
/// Reads text, or binary of either byte order; keeps colors. Faces get patch 0: the format has no groups.
Stream read_off(std::string_view bytes, const std::string& where);
/// Writes text: COFF if vertices have colors; colors of faces after their corners.
std::string write_off(const Stream& stream, bool ascii);

}  // namespace meshpipe
