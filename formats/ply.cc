// SPDX-License-Identifier: BSD-3-Clause
#include "formats/ply.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "formats/columns.h"
#include "formats/polygons.h"
#include "formats/text.h"
#include "lib/error.h"

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

/// Elements, and properties of each: their names are looked up one after the other.
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

/// What a property is to us.
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

class PlyReader {
 public:
  PlyReader(std::string_view bytes, const std::string& where)
      : bytes_(bytes), where_(where), text_(bytes, where) {}

  Stream read() {
    header();
    for (Element& e : elements_) rows(e);
    if (ascii_ ? text_.next_line() : at_ != bytes_.size())
      fail(ascii_ ? "more lines than the header declares"
                  : std::to_string(bytes_.size() - at_) + " bytes more than the header declares");
    const int n = static_cast<int>(stream_.surface.points.size());
    if (largest_ >= n)
      fail_at(largest_place_, "face " + std::to_string(largest_face_) + " uses vertex " +
                                  std::to_string(largest_) + ", but there are " + std::to_string(n));
    polygons_.patch.resize(polygons_.ends.size(), 0);
    for (Element& e : elements_) columns(e);
    set_faces(stream_, polygons_);
    return std::move(stream_);
  }

 private:
  [[noreturn]] void fail_at(std::size_t place, const std::string& what) const {
    throw BadInput(where_ + ":" + std::to_string(place) + ": " + what);
  }
  /// Line of a text or of the header, byte of binary rows.
  std::size_t place() const { return ascii_ || in_header_ ? text_.line() : at_; }
  [[noreturn]] void fail(const std::string& what) const { fail_at(place(), what); }

  void header() {
    text_.next_line();  // "ply"
    bool ascii = false, has_format = false;
    for (;;) {
      text_.need_line("'end_header'");
      std::string_view w = text_.word();
      if (w == "end_header") break;
      if (w == "comment") {
        comment();
      } else if (w == "format") {
        if (has_format) fail("a second 'format'");
        has_format = true;
        w = text_.word();
        if (w != "ascii" && w != "binary_little_endian" && w != "binary_big_endian")
          fail(quoted(w) + " where ascii, binary_little_endian or binary_big_endian is due");
        ascii = w == "ascii";
        swap_ = (w == "binary_little_endian") != (std::endian::native == std::endian::little);
      } else if (w == "element") {
        element();
      } else if (w == "property") {
        property();
      } else if (w != "obj_info") {
        fail(quoted(w) + " where 'element', 'property', 'comment' or 'end_header' is due");
      }
    }
    if (!has_format) fail("the header has no 'format'");
    check("vertex", {{"x", Role::x}, {"y", Role::y}, {"z", Role::z}});
    if (std::none_of(elements_.begin(), elements_.end(),
                     [](const Element& e) { return e.name == "tristrips"; }))
      check("face", {{"vertex_indices", Role::corners}});
    else
      check("tristrips", {{"vertex_indices", Role::strip}});
    for (const Element& e : elements_) check_rows(e, ascii);
    at_ = bytes_.size() - text_.after().size();
    in_header_ = false;
    ascii_ = ascii;
  }

  /// Names of patches are kept, as the stream writes them; anything else is a comment like others.
  void comment() {
    long long dim, tag;
    if (text_.word() == "name" && parse_integer(text_.word(), dim) && parse_integer(text_.word(), tag) &&
        dim == 2 && std::abs(tag) <= std::numeric_limits<int>::max())
      stream_.names.push_back({2, static_cast<int>(tag), percent_decode(text_.rest())});
  }

  void element() {
    Element e;
    e.name = text_.word();
    const int rows = text_.integer("a count of rows");
    if (rows < 0) fail("element " + quoted(e.name) + " has " + std::to_string(rows) + " rows");
    if (elements_.size() == max_declared)
      fail("more than " + std::to_string(max_declared) + " elements, which is the limit");
    e.rows = rows;
    for (const Element& other : elements_)
      if (other.name == e.name) fail("element " + quoted(e.name) + " is declared twice");
    elements_.push_back(std::move(e));
  }

  const Type* type() {
    std::string_view w = text_.word();
    for (const Type& t : types)
      if (w == t.name || w == t.other_name) return &t;
    fail(quoted(w) + " where a type is due");
  }

