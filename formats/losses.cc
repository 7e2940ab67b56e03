// SPDX-License-Identifier: BSD-3-Clause
#include "formats/losses.h"

#include <algorithm>

#include "formats/formats.h"
#include "formats/model_edges.h"
#include "formats/polygons.h"

namespace meshpipe {
namespace {

enum Holds {
  patches = 1,  ///< which triangles belong together
  labels = 2,   ///< by which number
  names = 4,    ///< of patches
  lines = 8,    ///< with their labels
  line_names = 16,
  data = 32,    ///< of vertices and faces
  colors = 64,  ///< of vertices
  face_colors = 128,
  marks = 256,  ///< .mesh: ref, corner, required
  nodes = 512,  ///< of second order
};

struct Format {
  const char* extension;
  int holds;
};
constexpr Format formats[] = {
    {".ply", patches | labels | names | data},
    {".stl", patches | names},  // as text
    {".obj", patches | names | colors},
    {".off", colors | face_colors},
    {".msh", patches | labels | names | lines | line_names | data | nodes},
    {".msh2", patches | labels | names | lines | line_names | data | nodes},
    {".msh4", patches | labels | names | lines | line_names | data | nodes},
    {".vtu", patches | labels | names | data | nodes},
    {".vtp", patches | labels | names | data},
    {".vtk", patches | labels | names | data},
    {".mesh", patches | labels | lines | marks},
    {".meshb", patches | labels | lines | marks},
    {".gts", 0},
    {".bdf", patches | labels | names},
    {".nas", patches | labels | names},
    {".inp", patches | names},
    {".poly", patches | labels},
};

bool among(const std::string& name, std::initializer_list<const char*> words) {
  return std::find(words.begin(), words.end(), name) != words.end();
}

/// The columns that are the user's and not held, in quotes.
std::string lost_columns(const Table& table, bool vertices, bool remeshed, int holds) {
  std::string words;
  for (const Column& c : table.columns) {
    const bool internal =
        vertices ? among(c.name, {"ref_face", "b1", "b2", "kind", "line"}) || (remeshed && c.name == "size")
                 : among(c.name, {"patch", "part", "origin", "model"});
    const bool colored =
        (holds & (vertices ? colors : face_colors)) && among(c.name, {"red", "green", "blue"});
    const bool marked =
        (holds & marks) && (c.name == "required" || (vertices && among(c.name, {"ref", "corner"})));
    if (!internal && !colored && !marked) words.append(" '").append(c.name).append("'");
  }
  return words;
}

std::size_t distinct(std::vector<int> v) {
  std::sort(v.begin(), v.end());
  return static_cast<std::size_t>(std::unique(v.begin(), v.end()) - v.begin());
}

std::string count_of(std::size_t n, const std::string& one, const std::string& many) {
  return std::to_string(n) + ' ' + (n == 1 ? one : many);
}

}  // namespace

std::string lost_in(const Stream& stream, const std::string& path, bool ascii) {
  const std::string extension = extension_of(path);
  const auto* format = std::find_if(std::begin(formats), std::end(formats),
                                    [&](const Format& f) { return extension == f.extension; });
  if (format == std::end(formats)) return "";  // the stream; .sol, which is no mesh
  const int holds = extension == ".stl" && !ascii ? 0 : format->holds;

  std::string what;
  auto add = [&](const std::string& words) { what.append(what.empty() ? "" : ", ").append(words); };
  const std::vector<int> tags = by_patch(stream).tags;
  bool in_order = true;
  for (std::size_t i = 0; i < tags.size(); ++i) in_order = in_order && tags[i] == static_cast<int>(i) + 1;
  if (tags.size() > 1 && !(holds & patches))
    add("the division into " + std::to_string(tags.size()) + " patches");
  else if (tags.size() > 1 && !in_order && !(holds & labels))
    add("the numbers of " + std::to_string(tags.size()) + " patches");
  auto add_names = [&](int dim, const char* one, const char* many) {
    const auto n = static_cast<std::size_t>(std::count_if(stream.names.begin(), stream.names.end(),
                                                          [&](const Name& name) { return name.dim == dim; }));
    if (n) add(count_of(n, one, many));
  };
  if (!(holds & names)) add_names(2, "name of a patch", "names of patches");
  if (!(holds & lines)) {
    std::vector<int> of_lines = read_model_edges(stream).tag;
    if (const Table* table = stream.find("line"); table && table->has("tag"))
      of_lines = table->get<int>("tag");
    std::erase(of_lines, 0);
    if (!of_lines.empty()) add(count_of(distinct(of_lines), "labelled line", "labelled lines"));
  }
  if (!(holds & line_names)) add_names(1, "name of a line", "names of lines");
  if (const Table* middle = stream.find("mid_vertex"); middle && !(holds & nodes))
    add(count_of(middle->rows, "node within an edge", "nodes within edges") + " (second order)");
  const bool remeshed = stream.find("ref_vertex") != nullptr;
  if (!(holds & data)) {
    const std::string of_vertices = lost_columns(stream.surface.vertex, true, remeshed, holds),
                      of_faces = lost_columns(stream.surface.face, false, remeshed, holds);
    if (!of_vertices.empty()) add("vertex data" + of_vertices);
    if (!of_faces.empty()) add("face data" + of_faces);
  }
  return what;
}

}  // namespace meshpipe
