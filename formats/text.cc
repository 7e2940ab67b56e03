// SPDX-License-Identifier: BSD-3-Clause
#include "formats/text.h"

#include <algorithm>
#include <charconv>
#include <climits>
#include <cmath>
#include <cstdlib>

#include "lib/core/error.h"
#include "lib/core/number.h"

namespace meshpipe {
namespace {

bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r' && c != '\n'); }

std::string_view without_leading_blanks(std::string_view text) {
  std::size_t i = 0;
  while (i < text.size() && is_blank(text[i])) ++i;
  return text.substr(i);
}

std::string_view without_plus(std::string_view word) {
  // from_chars takes no plus sign, and must not see "+-1" as a number
  return word.size() > 1 && word[0] == '+' && word[1] != '-' ? word.substr(1) : word;
}

bool is_utf8(std::string_view text) {
  int following = 0;  // bytes that still belong to the current character
  for (unsigned char c : text) {
    if ((c & 0xC0) == 0x80) {
      if (following-- == 0) return false;
    } else {
      if (following > 0 || c > 0xF4) return false;
      following = c < 0x80 ? 0 : c < 0xE0 ? 1 : c < 0xF0 ? 2 : 3;
    }
  }
  return following == 0;
}

}  // namespace

Text::Text(std::string_view bytes, std::string where, char comment)
    : bytes_(bytes), where_(std::move(where)), comment_(comment) {}

bool Text::next_line() {
  while (!bytes_.empty()) {
    std::size_t end = bytes_.find('\n');
    left_ = bytes_.substr(0, end);
    bytes_.remove_prefix(end == std::string_view::npos ? bytes_.size() : end + 1);
    ++line_;
    if (comment_) left_ = left_.substr(0, left_.find(comment_));
    left_ = without_leading_blanks(left_);
    if (!left_.empty()) return true;
  }
  left_ = {};
  return false;
}

std::string_view Text::peek() const {
  std::string_view left = without_leading_blanks(left_);
  std::size_t n = 0;
  while (n < left.size() && !is_blank(left[n])) ++n;
  return left.substr(0, n);
}

std::string_view Text::word() {
  std::string_view w = peek();
  left_.remove_prefix(w.data() + w.size() - left_.data());
  return w;
}

std::string_view Text::rest(bool comment) {
  if (comment) left_ = {left_.data(), bytes_.data()};
  if (left_.ends_with('\n')) left_.remove_suffix(1);
  std::string_view r = trim(left_);
  left_ = {};
  return r;
}

bool Text::line_ends() const { return without_leading_blanks(left_).empty(); }

double Text::number(const char* what) {
  left_ = without_leading_blanks(left_);
  const char* const end = left_.data() + left_.size();
  double value;
  // from_chars takes almost every number, and the word need not be found first
  if (auto [stop, error] = from_chars(left_.data(), end, value);
      error == std::errc() && (stop == end || is_blank(*stop)) && std::isfinite(value)) {
    left_.remove_prefix(stop - left_.data());
    return value;
  }
  std::string_view w = word();
  if (w.empty()) fail(std::string("expected ") + what + ", found the end of the line");
  if (!parse_number(w, value)) fail(std::string("expected ") + what + ", found " + quoted(w));
  return value;
}

void Text::skip(std::size_t n) {
  left_ = {};
  bytes_.remove_prefix(n);
}

int Text::integer(const char* what) {
  left_ = without_leading_blanks(left_);
  const char* const end = left_.data() + left_.size();
  int small;
  if (auto [stop, error] = from_chars(left_.data(), end, small);
      error == std::errc() && (stop == end || is_blank(*stop))) {
    left_.remove_prefix(stop - left_.data());
    return small;
  }
  const long long value = wide(what);
  if (value < INT_MIN || value > INT_MAX)
    fail(std::string(what) + " is " + std::to_string(value) + ", the limit is " + std::to_string(INT_MAX));
  return static_cast<int>(value);
}

bool Text::at_nan() const {
  const char *at = left_.data(), *const end = at + left_.size();
  while (at < end && is_blank(*at)) ++at;
  if (at < end && (*at == '-' || *at == '+')) ++at;
  if (end - at < 3 || !same_word({at, 3}, "nan")) return false;
  at += 3;
  const char* const word_end = std::find_if(at, end, is_blank);
  // C writes the kind of NaN in parentheses
  return at == word_end || (*at == '(' && word_end[-1] == ')');
}

bool Text::leading_integer(int& value, bool slash) {
  const char *at = left_.data(), *const end = at + left_.size();
  while (at < end && is_blank(*at)) ++at;
  auto [stop, error] = from_chars(at, end, value);
  if (error != std::errc() || (stop < end && !is_blank(*stop) && !(slash && *stop == '/'))) return false;
  while (stop < end && !is_blank(*stop)) ++stop;
  left_.remove_prefix(stop - left_.data());
  return true;
}

long long Text::wide(const char* what) {
  const std::string_view w = word();
  long long value;
  if (w.empty()) fail(std::string("expected ") + what + ", found the end of the line");
  if (!parse_integer(w, value)) fail(std::string("expected ") + what + ", found " + quoted(w));
  return value;
}

int Text::count(const char* what, std::size_t least) {
  int n = integer(what);
  if (n < 0) fail(std::string(what) + " is " + std::to_string(n));
  // the last item may lack its line end
  if (n > 0 && (n - 1) * least >= bytes_.size() + left_.size())
    fail(std::string(what) + " is " + std::to_string(n) + ", but only " + std::to_string(bytes_.size()) +
         " bytes follow");
  return n;
}

void Text::need_line(const char* what, int i, int n) {
  if (next_line()) return;
  std::string which = what;
  if (i >= 0) which += ' ' + std::to_string(i) + " of " + std::to_string(n);
  fail("expected " + which + ", found the end of the file");
}

void Text::fail_at(std::size_t line, const std::string& what) const {
  throw BadInput(where_ + ":" + std::to_string(line) + ": " + what);
}

std::string_view next_word(Text& text) {
  for (;;) {
    if (std::string_view w = text.word(); !w.empty()) return w;
    if (!text.next_line()) return {};
  }
}

double next_number(Text& text, const char* what) {
  if (text.line_ends()) text.need_line(what);
  return text.number(what);
}

int next_integer(Text& text, const char* what) {
  if (text.line_ends()) text.need_line(what);
  return text.integer(what);
}

Vec3 next_point(Text& text) {
  const double x = text.number("a coordinate"), y = text.number("a coordinate"),
               z = text.number("a coordinate");
  return {x, y, z};
}

bool parse_number(std::string_view word, double& value) {
  word = without_plus(word);
  std::string fortran;  // which writes 1.5D+03
  if (const std::size_t d = word.find_first_of("dD"); d != std::string_view::npos && d > 0) {
    fortran = word;
    fortran[d] = 'e';
    if (d + 1 < fortran.size() && fortran[d + 1] == '+') fortran.erase(d + 1, 1);
    word = fortran;
  }
  auto [end, error] = from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || word.empty()) return false;
  // strtod makes too small a number 0 or denormal, and too large a one infinite
  if (error == std::errc::result_out_of_range) value = std::strtod(std::string(word).c_str(), nullptr);
  return error != std::errc::invalid_argument && std::isfinite(value);
}

