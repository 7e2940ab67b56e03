// SPDX-License-Identifier: BSD-3-Clause
#include "formats/inria.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "formats/bytes.h"
#include "formats/columns.h"
#include "formats/model_lines.h"
#include "formats/polygons.h"
#include "formats/rows.h"
#include "formats/text.h"
#include "lib/error.h"

namespace meshpipe {
namespace {

/// Sections by the numbers they have in the binary format.
enum Keyword {
  dimension = 3,
  vertices = 4,
  edges = 5,
  triangles = 6,
  quadrilaterals = 7,
  corners = 13,
  ridges = 14,
  required_vertices = 15,
  required_edges = 16,
  required_triangles = 17,
  file_end = 54,
  solution = 62
};

constexpr std::pair<const char*, Keyword> keywords[] = {
    {"dimension", dimension},
    {"vertices", vertices},
    {"edges", edges},
    {"triangles", triangles},
    {"quadrilaterals", quadrilaterals},
    {"corners", corners},
    {"ridges", ridges},
    {"requiredvertices", required_vertices},
    {"requirededges", required_edges},
    {"requiredtriangles", required_triangles},
    {"end", file_end},
    {"solatvertices", solution},
};

bool is_binary(std::string_view bytes) {
  if (bytes.size() < 8) return false;
  for (bool swap : {false, true})
    if (const int version = load<int>(bytes.data() + 4, swap);
        load<int>(bytes.data(), swap) == 1 && version >= 1 && version <= 4)
      return true;
  return false;
}

class InriaReader {
 public:
  InriaReader(std::string_view bytes, const std::string& where)
      : bytes_(bytes), where_(where), text_(bytes, where, '#'), binary_(is_binary(bytes)) {}

  Stream read() {
    sections();
    if (!has_vertices_) fail("the file ends where Vertices are due");
    finish();
    return std::move(stream_);
  }

