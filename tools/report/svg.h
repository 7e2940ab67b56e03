// SPDX-License-Identifier: BSD-3-Clause
// SVG documents, built piece by piece.
#pragma once
#include <string>

#include "lib/core/vec.h"

namespace meshpipe {

/// The data of a path: "M x y L x y ...". Numbers have `digits` significant digits.
class SvgPath {
 public:
  explicit SvgPath(int digits = 6) : digits_(digits) {}
  void move_to(Vec2 p) { add('M', p); }
  void line_to(Vec2 p) { add('L', p); }
  void close() { data_ += 'Z'; }
  const std::string& data() const { return data_; }

 private:
  void add(char command, Vec2 p);
  std::string data_;
  int digits_;
};

/// A document of width x height units on a white ground. Attributes are written as SVG has them:
/// `fill="none" stroke="black"`.
class Svg {
 public:
  /// Starts a picture; `attributes` are those of the root. With `fixed_size` it has that many pixels by
  /// default.
  Svg(double width, double height, const std::string& attributes, bool fixed_size = false);

  /// Adds a path; nothing if it is empty.
  void path(const SvgPath& path, const std::string& attributes);
  /// Adds text, whose special characters are escaped.
  void text(Vec2 at, const std::string& words, const std::string& attributes = "");
  void circle(Vec2 center, double radius, const std::string& attributes);
  void rectangle(Vec2 corner, Vec2 size, const std::string& attributes);
  /// Adds the picture of another file.
  void image(Vec2 corner, Vec2 size, const std::string& file);
  /// Begins and ends a group of elements with common attributes.
  void begin_group(const std::string& attributes);
  void end_group();
  /// Defines a rectangle that groups are clipped to by `clip-path="url(#id)"`.
  void clip(const std::string& id, Vec2 corner, Vec2 size);
  /// Ends the document and returns it.
  std::string finish();

 private:
  void element(const std::string& name, const std::string& attributes);
  std::string out_;
};

/// Returns `name="value"`, the number with six significant digits.
std::string svg_number(const char* name, double value);

}  // namespace meshpipe
