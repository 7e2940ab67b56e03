// SPDX-License-Identifier: BSD-3-Clause
#include "formats/level_svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace meshpipe {
namespace {

constexpr double size = 900, disk_radius = 400;

/// A square window on a level's plane: what lies at `centre` is drawn at its middle, `scale` times as large.
struct Frame {
  Vec2 middle{size / 2, size / 2};
  double half = size / 2;
  Vec2 centre = {};
  double scale = disk_radius;

  Vec2 operator()(Vec2 p) const {
    return {middle.x + scale * (p.x - centre.x), middle.y - scale * (p.y - centre.y)};
  }
  bool shows(Vec2 a, Vec2 b, Vec2 c) const {  // their box
    const double reach = half / scale;
    return std::min({a.x, b.x, c.x}) < centre.x + reach && std::max({a.x, b.x, c.x}) > centre.x - reach &&
           std::min({a.y, b.y, c.y}) < centre.y + reach && std::max({a.y, b.y, c.y}) > centre.y - reach;
  }
};

void append(std::string& svg, char command, Vec2 p) {
  char text[64];
  // digits enough to zoom in on a set that is a thousandth of the disk
  std::snprintf(text, sizeof text, "%c%.8g %.8g", command, p.x, p.y);
  svg += text;
}

std::string path_of(const Frame& frame, const std::vector<Vec2>& polygon, bool closed) {
  std::string path;
  for (std::size_t i = 0; i < polygon.size(); i++) append(path, i ? 'L' : 'M', frame(polygon[i]));
  return path + (closed ? "Z" : "");
}

void draw(std::string& svg, const std::string& path, const char* style) {
  if (!path.empty())
    svg += "<path vector-effect=\"non-scaling-stroke\" " + std::string(style) + " d=\"" + path + "\"/>\n";
}

std::vector<int> depths(const std::vector<Level>& levels) {
  std::vector<int> depth(levels.size(), 0);
  for (std::size_t l = 0; l < levels.size(); l++)
    if (levels[l].parent >= 0) depth[l] = depth[levels[l].parent] + 1;
  return depth;
}

/// The triangles of a level, in shades of the logarithm of how much they shrink.
void draw_triangles(std::string& svg, const Frame& frame, const FilledDisk& disk, const Level& level) {
  constexpr std::array<const char*, 8> shades{"#f2f7fc", "#dde9f5", "#c3d9ee", "#a3c5e4",
                                              "#7dabd6", "#588fc4", "#3a72ad", "#245490"};
  std::vector<double> shrink(level.tris.size(), 0);
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (std::size_t i = 0; i < level.tris.size(); i++) {
    if (level.tris[i] >= disk.part_tris) continue;
    const Tri &t = disk.tris[level.tris[i]], &c = level.corners[i];
    const double in_space = norm(area_vector(disk.points[t[0]], disk.points[t[1]], disk.points[t[2]]));
    const double in_plane = std::abs(cross(level.uv[c[1]] - level.uv[c[0]], level.uv[c[2]] - level.uv[c[0]]));
    shrink[i] = std::log(std::max(in_space, 1e-300)) - std::log(std::max(in_plane, 1e-300));
    least = std::min(least, shrink[i]);
    most = std::max(most, shrink[i]);
  }
  std::array<std::string, shades.size()> path;
  for (std::size_t i = 0; i < level.tris.size(); i++) {
    const Vec2 corner[3] = {level.uv[level.corners[i][0]], level.uv[level.corners[i][1]],
                            level.uv[level.corners[i][2]]};
    if (level.tris[i] >= disk.part_tris || !frame.shows(corner[0], corner[1], corner[2])) continue;
    const double share = most > least ? (shrink[i] - least) / (most - least) : 0;
    std::string& p = path[std::min<std::size_t>(shades.size() - 1, share * shades.size())];
    for (int k = 0; k < 3; k++) append(p, k ? 'L' : 'M', frame(corner[k]));
    p += 'Z';
  }
  for (std::size_t s = 0; s < shades.size(); s++)
    draw(svg, path[s],
         (std::string("stroke=\"#1d3c5c\" stroke-width=\"0.25\" fill=\"") + shades[s] + '"').c_str());
}

/// Where the zero level of the part's field crosses the triangles of a level.
std::string cut_path(const Frame& frame, const CutMaps& maps, const Level& level) {
  std::string path;
  for (std::size_t i = 0; i < level.tris.size(); i++) {
    if (level.tris[i] >= maps.disk.part_tris) continue;
    const Tri &t = maps.disk.tris[level.tris[i]], &c = level.corners[i];
    if (!frame.shows(level.uv[c[0]], level.uv[c[1]], level.uv[c[2]])) continue;
    char command = 'M';
    for (int k = 0; k < 3; k++) {
      const double a = maps.field[t[k]], b = maps.field[t[(k + 1) % 3]];
      if ((a > 0) == (b > 0)) continue;
      append(path, command, frame(lerp(level.uv[c[k]], level.uv[c[(k + 1) % 3]], a / (a - b))));
      command = 'L';
    }
  }
  return path;
}

void draw_map(std::string& svg, const Frame& frame, const CutMaps& maps, int l,
              const std::vector<std::string>& names) {
  const Level& level = maps.levels[l];
  draw_triangles(svg, frame, maps.disk, level);
  std::vector<std::vector<Vec2>> outline(level.holes.size());
  std::vector<int> hole_of(level.vertex.size(), -1);
  for (std::size_t i = 0; i < level.holes.size(); i++) hole_of[level.holes[i]] = i;
  for (const Tri& c : level.corners)  // a fan's triangles end in its centre, and follow each other
    if (hole_of[c[2]] >= 0) outline[hole_of[c[2]]].push_back(level.uv[c[0]]);
  std::string holes, sets;
  for (const std::vector<Vec2>& o : outline) holes += path_of(frame, o, true);
  for (int child : level.children) sets += path_of(frame, maps.levels[child].border, true);
  draw(svg, holes, "fill=\"#e8e8e8\" stroke=\"#222222\"");
  draw(svg, sets, "fill=\"white\" stroke=\"#b06000\"");
  draw(svg, path_of(frame, maps.lines[l], false), "fill=\"none\" stroke=\"#d01010\" stroke-width=\"2\"");
  draw(svg, cut_path(frame, maps, level), "fill=\"none\" stroke=\"black\" stroke-width=\"1.2\"");
  char text[200];  // marks: small sets and holes would not be seen
  for (int hole : level.holes) {
    const Vec2 c = frame(level.uv[hole]);
    std::snprintf(text, sizeof text, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"#222222\"/>\n", c.x,
                  c.y);
    svg += text;
  }
  for (int child : level.children) {
    const Vec2 c = frame(maps.levels[child].centre);
    std::snprintf(text, sizeof text,
                  "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"8\" fill=\"none\" stroke=\"#b06000\"/>"
                  "<text x=\"%.1f\" y=\"%.1f\" fill=\"#b06000\">%s</text>\n",
                  c.x, c.y, c.x + 11, c.y - 8, names[child].c_str());
    svg += text;
  }
}

/// The neighbourhood of a level's sets, enlarged, in the corner of its picture, if they lie close together.
void draw_enlarged(std::string& svg, const CutMaps& maps, int l, const std::vector<std::string>& names) {
  Vec2 low{HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL};
  for (int child : maps.levels[l].children)
    for (Vec2 p : maps.levels[child].border) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  const double width = std::max(high.x - low.x, high.y - low.y);
  constexpr double inset = 260, close = 0.25;
  if (!(width > 0) || width > close) return;
  const Frame frame{{size - inset / 2, size - inset / 2}, inset / 2, 0.5 * (low + high), 0.7 * inset / width};
  char text[400];
  std::snprintf(text, sizeof text,
                "<clipPath id=\"corner\"><rect x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\"/></clipPath>\n"
                "<g clip-path=\"url(#corner)\"><rect x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\" "
                "fill=\"white\" stroke=\"#222222\" stroke-width=\"3\"/>\n",
                size - inset, size - inset, inset, inset, size - inset, size - inset, inset, inset);
  svg += text;
  draw_map(svg, frame, maps, l, names);
  std::snprintf(text, sizeof text, "<text x=\"%g\" y=\"%g\">x %.3g</text>\n</g>\n", size - inset + 10,
                size - inset + 26, frame.scale / disk_radius);
  svg += text;
}

}  // namespace