  /// Reads a file of values for the vertices of this mesh.
  void read_into(Stream& stream) {
    stream_ = std::move(stream);
    has_vertices_ = true;
    sections();
    stream = std::move(stream_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    if (!binary_) text_.fail(what);
    throw BadInput(where_ + ':' + std::to_string(at_) + ": " + what);
  }

  // -- values

  template <class T>
  T get(const char* what) {
    if (bytes_.size() - at_ < sizeof(T))
      fail("the file ends where " + std::string(what) + " is due: " + std::to_string(sizeof(T)) + " bytes, " +
           std::to_string(bytes_.size() - at_) + " are left");
    const T value = load<T>(bytes_.data() + at_, swap_);
    at_ += sizeof(T);
    return value;
  }
  int integer(const char* what) {
    if (!binary_) return text_.next_integer(what);
    if (version_ < 4) return get<int>(what);
    const auto v = get<std::int64_t>(what);
    if (v < std::numeric_limits<int>::min() || v > std::numeric_limits<int>::max())
      fail(std::string(what) + " is " + std::to_string(v) + ", beyond int");
    return static_cast<int>(v);
  }
  double real(const char* what) {
    if (!binary_) return text_.next_number(what);
    const double v = version_ == 1 ? get<float>(what) : get<double>(what);
    if (!std::isfinite(v)) fail(std::string(what) + " that is not finite");
    return v;
  }
  /// A count of rows of `values` numbers each.
  int count(const char* what, std::size_t values) {
    const int n = integer(what);
    const std::size_t left = binary_ ? bytes_.size() - at_ : text_.after().size() + text_.rest_size();
    if (n < 0) fail(std::string(what) + " is " + std::to_string(n));
    const std::size_t least = values * (binary_ ? 4 : 2);
    if (n > 0 && static_cast<std::size_t>(n) * least > left + (binary_ ? 0 : 1))
      fail(std::string(what) + " is " + std::to_string(n) + ", but only " + std::to_string(left) +
           " bytes follow");
    return n;
  }
  int vertex() {
    const int v = integer("a vertex number");
    if (v < 1 || v > n_vertices())
      fail("vertex " + std::to_string(v) + ", but there are " + std::to_string(n_vertices()));
    return v - 1;
  }
  int n_vertices() const { return static_cast<int>(stream_.surface.points.size()); }

  // -- sections

  void sections() {
    if (binary_) {
      swap_ = load<int>(bytes_.data()) != 1;
      version_ = load<int>(bytes_.data() + 4, swap_);
      at_ = 8;
    } else {
      text_.next_line();
      text_.word();  // MeshVersionFormatted
      version_ = text_.next_integer("the version");
    }
    while (const int keyword = next_keyword()) {
      if (keyword == file_end) break;
      if (keyword > 0) once(keyword);
      section(keyword);
    }
  }

  /// 0 at the end of the file, -1 for a section that is not known.
  int next_keyword() {
    if (binary_) {
      if (at_ == bytes_.size()) return 0;
      const int keyword = get<int>("a keyword");
      if (keyword == file_end && at_ == bytes_.size()) return keyword;
      const std::size_t here = at_;
      const std::int64_t next = version_ >= 3 ? get<std::int64_t>("a position") : get<int>("a position");
      if (next != 0 &&
          (next < static_cast<std::int64_t>(here) || next > static_cast<std::int64_t>(bytes_.size())))
        fail("the next section is at byte " + std::to_string(next) + " of " + std::to_string(bytes_.size()));
      next_ = next ? static_cast<std::size_t>(next) : bytes_.size();
      return keyword > 0 ? keyword : -1;
    }
    const std::string_view w = text_.next_word();
    if (w.empty()) return 0;
    for (const auto& [name, keyword] : keywords)
      if (same_word(w, name)) return keyword;
    const char c = w[0];
    if (!(c >= 'A' && c <= 'Z') && !(c >= 'a' && c <= 'z')) fail(quoted(w) + " where a section is due");
    // a section of another kind has a count at least; what ends with its first letters is cut off
    if (const std::string name(w); peek().empty()) fail("the file ends after " + quoted(name));
    return -1;
  }

  /// No section comes twice: numbers of triangles would be of either.
  void once(int keyword) {
    for (const auto& [name, known] : keywords) {
      if (known != keyword) continue;
      const std::uint64_t bit = std::uint64_t{1} << keyword;
      if (seen_ & bit) fail(std::string("a second section of ") + name);
      seen_ |= bit;
    }
  }

  void section(int keyword) {
    switch (keyword) {
      case dimension:
        dimension_ = integer("the dimension");
        if (dimension_ != 2 && dimension_ != 3)
          fail("dimension " + std::to_string(dimension_) + ", 2 or 3 is due");
        break;
      case vertices:
        read_vertices();
        break;
      case edges:
        for (int i = 0, n = count("the number of edges", 3); i < n; ++i) {
          const int a = vertex(), b = vertex();
          edges_.push_back({a, b, integer("a reference"), false, false});
        }
        break;
      case ridges:
        numbers(ridges_, "the number of ridges");
        break;
      case required_edges:
        numbers(required_edges_, "the number of required edges");
        break;
      case triangles:
        faces(3);
        break;
      case quadrilaterals:
        faces(4);
        break;
      case corners:
        marks("corner");
        break;
      case required_vertices:
        marks("required");
        break;
      case required_triangles:
        numbers(required_triangles_, "the number of required triangles");
        break;
      case solution:
        read_solution();
        break;
      default:
        if (!binary_) skip_numbers();
        break;
    }
    if (binary_) at_ = std::max(std::min(next_, bytes_.size()), at_);
  }

  void numbers(std::vector<int>& into, const char* what) {
    for (int i = 0, n = count(what, 1); i < n; ++i) into.push_back(integer("a number"));
  }

  void skip_numbers() {
    for (std::string_view w; !(w = peek()).empty();) {
      if ((w[0] >= 'A' && w[0] <= 'Z') || (w[0] >= 'a' && w[0] <= 'z')) return;
      text_.word();
    }
  }
  std::string_view peek() {
    while (text_.line_ends())
      if (!text_.next_line()) return {};
    return text_.peek();
  }

  void read_vertices() {
    if (has_vertices_) fail("a second section of vertices");
    has_vertices_ = true;
    const int n = count("the number of vertices", static_cast<std::size_t>(dimension_) + 1);
    std::vector<int> ref(static_cast<std::size_t>(n));
    stream_.surface.points.resize(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) {
      Vec3& p = stream_.surface.points[i];
      p.x = real("a coordinate");
      p.y = real("a coordinate");
      if (dimension_ == 3) p.z = real("a coordinate");
      ref[i] = integer("a reference");
    }
    if (std::any_of(ref.begin(), ref.end(), [](int r) { return r != 0; }))
      add_columns(stream_, stream_.surface.vertex, ref.size(), {"ref", 1, std::move(ref)});
  }

  void faces(int n_corners) {
    const int n = count(n_corners == 3 ? "the number of triangles" : "the number of quadrilaterals",
                        static_cast<std::size_t>(n_corners) + 1);
    if (n_corners == 3) first_triangle_ = polygons_.ends.size(), n_triangles_ = n;
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < n_corners; ++k) polygons_.corners.push_back(vertex());
      polygons_.patch.push_back(integer("a reference"));
      polygons_.ends.push_back(polygons_.corners.size());
    }
  }

