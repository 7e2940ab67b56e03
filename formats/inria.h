// SPDX-License-Identifier: BSD-3-Clause
// The formats of INRIA's Medit, which mmg speaks: .mesh (text), .meshb (binary), and .sol and .solb for
// sizes.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

bool is_inria(std::string_view bytes);
/// Triangles and quadrilaterals; references are patches, and of vertices column `ref`. Every edge is a model
/// edge, with its reference as the label of its line (see set_model_lines). Corners, required vertices and
/// required triangles are uchar columns `corner` and `required`. Left out: volumes, normals, tangents.
/// SolAtVertices become a column `size` if they are one positive number each, else `sol`, `sol.0` ...
Stream read_inria(std::string_view bytes, const std::string& where);
/// Adds the values of a .sol or .solb file to the vertices. Throws BadInput if it is for another number of
/// vertices.
void read_sol(Stream& stream, std::string_view bytes, const std::string& where);

/// .mesh and .sol are text, .meshb and .solb binary (version 3), whatever `ascii` says. Model edges are edges
/// with the label of their line as reference, and ridges.
std::string write_mesh(const Stream& stream, bool ascii);
std::string write_meshb(const Stream& stream, bool ascii);
/// Vertex column `size`, as mmg reads sizes. Throws NotAdmissible if there is none.
std::string write_sol(const Stream& stream, bool ascii);
std::string write_solb(const Stream& stream, bool ascii);

}  // namespace meshpipe
