// SPDX-License-Identifier: BSD-3-Clause
// Files that gzip has compressed (RFC 1952).
#pragma once
#include <string>
#include <string_view>

namespace meshpipe {

bool is_gzip(std::string_view bytes);

/// Returns the uncompressed bytes, of all members if there are several. `where`: as in read_any. Throws:
/// BadInput if the bytes are damaged or end early, or if the result has more than 4 GiB.
std::string unzip(std::string_view bytes, const std::string& where);

}  // namespace meshpipe
