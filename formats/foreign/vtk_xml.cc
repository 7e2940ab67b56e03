// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/vtk_xml.h"

#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <pugixml.hpp>

#include "formats/foreign/base64.h"
#include "formats/foreign/bytes.h"
#include "formats/foreign/vtk_data.h"
#include "formats/text.h"
#include "lib/core/error.h"
#include "lib/core/number.h"

namespace meshpipe {
namespace {

/// The bytes of one array, raw or in base64, taken piece by piece.
class Feed {
 public:
  Feed(std::string_view text, bool base64) : raw_(text), base64_(text), is_base64_(base64) {}
  bool take(std::size_t n, std::string& out) {
    if (n > most()) return false;
    if (is_base64_) return base64_.take(n, out);
    out.append(raw_.substr(0, n));
    raw_.remove_prefix(n);
    return true;
  }
  std::size_t most() const { return is_base64_ ? base64_.most() : raw_.size(); }

 private:
  std::string_view raw_;
  Base64 base64_;
  bool is_base64_;
};

/// The XML of a file without its appended data, which may be raw bytes that no XML parser takes.
class XmlFile {
 public:
  XmlFile(std::string_view bytes, const std::string& where) : where_(where) {
    cut_appended(bytes);
    const pugi::xml_parse_result parsed =
        document_.load_buffer(xml_.data(), xml_.size(), pugi::parse_escapes, pugi::encoding_utf8);
    if (!parsed) {
      std::string why = parsed.description();
      why[0] = static_cast<char>(why[0] | 32);
      fail_at(static_cast<std::size_t>(parsed.offset), why);
    }
    root = document_.child("VTKFile");
    if (!root) fail_at(0, "no element VTKFile");
  }

  [[noreturn]] void fail(pugi::xml_node node, const std::string& what) const {
    throw BadInput(place(node) + ": " + what);
  }
  /// Returns "FILE:LINE" of an element.
  std::string place(pugi::xml_node node) const {
    return place_at(static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, node.offset_debug())));
  }
  /// Returns the value of an attribute that counts something; `otherwise` if it is missing.
  std::size_t number(pugi::xml_node node, const char* name, std::size_t otherwise) const {
    const pugi::xml_attribute a = node.attribute(name);
    if (!a) return otherwise;
    long long value;
    if (!parse_integer(trim(a.value()), value) || value < 0)
      fail(node, "expected a count as " + std::string(name) + ", found " + quoted(a.value()));
    return static_cast<std::size_t>(value);
  }

  pugi::xml_node root;
  std::string_view appended;
  bool has_appended = false, appended_is_base64 = false;

 private:
  void cut_appended(std::string_view bytes) {
    const std::size_t tag = bytes.find("<AppendedData");
    xml_ = bytes.substr(0, tag);
    if (tag == std::string_view::npos) return;
    const std::size_t end = bytes.find('>', tag), mark = bytes.find('_', std::min(end, bytes.size()));
    if (mark == std::string_view::npos) fail_at(tag, "appended data without '_'");
    appended_is_base64 = bytes.substr(tag, end - tag).find("base64") != std::string_view::npos;
    appended = bytes.substr(mark + 1);
    has_appended = true;
    if (appended_is_base64) appended = appended.substr(0, appended.find('<'));
    xml_ += "</VTKFile>";
  }

  [[noreturn]] void fail_at(std::size_t offset, const std::string& what) const {
    throw BadInput(place_at(offset) + ": " + what);
  }
  std::string place_at(std::size_t offset) const {
    const std::size_t n = std::min(offset, xml_.size());
    return where_ + ':' +
           std::to_string(1 + std::count(xml_.begin(), xml_.begin() + static_cast<std::ptrdiff_t>(n), '\n'));
  }

  const std::string& where_;
  std::string xml_;
  pugi::xml_document document_;
};

bool attribute_is(pugi::xml_node node, const char* name, std::string_view value) {
  return node.attribute(name).value() == value;
}
std::string name_of(pugi::xml_node array) { return array.attribute("Name").value(); }
std::string shown(pugi::xml_node array) { return "array " + quoted(name_of(array)); }

