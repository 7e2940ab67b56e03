// SPDX-License-Identifier: BSD-3-Clause
// PLY as other programs write it: any order of elements, any types, text and both byte orders, polygons.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

bool is_ply(std::string_view bytes);
/// Reads the elements vertex, face and tristrips, with their scalar properties as columns; other elements are
/// skipped. Names of patches in comments are kept, as in the stream.
Stream read_ply(std::string_view bytes, const std::string& where);
/// Writes vertices and faces with their columns and `patch`, without the tables and the mark of a stream.
std::string write_ply(const Stream& stream, bool ascii);

}  // namespace meshpipe
