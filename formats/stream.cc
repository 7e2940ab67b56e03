// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include "formats/text.h"
#include "lib/error.h"

namespace meshpipe {
namespace {

static_assert(std::endian::native == std::endian::little, "the binary stream is little endian");

enum class Type { uchar, integer, real };
constexpr const char* type_names[] = {"uchar", "int", "double"};
constexpr std::size_t type_sizes[] = {1, 4, 8};
/// Half-edges 3 t + i must fit into an int.
constexpr long long max_rows = 715827882;

struct Property {
  Type type;
  std::string name;
};
/// An element as the header declares it, and where its rows are (for messages).
struct Element {
  std::string name;
  long long rows = 0;
  bool has_list = false;
  std::vector<Property> properties;
  std::size_t first = 0;   ///< line (ascii) or byte (binary) of the first row
  std::size_t stride = 0;  ///< bytes a row (binary)
};

[[noreturn]] void fail_at(const std::string& where, std::size_t place, const std::string& what) {
  throw BadInput(where + ":" + std::to_string(place) + ": " + what);
}

std::vector<std::string_view> words(std::string_view line) {
  std::vector<std::string_view> out;
  for (std::size_t i = 0; i < line.size();) {
    if (line[i] == ' ') {
      ++i;
      continue;
    }
    std::size_t j = std::min(line.find(' ', i), line.size());
    out.push_back(line.substr(i, j - i));
    i = j;
  }
  return out;
}

template <class T>
bool parse(std::string_view text, T& value) {
  auto r = std::from_chars(text.data(), text.data() + text.size(), value);
  return r.ec == std::errc() && r.ptr == text.data() + text.size();
}

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& where) : bytes_(bytes), where_(where) {}

  Stream read() {
    header();
    for (Element& e : elements_) {
      if (stream_.ascii)
        read_ascii(e);
      else
        read_binary(e);
    }
    if (at_ != bytes_.size()) {
      fail(std::to_string(bytes_.size() - at_) + " bytes follow the last row of '" + elements_.back().name +
           "'");
    }
    check_indices();
    return std::move(stream_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    fail_at(where_, stream_.ascii || in_header_ ? line_ : at_, what);
  }

  std::string_view next_line() {
    std::size_t end = bytes_.find('\n', at_);
    if (end == std::string_view::npos) fail("the file ends within line " + std::to_string(line_));
    std::string_view l = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    return l;
  }

  void header() {
    if (next_line() != "ply") fail("the first line is not 'ply'");
    ++line_;
    std::string_view format = next_line();
    if (format == "format ascii 1.0")
      stream_.ascii = true;
    else if (format != "format binary_little_endian 1.0")
      fail(quoted(format) + " where 'format ascii 1.0' or 'format binary_little_endian 1.0' is due");
    ++line_;
    auto version = words(next_line());
    if (version.size() != 3 || version[0] != "comment" || version[1] != "mply")
      fail("'comment mply 1.0' is due here");
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
    in_header_ = false;
    ++line_;
    if (elements_.size() < 2)
      fail("the header declares " + std::to_string(elements_.size()) +
           " elements, but 'vertex' and 'face' are due");
    for (Element& e : elements_) finish(e);
  }

  void comment(std::string_view line, const std::vector<std::string_view>& w) {
    if (!elements_.empty()) fail("a comment after the first element");
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
    } else {
      stream_.remarks.emplace_back(line.substr(std::min(line.size(), std::size_t{8})));
    }
  }

  void element(const std::vector<std::string_view>& w) {
    Element e;
    if (w.size() != 3 || !parse(w[2], e.rows) || e.rows < 0) fail("an element needs a name and a count");
    if (e.rows > max_rows)
      fail("element '" + std::string(w[1]) + "' has " + std::to_string(e.rows) + " rows, the limit is " +
           std::to_string(max_rows));
    e.name = w[1];
    for (const Element& o : elements_)
      if (o.name == e.name) fail("element '" + e.name + "' is declared twice");
    static constexpr const char* due[] = {"vertex", "face"};
    if (elements_.size() < 2 && e.name != due[elements_.size()])
      fail("element '" + e.name + "' where '" + due[elements_.size()] + "' is due");
    elements_.push_back(std::move(e));
  }

