// SPDX-License-Identifier: BSD-3-Clause
// All mesh formats: recognized by their first bytes on input, chosen by the extension on output.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "formats/stream.h"

namespace meshpipe {

/// Reads any known format, the stream included, also compressed by gzip. `where`: the name of the file for
/// messages. Foreign meshes come as they are in the file, with polygons triangulated, face column `patch` and
/// names of patches; only STL, which does not number its vertices, is welded. Throws: BadInput with the place
/// in the file.
Stream read_any(std::string_view bytes, const std::string& where);

/// Returns the extension of a path in lower case, ".stl" for "a/part.STL"; "" if the name has no dot.
std::string extension_of(const std::string& path);

/// Returns the mesh in the format of the extension of `path` (".mply": the stream). `ascii` asks for text
/// where the format has both encodings. Throws: as writer_of.
std::string write_as(const Stream& stream, const std::string& path, bool ascii);

/// Lists for a message what of a stream the format of `path` cannot hold; "" if nothing is lost. Tables and
/// columns that only programs of the chain use do not count.
std::string lost_in(const Stream& stream, const std::string& path, bool ascii);

/// A reader of a format, which `matches` recognizes by its first bytes.
struct Reader {
  const char* format;
  bool (*matches)(std::string_view bytes);
  Stream (*read)(std::string_view bytes, const std::string& where);
};
const std::vector<Reader>& readers();

/// Parts of a stream, in addition to its triangles, that a format can hold.
namespace holds {
enum : unsigned {
  patches = 1,        ///< which triangles belong together
  labels = 2,         ///< the numbers of patches
  names = 4,          ///< the names of patches
  lines = 8,          ///< model edges with their labels
  line_names = 16,    ///< the names of lines
  data = 32,          ///< columns of vertices and faces
  colors = 64,        ///< columns red, green, blue of vertices
  face_colors = 128,  ///< columns red, green, blue of faces
  marks = 256,        ///< columns ref, corner, required, as Medit has them
  nodes = 512,        ///< nodes of triangles of second order
  all = 1023,
};
}

/// A writer by extension.
struct Writer {
  const char* extension;
  std::string (*write)(const Stream& stream, bool ascii);
  unsigned holds;
  unsigned only_as_text = 0;  ///< what of that the binary encoding does not hold
};
const std::vector<Writer>& writers();
/// Returns the writer for the extension of `path`. Throws: BadUsage naming the known extensions.
const Writer& writer_of(const std::string& path);

}  // namespace meshpipe
