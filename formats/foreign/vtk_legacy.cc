// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/vtk_legacy.h"

#include <cmath>

#include "formats/foreign/bytes.h"
#include "formats/foreign/vtk_data.h"
#include "formats/text.h"
#include "lib/core/error.h"

namespace meshpipe {
namespace {

/// Returns a word in lower case: keywords and types come in either case.
std::string lower(std::string_view word) {
  std::string out(word);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
  return out;
}

/// The numbers of a file, in text or big-endian bytes.
class Values {
 public:
  Values(std::string_view bytes, const std::string& where)
      : text(bytes, where), bytes_(bytes), where_(where) {}

  /// Takes n numbers of the type that the file names; `what` is for messages.
  Data of_type(std::string_view type, std::size_t n, const char* what);
  /// The same, which must be ints.
  std::vector<int> integers(std::string_view type, std::size_t n, const char* what);
  /// Takes n bytes.
  std::string_view block(std::size_t n, const char* what);
  /// Takes a count from the line: any, or of the components of an array.
  std::size_t count(const char* what);
  int components(const char* what);
  /// "FILE:LINE" or "FILE:BYTE".
  std::string place() const { return where_ + ':' + std::to_string(binary ? position() : text.line()); }

  Text text;
  bool binary = false;

 private:
  std::size_t position() const { return bytes_.size() - text.after().size(); }
  template <class T>
  Data values(std::size_t n, const char* what);
  double real(const char* what);
  Data bits(std::size_t n, const char* what);

  std::string_view bytes_;
  const std::string& where_;
};

std::string_view Values::block(std::size_t n, const char* what) {
  if (n > text.after().size())
    throw BadInput(where_ + ':' + std::to_string(position()) + ": " + what + " take " + std::to_string(n) +
                   " bytes, but only " + std::to_string(text.after().size()) + " follow");
  const std::string_view b = text.after().substr(0, n);
  text.skip(n);
  return b;
}

template <class T>
Data Values::values(std::size_t n, const char* what) {
  if (binary) {
    if (n > text.after().size()) block(n, what);
    const char* base = block(n * sizeof(T), what).data();
    return as_data<T>(n, [&](std::size_t i) { return load<T>(base + i * sizeof(T), true); });
  }
  if (n > 0 && n - 1 > text.after().size() / 2 + 1)
    text.fail(std::to_string(n) + " values of " + what + ", but only " + std::to_string(text.after().size()) +
              " bytes follow");
  if constexpr (std::is_floating_point_v<T>) {
    std::vector<double> v(n);
    for (double& x : v) x = real(what);
    return v;
  } else if constexpr (std::is_same_v<T, std::int32_t>) {
    std::vector<int> v(n);
    for (int& x : v) x = next_integer(text, what);
    return v;
  } else {
    std::vector<long long> v(n);
    for (long long& x : v) {
      const std::string_view w = next_word(text);
      if (!parse_integer(w, x))
        text.fail("expected a whole number of " + std::string(what) + ", found " + quoted(w));
      if (std::is_same_v<T, std::uint8_t> && (x < 0 || x > 255))
        text.fail(quoted(w) + " is beyond a byte, 0 to 255");
    }
    using Value = std::conditional_t<std::is_same_v<T, std::uint8_t>, T, long long>;
    return as_data<Value>(n, [&](std::size_t i) { return static_cast<Value>(v[i]); });
  }
}

/// Takes a number of data, which may be NaN.
double Values::real(const char* what) {
  while (text.line_ends()) text.need_line(what);
  if (text.peek().find_first_of("nN") == std::string_view::npos) return text.number(what);
  text.word();
  return std::numeric_limits<double>::quiet_NaN();
}

Data Values::of_type(std::string_view type, std::size_t n, const char* what) {
  const std::string t = lower(type);
  if (t == "double") return values<double>(n, what);
  if (t == "float") return values<float>(n, what);
  if (t == "int") return values<std::int32_t>(n, what);
  if (t == "vtkidtype") return values<std::int32_t>(n, what);  // always written as int
  if (t == "long" || t == "vtktypeint64") return values<std::int64_t>(n, what);
  if (t == "unsigned_long" || t == "vtktypeuint64") return values<std::uint64_t>(n, what);
  if (t == "unsigned_char") return values<std::uint8_t>(n, what);
  if (t == "char" || t == "signed_char") return values<std::int8_t>(n, what);
  if (t == "short") return values<std::int16_t>(n, what);
  if (t == "unsigned_short") return values<std::uint16_t>(n, what);
  if (t == "unsigned_int") return values<std::uint32_t>(n, what);
  if (t == "bit") return bits(n, what);
  text.fail(quoted(type) + " is not a type of numbers");
}

Data Values::bits(std::size_t n, const char* what) {
  if (!binary) return values<std::uint8_t>(n, what);
  const std::string_view b = block(n / 8 + (n % 8 != 0), what);
  return as_data<std::uint8_t>(n, [&](std::size_t i) { return b[i / 8] >> (7 - i % 8) & 1; });
}

std::size_t Values::count(const char* what) {
  const int n = text.integer(what);
  if (n < 0) text.fail(std::string(what) + " is " + std::to_string(n));
  return static_cast<std::size_t>(n);
}

int Values::components(const char* what) {
  const int n = text.integer(what);
  if (n < 1 || n > 1000) text.fail(std::string(what) + " is " + std::to_string(n) + ", expected 1 to 1000");
  return n;
}

std::vector<int> Values::integers(std::string_view type, std::size_t n, const char* what) {
  std::vector<int> out;
  if (!whole_numbers(of_type(type, n, what), out))
    throw BadInput(place() + ": " + what + " beyond the range of int");
  return out;
}

class LegacyReader {
 public:
  LegacyReader(std::string_view bytes, const std::string& where)
      : where_(where), in_(bytes, where), text_(in_.text) {}

