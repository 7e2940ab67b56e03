// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/pack.h"

#include <gtest/gtest.h>
#include <zlib.h>

namespace meshpipe {
namespace {

std::string from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  unsigned word = 0;
  int bits = 0;
  for (char c : text) {
    if (c == '=') break;
    word = word << 6 | (unsigned)digits.find(c);
    if ((bits += 6) >= 8) out += (char)(word >> (bits -= 8) & 255);
  }
  return out;
}

/// Reads what pack has written, as viewer.js does: the corners of all triangles, and the bytes after them.
struct Unpacked {
  std::vector<Vec3> points, corners;
  std::string rest;

  explicit Unpacked(const PackedMesh& packed) {
    const std::string deflated = from_base64(packed.bytes);
    std::string bytes(100000, 0);
    uLongf size = bytes.size();
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size,
                         reinterpret_cast<const Bytef*>(deflated.data()), deflated.size()),
              Z_OK);
    bytes.resize(size);
    const std::size_t n = (std::size_t)packed.head["vertices"] + (std::size_t)packed.head["dots"],
                      m = packed.head["triangles"];
    points.resize(n);
    std::size_t at = 0;
    int axis_number = 0;
    for (double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      int last = 0;
      for (std::size_t i = 0; i < n; ++i) {
        const int code = (unsigned char)bytes[at + i] | (unsigned char)bytes[at + n + i] << 8;
        last = (last + (code >> 1 ^ -(code & 1))) & 0xffff;
        points[i].*axis =
            (double)packed.head["low"][axis_number] + last * (double)packed.head["step"][axis_number];
      }
      at += 2 * n;
      ++axis_number;
    }
    int used = 0;
    for (std::size_t i = 0; i < 3 * m; ++i) {
      int code = 0, shift = 0;
      for (;; shift += 7) {
        const int byte = (unsigned char)bytes[at++];
        code |= (byte & 127) << shift;
        if (byte < 128) break;
      }
      corners.push_back(points.at((std::size_t)(used - code)));
      used += code == 0;
    }
    rest = bytes.substr(at);
  }
};

TEST(pack, base64_of_each_length) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("M"), "TQ==");
  EXPECT_EQ(base64("Ma"), "TWE=");
  EXPECT_EQ(base64("Man\xff"), "TWFu/w==");
}

TEST(pack, gives_back_triangles_in_order_to_the_step) {
  Mesh mesh{{{9, 9, 9}, {0, 0, 0}, {1, 0, 1e-3}, {1, 50, 0}, {0, 50, 1e-3}}, {{1, 2, 3}, {3, 4, 1}}};
  const PackedMesh packed = pack(mesh, {}, {});
  EXPECT_EQ(packed.head["vertices"], 4);  // an unused one is left out
  const Unpacked u(packed);
  ASSERT_EQ(u.corners.size(), 6u);
  for (int h = 0; h < 6; ++h) {
    const Vec3 d = u.corners[h] - mesh.points[origin(mesh.tris, h)];
    EXPECT_LE(std::abs(d.x), 0.51 / 65535);
    EXPECT_LE(std::abs(d.y), 0.51 * 50 / 65535);
    EXPECT_LE(std::abs(d.z), 0.51e-3 / 65535);
  }
}

TEST(pack, writes_thick_edges_figures_and_labels) {
  Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {2, 1, 3}}};
  const MeshColumns columns{{{"kappa", {0.5, 2}}, {"size", {1, 100}, 1, 10000, true}},
                            {{"patch", {0, 300}, std::vector<std::string>(301, "inlet")}}};
  const Unpacked u(pack(mesh, {5, 2}, columns));
  // one region of area 1 with thick edges of length 3: 2/3 apart, where the diagonal is sqrt 2
  const char spacing = (char)std::lround(255 + 16 * std::log2(2 / 3. / std::sqrt(2.)));
  const std::string expected{5, 2, spacing, spacing, (char)128, (char)255, 0, (char)128, 0, 44, 0, 1};
  EXPECT_EQ(u.rest, expected);
}

TEST(pack, corrects_figures_of_rounded_positions) {
  // the second triangle is so small that rounding changes its figure, the first is not
  const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {3e-5, 0, 0}, {0, 1e-5, 0}}, {{0, 1, 2}, {0, 3, 4}}};
  auto figure = [](const Mesh& m, int t) { return norm(m.points[m.tris[t][1]]) / 6e-5; };
  const FigureColumn column{"x", {figure(mesh, 0), figure(mesh, 1)}, 0, 1, false, figure};
  const Unpacked u(pack(mesh, {}, {{column}, {}}));
  const int rounded = (int)std::lround(255 * std::round(3e-5 * 65535) / 65535 / 6e-5);
  EXPECT_EQ(u.rest.substr(4), (std::string{0, (char)(128 - rounded)}));
  EXPECT_NE(rounded, 128);
}

TEST(pack, adds_dots_to_the_points) {
  const PackedMesh packed = pack({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, {}, {}, {{2, 0.5, 0}});
  const Unpacked u(packed);
  EXPECT_EQ(packed.head["vertices"], 3);
  ASSERT_EQ(u.points.size(), 4u);
  EXPECT_NEAR(u.points[3].x, 2, 1e-4);
  EXPECT_NEAR(u.points[3].y, 0.5, 1e-4);
}

TEST(pack, takes_what_has_no_extent) {
  const PackedMesh point = pack({{{3, 4, 5}, {3, 4, 5}, {3, 4, 5}}, {{0, 1, 2}}}, {}, {});
  EXPECT_EQ(Unpacked(point).corners[0].y, 4);
  EXPECT_EQ(pack({{{1, 2, 3}}, {}}, {}, {}).head["triangles"], 0);
}

}  // namespace
}  // namespace meshpipe
