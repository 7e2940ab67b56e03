// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "formats/foreign/polygons.h"
#include "formats/formats.h"
#include "formats/stream/model_edges.h"

namespace meshpipe {
namespace {

bool among(const std::string& name, std::initializer_list<const char*> words) {
  return std::find(words.begin(), words.end(), name) != words.end();
}

/// Returns the names in quotes of the columns that are the user's and not held. The columns of a remeshed
/// surface include its sizes.
std::string lost_columns(const Table& table, bool vertices, bool remeshed, unsigned held) {
  std::string words;
  for (const Column& c : table.columns) {
    const bool internal =
        vertices ? among(c.name, {"ref_face", "b1", "b2", "kind", "line"}) || (remeshed && c.name == "size")
                 : among(c.name, {"patch", "part", "origin", "model"});
    const bool colored =
        (held & (vertices ? holds::colors : holds::face_colors)) && among(c.name, {"red", "green", "blue"});
    const bool marked =
        (held & holds::marks) && (c.name == "required" || (vertices && among(c.name, {"ref", "corner"})));
    if (!internal && !colored && !marked) words.append(" '").append(c.name).append("'");
  }
  return words;
}

std::string count_of(std::size_t n, const std::string& one, const std::string& many) {
  return std::to_string(n) + ' ' + (n == 1 ? one : many);
}

std::string lost_patches(const Stream& stream, unsigned held) {
  const std::vector<int> tags = by_patch(stream).tags;
  if (tags.size() < 2) return "";
  if (!(held & holds::patches)) return "the division into " + std::to_string(tags.size()) + " patches";
  bool in_order = true;
  for (std::size_t i = 0; i < tags.size(); ++i) in_order = in_order && tags[i] == static_cast<int>(i) + 1;
  if (in_order || (held & holds::labels)) return "";
  return "the numbers of " + std::to_string(tags.size()) + " patches";
}

std::string lost_names(const Stream& stream, int dim, const char* one, const char* many) {
  const auto n = std::count_if(stream.names.begin(), stream.names.end(),
                               [&](const Name& name) { return name.dim == dim; });
  return n ? count_of(static_cast<std::size_t>(n), one, many) : "";
}

std::string lost_lines(const Stream& stream) {
  std::vector<int> tags = read_model_edges(stream).tag;
  if (const Table* table = stream.find("line"); table && table->has("tag")) tags = table->get<int>("tag");
  std::erase(tags, 0);
  std::sort(tags.begin(), tags.end());
  const auto n = std::unique(tags.begin(), tags.end()) - tags.begin();
  return n ? count_of(static_cast<std::size_t>(n), "labeled line", "labeled lines") : "";
}

std::string lost_nodes(const Stream& stream) {
  const Table* middle = stream.find("mid_vertex");
  return middle ? count_of(middle->rows, "node within an edge", "nodes within edges") + " (second order)"
                : "";
}

}  // namespace

std::string lost_in(const Stream& stream, const std::string& path, bool ascii) {
  if (extension_of(path).empty()) return "";  // the stream
  const Writer& writer = writer_of(path);
  const unsigned held = ascii ? writer.holds : writer.holds & ~writer.only_as_text;
  if (held == holds::all) return "";
  std::string lost;
  auto add = [&](const std::string& words) {
    if (!words.empty()) lost.append(lost.empty() ? "" : ", ").append(words);
  };
  add(lost_patches(stream, held));
  if (!(held & holds::names)) add(lost_names(stream, 2, "name of a patch", "names of patches"));
  if (!(held & holds::lines)) add(lost_lines(stream));
  if (!(held & holds::line_names)) add(lost_names(stream, 1, "name of a line", "names of lines"));
  if (!(held & holds::nodes)) add(lost_nodes(stream));
  if (held & holds::data) return lost;
  const bool remeshed = stream.find("ref_vertex") != nullptr;
  if (const std::string names = lost_columns(stream.surface.vertex, true, remeshed, held); !names.empty())
    add("vertex data" + names);
  if (const std::string names = lost_columns(stream.surface.face, false, remeshed, held); !names.empty())
    add("face data" + names);
  return lost;
}

}  // namespace meshpipe
