// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/inria.h"

#include <algorithm>
#include <limits>

#include "formats/foreign/bytes.h"
#include "formats/foreign/columns.h"
#include "formats/foreign/number_source.h"
#include "formats/foreign/polygons.h"
#include "formats/foreign/rows.h"
#include "formats/foreign/volumes.h"
#include "formats/stream/model_lines.h"
#include "formats/text.h"
#include "lib/core/error.h"

namespace meshpipe {
namespace {

/// Sections, by their numbers in the binary format.
enum Keyword {
  dimension = 3,
  vertices = 4,
  edges = 5,
  triangles = 6,
  quadrilaterals = 7,
  tetrahedra = 8,
  prisms = 9,
  hexahedra = 10,
  corners = 13,
  ridges = 14,
  required_vertices = 15,
  required_edges = 16,
  required_triangles = 17,
  pyramids = 49,
  file_end = 54,
  solution = 62
};

constexpr std::pair<const char*, Keyword> keywords[] = {
    {"dimension", dimension},
    {"vertices", vertices},
    {"edges", edges},
    {"triangles", triangles},
    {"quadrilaterals", quadrilaterals},
    {"tetrahedra", tetrahedra},
    {"prisms", prisms},
    {"hexahedra", hexahedra},
    {"pyramids", pyramids},
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

/// The sections of a file: their keywords, and the numbers in them, which need no lines in a text.
class Sections {
 public:
  Sections(std::string_view bytes, const std::string& where) : in_(bytes, where, '#') {
    in_.binary = is_binary(bytes);
    if (in_.binary) {
      in_.swap = load<int>(bytes.data()) != 1;
      version_ = load<int>(bytes.data() + 4, in_.swap);
      in_.text.skip(8);
    } else {
      in_.text.next_line();
      in_.text.word();  // MeshVersionFormatted
      version_ = next_integer(in_.text, "the version");
    }
  }

  /// Moves to the next section and returns its keyword: 0 at the end of the file, -1 if it is not known.
  /// Fails for a known one that comes twice.
  int next() {
    leave();
    const int keyword = in_.binary ? next_binary() : next_text();
    if (keyword <= 0) return keyword;
    for (const auto& [name, known] : keywords) {
      if (known != keyword) continue;
      const std::uint64_t bit = std::uint64_t{1} << keyword;
      if (seen_ & bit) fail(std::string("a second section of ") + name);
      seen_ |= bit;
    }
    return keyword;
  }

  int integer(const char* what) {
    if (!in_.binary) return next_integer(in_.text, what);
    if (version_ < 4) return in_.get<int>(what);
    const auto v = in_.get<std::int64_t>(what);
    if (v < std::numeric_limits<int>::min() || v > std::numeric_limits<int>::max())
      fail(std::string(what) + " is " + std::to_string(v) + ", beyond int");
    return static_cast<int>(v);
  }
  double real(const char* what) {
    if (!in_.binary) return next_number(in_.text, what);
    return in_.finite(version_ == 1 ? in_.get<float>(what) : in_.get<double>(what), what);
  }
  /// Takes a count of rows of `values` numbers each.
  int count(const char* what, std::size_t values) {
    const int n = integer(what);
    if (n < 0) fail(std::string(what) + " is " + std::to_string(n));
    expect_values(static_cast<std::size_t>(n) * values, std::string(what) + " is " + std::to_string(n));
    return n;
  }
  /// Fails if the file cannot hold n more numbers; `what` says who asks for them.
  void expect_values(std::size_t n, const std::string& what) const {
    const std::size_t left = in_.left() + (in_.binary ? 0 : in_.text.rest_size() + 1);
    if (n * (in_.binary ? 4 : 2) > left)
      fail(what + ", but only " + std::to_string(left - (in_.binary ? 0 : 1)) + " bytes follow");
  }
  [[noreturn]] void fail(const std::string& what) const { in_.fail(what); }

 private:
  /// Skips what the reader did not take of the current section.
  void leave() {
    if (in_.binary) {
      if (end_ > in_.position()) in_.text.skip(end_ - in_.position());
      return;
    }
    if (!skips_numbers_) return;
    skips_numbers_ = false;
    for (std::string_view w; !(w = peek()).empty() && !is_letter(w[0]);) in_.text.word();
  }
  static bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

  int next_binary() {
    if (in_.left() == 0) return 0;
    const int keyword = in_.get<int>("a keyword");
    if (keyword == file_end && in_.left() == 0) return keyword;
    const auto here = static_cast<std::int64_t>(in_.position());
    const auto size = static_cast<std::int64_t>(in_.position() + in_.left());
    const std::int64_t end = version_ >= 3 ? in_.get<std::int64_t>("a position") : in_.get<int>("a position");
    if (end != 0 && (end < here || end > size))
      fail("the next section is at byte " + std::to_string(end) + " of " + std::to_string(size));
    end_ = static_cast<std::size_t>(end ? end : size);
    return keyword > 0 ? keyword : -1;
  }

  int next_text() {
    const std::string_view w = next_word(in_.text);
    if (w.empty()) return 0;
    for (const auto& [name, keyword] : keywords)
      if (same_word(w, name)) return keyword;
    if (!is_letter(w[0])) fail("expected a section, found " + quoted(w));
    // an unknown section has a count at least; one that ends with its first letters is cut off
    if (const std::string name(w); peek().empty()) fail("the file ends after " + quoted(name));
    skips_numbers_ = true;
    return -1;
  }

  /// Returns the next word, on whatever line it is.
  std::string_view peek() {
    while (in_.text.line_ends())
      if (!in_.text.next_line()) return {};
    return in_.text.peek();
  }

  NumberSource in_;
  int version_ = 2;
  std::size_t end_ = 0;         ///< of the current section in a binary file
  bool skips_numbers_ = false;  ///< the current section of a text is not known
  std::uint64_t seen_ = 0;      ///< bits of keywords
};

class InriaReader {
 public:
  InriaReader(std::string_view bytes, const std::string& where) : in_(bytes, where) {}

  Stream read() {
    sections();
    if (!has_vertices_) in_.fail("expected Vertices, found the end of the file");
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
  void sections() {
    for (int keyword; (keyword = in_.next()) != 0 && keyword != file_end;) section(keyword);
  }

  int vertex() {
    const int v = in_.integer("a vertex number");
    if (v < 1 || v > n_vertices())
      in_.fail("vertex " + std::to_string(v) + ", but there are " + std::to_string(n_vertices()));
    return v - 1;
  }
  int n_vertices() const { return static_cast<int>(stream_.surface.points.size()); }

  void section(int keyword) {
    switch (keyword) {
      case dimension:
        dimension_ = in_.integer("the dimension");
        if (dimension_ != 2 && dimension_ != 3)
          in_.fail("expected dimension 2 or 3, found " + std::to_string(dimension_));
        break;
      case vertices:
        read_vertices();
        break;
      case edges:
        for (int i = 0, n = in_.count("the number of edges", 3); i < n; ++i) {
          const int a = vertex(), b = vertex();
          edges_.push_back({a, b, in_.integer("a reference"), false, false});
        }
        break;
      case ridges:
        numbers(ridges_, "the number of ridges");
        break;
      case required_edges:
        numbers(required_edges_, "the number of required edges");
        break;
      case triangles:
      case quadrilaterals:
        cells(keyword == triangles ? 3 : 4, false);
        break;
      case tetrahedra:
      case pyramids:
      case prisms:
      case hexahedra:
        cells(keyword == tetrahedra ? 4 : keyword == pyramids ? 5 : keyword == prisms ? 6 : 8, true);
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
        break;
    }
  }

  void numbers(std::vector<int>& into, const char* what) {
    for (int i = 0, n = in_.count(what, 1); i < n; ++i) into.push_back(in_.integer("a number"));
  }

  void read_vertices() {
    if (has_vertices_) in_.fail("a second section of vertices");
    has_vertices_ = true;
    const int n = in_.count("the number of vertices", static_cast<std::size_t>(dimension_) + 1);
    std::vector<int> ref(static_cast<std::size_t>(n));
    stream_.surface.points.resize(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) {
      Vec3& p = stream_.surface.points[i];
      p.x = in_.real("a coordinate");
      p.y = in_.real("a coordinate");
      if (dimension_ == 3) p.z = in_.real("a coordinate");
      ref[i] = in_.integer("a reference");
    }
    if (std::any_of(ref.begin(), ref.end(), [](int r) { return r != 0; }))
      add_columns(stream_, stream_.surface.vertex, ref.size(), {"ref", 1, std::move(ref)});
  }

  void cells(int n_corners, bool solid) {
    const int n = in_.count(solid            ? "the number of volumes"
                            : n_corners == 3 ? "the number of triangles"
                                             : "the number of quadrilaterals",
                            static_cast<std::size_t>(n_corners) + 1);
    if (solid && !polygons_.ends.empty()) {  // they are not needed
      for (std::size_t i = 0; i < static_cast<std::size_t>(n) * (n_corners + 1); ++i) in_.integer("a number");
      return;
    }
    if (!solid) volumes_ = {};
    if (n_corners == 3) first_triangle_ = polygons_.ends.size(), n_triangles_ = n;
    for (int i = 0; i < n; ++i) {
      int corner[8];
      for (int k = 0; k < n_corners; ++k) corner[k] = vertex();
      const int reference = in_.integer("a reference");
      if (solid) {
        add_volume(volumes_, corner, n_corners, n_corners, reference);
        continue;
      }
      polygons_.corners.insert(polygons_.corners.end(), corner, corner + n_corners);
      polygons_.patch.push_back(reference);
      polygons_.ends.push_back(polygons_.corners.size());
    }
  }

  void marks(const char* column) {
    const int n = in_.count("the number of marked vertices", 1);
    std::vector<std::uint8_t> mark(stream_.surface.points.size(), 0);
    for (int i = 0; i < n; ++i) mark[vertex()] = 1;
    add_columns(stream_, stream_.surface.vertex, mark.size(), {column, 1, std::move(mark)});
  }

  void read_solution() {
    const int n = in_.count("the number of values", 1), fields = in_.integer("the number of fields");
    if (n != n_vertices())
      in_.fail("values for " + std::to_string(n) + " vertices, but there are " +
               std::to_string(n_vertices()) + (has_vertices_ ? "" : ": a .sol file goes with a mesh"));
    if (fields < 1 || fields > 1000)
      in_.fail("a solution of " + std::to_string(fields) + " fields, expected 1 to 1000");
    int values = 0;
    for (int f = 0; f < fields; ++f) {
      const int type = in_.integer("the type of a field");
      if (type < 1 || type > 3) in_.fail("a field of type " + std::to_string(type) + ", expected 1 to 3");
      // a number, a vector, the lower triangle of a matrix
      values += type == 1 ? 1 : type == 2 ? dimension_ : dimension_ * (dimension_ + 1) / 2;
    }
    const std::size_t total = static_cast<std::size_t>(n) * static_cast<std::size_t>(values);
    in_.expect_values(total, std::to_string(total) + " values");
    std::vector<double> v(total);
    for (double& x : v) x = in_.real("a value");
    const bool sizes = values == 1 && std::all_of(v.begin(), v.end(), [](double x) { return x > 0; });
    add_columns(stream_, stream_.surface.vertex, static_cast<std::size_t>(n),
                {sizes ? "size" : "sol", values, std::move(v)});
  }

  void finish() {
    for (int reference : add_outer_faces(polygons_, volumes_, stream_)) polygons_.patch.push_back(reference);
    if (!required_triangles_.empty()) {
      std::vector<std::uint8_t> required(polygons_.ends.size(), 0);
      for (int t : required_triangles_) {
        if (t < 1 || t > n_triangles_)
          in_.fail("required triangle " + std::to_string(t) + ", but there are " +
                   std::to_string(n_triangles_));
        required[first_triangle_ + static_cast<std::size_t>(t) - 1] = 1;
      }
      polygons_.columns.set("required", std::move(required));
    }
    set_faces(stream_, polygons_);
    auto mark = [&](const std::vector<int>& numbers, const char* what, bool LineEdge::*flag) {
      for (int e : numbers) {
        if (e < 1 || e > static_cast<int>(edges_.size()))
          in_.fail(what + std::to_string(e) + ", but there are " + std::to_string(edges_.size()) + " edges");
        edges_[e - 1].*flag = true;
      }
    };
    mark(ridges_, "ridge ", &LineEdge::ridge);
    mark(required_edges_, "required edge ", &LineEdge::required);
    set_model_lines(stream_, edges_);
  }

  Sections in_;
  int dimension_ = 3;
  Stream stream_;
  Polygons polygons_;
  Volumes volumes_;
  bool has_vertices_ = false;
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

  /// Begins a section of n rows of `bytes` each in binary, after `more` bytes. Files of version 3 have
  /// positions of 64 bits.
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

/// Returns the rows that a column of uchar marks, counted from 1.
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
