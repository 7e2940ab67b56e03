// SPDX-License-Identifier: BSD-3-Clause
#include "formats/formats.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <regex>
#include <set>
#include <sstream>

#include "formats/foreign/inria.h"
#include "lib/core/error.h"
#include "tests/unit/formats/failure.h"

using namespace meshpipe;
namespace fs = std::filesystem;

static std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream out;
  out << file.rdbuf();
  return out.str();
}

static std::vector<fs::path> examples(const char* folder) {
  std::vector<fs::path> all;
  for (const auto& entry : fs::directory_iterator(fs::path(SOURCE_DIR) / "formats" / folder))
    all.push_back(entry.path());
  std::sort(all.begin(), all.end());
  return all;
}

/// One line that names a line or byte.
static bool names_a_place(const std::string& message) {
  static const std::regex place("in:[0-9]+: [^\n]+[^.\n]");
  return std::regex_match(message, place);
}

TEST(Mply, PassedExamplesRoundTripThroughBothEncodings) {
  ASSERT_GE(examples("passed").size(), 8u);
  for (const fs::path& path : examples("passed")) {
    SCOPED_TRACE(path.filename());
    const std::string text = contents(path);
    Stream stream = read_stream(text, "in");
    EXPECT_TRUE(stream.ascii);
    EXPECT_EQ(write_stream(stream, true), text);
    const std::string binary = write_stream(stream, false);
    stream = read_stream(binary, "in");
    EXPECT_FALSE(stream.ascii);
    EXPECT_EQ(write_stream(stream, false), binary);
    EXPECT_EQ(write_stream(stream, true), text);
  }
}

TEST(Mply, FailedExamplesFailNamingThePlace) {
  ASSERT_GE(examples("failed").size(), 60u);
  for (const fs::path& path : examples("failed"))
    EXPECT_PRED1(names_a_place, failure(contents(path), read_stream)) << path.filename();
}

TEST(Mply, TruncatedAnywhereFails) {
  for (const fs::path& path : examples("passed")) {
    const Stream stream = read_stream(contents(path), "in");
    for (bool ascii : {true, false}) {
      const std::string bytes = write_stream(stream, ascii);
      for (std::size_t n = 0; n < bytes.size(); ++n)
        ASSERT_PRED1(names_a_place, failure(bytes.substr(0, n), read_stream))
            << path.filename() << " cut at byte " << n << " of " << bytes.size();
    }
  }
}

TEST(Mply, BinaryRowsAreChecked) {
  Stream stream = read_stream(contents(fs::path(SOURCE_DIR) / "formats/passed/square.ply"), "in");
  const std::string good = write_stream(stream, false);
  const std::size_t rows = good.find("end_header\n") + 11, faces = rows + 4 * 24;
  auto changed = [&](std::size_t at, auto value) {
    std::string bytes = good;
    std::memcpy(&bytes[at], &value, sizeof value);
    return failure(bytes, read_stream);
  };
  EXPECT_EQ(failure(good, read_stream), "");
  EXPECT_PRED1(names_a_place, changed(rows + 8, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_PRED1(names_a_place, changed(rows + 8, std::numeric_limits<double>::infinity()));
  EXPECT_PRED1(names_a_place, changed(faces, char{4}));
  EXPECT_EQ(changed(faces + 13 + 9, 4),
            "in:" + std::to_string(faces + 13) + ": face 1 uses vertex 4, but there are 4");
  EXPECT_PRED1(names_a_place, failure(good + '\n', read_stream));
}

TEST(Mply, LeavesOutWhatIsNotWanted) {
  const Stream all = read_stream(contents(fs::path(SOURCE_DIR) / "formats/passed/lifted.ply"), "in");
  const Wanted shape = [](std::string_view table, std::string_view column) {
    return table == "vertex" ? column == "x" || column == "size" : column == "vertex_indices";
  };
  const Wanted reference = [](std::string_view table, std::string_view) { return table.starts_with("ref_"); };
  for (bool ascii : {false, true}) {
    const std::string bytes = write_stream(all, ascii);
    MemorySource first(bytes), second(bytes);
    const Stream some = read_stream(first, "in", false, shape),
                 tables = read_stream(second, "in", false, reference);
    EXPECT_EQ(some.surface.points, all.surface.points);
    EXPECT_EQ(some.surface.tris, all.surface.tris);
    EXPECT_EQ(some.surface.vertex.columns.size(), 1u);
    EXPECT_EQ(some.surface.vertex.get<double>("size"), all.surface.vertex.get<double>("size"));
    EXPECT_TRUE(some.surface.face.columns.empty() && some.tables.empty());
    EXPECT_TRUE(tables.surface.points.empty() && tables.surface.tris.empty());
    ASSERT_EQ(tables.tables.size(), 2u);
    EXPECT_EQ(tables.need("ref_vertex", "").get<double>("x"), all.need("ref_vertex", "").get<double>("x"));
  }
}

TEST(Mply, IsReadPieceByPiece) {
  /// Has no more in memory than it was asked for.
  struct Pieces : Source {
    explicit Pieces(std::string_view all) : left(all) {}
    std::string_view next(std::size_t n) override { return left.substr(0, n); }
    void drop(std::size_t n) override { left.remove_prefix(n); }
    std::size_t most_left() const override { return std::size_t(-1) / 2; }
    std::string_view left;
  };
  Mesh mesh;
  std::vector<int> patch;
  for (int i = 0; i < 30000; ++i) {  // more than a block
    mesh.points.push_back({1. * i, 2. * i, 3. * i});
    mesh.tris.push_back({i, (i + 1) % 30000, (i + 2) % 30000});
    patch.push_back(i);
  }
  Stream stream;
  stream.surface = surface_of(std::move(mesh));
  stream.surface.face.set("patch", std::move(patch));
  for (bool ascii : {false, true}) {
    const std::string bytes = write_stream(stream, ascii);
    Pieces all(bytes), some(std::string_view(bytes).substr(0, bytes.size() - 5000));
    EXPECT_EQ(write_stream(read_stream(all, "in"), ascii), bytes);
    EXPECT_THROW(read_stream(some, "in"), BadInput);
  }
}

TEST(Mply, TheLineOfAFailedProgramIsPassedOn) {
  try {
    read_any("mply-failed mclean 4\n", "stdin");
    FAIL();
  } catch (const UpstreamFailed& e) {
    EXPECT_EQ(e.program, "mclean");
    EXPECT_EQ(e.status, 4);
  }
}

//  3---2   5---4   two squares of two triangles: patch 3 "left side" and patch 8 "100%"
//  | 1/|   | 3/|
//  |/0 |   |/2 |
//  0---1   6---7
static Stream two_patches() {
  Stream s;
  s.surface.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.1}, {0, 1, 0},
                      {3, 1, 0}, {2, 1, 0}, {2, 0, 0},   {3, 0, 1e-30}};
  s.surface.tris = {{0, 1, 2}, {0, 2, 3}, {6, 7, 4}, {6, 4, 5}};
  s.surface.vertex.rows = 8;
  s.surface.vertex.set<double>("size", std::vector<double>(8, 0.5));
  s.surface.face.set<int>("patch", {3, 3, 8, 8});
  s.surface.face.set<int>("part", {0, 1, 1, 1});
  s.names = {{2, 3, "left side"}, {2, 8, "100% of \"it\", 25%22"}};
  return s;
}

