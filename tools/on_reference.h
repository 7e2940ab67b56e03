// SPDX-License-Identifier: BSD-3-Clause
// What mlift and mrelax do with a mesh that lies on its reference before they write it.
#pragma once
#include <string>

#include "formats/stream.h"
#include "lib/lift/lift.h"

namespace meshpipe {

/// Raises the vertices of a mesh to the smooth surface above its reference, if that has face column `curved`,
/// and puts the mesh into the stream, with the nodes of second order if asked. Returns: a description of what
/// had to stay flat or straight; empty if nothing.
std::string write_on_reference(Stream& stream, LiftedMesh mesh, const Surface& reference, bool second_order);

}  // namespace meshpipe
