// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstring>

#include "formats/stream.h"
#include "formats/stream/elements.h"
#include "formats/text.h"
#include "lib/core/error.h"
#include "lib/core/number.h"

namespace meshpipe {
namespace {

[[noreturn]] void fail_at(const std::string& where, std::size_t place, const std::string& what) {
  throw BadInput(where + ":" + std::to_string(place) + ": " + what);
}

/// Reads the header: the elements, and what the comments say of the stream.
class Header {
 public:
  Header(Source& source, const std::string& where, Stream& stream)
      : source_(source), where_(where), stream_(stream) {}

  void read();
  /// Where the rows begin: byte, and line counted from 1.
  std::size_t bytes() const { return at_; }
  std::size_t lines() const { return line_; }

  std::vector<Element> elements;

 private:
  [[noreturn]] void fail(const std::string& what) const { fail_at(where_, line_, what); }
  std::string_view next_line();
  void comment(std::string_view line, const std::vector<std::string_view>& w);
  void element(const std::vector<std::string_view>& w);
  void property(const std::vector<std::string_view>& w);
  void finish(Element& e);

  Source& source_;
  const std::string& where_;
  Stream& stream_;
  std::string_view bytes_;  // as far as it was read
  std::size_t at_ = 0, line_ = 1;
};

std::string_view Header::next_line() {
  std::size_t end;
  while ((end = bytes_.find('\n', at_)) == std::string_view::npos) {
    const std::size_t known = bytes_.size();
    bytes_ = source_.next(known + 1);
    if (bytes_.size() == known) fail("the file ends within line " + std::to_string(line_));
  }
  std::string_view l = bytes_.substr(at_, end - at_);
  at_ = end + 1;
  return l;
}

void Header::read() {
  if (next_line() != "ply") fail("the first line is not 'ply'");
  ++line_;
  std::string_view format = next_line();
  if (format == "format ascii 1.0")
    stream_.ascii = true;
  else if (format != "format binary_little_endian 1.0")
    fail("expected 'format ascii 1.0' or 'format binary_little_endian 1.0', found " + quoted(format));
  ++line_;
  const std::string_view mark = next_line();
  const auto version = words(mark);
  if (version.size() != 3 || version[0] != "comment" || version[1] != "mply")
    fail("expected 'comment mply 1.0', found " + quoted(mark));
  if (!version[2].starts_with("1."))
    fail("mply version " + quoted(version[2]) + ", but this reader knows version 1");
  for (++line_;; ++line_) {
    std::string_view line = next_line();
    auto w = words(line);
    if (line == "end_header") break;
    if (std::any_of(line.begin(), line.end(), [](unsigned char c) { return c < 32 || c == 127; }))
      fail("a control character in the header: " + quoted(line));
    if (w.empty()) fail("an empty line in the header");
    if (w[0] == "comment")
      comment(line, w);
    else if (w[0] == "element")
      element(w);
    else if (w[0] == "property")
      property(w);
    else
      fail("unknown keyword " + quoted(w[0]));
  }
  ++line_;
  if (elements.size() < 2)
    fail("expected the elements 'vertex' and 'face', found " + std::to_string(elements.size()) + " elements");
  for (Element& e : elements) finish(e);
}

void Header::comment(std::string_view line, const std::vector<std::string_view>& w) {
  if (!elements.empty()) fail("a comment after the first element");
  if (w.size() == 5 && w[1] == "name") {
    Name n;
    if (!parse(w[2], n.dim) || !parse(w[3], n.tag) || n.dim < 0 || n.dim > 3)
      fail(quoted(line) + " is not 'comment name DIM TAG NAME'");
    n.text = percent_decode(w[4]);
    stream_.names.push_back(std::move(n));
  } else if (w.size() >= 4 && w[1] == "pg") {
    std::size_t rest = w.size() > 4 ? w[4].data() - line.data() : line.size();
    stream_.history.push_back({std::string(w[2]), std::string(w[3]), std::string(line.substr(rest))});
  } else if (w.size() == 3 && w[1] == "input_triangles") {
    if (!parse(w[2], stream_.input_triangles) || stream_.input_triangles < 0)
      fail(quoted(w[2]) + " is not a count of triangles");
  } else if (w.size() == 3 && w[1] == "asked_triangles") {
    if (!parse(w[2], stream_.asked_triangles) || stream_.asked_triangles < 0)
      fail(quoted(w[2]) + " is not a count of triangles");
  } else if (w.size() == 3 && w[1] == "unit") {
    if (!parse(w[2], stream_.unit) || std::abs(stream_.unit) > most_unit)
      fail(quoted(w[2]) + " is not an exponent from -" + std::to_string(most_unit) + " to " +
           std::to_string(most_unit));
  } else {
    stream_.remarks.emplace_back(line.substr(std::min(line.size(), std::size_t{8})));
  }
}

void Header::element(const std::vector<std::string_view>& w) {
  Element e;
  if (w.size() != 3 || !parse(w[2], e.rows) || e.rows < 0) fail("an element needs a name and a count");
  if (e.rows > max_rows)
    fail("element '" + std::string(w[1]) + "' has " + std::to_string(e.rows) + " rows, the limit is " +
         std::to_string(max_rows));
  e.name = w[1];
  for (const Element& o : elements)
    if (o.name == e.name) fail("element '" + e.name + "' is declared twice");
  static constexpr const char* first[] = {"vertex", "face"};
  if (elements.size() < 2 && e.name != first[elements.size()])
    fail(std::string("expected element '") + first[elements.size()] + "', found '" + e.name + "'");
  elements.push_back(std::move(e));
}

void Header::property(const std::vector<std::string_view>& w) {
  if (elements.empty()) fail("a property before the first element");
  Element& e = elements.back();
  if (w.size() == 5 && w[1] == "list") {
    if (e.name != "face" || !e.properties.empty() || e.has_list || w[2] != "uchar" || w[3] != "int" ||
        w[4] != "vertex_indices")
      fail("the only list is 'property list uchar int vertex_indices', first in 'face'");
    e.has_list = true;
    return;
  }
  if (w.size() != 3) fail("a property needs a type and a name");
  if (e.name == "face" && !e.has_list)
    fail("expected 'property list uchar int vertex_indices' first in 'face', found " + quoted(w[2]));
  auto type = std::find(std::begin(type_names), std::end(type_names), w[1]);
  if (type == std::end(type_names)) fail("expected type uchar, int or double, found " + quoted(w[1]));
  for (const Property& p : e.properties)
    if (p.name == w[2]) fail("property '" + p.name + "' of '" + e.name + "' is declared twice");
  e.properties.push_back({static_cast<Type>(type - type_names), std::string(w[2])});
}

/// Checks what vertex and face must have, and before anything is allocated that the file is long enough.
void Header::finish(Element& e) {
  if (e.name == "vertex") {
    static constexpr const char* xyz[] = {"x", "y", "z"};
    for (int i = 0; i < 3; ++i)
      if ((int)e.properties.size() <= i || e.properties[i].name != xyz[i] ||
          e.properties[i].type != Type::real)
        fail(std::string("property ") + std::to_string(i) + " of 'vertex' must be 'double " + xyz[i] + "'");
  }
  if (e.name == "face" && !e.has_list) fail("'face' has no vertex_indices");
  if (e.properties.empty() && !e.has_list) fail("element '" + e.name + "' has no properties");
  e.stride = e.has_list ? 13 : 0;
  for (const Property& p : e.properties) e.stride += type_sizes[(int)p.type];
  // an ascii row has at least a digit and a blank per value
  std::size_t least = stream_.ascii ? 2 * (e.properties.size() + (e.has_list ? 4 : 0)) : e.stride;
  if (e.rows * least > source_.most_left())
    fail("element '" + e.name + "' has " + std::to_string(e.rows) + " rows, but only " +
         std::to_string(source_.most_left() - at_) + " bytes follow the header");
}

std::size_t place(const Stream& stream, const Element& e, long long row) {
  return stream.ascii ? e.first + row : e.first + row * e.stride;
}

/// Reads the rows of the elements.
class Rows {
 public:
  /// `at` and `line`: where the rows begin.
  Rows(Source& source, const std::string& where, const Wanted& wanted, Stream& stream, std::size_t at,
       std::size_t line)
      : source_(source), where_(where), wanted_(wanted), stream_(stream), at_(at), line_(line) {}