  void property(const std::vector<std::string_view>& w) {
    if (elements_.empty()) fail("a property before the first element");
    Element& e = elements_.back();
    if (w.size() == 5 && w[1] == "list") {
      if (e.name != "face" || !e.properties.empty() || e.has_list || w[2] != "uchar" || w[3] != "int" ||
          w[4] != "vertex_indices")
        fail("the only list is 'property list uchar int vertex_indices', first in 'face'");
      e.has_list = true;
      return;
    }
    if (w.size() != 3) fail("a property needs a type and a name");
    if (e.name == "face" && !e.has_list)
      fail("'property list uchar int vertex_indices' is due first in 'face'");
    auto type = std::find(std::begin(type_names), std::end(type_names), w[1]);
    if (type == std::end(type_names))
      fail("type " + quoted(w[1]) + ", but the types are uchar, int and double");
    for (const Property& p : e.properties)
      if (p.name == w[2]) fail("property '" + p.name + "' of '" + e.name + "' is declared twice");
    e.properties.push_back({static_cast<Type>(type - type_names), std::string(w[2])});
  }

  /// Checks what vertex and face must have, and that the file is long enough before anything is allocated.
  void finish(Element& e) {
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
    // an ascii row has at least a digit and a blank a value
    std::size_t least = stream_.ascii ? 2 * (e.properties.size() + (e.has_list ? 4 : 0)) : e.stride;
    if (e.rows * least > bytes_.size())
      fail("element '" + e.name + "' has " + std::to_string(e.rows) + " rows, but only " +
           std::to_string(bytes_.size() - at_) + " bytes follow the header");
  }

  /// Gives every property of an element its column; the first three of vertex and the list of face go to the
  /// mesh.
  void allocate(const Element& e, Table& table) {
    table.name = e.name;
    table.rows = e.rows;
    for (const Property& p : e.properties) {
      Column c{p.name, {}};
      if (p.type == Type::uchar) c.data = std::vector<std::uint8_t>(e.rows);
      if (p.type == Type::integer) c.data = std::vector<int>(e.rows);
      if (p.type == Type::real) c.data = std::vector<double>(e.rows);
      table.columns.push_back(std::move(c));
    }
    if (e.name == "vertex") {
      table.columns.erase(table.columns.begin(), table.columns.begin() + 3);
      stream_.surface.points.resize(e.rows);
    }
    if (e.name == "face") stream_.surface.tris.resize(e.rows);
  }

  Table& table_for(const Element& e) {
    if (e.name == "vertex") return stream_.surface.vertex;
    if (e.name == "face") return stream_.surface.face;
    return stream_.tables.emplace_back();
  }

