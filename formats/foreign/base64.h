// SPDX-License-Identifier: BSD-3-Clause
// Bytes in base64, as the XML formats of VTK hold them.
#pragma once
#include <string>
#include <string_view>

namespace meshpipe {

void append_base64(std::string& out, std::string_view bytes);

/// Decodes base64 text piece by piece. Blanks and line ends are skipped; there may be padding in the middle.
class Base64 {
 public:
  explicit Base64(std::string_view text) : text_(text) {}
  /// Appends the next n bytes to `out`; returns false, and appends all that are left, if there are fewer.
  bool take(std::size_t n, std::string& out);
  /// Returns an upper bound of the bytes that are left.
  std::size_t most() const { return (text_.size() + 3) / 4 * 3 + held_.size(); }

 private:
  bool quad();  ///< decodes the next four digits into held_

  std::string_view text_;
  std::string held_;  ///< decoded and not yet taken: at most two bytes between calls
};

}  // namespace meshpipe
