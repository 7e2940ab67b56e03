// SPDX-License-Identifier: BSD-3-Clause
// The formats of INRIA's Medit, which mmg reads: .mesh (text), .meshb (binary), and .sol and .solb for sizes.
#pragma once
#include "formats/stream.h"

namespace meshpipe {

bool is_inria(std::string_view bytes);
/// Reads triangles and quadrilaterals. References become patches, and column `ref` of vertices; edges become
/// model edges, labeled by their references (set_model_lines); corners, required vertices and triangles
/// become columns `corner` and `required`; SolAtVertices becomes `size` if it is one positive number each,
/// else `sol`. Without faces the outer ones of volumes are read. Normals and tangents are left out.
Stream read_inria(std::string_view bytes, const std::string& where);
/// Adds the values of a .sol or .solb file to the vertices. Throws: BadInput if there is not one for each
/// vertex.
void read_sol(Stream& stream, std::string_view bytes, const std::string& where);

/// Writes text (.mesh), or binary of version 3 (.meshb); `ascii` is ignored. Model edges become edges, with
/// the label of their line as reference, and ridges.
std::string write_mesh(const Stream& stream, bool ascii);
std::string write_meshb(const Stream& stream, bool ascii);
/// Writes vertex column `size` as mmg reads it, in text (.sol) or binary (.solb). Throws: NotAdmissible
/// without it.
std::string write_sol(const Stream& stream, bool ascii);
std::string write_solb(const Stream& stream, bool ascii);

}  // namespace meshpipe