  void property() {
    if (elements_.empty()) fail("a property before the first element");
    Element& e = elements_.back();
    if (e.properties.size() == max_declared)
      fail("element " + quoted(e.name) + " has more than " + std::to_string(max_declared) +
           " properties, which is the limit");
    Property p;
    const bool list = text_.peek() == "list";
    if (list) {
      text_.word();
      p.count = type();
    }
    p.type = type();
    p.name = text_.word();
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

  void check(const char* element, std::initializer_list<std::pair<const char*, Role>> needs) {
    auto e =
        std::find_if(elements_.begin(), elements_.end(), [&](const Element& x) { return x.name == element; });
    if (e == elements_.end()) fail("the header has no element '" + std::string(element) + "'");
    for (auto [name, role] : needs)
      if (std::none_of(e->properties.begin(), e->properties.end(),
                       [role = role](const Property& p) { return p.role == role; }))
        fail("element '" + e->name + "' has no property '" + name + "'");
  }

  void check_rows(const Element& e, bool ascii) {
    std::size_t least = 0;
    for (const Property& p : e.properties) least += ascii ? 2 : p.count ? p.count->bytes : p.type->bytes;
    if (least == 0 && e.rows > 0) fail("element " + quoted(e.name) + " has no properties");
    // the last value of a text may lack its line end
    if (e.rows * least > text_.after().size() + 1)
      fail("element " + quoted(e.name) + " has " + std::to_string(e.rows) + " rows of at least " +
           std::to_string(least) + " bytes, but only " + std::to_string(text_.after().size()) +
           " bytes follow the header");
  }

  void rows(Element& e) {
    const bool vertices = e.name == "vertex", faces = e.name == "face";
    if (vertices) stream_.surface.points.resize(e.rows);
    if (faces) polygons_.ends.reserve(e.rows);
    for (Property& p : e.properties)
      if (p.role == Role::column) {
        if (!p.type->integral || p.type->bytes == 4)
          p.values = std::vector<double>(e.rows);  // uint is beyond int
        else if (std::string_view(p.type->name) == "uchar")
          p.values = std::vector<std::uint8_t>(e.rows);
        else
          p.values = std::vector<int>(e.rows);
      }
    for (std::size_t r = 0; r < e.rows; ++r) {
      for (Property& p : e.properties) {
        if (p.count) {
          const int n = integer(*p.count, e, r, "a list of length");
          if (n < 0) fail("a list of length " + std::to_string(n));
          if (p.role == Role::corners)
            corners(static_cast<std::size_t>(n), *p.type, e, r);
          else if (p.role == Role::strip)
            strip(static_cast<std::size_t>(n), *p.type, e, r);
          else
            skip(static_cast<std::size_t>(n), *p.type, e, r);
        } else if (p.role == Role::none) {
          skip(1, *p.type, e, r);
        } else if (p.role == Role::column) {
          const double v = value(*p.type, e, r, true);
          if (auto* reals = std::get_if<std::vector<double>>(&p.values))
            (*reals)[r] = v;
          else if (auto* ints = std::get_if<std::vector<int>>(&p.values))
            (*ints)[r] = whole(v, e, p.name.c_str(), r);
          else
            std::get<std::vector<std::uint8_t>>(p.values)[r] =
                static_cast<std::uint8_t>(whole(v, e, p.name.c_str(), r, 255) & 255);
        } else {
          if (p.role == Role::patch) {
            polygons_.patch.push_back(integer(*p.type, e, r, "patch"));
            continue;
          }
          const double v = value(*p.type, e, r);
          if (!std::isfinite(v)) fail("vertex " + std::to_string(r) + " holds a number that is not finite");
          Vec3& q = stream_.surface.points[r];
          (p.role == Role::x ? q.x : p.role == Role::y ? q.y : q.z) = v;
        }
      }
    }
  }

  /// Hands the values that are not the mesh itself to the stream.
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

  /// Strips one after the other, with -1 between them. Triangles with a corner twice only lead from one strip
  /// to another.
  void strip(std::size_t n, const Type& type, const Element& e, std::size_t row) {
    int a = -1, b = -1;
    bool turned = false;
    for (std::size_t i = 0; i < n; ++i) {
      const int v = integer(type, e, row, "vertex");
      if (v < -1) fail("strip " + std::to_string(row) + " uses vertex " + std::to_string(v));
      note(v, row);
      if (a >= 0 && v >= 0) {
        if (a != b && b != v && v != a) {
          polygons_.corners.insert(polygons_.corners.end(), {turned ? b : a, turned ? a : b, v});
          polygons_.ends.push_back(polygons_.corners.size());
        }
        turned = !turned;
      } else {
        turned = false;
      }
      a = v < 0 ? -1 : b;
      b = v;
    }
  }

  void note(int v, std::size_t row) {
    if (v <= largest_) return;
    largest_ = v;
    largest_face_ = row;
    largest_place_ = place();
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

  /// The next value of a text, on whatever line it is.
  std::string_view next_word(const Element& e, std::size_t row) {
    for (;;) {
      if (std::string_view w = text_.word(); !w.empty()) return w;
      if (!text_.next_line()) fail(ends(e, row));
    }
  }

  static std::string ends(const Element& e, std::size_t row) {
    return "the file ends in row " + std::to_string(row) + " of " + quoted(e.name) + ", which has " +
           std::to_string(e.rows);
  }

  /// The next value; it may be other than finite in a text only if that `may_be_nan`.
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
    if (swap_) std::reverse(buffer, buffer + type.bytes);
    return type.value(buffer);
  }

  /// The next value, which must be whole: nearly always it is written as an int.
  int integer(const Type& type, const Element& e, std::size_t row, const char* what) {
    int small;
    if (ascii_ && text_.leading_integer(small, false)) return small;
    return whole(value(type, e, row), e, what, row);
  }

  void skip(std::size_t n, const Type& type, const Element& e, std::size_t row) {
    if (ascii_) {
      for (std::size_t i = 0; i < n; ++i) next_word(e, row);
    } else {
      if ((bytes_.size() - at_) / type.bytes < n) fail(ends(e, row));
      at_ += n * type.bytes;
    }
  }

  std::string_view bytes_;
  const std::string& where_;
  Text text_;
  bool ascii_ = false, swap_ = false, in_header_ = true;
  std::size_t at_ = 0;  ///< in binary rows
  std::vector<Element> elements_;
  Stream stream_;
  Polygons polygons_;
  int largest_ = -1;  ///< vertex number, and where it is used: vertices may come after the faces
  std::size_t largest_face_ = 0, largest_place_ = 0;
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
