// SPDX-License-Identifier: BSD-3-Clause
// The formats of INRIA's Medit, which mmg speaks: .mesh (text), .meshb (binary), and .sol for sizes.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

bool is_inria(std::string_view bytes);
/// Triangles and quadrilaterals; references are patches, and of vertices column `ref`. Every edge, ridge or
/// not, is a model edge. Corners, required vertices and required triangles are uchar columns `corner` and
/// `required`. Left out: volumes, normals, tangents, references of edges and which of them are required.
/// SolAtVertices become a column `size` if they are one positive number each, else `sol`, `sol.0` ...
Stream read_inria(std::string_view bytes, const std::string& where);
/// Adds the values of a .sol file to the vertices. Throws BadInput if it is for another number of vertices.
void read_sol(Stream& stream, std::string_view bytes, const std::string& where);

/// .mesh is text and .meshb binary (version 3), whatever `ascii` says. Model edges are edges of reference 0
/// and ridges.
std::string write_mesh(const Stream& stream, bool ascii);
std::string write_meshb(const Stream& stream, bool ascii);
/// Vertex column `size`, as mmg reads sizes. Throws NotAdmissible if there is none.
std::string write_sol(const Stream& stream, bool ascii);

}  // namespace meshpipe
