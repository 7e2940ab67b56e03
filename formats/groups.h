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

/// A group a line: patches by name or number, parted by blanks; before them NAME = if the group is to have
/// another name. A word in double quotes may hold blanks. * ? [ ] stand for others as in the shell, in names
/// and in the numbers of patches without one. Lines that begin with # are skipped; a word may name a patch
/// that has no faces any more. Throws BadInput with the line if it names none, or the name of a group that a
/// line before has.
std::vector<PatchGroup> read_groups(std::string_view bytes, const std::string& where, const Stream& stream);

}  // namespace meshpipe
