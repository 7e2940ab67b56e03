// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/colors.h"

#include <cmath>
#include <string_view>
#include <system_error>

#include "lib/core/number.h"

namespace meshpipe {

bool rest_of_line(Text& text, std::vector<double>& channels) {
  channels.clear();
  bool whole = true, given = true;
  while (!text.line_ends()) {
    const std::string_view w = text.peek();
    double x;
    whole = whole && w.find_first_of(".eE") == std::string_view::npos;
    if (w.find_first_of("nN") != std::string_view::npos &&
        from_chars(w.data(), w.data() + w.size(), x).ec == std::errc() && std::isnan(x)) {
      text.word();
      given = false;
    } else {
      channels.push_back(text.number("a color"));
    }
  }
  if (!given) channels.clear();
  return whole;
}

void Colors::add(const double* c, std::size_t n, bool whole) {
  if (n != 3 && n != 4) return;
  for (int k = 0; k < 3; ++k) {
    const double x = whole ? c[k] : 255 * c[k];
    rgb_.push_back(x >= 0 ? static_cast<std::uint8_t>(std::lround(std::min(x, 255.0))) : 0);  // 0 for nan too
  }
}

void Colors::give(Stream& stream, Table& table, std::size_t rows) {
  if (rgb_.empty()) return;
  if (rgb_.size() == 3 * rows)
    add_columns(stream, table, rows, {"color", 3, std::move(rgb_)});
  else
    leave_out(stream, table, "color",
              "given for " + std::to_string(rgb_.size() / 3) + " of " + std::to_string(rows));
}

Rgb::Rgb(const Table& table) {
  static constexpr const char* names[] = {"red", "green", "blue"};
  for (int k = 0; k < 3; ++k) {
    const Column* c = table.find(names[k]);
    channel_[k] = c ? std::get_if<std::vector<std::uint8_t>>(&c->data) : nullptr;
  }
}

void Rgb::append_to(std::string& out, std::size_t row, bool whole) const {
  for (const auto* c : channel_) {
    out += ' ';
    if (whole)
      append(out, static_cast<long long>((*c)[row]));
    else
      append(out, std::round((*c)[row] / 255.0 * 1e4) / 1e4);  // digits enough to read the byte back
  }
}

}  // namespace meshpipe
