// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/stl.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "formats/foreign/polygons.h"
#include "formats/text.h"
#include "lib/core/error.h"
#include "lib/core/weld.h"

namespace meshpipe {
namespace {

constexpr std::size_t head_bytes = 84, facet_bytes = 50;
/// Limit of triangles: half-edges, three per triangle, are numbered by an int.
constexpr std::size_t max_facets = std::numeric_limits<int>::max() / 3;

std::uint32_t declared_facets(std::string_view bytes) {
  std::uint32_t n;
  std::memcpy(&n, bytes.data() + 80, 4);
  return n;
}

bool begins_with_solid(std::string_view bytes) {
  return same_word(trim(bytes.substr(0, 512)).substr(0, 5), "solid");
}

/// Numbers the corners of triangles; equal points become one vertex, since the format cannot express in any
/// other way that triangles are joined.
class Corners {
 public:
  explicit Corners(std::size_t triangles) : numbers_(triangles / 2) { tris_.reserve(triangles); }

  void add(const Vec3 (&p)[3]) {
    std::copy_n(p, 3, waiting_ + 3 * n_waiting_);
    if (++n_waiting_ == block) flush();
  }
  std::size_t size() const { return tris_.size() + n_waiting_; }
  void give(Surface& s) {
    flush();
    s.tris = std::move(tris_);
    s.points = std::move(numbers_.points);
    s.vertex.rows = s.points.size();
  }

 private:
  void flush() {
    const std::size_t first = tris_.size();
    tris_.resize(first + n_waiting_);
    if (n_waiting_) numbers_.add(waiting_, 3 * n_waiting_, tris_[first].data());
    n_waiting_ = 0;
  }

