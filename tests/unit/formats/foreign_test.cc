// SPDX-License-Identifier: BSD-3-Clause
// Data in files of other programs in addition to flat triangles: curved elements, lines, colors, odd sizes.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>

#include "formats/foreign/columns.h"
#include "formats/foreign/feature_edges.h"
#include "formats/foreign/inria.h"
#include "formats/foreign/numbers.h"
#include "formats/foreign/stl.h"
#include "formats/formats.h"
#include "formats/stream/model_edges.h"
#include "formats/text.h"
#include "lib/core/error.h"
#include "tests/unit/formats/failure.h"

using namespace meshpipe;

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

TEST(Curved, EdgesWithinElementsAreNoModelEdges) {
  const Stream s = read_any(msh("2\n1 9 2 3 1 1 2 3 5 6 8\n7 2 2 4 1 1 3 4\n") +
                                "$ElementData\n1\n\"model\"\n1\n0\n3\n0\n1\n2\n1 3\n7 1\n$EndElementData\n",
                            "in");
  // edges 0 and 1 of the element, each of them now two
  EXPECT_EQ(s.surface.face.get<std::uint8_t>("model"), (std::vector<std::uint8_t>{1, 3, 2, 0, 1}));
}

TEST(Curved, QuadsOfAllKinds) {
  // flat, so that the area shows it: 8 and 9 nodes, and one of third order by its corners
  for (const char* quad : {"16 2 1 1 1 2 3 4 5 6 7 9", "10 2 1 1 1 2 3 4 5 6 7 9 8",
                           "36 2 1 1 1 2 3 4 5 5 6 6 7 7 9 9 8 8 8 8"}) {
    std::string bytes = msh(std::string("1\n1 ") + quad + "\n");
    bytes.replace(bytes.find("8 1 1 1"), 7, "8 1 1 0");
    EXPECT_DOUBLE_EQ(area(read_any(bytes, "in")), 4) << quad;
  }
  EXPECT_EQ(failure(msh("1\n1 9 2 1 1 1 2 3 5 6\n")),
            "in:18: expected a node number, found the end of the line");
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

//      4--------7
//     /|       /|     on the cube 0 ... 7 there is a pyramid with apex 8 = (1, 1, 4), and at its right face
//    5--------6 |     a prism up to the edge from 9 = (4, 0, 1) to 10 = (4, 2, 1); the tetrahedron 11 ... 14
//    | 0------|-3     is far away
//    |/       |/
//    1--------2
static const char* const solid =
    "0 0 0  2 0 0  2 2 0  0 2 0  0 0 2  2 0 2  2 2 2  0 2 2  1 1 4  4 0 1  4 2 1  9 0 0  9 1 0  9 0 1  8 0 0";
static std::string vtk_cells(const std::string& cells, const std::string& types,
                             const std::string& data = "") {
  const long n = std::count(types.begin(), types.end(), ' ') + 1;
  return "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 15 float\n" +
         std::string(solid) + "\nCELLS " + std::to_string(n) + " " +
         std::to_string(std::count(cells.begin(), cells.end(), ' ') + 1) + "\n" + cells + "\nCELL_TYPES " +
         std::to_string(n) + "\n" + types + "\n" + data;
}
static double volume(const Mesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.tris)
    sum += dot(mesh.points[a], cross(mesh.points[b], mesh.points[c])) / 6;
  return sum;
}

TEST(Vtk, LabelsThatAreNotWholeAreDataAndSaidToBe) {
  const std::string data = "CELL_DATA 2\nSCALARS patch double 1\nLOOKUP_TABLE default\n1.5 2.5\n";
  const Stream s = read_any(vtk_cells("3 0 1 2 3 0 2 3", "5 5", data), "in");
  EXPECT_EQ(s.surface.face.get<double>("patch_2"), (std::vector<double>{1.5, 2.5}));
  EXPECT_EQ(s.remarks, std::vector<std::string>{
                           "left out: face data patch, as labels, which are whole numbers of 32 bits"});
}