  Stream read() {
    head();
    while (text_.next_line()) {
      const std::string keyword = lower(text_.word());
      if (keyword == "metadata")
        metadata();
      else if (keyword == "field")
        field(in_data_ ? *in_data_ : data_.field_data);
      else if (keyword == "points")
        points();
      else if (keyword == "cells" || keyword == "vertices" || keyword == "lines" || keyword == "polygons" ||
               keyword == "triangle_strips")
        cells(keyword);
      else if (keyword == "cell_types")
        cell_types();
      else if (keyword == "point_data" || keyword == "cell_data")
        section(keyword);
      else if (in_data_)
        attribute(keyword);
      else
        text_.fail("expected a section of the data set, found " + quoted(keyword));
    }
    for (int k = 0; k < 5; ++k) add_cells(connectivity_[k], k);
    return vtk_surface(std::move(data_));
  }

 private:
  void head() {
    text_.next_line();  // "# vtk DataFile Version x"
    // the title may be empty, and then the next line with a word is the encoding
    text_.need_line("a title");
    std::string word = lower(text_.word());
    if ((word != "ascii" && word != "binary") || !text_.line_ends()) {
      text_.need_line("ASCII or BINARY");
      word = lower(text_.word());
    }
    if (word != "ascii" && word != "binary") text_.fail("expected ASCII or BINARY, found " + quoted(word));
    in_.binary = word == "binary";
    text_.need_line("DATASET");
    if (word = lower(text_.word()); word != "dataset") text_.fail("expected DATASET, found " + quoted(word));
    word = lower(text_.word());
    if (word != "polydata" && word != "unstructured_grid")
      text_.fail("a data set " + quoted(word) + ", but only POLYDATA and UNSTRUCTURED_GRID hold a surface");
  }

  /// Skips remarks on the previous array, up to an empty line.
  void metadata() {
    const std::string_view after = text_.after();
    std::size_t end = after.find("\n\n");
    if (const std::size_t crlf = after.find("\n\r\n"); crlf < end) end = crlf;
    text_.skip(std::min(end, after.size()));
  }

  // -- geometry

