// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/off.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdint>

#include "formats/foreign/bytes.h"
#include "formats/foreign/colors.h"
#include "formats/foreign/polygons.h"
#include "formats/text.h"
#include "lib/core/error.h"

namespace meshpipe {
namespace {

/// What the keyword [ST][C][N][4][n]OFF declares: the numbers after the coordinates of a vertex (4 and n:
/// more coordinates).
struct Keyword {
  bool known = false, normals = false, colors = false, texture = false, more_dimensions = false;
};

Keyword parse_keyword(std::string_view w) {
  Keyword k;
  if (!w.ends_with("OFF")) return k;
  w.remove_suffix(3);
  auto letter = [&](std::string_view l) {
    const bool has = w.starts_with(l);
    if (has) w.remove_prefix(l.size());
    return has;
  };
  k.texture = letter("ST");
  k.colors = letter("C");
  k.normals = letter("N");
  const bool four = letter("4"), n = letter("n");
  k.more_dimensions = four || n;
  k.known = w.empty();
  return k;
}

class OffReader {
 public:
  OffReader(std::string_view bytes, const std::string& where)
      : bytes_(bytes), where_(where), text_(bytes, where, '#') {}

  Stream read() {
    text_.need_line("'OFF'");
    const std::string_view word = text_.word();
    keyword_ = parse_keyword(word);
    if (!keyword_.known) text_.fail("expected 'OFF', found " + quoted(word));
    if (keyword_.more_dimensions)
      text_.fail(quoted(word) + " has coordinates of 4 or more dimensions, but a surface has 3");
    if (same_word(text_.peek(), "binary"))
      binary();
    else
      ascii();
    vertex_colors_.give(stream_, stream_.surface.vertex, stream_.surface.points.size());
    face_colors_.give(stream_, polygons_.columns, polygons_.ends.size());
    polygons_.patch.assign(polygons_.ends.size(), 0);
    set_faces(stream_, polygons_);
    return std::move(stream_);
  }

 private:
  void ascii() {
    if (text_.line_ends()) text_.need_line("the counts of vertices and faces");
    const int n_vertices = text_.count("the count of vertices", 6),
              n_faces = text_.count("the count of faces", 2);
    std::vector<Vec3>& points = stream_.surface.points;
    points.resize(n_vertices);
    std::vector<double> more;
    for (int i = 0; i < n_vertices; ++i) {
      text_.need_line("vertex", i, n_vertices);
      points[i] = next_point(text_);
      if (!keyword_.colors) continue;
      if (keyword_.normals) next_point(text_);
      const bool whole = rest_of_line(text_, more);
      vertex_colors_.add(more.data(), more.size() - (keyword_.texture && more.size() > 4 ? 2 : 0), whole);
    }
    polygons_.ends.reserve(n_faces);
    for (int f = 0; f < n_faces; ++f) {
      text_.need_line("face", f, n_faces);
      const int n = checked_corners(text_.integer("a number of corners"), f,
                                    [&](const std::string& what) { text_.fail(what); });
      for (int i = 0; i < n; ++i)  // they may go on in the next line
        polygons_.corners.push_back(vertex(next_integer(text_, "a vertex number"), f,
                                           [&](const std::string& what) { text_.fail(what); }));
      polygons_.ends.push_back(polygons_.corners.size());
      if (text_.line_ends()) continue;
      const bool whole = rest_of_line(text_, more);
      face_colors_.add(more.data(), more.size(), whole);
    }
    if (text_.next_line())
      text_.fail(quoted(text_.word()) + " follows the last of " + std::to_string(n_faces) + " faces");
  }

  /// Reads what follows the line with the keyword: ints and floats of 32 bits, big endian, or little endian
  /// as PMP writes them, which leaves out the numbers of face colors.
  void binary() {
    const std::size_t start = bytes_.size() - text_.after().size();
    const int extra = (keyword_.normals ? 3 : 0) + (keyword_.colors ? 4 : 0) + (keyword_.texture ? 2 : 0);
    constexpr Layout layouts[] = {{false, true}, {true, false}, {true, true}};
    const Layout* layout = std::find_if(std::begin(layouts), std::end(layouts), [&](const Layout& l) {
      return ends_with_file(start, 4 * (3 + static_cast<std::size_t>(extra)), l);
    });
    auto vertices = [&](bool little) {
      at_ = start, little_ = little;
      return get<std::uint32_t>();
    };
    if (layout == std::end(layouts)) layout = layouts + (vertices(true) < vertices(false) ? 1 : 0);
    at_ = start, little_ = layout->little;
    const int n_vertices = get<int>(), n_faces = get<int>();
    get<int>();  // edges
    if (n_vertices < 0 || n_faces < 0 ||
        n_vertices * (12 + 4 * static_cast<std::size_t>(extra)) + 4 * static_cast<std::size_t>(n_faces) >
            left())
      fail_at(std::to_string(n_vertices) + " vertices and " + std::to_string(n_faces) + " faces, but only " +
              std::to_string(left()) + " bytes follow");
    stream_.surface.points.resize(n_vertices);
    std::vector<double> more;
    for (Vec3& p : stream_.surface.points) {
      p.x = get<float>(), p.y = get<float>(), p.z = get<float>();
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        fail_at("a vertex holds a number that is not finite");
      reals(extra, more);
      if (keyword_.colors) vertex_colors_.add(more.data() + (keyword_.normals ? 3 : 0), 4, false);
    }
    auto fail = [&](const std::string& what) { fail_at(what); };
    for (int f = 0; f < n_faces; ++f) {
      const int n = checked_corners(get<int>(), f, fail);
      for (int i = 0; i < n; ++i) polygons_.corners.push_back(vertex(get<int>(), f, fail));
      polygons_.ends.push_back(polygons_.corners.size());
      const int of_color = layout->face_colors ? get<int>() : 0;
      if (of_color < 0 || of_color > 4) fail_at("a color of " + std::to_string(of_color) + " numbers");
      reals(of_color, more);
      face_colors_.add(more.data(), more.size(), false);
    }
    if (left() > 0)
      fail_at(std::to_string(left()) + " bytes follow the last of " + std::to_string(n_faces) + " faces");
  }