/// Corner coordinates of every triangle, and the name of its patch: what every format must keep.
static std::vector<std::pair<std::array<Vec3, 3>, std::string>> soup(const Stream& s) {
  std::vector<std::pair<std::array<Vec3, 3>, std::string>> out;
  for (std::size_t t = 0; t < s.surface.tris.size(); ++t) {
    const Tri& v = s.surface.tris[t];
    out.push_back({{s.surface.points[v[0]], s.surface.points[v[1]], s.surface.points[v[2]]},
                   s.name_of(2, s.surface.face.get<int>("patch")[t])});
  }
  return out;
}

TEST(Formats, TextFormatsKeepEveryDigitAndName) {
  const Stream original = two_patches();
  for (const char* path : {"a.mply", "a.ply", "a.stl", "a.obj", "a.msh", "a.msh4"}) {
    const std::string bytes = write_as(original, path, true);
    EXPECT_EQ(soup(read_any(bytes, path)), soup(original)) << path;
    // and what was read is written in the same way again
    EXPECT_EQ(write_as(read_any(bytes, path), path, true), bytes) << path;
  }
  const Stream off = read_any(write_as(original, "a.off", true), "a.off");
  EXPECT_EQ(off.surface.points, original.surface.points);
  EXPECT_EQ(off.surface.tris, original.surface.tris);
}

TEST(Formats, ObjGroupsOfOneNameStayApart) {
  Stream same = two_patches();
  const std::set<int> tags(same.surface.face.get<int>("patch").begin(),
                           same.surface.face.get<int>("patch").end());
  same.names.clear();
  for (int tag : tags) same.names.push_back({2, tag, "part"});
  const Stream back = read_any(write_as(same, "a.obj", true), "a.obj");
  ASSERT_EQ(back.names.size(), 2u);
  EXPECT_EQ(back.names[0].text, "part");
  EXPECT_EQ(back.names[1].text, "part_" + std::to_string(*tags.rbegin()));
}

TEST(Formats, BinaryPlyKeepsEveryBit) {
  EXPECT_EQ(soup(read_any(write_as(two_patches(), "a.ply", false), "a")), soup(two_patches()));
}

TEST(Formats, BinaryStlIsSinglePrecision) {
  const Stream stl = read_any(write_as(two_patches(), "a.stl", false), "a.stl");
  ASSERT_EQ(stl.surface.tris.size(), 4u);
  EXPECT_EQ(stl.surface.points.size(), 8u);
  EXPECT_EQ(stl.surface.tris[1], (Tri{0, 2, 3}));
  EXPECT_EQ(stl.surface.points[2].z, 0.1f);
  Stream large = two_patches();
  large.surface.points[1].x = 1e300;
  EXPECT_THROW(write_as(large, "a.stl", false), CannotWrite);
}