  void marks(const char* column) {
    const int n = count("the number of marked vertices", 1);
    std::vector<std::uint8_t> mark(stream_.surface.points.size(), 0);
    for (int i = 0; i < n; ++i) mark[vertex()] = 1;
    add_columns(stream_, stream_.surface.vertex, mark.size(), {column, 1, std::move(mark)});
  }

  void read_solution() {
    const int n = count("the number of values", 1), fields = integer("the number of fields");
    if (n != n_vertices())
      fail("values for " + std::to_string(n) + " vertices, but there are " + std::to_string(n_vertices()) +
           (has_vertices_ ? "" : ": a .sol file goes with a mesh"));
    if (fields < 1 || fields > 1000)
      fail("a solution of " + std::to_string(fields) + " fields, 1 to 1000 are due");
    int values = 0;
    for (int f = 0; f < fields; ++f) {
      const int type = integer("the type of a field");
      if (type < 1 || type > 3) fail("a field of type " + std::to_string(type) + ", 1 to 3 are due");
      // a number, a vector, the lower triangle of a matrix
      values += type == 1 ? 1 : type == 2 ? dimension_ : dimension_ * (dimension_ + 1) / 2;
    }
    const std::size_t left = binary_ ? bytes_.size() - at_ : text_.after().size() + text_.rest_size() + 1;
    const std::size_t total = static_cast<std::size_t>(n) * static_cast<std::size_t>(values);
    if (total * (binary_ ? 4 : 2) > left)
      fail(std::to_string(total) + " values, but only " + std::to_string(left) + " bytes follow");
    std::vector<double> v(total);
    for (double& x : v) x = real("a value");
    const bool sizes = values == 1 && std::all_of(v.begin(), v.end(), [](double x) { return x > 0; });
    add_columns(stream_, stream_.surface.vertex, static_cast<std::size_t>(n),
                {sizes ? "size" : "sol", values, std::move(v)});
  }

  void finish() {
    if (!required_triangles_.empty()) {
      std::vector<std::uint8_t> required(polygons_.ends.size(), 0);
      for (int t : required_triangles_) {
        if (t < 1 || t > n_triangles_)
          fail("required triangle " + std::to_string(t) + ", but there are " + std::to_string(n_triangles_));
        required[first_triangle_ + static_cast<std::size_t>(t) - 1] = 1;
      }
      polygons_.columns.set("required", std::move(required));
    }
    set_faces(stream_, polygons_);
    auto mark = [&](const std::vector<int>& numbers, const char* what, bool LineEdge::*flag) {
      for (int e : numbers) {
        if (e < 1 || e > static_cast<int>(edges_.size()))
          fail(what + std::to_string(e) + ", but there are " + std::to_string(edges_.size()) + " edges");
        edges_[e - 1].*flag = true;
      }
    };
    mark(ridges_, "ridge ", &LineEdge::ridge);
    mark(required_edges_, "required edge ", &LineEdge::required);
    set_model_lines(stream_, edges_);
  }

  std::string_view bytes_;
  const std::string& where_;
  Text text_;
  bool binary_, swap_ = false;
  int version_ = 2, dimension_ = 3;
  std::size_t at_ = 0, next_ = 0;  ///< in a binary file
  Stream stream_;
  Polygons polygons_;
  bool has_vertices_ = false;
  std::uint64_t seen_ = 0;  ///< bits of keywords
  std::size_t first_triangle_ = 0;
  int n_triangles_ = 0;
  std::vector<int> required_triangles_, ridges_, required_edges_;
  std::vector<LineEdge> edges_;
};

/// Writes sections in either encoding.
class InriaWriter : public Rows {
 public:
  explicit InriaWriter(bool ascii) : Rows(ascii) {
    if (ascii) {
      out = "MeshVersionFormatted 2\nDimension 3\n";
      return;
    }
    for (int v : {1, 3, static_cast<int>(dimension)}) put(out, v);
    put(out, static_cast<std::int64_t>(out.size() + 12));
    put(out, 3);
  }

