// SPDX-License-Identifier: BSD-3-Clause
// Writing rows of numbers, in text or binary.
#pragma once
#include <string>

#include "formats/foreign/bytes.h"
#include "formats/text.h"

namespace meshpipe {

/// Appends numbers to `out`: words separated by blanks, or binary values of 4 and 8 bytes.
class Rows {
 public:
  explicit Rows(bool ascii) : ascii_(ascii) {}

  void integer(long long v) { ascii_ ? word(v) : put(out, static_cast<int>(v)); }
  void wide(long long v) { ascii_ ? word(v) : put(out, v); }  ///< eight bytes
  void real(double v) { ascii_ ? word(v) : put(out, v); }
  void end_row() {
    if (ascii_) out.back() = '\n';
  }
  bool ascii() const { return ascii_; }

  std::string out;

 private:
  template <class T>
  void word(T v) {
    append(out, v);
    out += ' ';
  }
  bool ascii_;
};

}  // namespace meshpipe