  void points() {
    if (!data_.points.empty()) text_.fail("a second POINTS");
    const std::size_t n = in_.count("the number of points");
    const std::string type(text_.word());
    const Data xyz = in_.of_type(type, 3 * n, "points");
    std::visit(
        [&](const auto& v) {
          data_.points.reserve(n);
          for (std::size_t i = 0; i < n; ++i) {
            const Vec3 p{static_cast<double>(v[3 * i]), static_cast<double>(v[3 * i + 1]),
                         static_cast<double>(v[3 * i + 2])};
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
              throw BadInput(in_.place() + ": point " + std::to_string(i) +
                             " holds a number that is not finite");
            data_.points.push_back(p);
          }
        },
        xyz);
  }

  /// A section of cells, kept until all sections are read: types and points may follow.
  struct Cells {
    std::vector<int> ends, corners;
    std::string place;
  };

  void cells(const std::string& keyword) {
    const int k = keyword == "vertices"          ? 0
                  : keyword == "lines"           ? 1
                  : keyword == "polygons"        ? 2
                  : keyword == "triangle_strips" ? 3
                                                 : 4;
    Cells& c = connectivity_[k];
    if (!c.place.empty()) text_.fail("a second section of " + keyword);
    c.place = where_ + ':' + std::to_string(text_.line());
    const std::size_t n = in_.count("the number of cells"), size = in_.count("the size of the cells");
    // version 5: OFFSETS type, one more than there are cells, CONNECTIVITY type
    const Text before = text_;
    if (text_.next_line() && same_word(text_.word(), "offsets")) {
      std::vector<int> offsets = in_.integers(std::string(text_.word()), n, "offsets");
      text_.need_line("CONNECTIVITY");
      if (std::string_view w = text_.word(); !same_word(w, "connectivity"))
        text_.fail("expected CONNECTIVITY, found " + quoted(w));
      c.corners = in_.integers(std::string(text_.word()), size, "corners");
      if (n > 0 && offsets[0] != 0)
        text_.fail("the first offset is " + std::to_string(offsets[0]) + ", expected 0");
      if (n > 0) c.ends.assign(offsets.begin() + 1, offsets.end());
      return;
    }
    text_ = before;
    // a number of corners before those of each cell
    if (n > size)
      throw BadInput(c.place + ": " + std::to_string(n) + " cells, but only " + std::to_string(size) +
                     " numbers");
    std::vector<int> all = in_.integers("int", size, "cells");
    c.ends.reserve(n);
    c.corners.reserve(size - n);
    std::size_t i = 0;
    for (std::size_t k = 0; k < n; ++k) {
      if (i >= all.size() || all[i] < 0 || static_cast<std::size_t>(all[i]) > all.size() - i - 1)
        throw BadInput(c.place + ": cell " + std::to_string(k) + " of " + std::to_string(n) +
                       " is beyond the " + std::to_string(size) + " numbers of the section");
      c.corners.insert(c.corners.end(), all.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                       all.begin() + static_cast<std::ptrdiff_t>(i) + 1 + all[i]);
      c.ends.push_back(static_cast<int>(c.corners.size()));
      i += 1 + static_cast<std::size_t>(all[i]);
    }
    if (i != size)
      throw BadInput(c.place + ": the cells take " + std::to_string(i) + " numbers, but the section has " +
                     std::to_string(size));
  }

  void cell_types() {
    const std::size_t n = in_.count("the number of cell types");
    types_ = in_.integers("int", n, "cell types");
  }

  void add_cells(const Cells& c, int section) {
    static constexpr int types[] = {2, 4, vtk_polygon, vtk_strip};
    if (section == 4 && types_.size() != c.ends.size())
      text_.fail(std::to_string(types_.size()) + " cell types, but " + std::to_string(c.ends.size()) +
                 " cells");
    int first = 0;
    for (std::size_t i = 0; i < c.ends.size(); ++i) {
      if (c.ends[i] < first || c.ends[i] > static_cast<int>(c.corners.size()))
        throw BadInput(c.place + ": cell " + std::to_string(i) + " ends at " + std::to_string(c.ends[i]) +
                       ", expected " + std::to_string(first) + " to " + std::to_string(c.corners.size()));
      data_.add_cell(section == 4 ? types_[i] : types[section], c.corners.data() + first,
                     static_cast<std::size_t>(c.ends[i] - first), c.place);
      first = c.ends[i];
    }
  }

