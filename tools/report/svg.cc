// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/svg.h"

#include <cstdio>

#include "formats/text.h"

namespace meshpipe {
namespace {

std::string places(const char* x, const char* y, Vec2 p) {
  return svg_number(x, p.x) + ' ' + svg_number(y, p.y);
}

std::string box(Vec2 corner, Vec2 size) {
  return places("x", "y", corner) + ' ' + places("width", "height", size);
}

}  // namespace

std::string svg_number(const char* name, double value) {
  char text[80];
  std::snprintf(text, sizeof text, "%s=\"%.6g\"", name, value);
  return text;
}

void SvgPath::add(char command, Vec2 p) {
  char text[64];
  data_.append(text, std::snprintf(text, sizeof text, "%c%.*g %.*g", command, digits_, p.x, digits_, p.y));
}

Svg::Svg(double width, double height, const std::string& attributes, bool fixed_size) {
  char box[80];
  std::snprintf(box, sizeof box, " viewBox=\"0 0 %.6g %.6g\" ", width, height);
  out_ = "<svg xmlns=\"http://www.w3.org/2000/svg\"";
  if (fixed_size) out_ += ' ' + places("width", "height", {width, height});
  out_ += box + attributes + ">\n<rect width=\"100%\" height=\"100%\" fill=\"white\" stroke=\"none\"/>\n";
}

void Svg::element(const std::string& name, const std::string& attributes) {
  out_ += '<' + name + ' ' + attributes + "/>\n";
}

void Svg::path(const SvgPath& path, const std::string& attributes) {
  if (!path.data().empty()) element("path", attributes + " d=\"" + path.data() + '"');
}

void Svg::text(Vec2 at, const std::string& words, const std::string& attributes) {
  out_ += "<text " + places("x", "y", at) + ' ' + attributes + '>' + xml_escaped(words) + "</text>\n";
}

void Svg::circle(Vec2 center, double radius, const std::string& attributes) {
  element("circle", places("cx", "cy", center) + ' ' + svg_number("r", radius) + ' ' + attributes);
}

void Svg::rectangle(Vec2 corner, Vec2 size, const std::string& attributes) {
  element("rect", box(corner, size) + ' ' + attributes);
}

void Svg::image(Vec2 corner, Vec2 size, const std::string& file) {
  element("image", box(corner, size) + " href=\"" + xml_escaped(file) + '"');
}

void Svg::begin_group(const std::string& attributes) { out_ += "<g " + attributes + ">\n"; }
void Svg::end_group() { out_ += "</g>\n"; }

void Svg::clip(const std::string& id, Vec2 corner, Vec2 size) {
  out_ += "<clipPath id=\"" + id + "\">\n";
  rectangle(corner, size, "");
  out_ += "</clipPath>\n";
}

std::string Svg::finish() { return std::move(out_) + "</svg>\n"; }

}  // namespace meshpipe