TEST(Formats, AnUnknownExtensionIsRefused) {
  EXPECT_THROW(write_as(two_patches(), "a.xyz", false), BadUsage);
  EXPECT_THROW(write_as(two_patches(), "dir.stl/a", false), BadUsage);
  EXPECT_PRED1(names_a_place, failure("hello\n"));
  EXPECT_PRED1(names_a_place, failure(""));
  EXPECT_PRED1(names_a_place, failure("\x1f\x8b\x08"));
}

TEST(Stl, BinaryIsRecognizedByItsSizeNotItsFirstWord) {
  std::string bytes = write_as(two_patches(), "a.stl", false);
  std::memcpy(bytes.data(), "solid of a careless writer", 26);
  EXPECT_EQ(read_any(bytes, "in").surface.tris.size(), 4u);
  bytes.pop_back();
  EXPECT_EQ(failure(bytes), "in:80: as a binary stl of 4 triangles it would have 284 bytes, but it has 283");
}

static const char* const facet =
    "facet normal nan 0 1\n outer loop\n vertex 0 0 0\n vertex +1 0 0\n vertex 0 1e0 0\n endloop\nendfacet\n";

TEST(Stl, EachSolidIsAPatch) {
  const std::string f = facet;
  // the third solid lacks its first line, as some writers have it
  Stream s = read_any("  SOLID first part\r\n" + f + "endsolid first part\n\n\tsolid\n" + f + f +
                          "endsolid\n" + f + "endsolid\nMade by a careless writer\n",
                      "in");
  EXPECT_EQ(s.surface.face.get<int>("patch"), (std::vector<int>{1, 2, 2, 3}));
  EXPECT_EQ(s.name_of(2, 1), "first part");
  EXPECT_EQ(s.name_of(2, 2), "");
  EXPECT_EQ(s.surface.points[1], (Vec3{1, 0, 0}));
}

TEST(Stl, EndsMayBeTwoWords) {
  const std::string f =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nEND LOOP\nend facet\n";
  EXPECT_EQ(
      read_any("solid a\n" + f + f + "end solid a\nsolid\n" + f + "end solid\n", "in").surface.tris.size(),
      3u);
  EXPECT_EQ(failure("solid\n" + f + "end\n"), "in:9: expected 'solid', 'facet' or 'endsolid', found 'end'");
}

TEST(Stl, LinesMayEndInCarriageReturns) {
  std::string text = std::string("solid\n") + facet + "endsolid\n";
  std::replace(text.begin(), text.end(), '\n', '\r');
  EXPECT_EQ(read_any(text, "in").surface.tris.size(), 1u);
  text.resize(text.size() - 9);
  EXPECT_EQ(failure(text), "in:8: expected 'endsolid', found the end of the file");
}

TEST(Stl, MalformedTextNamesTheLine) {
  const std::string f = facet;
  EXPECT_EQ(failure("solid\n" + f), "in:8: expected 'endsolid', found the end of the file");
  EXPECT_EQ(failure("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n"),
            "in:4: expected a coordinate, found the end of the line");
  EXPECT_EQ(failure("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 inf\n"),
            "in:4: expected a coordinate, found 'inf'");
  EXPECT_EQ(failure("solid\n" + f + "vertex 0 0 0\n"),
            "in:9: expected 'solid', 'facet' or 'endsolid', found 'vertex'");
}

TEST(Obj, GroupsObjectsOrMaterialsAreThePatches) {
  const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  Stream s =
      read_any(v + "g a b\nusemtl red\nf 1 2 3\ng other\nf 1/1 2/2 3/3\ng a b\nf -3//1 -2//2 -1//3\n", "in");
  EXPECT_EQ(s.surface.face.get<int>("patch"), (std::vector<int>{1, 2, 1}));
  EXPECT_EQ(s.name_of(2, 1), "a b");
  EXPECT_EQ(s.surface.tris[2], (Tri{0, 1, 2}));
  // one group does not distinguish faces, materials do
  s = read_any("# comment\r\n" + v + "g all\r\nf 1 2 3\r\nusemtl red\r\nf 1 2 \\\r\n 3 # end\r\n", "in");
  EXPECT_EQ(s.surface.face.get<int>("patch"), (std::vector<int>{0, 1}));
  EXPECT_EQ(s.name_of(2, 1), "red");
  s = read_any(v + "g wall#1 # left\nf 1 2 3\ng wall#2\nf 1 3 2 # end\n", "in");  // names may hold a #
  EXPECT_EQ(s.name_of(2, 1) + '|' + s.name_of(2, 2), "wall#1 # left|wall#2");
  s = read_any("o ring\n" + v + "f 1 2 3\n", "in");
  EXPECT_EQ(s.name_of(2, s.surface.face.get<int>("patch")[0]), "ring");
  s = read_any("f 1 2 3\n" + v, "in");  // vertices after the face that uses them
  EXPECT_EQ(s.surface.face.get<int>("patch"), std::vector<int>{0});
}

