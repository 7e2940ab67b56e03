// SPDX-License-Identifier: BSD-3-Clause
#include "formats/formats.h"

#include <cstring>

#include "formats/abaqus.h"
#include "formats/gts.h"
#include "formats/inria.h"
#include "formats/msh.h"
#include "formats/nastran.h"
#include "formats/obj.h"
#include "formats/off.h"
#include "formats/ply.h"
#include "formats/stl.h"
#include "formats/tetgen.h"
#include "formats/text.h"
#include "formats/vtk_legacy.h"
#include "formats/vtk_xml.h"
#include "lib/error.h"

namespace meshpipe {
namespace {

/// What can be told of bytes that match no format.
std::string guess(std::string_view bytes) {
  if (bytes.starts_with("\x1f\x8b")) return "; it is compressed: gzip -dc gives the file";
  if (std::string size = binary_stl_mismatch(bytes); !size.empty()) return "; " + size;
  return "";
}

}  // namespace

const std::vector<Reader>& readers() {
  // binary STL comes first: its size tells it, and its first bytes may be anything
  static const std::vector<Reader> all = {
      {"stl", is_stl, read_stl},
      {"mply", is_stream, read_stream},
      {"ply", is_ply, read_ply},
      {"msh", is_msh, read_msh},
      {"off", is_off, read_off},
      {"vtu/vtp", is_vtk_xml, read_vtk_xml},
      {"vtk", is_vtk_legacy, read_vtk_legacy},
      {"mesh", is_inria, read_inria},
      {"obj", is_obj, read_obj},
      {"stl", is_odd_stl, read_stl},
  };
  return all;
}

const std::vector<Writer>& writers() {
  static const std::vector<Writer> all = {
      {".mply", write_stream}, {".ply", write_ply},     {".stl", write_stl},      {".obj", write_obj},
      {".off", write_off},     {".msh", write_msh2},    {".msh2", write_msh2},    {".msh4", write_msh4},
      {".vtu", write_vtu},     {".vtp", write_vtp},     {".vtk", write_vtk_grid}, {".mesh", write_mesh},
      {".meshb", write_meshb}, {".sol", write_sol},     {".solb", write_solb},    {".gts", write_gts},
      {".bdf", write_nastran}, {".nas", write_nastran}, {".inp", write_abaqus},   {".poly", write_poly},
  };
  return all;
}

Stream read_any(std::string_view bytes, const std::string& where) {
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);  // byte-order mark of UTF-8
  for (const Reader& r : readers())
    if (r.matches(bytes)) return r.read(bytes, where);
  std::string known;
  for (const Reader& r : readers())
    if (r.matches != is_odd_stl) known += std::string(known.empty() ? "" : ", ") + r.format;
  throw BadInput(where + ":1: none of the known formats (" + known + ")" + guess(bytes));
}

std::string extension_of(const std::string& path) {
  const std::size_t dot = path.find_last_of("./");
  std::string extension = dot == std::string::npos || path[dot] == '/' ? "" : path.substr(dot);
  for (char& c : extension)
    if ('A' <= c && c <= 'Z') c += 'a' - 'A';
  return extension;
}

const Writer& writer_of(const std::string& path) {
  const std::string extension = extension_of(path);
  std::string known;
  for (const Writer& w : writers()) {
    if (extension == w.extension) return w;
    known += std::string(known.empty() ? "" : " ") + w.extension;
  }
  throw BadUsage("'" + path + "' has extension '" + extension + "'; known are " + known);
}

std::string write_as(const Stream& stream, const std::string& path, bool ascii) {
  return writer_of(path).write(stream, ascii);
}

}  // namespace meshpipe