  /// A section of n rows; `bytes` a row in binary, and `more` before them. Files of version 3 have positions
  /// of 64 bits.
  void section(const char* name, Keyword keyword, std::size_t n, std::size_t bytes, std::size_t more = 0) {
    if (ascii()) {
      out += std::string("\n") + name + '\n' + std::to_string(n) + '\n';
      return;
    }
    put(out, static_cast<int>(keyword));
    put(out, static_cast<std::int64_t>(out.size() + 12 + more + n * bytes));
    put(out, static_cast<int>(n));
  }
  void numbers(const char* name, Keyword keyword, const std::vector<int>& v) {
    if (v.empty()) return;
    section(name, keyword, v.size(), 4);
    for (int x : v) {
      integer(x);
      end_row();
    }
  }
  std::string finish() {
    if (ascii()) {
      out += "\nEnd\n";
    } else {
      put(out, static_cast<int>(file_end));
      put(out, std::int64_t{0});
    }
    return std::move(out);
  }
};

/// Numbers from 1 on of the rows that a column of uchar marks.
std::vector<int> marked(const Table& table, const char* column) {
  std::vector<int> rows;
  const Column* c = table.find(column);
  if (!c || !std::holds_alternative<std::vector<std::uint8_t>>(c->data)) return rows;
  const auto& mark = std::get<std::vector<std::uint8_t>>(c->data);
  for (std::size_t i = 0; i < mark.size(); ++i)
    if (mark[i]) rows.push_back(static_cast<int>(i) + 1);
  return rows;
}

std::string write(const Stream& stream, bool ascii) {
  const Surface& s = stream.surface;
  const std::vector<int> patch = patches_of(stream);
  std::vector<int> ref(s.points.size(), 0);
  if (s.vertex.has("ref")) whole_numbers(s.vertex.find("ref")->data, ref);
  InriaWriter w(ascii);
  w.section("Vertices", vertices, s.points.size(), 28);
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    for (double x : {s.points[i].x, s.points[i].y, s.points[i].z}) w.real(x);
    w.integer(ref[i]);
    w.end_row();
  }
  w.section("Triangles", triangles, s.tris.size(), 16);
  for (std::size_t t = 0; t < s.tris.size(); ++t) {
    for (int v : s.tris[t]) w.integer(v + 1);
    w.integer(patch[t]);
    w.end_row();
  }
  if (const std::vector<LineEdge> lines = model_lines(stream); !lines.empty()) {
    w.section("Edges", edges, lines.size(), 12);
    std::vector<int> of_ridges, of_required;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      for (int v : {lines[i].a + 1, lines[i].b + 1, lines[i].tag}) w.integer(v);
      w.end_row();
      if (lines[i].ridge) of_ridges.push_back(static_cast<int>(i) + 1);
      if (lines[i].required) of_required.push_back(static_cast<int>(i) + 1);
    }
    w.numbers("Ridges", ridges, of_ridges);
    w.numbers("RequiredEdges", required_edges, of_required);
  }
  w.numbers("Corners", corners, marked(s.vertex, "corner"));
  w.numbers("RequiredVertices", required_vertices, marked(s.vertex, "required"));
  w.numbers("RequiredTriangles", required_triangles, marked(s.face, "required"));
  return w.finish();
}

std::string write_sizes(const Stream& stream, bool ascii) {
  if (!stream.surface.vertex.has("size"))
    throw NotAdmissible("no vertex column 'size' to write as .sol; run msize first");
  const auto& size = stream.surface.vertex.get<double>("size");
  InriaWriter w(ascii);
  w.section("SolAtVertices", solution, size.size(), 8, 8);
  w.integer(1);
  w.integer(1);
  w.end_row();
  for (double x : size) {
    w.real(x);
    w.end_row();
  }
  return w.finish();
}

}  // namespace

bool is_inria(std::string_view bytes) {
  if (is_binary(bytes)) return true;
  Text text(bytes.substr(0, 4096), "", '#');
  return text.next_line() && same_word(text.peek(), "meshversionformatted");
}

Stream read_inria(std::string_view bytes, const std::string& where) {
  return InriaReader(bytes, where).read();
}

void read_sol(Stream& stream, std::string_view bytes, const std::string& where) {
  if (!is_inria(bytes)) throw BadInput(where + ":1: no .sol file, which begins with MeshVersionFormatted");
  InriaReader(bytes, where).read_into(stream);
}

std::string write_mesh(const Stream& stream, bool) { return write(stream, true); }
std::string write_meshb(const Stream& stream, bool) { return write(stream, false); }

std::string write_sol(const Stream& stream, bool) { return write_sizes(stream, true); }
std::string write_solb(const Stream& stream, bool) { return write_sizes(stream, false); }

}  // namespace meshpipe
