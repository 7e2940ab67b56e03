// SPDX-License-Identifier: BSD-3-Clause
#include "formats/off.h"

#include "formats/polygons.h"
#include "formats/text.h"

namespace meshpipe {
namespace {

/// [ST][C][N][4][n]OFF; what its letters add comes after the coordinates, but for 4 and n.
bool is_keyword(std::string_view w) {
  if (!w.ends_with("OFF")) return false;
  w.remove_suffix(3);
  for (const char* letters : {"ST", "C", "N", "4", "n"})
    if (w.starts_with(letters)) w.remove_prefix(std::string_view(letters).size());
  return w.empty();
}

}  // namespace

bool is_off(std::string_view bytes) {
  Text text(bytes.substr(0, 4096), "", '#');
  return text.next_line() && is_keyword(text.word());
}

Stream read_off(std::string_view bytes, const std::string& where) {
  Text text(bytes, where, '#');
  text.need_line("'OFF'");
  std::string_view keyword = text.word();
  if (!is_keyword(keyword)) text.fail(quoted(keyword) + " where 'OFF' is due");
  if (keyword.find_first_of("4n") != std::string_view::npos)
    text.fail(quoted(keyword) + " has coordinates of 4 or more dimensions, but a surface has 3");
  if (text.line_ends()) text.need_line("the counts of vertices and faces");
  if (same_word(text.peek(), "binary")) text.fail("binary off is not built yet");
  const int n_vertices = text.count("the count of vertices", 6),
            n_faces = text.count("the count of faces", 2);
  Stream stream;
  std::vector<Vec3>& points = stream.surface.points;
  points.resize(n_vertices);
  for (int i = 0; i < n_vertices; ++i) {
    text.need_line("vertex", i, n_vertices);
    points[i] = text.point();
  }
  Polygons polygons;
  polygons.ends.reserve(n_faces);
  for (int f = 0; f < n_faces; ++f) {
    text.need_line("face", f, n_faces);
    const int n = text.integer("a number of corners");
    if (n < 0 || n > max_corners)
      text.fail("face " + std::to_string(f) + " has " + std::to_string(n) + " corners, the limit is " +
                std::to_string(max_corners));
    for (int i = 0; i < n; ++i) {
      const int v = text.integer("a vertex number");
      if (v < 0 || v >= n_vertices)
        text.fail("face " + std::to_string(f) + " uses vertex " + std::to_string(v) + ", but there are " +
                  std::to_string(n_vertices));
      polygons.corners.push_back(v);
    }
    polygons.ends.push_back(polygons.corners.size());
  }
  if (text.next_line())
    text.fail(quoted(text.word()) + " follows the last of " + std::to_string(n_faces) + " faces");
  polygons.patch.assign(n_faces, 0);
  set_faces(stream, polygons);
  return stream;
}

std::string write_off(const Stream& stream, bool) {
  const Surface& s = stream.surface;
  std::string out = "OFF\n";
  out.reserve(s.points.size() * 60 + s.tris.size() * 24);
  append(out, static_cast<long long>(s.points.size()));
  out += ' ';
  append(out, static_cast<long long>(s.tris.size()));
  out += " 0\n";
  for (const Vec3& p : s.points) append_point(out, "", p);
  for (const Tri& t : s.tris) {
    out += '3';
    for (int v : t) {
      out += ' ';
      append(out, static_cast<long long>(v));
    }
    out += '\n';
  }
  return out;
}

}  // namespace meshpipe
