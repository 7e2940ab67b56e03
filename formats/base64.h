// SPDX-License-Identifier: BSD-3-Clause
// Bytes in base64, as the XML formats of VTK hold them.
#pragma once
#include <string>
#include <string_view>

namespace meshpipe {

void append_base64(std::string& out, std::string_view bytes);

/// Takes bytes out of base64 text piece by piece; blanks and line ends are skipped, padding may come within.
class Base64 {
 public:
  explicit Base64(std::string_view text) : text_(text) {}
  /// Appends n bytes, or as many as there are; false if there are fewer.
  bool take(std::size_t n, std::string& out);
  /// No more bytes than this can be left.
  std::size_t most() const { return (text_.size() + 3) / 4 * 3 + held_.size(); }

 private:
  bool quad();  ///< the next four digits into held_

  std::string_view text_;
  std::string held_;  ///< decoded and not yet taken: at most two bytes between calls
};

}  // namespace meshpipe