  void read_binary(Element& e) {
    e.first = at_;
    if (e.rows * e.stride > bytes_.size() - at_)
      fail("the file ends within '" + e.name + "': " + std::to_string(e.rows) + " rows of " +
           std::to_string(e.stride) + " bytes are due, but only " + std::to_string(bytes_.size() - at_) +
           " bytes are left");
    Table& table = table_for(e);
    allocate(e, table);
    const char* base = bytes_.data() + at_;
    std::size_t offset = 0;
    if (e.name == "vertex") {
      for (long long r = 0; r < e.rows; ++r) {
        Vec3& p = stream_.surface.points[r];
        std::memcpy(&p, base + r * e.stride, 24);
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) not_finite(e, r);
      }
      offset = 24;
    } else if (e.has_list) {
      for (long long r = 0; r < e.rows; ++r) {
        const char* row = base + r * e.stride;
        if (*row != 3) {
          at_ += r * e.stride;
          fail("face " + std::to_string(r) + " has " + std::to_string((unsigned char)*row) +
               " corners, not 3");
        }
        std::memcpy(stream_.surface.tris[r].data(), row + 1, 12);
      }
      offset = 13;
    }
    for (Column& c : table.columns) {
      std::visit(
          [&](auto& v) {
            using T = typename std::decay_t<decltype(v)>::value_type;
            for (long long r = 0; r < e.rows; ++r) {
              std::memcpy(&v[r], base + r * e.stride + offset, sizeof(T));
              if constexpr (std::is_same_v<T, double>)
                if (!std::isfinite(v[r])) not_finite(e, r);
            }
            offset += sizeof(T);
          },
          c.data);
    }
    at_ += e.rows * e.stride;
  }

  [[noreturn]] void not_finite(const Element& e, long long row) const {
    fail_at(where_, place(e, row), e.name + " " + std::to_string(row) + " holds a number that is not finite");
  }

  std::size_t place(const Element& e, long long row) const {
    return stream_.ascii ? e.first + row : e.first + row * e.stride;
  }

  template <class T>
  T number(const Element& e, long long row) {
    while (at_ < bytes_.size() && bytes_[at_] == ' ') ++at_;
    const char* end = bytes_.data() + bytes_.size();
    T value{};
    int small = 0;
    std::from_chars_result r;
    if constexpr (sizeof(T) == 1) {
      r = std::from_chars(bytes_.data() + at_, end, small);
      if (small < 0 || small > 255) r.ec = std::errc::result_out_of_range;
      value = static_cast<T>(small);
    } else {
      r = std::from_chars(bytes_.data() + at_, end, value);
    }
    if (r.ec != std::errc() || (r.ptr != end && *r.ptr != ' ' && *r.ptr != '\n')) {
      if (at_ >= bytes_.size())
        fail("the file ends at row " + std::to_string(row) + " of '" + e.name + "', but " +
             std::to_string(e.rows) + " rows are due");
      std::size_t stop = std::min(bytes_.find_first_of(" \n", at_), bytes_.size());
      fail(quoted(bytes_.substr(at_, stop - at_)) + " in row " + std::to_string(row) + " of '" + e.name +
           "' is not a value of type " +
           (sizeof(T) == 8   ? "double"
            : sizeof(T) == 4 ? "int"
                             : "uchar"));
    }
    at_ = r.ptr - bytes_.data();
    if constexpr (sizeof(T) == 8)
      if (!std::isfinite(value)) not_finite(e, row);
    return value;
  }

  void read_ascii(Element& e) {
    e.first = line_;
    Table& table = table_for(e);
    allocate(e, table);
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
  }

  /// Every column that points into another table, and from where on: -1 means none.
  void check_indices() {
    struct Rule {
      const char *table, *column, *into;
      int least;
    };
    // before mlift lines and charts index the surface, from then on the surface kept as ref_*
    const bool lifted = stream_.find("ref_vertex") != nullptr;
    const char* vertex = lifted ? "ref_vertex" : "vertex";
    const char* face = lifted ? "ref_face" : "face";
    const Rule rules[] = {{"face", "part", "part", 0},
                          {"chart_vertex", "part", "part", 0},
                          {"chart_vertex", "vertex", vertex, 0},
                          {"line_use", "line", "line", 0},
                          {"line_use", "part", "part", 0},
                          {"line_vertex", "vertex_a", vertex, 0},
                          {"line_vertex", "vertex_b", vertex, 0},
                          {"chart_point", "part", "part", 0},
                          {"chart_point", "line_vertex", "line_vertex", -1},
                          {"chart_point", "face", face, -1},
                          {"chart_face", "part", "part", 0},
                          {"chart_face", "a", "chart_point", 0},
                          {"chart_face", "b", "chart_point", 0},
                          {"chart_face", "c", "chart_point", 0},
                          {"vertex", "ref_face", "ref_face", 0},
                          {"vertex", "line", "line", -1},
                          {"mid_vertex", "a", "vertex", 0},
                          {"mid_vertex", "b", "vertex", 0},
                          {"ref_face", "a", "ref_vertex", 0},
                          {"ref_face", "b", "ref_vertex", 0},
                          {"ref_face", "c", "ref_vertex", 0},
                          {"ref_face", "part", "part", 0}};
    const Surface& s = stream_.surface;
    const int n = (int)s.points.size();
    for (int t = 0; t < (int)s.tris.size(); ++t)
      for (int v : s.tris[t])
        if (v < 0 || v >= n)
          fail_at(where_, place(elements_[1], t),
                  "face " + std::to_string(t) + " uses vertex " + std::to_string(v) + ", but there are " +
                      std::to_string(n));
    for (const Rule& r : rules) {
      auto rows = [&](std::string_view name) {
        auto e = std::find_if(elements_.begin(), elements_.end(),
                              [&](const Element& x) { return x.name == name; });
        return e == elements_.end() ? nullptr : &*e;
      };
      const Element *from = rows(r.table), *into = rows(r.into);
      if (!from || !into) continue;
      const Table& table = from->name == "vertex" ? s.vertex
                           : from->name == "face" ? s.face
                                                  : *stream_.find(r.table);
      const Column* column = table.find(r.column);
      if (!column) continue;
      if (!std::holds_alternative<std::vector<int>>(column->data))
        fail_at(where_, place(*from, 0),
                std::string("column '") + r.column + "' of '" + r.table + "' is not of type int");
      const auto& values = table.get<int>(r.column);
      for (int i = 0; i < (int)values.size(); ++i)
        if (values[i] < r.least || values[i] >= into->rows)
          fail_at(where_, place(*from, i),
                  std::string(r.table) + " " + std::to_string(i) + " has " + r.column + " " +
                      std::to_string(values[i]) + ", but '" + r.into + "' has " + std::to_string(into->rows) +
                      " rows");
    }
  }

  std::string_view bytes_;
  const std::string& where_;
  std::size_t at_ = 0, line_ = 1;
  bool in_header_ = true;
  std::vector<Element> elements_;
  Stream stream_;
};

