// SPDX-License-Identifier: BSD-3-Clause
// Text formats: lines, words and numbers read without copies, and numbers written without loss.
#pragma once
#include <string>
#include <string_view>

#include "lib/core/vec.h"

namespace meshpipe {

/// Returns the text without blanks at either end.
std::string_view trim(std::string_view text);
/// Returns whether a word is `lower`, which is in lower case, ignoring the case of ASCII letters.
bool same_word(std::string_view word, std::string_view lower);

/// A cursor over the lines of a text. Blanks are space, tab and carriage return, so that CRLF files need no
/// care. Every failure throws BadInput "WHERE:LINE: message".
class Text {
 public:
  /// Starts before the first line. `where`: the name of the file; `comment`: starts a comment that runs to
  /// the end of the line, 0: there are none.
  Text(std::string_view bytes, std::string where, char comment = 0);

  /// Moves to the next line that holds a word; returns false at the end.
  bool next_line();
  /// Moves to the next line that holds a word, which must exist; `what` (item i of n) is for the message.
  void need_line(const char* what, int i = -1, int n = -1);
  /// Drops the rest of the line and the n bytes after it, which are no text. Requires: there are n bytes.
  void skip(std::size_t n);

  /// Takes the next word of the line; empty at its end.
  std::string_view word();
  /// Returns the next word without taking it.
  std::string_view peek() const;
  /// Takes the rest of the line, without blanks at either end; with `comment` also what would be one: names
  /// may hold the character.
  std::string_view rest(bool comment = false);
  bool line_ends() const;
  /// Takes the next word of the line as a finite number; `what` is for the message.
  double number(const char* what);
  /// Takes the next word of the line as an int, or as an integer of 64 bits.
  int integer(const char* what);
  long long wide(const char* what);
  /// Takes the next word of the line as a count of things of at least `least` bytes each: neither negative
  /// nor more than the text can hold.
  int count(const char* what, std::size_t least);
  /// Takes the next word if it is an int, alone or (with `slash`) before a "/" and more; else returns false.
  bool leading_integer(int& value, bool slash = true);
  /// Returns whether the next word is a NaN as C writes it: "nan", "-NaN", "nan(ind)".
  bool at_nan() const;

  std::size_t line() const { return line_; }
  /// Returns the number of bytes left in the current line, and the bytes after the line.
  std::size_t rest_size() const { return left_.size(); }
  std::string_view after() const { return bytes_; }
  /// Returns "WHERE:LINE: what".
  std::string here(const std::string& what) const {
    return where_ + ':' + std::to_string(line_) + ": " + what;
  }
  [[noreturn]] void fail(const std::string& what) const { fail_at(line_, what); }
  [[noreturn]] void fail_at(std::size_t line, const std::string& what) const;

 private:
  std::string_view bytes_, left_;  ///< bytes_: after the current line; left_: of the current line
  std::string where_;
  char comment_;
  std::size_t line_ = 0;
};

/// Takes the next word, on whatever line it is; "" at the end of the text.
std::string_view next_word(Text& text);
/// Takes the next word, on whatever line it is, as a number or an int.
double next_number(Text& text, const char* what);
int next_integer(Text& text, const char* what);
/// Takes the next three words of the line as a point.
Vec3 next_point(Text& text);

/// Parses the whole of a word as a finite decimal number, as C or Fortran write it, also with a leading +.
/// Returns whether it is one.
bool parse_number(std::string_view word, double& value);
bool parse_integer(std::string_view word, long long& value);

/// Returns the word in quotes for a message: shortened if long, control characters replaced.
std::string quoted(std::string_view word);
/// Encodes blanks, % and all that is not printable ASCII as %XX, for names in a PLY header; and decodes it.
std::string percent_encode(std::string_view text);
std::string percent_decode(std::string_view text);
/// Returns a name for formats with one name per line: control characters become blanks, and blanks at the
/// ends go.
std::string one_line(std::string_view name);
/// Returns text for an attribute or element of XML, in UTF-8; bytes that are not UTF-8 are taken as Latin 1.
std::string xml_escaped(std::string_view text);

/// Appends the shortest text that reads back as the same number.
void append(std::string& out, double value);
void append(std::string& out, long long value);
/// Appends `before`, "x y z" and a line end.
void append_point(std::string& out, const char* before, Vec3 p);

}  // namespace meshpipe
