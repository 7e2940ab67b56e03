// SPDX-License-Identifier: BSD-3-Clause
// OFF, the Geomview format: vertices and polygons, in text or binary.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

/// OFF and its kin with colours, normals or texture coordinates (COFF, NOFF, STOFF ...), of which
/// colours are kept; text, or binary of big endian.
bool is_off(std::string_view bytes);
/// Faces get patch 0: the format has no groups.
Stream read_off(std::string_view bytes, const std::string& where);
/// Text; COFF with colours of vertices, and those of faces after their corners.
std::string write_off(const Stream& stream, bool ascii);

}  // namespace meshpipe