  void read(std::vector<Element>& elements) {
    constexpr auto all = std::string_view::npos;
    if (stream_.ascii) bytes_ = source_.next(all), at_ = 0;
    for (Element& e : elements) {
      if (stream_.ascii)
        read_ascii(e);
      else
        read_binary(e);
      if (!stream_.tables.empty() && stream_.tables.back().columns.empty()) stream_.tables.pop_back();
    }
    if (stream_.ascii) source_.drop(at_);
  }

  /// Throws: BadInput if something follows, except for another stream where there may be `several`.
  void expect_end(const Element& last, bool several) {
    const bool another = source_.next(4).starts_with("ply\n");
    if (another && !several) fail("another stream follows; only mrelax and mcheck read shards");
    if (const std::size_t left = another ? 0 : source_.next(std::string_view::npos).size(); left > 0)
      fail(std::to_string(left) + " bytes follow the last row of '" + last.name + "'");
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    fail_at(where_, stream_.ascii ? line_ : at_, what);
  }

  /// Gives every wanted property of an element its column, except those that the mesh itself holds.
  void declare(const Element& e, Table& table) {
    constexpr long long most = 1 << 26;  // a damaged header does not ask for more
    const std::size_t rows = std::min(e.rows, most);
    table.name = e.name;
    offsets_.clear();
    std::size_t offset = e.has_list ? 13 : 0;
    for (std::size_t i = 0; i < e.properties.size(); offset += type_sizes[(int)e.properties[i++].type]) {
      const Property& p = e.properties[i];
      if ((e.name == "vertex" && i < 3) || !(stream_.ascii || is_wanted(e, p.name))) continue;
      Column& c = table.columns.emplace_back(Column{p.name, {}});
      if (p.type == Type::uchar) c.data = std::vector<std::uint8_t>();
      if (p.type == Type::integer) c.data = std::vector<int>();
      if (p.type == Type::real) c.data = std::vector<double>();
      std::visit([&](auto& v) { v.reserve(rows); }, c.data);
      offsets_.push_back(offset);
    }
    has_points_ = e.name == "vertex" && (stream_.ascii || is_wanted(e, "x"));
    has_tris_ = e.has_list && (stream_.ascii || is_wanted(e, "vertex_indices"));
    if (has_points_) stream_.surface.points.reserve(rows);
    if (has_tris_) stream_.surface.tris.reserve(rows);
    if (has_points_ || has_tris_ || !table.columns.empty()) table.rows = e.rows;
  }
  void resize(Table& table, std::size_t rows) {
    if (has_points_) stream_.surface.points.resize(rows);
    if (has_tris_) stream_.surface.tris.resize(rows);
    for (Column& c : table.columns) std::visit([&](auto& v) { v.resize(rows); }, c.data);
  }

