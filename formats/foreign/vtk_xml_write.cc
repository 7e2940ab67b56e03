// SPDX-License-Identifier: BSD-3-Clause
#include <zlib.h>

#include "formats/foreign/base64.h"
#include "formats/foreign/bytes.h"
#include "formats/foreign/vtk_data.h"
#include "formats/foreign/vtk_xml.h"
#include "formats/stream/second_order.h"
#include "formats/text.h"
#include "lib/core/error.h"

namespace meshpipe {
namespace {

template <class T>
constexpr const char* type_name = sizeof(T) == 1   ? "UInt8"
                                  : sizeof(T) == 4 ? "Int32"
                                                   : "Float64";

class Xml {
 public:
  explicit Xml(bool ascii) : ascii_(ascii) {}

  template <class T>
  void array(std::string_view name, int components, const T* values, std::size_t n, const char* more = "") {
    out += std::string("<DataArray type=\"") + type_name<T> + "\" Name=\"" + xml_escaped(name) +
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
      compressed({reinterpret_cast<const char*>(values), n * sizeof(T)});
      out += '\n';
    }
    out += "</DataArray>\n";
  }

  void array(const Array& a, const char* more = "") {
    std::visit([&](const auto& v) { array(a.name, a.components, v.data(), v.size(), more); }, a.data);
  }

  void columns(const char* section, const Table& table) {
    out += std::string("<") + section + ">\n";
    for (const Group& g : groups_of(table)) array(array_of(g));
    out += std::string("</") + section + ">\n";
  }

  std::string out;

 private:
  /// Appends sizes and compressed blocks, as two texts of base64. More effort makes coordinates hardly
  /// smaller.
  void compressed(std::string_view bytes) {
    constexpr std::size_t block = 1 << 20;
    const std::size_t n = (bytes.size() + block - 1) / block;
    std::string sizes, blocks;
    for (std::size_t v : {n, block, bytes.size() % block}) put(sizes, static_cast<std::uint64_t>(v));
    for (std::size_t i = 0; i < n; ++i) {
      const std::string_view b = bytes.substr(i * block, block);
      const std::size_t start = blocks.size();
      uLongf length = compressBound(b.size());
      blocks.resize(start + length);
      if (compress2(reinterpret_cast<Bytef*>(blocks.data() + start), &length,
                    reinterpret_cast<const Bytef*>(b.data()), b.size(), Z_BEST_SPEED) != Z_OK)
        throw CannotWrite("zlib could not compress " + std::to_string(b.size()) + " bytes");
      blocks.resize(start + length);
      put(sizes, static_cast<std::uint64_t>(length));
    }
    append_base64(out, sizes);
    append_base64(out, blocks);
  }

  bool ascii_;
};

std::string write_xml(const Stream& stream, bool ascii, bool polygons) {
  const SecondOrder second(stream);
  const bool curved = second && !polygons;
  const Surface& s = curved ? second.surface() : stream.surface;
  const std::size_t n = s.tris.size(), nodes = curved ? 6 : 3;
  static_assert(sizeof(Vec3) == 24 && sizeof(Tri) == 12);
  const std::string type = polygons ? "PolyData" : "UnstructuredGrid", cells = polygons ? "Polys" : "Cells";
  Xml xml(ascii);
  xml.out = "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + type +
            "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\"" +
            (ascii ? "" : " compressor=\"vtkZLibDataCompressor\"") + ">\n<" + type + ">\n";
  if (!stream.names.empty()) {
    xml.out += "<FieldData>\n";
    for (const Array& a : field_of_names(stream)) xml.array(a, " NumberOfTuples=\"2\"");
    xml.out += "</FieldData>\n";
  }
  xml.out += "<Piece NumberOfPoints=\"" + std::to_string(s.points.size()) + "\" ";
  if (polygons) xml.out += "NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" ";
  xml.out += "NumberOf" + cells + "=\"" + std::to_string(n) + "\">\n<Points>\n";
  xml.array("Points", 3, s.points.empty() ? nullptr : &s.points[0].x, 3 * s.points.size());
  xml.out += "</Points>\n<" + cells + ">\n";
  std::vector<int> all_nodes, offsets;
  for (const Tri& t : s.tris) {
    if (!curved) break;
    all_nodes.insert(all_nodes.end(), t.begin(), t.end());
    for (int i = 0; i < 3; ++i) all_nodes.push_back(second.node(t[i], t[(i + 1) % 3]));
  }
  xml.array("connectivity", 1, curved ? all_nodes.data() : n ? s.tris[0].data() : nullptr, nodes * n);
  for (std::size_t t = 1; t <= n; ++t) offsets.push_back(static_cast<int>(nodes * t));
  xml.array("offsets", 1, offsets.data(), n);
  if (!polygons) {
    const std::vector<std::uint8_t> types(n, curved ? vtk_quadratic_triangle : vtk_triangle);
    xml.array("types", 1, types.data(), n);
  }
  xml.out += "</" + cells + ">\n";
  xml.columns("PointData", s.vertex);
  xml.columns("CellData", s.face);
  xml.out += "</Piece>\n</" + type + ">\n</VTKFile>\n";
  return std::move(xml.out);
}

}  // namespace

std::string write_vtu(const Stream& stream, bool ascii) { return write_xml(stream, ascii, false); }
std::string write_vtp(const Stream& stream, bool ascii) { return write_xml(stream, ascii, true); }

}  // namespace meshpipe
