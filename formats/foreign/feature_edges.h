// SPDX-License-Identifier: BSD-3-Clause
// Files of lines alone, for programs that want feature edges apart from the surface.
#pragma once
#include <string>

#include "formats/stream.h"

namespace meshpipe {

/// Writes the model edges of a surface as text, by the extension of `path`: lines of OBJ, POLYDATA of legacy
/// VTK with cell data `tag`, or the .eMesh of OpenFOAM. Edges with equal labels follow each other. Throws:
/// BadUsage for any other extension; NotAdmissible if the surface has no model edges.
std::string write_feature_edges(const Stream& stream, const std::string& path);

}  // namespace meshpipe