/// Reads the arrays of a file, in any of its encodings.
class ArrayReader {
 public:
  ArrayReader(const XmlFile& file, std::size_t file_size);
  /// Reads an array of at most `rows` rows; longer ones are refused before they are decompressed.
  Array load(pugi::xml_node node, std::size_t rows = std::numeric_limits<int>::max()) {
    Array array;
    array.name = name_of(node);
    const std::size_t components = file_.number(node, "NumberOfComponents", 1);
    if (components > 1000)
      file_.fail(node, shown(node) + " has " + std::to_string(components) + " components, the limit is 1000");
    array.components = std::max(1, static_cast<int>(components));
    const std::string_view format = node.attribute("format").value();
    if (format == "ascii" || format.empty())
      array.data = of_type(node, [&]<class T>(T*) { return from_text<T>(node); });
    else if (format == "binary" || format == "appended")
      array.data = of_type(node, [&]<class T>(T*) {
        const std::size_t most = rows * static_cast<std::size_t>(array.components) * sizeof(T);
        return from_bytes<T>(node, bytes(node, format == "appended", most));
      });
    else
      file_.fail(node, shown(node) + " has format " + quoted(format));
    if (array.size() % array.components)
      file_.fail(node, shown(node) + " has " + std::to_string(array.size()) + " values, no multiple of its " +
                           std::to_string(array.components) + " components");
    return array;
  }

  /// Returns whether an array may be just two numbers: it is text, or its head declares few bytes.
  bool is_short(pugi::xml_node node) const {
    const std::string_view format = node.attribute("format").value();
    if (format != "binary" && format != "appended") return true;
    Feed feed = feed_of(node, format == "appended");
    const std::size_t first = size(node, feed);
    if (!compressed_) return first <= 16;
    if (first > 1) return false;
    const std::size_t whole = size(node, feed), part = size(node, feed);
    return (part ? part : whole) <= 16;
  }

  /// Takes an array whose values must be ints.
  std::vector<int> integers(pugi::xml_node node) {
    std::vector<int> out;
    Array array = load(node);
    if (auto* ints = std::get_if<std::vector<int>>(&array.data)) return std::move(*ints);
    if (!whole_numbers(array.data, out)) file_.fail(node, shown(node) + " has values that are no int");
    return out;
  }

 private:
  /// Calls make((T*)nullptr) with the type of the array.
  template <class Make>
  Data of_type(pugi::xml_node node, const Make& make) {
    const std::string_view type = node.attribute("type").value();
    if (type == "Float64") return make(static_cast<double*>(nullptr));
    if (type == "Float32") return make(static_cast<float*>(nullptr));
    if (type == "Int64") return make(static_cast<std::int64_t*>(nullptr));
    if (type == "Int32") return make(static_cast<std::int32_t*>(nullptr));
    if (type == "UInt8") return make(static_cast<std::uint8_t*>(nullptr));
    if (type == "Int8") return make(static_cast<std::int8_t*>(nullptr));
    if (type == "Int16") return make(static_cast<std::int16_t*>(nullptr));
    if (type == "UInt16") return make(static_cast<std::uint16_t*>(nullptr));
    if (type == "UInt32") return make(static_cast<std::uint32_t*>(nullptr));
    if (type == "UInt64") return make(static_cast<std::uint64_t*>(nullptr));
    file_.fail(node, shown(node) + " is of type " + quoted(type) + ", which is no type of numbers");
  }

