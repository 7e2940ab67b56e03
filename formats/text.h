// SPDX-License-Identifier: BSD-3-Clause
// Lines, words and numbers of a text format, read without copies; and numbers written so that nothing is
// lost.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "lib/vec.h"

namespace meshpipe {

/// Without blanks at either end.
std::string_view trim(std::string_view text);
/// Equal but for upper and lower case of ASCII letters; `lower` is in lower case.
bool same_word(std::string_view word, std::string_view lower);

/// A cursor over the lines of a text that knows where it is. Blanks are space, tab and carriage return, so
/// CRLF files need no care. Every failure is a BadInput "WHERE:LINE: what", with both numbers where there are
/// two.
class Text {
 public:
  /// `comment`: the character that starts a comment running to the line's end, or 0 for none.
  Text(std::string_view bytes, std::string where, char comment = 0);

  /// Moves to the next line that holds a word; false at the end.
  bool next_line();
  /// The next word of the line; empty at its end.
  std::string_view word();
  /// The next word, on whatever line it is; empty at the end of the text.
  std::string_view next_word();
  /// The next word, on whatever line it is, as a number or an int.
  double next_number(const char* what);
  int next_integer(const char* what);
  /// The next word of the line as a whole number, which may be beyond int.
  long long wide(const char* what);
  /// The next word of the line if it is an int, alone or (with `slash`) before a "/", with what follows that;
  /// false for any other, which is left.
  bool leading_integer(int& value, bool slash = true);
  /// Is the next word NaN, of either sign, as C writes it: "nan", "-NaN", "nan(ind)"?
  bool at_nan() const;
  /// Leaves the current line and the n bytes after it, which are not text: no more than there are.
  void skip(std::size_t n);
  /// The next word again.
  std::string_view peek() const;
  /// What is left of the line, without blanks at either end.
  std::string_view rest();
  bool line_ends() const;
  /// The next word of the line as a finite number; `what` names it in the message when it is not one.
  double number(const char* what);
  /// The next three words as a point.
  Vec3 point();
  /// The next word of the line as an int.
  int integer(const char* what);
  /// A count of things that take at least `least` bytes each: not negative, and no more than the text can
  /// hold.
  int count(const char* what, std::size_t least);
  /// Moves to the next line, which must exist: "the file ends where WHAT is due" otherwise, or "WHAT i of n".
  void need_line(const char* what, int i = -1, int n = -1);

  std::size_t line() const { return line_; }
  /// The bytes that are left of the current line.
  std::size_t rest_size() const { return left_.size(); }
  /// The bytes after the current line.
  std::string_view after() const { return bytes_; }
  [[noreturn]] void fail(const std::string& what) const { fail_at(line_, what); }
  [[noreturn]] void fail_at(std::size_t line, const std::string& what) const;

 private:
  std::string_view bytes_, left_;  ///< bytes_: after the current line; left_: of the current line
  std::string where_;
  char comment_;
  std::size_t line_ = 0;
};

/// The whole of `word` as a number: decimal, as C writes them, an initial + included; false for anything
/// else, inf and nan too.
bool parse_number(std::string_view word, double& value);
bool parse_integer(std::string_view word, long long& value);

/// `word` in quotes for a message: cut if long, control characters replaced.
std::string quoted(std::string_view word);
/// Names as the comments of a PLY header hold them: blanks, %, and all but printable ASCII as %XX.
std::string percent_encode(std::string_view text);
std::string percent_decode(std::string_view text);
/// A name as formats with one name a line can hold it: control characters are blanks, none at either end.
std::string one_line(std::string_view name);

/// Appends the shortest text that reads back as the same number.
void append(std::string& out, double value);
void append(std::string& out, long long value);
/// "x y z" after `before`, and a line end.
void append_point(std::string& out, const char* before, Vec3 p);

}  // namespace meshpipe
