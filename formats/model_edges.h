// SPDX-License-Identifier: BSD-3-Clause
// The stream's table model_edge: model edges by the coordinates of their ends, from the file they came in to
// the programs that need them, past those that renumber.
#pragma once
#include "formats/stream.h"
#include "lib/model_edges.h"

namespace meshpipe {

/// The model edges of a mesh that was just read (see set_model_lines).
ModelSegments segments_of(const Stream& mesh);

/// The table as segments; none if it is not there.
ModelSegments read_model_edges(const Stream& stream);

/// Replaces the table; drops it if there are no segments.
void write_model_edges(Stream& stream, const ModelSegments& segments);

/// Adds the segments of `more`.
void append(ModelSegments& segments, const ModelSegments& more);

}  // namespace meshpipe