  /// An order of bytes, and whether each face ends with the number of its colors and these.
  struct Layout {
    bool little, face_colors;
  };

  /// Does the file, whose counts begin at `start`, end with the last face if it has this layout? `row`: bytes
  /// of a vertex.
  bool ends_with_file(std::size_t start, std::size_t row, const Layout& layout) {
    at_ = start, little_ = layout.little;
    auto skip = [&](std::size_t n, std::size_t size) {
      const bool there = n <= left() / size;
      if (there) at_ += n * size;
      return there;
    };
    auto number = [&](int& n, int most) { return left() >= 4 && (n = get<int>()) >= 0 && n <= most; };
    int n_vertices, n_faces, n;
    if (!number(n_vertices, INT_MAX) || !number(n_faces, INT_MAX) || !skip(1, 4) || !skip(n_vertices, row))
      return false;
    for (int f = 0; f < n_faces; ++f) {
      if (!number(n, max_corners) || !skip(n, 4)) return false;
      if (layout.face_colors && (!number(n, 4) || !skip(n, 4))) return false;
    }
    return left() == 0;
  }

  template <class Fail>
  int checked_corners(int n, int face, const Fail& fail) const {
    if (n < 0 || n > max_corners)
      fail("face " + std::to_string(face) + " has " + std::to_string(n) + " corners, the limit is " +
           std::to_string(max_corners));
    return n;
  }
  template <class Fail>
  int vertex(int v, int face, const Fail& fail) const {
    const int n = static_cast<int>(stream_.surface.points.size());
    if (v < 0 || v >= n)
      fail("face " + std::to_string(face) + " uses vertex " + std::to_string(v) + ", but there are " +
           std::to_string(n));
    return v;
  }

  std::size_t left() const { return bytes_.size() - at_; }
  [[noreturn]] void fail_at(const std::string& what) const {
    throw BadInput(where_ + ':' + std::to_string(at_) + ": " + what);
  }
  template <class T>
  T get() {
    if (left() < sizeof(T))
      fail_at("the file ends early: expected " + std::to_string(sizeof(T)) + " bytes, but only " +
              std::to_string(left()) + " are left");
    at_ += sizeof(T);
    return load<T>(bytes_.data() + at_ - sizeof(T), !little_);
  }
  void reals(int n, std::vector<double>& out) {
    out.clear();
    for (int i = 0; i < n; ++i) out.push_back(get<float>());
  }

  std::string_view bytes_;
  const std::string& where_;
  Text text_;
  Keyword keyword_;
  std::size_t at_ = 0;  ///< in a binary file
  bool little_ = false;
  Stream stream_;
  Polygons polygons_;
  Colors vertex_colors_, face_colors_;
};

}  // namespace

bool is_off(std::string_view bytes) {
  Text text(bytes.substr(0, 4096), "", '#');
  return text.next_line() && parse_keyword(text.word()).known;
}

Stream read_off(std::string_view bytes, const std::string& where) { return OffReader(bytes, where).read(); }

std::string write_off(const Stream& stream, bool) {
  const Surface& s = stream.surface;
  const Rgb of_vertices(s.vertex), of_faces(s.face);
  std::string out = of_vertices ? "COFF\n" : "OFF\n";
  out.reserve(s.points.size() * 72 + s.tris.size() * 36);
  append(out, static_cast<long long>(s.points.size()));
  out += ' ';
  append(out, static_cast<long long>(s.tris.size()));
  out += " 0\n";
  for (std::size_t v = 0; v < s.points.size(); ++v) {
    append_point(out, "", s.points[v]);
    if (!of_vertices) continue;
    out.pop_back();
    of_vertices.append_to(out, v, true);
    out += " 255\n";
  }
  for (std::size_t t = 0; t < s.tris.size(); ++t) {
    out += '3';
    for (int v : s.tris[t]) {
      out += ' ';
      append(out, static_cast<long long>(v));
    }
    if (of_faces) of_faces.append_to(out, t, true);
    out += '\n';
  }
  return out;
}

}  // namespace meshpipe