  Table& table_for(const Element& e) {
    if (e.name == "vertex") return stream_.surface.vertex;
    if (e.name == "face") return stream_.surface.face;
    return stream_.tables.emplace_back();
  }

  void read_binary(Element& e) {
    constexpr std::size_t block = 1 << 18;  // bytes that stay in the cache
    e.first = at_;
    Table& table = table_for(e);
    declare(e, table);
    if (table.rows == 0) source_.skip(e.rows * e.stride);
    for (long long first = 0, end; first < (long long)table.rows; first = end) {
      const long long wanted = std::min<long long>(e.rows - first, block / e.stride + 1);
      const std::string_view bytes = source_.next(wanted * e.stride);
      end = first + std::min<long long>(e.rows - first, bytes.size() / e.stride);
      if (end == first)
        fail("the file ends within '" + e.name + "': expected " + std::to_string(e.rows) + " rows of " +
             std::to_string(e.stride) + " bytes, but only " +
             std::to_string(first * e.stride + bytes.size()) + " bytes are left");
      end = std::min(end, first + wanted);
      resize(table, end);
      take_rows(e, table, bytes.data(), first, end);
      source_.drop((end - first) * e.stride);
    }
    at_ += e.rows * e.stride;
  }

  /// Takes rows of which the first is at `base`.
  void take_rows(const Element& e, Table& table, const char* base, long long first, long long end) {
    if (has_points_) {
      for (long long i = first; i < end; ++i) {
        Vec3& p = stream_.surface.points[i];
        std::memcpy(&p, base + (i - first) * e.stride, 24);
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) not_finite(e, i);
      }
    } else if (has_tris_) {
      for (long long i = first; i < end; ++i) {
        const char* row = base + (i - first) * e.stride;
        std::memcpy(stream_.surface.tris[i].data(), row + 1, 12);
        if (*row != 3)
          fail_at(where_, place(stream_, e, i),
                  "face " + std::to_string(i) + " has " + std::to_string((unsigned char)*row) +
                      " corners, not 3");
      }
    }
    for (std::size_t k = 0; k < offsets_.size(); ++k)
      std::visit(
          [&]<class T>(std::vector<T>& v) {
            for (long long i = first; i < end; ++i) {
              std::memcpy(&v[i], base + (i - first) * e.stride + offsets_[k], sizeof(T));
              if constexpr (std::is_same_v<T, double>)
                if (!std::isfinite(v[i])) not_finite(e, i);
            }
          },
          table.columns[k].data);
  }

