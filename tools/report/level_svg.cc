// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/level_svg.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lib/core/number.h"
#include "tools/report/svg.h"

namespace meshpipe {
namespace {

constexpr double size = 900, disk_radius = 400;

/// A square window on a level's plane: the point `center` is drawn at its middle, `scale` times as large.
struct LevelFrame {
  Vec2 middle{size / 2, size / 2};
  double half = size / 2;
  Vec2 center = {};
  double scale = disk_radius;

  Vec2 operator()(Vec2 p) const {
    return {middle.x + scale * (p.x - center.x), middle.y - scale * (p.y - center.y)};
  }
  bool shows(Vec2 a, Vec2 b, Vec2 c) const {  // their box
    const double reach = half / scale;
    return std::min({a.x, b.x, c.x}) < center.x + reach && std::max({a.x, b.x, c.x}) > center.x - reach &&
           std::min({a.y, b.y, c.y}) < center.y + reach && std::max({a.y, b.y, c.y}) > center.y - reach;
  }
};

constexpr int level_digits = 8;  ///< of coordinates: enough to enlarge a set that is a thousandth of the disk

void add_polygon(SvgPath& path, const LevelFrame& frame, const std::vector<Vec2>& polygon, bool closed) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    if (i)
      path.line_to(frame(polygon[i]));
    else
      path.move_to(frame(polygon[i]));
  }
  if (closed) path.close();
}

SvgPath path_of(const LevelFrame& frame, const std::vector<Vec2>& polygon, bool closed) {
  SvgPath path(level_digits);
  add_polygon(path, frame, polygon, closed);
  return path;
}

void draw(Svg& svg, const SvgPath& path, const std::string& style) {
  svg.path(path, "vector-effect=\"non-scaling-stroke\" " + style);
}

std::vector<int> depths(const std::vector<Level>& levels) {
  std::vector<int> depth(levels.size(), 0);
  for (std::size_t l = 0; l < levels.size(); ++l)
    if (levels[l].parent >= 0) depth[l] = depth[levels[l].parent] + 1;
  return depth;
}

/// Draws the triangles of a level, in shades of the logarithm of their area scale.
void draw_triangles(Svg& svg, const LevelFrame& frame, const FilledDisk& disk, const Level& level) {
  constexpr std::array<const char*, 8> shades{"#f2f7fc", "#dde9f5", "#c3d9ee", "#a3c5e4",
                                              "#7dabd6", "#588fc4", "#3a72ad", "#245490"};
  std::vector<double> shrink(level.tris.size(), 0);
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (std::size_t i = 0; i < level.tris.size(); ++i) {
    if (level.tris[i] >= disk.part_tris) continue;
    const Tri &t = disk.tris[level.tris[i]], &c = level.corners[i];
    const double in_space = norm(area_vector(disk.points[t[0]], disk.points[t[1]], disk.points[t[2]]));
    const double in_plane = std::abs(cross(level.uv[c[1]] - level.uv[c[0]], level.uv[c[2]] - level.uv[c[0]]));
    shrink[i] = std::log(std::max(in_space, 1e-300)) - std::log(std::max(in_plane, 1e-300));
    least = std::min(least, shrink[i]);
    most = std::max(most, shrink[i]);
  }
  std::vector<SvgPath> path(shades.size(), SvgPath(level_digits));
  for (std::size_t i = 0; i < level.tris.size(); ++i) {
    const Vec2 corner[3] = {level.uv[level.corners[i][0]], level.uv[level.corners[i][1]],
                            level.uv[level.corners[i][2]]};
    if (level.tris[i] >= disk.part_tris || !frame.shows(corner[0], corner[1], corner[2])) continue;
    const double share = most > least ? (shrink[i] - least) / (most - least) : 0;
    add_polygon(path[std::min<std::size_t>(shades.size() - 1, share * shades.size())], frame,
                {corner[0], corner[1], corner[2]}, true);
  }
  for (std::size_t s = 0; s < shades.size(); ++s)
    draw(svg, path[s], std::string("stroke=\"#1d3c5c\" stroke-width=\"0.25\" fill=\"") + shades[s] + '"');
}

/// Returns the path where the zero level of the part's field crosses the triangles of a level.
SvgPath cut_path(const LevelFrame& frame, const CutMaps& maps, const Level& level) {
  SvgPath path(level_digits);
  for (std::size_t i = 0; i < level.tris.size(); ++i) {
    if (level.tris[i] >= maps.disk.part_tris) continue;
    const Tri &t = maps.disk.tris[level.tris[i]], &c = level.corners[i];
    if (!frame.shows(level.uv[c[0]], level.uv[c[1]], level.uv[c[2]])) continue;
    bool begun = false;
    for (int k = 0; k < 3; ++k) {
      const double a = maps.field[t[k]], b = maps.field[t[(k + 1) % 3]];
      if ((a > 0) == (b > 0)) continue;
      const Vec2 p = frame(lerp(level.uv[c[k]], level.uv[c[(k + 1) % 3]], a / (a - b)));
      if (begun)
        path.line_to(p);
      else
        path.move_to(p);
      begun = true;
    }
  }
  return path;
}