  // -- data

  void section(const std::string& keyword) {
    in_data_ = keyword == "point_data" ? &data_.point_data : &data_.cell_data;
    rows_ = in_.count("the number of rows");
  }

  std::string name() { return percent_decode(text_.word()); }

  void add(std::string name, int components, std::string_view type) {
    Data v = in_.of_type(type, rows_ * static_cast<std::size_t>(components), "data");
    in_data_->push_back({std::move(name), components, std::move(v)});
  }

  void attribute(const std::string& keyword) {
    const std::string array = name();
    if (keyword == "scalars") {
      const std::string type(text_.word());
      const int n = text_.line_ends() ? 1 : in_.components("the number of components");
      // LOOKUP_TABLE may be left out
      const Text before = text_;
      if (!text_.next_line() || !same_word(text_.word(), "lookup_table"))
        text_ = before;
      else
        text_.rest();
      add(array, n, type);
    } else if (keyword == "vectors" || keyword == "normals") {
      add(array, 3, std::string(text_.word()));
    } else if (keyword == "texture_coordinates") {
      const int n = in_.components("the number of components");
      add(array, n, std::string(text_.word()));
    } else if (keyword == "tensors") {
      add(array, 9, std::string(text_.word()));
    } else if (keyword == "tensors6") {
      add(array, 6, std::string(text_.word()));
    } else if (keyword == "global_ids" || keyword == "pedigree_ids" || keyword == "edge_flags") {
      add(array, 1, std::string(text_.word()));
    } else if (keyword == "color_scalars") {
      add(array, in_.components("the number of components"), in_.binary ? "unsigned_char" : "float");
      if (!in_.binary) in_data_->back().data = bytes_of_colors(in_data_->back().data);
    } else if (keyword == "lookup_table") {
      in_.of_type(in_.binary ? "unsigned_char" : "float", 4 * in_.count("the size of the table"), "colors");
    } else {
      text_.fail("expected data, found " + quoted(keyword));
    }
  }

  /// Converts colors of a text, numbers from 0 to 1, to bytes.
  static Data bytes_of_colors(const Data& data) {
    const auto& v = std::get<std::vector<double>>(data);
    return as_data<std::uint8_t>(v.size(), [&](std::size_t i) {
      return static_cast<std::uint8_t>(v[i] >= 0 && v[i] <= 1 ? 255 * v[i] + 0.5 : 0);
    });
  }

  void field(std::vector<Array>& into) {
    text_.word();
    const std::size_t n = in_.count("the number of arrays");
    for (std::size_t i = 0; i < n;) {
      text_.need_line("array", static_cast<int>(i), static_cast<int>(n));
      const std::string_view word = text_.word();
      if (word == "METADATA") {
        metadata();
        continue;
      }
      ++i;
      const std::string array = percent_decode(word);
      if (text_.line_ends()) continue;  // an array that was not there is written as its name alone
      const int m = in_.components("the number of components");
      const std::size_t rows = in_.count("the number of rows");
      const std::string type = lower(text_.word());
      if (type == "string") {
        strings(rows * static_cast<std::size_t>(m));
        continue;
      }
      into.push_back({array, m, in_.of_type(type, rows * static_cast<std::size_t>(m), "field data")});
    }
  }

  /// Skips strings: one per line, or after their length in one to eight bytes (by its first two bits).
  void strings(std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
      if (!in_.binary) {
        text_.skip(0);
        const std::size_t end = text_.after().find('\n');
        if (end == std::string_view::npos) text_.fail("expected a string, found the end of the file");
        text_.skip(end + 1);
        continue;
      }
      const auto head = static_cast<unsigned char>(in_.block(1, "strings")[0]);
      std::size_t length = head & 63;
      for (int more = (1 << (3 - (head >> 6))) - 1; more > 0; --more)
        length = length << 8 | static_cast<unsigned char>(in_.block(1, "strings")[0]);
      in_.block(length, "strings");
    }
  }