template <class T>
void append_text(std::string& out, T value) {
  char buffer[32];
  char* end;
  if constexpr (sizeof(T) == 1)
    end = std::to_chars(buffer, buffer + 32, int{value}).ptr;
  else
    end = std::to_chars(buffer, buffer + 32, value).ptr;
  out.append(buffer, end - buffer);
}

void declare(std::string& out, const Table& table, std::size_t rows) {
  out += "element " + table.name + ' ' + std::to_string(rows) + '\n';
  if (table.name == "vertex") out += "property double x\nproperty double y\nproperty double z\n";
  if (table.name == "face") out += "property list uchar int vertex_indices\n";
  for (const Column& c : table.columns)
    out += std::string("property ") + type_names[c.data.index()] + ' ' + c.name + '\n';
}

/// One table's rows, in blocks that are handed on as they fill `out`; `mesh_row(r, row)` writes what the mesh
/// itself holds of row r to `row`, or appends it to `out` if that is null.
template <class MeshRow>
void write_rows(std::string& out, const Sink& sink, const Table& table, std::size_t rows, bool ascii,
                std::size_t mesh_bytes, const MeshRow& mesh_row) {
  constexpr std::size_t block_bytes = 1 << 20;
  std::size_t stride = mesh_bytes;
  for (const Column& c : table.columns) stride += type_sizes[c.data.index()];
  const std::size_t block = std::max<std::size_t>(1, block_bytes / std::max<std::size_t>(1, stride));
  for (std::size_t first = 0; first < rows; first += block) {
    const std::size_t end = std::min(first + block, rows);
    if (ascii) {
      for (std::size_t r = first; r < end; ++r) {
        mesh_row(r, nullptr);
        for (const Column& c : table.columns) {
          std::visit([&](const auto& v) { append_text(out, v[r]); }, c.data);
          out += ' ';
        }
        out.back() = '\n';
      }
    } else {
      const std::size_t start = out.size();
      out.resize(start + (end - first) * stride);
      char* const base = out.data() + start;
      if (mesh_bytes)
        for (std::size_t r = first; r < end; ++r) mesh_row(r, base + (r - first) * stride);
      std::size_t offset = mesh_bytes;
      for (const Column& c : table.columns)
        std::visit(
            [&](const auto& v) {
              for (std::size_t r = first; r < end; ++r)
                std::memcpy(base + (r - first) * stride + offset, &v[r], sizeof v[r]);
              offset += sizeof v[0];
            },
            c.data);
    }
    if (out.size() >= block_bytes) {
      sink(out);
      out.clear();
    }
  }
}

}  // namespace

