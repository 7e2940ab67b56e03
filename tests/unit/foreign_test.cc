// SPDX-License-Identifier: BSD-3-Clause
// What files of other programs hold beside flat triangles: curved elements, lines, colours, odd sizes.
#include <gtest/gtest.h>

#include <cstring>

#include "formats/formats.h"
#include "formats/inria.h"
#include "lib/error.h"

using namespace meshpipe;

static std::string failure(std::string_view bytes) {
  try {
    read_any(bytes, "in");
    return "";
  } catch (const BadInput& e) {
    return e.what();
  }
}

static double area(const Stream& s) { return total_area(s.surface); }

//  3---6---2    a triangle of six nodes 0 1 2 | 4 5 7 (7 is above the plane) and, in the other half,
//  |     / |    one of three
//  8   7   5
//  | /     |
//  0---4---1
static const char* const nodes =
    "$Nodes\n9\n1 0 0 0\n2 2 0 0\n3 2 2 0\n4 0 2 0\n5 1 0 0\n6 2 1 0\n7 1 2 0\n8 1 1 1\n9 0 1 0\n$EndNodes\n";
static std::string msh(const std::string& elements) {
  return std::string("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n") + nodes + "$Elements\n" + elements +
         "$EndElements\n";
}

TEST(Curved, SecondOrderElementsAreFlatBetweenTheirNodes) {
  const Stream s = read_any(msh("2\n1 9 2 3 1 1 2 3 5 6 8\n7 2 2 4 1 1 3 4\n") +
                                "$ElementData\n1\n\"d\"\n1\n0\n3\n0\n1\n2\n7 0.5\n1 0.25\n$EndElementData\n",
                            "in");
  EXPECT_EQ(s.surface.tris, (std::vector<Tri>{{0, 4, 7}, {4, 1, 5}, {7, 5, 2}, {4, 5, 7}, {0, 2, 3}}));
  EXPECT_EQ(s.surface.face.get<int>("patch"), (std::vector<int>{3, 3, 3, 3, 4}));
  EXPECT_EQ(s.surface.face.get<double>("d"), (std::vector<double>{0.25, 0.25, 0.25, 0.25, 0.5}));
  EXPECT_EQ(s.remarks,
            std::vector<std::string>{"read flat between their nodes: 1 curved elements of second order"});
}

TEST(Curved, QuadsOfAllKinds) {
  // flat, so that the area tells: 8 and 9 nodes, and one of third order by its corners
  for (const char* quad : {"16 2 1 1 1 2 3 4 5 6 7 9", "10 2 1 1 1 2 3 4 5 6 7 9 8",
                           "36 2 1 1 1 2 3 4 5 5 6 6 7 7 9 9 8 8 8 8"}) {
    std::string bytes = msh(std::string("1\n1 ") + quad + "\n");
    bytes.replace(bytes.find("8 1 1 1"), 7, "8 1 1 0");
    EXPECT_DOUBLE_EQ(area(read_any(bytes, "in")), 4) << quad;
  }
  EXPECT_EQ(failure(msh("1\n1 9 2 1 1 1 2 3 5 6\n")), "in:18: the line ends where a node number is due");
}

TEST(Curved, VtkHasTheSameKinds) {
  const std::string head =
      "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 9 float\n0 0 0 2 0 0 2 2 0 0 "
      "2 0 1 0 0 2 1 0 "
      "1 2 0 1 1 0 0 1 0\n";
  auto cell = [&](int type, const std::string& points, int n) {
    return head + "CELLS 1 " + std::to_string(n + 1) + "\n" + std::to_string(n) + ' ' + points +
           "\nCELL_TYPES 1\n" + std::to_string(type) + "\n";
  };
  EXPECT_DOUBLE_EQ(area(read_any(cell(22, "0 1 2 4 5 7", 6), "in")), 2);
  EXPECT_DOUBLE_EQ(area(read_any(cell(69, "0 1 2 4 5 7", 6), "in")), 2);
  EXPECT_DOUBLE_EQ(area(read_any(cell(23, "0 1 2 3 4 5 6 8", 8), "in")), 4);
  EXPECT_DOUBLE_EQ(area(read_any(cell(28, "0 1 2 3 4 5 6 8 7", 9), "in")), 4);
  EXPECT_DOUBLE_EQ(area(read_any(cell(70, "0 1 2 3 4 5 6 8 7", 9), "in")), 4);
  EXPECT_EQ(failure(cell(77, "0 1 2 3 4 5 6 8 7", 9)),
            "in:7: cell 0 is of type 77, a kind of curved cells that is not read");
}