//  3---2
//  | / |   the line 4-1-3 follows two edges and then the diagonal; 2-4 is no edge
//  0---1
TEST(Obj, LinesAreModelEdges) {
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
  Stream s = read_any(square + "l 4 1/1 -2\nl 2 4\n", "in");
  EXPECT_EQ(s.surface.face.get<std::uint8_t>("model"), (std::vector<std::uint8_t>{4, 1 | 4}));
  ASSERT_EQ(s.remarks.size(), 1u);
  EXPECT_EQ(s.remarks[0], "left out: 1 line elements that are no edge of a triangle");
  EXPECT_FALSE(read_any(square, "in").surface.face.has("model"));
  EXPECT_EQ(failure(square + "l 1\n"), "in:7: a line of 1 point, expected at least 2");
  EXPECT_EQ(failure(square + "l 1 9\n"), "in:7: a face or line uses vertex 9, but there are 4");
  EXPECT_EQ(failure("v 0 0 0\nv 1 0 0\n"), "in:2: the file ends without a face");
}

TEST(Obj, BadCornersNameTheLine) {
  const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_EQ(failure(v + "f 1 2 4\n"), "in:4: a face or line uses vertex 4, but there are 3");
  EXPECT_EQ(failure(v + "f 1 2 -4\n"), "in:4: a face uses vertex -4, but there are 3 before it");
  EXPECT_EQ(failure(v + "f 0 1 2\n"), "in:4: vertex 0, but vertices are counted from 1");
  EXPECT_EQ(failure(v + "f 1 2\n"), "in:4: a face of 2 corners, expected at least 3");
  EXPECT_EQ(failure(v + "f 1 2 x\n"), "in:4: expected a corner, found 'x'");
  EXPECT_PRED1(names_a_place, failure(v + "f 1 2 -9223372036854775808\n"));
  EXPECT_PRED1(names_a_place, failure(v + "f 1 2 9223372036854775807\n"));
}

//  3-------2       3
//   \     /       / \        left: the short diagonal 1-3 is the better one
//    \   /       / 2 \       right: an arrow head; only the diagonal through corner 2 lies inside
//     0 1       0     1
TEST(Polygons, QuadsAreCutAlongTheBetterDiagonalInside) {
  Stream s = read_any("OFF 4 1 0\n0 0 0\n3 0 0\n4 1 0\n1 1 0\n4 0 1 2 3\n", "in");
  EXPECT_EQ(s.surface.tris, (std::vector<Tri>{{0, 1, 3}, {1, 2, 3}}));
  s = read_any("OFF\n4 1 0\n0 0 0\n1 1 0\n2 0 0\n1 3 0\n4 0 1 2 3\n", "in");
  EXPECT_EQ(s.surface.tris, (std::vector<Tri>{{0, 1, 3}, {1, 2, 3}}));
}

TEST(Polygons, FacesThatAreNotConvexKeepTheirAreaAndOrientation) {
  // a comb of n teeth in a slanted plane: area n + (2n - 1) and no inverted triangle
  const int n = 20;
  std::vector<Vec2> comb = {{0, 0}, {2.0 * n - 1, 0}};
  for (int i = n - 1; i >= 0; --i) {
    comb.push_back({2.0 * i + 1, 1});
    comb.push_back({2.0 * i + 1, 2});
    comb.push_back({2.0 * i, 2});
    comb.push_back({2.0 * i, 1});
  }
  std::string off = "OFF\n" + std::to_string(comb.size()) + " 1 0\n";
  for (Vec2 p : comb)
    off += std::to_string(p.x) + ' ' + std::to_string(p.y) + ' ' + std::to_string(p.x + p.y) + '\n';
  off += std::to_string(comb.size());
  for (std::size_t i = 0; i < comb.size(); ++i) off += ' ' + std::to_string(i);
  const Stream s = read_any(off + '\n', "in");
  EXPECT_EQ(s.surface.tris.size(), comb.size() - 2);
  double area = 0;
  for (const Tri& t : s.surface.tris) {
    const double a =
        0.5 * area_vector(s.surface.points[t[0]], s.surface.points[t[1]], s.surface.points[t[2]]).z;
    EXPECT_GE(a, 0);
    area += a;
  }
  EXPECT_NEAR(area, n + (2 * n - 1), 1e-9);
}

