// SPDX-License-Identifier: BSD-3-Clause
// Writing rows of numbers, in text or binary.
#pragma once
#include <string>

#include "formats/bytes.h"
#include "formats/text.h"

namespace meshpipe {

/// Numbers are words with a blank between them in text, and so many bytes in binary; append to `out` what is
/// neither.
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