std::vector<std::string> level_names(const std::vector<Level>& levels) {
  const std::vector<int> depth = depths(levels);
  std::vector<int> count;
  std::vector<std::string> names;
  for (int d : depth) {
    count.resize(std::max<std::size_t>(count.size(), d + 1), 0);
    names.push_back(std::to_string(d) + "-" + std::to_string(count[d]++));
  }
  return names;
}

std::string level_svg(const CutMaps& maps, int l) {
  const std::vector<std::string> names = level_names(maps.levels);
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 900 900\" font-family=\"sans-serif\" "
      "font-size=\"20\" stroke-linejoin=\"round\">\n<rect width=\"900\" height=\"900\" fill=\"white\"/>\n"
      "<circle cx=\"450\" cy=\"450\" r=\"400\" fill=\"none\" stroke=\"#888888\"/>\n"
      "<text x=\"20\" y=\"36\">level " +
      names[l] + "</text>\n";
  draw_map(svg, {}, maps, l, names);
  draw_enlarged(svg, maps, l, names);
  return svg + "</svg>\n";
}

std::string levels_svg(const std::vector<Level>& levels, const std::vector<std::string>& files) {
  constexpr int cell = 240;
  const std::vector<int> depth = depths(levels);
  std::vector<int> width(levels.size() + 1, 0), column(levels.size());
  for (std::size_t l = 0; l < levels.size(); l++) column[l] = width[depth[l]]++;
  const int columns = *std::max_element(width.begin(), width.end());
  const int rows = 1 + *std::max_element(depth.begin(), depth.end());
  char text[200];
  std::snprintf(text, sizeof text,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\">\n"
                "<rect width=\"%d\" height=\"%d\" fill=\"white\"/>\n",
                cell * columns, cell * rows, cell * columns, cell * rows);
  std::string svg = text;
  for (std::size_t l = 0; l < levels.size(); l++) {
    std::snprintf(text, sizeof text, "<image x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" href=\"",
                  cell * (columns - width[depth[l]]) / 2 + cell * column[l], cell * depth[l], cell, cell);
    svg += text + files[l] + "\"/>\n";
  }
  return svg + "</svg>\n";
}

}  // namespace meshpipe
