// SPDX-License-Identifier: BSD-3-Clause
// The lifted mesh in the stream: columns of vertex and face, and the reference surface in ref_vertex and
// ref_face.
#pragma once
#include "formats/stream.h"
#include "lib/lift.h"

namespace meshpipe {

/// The mesh in `vertex` and `face` with each vertex's place on the reference; every index and barycentric
/// checked. Throws NotAdmissible if mlift has not run, BadInput naming the row that is wrong.
LiftedMesh read_lifted(const Stream& stream);

/// Replaces `vertex` and `face` by the mesh and its columns; tables stay but for mid_vertex. The input's own
/// vertex data, which the reference keeps, is interpolated. Precondition: write_reference.
void write_lifted(Stream& stream, const LiftedMesh& mesh);

/// The surface that the mesh was lifted to: face columns patch, part, origin and model,
/// and `curved` if vertices lie on the smooth surface above it (lib/curved.h).
/// Throws NotAdmissible if mlift has not run.
Surface read_reference(const Stream& stream);

/// Adds the tables ref_vertex, with the surface's own vertex data, and ref_face; columns that the surface
/// lacks are 0 (`origin`: the triangle itself).
void write_reference(Stream& stream, const Surface& reference);

}  // namespace meshpipe