  template <class T>
  Data from_text(pugi::xml_node node) const {
    const std::string_view text = node.child_value();
    const char *at = text.data(), *const end = at + text.size();
    auto is_blank = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
    // bytes are numbers here, not characters
    using Value =
        std::conditional_t<sizeof(T) == 1, int, std::conditional_t<std::is_same_v<T, float>, double, T>>;
    std::vector<Value> values;
    values.reserve(text.size() / 8);
    for (;;) {
      while (at < end && is_blank(*at)) ++at;
      if (at == end) break;
      Value v;
      auto [stop, error] = from_chars(at, end, v);
      if (error != std::errc() || (stop < end && !is_blank(*stop))) {
        const char* word_end = std::find_if(at, end, is_blank);
        const std::string_view word(at, word_end - at);
        double x;
        if (std::is_integral_v<Value> || !parse_number(word, x))
          file_.fail(node, "expected a number in " + shown(node) + ", found " + quoted(word));
        v = static_cast<Value>(x);
        stop = word_end;
      }
      if (std::is_same_v<T, std::uint8_t> && (v < 0 || v > 255))
        file_.fail(node, shown(node) + " of type UInt8 has a value beyond 0 to 255");
      values.push_back(v);
      at = stop;
    }
    auto value = [&](std::size_t i) { return values[i]; };
    if constexpr (std::is_same_v<T, std::uint8_t>) return as_data<std::uint8_t>(values.size(), value);
    if constexpr (std::is_same_v<Value, double> || std::is_same_v<Value, int>) return values;
    return as_data<Value>(values.size(), value);
  }

  template <class T>
  Data from_bytes(pugi::xml_node node, const std::string& bytes) const {
    if (bytes.size() % sizeof(T))
      file_.fail(node, shown(node) + " has " + std::to_string(bytes.size()) + " bytes, no multiple of " +
                           std::to_string(sizeof(T)));
    return as_data<T>(bytes.size() / sizeof(T),
                      [&](std::size_t i) { return load_value<T>(bytes.data() + i * sizeof(T)); });
  }
  template <class T>
  T load_value(const char* at) const {
    return meshpipe::load<T>(at, swap_);
  }

  /// Returns the bytes of a binary array, its head included.
  Feed feed_of(pugi::xml_node node, bool appended) const {
    std::string_view text = node.child_value();
    if (appended) {
      const std::size_t offset = file_.number(node, "offset", 0);
      if (!file_.has_appended)
        file_.fail(node, shown(node) + " is appended, but the file has no appended data");
      if (offset > file_.appended.size())
        file_.fail(node, shown(node) + " is at byte " + std::to_string(offset) +
                             " of the appended data, which has " + std::to_string(file_.appended.size()));
      text = file_.appended.substr(offset);
    }
    return Feed(text, !appended || file_.appended_is_base64);
  }

  /// Returns the bytes of a binary array, at most `most`, decompressed and without their head.
  std::string bytes(pugi::xml_node node, bool appended, std::size_t most) {
    Feed feed = feed_of(node, appended);
    std::string out;
    auto bound = [&](std::size_t n) {
      if (n > most)
        file_.fail(node, shown(node) + " has " + std::to_string(n) + " bytes, expected at most " +
                             std::to_string(most));
    };
    if (!compressed_) {
      const std::size_t n = size(node, feed);
      bound(n);
      take(node, feed, n, out);
      return out;
    }
    // the number of blocks, their size, the size of the last if it is smaller, and all compressed sizes
    const std::size_t n = size(node, feed), whole = size(node, feed), part = size(node, feed);
    if (n > feed.most() / (wide_header_ ? 8 : 4))
      file_.fail(node, shown(node) + " has " + std::to_string(n) + " compressed blocks in " +
                           std::to_string(feed.most()) + " bytes");
    std::vector<std::size_t> sizes(n);
    for (std::size_t& s : sizes) s = size(node, feed);
    // a block belongs to one array, so that a small file cannot become many large ones
    for (std::size_t s : sizes)
      if (s > file_size_ - packed_)
        file_.fail(node, shown(node) + " and those before it have more compressed bytes than the file, " +
                             std::to_string(file_size_));
      else
        packed_ += s;
    std::string block;
    for (std::size_t i = 0; i < n; ++i) {
      block.clear();
      take(node, feed, sizes[i], block);
      const std::size_t expected = i + 1 == n && part ? part : whole, start = out.size();
      // zlib packs at most 1032 bytes into one
      if (expected > 1032 * sizes[i] + 1032)
        file_.fail(node, shown(node) + " has a block of " + std::to_string(expected) +
                             " bytes compressed to " + std::to_string(sizes[i]));
      bound(start + expected);
      out.resize(start + expected);
      uLongf length = expected;
      const int status = uncompress(reinterpret_cast<Bytef*>(out.data() + start), &length,
                                    reinterpret_cast<const Bytef*>(block.data()), sizes[i]);
      if (status != Z_OK || length != expected)
        file_.fail(node, "block " + std::to_string(i) + " of " + shown(node) + " is damaged: " +
                             std::to_string(length) + " bytes of " + std::to_string(expected));
    }
    return out;
  }

