// SPDX-License-Identifier: BSD-3-Clause
// Names of a vessel's ends that a user writes down.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "lib/cap/cap.h"

namespace meshpipe {

/// Reads one end per line: a name, then the coordinates of a point near the end, or nothing for the next end
/// in the order of area. What follows # is a comment.
/// Throws: BadInput with the line, for other words, and for a name that is used twice.
std::vector<EndName> read_end_names(std::string_view bytes, const std::string& where);

}  // namespace meshpipe
