// SPDX-License-Identifier: BSD-3-Clause
// Colors of vertices and faces in text formats, and the columns red green blue.
#pragma once
#include <string>
#include <vector>

#include "formats/foreign/columns.h"
#include "formats/text.h"

namespace meshpipe {

/// Takes the channels left on the line; returns whether all are whole numbers. None if one is nan, as
/// programs write colors that were not set.
bool rest_of_line(Text& text, std::vector<double>& channels);

/// Collects the colors of a table's rows; they are kept if all rows have one.
class Colors {
 public:
  /// Adds the color of the next row: the first three of n = 3 or 4 numbers, up to 255 if they are `whole`,
  /// else up to 1. Any other n means none.
  void add(const double* c, std::size_t n, bool whole);
  /// Adds the columns red green blue to the table of `rows` rows; if only some rows have a color, adds a
  /// remark to the stream instead.
  void give(Stream& stream, Table& table, std::size_t rows);

 private:
  std::vector<std::uint8_t> rgb_;
};

/// Views the columns red green blue of a table, if it has them.
class Rgb {
 public:
  explicit Rgb(const Table& table);
  explicit operator bool() const { return channel_[0] && channel_[1] && channel_[2]; }
  /// Appends " r g b": whole numbers up to 255, or numbers up to 1.
  void append_to(std::string& out, std::size_t row, bool whole) const;

 private:
  const std::vector<std::uint8_t>* channel_[3];
};

}  // namespace meshpipe
