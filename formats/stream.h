// SPDX-License-Identifier: BSD-3-Clause
// The stream that the programs speak: mply, a strict profile of PLY (formats/mply.md), in memory and in
// bytes.
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "lib/mesh.h"

namespace meshpipe {

/// The name of a patch (dim 2) or a line (dim 1) by its tag: the solid, group or physical name of the file it
/// came from.
struct Name {
  int dim, tag;
  std::string text;
};

/// One program that wrote the stream: its version and the options that change the result.
struct Provenance {
  std::string program, version, arguments;
};

struct Stream {
  Surface surface;            ///< elements vertex and face
  std::vector<Table> tables;  ///< the elements after face, in the stream's order
  std::vector<Name> names;
  std::vector<Provenance> history;   ///< in the order the programs ran
  std::vector<std::string> remarks;  ///< other comments, kept as they are
  int input_triangles = 0;           ///< after mclean; 0: not recorded
  int asked_triangles = 0;           ///< of the mesh to be; 0: the sizes say how many
  bool ascii = false;                ///< encoding it was read in, and is written in unless told otherwise

  const Table* find(std::string_view table) const;
  /// The table; throws NotAdmissible "no section 'chart_vertex'; run mparam first" if it is not there
  /// (`writer` = mparam).
  const Table& need(std::string_view table, std::string_view writer) const;
  /// Replaces the table of this name, or appends it.
  void set(Table table);
  void erase(std::string_view table);
  /// Name of a patch, or an empty string.
  std::string name_of(int dim, int tag) const;
};

/// True for a stream (a PLY with the line "comment mply"), and for the line a failed program leaves in its
/// place.
bool is_stream(std::string_view bytes);

/// Reads a stream and checks all that formats/mply.md says: header, types, counts, index ranges, finite
/// numbers, no trailing bytes. Throws BadInput with the line (ascii) or byte (binary): `where` is the file's
/// name for the message. If the bytes are "mply-failed PROGRAM STATUS", throws UpstreamFailed.
Stream read_stream(std::string_view bytes, const std::string& where);

/// The stream in bytes: ascii with shortest round-trip numbers, or binary little endian.
std::string write_stream(const Stream& stream, bool ascii);
/// The same bytes in pieces of about a megabyte, handed on as they are made.
using Sink = std::function<void(std::string_view)>;
void write_stream(const Stream& stream, bool ascii, const Sink& sink);

/// The program before this one in the pipe failed, and has said why.
struct UpstreamFailed {
  std::string program;
  int status;
};

}  // namespace meshpipe