const Table* Stream::find(std::string_view table) const {
  for (const Table& t : tables)
    if (t.name == table) return &t;
  return nullptr;
}

const Table& Stream::need(std::string_view table, std::string_view writer) const {
  const Table* t = find(table);
  if (!t)
    throw NotAdmissible("no section '" + std::string(table) + "'; run " + std::string(writer) + " first");
  return *t;
}

void Stream::set(Table table) {
  for (Table& t : tables)
    if (t.name == table.name) {
      t = std::move(table);
      return;
    }
  tables.push_back(std::move(table));
}

void Stream::erase(std::string_view table) {
  std::erase_if(tables, [&](const Table& t) { return t.name == table; });
}

std::string Stream::name_of(int dim, int tag) const {
  for (const Name& n : names)
    if (n.dim == dim && n.tag == tag) return n.text;
  return {};
}

bool is_stream(std::string_view bytes) {
  if (bytes.starts_with("mply-failed ")) return true;
  if (!bytes.starts_with("ply\n")) return false;
  std::size_t second = bytes.find('\n', 4);
  return second != std::string_view::npos && bytes.substr(second + 1).starts_with("comment mply ");
}

Stream read_stream(std::string_view bytes, const std::string& where) {
  if (bytes.starts_with("mply-failed ")) {
    auto w = words(bytes.substr(0, std::min(bytes.find('\n'), bytes.size())));
    int status = 1;
    if (w.size() == 3 && parse(w[2], status) && status > 0 && status < 256 &&
        std::all_of(w[1].begin(), w[1].end(), [](unsigned char c) { return c > 32 && c < 127; }))
      throw UpstreamFailed{std::string(w[1]), status};
    throw BadInput(where + ":1: a damaged 'mply-failed' line");
  }
  return Reader(bytes, where).read();
}

std::string write_stream(const Stream& stream, bool ascii) {
  std::string all;
  write_stream(stream, ascii, [&](std::string_view bytes) { all += bytes; });
  return all;
}

void write_stream(const Stream& stream, bool ascii, const Sink& sink) {
  std::string out = ascii ? "ply\nformat ascii 1.0\n" : "ply\nformat binary_little_endian 1.0\n";
  out += "comment mply 1.0\n";
  for (const Provenance& p : stream.history) {
    // some viewers read lines of at most 500 bytes
    std::string line =
        "comment pg " + p.program + ' ' + p.version + (p.arguments.empty() ? "" : " ") + p.arguments;
    out += (line.size() > 400 ? line.substr(0, 397) + "..." : line) + '\n';
  }
  if (stream.input_triangles > 0)
    out += "comment input_triangles " + std::to_string(stream.input_triangles) + '\n';
  if (stream.asked_triangles > 0)
    out += "comment asked_triangles " + std::to_string(stream.asked_triangles) + '\n';
  for (const Name& n : stream.names)
    out += "comment name " + std::to_string(n.dim) + ' ' + std::to_string(n.tag) + ' ' +
           percent_encode(n.text) + '\n';
  for (const std::string& r : stream.remarks) out += "comment " + r + '\n';
  const Surface& s = stream.surface;
  declare(out, s.vertex, s.points.size());
  declare(out, s.face, s.tris.size());
  for (const Table& t : stream.tables) declare(out, t, t.rows);
  out += "end_header\n";

  write_rows(out, sink, s.vertex, s.points.size(), ascii, 24, [&](std::size_t r, char* row) {
    const Vec3& p = s.points[r];
    if (row) {
      std::memcpy(row, &p, 24);
      return;
    }
    for (double x : {p.x, p.y, p.z}) {
      append_text(out, x);
      out += ' ';
    }
  });
  write_rows(out, sink, s.face, s.tris.size(), ascii, 13, [&](std::size_t r, char* row) {
    if (row) {
      *row = 3;
      std::memcpy(row + 1, s.tris[r].data(), 12);
      return;
    }
    out += "3 ";
    for (int v : s.tris[r]) {
      append_text(out, v);
      out += ' ';
    }
  });
  for (const Table& t : stream.tables) write_rows(out, sink, t, t.rows, ascii, 0, [](std::size_t, char*) {});
  sink(out);
}

}  // namespace meshpipe