bool parse_integer(std::string_view word, long long& value) {
  word = without_plus(word);
  auto [end, error] = from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

std::string quoted(std::string_view word) {
  std::string out = "'";
  for (unsigned char c : word.substr(0, 40)) out += c < 32 || c > 126 ? '?' : static_cast<char>(c);
  return out + (word.size() > 40 ? "...'" : "'");
}

std::string_view trim(std::string_view text) {
  text = without_leading_blanks(text);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string percent_decode(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned value = 0;
    const char* const at = text.data() + i;
    if (*at == '%' && i + 2 < text.size() && std::from_chars(at + 1, at + 3, value, 16).ptr == at + 3) {
      out += static_cast<char>(value);
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

std::string percent_encode(std::string_view text) {
  constexpr char hex[] = "0123456789ABCDEF";
  std::string out;
  for (unsigned char c : text) {
    if (c > 32 && c < 127 && c != '%')
      out += static_cast<char>(c);
    else
      out += {'%', hex[c >> 4], hex[c & 15]};
  }
  return out;
}

std::string one_line(std::string_view name) {
  std::string out(name);
  for (char& c : out)
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = ' ';
  return std::string(trim(out));
}

bool same_word(std::string_view word, std::string_view lower) {
  if (word.size() != lower.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i)
    if ((word[i] >= 'A' && word[i] <= 'Z' ? word[i] + 32 : word[i]) != lower[i]) return false;
  return true;
}

void append(std::string& out, double value) {
  char buffer[32];
  out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

void append(std::string& out, long long value) {
  char buffer[24];
  out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

void append_point(std::string& out, const char* before, Vec3 p) {
  out += before;
  append(out, p.x);
  out += ' ';
  append(out, p.y);
  out += ' ';
  append(out, p.z);
  out += '\n';
}

std::string xml_escaped(std::string_view text) {
  const bool utf8 = is_utf8(text);
  std::string out;
  for (char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte > 127 && !utf8)  // then it can only be Latin 1
      out += {static_cast<char>(0xC0 | byte >> 6), static_cast<char>(0x80 | (byte & 63))};
    else if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

}  // namespace meshpipe
