// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/nastran.h"

#include <charconv>

#include "formats/foreign/polygons.h"
#include "formats/text.h"
#include "lib/core/error.h"

namespace meshpipe {
namespace {

constexpr long long largest = 99999999;  ///< number that fits a field of 8 columns

/// Appends a word and blanks up to `width`.
void field(std::string& out, std::string_view word, std::size_t width) {
  out += word;
  out.append(width - word.size(), ' ');
}

void integer(std::string& out, long long v, std::size_t width = 8) {
  if (v > largest)
    throw CannotWrite("number " + std::to_string(v) +
                      " does not fit the 8 columns of nastran, the largest is " + std::to_string(largest));
  field(out, std::to_string(v), width);
}

/// Appends a real number in 16 columns, with the digits that fit. It needs a point; the e of an exponent is
/// left out where one digit more then fits, as the format allows.
void real(std::string& out, double v) {
  char buffer[64];
  for (int digits = 17;; --digits) {
    const std::to_chars_result r =
        digits == 17 ? std::to_chars(buffer, buffer + sizeof buffer, v)
                     : std::to_chars(buffer, buffer + sizeof buffer, v, std::chars_format::general, digits);
    std::string word(buffer, r.ptr);
    const std::size_t e = word.find('e');
    if (word.find('.') == std::string::npos) word.insert(e == std::string::npos ? word.size() : e, 1, '.');
    if (word.size() > 16 && e != std::string::npos) word.erase(word.find('e'), 1);
    if (word.size() <= 16) return field(out, word, 16);
  }
}

}  // namespace

std::string write_nastran(const Stream& stream, bool) {
  const Surface& s = stream.surface;
  const std::vector<int> patch = patches_of(stream);
  const ByPatch by = by_patch(stream);
  const long long shift = shift_to_positive(by);
  std::string out = "CEND\nBEGIN BULK\n";
  out.reserve(s.points.size() * 120 + s.tris.size() * 49);
  for (int tag : by.tags)
    if (const std::string name = one_line(stream.name_of(2, tag)); !name.empty())
      out += "$ property " + std::to_string(tag + shift) + ": " + name.substr(0, 50) + '\n';
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    field(out, "GRID*", 8);
    integer(out, static_cast<long long>(i) + 1, 16);
    field(out, "", 16);
    real(out, s.points[i].x);
    real(out, s.points[i].y);
    out += '\n';
    field(out, "*", 8);
    real(out, s.points[i].z);
    out += '\n';
  }
  for (std::size_t t = 0; t < s.tris.size(); ++t) {
    field(out, "CTRIA3", 8);
    integer(out, static_cast<long long>(t) + 1);
    integer(out, patch[t] + shift);
    for (int v : s.tris[t]) integer(out, v + 1LL);
    out += '\n';
  }
  return out + "ENDDATA\n";
}

}  // namespace meshpipe
