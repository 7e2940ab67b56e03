// SPDX-License-Identifier: BSD-3-Clause
#include "formats/level_svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace meshpipe {
namespace {

constexpr double size = 900, scale = 400;

void append(std::string& svg, char command, Vec2 p) {
  char text[64];
  // digits enough to zoom in on a set that is a thousandth of the disk
  std::snprintf(text, sizeof text, "%c%.8g %.8g", command, size / 2 + scale * p.x, size / 2 - scale * p.y);
  svg += text;
}

std::string path_of(const std::vector<Vec2>& polygon, bool closed) {
  std::string path;
  for (std::size_t i = 0; i < polygon.size(); i++) append(path, i ? 'L' : 'M', polygon[i]);
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
void draw_triangles(std::string& svg, const FilledDisk& disk, const Level& level) {
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
    if (level.tris[i] >= disk.part_tris) continue;
    const double share = most > least ? (shrink[i] - least) / (most - least) : 0;
    std::string& p = path[std::min<std::size_t>(shades.size() - 1, share * shades.size())];
    for (int k = 0; k < 3; k++) append(p, k ? 'L' : 'M', level.uv[level.corners[i][k]]);
    p += 'Z';
  }
  for (std::size_t s = 0; s < shades.size(); s++)
    draw(svg, path[s],
         (std::string("stroke=\"#1d3c5c\" stroke-width=\"0.25\" fill=\"") + shades[s] + '"').c_str());
}

/// Where the zero level of the part's field crosses the triangles of a level.
std::string cut_path(const CutMaps& maps, const Level& level) {
  std::string path;
  for (std::size_t i = 0; i < level.tris.size(); i++) {
    if (level.tris[i] >= maps.disk.part_tris) continue;
    const Tri &t = maps.disk.tris[level.tris[i]], &c = level.corners[i];
    char command = 'M';
    for (int k = 0; k < 3; k++) {
      const double a = maps.field[t[k]], b = maps.field[t[(k + 1) % 3]];
      if ((a > 0) == (b > 0)) continue;
      append(path, command, lerp(level.uv[c[k]], level.uv[c[(k + 1) % 3]], a / (a - b)));
      command = 'L';
    }
  }
  return path;
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
  const Level& level = maps.levels[l];
  const std::vector<std::string> names = level_names(maps.levels);
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 900 900\" font-family=\"sans-serif\" "
      "font-size=\"20\" stroke-linejoin=\"round\">\n<rect width=\"900\" height=\"900\" fill=\"white\"/>\n"
      "<circle cx=\"450\" cy=\"450\" r=\"400\" fill=\"none\" stroke=\"#888888\"/>\n"
      "<text x=\"20\" y=\"36\">level " +
      names[l] + "</text>\n";
  draw_triangles(svg, maps.disk, level);

  std::vector<std::vector<Vec2>> outline(level.holes.size());
  std::vector<int> hole_of(level.vertex.size(), -1);
  for (std::size_t i = 0; i < level.holes.size(); i++) hole_of[level.holes[i]] = i;
  for (const Tri& c : level.corners)  // a fan's triangles end in its centre, and follow each other
    if (hole_of[c[2]] >= 0) outline[hole_of[c[2]]].push_back(level.uv[c[0]]);
  std::string holes, sets;
  for (const std::vector<Vec2>& o : outline) holes += path_of(o, true);
  for (int child : level.children) sets += path_of(maps.levels[child].border, true);
  draw(svg, holes, "fill=\"#e8e8e8\" stroke=\"#222222\"");
  draw(svg, sets, "fill=\"white\" stroke=\"#b06000\"");
  draw(svg, path_of(maps.lines[l], false), "fill=\"none\" stroke=\"#d01010\" stroke-width=\"2\"");
  draw(svg, cut_path(maps, level), "fill=\"none\" stroke=\"black\" stroke-width=\"1.2\"");
  for (int child : level.children) {  // small ones would not be seen
    char text[200];
    const double x = size / 2 + scale * maps.levels[child].centre.x,
                 y = size / 2 - scale * maps.levels[child].centre.y;
    std::snprintf(text, sizeof text,
                  "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"8\" fill=\"none\" stroke=\"#b06000\"/>"
                  "<text x=\"%.1f\" y=\"%.1f\" fill=\"#b06000\">%s</text>\n",
                  x, y, x + 11, y - 8, names[child].c_str());
    svg += text;
  }
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