  [[noreturn]] void not_finite(const Element& e, long long row) const {
    fail_at(where_, place(stream_, e, row),
            e.name + " " + std::to_string(row) + " holds a number that is not finite");
  }

  template <class T>
  T number(const Element& e, long long row) {
    while (at_ < bytes_.size() && bytes_[at_] == ' ') ++at_;
    const char* end = bytes_.data() + bytes_.size();
    T value{};
    int small = 0;
    std::from_chars_result r;
    if constexpr (sizeof(T) == 1) {
      r = from_chars(bytes_.data() + at_, end, small);
      if (small < 0 || small > 255) r.ec = std::errc::result_out_of_range;
      value = static_cast<T>(small);
    } else {
      r = from_chars(bytes_.data() + at_, end, value);
    }
    if (r.ec != std::errc() || (r.ptr != end && *r.ptr != ' ' && *r.ptr != '\n')) {
      if (at_ >= bytes_.size())
        fail("the file ends at row " + std::to_string(row) + " of '" + e.name + "', expected " +
             std::to_string(e.rows) + " rows");
      std::size_t stop = std::min(bytes_.find_first_of(" \n", at_), bytes_.size());
      fail(std::string("expected a value of type ") +
           (sizeof(T) == 8   ? "double"
            : sizeof(T) == 4 ? "int"
                             : "uchar") +
           " in row " + std::to_string(row) + " of '" + e.name + "', found " +
           quoted(bytes_.substr(at_, stop - at_)));
    }
    at_ = r.ptr - bytes_.data();
    if constexpr (sizeof(T) == 8)
      if (!std::isfinite(value)) not_finite(e, row);
    return value;
  }

