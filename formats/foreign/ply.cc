// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/ply.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "formats/foreign/columns.h"
#include "formats/foreign/polygons.h"
#include "formats/text.h"
#include "lib/core/error.h"

namespace meshpipe {
namespace {

struct Type {
  const char *name, *other_name;
  std::size_t bytes;
  bool integral;
  double (*value)(const char* bytes);
};

template <class T>
double as_double(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

/// Limit of elements, and of properties of each, whose names are searched linearly.
constexpr std::size_t max_declared = 1000;

constexpr Type types[] = {
    {"char", "int8", 1, true, as_double<std::int8_t>},
    {"uchar", "uint8", 1, true, as_double<std::uint8_t>},
    {"short", "int16", 2, true, as_double<std::int16_t>},
    {"ushort", "uint16", 2, true, as_double<std::uint16_t>},
    {"int", "int32", 4, true, as_double<std::int32_t>},
    {"uint", "uint32", 4, true, as_double<std::uint32_t>},
    {"float", "float32", 4, false, as_double<float>},
    {"double", "float64", 8, false, as_double<double>},
};

/// What becomes of a property.
enum class Role { none, x, y, z, corners, strip, patch, column };

struct Property {
  const Type* type;
  const Type* count = nullptr;  ///< of a list: the type of its length
  std::string name;
  Role role = Role::none;
  Data values{};  ///< of a column
};

struct Element {
  std::string name;
  std::size_t rows = 0;
  std::vector<Property> properties;
};

/// The header of a file: its elements, its encoding and the names of patches.
class Header {
 public:
  Header(std::string_view bytes, const std::string& where) : text(bytes, where) {}

  void read();
  const Element* find(std::string_view element) const {
    const auto e =
        std::find_if(elements.begin(), elements.end(), [&](const Element& x) { return x.name == element; });
    return e == elements.end() ? nullptr : &*e;
  }

  Text text;
  std::vector<Element> elements;
  std::vector<Name> names;
  bool ascii = false, swap = false;

 private:
  [[noreturn]] void fail(const std::string& what) const { text.fail(what); }
  void format();
  void comment();
  void element();
  const Type* type();
  void property();
  void check(const char* element, std::initializer_list<std::pair<const char*, Role>> needs) const;
  void check_rows(const Element& e) const;
};

void Header::read() {
  text.next_line();  // "ply"
  bool has_format = false;
  for (;;) {
    text.need_line("'end_header'");
    std::string_view w = text.word();
    if (w == "end_header") break;
    if (w == "comment") {
      comment();
    } else if (w == "format") {
      if (has_format) fail("a second 'format'");
      has_format = true;
      format();
    } else if (w == "element") {
      element();
    } else if (w == "property") {
      property();
    } else if (w != "obj_info") {
      fail("expected 'element', 'property', 'comment' or 'end_header', found " + quoted(w));
    }
  }
  if (!has_format) fail("the header has no 'format'");
  check("vertex", {{"x", Role::x}, {"y", Role::y}, {"z", Role::z}});
  if (!find("tristrips"))
    check("face", {{"vertex_indices", Role::corners}});
  else
    check("tristrips", {{"vertex_indices", Role::strip}});
  for (const Element& e : elements) check_rows(e);
}

void Header::format() {
  const std::string_view w = text.word();
  if (w != "ascii" && w != "binary_little_endian" && w != "binary_big_endian")
    fail("expected ascii, binary_little_endian or binary_big_endian, found " + quoted(w));
  ascii = w == "ascii";
  swap = w == "binary_big_endian";
}

/// Keeps names of patches, as the stream writes them; other comments are dropped.
void Header::comment() {
  long long dim, tag;
  if (text.word() == "name" && parse_integer(text.word(), dim) && parse_integer(text.word(), tag) &&
      dim == 2 && std::abs(tag) <= std::numeric_limits<int>::max())
    names.push_back({2, static_cast<int>(tag), percent_decode(text.rest())});
}

void Header::element() {
  Element e;
  e.name = text.word();
  const int rows = text.integer("a count of rows");
  if (rows < 0) fail("element " + quoted(e.name) + " has " + std::to_string(rows) + " rows");
  if (elements.size() == max_declared)
    fail("more than " + std::to_string(max_declared) + " elements, which is the limit");
  e.rows = rows;
  for (const Element& other : elements)
    if (other.name == e.name) fail("element " + quoted(e.name) + " is declared twice");
  elements.push_back(std::move(e));
}

const Type* Header::type() {
  std::string_view w = text.word();
  for (const Type& t : types)
    if (w == t.name || w == t.other_name) return &t;
  fail("expected a type, found " + quoted(w));
}

void Header::property() {
  if (elements.empty()) fail("a property before the first element");
  Element& e = elements.back();
  if (e.properties.size() == max_declared)
    fail("element " + quoted(e.name) + " has more than " + std::to_string(max_declared) +
         " properties, which is the limit");
  Property p;
  const bool list = text.peek() == "list";
  if (list) {
    text.word();
    p.count = type();
  }
  p.type = type();
  p.name = text.word();
  if (p.name.empty()) fail("a property without a name");
  if (e.name == "vertex" && !list && p.name.size() == 1 && p.name[0] >= 'x' && p.name[0] <= 'z')
    p.role = p.name == "x" ? Role::x : p.name == "y" ? Role::y : Role::z;
  if (list && (p.name == "vertex_indices" || p.name == "vertex_index"))
    p.role = e.name == "face" ? Role::corners : e.name == "tristrips" ? Role::strip : Role::none;
  if (e.name == "face" && !list && p.name == "patch" && p.type->integral) p.role = Role::patch;
  if (!list && p.role == Role::none && (e.name == "vertex" || e.name == "face")) p.role = Role::column;
  if ((p.role == Role::corners || p.role == Role::strip) && !p.type->integral)
    fail("the corners of faces are of type " + std::string(p.type->name) + ", not of an integral type");
  for (const Property& other : e.properties)
    if (p.role != Role::none && other.role == p.role && (p.role != Role::column || other.name == p.name))
      fail("property " + quoted(p.name) + " is declared twice");
  e.properties.push_back(std::move(p));
}

void Header::check(const char* element, std::initializer_list<std::pair<const char*, Role>> needs) const {
  const Element* e = find(element);
  if (!e) fail("the header has no element '" + std::string(element) + "'");
  for (auto [name, role] : needs)
    if (std::none_of(e->properties.begin(), e->properties.end(),
                     [role = role](const Property& p) { return p.role == role; }))
      fail("element '" + e->name + "' has no property '" + name + "'");
}

void Header::check_rows(const Element& e) const {
  std::size_t least = 0;
  for (const Property& p : e.properties) least += ascii ? 2 : p.count ? p.count->bytes : p.type->bytes;
  if (least == 0 && e.rows > 0) fail("element " + quoted(e.name) + " has no properties");
  // the last value of a text may lack its line end
  if (e.rows * least > text.after().size() + 1)
    fail("element " + quoted(e.name) + " has " + std::to_string(e.rows) + " rows of at least " +
         std::to_string(least) + " bytes, but only " + std::to_string(text.after().size()) +
         " bytes follow the header");
}

/// Gives a property of role `column` its values, of the type that holds them.
void allocate(Property& p, std::size_t rows) {
  if (p.role != Role::column) return;
  if (!p.type->integral || p.type->bytes == 4)
    p.values = std::vector<double>(rows);  // uint is beyond int
  else if (std::string_view(p.type->name) == "uchar")
    p.values = std::vector<std::uint8_t>(rows);
  else
    p.values = std::vector<int>(rows);
}

std::string ends(const Element& e, std::size_t row) {
  return "the file ends in row " + std::to_string(row) + " of " + quoted(e.name) + ", which has " +
         std::to_string(e.rows);
}

class PlyReader {
 public:
  PlyReader(std::string_view bytes, const std::string& where)
      : bytes_(bytes), header_(bytes, where), text_(header_.text) {}

  Stream read() {
    header_.read();
    ascii_ = header_.ascii;
    at_ = bytes_.size() - text_.after().size();
    stream_.names = std::move(header_.names);
    for (Element& e : header_.elements) rows(e);
    if (ascii_ ? text_.next_line() : at_ != bytes_.size())
      fail(ascii_ ? "more lines than the header declares"
                  : std::to_string(bytes_.size() - at_) + " bytes more than the header declares");
    const int n = static_cast<int>(stream_.surface.points.size());
    if (largest_.vertex >= n)
      text_.fail_at(largest_.place, "face " + std::to_string(largest_.face) + " uses vertex " +
                                        std::to_string(largest_.vertex) + ", but there are " +
                                        std::to_string(n));
    polygons_.patch.resize(polygons_.ends.size(), 0);
    for (Element& e : header_.elements) columns(e);
    set_faces(stream_, polygons_);
    return std::move(stream_);
  }

 private:
  /// Returns the line of a text, or the byte of binary rows.
  std::size_t place() const { return ascii_ ? text_.line() : at_; }
  [[noreturn]] void fail(const std::string& what) const { text_.fail_at(place(), what); }

  void rows(Element& e) {
    const bool vertices = e.name == "vertex", faces = e.name == "face";
    if (vertices) stream_.surface.points.resize(e.rows);
    if (faces) polygons_.ends.reserve(e.rows);
    for (Property& p : e.properties) allocate(p, e.rows);
    for (std::size_t r = 0; r < e.rows; ++r) {
      for (Property& p : e.properties) {
        if (p.count)
          list(p, e, r);
        else if (p.role == Role::none)
          skip(1, *p.type, e, r);
        else if (p.role == Role::column)
          column_value(p, e, r);
        else if (p.role == Role::patch)
          polygons_.patch.push_back(integer(*p.type, e, r, "patch"));
        else
          coordinate(p, e, r);
      }
    }
  }

  void list(const Property& p, const Element& e, std::size_t row) {
    const int n = integer(*p.count, e, row, "a list of length");
    if (n < 0) fail("a list of length " + std::to_string(n));
    const auto size = static_cast<std::size_t>(n);
    if (p.role == Role::corners)
      corners(size, *p.type, e, row);
    else if (p.role == Role::strip)
      strip(size, *p.type, e, row);
    else
      skip(size, *p.type, e, row);
  }

  void column_value(Property& p, const Element& e, std::size_t row) {
    const double v = value(*p.type, e, row, true);
    if (auto* reals = std::get_if<std::vector<double>>(&p.values))
      (*reals)[row] = v;
    else if (auto* ints = std::get_if<std::vector<int>>(&p.values))
      (*ints)[row] = whole(v, e, p.name.c_str(), row);
    else
      std::get<std::vector<std::uint8_t>>(p.values)[row] =
          static_cast<std::uint8_t>(whole(v, e, p.name.c_str(), row, 255) & 255);
  }

  void coordinate(const Property& p, const Element& e, std::size_t row) {
    const double v = value(*p.type, e, row);
    if (!std::isfinite(v)) fail("vertex " + std::to_string(row) + " holds a number that is not finite");
    Vec3& q = stream_.surface.points[row];
    (p.role == Role::x ? q.x : p.role == Role::y ? q.y : q.z) = v;
  }

  /// Adds the values that are not the mesh itself to the stream.
  void columns(Element& e) {
    const bool vertices = e.name == "vertex";
    Table& table = vertices ? stream_.surface.vertex : polygons_.columns;
    for (Property& p : e.properties) {
      if (p.role != Role::column) continue;
      if (!vertices && e.rows != polygons_.ends.size()) {
        leave_out(stream_, table, p.name, "there are triangle strips too");
        continue;
      }
      std::vector<int> ints;
      if (p.type->integral && p.type->bytes == 4 && whole_numbers(p.values, ints)) p.values = std::move(ints);
      add_columns(stream_, table, e.rows, {percent_decode(p.name), 1, std::move(p.values)});
    }
  }

  void corners(std::size_t n, const Type& type, const Element& e, std::size_t row) {
    if (n > max_corners)
      fail("face " + std::to_string(row) + " has " + std::to_string(n) + " corners, the limit is " +
           std::to_string(max_corners));
    for (std::size_t i = 0; i < n; ++i) {
      const int v = integer(type, e, row, "vertex");
      if (v < 0) fail("face " + std::to_string(row) + " uses vertex " + std::to_string(v));
      note(v, row);
      polygons_.corners.push_back(v);
    }
    polygons_.ends.push_back(polygons_.corners.size());
  }

  /// Adds the triangles of strips, which -1 separates. Triangles with equal corners only lead from one strip
  /// to another.
  void strip(std::size_t n, const Type& type, const Element& e, std::size_t row) {
    int a = -1, b = -1;
    bool reversed = false;
    for (std::size_t i = 0; i < n; ++i) {
      const int v = integer(type, e, row, "vertex");
      if (v < -1) fail("strip " + std::to_string(row) + " uses vertex " + std::to_string(v));
      note(v, row);
      if (a >= 0 && v >= 0) {
        if (a != b && b != v && v != a) {
          polygons_.corners.insert(polygons_.corners.end(), {reversed ? b : a, reversed ? a : b, v});
          polygons_.ends.push_back(polygons_.corners.size());
        }
        reversed = !reversed;
      } else {
        reversed = false;
      }
      a = v < 0 ? -1 : b;
      b = v;
    }
  }

  void note(int v, std::size_t row) {
    if (v <= largest_.vertex) return;
    largest_.vertex = v;
    largest_.face = row;
    largest_.place = place();
  }

  int whole(double v, const Element& e, const char* what, std::size_t row,
            int limit = std::numeric_limits<int>::max()) const {
    if (!(std::abs(v) <= limit) || v != std::floor(v)) {
      std::string shown;
      append(shown, v);
      fail(e.name + ' ' + std::to_string(row) + " has " + what + ' ' + shown + ", not a whole number up to " +
           std::to_string(limit));
    }
    return static_cast<int>(v);
  }

  /// Takes the next value, which in a text may be NaN only if `may_be_nan`.
  double value(const Type& type, const Element& e, std::size_t row, bool may_be_nan = false) {
    if (ascii_) {
      while (text_.line_ends())
        if (!text_.next_line()) fail(ends(e, row));
      if (may_be_nan && text_.at_nan()) {
        text_.word();
        return std::numeric_limits<double>::quiet_NaN();
      }
      return text_.number("a finite number");
    }
    if (bytes_.size() - at_ < type.bytes) fail(ends(e, row));
    char buffer[8];
    std::memcpy(buffer, bytes_.data() + at_, type.bytes);
    at_ += type.bytes;
    if (header_.swap) std::reverse(buffer, buffer + type.bytes);
    return type.value(buffer);
  }

  /// Takes the next value, which must be whole; almost always it is written as an int.
  int integer(const Type& type, const Element& e, std::size_t row, const char* what) {
    int small;
    if (ascii_ && text_.leading_integer(small, false)) return small;
    return whole(value(type, e, row), e, what, row);
  }

  void skip(std::size_t n, const Type& type, const Element& e, std::size_t row) {
    if (ascii_) {
      for (std::size_t i = 0; i < n; ++i)
        if (next_word(text_).empty()) fail(ends(e, row));
    } else {
      if ((bytes_.size() - at_) / type.bytes < n) fail(ends(e, row));
      at_ += n * type.bytes;
    }
  }

  std::string_view bytes_;
  Header header_;
  Text& text_;  ///< of header_
  bool ascii_ = false;
  std::size_t at_ = 0;  ///< in binary rows
  Stream stream_;
  Polygons polygons_;
  struct {
    int vertex = -1;
    std::size_t face = 0, place = 0;
  } largest_;  ///< vertex number, and where it is used: vertices may come after the faces
};

}  // namespace

bool is_ply(std::string_view bytes) {
  Text text(bytes.substr(0, 16), "");
  return text.next_line() && text.word() == "ply" && text.line_ends();
}

Stream read_ply(std::string_view bytes, const std::string& where) { return PlyReader(bytes, where).read(); }

std::string write_ply(const Stream& stream, bool ascii) {
  Stream plain;
  plain.surface = stream.surface;
  plain.names = stream.names;
  if (!plain.surface.face.has("patch")) plain.surface.face.set("patch", patches_of(stream));
  // without its mark a stream is an ordinary PLY, which other programs may change as they like
  std::string out = write_stream(plain, ascii);
  const std::string mark = "comment mply 1.0\n";
  return out.erase(out.find(mark), mark.size());
}

}  // namespace meshpipe