TEST(Volumes, TheirOuterFacesAreTheSurfaceWhereThereIsNone) {
  const std::string cells = "8 0 1 2 3 4 5 6 7 5 4 5 6 7 8 6 1 9 5 2 10 6 4 11 13 12 14",
                    types = "12 14 13 10";
  const Stream s = read_any(
      vtk_cells(cells, types, "CELL_DATA 4\nSCALARS patch int 1\nLOOKUP_TABLE default\n1 2 3 4\n"), "in");
  EXPECT_EQ(s.surface.tris.size(), 2u * 4 + 4 + 2u * 2 + 2 + 4);  // 2 faces of the cube are inside
  EXPECT_NEAR(volume(s.surface), 8 + 8.0 / 3 + 4 + 1.0 / 6, 1e-6);
  const std::vector<int>& patch = s.surface.face.get<int>("patch");
  EXPECT_EQ(std::count(patch.begin(), patch.end(), 2), 4);
  EXPECT_EQ(std::count(patch.begin(), patch.end(), 4), 4);
  EXPECT_EQ(s.remarks, std::vector<std::string>{
                           "no faces, but 4 volume elements: their 16 outer faces are the surface"});
  // any face is the surface, before the volumes or after them
  for (const auto& [with, kinds] :
       {std::pair{cells + " 3 0 1 2", types + " 5"}, {"3 0 1 2 " + cells, "5 " + types}}) {
    const Stream face = read_any(vtk_cells(with, kinds), "in");
    EXPECT_EQ(face.surface.tris, (std::vector<Tri>{{0, 1, 2}}));
    EXPECT_TRUE(face.remarks.empty());
  }
  EXPECT_EQ(failure(vtk_cells("3 11 12 13", "10")), "in:7: cell 0 of type 10 has 3 points, expected 4");
}

// quadratic, collapsed, with nodes of their own, of a kind that is not read
TEST(Volumes, OfManyKinds) {
  auto faces = [](const std::string& cells, const std::string& types) {
    return read_any(vtk_cells(cells, types), "in").surface.tris.size();
  };
  EXPECT_EQ(faces("8 0 1 2 3 4 5 6 7", "12"), 12u);
  EXPECT_EQ(faces("8 0 1 3 2 4 5 7 6", "11"), 12u);
  EXPECT_EQ(faces("8 0 1 2 3 8 8 8 8", "12"), 6u);  // a pyramid
  EXPECT_EQ(faces("8 0 1 2 2 8 8 8 8 4 0 2 3 8", "12 10"), 6u);
  const Stream curved = read_any(vtk_cells("10 0 1 2 4 9 9 9 9 9 9", "24"), "in");
  EXPECT_EQ(curved.remarks.back(), "read by their corners alone: 1 curved elements of higher order");
  EXPECT_EQ(failure(vtk_cells("8 0 1 2 3 4 5 6 7 5 4 5 6 7 8", "12 42")),
            "in:7: cell 1 is a volume of type 42, a kind whose faces are not read, and there are no others");
  EXPECT_EQ(faces("5 4 5 6 7 8 3 0 1 2", "42 5"), 1u);
  // two cubes that touch, each with nodes of its own
  std::string points, cells;
  for (int cube = 0; cube < 2; ++cube) {
    for (int z : {cube, cube + 1})
      for (const char* p : {"0 0 ", "1 0 ", "1 1 ", "0 1 "}) points += p + std::to_string(z) + '\n';
    cells += "8 ";
    for (int v = 0; v < 8; ++v) cells += std::to_string(8 * cube + v) + ' ';
  }
  const Stream cubes =
      read_any("# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 16 float\n" + points +
                   "CELLS 2 18\n" + cells + "\nCELL_TYPES 2\n12 12\n",
               "in");
  EXPECT_EQ(cubes.surface.tris.size(), 20u);
  EXPECT_NEAR(volume(cubes.surface), 2, 1e-12);
}