  void read_ascii(Element& e) {
    e.first = line_;
    Table& table = table_for(e);
    declare(e, table);
    resize(table, e.rows);
    for (long long r = 0; r < e.rows; ++r, ++line_) {
      if (e.name == "vertex") {
        Vec3& p = stream_.surface.points[r];
        p.x = number<double>(e, r);
        p.y = number<double>(e, r);
        p.z = number<double>(e, r);
      } else if (e.has_list) {
        if (int corners = number<int>(e, r); corners != 3)
          fail("face " + std::to_string(r) + " has " + std::to_string(corners) + " corners, not 3");
        for (int& v : stream_.surface.tris[r]) v = number<int>(e, r);
      }
      for (Column& c : table.columns) {
        std::visit([&](auto& v) { v[r] = number<typename std::decay_t<decltype(v)>::value_type>(e, r); },
                   c.data);
      }
      while (at_ < bytes_.size() && bytes_[at_] == ' ') ++at_;
      if (at_ >= bytes_.size()) fail("row " + std::to_string(r) + " of '" + e.name + "' has no line end");
      if (bytes_[at_] != '\n')
        fail("row " + std::to_string(r) + " of '" + e.name + "' has more values than its columns");
      ++at_;
    }
    std::erase_if(table.columns, [&](const Column& c) { return !is_wanted(e, c.name); });
    if (has_points_ && !is_wanted(e, "x")) stream_.surface.points = {};
    if (has_tris_ && !is_wanted(e, "vertex_indices")) stream_.surface.tris = {};
  }

  bool is_wanted(const Element& e, std::string_view column) const {
    return !wanted_ || wanted_(e.name, column);
  }

  Source& source_;
  const std::string& where_;
  const Wanted& wanted_;
  Stream& stream_;
  std::vector<std::size_t> offsets_;  // of the element's columns in a row
  bool has_points_ = false, has_tris_ = false;
  std::string_view bytes_;  // of an ascii stream: all after the header
  std::size_t at_, line_;
};

/// Checks the indices of a stream that was read.
class IndexCheck {
 public:
  IndexCheck(const Stream& stream, const std::vector<Element>& elements, const std::string& where)
      : stream_(stream), elements_(elements), where_(where) {}

  void corners() const;
  /// Checks a column of rows of another table; -1 (none) is allowed if that is `least`.
  void column(const char* table, const char* name, const char* into, int least = 0) const;
  /// Checks that a column holds numbers of rows of some table that is not there any more.
  void row_numbers(const char* table, const char* name) const;
  void parts_have_faces() const;

 private:
  struct Values {
    const Element* element;
    const std::vector<int>* values;  ///< null: there is no such column
  };
  const Element* find(std::string_view table) const;
  Values values(const char* table, const char* name) const;
  [[noreturn]] void fail(const Element& e, std::size_t row, const std::string& what) const {
    fail_at(where_, place(stream_, e, static_cast<long long>(row)), what);
  }