//  3---2   5---4
//  | 1/|   | 3/|
//  |/0 |   |/2 |
//  0---1   6---7
static Stream squares() {
  Stream s;
  s.surface.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.1}, {0, 1, 0},
                      {3, 1, 0}, {2, 1, 0}, {2, 0, 0},   {3, 0, 0}};
  s.surface.tris = {{0, 1, 2}, {0, 2, 3}, {6, 7, 4}, {6, 4, 5}};
  s.surface.vertex.rows = 8;
  s.surface.face.set<int>("patch", {3, 3, 8, 8});
  return s;
}

TEST(Lines, OfMshKeepTheirLabelsAndNames) {
  const std::string bytes =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 7 \"say %22rim%22\"\n$EndPhysicalNames\n" +
      std::string(nodes) + "$Elements\n6\n1 2 2 3 1 1 2 3\n2 2 2 3 1 1 3 4\n3 1 2 7 1 2 3\n4 1 2 7 1 3 1\n" +
      "5 1 2 0 4 3 4\n6 1 2 7 1 2 4\n$EndElements\n";
  const Stream s = read_any(bytes, "in");
  EXPECT_EQ(s.name_of(1, 7), "say \"rim\"");
  EXPECT_EQ(s.surface.face.get<std::uint8_t>("model"), (std::vector<std::uint8_t>{6, 3}));
  const Table& line = *s.find("line");
  EXPECT_EQ(line.get<int>("tag"), (std::vector<int>{7, 7 + 4}));
  EXPECT_EQ(line.get<int>("count"), (std::vector<int>{3, 2}));
  EXPECT_EQ(s.find("line_vertex")->get<int>("vertex_b"), (std::vector<int>{1, 2, 0, 2, 3}));
  EXPECT_EQ(s.remarks, std::vector<std::string>{"left out: 1 line elements that are no edge of a triangle"});
  for (const char* path : {"a.msh", "a.msh4"})
    for (bool ascii : {true, false}) {
      Stream back = read_any(write_as(s, path, ascii), path);
      EXPECT_TRUE(back.remarks.empty());
      back.remarks = s.remarks;
      EXPECT_EQ(write_stream(back, true), write_stream(s, true)) << path << ascii;
    }
}

TEST(Lines, OfInriaKeepReferencesRidgesAndWhatIsRequired) {
  const std::string mesh =
      "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n1 1 0 0\n0 1 0 0\nTriangles\n2\n1 "
      "2 3 9\n1 3 "
      "4 9\nEdges\n5\n1 2 5\n2 3 5\n3 4 0\n4 1 -2\n1 3 5\nRidges\n3\n1\n2\n5\nRequiredEdges\n2\n3\n5\nEnd\n";
  const Stream s = read_any(mesh, "in");
  const Table& line = *s.find("line");
  EXPECT_EQ(line.get<int>("tag"), (std::vector<int>{5, 0, -2, 5}));
  EXPECT_EQ(line.get<int>("ridge"), (std::vector<int>{1, 0, 0, 1}));
  EXPECT_EQ(line.get<int>("required"), (std::vector<int>{0, 1, 0, 1}));
  for (const char* path : {"a.mesh", "a.meshb"})
    EXPECT_EQ(write_stream(read_any(write_as(s, path, true), path), true), write_stream(s, true)) << path;
  EXPECT_EQ(
      failure(
          "MeshVersionFormatted 2\nDimension 3\nVertices\n3\n0 0 0 0\n1 0 0 0\n1 1 0 0\nTriangles\n1\n1 2 3 "
          "9\nRidges\n1\n1\nEnd\n"),
      "in:14: ridge 1, but there are 0 edges");
}

TEST(Lines, OfARemeshedSurfaceAreToldByItsVertices) {
  Stream s = squares();
  s.surface.face.set<std::uint8_t>("model", {4, 1, 0, 0});
  s.surface.vertex.set<int>("line", {0, -1, 1, -1, -1, -1, -1, -1});
  s.surface.vertex.set<int>("kind", {2, 0, 1, 0, 0, 0, 0, 0});
  Table line{"line", 0, {}}, reference{"ref_vertex", 0, {}};
  for (const char* column : {"kind", "first", "count", "closed"}) line.set<int>(column, {1, 1});
  line.set<int>("tag", {4, 6});
  reference.set<double>("x", {0.0});
  s.tables = {line, reference};
  s.names = {{1, 6, "crease"}};
  const Stream back = read_any(write_as(s, "a.msh", false), "in");
  EXPECT_EQ(back.find("line")->get<int>("tag"), std::vector<int>{6});
  EXPECT_EQ(back.name_of(1, 6), "crease");
}

