// SPDX-License-Identifier: BSD-3-Clause
// The tables of charts and lines in the stream: chart_vertex; line, line_use and line_vertex.
#pragma once
#include "formats/stream.h"
#include "lib/lines.h"

namespace meshpipe {

/// The charts that mparam wrote, in part order. Throws NotAdmissible if it has not run, BadInput if a row is
/// missing.
std::vector<Chart> read_charts(const Stream& stream);

/// Adds or replaces the table chart_vertex.
void write_charts(Stream& stream, const std::vector<Chart>& charts);

/// The lines that mlines wrote; every index checked. They index the surface, or its reference once it was
/// lifted. Throws NotAdmissible if the tables are not there, BadInput naming the row that is wrong.
Lines read_lines(const Stream& stream);

/// Adds or replaces the tables line, line_use and line_vertex.
void write_lines(Stream& stream, const Lines& lines);

}  // namespace meshpipe
