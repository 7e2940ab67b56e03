// SPDX-License-Identifier: BSD-3-Clause
// The stream's table model_edge: model edges by the coordinates of their ends, which survive renumbering.
#pragma once
#include "formats/stream.h"
#include "formats/stream/model_lines.h"
#include "lib/feature/feature.h"

namespace meshpipe {

/// Returns edges as segments.
ModelSegments segments_between(const std::vector<Vec3>& points, const std::vector<LineEdge>& edges);

/// Returns the model edges of a mesh that was just read (set_model_lines), or the lines of a file without
/// faces.
ModelSegments segments_of(const Stream& mesh);

/// Reads the table; returns no segments without it.
ModelSegments read_model_edges(const Stream& stream);

/// Replaces the table, or drops it if there are no segments.
void write_model_edges(Stream& stream, const ModelSegments& segments);

/// Adds the segments of `more`.
void append(ModelSegments& segments, const ModelSegments& more);

}  // namespace meshpipe