TEST(Colors, OfObjAndOffAreKept) {
  Stream s = squares();
  s.surface.vertex.set<std::uint8_t>("red", {0, 1, 2, 100, 127, 128, 254, 255});
  s.surface.vertex.set<std::uint8_t>("green", std::vector<std::uint8_t>(8, 7));
  s.surface.vertex.set<std::uint8_t>("blue", std::vector<std::uint8_t>(8, 200));
  for (const char* path : {"a.obj", "a.off"}) {
    const Stream back = read_any(write_as(s, path, true), path);
    for (const char* channel : {"red", "green", "blue"})
      EXPECT_EQ(back.surface.vertex.get<std::uint8_t>(channel), s.surface.vertex.get<std::uint8_t>(channel))
          << path;
  }
  const Stream faces =
      read_any("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 9\n3 2 1 0 0.5 1 0 1\n", "in");
  EXPECT_EQ(faces.surface.face.get<std::uint8_t>("red"), (std::vector<std::uint8_t>{255, 128}));
  EXPECT_EQ(write_as(faces, "a.off", true),
            "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 9\n3 2 1 0 128 255 0\n");
  // not all have one
  EXPECT_EQ(read_any("v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0 0 0 1\nf 1 2 3\n", "in").remarks,
            std::vector<std::string>{"left out: vertex data color, given for 2 of 3"});
}

template <class T>
static void put_big(std::string& out, T value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  std::reverse(bytes, bytes + sizeof value);
  out.append(bytes, sizeof value);
}

TEST(Off, Binary) {
  std::string bytes = "COFF BINARY\n";
  for (int n : {3, 1, 0}) put_big(bytes, n);
  for (int v = 0; v < 3; ++v)
    for (float x : {v == 1 ? 2.5f : 0.f, v == 2 ? 1.f : 0.f, 0.f, 1.f, 0.5f, 0.f, 1.f}) put_big(bytes, x);
  for (int n : {3, 0, 1, 2, 0}) put_big(bytes, n);
  const Stream s = read_any(bytes, "in");
  EXPECT_EQ(s.surface.points[1], (Vec3{2.5, 0, 0}));
  EXPECT_EQ(s.surface.tris, (std::vector<Tri>{{0, 1, 2}}));
  EXPECT_EQ(s.surface.vertex.get<std::uint8_t>("green"), (std::vector<std::uint8_t>{128, 128, 128}));
  for (std::size_t n = 12; n < bytes.size(); ++n) {
    if (n == 84) continue;  // an empty STL, as it happens
    EXPECT_NE(failure(bytes.substr(0, n)), "") << n;
  }
}

TEST(Stl, SizesThatDisagreeWithTheCount) {
  const std::string good = write_as(squares(), "a.stl", false);
  auto declare = [&](std::string bytes, std::uint32_t n) {
    std::memcpy(&bytes[80], &n, 4);
    return bytes;
  };
  // writers that stream do not know the count; others pad
  for (std::uint32_t n : {0u, 0xFFFFFFFFu}) {
    const Stream s = read_any(declare(good, n), "in");
    EXPECT_EQ(s.surface.tris.size(), 4u);
    EXPECT_EQ(s.remarks.size(), 1u);
  }
  EXPECT_EQ(read_any(good + std::string(20, '\0'), "in").surface.tris.size(), 4u);
  EXPECT_EQ(read_any(declare(good, 3), "in").remarks,
            std::vector<std::string>{
                "the binary stl declares 3 triangles and has room for 4: what follows is left out"});
  EXPECT_EQ(failure(declare(good, 5)),
            "in:1: none of the known formats (stl, mply, ply, msh, off, vtu/vtp, vtk, mesh, "
            "obj); as a binary stl of 5 triangles it would have 334 bytes, but it has 284");
}

TEST(Sol, BinaryAndTextAreTheSame) {
  Stream s = squares();
  s.surface.vertex.set<double>("size", {1, 2, 3, 4, 5, 6, 7, 0.1});
  for (const char* path : {"a.sol", "a.solb"}) {
    Stream back = squares();
    read_sol(back, write_as(s, path, true), path);
    EXPECT_EQ(back.surface.vertex.get<double>("size"), s.surface.vertex.get<double>("size")) << path;
  }
}

TEST(Msh, NumbersMayBeBeyondInt) {
  std::string bytes = msh("1\n123456789012 2 2 3 1 1 2 5000000000\n");
  bytes.replace(bytes.find("\n3 2 2 0"), 3, "\n5000000000 ");
  EXPECT_EQ(read_any(bytes, "in").surface.tris, (std::vector<Tri>{{0, 1, 2}}));
}
