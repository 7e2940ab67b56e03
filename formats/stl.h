// SPDX-License-Identifier: BSD-3-Clause
// STL: triangles without numbering, in solids. Text files may hold several solids; binary ones hold one.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

/// A binary file is told by its size, 84 + 50 n bytes with n the count it declares, whatever its first word.
bool is_binary_stl(std::string_view bytes);
bool is_stl(std::string_view bytes);
/// A binary file whose size is not the one it declares, but may be read: with bytes after its triangles, or
/// with the count 0 or -1 of writers that did not know it. To be asked last, after all other formats.
bool is_odd_stl(std::string_view bytes);
/// Why bytes that look binary are no binary STL, with both sizes; empty if they are text.
std::string binary_stl_mismatch(std::string_view bytes);
/// Corners of triangles at the same place, to the last bit, are one vertex, numbered as they come; each solid
/// is a patch, numbered from 1, with its name.
Stream read_stl(std::string_view bytes, const std::string& where);
/// Why single precision does not hold the surface: a coordinate beyond its range, places of vertices that
/// become one, triangles that become degenerate or turn over, with their number; empty if it does. n log n.
std::string beyond_single_precision(const Surface& s);
/// Binary in single precision (ask before whether that holds the surface), the patches lost, or text with a
/// solid for each patch and all digits.
std::string write_stl(const Stream& stream, bool ascii);

}  // namespace meshpipe
