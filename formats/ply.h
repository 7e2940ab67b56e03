// SPDX-License-Identifier: BSD-3-Clause
// PLY as other programs write it: any order of elements, any types, text and both byte orders, polygons.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

bool is_ply(std::string_view bytes);
/// The elements vertex and face; all others are skipped, and so are all columns but x y z, the list of
/// corners and an integral face column `patch`. Names of patches in comments, as in the stream, are kept.
Stream read_ply(std::string_view bytes, const std::string& where);
/// Only vertices and faces, with `patch` and, if there, red green blue: what every reader of PLY takes.
std::string write_ply(const Stream& stream, bool ascii);

}  // namespace meshpipe
