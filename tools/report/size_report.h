// SPDX-License-Identifier: BSD-3-Clause
// What msize says of its field.
#pragma once
#include <string>
#include <vector>

#include "lib/size/size.h"

namespace meshpipe {

/// Returns whether the field asks for the number of triangles that was requested; bounds may prevent that.
bool met_count(const SizeReport& report, const SizeOptions& options);

/// Returns lines for the user: the sizes, and where they differ from what was requested. `counted`: the
/// number of triangles was requested by the user.
std::vector<std::string> size_lines(const SizeReport& report, const SizeOptions& options, bool counted);

}  // namespace meshpipe