  static constexpr int block = 64;
  PointNumbers numbers_;
  std::vector<Tri> tris_;
  Vec3 waiting_[3 * block];
  int n_waiting_ = 0;
};

Stream read_binary(std::string_view bytes, std::size_t n, const std::string& where) {
  if (n > max_facets)
    throw BadInput(where + ":80: the file has " + std::to_string(n) + " triangles, the limit is " +
                   std::to_string(max_facets));
  Corners corners(n);
  for (std::size_t t = 0; t < n; ++t) {
    float f[9];
    std::memcpy(f, bytes.data() + head_bytes + facet_bytes * t + 12, sizeof f);
    for (int i = 0; i < 9; ++i)
      if (!std::isfinite(f[i]))
        throw BadInput(where + ":" + std::to_string(head_bytes + facet_bytes * t + 12 + 4 * i) +
                       ": triangle " + std::to_string(t) + " holds a number that is not finite");
    corners.add({{f[0], f[1], f[2]}, {f[3], f[4], f[5]}, {f[6], f[7], f[8]}});
  }
  Stream stream;
  corners.give(stream.surface);
  stream.surface.face.set("patch", std::vector<int>(n, 1));
  return stream;
}

void expect(Text& text, const char* first, const char* second = nullptr) {
  text.need_line(first);
  std::string_view w = text.word();
  if (!same_word(w, first)) text.fail(std::string("expected '") + first + "', found " + quoted(w));
  if (second && !same_word(w = text.word(), second))
    text.fail(std::string("expected '") + second + "' after '" + first + "', found " + quoted(w));
}

/// Is the word the end of `what`, as endloop or, of some writers, end loop?
bool is_end(Text& text, std::string_view word, const char* what) {
  if (same_word(word, "end")) return same_word(text.word(), what);
  return same_word(word.substr(0, 3), "end") && same_word(word.substr(3), what);
}

void expect_end(Text& text, const char* what) {
  const std::string end = std::string("end") + what;
  text.need_line(end.c_str());
  if (const std::string_view w = text.word(); !is_end(text, w, what))
    text.fail("expected '" + end + "', found " + quoted(w));
}

Stream read_text(std::string_view bytes, const std::string& where) {
  Text text(bytes, where);
  Stream stream;
  Corners corners(bytes.size() / 256);
  std::vector<int> patch;
  int solid = 0;
  bool open = false;
  while (text.next_line()) {
    std::string_view w = text.word();
    if (same_word(w, "facet")) {
      // some writers leave out the 'solid' of all solids except the first
      if (!open) ++solid;
      open = true;
      expect(text, "outer", "loop");
      Vec3 p[3];
      for (Vec3& q : p) {
        expect(text, "vertex");
        q = next_point(text);
      }
      expect_end(text, "loop");
      expect_end(text, "facet");
      if (corners.size() == max_facets)
        text.fail("more than " + std::to_string(max_facets) + " triangles, which is the limit");
      corners.add(p);
      patch.push_back(solid);
    } else if (same_word(w, "solid")) {
      if (open) text.fail("expected 'facet' or 'endsolid', found 'solid'");
      open = true;
      ++solid;
      if (std::string_view name = text.rest(); !name.empty())
        stream.names.push_back({2, solid, std::string(name)});
    } else if (is_end(text, w, "solid")) {
      if (!open) text.fail("'endsolid' without a solid");
      open = false;
    } else if (open || solid == 0 || same_word(w, "outer") || same_word(w, "vertex") ||
               same_word(w, "endloop") || same_word(w, "endfacet")) {
      text.fail("expected 'solid', 'facet' or 'endsolid', found " + quoted(w));
    }  // anything else after a solid is a note of the program that wrote the file
  }
  if (open) text.fail("expected 'endsolid', found the end of the file");
  corners.give(stream.surface);
  stream.surface.face.set("patch", std::move(patch));
  return stream;
}

std::string write_binary(const Surface& s) {
  if (s.tris.size() > std::numeric_limits<std::uint32_t>::max())
    throw CannotWrite("stl holds at most 4294967295 triangles, here are " + std::to_string(s.tris.size()));
  std::string out(head_bytes + facet_bytes * s.tris.size(), '\0');
  const char title[] = "meshpipe binary STL";  // must not begin with "solid"
  std::memcpy(out.data(), title, sizeof title - 1);
  const auto n = static_cast<std::uint32_t>(s.tris.size());
  std::memcpy(out.data() + 80, &n, 4);
  char* at = out.data() + head_bytes;
  for (const Tri& t : s.tris) {
    const Vec3 a = s.points[t[0]], b = s.points[t[1]], c = s.points[t[2]];
    const Vec3 u = normalized(area_vector(a, b, c));
    const double d[] = {u.x, u.y, u.z, a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z};
    float f[12];
    for (int i = 0; i < 12; ++i) {
      if (std::abs(d[i]) > std::numeric_limits<float>::max()) {
        std::string value;
        append(value, d[i]);
        throw CannotWrite("coordinate " + value +
                          " does not fit the single precision of a binary stl; use --ascii");
      }
      f[i] = static_cast<float>(d[i]);
    }
    std::memcpy(at, f, sizeof f);
    at += facet_bytes;
  }
  return out;
}

/// Returns the number of triangles of a binary file whose size differs from the declared count, and a remark:
/// the number that fits if the writer did not know it and left 0 or -1; the declared count if more bytes
/// follow; 0 if the file is cut off, or no binary STL.
std::pair<std::size_t, std::string> facets_by_size(std::string_view bytes) {
  if (bytes.size() < head_bytes + facet_bytes) return {};
  const std::size_t declared = declared_facets(bytes), fitting = (bytes.size() - head_bytes) / facet_bytes;
  const std::string counts = "the binary stl declares " + std::to_string(declared) +
                             " triangles and has bytes for " + std::to_string(fitting);
  if (declared == 0 || declared == 0xFFFFFFFF)
    return {(bytes.size() - head_bytes) % facet_bytes == 0 ? fitting : 0, counts + ": all are read"};
  // a file with more other bytes than triangles is of another kind
  return {declared <= fitting && fitting < 2 * declared ? declared : 0,
          counts + ": what follows is left out"};
}

}  // namespace

bool is_binary_stl(std::string_view bytes) {
  return bytes.size() >= head_bytes && bytes.size() == head_bytes + facet_bytes * declared_facets(bytes);
}

bool is_odd_stl(std::string_view bytes) {
  return !binary_stl_mismatch(bytes).empty() && facets_by_size(bytes).first > 0;
}

bool is_stl(std::string_view bytes) { return is_binary_stl(bytes) || begins_with_solid(bytes); }

std::string binary_stl_mismatch(std::string_view bytes) {
  // no text holds a zero byte
  if (bytes.size() < head_bytes || bytes.substr(0, head_bytes).find('\0') == std::string_view::npos)
    return "";
  const std::uint32_t n = declared_facets(bytes);
  return "as a binary stl of " + std::to_string(n) + " triangles it would have " +
         std::to_string(head_bytes + facet_bytes * n) + " bytes, but it has " + std::to_string(bytes.size());
}

Stream read_stl(std::string_view bytes, const std::string& where) {
  if (is_binary_stl(bytes)) return read_binary(bytes, declared_facets(bytes), where);
  const std::string why = binary_stl_mismatch(bytes);
  if (why.empty()) return read_text(bytes, where);
  const auto [n, remark] = facets_by_size(bytes);
  if (n == 0) throw BadInput(where + ":80: " + why);
  Stream stream = read_binary(bytes, n, where);
  stream.remarks.push_back(remark);
  return stream;
}

std::string beyond_single_precision(const Surface& s) {
  constexpr double most = std::numeric_limits<float>::max();
  double largest = 0;
  for (const Vec3& p : s.points)
    for (double x : {p.x, p.y, p.z}) largest = std::max(largest, std::abs(x));
  if (largest > most) {
    std::string value;
    append(value, largest);
    return "a coordinate of " + value + " is beyond it";
  }
  auto rounded = [](const Vec3& p) {
    return Vec3{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  };
  if (std::all_of(s.points.begin(), s.points.end(), [&](const Vec3& p) { return rounded(p) == p; }))
    return "";
  // triangles thinner than the rounding of double coordinates are not spoiled by the format
  const double noise = 1e-14 * largest;
  std::size_t spoiled = 0;
  std::vector<char> used(s.points.size(), false);
  for (const Tri& t : s.tris) {
    const Vec3 p[] = {s.points[t[0]], s.points[t[1]], s.points[t[2]]};
    const Vec3 q[] = {rounded(p[0]), rounded(p[1]), rounded(p[2])};
    for (int v : t) used[v] = true;
    const Vec3 u = area_vector(p[0], p[1], p[2]);
    const double longest = std::max({norm(p[1] - p[0]), norm(p[2] - p[1]), norm(p[0] - p[2])});
    if (norm(u) > noise * longest && !(dot(u, area_vector(q[0], q[1], q[2])) > 0)) ++spoiled;
  }
  auto places = [&](auto&& place) {
    std::vector<Vec3> all;
    for (std::size_t v = 0; v < s.points.size(); ++v)
      if (used[v]) all.push_back(place(s.points[v]));
    std::vector<int> number(all.size());
    PointNumbers numbers(all.size());
    constexpr std::size_t block = 1024;
    for (std::size_t i = 0; i < all.size(); i += block)
      numbers.add(all.data() + i, static_cast<int>(std::min(block, all.size() - i)), number.data() + i);
    return numbers.points.size();
  };
  const std::size_t before = places([](const Vec3&p) { return p; }), after = places(rounded);
  if (spoiled + (before - after) == 0) return "";
  return std::to_string(before - after) + " vertices fall on others and " + std::to_string(spoiled) +
         " triangles become degenerate or change orientation";
}

std::string write_stl(const Stream& stream, bool ascii) {
  const Surface& s = stream.surface;
  if (!ascii) return write_binary(s);
  const ByPatch by = by_patch(stream);
  std::string out;
  out.reserve(s.tris.size() * 256);
  for (std::size_t k = 0; k < by.tags.size(); ++k) {
    const std::string name = one_line(stream.name_of(2, by.tags[k]));
    out += name.empty() ? "solid\n" : "solid " + name + '\n';
    for (std::size_t i = by.first[k]; i < by.first[k + 1]; ++i) {
      const Tri& t = s.tris[by.order[i]];
      const Vec3 a = s.points[t[0]], b = s.points[t[1]], c = s.points[t[2]];
      append_point(out, " facet normal ", normalized(area_vector(a, b, c)));
      out += "  outer loop\n";
      for (const Vec3& p : {a, b, c}) append_point(out, "   vertex ", p);
      out += "  endloop\n endfacet\n";
    }
    out += name.empty() ? "endsolid\n" : "endsolid " + name + '\n';
  }
  return out;
}

}  // namespace meshpipe