TEST(Volumes, OfMshAndInria) {
  // two tetrahedra with the triangle 1 2 3 between them
  const std::string points = "1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 0 0 -1\n";
  auto gmsh = [&](const std::string& elements) {
    return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n" + points + "$EndNodes\n$Elements\n" +
           elements + "$EndElements\n";
  };
  const std::string two = "7 4 2 6 1 1 2 3 4\n8 4 2 7 1 1 3 2 5\n";
  const std::string data = "$ElementData\n1\n\"d\"\n1\n0\n3\n0\n1\n2\n8 0.5\n7 0.25\n$EndElementData\n";
  const Stream s = read_any(gmsh("2\n" + two) + data, "in");
  EXPECT_EQ(s.surface.face.get<int>("patch"), (std::vector<int>{6, 6, 6, 7, 7, 7}));
  EXPECT_EQ(s.surface.face.get<double>("d"), (std::vector<double>{0.25, 0.25, 0.25, 0.5, 0.5, 0.5}));
  EXPECT_NEAR(volume(s.surface), 1.0 / 3, 1e-12);
  EXPECT_EQ(read_any(gmsh("3\n" + two + "9 2 2 5 1 1 2 3\n"), "in").surface.face.get<int>("patch"),
            std::vector<int>{5});
  // in two groups, as Gmsh writes it; of a kind that is not known
  EXPECT_EQ(read_any(gmsh("3\n" + two + "9 4 2 8 1 1 3 2 5\n"), "in").surface.tris, s.surface.tris);
  EXPECT_EQ(failure(gmsh("3\n" + two + "9 118 2 8 1 1 3 2 5\n")),
            "in:16: elements of type 118 are not read, and there are no faces");
  const Stream v4 = read_any(
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 6 \"wall\"\n3 6 "
      "\"fluid\"\n$EndPhysicalNames\n"
      "$Entities\n0 0 0 1\n3 0 0 0 1 1 1 2 6 7 0\n$EndEntities\n"
      "$Nodes\n1 4 1 4\n3 3 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n$EndNodes\n"
      "$Elements\n1 1 1 1\n3 3 4 1\n7 1 2 3 4\n$EndElements\n",
      "in");
  EXPECT_EQ(v4.surface.face.get<int>("patch"), (std::vector<int>(4, 6)));
  ASSERT_EQ(v4.names.size(), 1u);
  EXPECT_EQ(v4.name_of(2, 6), "fluid");
  std::string inria =
      "MeshVersionFormatted 2\nDimension 3\nVertices 5\n0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 0 0 0 -1 0\n"
      "Tetrahedra 2\n1 2 3 4 6\n1 3 2 5 7\n";
  EXPECT_EQ(read_any(inria + "End\n", "in").surface.tris, s.surface.tris);
  EXPECT_EQ(read_any(inria + "End\n", "in").surface.face.get<int>("patch"), s.surface.face.get<int>("patch"));
  EXPECT_EQ(read_any(inria + "Triangles 1\n1 2 3 5\nEnd\n", "in").surface.tris.size(), 1u);
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

TEST(Lines, OfARemeshedSurfaceAreFoundByItsVertices) {
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
  // an edge without a label is a model edge all the same
  EXPECT_EQ(back.surface.face.get<std::uint8_t>("model"), s.surface.face.get<std::uint8_t>("model"));
}

TEST(Lines, OfARemeshedSurfaceBetweenCornersAreThoseOfTheFileThere) {
  Stream s = squares();
  s.surface.face.set<std::uint8_t>("model", {4, 1, 0, 0});
  s.surface.vertex.set<int>("line", std::vector<int>(8, 0));  // one of the lines that end there
  s.surface.vertex.set<int>("kind", std::vector<int>(8, 2));
  Table line{"line", 0, {}}, reference{"ref_vertex", 0, {}};
  for (const char* column : {"kind", "first", "count", "closed"}) line.set<int>(column, {1, 1});
  line.set<int>("tag", {5, 6});
  reference.set<double>("x", {0.0});
  s.tables = {line, reference};
  write_model_edges(s, segments_between(s.surface.points, {{0, 1, 5}, {0, 2, 6}, {1, 2, 7}}));
  std::vector<std::array<int, 3>> found;
  for (const LineEdge& e : model_lines(s)) found.push_back({std::min(e.a, e.b), std::max(e.a, e.b), e.tag});
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, (std::vector<std::array<int, 3>>{{0, 1, 5}, {0, 2, 6}, {1, 2, 7}}));
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
  EXPECT_EQ(read_any("COFF\n3 1 0\n0 0 0 1 0 0 1\n1 0 0 -nan 0 0 1\n0 1 0 0 0 1 1\n3 0 1 2\n", "in").remarks,
            std::vector<std::string>{"left out: vertex data color, given for 2 of 3"});
  // not all have one
  for (const char* second : {"", " nan nan nan", " 1 -NaN 0"})
    EXPECT_EQ(
        read_any(std::string("v 0 0 0 1 0 0\nv 1 0 0") + second + "\nv 0 1 0 0 0 1\nf 1 2 3\n", "in").remarks,
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

/// A little-endian file of n vertices (i, 0, 0) and faces 0 1 2 and 2 1 0.
static std::string little_endian_off(int n, bool numbers_of_colors) {
  std::string bytes = "OFF BINARY\n";
  auto append = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (int i : {n, 2, 0}) append(i);
  for (int v = 0; v < n; ++v)
    for (float x : {(float)v, 0.f, 0.f}) append(x);
  for (int first : {0, 2}) {
    for (int i : {3, first, 1, 2 - first}) append(i);
    if (numbers_of_colors) append(0);
  }
  return bytes;
}

TEST(Off, BinaryLittleEndian) {  // without numbers of colors: as PMP writes it
  for (const bool numbers_of_colors : {false, true})
    for (const int n : {3, 65536}) {  // 256, read big endian
      const Stream s = read_any(little_endian_off(n, numbers_of_colors), "in");
      ASSERT_EQ((int)s.surface.points.size(), n);
      EXPECT_EQ(s.surface.points[2], (Vec3{2, 0, 0}));
      EXPECT_EQ(s.surface.tris, (std::vector<Tri>{{0, 1, 2}, {2, 1, 0}}));
    }
  const std::string bytes = little_endian_off(3, false);
  EXPECT_EQ(failure(bytes.substr(0, bytes.size() - 1)),
            "in:87: the file ends early: expected 4 bytes, but only 3 are left");
  EXPECT_EQ(failure(bytes.substr(0, 50)), "in:23: 3 vertices and 2 faces, but only 27 bytes follow");
  EXPECT_EQ(failure(bytes + "????"), "in:91: 4 bytes follow the last of 2 faces");
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
                "the binary stl declares 3 triangles and has bytes for 4: what follows is left out"});
  EXPECT_EQ(failure(declare(good, 5)),
            "in:1: none of the known formats (stl, mply, ply, msh, off, vtu/vtp, vtk, mesh, "
            "obj); as a binary stl of 5 triangles it would have 334 bytes, but it has 284");
}