  void take(pugi::xml_node node, Feed& feed, std::size_t n, std::string& out) const {
    if (!feed.take(n, out))
      file_.fail(node, shown(node) + " ends early: expected " + std::to_string(n) + " bytes, but at most " +
                           std::to_string(feed.most()) + " are left");
  }
  std::size_t size(pugi::xml_node node, Feed& feed) const {
    std::string word;
    take(node, feed, wide_header_ ? 8 : 4, word);
    return wide_header_ ? load_value<std::uint64_t>(word.data()) : load_value<std::uint32_t>(word.data());
  }

  const XmlFile& file_;
  const std::size_t file_size_;
  bool swap_ = false, wide_header_ = false, compressed_ = false;
  std::size_t packed_ = 0;  ///< compressed bytes of the arrays so far
};

ArrayReader::ArrayReader(const XmlFile& file, std::size_t file_size) : file_(file), file_size_(file_size) {
  swap_ = attribute_is(file.root, "byte_order", "BigEndian");
  wide_header_ = attribute_is(file.root, "header_type", "UInt64");
  const std::string compressor = file.root.attribute("compressor").value();
  compressed_ = !compressor.empty();
  if (compressed_ && compressor != "vtkZLibDataCompressor")
    file.fail(file.root, "compressor " + quoted(compressor) + ", but only vtkZLibDataCompressor is known");
}

class XmlReader {
 public:
  XmlReader(std::string_view bytes, const std::string& where)
      : file_(bytes, where), arrays_(file_, bytes.size()) {}

  Stream read() {
    const std::string type = file_.root.attribute("type").value();
    if (type != "UnstructuredGrid" && type != "PolyData")
      file_.fail(file_.root, "a file of type " + quoted(type) +
                                 ", but only UnstructuredGrid and PolyData hold a surface");
    const pugi::xml_node grid = file_.root.child(type.c_str());
    if (!grid) file_.fail(file_.root, "no element " + type);
    // names are pairs of numbers; longer arrays need not be decompressed
    for (pugi::xml_node array : grid.child("FieldData").children("DataArray"))
      if (!attribute_is(array, "type", "String") && arrays_.is_short(array))
        if (Array a = arrays_.load(array); a.size() <= 2) data_.field_data.push_back(std::move(a));
    for (pugi::xml_node p : grid.children("Piece")) piece(p, type == "PolyData");
    return vtk_surface(std::move(data_));
  }

 private:
  pugi::xml_node child(pugi::xml_node node, const char* section, const char* name) const {
    const pugi::xml_node array = name ? node.child(section).find_child_by_attribute("DataArray", "Name", name)
                                      : node.child(section).child("DataArray");
    if (!array) file_.fail(node, std::string("no array ") + (name ? name : "") + " in " + section);
    return array;
  }

  void piece(pugi::xml_node node, bool polygons) {
    const int first_point = static_cast<int>(data_.points.size()), first_cell = data_.cells;
    const std::size_t n = file_.number(node, "NumberOfPoints", 0);
    if (n > 0) {
      const pugi::xml_node array = child(node, "Points", nullptr);
      const Array points = arrays_.load(array, n);
      if (points.components != 3 || points.rows() != n)
        file_.fail(array, "points of " + std::to_string(points.components) + " components, " +
                              std::to_string(points.rows()) + " of them, expected 3 and " +
                              std::to_string(n));
      add_points(array, points);
    }
    if (polygons) {
      cells(node, "Verts", 2, first_point);
      cells(node, "Lines", 4, first_point);
      // cell data come in this order, not in that of the sections
      cells(node, "Polys", vtk_polygon, first_point);
      cells(node, "Strips", vtk_strip, first_point);
    } else if (file_.number(node, "NumberOfCells", 0) > 0) {
      cells(node, "Cells", 0, first_point);
    }
    read_data(node, "PointData", data_.point_data, n);
    read_data(node, "CellData", data_.cell_data, static_cast<std::size_t>(data_.cells - first_cell));
  }