TEST(Off, KinAreReadAndCountsChecked) {
  EXPECT_EQ(read_any("# made by hand\nCOFF\n# counts\n3 2 0\n0 0 0 255 0 0 255\n1 0 0 1 1 1 1\n0 1 0 0 0 0 "
                     "0\n3 0 1 2 0.5\n2 0 1\n",
                     "in")
                .surface.tris.size(),
            1u);
  // a face may go on in the next line
  EXPECT_EQ(read_any("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n\n2 \n3 2 1 0\n", "in").surface.tris,
            (std::vector<Tri>{{0, 1, 2}, {2, 1, 0}}));
  EXPECT_EQ(failure("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
            "in:6: face 0 uses vertex 3, but there are 3");
  EXPECT_EQ(failure("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 2\n"),
            "in:7: '3' follows the last of 1 faces");
  EXPECT_PRED1(names_a_place, failure("OFF\n2000000000 1 0\n0 0 0\n"));
  EXPECT_PRED1(names_a_place, failure("4OFF\n0 0 0\n"));
}

TEST(Ply, ForeignOnesOfAllKindsGiveTheSame) {
  const std::string head =
      "comment by hand\r\nelement face 2\r\nproperty uchar alpha\r\nproperty list uchar uint vertex_index\r\n"
      "element vertex 4\r\nproperty float x\r\nproperty float y\r\nproperty float32 z\r\nproperty short "
      "quality\r\n"
      "element edge 1\r\nproperty list ushort int ends\r\nend_header\r\n";
  // faces first, one a quad; rows not one a line
  Stream text = read_any("ply\r\nformat ascii 1.0\r\n" + head +
                             "9 3 0 1 2 7 4 0 1 2 3\r\n0 0 0 1 1 0 0 1 1 1 0\r\n1 0 1 0 1\r\n2 0 1\r\n",
                         "in");
  ASSERT_EQ(text.surface.tris.size(), 3u);
  EXPECT_EQ(text.surface.points[2], (Vec3{1, 1, 0}));
  for (bool big : {false, true}) {
    std::string rows;
    auto put = [&](auto value) {
      char bytes[sizeof value];
      std::memcpy(bytes, &value, sizeof value);
      if (big) std::reverse(bytes, bytes + sizeof value);
      rows.append(bytes, sizeof value);
    };
    for (const std::vector<unsigned>& face : {std::vector<unsigned>{0, 1, 2}, {0, 1, 2, 3}}) {
      put(std::uint8_t{9});
      put(static_cast<std::uint8_t>(face.size()));
      for (unsigned v : face) put(v);
    }
    for (int v = 0; v < 4; ++v) {
      for (float x : {v == 1 || v == 2 ? 1.f : 0.f, v >= 2 ? 1.f : 0.f, 0.f}) put(x);
      put(std::int16_t{1});
    }
    put(std::uint16_t{2});
    put(0);
    put(1);
    const std::string whole =
        std::string("ply\r\nformat binary_") + (big ? "big" : "little") + "_endian 1.0\r\n" + head + rows;
    const Stream s = read_any(whole, "in");
    EXPECT_EQ(s.surface.tris, text.surface.tris);
    EXPECT_EQ(s.surface.points, text.surface.points);
    for (std::size_t n = 1; n < whole.size(); ++n)
      ASSERT_PRED1(names_a_place, failure(whole.substr(0, n))) << n;
  }
}

TEST(Ply, CountsAreNotTrusted) {
  const std::string head =
      "ply\nformat binary_little_endian 1.0\nelement vertex 2000000000\nproperty float x\n"
      "property float y\nproperty float z\nelement face 0\nproperty list uchar int vertex_indices\n";
  EXPECT_PRED1(names_a_place, failure(head + "end_header\n"));
  EXPECT_PRED1(names_a_place, failure(head + "element none 2000000000\nend_header\n"));
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n";
  EXPECT_PRED1(names_a_place, failure(text + std::string(60, '7') + " 0 0 0\n"));
  EXPECT_PRED1(names_a_place, failure(text + "-3 0 0 0\n"));
}

static const char* const tagged_msh =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Comments\nanything $at all\n$EndComments\n"
    "$PhysicalNames\n3\n2 7 \"outer wall\"\n1 7 \"edge\"\n2 9 \"lid\"\n$EndPhysicalNames\n"
    "$Nodes\n4\n10 0 0 0\n2 1 0 0\n30 1 1 0\n4 0 1 0\n$EndNodes\n"
    "$Elements\n5\n1 15 2 0 1 10\n2 1 2 7 1 10 2\n3 2 2 7 1 10 2 30\n4 2 3 0 5 99 10 30 4\n5 3 2 9 6 10 2 30 "
    "4\n$EndElements\n";

TEST(Msh, PhysicalTagsAreThePatchesAndElsewhereElementaryOnes) {
  const Stream s = read_any(tagged_msh, "in");
  EXPECT_EQ(s.surface.face.get<int>("patch"), (std::vector<int>{7, 9 + 5, 9, 9}));
  EXPECT_EQ(s.surface.tris[1], (Tri{0, 2, 3}));
  EXPECT_EQ(s.name_of(2, 7), "outer wall");
  EXPECT_EQ(s.name_of(1, 7), "edge");
  EXPECT_EQ(s.names.size(), 3u);
  // the line element is an edge of the first triangle
  EXPECT_EQ(s.surface.face.get<std::uint8_t>("model"), (std::vector<std::uint8_t>{1, 0, 1, 0}));
  EXPECT_EQ(s.find("line")->get<int>("tag"), std::vector<int>{7});
}

TEST(Msh, OtherVersionsAndBadNodesAreRefused) {
  auto with = [](const char* from, const char* to) {
    std::string bytes = tagged_msh;
    return bytes.replace(bytes.find(from), std::strlen(from), to);
  };
  EXPECT_EQ(failure(with("2.2 0", "3 0")), "in:2: msh version 3, expected 1, 2, 4 or 4.1");
  EXPECT_EQ(failure(with("2.2 0 8", "2.2 1 4")), "in:2: expected numbers of 8 bytes, found 4");
  EXPECT_EQ(failure(with("10 2 30\n4 2", "10 2 3\n4 2")),
            "in:24: surface element 0 uses node 3, which is none of the 4");
  EXPECT_EQ(failure(with("4 0 1 0\n$", "2 0 1 0\n$")), "in:18: node number 2 is given twice");
  EXPECT_PRED1(names_a_place, failure(with("$Nodes\n4", "$Nodes\n5")));
  EXPECT_PRED1(names_a_place, failure(with("$Nodes\n4", "$Nodes\n3")));
  EXPECT_PRED1(names_a_place, failure(with("$Elements\n5", "$Elements\n2147483647")));
  EXPECT_PRED1(names_a_place, failure(with("5 3 2 9", "5 9 2 9")));  // too few nodes for a curved one
}

TEST(Msh, NamesWithoutDimensionBelongToTheElementsThatHaveTheirTag) {
  std::string bytes = tagged_msh;
  const std::string names = "3\n2 7 \"outer wall\"\n1 7 \"edge\"\n2 9 \"lid\"\n";
  bytes.replace(bytes.find(names), names.size(), "3\n7 \"wall\"\n9 \"lid\"\n8 \"fluid\"\n");
  const Stream s = read_any(bytes, "in");
  EXPECT_EQ(s.names.size(), 3u);  // tag 8 is of no surface or line
  EXPECT_EQ(s.name_of(2, 7), "wall");
  EXPECT_EQ(s.name_of(1, 7), "wall");
  EXPECT_EQ(s.name_of(2, 9), "lid");
}

TEST(Msh, TagsBelowOneAreCountedUpWithTheirNames) {
  Stream s = two_patches();
  s.surface.face.set<int>("patch", {0, 0, 8, 8});
  s.names[0].tag = 0;
  const Stream back = read_any(write_as(s, "a.msh", true), "in");
  EXPECT_EQ(back.surface.face.get<int>("patch"), (std::vector<int>{1, 1, 9, 9}));
  EXPECT_EQ(soup(back), soup(s));
}

/// Columns by name: what formats with data must keep.
static std::string columns(const Stream& s) {
  Stream data;
  for (auto [from, to] :
       {std::pair{&s.surface.vertex, &data.surface.vertex}, {&s.surface.face, &data.surface.face}}) {
    *to = *from;
    std::sort(to->columns.begin(), to->columns.end(),
              [](const Column& a, const Column& b) { return a.name < b.name; });
  }
  data.surface.points = s.surface.points;
  data.surface.tris = s.surface.tris;
  return write_stream(data, true);
}

TEST(Matrix, EveryFormatGivesTheSameTrianglesNamesAndData) {
  Stream original = two_patches();
  Surface& s = original.surface;
  s.vertex.set<double>("wall%20shear.0", {0.1, 2, 3, 4, 5, 6, 7, 1e-300});
  s.vertex.set<double>("wall%20shear.1", std::vector<double>(8, -1));
  s.face.set<std::uint8_t>("model", {1, 0, 4, 1});
  s.face.set<std::uint8_t>("red", {1, 2, 3, 255});
  s.face.set<std::uint8_t>("green", {1, 2, 3, 0});
  s.face.set<std::uint8_t>("blue", {1, 2, 3, 1});
  // tiny, large, and neither
  for (double scale : {1.0, 1e-7, 1e6}) {
    Stream scaled = original;
    for (Vec3& p : scaled.surface.points) p = scale / 3 * p;
    for (const char* from : {"a.mply", "a.ply", "a.msh", "a.msh4", "a.vtu", "a.vtp", "a.vtk"})
      for (bool ascii : {true, false}) {
        const Stream first = read_any(write_as(scaled, from, ascii), from);
        EXPECT_EQ(soup(first), soup(scaled)) << from << ascii;
        // MSH has one number type, and no colors
        if (!std::string(from).starts_with("a.msh"))
          EXPECT_EQ(columns(first), columns(scaled)) << from << ascii;
        else
          EXPECT_EQ(first.surface.vertex.get<double>("wall%20shear.0"),
                    s.vertex.get<double>("wall%20shear.0"));
        for (const char* to : {"a.ply", "a.stl", "a.obj", "a.msh4", "a.vtu", "a.vtp", "a.vtk"})
          EXPECT_EQ(soup(read_any(write_as(first, to, true), to)), soup(scaled)) << from << " to " << to;
      }
    for (const char* path : {"a.mesh", "a.meshb"}) {  // without names
      const Stream back = read_any(write_as(scaled, path, true), path);
      EXPECT_EQ(back.surface.points, scaled.surface.points);
      EXPECT_EQ(back.surface.tris, scaled.surface.tris);
      EXPECT_EQ(back.surface.face.get<int>("patch"), s.face.get<int>("patch"));
      EXPECT_EQ(back.surface.face.get<std::uint8_t>("model"), s.face.get<std::uint8_t>("model"));
    }
  }
}

TEST(Matrix, AnEmptyMeshGoesThroughAll) {
  for (const char* path :
       {"a.ply", "a.off", "a.msh", "a.msh4", "a.vtu", "a.vtp", "a.vtk", "a.mesh", "a.meshb"})
    for (bool ascii : {true, false})
      EXPECT_EQ(read_any(write_as(Stream(), path, ascii), path).surface.tris.size(), 0u) << path;
  for (const char* path : {"a.gts", "a.bdf", "a.inp", "a.poly", "a.smesh"})
    EXPECT_FALSE(write_as(Stream(), path, true).empty()) << path;
}

//  3---2   6
//  |   |  / \      a strip 0 1 3 2, and a triangle 4 5 6 after a break
//  0---1 4---5
TEST(Ply, StripsAndDataOfVertices) {
  const Stream s = read_any(
      "ply\nformat ascii 1.0\nelement vertex 7\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty float quality\nproperty uint id\nelement tristrips 1\n"
      "property list int int vertex_indices\nend_header\n"
      "0 0 0 1 nan 4294967295\n1 0 0 2 2 1\n1 1 0 3 3 1\n0 1 0 4 4 1\n2 0 0 5 5 1\n4 0 0 6 6 1\n3 1 0 7 7 1\n"
      "9 0 1 3 2 2 -1 4 5 6\n",
      "in");
  EXPECT_EQ(s.surface.tris, (std::vector<Tri>{{0, 1, 3}, {3, 1, 2}, {4, 5, 6}}));
  EXPECT_EQ(s.surface.vertex.get<std::uint8_t>("red")[6], 7);
  EXPECT_EQ(s.surface.vertex.get<double>("id")[0], 4294967295.0);
  EXPECT_FALSE(s.surface.vertex.has("quality"));  // the stream holds no nan
  EXPECT_EQ(s.remarks, std::vector<std::string>{"left out: vertex data quality, not finite in row 0"});
}

TEST(Inria, ReferencesRidgesAndSizes) {
  const std::string mesh =
      "MeshVersionFormatted\n2\n# by hand\nDimension\n3\nVertices 4\n0 0 0 7\n1 0 0 0\n1 1 0 0\n0 1 0.5d-1 "
      "0\n"
      "Normals 1\n0 0 1\nTriangles\n1\n1 2 3 9\nQuadrilaterals 1\n1 2 3 4 -2\nEdges 1\n2 1 5\nRidges 1\n1\n"
      "Corners 1\n3\nRequiredTriangles 1\n1\nTetrahedra 1\n1 2 3 4 0\nEnd\n";
  Stream s = read_any(mesh, "in");
  EXPECT_EQ(s.surface.points[3], (Vec3{0, 1, 0.05}));
  EXPECT_EQ(s.surface.face.get<int>("patch"), (std::vector<int>{9, -2, -2}));
  EXPECT_EQ(s.surface.face.get<std::uint8_t>("required"), (std::vector<std::uint8_t>{1, 0, 0}));
  EXPECT_EQ(s.surface.face.get<std::uint8_t>("model")[0], 1);
  EXPECT_EQ(s.surface.vertex.get<int>("ref"), (std::vector<int>{7, 0, 0, 0}));
  EXPECT_EQ(s.surface.vertex.get<std::uint8_t>("corner"), (std::vector<std::uint8_t>{0, 0, 1, 0}));
  const std::string head = "MeshVersionFormatted 2\nDimension 3\nSolAtVertices\n";
  read_sol(s, head + "4\n1 1\n1 2 3 4\nEnd\n", "sol");
  EXPECT_EQ(s.surface.vertex.get<double>("size"), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(write_as(s, "a.sol", true), write_as(s, "b.sol", false));
  EXPECT_THROW(read_sol(s, head + "3\n1 1\n1 2 3\n", "sol"), BadInput);
  EXPECT_EQ(failure(head + "4\n1 1\n1 2 3 4\nEnd\n"),
            "in:5: values for 4 vertices, but there are 0: a .sol file goes with a mesh");
  EXPECT_THROW(write_as(two_patches(), "dir/b.txt", false), BadUsage);
}

TEST(Msh, DataCalledLineAreNoRowsOfTheTableOfLines) {
  const Stream s = read_any(
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"
      "$Elements\n2\n1 1 2 7 1 1 2\n2 2 2 4 4 1 2 3\n$EndElements\n"
      "$NodeData\n1\n\"line\"\n1\n0\n3\n0\n1\n3\n1 5\n2 6\n3 7\n$EndNodeData\n",
      "in");
  EXPECT_EQ(s.surface.vertex.get<int>("line_2"), (std::vector<int>{5, 6, 7}));
  EXPECT_EQ(s.find("line")->get<int>("tag"), std::vector<int>{7});
  read_stream(write_stream(s, false), "again");  // throws if it is not valid
}

TEST(Msh, OldVersionsAndDataOfSomeNodes) {
  const Stream one = read_any(
      "$NOD\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$ENDNOD\n$ELM\n2\n1 15 0 1 1 1\n2 2 4 1 3 1 2 3\n$ENDELM\n", "in");
  EXPECT_EQ(one.surface.face.get<int>("patch"), std::vector<int>{4});
  const std::string four =
      "$MeshFormat\n4 0 8\n$EndMeshFormat\n$Entities\n0 0 1 0\n7 0 0 0 1 1 0 1 3 0\n$EndEntities\n"
      "$Nodes\n1 3\n7 2 0 3\n1 0 0 0\n2 1 0 0\n5 0 1 0\n$EndNodes\n$Elements\n1 1\n7 2 2 1\n1 1 2 "
      "5\n$EndElements\n";
  const Stream s =
      read_any(four + "$NodeData\n1\n\"a b\"\n1\n0\n3\n0\n1\n3\n1 1\n2 2\n5 0.1\n$EndNodeData\n", "in");
  EXPECT_EQ(s.surface.face.get<int>("patch"), std::vector<int>{3});
  EXPECT_EQ(s.surface.vertex.get<double>("a%20b"), (std::vector<double>{1, 2, 0.1}));
  EXPECT_EQ(read_any(four + "$NodeData\n1\n\"a\"\n1\n0\n3\n0\n1\n1\n1 1\n$EndNodeData\n", "in").remarks,
            std::vector<std::string>{"left out: vertex data a, given for 1 of 3"});
}

TEST(Msh, ASurfaceInTwoPhysicalGroupsIsThereForEach) {
  // two triangles of entities 7, in groups 3 and 4, and 8, in none
  const Stream s = read_any(
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 2 0\n7 0 0 0 1 1 0 2 3 -4 0\n8 0 0 0 1 1 0 0 0\n"
      "$EndEntities\n$Nodes\n1 4 1 4\n2 7 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n$EndNodes\n"
      "$Elements\n2 2 1 2\n2 7 2 1\n1 1 2 3\n2 8 2 1\n2 2 4 3\n$EndElements\n"
      "$ElementData\n1\n\"a\"\n1\n0\n3\n0\n1\n2\n1 0.5\n2 0.7\n$EndElementData\n",
      "in");
  EXPECT_EQ(s.surface.tris, (std::vector<Tri>{{0, 1, 2}, {0, 1, 2}, {1, 3, 2}}));
  EXPECT_EQ(s.surface.face.get<int>("patch"), (std::vector<int>{3, 4, 12}));
  EXPECT_EQ(s.surface.face.get<double>("a"), (std::vector<double>{0.5, 0.5, 0.7}));
}

TEST(Vtk, CellsThatAreNoSurfaceAreLeftOutWithTheirData) {
  // a vertex, a line, a quad and a strip; cell data count them all
  const Stream s = read_any(
      "# vtk DataFile Version 4.2\r\n\r\nASCII\r\nDATASET POLYDATA\r\nPOINTS 4 float\r\n0 0 0 1 0 0\r\n1 1 0 "
      "0 1 0\r\n"
      "VERTICES 1 2\r\n1 0\r\nLINES 1 3\r\n2 0 1\r\nTRIANGLE_STRIPS 1 5\r\n4 0 1 3 2\r\nPOLYGONS 1 5\r\n4 0 "
      "1 2 3\r\n"
      "CELL_DATA 4\r\nSCALARS CellEntityIds int 1\r\nLOOKUP_TABLE default\r\n7 8 9 10\r\n",
      "in");
  EXPECT_EQ(s.surface.face.get<int>("patch"), (std::vector<int>{9, 9, 10, 10}));
  EXPECT_EQ(s.surface.tris[2], (Tri{0, 1, 3}));
  EXPECT_EQ(s.surface.tris[3], (Tri{3, 1, 2}));
  const std::string grid =
      "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 float\n0 0 0 1 0 0 1 1 0\n";
  EXPECT_EQ(failure(grid + "CELLS 1 4\n3 0 1 3\nCELL_TYPES 1\n5\n"),
            "in:7: cell 0 uses point 3, but there are 3");
  EXPECT_EQ(failure(grid + "CELLS 1 4\n3 0 1 2\n"), "in:8: 0 cell types, but 1 cells");
  EXPECT_EQ(failure(grid + "CELLS 999999999 4\n3 0 1 2\n"), "in:7: 999999999 cells, but only 4 numbers");
  EXPECT_PRED1(names_a_place, failure(grid + "CELLS 1 2000000000\n3 0 1 2\n"));
  EXPECT_PRED1(names_a_place,
               failure("<VTKFile type=\"PolyData\">\n<PolyData>\n<Piece NumberOfPoints=\"99999999999\">"));
}

TEST(Formats, EveryReaderSurvivesDamage) {
  std::vector<std::string> files = {
      tagged_msh, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
      std::string("solid a\n") + facet + "endsolid a\n",
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng a\nf 1 2 3\ng b\nf 1/2/3 2//4 -1 -2\n"};
  for (const Writer& w : writers())
    for (bool ascii : {true, false})
      files.push_back(w.write(two_patches(), ascii));  // read or refused, all of them
  for (const fs::path& path : examples("passed"))
    for (bool ascii : {true, false}) files.push_back(write_stream(read_stream(contents(path), "in"), ascii));
  const char replacements[] = {'\0', '-', '9', '\n', ' ', '\xff', '#', 'e'};
  for (const std::string& file : files) {
    for (std::size_t i = 0; i < file.size(); ++i) {
      const std::string cut = failure(file.substr(0, i));
      EXPECT_TRUE(cut.empty() || names_a_place(cut)) << cut;
      std::string changed = file;
      changed[i] = replacements[i % sizeof replacements];
      const std::string why = failure(changed);
      EXPECT_TRUE(why.empty() || names_a_place(why)) << why;
    }
  }
}
