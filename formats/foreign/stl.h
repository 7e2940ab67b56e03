// SPDX-License-Identifier: BSD-3-Clause
// STL: triangles without numbering, in solids. Text files may hold several solids; binary ones hold one.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

/// Recognizes a binary file by its size, 84 + 50 n bytes for the declared count n, whatever its first word.
bool is_binary_stl(std::string_view bytes);
bool is_stl(std::string_view bytes);
/// Recognizes a readable binary file of another size: with bytes after its triangles, or with the count 0 or
/// -1 of writers that did not know it. To be asked after all other formats.
bool is_odd_stl(std::string_view bytes);
/// Returns why bytes that look binary are no binary STL, with both sizes; "" if they are text.
std::string binary_stl_mismatch(std::string_view bytes);
/// Reads text or binary. Corners with equal coordinates become one vertex, numbered in order of appearance;
/// each solid becomes a patch, numbered from 1, with its name.
Stream read_stl(std::string_view bytes, const std::string& where);
/// Returns why single precision does not hold the surface: a coordinate beyond its range, or the number of
/// vertices that become equal and of triangles that degenerate; "" if it does. Time n log n.
std::string beyond_single_precision(const Surface& s);
/// Writes binary in single precision without patches (see beyond_single_precision), or text with one solid
/// per patch and all digits.
std::string write_stl(const Stream& stream, bool ascii);

}  // namespace meshpipe
