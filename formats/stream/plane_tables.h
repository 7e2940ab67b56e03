// SPDX-License-Identifier: BSD-3-Clause
// The plane meshes of the charts in the stream: chart_point and chart_face.
#pragma once
#include "formats/stream.h"
#include "lib/mesh2d/mesh2d.h"

namespace meshpipe {

/// Reads the plane meshes that mmesh2d wrote, in the order of parts, with places in triangles of the charts.
/// Throws: NotAdmissible if it has not run; BadInput with the row that is wrong.
std::vector<PlaneMesh> read_plane_meshes(const Stream& stream, const std::vector<Chart>& charts);

/// Adds or replaces the tables chart_point and chart_face.
void write_plane_meshes(Stream& stream, const std::vector<Chart>& charts,
                        const std::vector<PlaneMesh>& meshes);

}  // namespace meshpipe