TEST(Obj, IsRecognizedAfterLinesOfOtherWords) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_EQ(
      read_any("# cow\n$ Contributed by somebody\n\n" + vertices + "f 1 2 3\n", "in").surface.tris.size(),
      1u);
  EXPECT_THROW(read_any("$ a list of words\ns 1\nf 1 2 3\nv and so on\n", "in"), BadInput);
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

TEST(Msh, NumbersMayBeAsFarApartAsThereAre) {
  Numbers numbers;
  const long long least = std::numeric_limits<long long>::min() + 1;
  numbers.add(least);
  EXPECT_EQ(numbers.finish(), 0);
  EXPECT_EQ(numbers.row(least), 0);
  for (long long other : {1LL, least - 1, std::numeric_limits<long long>::max()})
    EXPECT_EQ(numbers.row(other), -1);
}

TEST(Bounds, RepeatedSectionsOfMeshAreRefused) {
  const std::string head = "MeshVersionFormatted 2\nDimension 3\nVertices 3\n0 0 0 0\n1 0 0 0\n0 1 0 0\n";
  const std::string face = "Triangles 1\n1 2 3 1\n";
  EXPECT_EQ(failure(head + face), "");
  EXPECT_EQ(failure(head + face + "Corners\n0\nCorners\n0\n"), "in:11: a second section of corners");
  EXPECT_EQ(failure(head + face + face), "in:9: a second section of triangles");
}

TEST(Bounds, PropertiesOfPly) {
  std::string bytes = "ply\nformat ascii 1.0\nelement vertex 0\n";
  for (int i = 0; i < 1001; ++i) bytes += "property float p" + std::to_string(i) + '\n';
  EXPECT_EQ(failure(bytes), "in:1004: element 'vertex' has more than 1000 properties, which is the limit");
}

