// SPDX-License-Identifier: BSD-3-Clause
// Lines of foreign files along edges of their surface (line elements, ridges), as model edges of the stream.
#pragma once
#include <vector>

#include "formats/stream.h"

namespace meshpipe {

/// An edge of the surface on a line of the model, with its label (0: none) and its marks in Medit's files.
struct LineEdge {
  int a, b, tag;
  bool ridge = true, required = false;
};

/// Adds edges to face column `model`, on both sides. If any has a label, or is not just a ridge, the tables
/// line and line_vertex get them too: consecutive edges of equal label and marks as one line, with columns
/// `ridge` and `required` where these distinguish lines. Edges of no triangle are left out, with a remark; if
/// there are no triangles at all, table model_edge gets the edges. Requires the faces.
void set_model_lines(Stream& stream, const std::vector<LineEdge>& edges);

/// Returns every model edge of the surface once, and border edges with a label. Labels come from the tables
/// of lines if these index this surface (edges are then in their order) or if it is remeshed, else from table
/// model_edge.
std::vector<LineEdge> model_lines(const Stream& stream);

}  // namespace meshpipe
