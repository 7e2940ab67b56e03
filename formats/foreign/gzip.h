// SPDX-License-Identifier: BSD-3-Clause
// Files that gzip has compressed (RFC 1952).
#pragma once
#include <string>
#include <string_view>

namespace meshpipe {

bool is_gzip(std::string_view bytes);

/// Returns what was compressed; of several members in a row all. `where` as in read_any.
/// Throws: BadInput if the bytes are damaged or end early, or if there are more than 4 GiB in them.
std::string unzip(std::string_view bytes, const std::string& where);

}  // namespace meshpipe
