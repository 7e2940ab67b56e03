// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/pack.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>

#include "lib/core/bvh.h"
#include "lib/core/error.h"
#include "tools/report/page_meshes.h"

namespace meshpipe {
namespace {

constexpr int steps = 65535;       ///< of a coordinate over the bounding box
constexpr int most_names = 65536;  ///< of a label column; further ones share the last

/// The vertices of a mesh in the order in which its triangles use them, and the corners as the distance back
/// from the next unused number, 0 for a vertex that is used for the first time: small numbers, since
/// triangles are near those before them.
struct Order {
  std::vector<int> vertices;
  std::string corners;  ///< 7 bits a byte, the lowest first; the highest bit says that more follow

  explicit Order(const Mesh& mesh) {
    std::vector<int> number(mesh.points.size(), -1);
    for (const Tri& t : mesh.tris)
      for (int v : t) {
        unsigned code = 0;
        if (number[v] < 0) {
          number[v] = (int)vertices.size();
          vertices.push_back(v);
        } else {
          code = (unsigned)((int)vertices.size() - number[v]);
        }
        for (; code > 127; code >>= 7) corners += (char)(code | 128);
        corners += (char)code;
      }
  }
};

/// Adds 16-bit numbers as all low bytes and then all high bytes, which deflate better.
void add_split(std::string& out, const std::vector<int>& values) {
  for (int shift : {0, 8})
    for (int x : values) out += (char)(x >> shift & 255);
}

/// Returns numbers as differences from the one before, signs in the lowest bit.
std::vector<int> differences(const std::vector<int>& values) {
  std::vector<int> codes;
  int last = 0;
  for (int x : values) {
    const int d = (std::int16_t)(x - last);  // modulo 65536
    codes.push_back((d << 1 ^ d >> 15) & 0xffff);
    last = x;
  }
  return codes;
}

/// A distance over the diagonal in sixteenths of its logarithm to base 2, plus 255; 255 above the diagonal.
int spacing_code(double x) {
  return x > 0 ? (int)std::lround(std::clamp(255 + 16 * std::log2(x), 0.0, 255.0)) : 0;
}

int quantized(const FigureColumn& c, double x) {
  auto f = [&](double y) { return c.logarithmic ? std::log(y) : y; };
  const double share = c.high > c.low ? (f(x) - f(c.low)) / (f(c.high) - f(c.low)) : 0;
  return share > 0 ? (int)std::lround(255 * std::min(share, 1.0)) : 0;
}

}  // namespace

std::string base64(std::string_view bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? (unsigned char)bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k <= bytes.size() ? digits[word >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

std::string packed_bytes(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string out(size, 0);
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                bytes.size(), 9) != Z_OK)
    throw CannotWrite("the mesh cannot be compressed");
  out.resize(size);
  return base64(out);
}

PackedMesh pack(const Mesh& mesh, const std::vector<std::uint8_t>& thick, const MeshColumns& columns,
                const std::vector<Vec3>& dots) {
  const Order order(mesh);
  std::vector<Vec3> points;
  for (int v : order.vertices) points.push_back(mesh.points[v]);
  points.insert(points.end(), dots.begin(), dots.end());
  Box box{{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
  for (Vec3 p : points) box = join(box, {p, p});
  if (points.empty()) box = {};
  const Vec3 size = box.hi - box.lo, step = (1.0 / steps) * size;
  std::string bytes;
  Mesh rounded{std::vector<Vec3>(mesh.points.size()), mesh.tris};
  for (double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    const double s = step.*axis;
    std::vector<int> counts;
    for (Vec3 p : points) counts.push_back(s > 0 ? (int)std::lround((p.*axis - box.lo.*axis) / s) : 0);
    for (std::size_t i = 0; i < order.vertices.size(); ++i)
      rounded.points[order.vertices[i]].*axis = box.lo.*axis + counts[i] * s;
    add_split(bytes, differences(counts));
  }
  bytes += order.corners;
  for (std::size_t t = 0; t < mesh.tris.size(); ++t) bytes += (char)(thick.empty() ? 0 : thick[t] & 7);
  for (double spacing : spacing_of(mesh, thick)) bytes += (char)spacing_code(spacing / norm(size));
  auto figures = nlohmann::ordered_json::array(), labels = figures;
  for (const FigureColumn& c : columns.figures) {
    for (int t = 0; t < (int)c.values.size(); ++t)
      bytes +=
          (char)(quantized(c, c.values[t]) - (c.of_triangle ? quantized(c, c.of_triangle(rounded, t)) : 0));
    figures.push_back({{"name", c.name}, {"low", c.low}, {"high", c.high}, {"log", c.logarithmic}});
  }
  for (const LabelColumn& c : columns.labels) {
    std::vector<int> values = c.values;
    for (int& x : values) x = std::min(x, most_names - 1);
    add_split(bytes, values);
    auto names = c.names;
    if (names.size() > most_names) names.resize(most_names);
    labels.push_back({{"name", c.name}, {"names", names}});
  }
  PackedMesh packed;
  packed.head = {{"vertices", order.vertices.size()},
                 {"dots", dots.size()},
                 {"triangles", mesh.tris.size()},
                 {"low", {box.lo.x, box.lo.y, box.lo.z}},
                 {"step", {step.x, step.y, step.z}},
                 {"diagonal", norm(size)},
                 {"columns", figures},
                 {"labels", labels}};
  packed.bytes = packed_bytes(bytes);
  return packed;
}

}  // namespace meshpipe