void draw_map(Svg& svg, const LevelFrame& frame, const CutMaps& maps, int l,
              const std::vector<std::string>& names) {
  const Level& level = maps.levels[l];
  draw_triangles(svg, frame, maps.disk, level);
  std::vector<std::vector<Vec2>> outline(level.holes.size());
  std::vector<int> hole_of(level.vertex.size(), -1);
  for (std::size_t i = 0; i < level.holes.size(); ++i) hole_of[level.holes[i]] = i;
  for (const Tri& c : level.corners)  // a fan's triangles end in its center, and follow each other
    if (hole_of[c[2]] >= 0) outline[hole_of[c[2]]].push_back(level.uv[c[0]]);
  SvgPath holes(level_digits), sets(level_digits);
  for (const std::vector<Vec2>& o : outline) add_polygon(holes, frame, o, true);
  for (int child : level.children) add_polygon(sets, frame, maps.levels[child].border, true);
  draw(svg, holes, "fill=\"#e8e8e8\" stroke=\"#222222\"");
  draw(svg, sets, "fill=\"white\" stroke=\"#b06000\"");
  draw(svg, path_of(frame, maps.lines[l], false), "fill=\"none\" stroke=\"#d01010\" stroke-width=\"2\"");
  draw(svg, cut_path(frame, maps, level), "fill=\"none\" stroke=\"black\" stroke-width=\"1.2\"");
  // marks: small sets and holes would not be seen
  for (int hole : level.holes) svg.circle(frame(level.uv[hole]), 3, "fill=\"#222222\"");
  for (int child : level.children) {
    const Vec2 c = frame(maps.levels[child].center);
    svg.circle(c, 8, "fill=\"none\" stroke=\"#b06000\"");
    svg.text(c + Vec2{11, -8}, names[child], "fill=\"#b06000\"");
  }
}

/// Draws the neighborhood of a level's sets, enlarged, in the corner of its picture, if they lie close
/// together.
void draw_enlarged(Svg& svg, const CutMaps& maps, int l, const std::vector<std::string>& names) {
  Vec2 low{HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL};
  for (int child : maps.levels[l].children)
    for (Vec2 p : maps.levels[child].border) low = lower(low, p), high = upper(high, p);
  const double width = std::max(high.x - low.x, high.y - low.y);
  constexpr double inset = 260, close = 0.25;
  if (!(width > 0) || width > close) return;
  const LevelFrame frame{
      {size - inset / 2, size - inset / 2}, inset / 2, 0.5 * (low + high), 0.7 * inset / width};
  const Vec2 corner{size - inset, size - inset}, extent{inset, inset};
  svg.clip("corner", corner, extent);
  svg.begin_group("clip-path=\"url(#corner)\"");
  svg.rectangle(corner, extent, "fill=\"white\" stroke=\"#222222\" stroke-width=\"3\"");
  draw_map(svg, frame, maps, l, names);
  svg.text(corner + Vec2{10, 26}, "x " + shown(frame.scale / disk_radius));
  svg.end_group();
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
  Svg svg(size, size, "font-family=\"sans-serif\" font-size=\"20\" stroke-linejoin=\"round\"");
  svg.circle({size / 2, size / 2}, disk_radius, "fill=\"none\" stroke=\"#888888\"");
  svg.text({20, 36}, "level " + names[l]);
  draw_map(svg, {}, maps, l, names);
  draw_enlarged(svg, maps, l, names);
  return svg.finish();
}

std::string levels_svg(const std::vector<Level>& levels, const std::vector<std::string>& files) {
  constexpr int tile = 240;
  const std::vector<int> depth = depths(levels);
  std::vector<int> width(levels.size() + 1, 0), column(levels.size());
  for (std::size_t l = 0; l < levels.size(); ++l) column[l] = width[depth[l]]++;
  const int columns = *std::max_element(width.begin(), width.end());
  const int rows = 1 + *std::max_element(depth.begin(), depth.end());
  Svg svg(tile * columns, tile * rows, "", true);
  for (std::size_t l = 0; l < levels.size(); ++l)
    svg.image({tile * (columns - width[depth[l]]) / 2.0 + tile * column[l], 1.0 * tile * depth[l]},
              {tile, tile}, files[l]);
  return svg.finish();
}

}  // namespace meshpipe