TEST(Bounds, WhatIsNoNumberIsNotNan) {
  auto ply = [](const std::string& value) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
           "property float q\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
           "0 0 0 1\n1 0 0 " +
           value + "\n0 1 0 2\n3 0 1 2\n";
  };
  for (const char* nan : {"nan", "-NaN", "+NAN", "nan(ind)", "-nan(0x8)"}) {
    const Stream s = read_any(ply(nan), "in");
    EXPECT_EQ(s.remarks, std::vector<std::string>{"left out: vertex data q, not finite in row 1"}) << nan;
  }
  for (const char* word : {"none", "n", "nano", "nan(", "N/A", "-"})
    EXPECT_EQ(failure(ply(word)), "in:12: expected a finite number, found '" + std::string(word) + "'");
}

TEST(Bounds, ColumnsOfOneName) {
  Stream stream;
  Table& table = stream.surface.vertex;
  for (int i = 0; i < 5002; ++i) add_columns(stream, table, 1, {"a", 1, std::vector<int>{i}});
  ASSERT_EQ(table.columns.size(), 5000u);
  EXPECT_EQ(table.columns[0].name, "a");
  EXPECT_EQ(table.columns[1].name, "a_2");
  EXPECT_EQ(table.columns[4999].name, "a_5000");
  EXPECT_EQ(stream.remarks, std::vector<std::string>{"left out: vertex data beyond 5000 columns"});
}

TEST(Bounds, NamesEndInAnyWay) {
  EXPECT_EQ(percent_decode("a%20"), "a ");
  EXPECT_EQ(percent_decode("a%2"), "a%2");
  EXPECT_EQ(percent_decode("%"), "%");
}

// As the files of VTK have them: a head of numbers of 32 bits, blocks, size, part, and the compressed ones.
static std::string packed(std::string bytes) {
  std::string out(compressBound(bytes.size()), '\0');
  uLongf length = out.size();
  compress(reinterpret_cast<Bytef*>(out.data()), &length, reinterpret_cast<const Bytef*>(bytes.data()),
           bytes.size());
  const std::uint32_t head[] = {1, static_cast<std::uint32_t>(bytes.size()), 0,
                                static_cast<std::uint32_t>(length)};
  return std::string(reinterpret_cast<const char*>(head), sizeof head) + out.substr(0, length);
}

static std::string packed_vtu(const std::string& field, const std::string& point_data, int uses = 1) {
  std::string noise;  // that cannot be compressed
  for (std::uint32_t x = 1; noise.size() < 2700; x = x * 1664525 + 1013904223)
    noise += static_cast<char>(x >> 24);
  std::string data;
  auto array = [&](const std::string& type, const std::string& name, const std::string& more,
                   const std::string& bytes) {
    const std::string at = std::to_string(data.size());
    data += packed(bytes);
    return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" " + more +
           " format=\"appended\" offset=\"" + at + "\"/>";
  };
  auto bytes_of = [](auto... v) {
    const std::common_type_t<decltype(v)...> all[] = {v...};
    return std::string(reinterpret_cast<const char*>(all), sizeof all);
  };
  const std::string zeros = array("UInt8", "zeros", "", std::string(1000000, '\0'));
  std::string out =
      "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\" compressor=\"vtkZLibDataCompressor\">"
      "<UnstructuredGrid><FieldData>";
  if (field == "zeros")
    for (int i = 0; i < 60; ++i) out += zeros;
  out += array("Int32", "wall", "", bytes_of(7, 2));
  out +=
      "</FieldData><Piece NumberOfPoints=\"3\" NumberOfCells=\"1\"><Points>" +
      array("Float64", "Points", "NumberOfComponents=\"3\"", bytes_of(0., 0., 0., 1., 0., 0., 0., 1., 0.)) +
      "</Points><PointData>" + (point_data == "zeros" ? zeros : "");
  if (point_data == "shared")
    for (const std::string one = array("UInt8", "d", "NumberOfComponents=\"900\"", noise); uses-- > 0;)
      out += one;
  return out + "</PointData><CellData>" + array("Int32", "patch", "", bytes_of(7)) + "</CellData><Cells>" +
         array("Int32", "connectivity", "", bytes_of(0, 1, 2)) + array("Int32", "offsets", "", bytes_of(3)) +
         array("Int32", "types", "", bytes_of(5)) +
         "</Cells></Piece></UnstructuredGrid><AppendedData encoding=\"raw\">_" + data +
         "</AppendedData></VTKFile>";
}

