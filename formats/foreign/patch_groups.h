// SPDX-License-Identifier: BSD-3-Clause
// Groups of patches that a user writes down, to be merged.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "formats/stream.h"

namespace meshpipe {

struct PatchGroup {
  std::string name;  ///< empty: that of the first patch
  std::vector<int> patches;
};

/// Reads one group per line: patches by name, or number if they have none, separated by blanks, after "NAME
/// =" if the group gets a name of its own. Words in double quotes may hold blanks; * ? [ ] are wildcards as
/// in the shell. Lines that begin with # are comments. Words may name patches that have lost all faces.
/// Throws: BadInput with the line for words that name no patch and names of groups that are used twice.
std::vector<PatchGroup> read_groups(std::string_view bytes, const std::string& where, const Stream& stream);

}  // namespace meshpipe