  void add_points(pugi::xml_node node, const Array& array) {
    std::visit(
        [&](const auto& v) {
          data_.points.reserve(data_.points.size() + v.size() / 3);
          for (std::size_t i = 0; i + 2 < v.size(); i += 3) {
            const Vec3 p{static_cast<double>(v[i]), static_cast<double>(v[i + 1]),
                         static_cast<double>(v[i + 2])};
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
              file_.fail(node, "point " + std::to_string(i / 3) + " holds a number that is not finite");
            data_.points.push_back(p);
          }
        },
        array.data);
  }

  /// Reads a section of cells; `type` is 0 if each has its own.
  void cells(pugi::xml_node piece, const char* section, int type, int first_point) {
    if (type && !piece.child(section)) return;
    const pugi::xml_node node = child(piece, section, "connectivity");
    const std::string here = file_.place(node);
    std::vector<int> corners = arrays_.integers(node);
    const std::vector<int> ends = arrays_.integers(child(piece, section, "offsets"));
    const std::vector<int> types =
        type ? std::vector<int>() : arrays_.integers(child(piece, section, "types"));
    if (!type && types.size() != ends.size())
      file_.fail(node, std::to_string(types.size()) + " types of cells, but " + std::to_string(ends.size()) +
                           " offsets");
    for (int& v : corners) {
      if (v < 0 || v > std::numeric_limits<int>::max() - first_point)
        file_.fail(node, "a cell uses point " + std::to_string(v));
      v += first_point;
    }
    int first = 0;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      if (ends[i] < first || ends[i] > static_cast<int>(corners.size()))
        file_.fail(node, "cell " + std::to_string(i) + " has offset " + std::to_string(ends[i]) +
                             ", expected " + std::to_string(first) + " to " + std::to_string(corners.size()));
      data_.add_cell(type ? type : types[i], corners.data() + first,
                     static_cast<std::size_t>(ends[i] - first), here);
      first = ends[i];
    }
  }

  /// Appends the arrays of a piece to those of the same name of earlier pieces.
  void read_data(pugi::xml_node piece, const char* section, std::vector<Array>& all, std::size_t rows) {
    for (pugi::xml_node node : piece.child(section).children("DataArray")) {
      if (attribute_is(node, "type", "String")) continue;
      Array array = arrays_.load(node, rows);
      if (array.rows() != rows)
        file_.fail(node, shown(node) + " has " + std::to_string(array.rows()) + " rows, expected " +
                             std::to_string(rows));
      auto same = std::find_if(all.begin(), all.end(), [&](const Array& a) {
        return a.name == array.name && a.components == array.components &&
               a.data.index() == array.data.index();
      });
      if (same == all.end() || first_piece_)
        all.push_back(std::move(array));
      else
        std::visit(
            [&](auto& v) {
              const auto& w = std::get<std::decay_t<decltype(v)>>(array.data);
              v.insert(v.end(), w.begin(), w.end());
            },
            same->data);
    }
    if (std::string_view(section) == "CellData") first_piece_ = false;
  }

  XmlFile file_;
  ArrayReader arrays_;
  VtkData data_;
  bool first_piece_ = true;
};

}  // namespace

bool is_vtk_xml(std::string_view bytes) {
  const std::size_t start = bytes.find_first_not_of(" \t\r\n");
  if (start == std::string_view::npos) return false;
  bytes = bytes.substr(start, 4096);
  return bytes.starts_with("<VTKFile") ||
         (bytes.starts_with("<?xml") && bytes.find("<VTKFile") != std::string_view::npos);
}

Stream read_vtk_xml(std::string_view bytes, const std::string& where) {
  return XmlReader(bytes, where).read();
}

}  // namespace meshpipe
