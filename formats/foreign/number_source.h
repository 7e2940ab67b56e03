// SPDX-License-Identifier: BSD-3-Clause
// Numbers of formats that have a text and a binary encoding with the same order of values.
#pragma once
#include <string>
#include <string_view>

#include "formats/foreign/bytes.h"
#include "formats/text.h"

namespace meshpipe {

/// Takes numbers as words of a text or from bytes. Every failure throws BadInput with the line, or the byte.
class NumberSource {
 public:
  NumberSource(std::string_view bytes, const std::string& where, char comment = 0)
      : text(bytes, where, comment), bytes_(bytes), where_(where) {}

  /// Takes one binary value; `what` is for the message.
  template <class T>
  T get(const char* what) {
    if (left() < sizeof(T)) ends(what, sizeof(T));
    const T value = load<T>(text.after().data(), swap);
    text.skip(sizeof(T));
    return value;
  }
  /// Takes the next value: a word of the line in a text, 4 or 8 bytes in a binary file. `what` is for the
  /// message.
  int integer(const char* what) { return binary ? get<int>(what) : text.integer(what); }
  long long wide(const char* what) { return binary ? get<long long>(what) : text.wide(what); }
  double real(const char* what);
  Vec3 point();
  /// Takes a count of things of at least that many bytes each, or fails if the file cannot hold them; of 8
  /// bytes if `is_wide`.
  int count(const char* what, bool is_wide, std::size_t least_binary, std::size_t least_text);
  /// Skips n bytes of a binary file.
  void skip(std::size_t n, const char* what);

  /// Returns the number of bytes after the current line of a text, or after the value last taken.
  std::size_t left() const { return text.after().size(); }
  /// Returns the position of the next byte of a binary file.
  std::size_t position() const { return bytes_.size() - left(); }
  [[noreturn]] void fail(const std::string& what) const;
  /// Returns `x`, which was just taken; fails unless it is finite.
  double finite(double x, const char* what) const;

  Text text;
  bool binary = false;
  bool swap = false;  ///< the bytes are of the other order

 private:
  [[noreturn]] void ends(const char* what, std::size_t n) const;

  std::string_view bytes_;
  std::string where_;
};

}  // namespace meshpipe