  const Stream& stream_;
  const std::vector<Element>& elements_;
  const std::string& where_;
};

const Element* IndexCheck::find(std::string_view table) const {
  const auto e =
      std::find_if(elements_.begin(), elements_.end(), [&](const Element& x) { return x.name == table; });
  return e == elements_.end() ? nullptr : &*e;
}

IndexCheck::Values IndexCheck::values(const char* table, const char* name) const {
  const Element* e = find(table);
  if (!e) return {};
  const Surface& s = stream_.surface;
  const Table* t = e->name == "vertex" ? &s.vertex : e->name == "face" ? &s.face : stream_.find(table);
  const Column* column = t ? t->find(name) : nullptr;
  if (!column) return {};
  if (!std::holds_alternative<std::vector<int>>(column->data))
    fail(*e, 0, std::string("column '") + name + "' of '" + table + "' is not of type int");
  return {e, &t->get<int>(name)};
}

void IndexCheck::corners() const {
  const Surface& s = stream_.surface;
  const int n = static_cast<int>(s.points.size());
  for (std::size_t t = 0; t < s.tris.size(); ++t)
    for (int v : s.tris[t])
      if (v < 0 || v >= n)
        fail(elements_[1], t,
             "face " + std::to_string(t) + " uses vertex " + std::to_string(v) + ", but there are " +
                 std::to_string(n));
}

void IndexCheck::column(const char* table, const char* name, const char* into, int least) const {
  const Element* target = find(into);
  if (!target) return;
  const auto [element, v] = values(table, name);
  for (std::size_t i = 0; v && i < v->size(); ++i)
    if ((*v)[i] < least || (*v)[i] >= target->rows)
      fail(*element, i,
           std::string(table) + " " + std::to_string(i) + " has " + name + " " + std::to_string((*v)[i]) +
               ", but '" + into + "' has " + std::to_string(target->rows) + " rows");
}

void IndexCheck::row_numbers(const char* table, const char* name) const {
  const auto [element, v] = values(table, name);
  for (std::size_t i = 0; v && i < v->size(); ++i)
    if ((*v)[i] < 0 || (*v)[i] >= max_rows)
      fail(*element, i,
           std::string(table) + " " + std::to_string(i) + " has " + name + " " + std::to_string((*v)[i]) +
               ", expected 0 to " + std::to_string(max_rows - 1));
}

void IndexCheck::parts_have_faces() const {
  const Element* parts = find("part");
  if (!parts) return;  // without parts the column may be data of a foreign file
  const auto [element, v] = values("face", "part");
  if (!v) return;
  std::vector<char> has_face(parts->rows, 0);
  for (int p : *v) has_face[p] = 1;
  for (std::size_t p = 0; p < has_face.size(); ++p)
    if (!has_face[p])
      fail(*parts, p,
           "part " + std::to_string(p) + " has no face, but 'part' has one row per part of the faces");
}

/// Checks every column that points into another table.
void check_indices(const Stream& stream, const std::vector<Element>& elements, const std::string& where) {
  const IndexCheck check(stream, elements, where);
  // from mlift on, lines and charts index the surface that is kept as ref_*
  const bool lifted = stream.find("ref_vertex") != nullptr;
  const char *vertex = lifted ? "ref_vertex" : "vertex", *face = lifted ? "ref_face" : "face";
  // what was made of a shard is checked when it is joined to the surface
  if (stream.find("shard") && stream.surface.points.empty()) vertex = face = "";
  check.corners();
  for (const char* table : {"face", "chart_vertex", "line_use", "chart_point", "chart_face", "ref_face"})
    check.column(table, "part", "part");
  check.column("chart_vertex", "vertex", vertex);
  check.column("line_use", "line", "line");
  check.column("line_vertex", "vertex_a", vertex);
  check.column("line_vertex", "vertex_b", vertex);
  check.column("chart_point", "line_vertex", "line_vertex", -1);
  check.column("chart_point", "face", face, -1);
  for (const char* corner : {"a", "b", "c"}) {
    check.column("chart_face", corner, "chart_point");
    check.column("ref_face", corner, "ref_vertex");
    check.column("fine_face", corner, "fine_vertex");
    check.column("other_face", corner, "other_vertex");
  }
  check.column("vertex", "ref_face", "ref_face");
  check.column("vertex", "line", "line", -1);
  check.column("mid_vertex", "a", "vertex");
  check.column("mid_vertex", "b", "vertex");
  check.row_numbers("ref_face", "origin");
  // without parts it may be data of a foreign file
  if (stream.find("part")) check.row_numbers("face", "origin");
  if (!lifted && !stream.surface.tris.empty()) check.parts_have_faces();
}

}  // namespace

Stream read_stream(Source& source, const std::string& where, bool several, const Wanted& wanted) {
  if (const std::string_view bytes = source.next(200); bytes.starts_with("mply-failed ")) {
    auto w = words(bytes.substr(0, std::min(bytes.find('\n'), bytes.size())));
    int status = 1;
    if (w.size() == 3 && parse(w[2], status) && status > 0 && status < 256 &&
        std::all_of(w[1].begin(), w[1].end(), [](unsigned char c) { return c > 32 && c < 127; }))
      throw UpstreamFailed{std::string(w[1]), status};
    throw BadInput(where + ":1: a damaged 'mply-failed' line");
  }
  Stream stream;
  Header header(source, where, stream);
  header.read();
  source.drop(header.bytes());
  Rows rows(source, where, wanted, stream, header.bytes(), header.lines());
  rows.read(header.elements);
  rows.expect_end(header.elements.back(), several);
  check_indices(stream, header.elements, where);
  return stream;
}

Stream read_stream(std::string_view bytes, const std::string& where) {
  MemorySource memory(bytes);
  return read_stream(memory, where);
}

}  // namespace meshpipe
