// SPDX-License-Identifier: BSD-3-Clause
#include "formats/vtu.h"

#include <cstring>

#include "formats/polygons.h"
#include "formats/text.h"

namespace meshpipe {
namespace {

template <class T>
constexpr const char* type_name = sizeof(T) == 1   ? "UInt8"
                                  : sizeof(T) == 4 ? "Int32"
                                                   : "Float64";

void append_base64(std::string& out, const unsigned char* bytes, std::size_t n) {
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::size_t i = 0;
  for (; i + 3 <= n; i += 3) {
    const unsigned v = bytes[i] << 16 | bytes[i + 1] << 8 | bytes[i + 2];
    out += {digits[v >> 18], digits[v >> 12 & 63], digits[v >> 6 & 63], digits[v & 63]};
  }
  if (i == n) return;
  const unsigned v = bytes[i] << 16 | (i + 1 < n ? bytes[i + 1] << 8 : 0);
  out += {digits[v >> 18], digits[v >> 12 & 63], i + 1 < n ? digits[v >> 6 & 63] : '=', '='};
}

bool is_utf8(std::string_view text) {
  int due = 0;  // bytes that continue the current character
  for (unsigned char c : text) {
    if ((c & 0xC0) == 0x80) {
      if (due-- == 0) return false;
    } else {
      if (due > 0 || c > 0xF4) return false;
      due = c < 0x80 ? 0 : c < 0xE0 ? 1 : c < 0xF0 ? 2 : 3;
    }
  }
  return due == 0;
}

std::string escaped(std::string_view text) {
  const bool utf8 = is_utf8(text);
  std::string out;
  for (char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte > 127 && !utf8)  // then it can only be Latin 1
      out += {static_cast<char>(0xC0 | byte >> 6), static_cast<char>(0x80 | (byte & 63))};
    else if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

class Vtu {
 public:
  explicit Vtu(bool ascii) : ascii_(ascii) {}

  template <class T>
  void array(std::string_view name, int components, const T* values, std::size_t n, const char* more = "") {
    out += std::string("<DataArray type=\"") + type_name<T> + "\" Name=\"" + escaped(name) +
           "\" NumberOfComponents=\"" + std::to_string(components) + "\"" + more +
           (ascii_ ? " format=\"ascii\">\n" : " format=\"binary\">\n");
    if (ascii_) {
      for (std::size_t i = 0; i < n; ++i) {
        if constexpr (sizeof(T) == 8)
          append(out, values[i]);
        else
          append(out, static_cast<long long>(values[i]));
        out += (i + 1) % components ? ' ' : '\n';
      }
    } else {
      // the count of bytes and the bytes are one base64 text
      const std::uint64_t bytes = n * sizeof(T);
      std::vector<unsigned char> block(8 + bytes);
      std::memcpy(block.data(), &bytes, 8);
      if (bytes) std::memcpy(block.data() + 8, values, bytes);
      append_base64(out, block.data(), block.size());
      out += '\n';
    }
    out += "</DataArray>\n";
  }

  void columns(const char* section, const Table& table, bool skip_color) {
    for (const Column& c : table.columns) {
      if (skip_color && (c.name == "red" || c.name == "green" || c.name == "blue")) continue;
      std::visit([&](const auto& v) { array(c.name, 1, v.data(), v.size()); }, c.data);
    }
    out += std::string("</") + section + ">\n";
  }

  std::string out;

 private:
  bool ascii_;
};

/// Names as meshio has them: an array of the name, which holds the tag and the dimension.
void write_names(Vtu& vtu, const Stream& stream) {
  if (stream.names.empty()) return;
  vtu.out += "<FieldData>\n";
  for (const Name& n : stream.names) {
    const int tag_and_dim[] = {n.tag, n.dim};
    vtu.array(one_line(n.text), 1, tag_and_dim, 2, " NumberOfTuples=\"2\"");
  }
  vtu.out += "</FieldData>\n";
}

}  // namespace

std::string write_vtu(const Stream& stream, bool ascii) {
  const Surface& s = stream.surface;
  const std::size_t n = s.tris.size();
  static_assert(sizeof(Vec3) == 24 && sizeof(Tri) == 12);
  Vtu vtu(ascii);
  vtu.out =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n"
      "<UnstructuredGrid>\n";
  write_names(vtu, stream);
  vtu.out += "<Piece NumberOfPoints=\"" + std::to_string(s.points.size()) + "\" NumberOfCells=\"" +
             std::to_string(n) + "\">\n<Points>\n";
  vtu.array("Points", 3, s.points.empty() ? nullptr : &s.points[0].x, 3 * s.points.size());
  vtu.out += "</Points>\n<Cells>\n";
  vtu.array("connectivity", 1, n ? s.tris[0].data() : nullptr, 3 * n);
  std::vector<int> offsets(n);
  for (std::size_t t = 0; t < n; ++t) offsets[t] = static_cast<int>(3 * t + 3);
  vtu.array("offsets", 1, offsets.data(), n);
  const std::vector<std::uint8_t> types(n, 5);  // VTK_TRIANGLE
  vtu.array("types", 1, types.data(), n);
  vtu.out += "</Cells>\n<PointData>\n";
  vtu.columns("PointData", s.vertex, false);
  vtu.out += "<CellData>\n";
  const bool color = s.face.has("red") && s.face.has("green") && s.face.has("blue");
  if (color) {
    const auto &r = s.face.get<std::uint8_t>("red"), &g = s.face.get<std::uint8_t>("green"),
               &b = s.face.get<std::uint8_t>("blue");
    std::vector<std::uint8_t> rgb(3 * n);
    for (std::size_t t = 0; t < n; ++t) {
      rgb[3 * t] = r[t];
      rgb[3 * t + 1] = g[t];
      rgb[3 * t + 2] = b[t];
    }
    vtu.array("color", 3, rgb.data(), rgb.size());
  }
  vtu.columns("CellData", s.face, color);
  vtu.out += "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  return std::move(vtu.out);
}

}  // namespace meshpipe
