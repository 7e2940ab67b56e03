// SPDX-License-Identifier: BSD-3-Clause
// What readers say of damaged files.
#pragma once
#include <string>
#include <string_view>

#include "formats/formats.h"
#include "lib/core/error.h"

namespace meshpipe {

/// The message of the BadInput that reading throws; empty if it succeeds. Any other exception fails the test.
inline std::string failure(std::string_view bytes,
                           Stream (*read)(std::string_view, const std::string&) = read_any) {
  try {
    read(bytes, "in");
    return "";
  } catch (const BadInput& e) {
    return e.what();
  } catch (const UpstreamFailed& e) {
    return "in:1: " + e.program + " failed";
  }
}

}  // namespace meshpipe
