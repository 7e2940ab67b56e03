// SPDX-License-Identifier: BSD-3-Clause
// The tables of charts and lines in the stream: chart_vertex; line, line_use and line_vertex.
#pragma once
#include "formats/stream.h"
#include "lib/lines/lines.h"

namespace meshpipe {

/// Reads the charts that mparam wrote, in the order of parts.
/// Throws: NotAdmissible if it has not run; BadInput if a row is missing.
std::vector<Chart> read_charts(const Stream& stream);

/// Adds or replaces the table chart_vertex.
void write_charts(Stream& stream, const std::vector<Chart>& charts);

/// Reads the lines that mlines wrote. They index the surface, or its reference from mlift on.
/// Throws: NotAdmissible if the tables are missing; BadInput with the row of a wrong index.
Lines read_lines(const Stream& stream);

/// Adds or replaces the tables line, line_use and line_vertex.
void write_lines(Stream& stream, const Lines& lines);

}  // namespace meshpipe
