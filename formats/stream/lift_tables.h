// SPDX-License-Identifier: BSD-3-Clause
// The lifted mesh in the stream, and its reference surface: tables ref_vertex and ref_face.
#pragma once
#include <optional>

#include "formats/stream.h"
#include "lib/lift/lift.h"

namespace meshpipe {

/// Moves a mesh with each vertex's place out of a surface, on a reference of `faces` triangles and with
/// `lines` lines; the surface loses these columns. Throws: NotAdmissible if mlift has not run; BadInput with
/// the row of a wrong index or weight.
LiftedMesh take_lifted(Surface& surface, int faces, int lines);
/// Returns the mesh as a surface with its columns.
Surface surface_from(LiftedMesh mesh);

/// Replaces `vertex` and `face` by the mesh and drops table mid_vertex. Vertex data of the input is
/// interpolated from the reference. Requires: write_reference was called before.
void write_lifted(Stream& stream, LiftedMesh mesh);

/// Reads the surface that the mesh was lifted to, with face columns patch, part, origin and model, and
/// `curved` if vertices lie on the smooth surface above it. Throws: NotAdmissible if mlift has not run.
Surface read_reference(const Stream& stream);

/// Adds the tables ref_vertex, with the surface's vertex data, and ref_face. Missing columns become 0
/// (`origin`: the triangle itself). Drops the tables of write_fine.
void write_reference(Stream& stream, const Surface& reference);

/// Adds the tables fine_vertex, with the surface's vertex data, and fine_face: the surface that a coarse one
/// stands for.
void write_fine(Stream& stream, const Surface& fine);
/// Takes the surface out of these tables, with its vertex data and face columns patch and model; nothing if
/// mcoarsen has not written them.
std::optional<Surface> take_fine(Stream& stream);

}  // namespace meshpipe
