// SPDX-License-Identifier: BSD-3-Clause
// Every mesh format by one door: sniffed on input, chosen by the file's extension on output.
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/stream.h"

namespace meshpipe {

/// Reads any known format, the stream included. Foreign meshes come as they are in the file (only STL, which
/// does not number its vertices, is welded), polygons triangulated, with face column `patch` and its names.
/// Throws BadInput with place and both numbers.
Stream read_any(std::string_view bytes, const std::string& where);

/// ".stl" of "a/part.STL": the last dot of the file's name and what follows, in lower case; empty without a
/// dot.
std::string extension_of(const std::string& path);

/// The mesh in the format of the extension of `path` (".stl", ".vtu", ...; ".mply" is the stream).
/// `ascii` asks for text where the format has both. Throws like writer_of.
std::string write_as(const Stream& stream, const std::string& path, bool ascii);

/// A reader knows its format by its first bytes (`matches`) and reads the whole.
struct Reader {
  const char* format;
  bool (*matches)(std::string_view bytes);
  Stream (*read)(std::string_view bytes, const std::string& where);
};
const std::vector<Reader>& readers();

/// A writer by extension.
struct Writer {
  const char* extension;
  std::string (*write)(const Stream& stream, bool ascii);
};
const std::vector<Writer>& writers();
/// The writer of the extension of `path`; throws BadUsage naming the known ones for an unknown extension.
const Writer& writer_of(const std::string& path);

}  // namespace meshpipe