  const std::string& where_;
  Values in_;
  Text& text_;  ///< of in_
  VtkData data_;
  Cells connectivity_[5];  ///< of vertices, lines, polygons and strips, in the order of cell data; of a grid
  std::vector<int> types_;
  std::vector<Array>* in_data_ = nullptr;
  std::size_t rows_ = 0;
};

class LegacyWriter {
 public:
  explicit LegacyWriter(bool ascii) : ascii_(ascii) {}

  template <class T>
  void values(const T* v, std::size_t n, std::size_t a_row) {
    for (std::size_t i = 0; i < n; ++i) {
      if (!ascii_) {
        put(out, v[i], true);
        continue;
      }
      if constexpr (std::is_floating_point_v<T>)
        append(out, v[i]);
      else
        append(out, static_cast<long long>(v[i]));
      out += (i + 1) % a_row ? ' ' : '\n';
    }
    if (!ascii_) out += '\n';
  }

  void field(const char* name, const std::vector<Array>& arrays) {
    static constexpr const char* types[] = {"unsigned_char", "int", "double"};
    if (arrays.empty()) return;
    out += std::string("FIELD ") + name + ' ' + std::to_string(arrays.size()) + '\n';
    for (const Array& a : arrays) {
      out += percent_encode(a.name.empty() ? "unnamed" : a.name) + ' ' + std::to_string(a.components) + ' ' +
             std::to_string(a.rows()) + ' ' + types[a.data.index()] + '\n';
      std::visit([&](const auto& v) { values(v.data(), v.size(), static_cast<std::size_t>(a.components)); },
                 a.data);
    }
  }

  void columns(const char* section, const Table& table, std::size_t rows) {
    std::vector<Array> arrays;
    for (const Group& g : groups_of(table)) arrays.push_back(array_of(g));
    if (arrays.empty()) return;
    out += std::string(section) + ' ' + std::to_string(rows) + '\n';
    field("FieldData", arrays);
  }

  std::string out;

 private:
  bool ascii_;
};

std::string write(const Stream& stream, bool ascii, bool polydata) {
  const Surface& s = stream.surface;
  const std::size_t n = s.tris.size();
  LegacyWriter writer(ascii);
  writer.out = "# vtk DataFile Version 3.0\nmeshpipe\n";
  writer.out += ascii ? "ASCII\nDATASET " : "BINARY\nDATASET ";
  writer.out += polydata ? "POLYDATA\n" : "UNSTRUCTURED_GRID\n";
  writer.out += "POINTS " + std::to_string(s.points.size()) + " double\n";
  writer.values(s.points.empty() ? nullptr : &s.points[0].x, 3 * s.points.size(), 3);
  writer.out += polydata ? "POLYGONS " : "CELLS ";
  writer.out += std::to_string(n) + ' ' + std::to_string(4 * n) + '\n';
  std::vector<int> cells;
  cells.reserve(4 * n);
  for (const Tri& t : s.tris) cells.insert(cells.end(), {3, t[0], t[1], t[2]});
  writer.values(cells.data(), cells.size(), 4);
  if (!polydata) {
    writer.out += "CELL_TYPES " + std::to_string(n) + '\n';
    writer.values(std::vector<int>(n, vtk_triangle).data(), n, 1);
  }
  // not before the points, where Gmsh takes no field
  writer.field("FieldData", field_of_names(stream));
  writer.columns("POINT_DATA", s.vertex, s.points.size());
  writer.columns("CELL_DATA", s.face, n);
  return std::move(writer.out);
}

}  // namespace

bool is_vtk_legacy(std::string_view bytes) {
  Text text(bytes.substr(0, 256), "");
  return text.next_line() && text.word() == "#" && same_word(text.word(), "vtk") &&
         same_word(text.word(), "datafile");
}

Stream read_vtk_legacy(std::string_view bytes, const std::string& where) {
  return LegacyReader(bytes, where).read();
}

std::string write_vtk_grid(const Stream& stream, bool ascii) { return write(stream, ascii, false); }
std::string write_vtk_polydata(const Stream& stream, bool ascii) { return write(stream, ascii, true); }

}  // namespace meshpipe
