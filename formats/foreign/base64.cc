// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/base64.h"

#include <array>

namespace meshpipe {
namespace {

constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr unsigned char padding = 64, blank = 65, wrong = 66;

constexpr std::array<unsigned char, 256> values = [] {
  std::array<unsigned char, 256> v{};
  v.fill(wrong);
  for (unsigned char i = 0; i < 64; ++i) v[static_cast<unsigned char>(digits[i])] = i;
  v['='] = padding;
  for (char c : {' ', '\t', '\r', '\n'}) v[static_cast<unsigned char>(c)] = blank;
  return v;
}();

}  // namespace

void append_base64(std::string& out, std::string_view bytes) {
  const std::size_t n = bytes.size();
  auto byte = [&](std::size_t i) { return i < n ? static_cast<unsigned char>(bytes[i]) : 0u; };
  out.reserve(out.size() + (n + 2) / 3 * 4);
  for (std::size_t i = 0; i < n; i += 3) {
    const unsigned v = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    const char four[] = {digits[v >> 18], digits[v >> 12 & 63], i + 1 < n ? digits[v >> 6 & 63] : '=',
                         i + 2 < n ? digits[v & 63] : '='};
    out.append(four, 4);
  }
}

bool Base64::quad() {
  unsigned v = 0;
  int n = 0, pads = 0;
  while (n < 4) {
    if (text_.empty()) return false;
    const unsigned char d = values[static_cast<unsigned char>(text_.front())];
    if (d == wrong) return false;
    text_.remove_prefix(1);
    if (d == blank) continue;
    if (d == padding ? n < 2 : pads > 0) return false;
    pads += d == padding;
    v = v << 6 | (d & 63);
    ++n;
  }
  const char three[] = {static_cast<char>(v >> 16), static_cast<char>(v >> 8), static_cast<char>(v)};
  held_.append(three, 3 - pads);
  return true;
}

bool Base64::take(std::size_t n, std::string& out) {
  const std::size_t wanted = out.size() + n;
  for (;;) {
    const std::size_t k = std::min(wanted - out.size(), held_.size());
    out.append(held_, 0, k);
    held_.erase(0, k);
    if (out.size() == wanted) return true;
    if (!quad()) return false;
  }
}

}  // namespace meshpipe
