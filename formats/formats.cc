// SPDX-License-Identifier: BSD-3-Clause
#include "formats/formats.h"

#include <algorithm>

#include "formats/foreign/abaqus.h"
#include "formats/foreign/geo.h"
#include "formats/foreign/gts.h"
#include "formats/foreign/gzip.h"
#include "formats/foreign/inria.h"
#include "formats/foreign/msh.h"
#include "formats/foreign/nastran.h"
#include "formats/foreign/obj.h"
#include "formats/foreign/off.h"
#include "formats/foreign/ply.h"
#include "formats/foreign/stl.h"
#include "formats/foreign/tetgen.h"
#include "formats/foreign/vtk_legacy.h"
#include "formats/foreign/vtk_xml.h"
#include "formats/stream/region_tables.h"
#include "lib/core/error.h"

namespace meshpipe {

const std::vector<Reader>& readers() {
  // binary STL comes first: it is recognized by its size, and its first bytes may be anything
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
  using namespace holds;
  constexpr unsigned named = patches | labels | names, gmsh = named | lines | line_names | data | nodes,
                     medit = patches | labels | lines | marks;
  static const std::vector<Writer> all = {
      {".mply", write_stream, holds::all},
      {".ply", write_ply, named | data},
      {".stl", write_stl, patches | names, patches | names},
      {".obj", write_obj, patches | names | colors},
      {".off", write_off, colors | face_colors},
      {".msh", write_msh2, gmsh},
      {".msh2", write_msh2, gmsh},
      {".msh4", write_msh4, gmsh},
      {".vtu", write_vtu, named | data | nodes},
      {".vtp", write_vtp, named | data},
      {".vtk", write_vtk_grid, named | data},
      {".mesh", write_mesh, medit},
      {".meshb", write_meshb, medit},
      {".sol", write_sol, holds::all},  // holds sizes: nobody expects a mesh in it
      {".solb", write_solb, holds::all},
      {".gts", write_gts, 0},
      {".bdf", write_nastran, named},
      {".nas", write_nastran, named},
      {".inp", write_abaqus, patches | names},
      {".poly", write_poly, patches | labels},
      {".smesh", write_smesh, patches | labels},
      {".geo", write_geo,
       holds::all},  // volumes between the surfaces of a .msh file: nobody expects a mesh in it
  };
  return all;
}

Stream read_any(std::string_view bytes, const std::string& where) {
  if (is_gzip(bytes) && !is_stl(bytes)) {
    const std::string file = unzip(bytes, where);
    if (is_gzip(file)) throw BadInput(where + ":1: the gzip file holds another one");
    return read_any(file, where);
  }
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);  // byte-order mark of UTF-8
  auto has = [&](char c) { return bytes.find(c) != bytes.npos; };
  if (!has('\n') && has('\r') && !has('\0')) {  // lines end as on old Macintosh computers
    std::string text(bytes);
    std::replace(text.begin(), text.end(), '\r', '\n');
    return read_any(text, where);
  }
  for (const Reader& r : readers())
    if (r.matches(bytes)) return r.read(bytes, where);
  std::string known;
  for (const Reader& r : readers())
    if (r.matches != is_odd_stl) known += std::string(known.empty() ? "" : ", ") + r.format;
  const std::string size = binary_stl_mismatch(bytes);
  throw BadInput(where + ":1: none of the known formats (" + known + ")" + (size.empty() ? "" : "; " + size));
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
  const Writer& writer = writer_of(path);
  if (has_sheets(stream) && writer.write != static_cast<decltype(Writer::write)>(write_stream))
    return writer.write(with_sheets_joined(stream), ascii);
  return writer.write(stream, ascii);
}

}  // namespace meshpipe
