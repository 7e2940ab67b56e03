// SPDX-License-Identifier: BSD-3-Clause
// Lines that foreign files hold along edges of their surface (line elements, ridges): model edges of the
// stream, with their labels in its tables of lines.
#pragma once
#include <vector>

#include "formats/stream.h"

namespace meshpipe {

/// An edge of the surface that belongs to a line of the model, with its label (0: none) and what the files of
/// INRIA say of it.
struct LineEdge {
  int a, b, tag;
  bool ridge = true, required = false;
};

/// Sets the bits of face column `model` for these edges, on both sides. If any has a label, or is not just a
/// ridge, the tables line and line_vertex get them too: edges that follow each other and are alike as one
/// line of points at vertices, with columns `ridge` and `required` if they tell lines apart. Edges that no
/// triangle has are left out, which a remark of the stream says. Precondition: the faces are set.
void set_model_lines(Stream& stream, const std::vector<LineEdge>& edges);

/// Every model edge of the surface once, and those of its border that have a label: with their labels by the
/// tables of lines where these are of this surface (as set_model_lines made them, then in their order; or of
/// a remeshed surface whose vertices know their lines), or else by table model_edge, which holds what was
/// given past programs that renumber.
std::vector<LineEdge> model_lines(const Stream& stream);

}  // namespace meshpipe