TEST(Bounds, CompressedArraysOfVtk) {
  const Stream s = read_any(packed_vtu("zeros", ""), "in");
  EXPECT_EQ(s.surface.tris.size(), 1u);
  EXPECT_EQ(s.name_of(2, 7), "wall");
  EXPECT_EQ(failure(packed_vtu("", "zeros")), "in:1: array 'zeros' has 1000000 bytes, expected at most 3");
  EXPECT_EQ(failure(packed_vtu("", "shared")), "");
  EXPECT_NE(failure(packed_vtu("", "shared", 20)).find("more compressed bytes than the file"),
            std::string::npos);
}

TEST(Bounds, SurfacesThatSinglePrecisionDoesNotHold) {
  //  3---2
  //  | / |   of edge 0.25, far from the origin
  //  0---1
  auto square = [](double x) {
    Surface s;
    s.points = {{x, x, 0}, {x + 0.25, x, 0}, {x + 0.25, x + 0.25, 0}, {x, x + 0.25, 0}};
    s.tris = {{0, 1, 2}, {0, 2, 3}};
    return s;
  };
  EXPECT_EQ(beyond_single_precision(square(0)), "");
  EXPECT_EQ(beyond_single_precision(square(1e5 + 0.1)), "");
  EXPECT_EQ(beyond_single_precision(square(1e7)),
            "3 vertices fall on others and 2 triangles become degenerate or change orientation");
  EXPECT_EQ(beyond_single_precision(square(1e39)), "a coordinate of 1e+39 is beyond it");
  // what lay at the same place before, or in a line, is not the doing of the format
  Surface flat = square(0.1);
  flat.points[3] = flat.points[0];
  EXPECT_EQ(beyond_single_precision(flat), "");
  // an unused vertex is not written
  Surface unused = square(0.1);
  unused.points.push_back({0.1 + 1e-12, 0.1, 0});
  EXPECT_EQ(beyond_single_precision(unused), "");
}

TEST(FeatureEdges, AreLinesWithTheirLabels) {
  const Stream s = read_any(
      "MeshVersionFormatted 2\nDimension 3\nVertices 4\n0 0 0 0\n1 0 0 0\n1 1 0 0\n0 1 0.5 0\n"
      "Triangles 2\n1 2 3 1\n1 3 4 1\nEdges 2\n3 4 7\n1 3 2\nEnd\n",
      "in");
  EXPECT_EQ(write_feature_edges(s, "a.obj"),
            "v 0 0 0\nv 1 1 0\nv 0 1 0.5\ng line_2\nl 1 2\ng line_7\nl 2 3\n");
  const std::string vtk = write_feature_edges(s, "a.vtk");
  EXPECT_NE(vtk.find("LINES 2 6\n2 0 1\n2 1 2\n"), std::string::npos) << vtk;
  EXPECT_NE(vtk.find("default\n2\n7\n"), std::string::npos) << vtk;
  EXPECT_NE(write_feature_edges(s, "a.eMesh")
                .find("3\n(\n(0 0 0)\n(1 1 0)\n(0 1 0.5)\n)\n\n2\n(\n(0 1)\n(1 2)\n)\n"),
            std::string::npos);
  for (const char* path : {"a.obj", "a.vtk"}) {
    const ModelSegments back = segments_of(read_any(write_feature_edges(s, path), "in"));
    ASSERT_EQ(back.tris.size(), 2u) << path;
    EXPECT_EQ(back.points[back.tris[1][1]], (Vec3{0, 1, 0.5})) << path;
    EXPECT_EQ(back.tag, extension_of(path) == ".vtk" ? (std::vector<int>{2, 7}) : (std::vector<int>{0, 0}));
  }
  EXPECT_THROW(write_feature_edges(s, "a.stl"), BadUsage);
  Stream plain = s;
  plain.tables.clear();
  plain.surface.face.erase("model");
  EXPECT_THROW(write_feature_edges(plain, "a.obj"), NotAdmissible);
}
