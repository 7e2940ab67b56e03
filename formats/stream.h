// SPDX-License-Identifier: BSD-3-Clause
// The stream that the programs exchange: mply, a strict profile of PLY (formats/mply.md).
#pragma once
#include <algorithm>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// The name of a patch (dim 2) or a line (dim 1): the solid, group or physical name in the input file.
struct Name {
  int dim, tag;
  std::string text;
};

/// A program that wrote the stream, with the options that change the result.
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
  int asked_triangles = 0;           ///< of the mesh to be made; 0: as the sizes ask
  int unit = 0;                      ///< coordinates and sizes are multiples of 2^unit
  bool ascii = false;                ///< encoding of the input, and by default of the output

  const Table* find(std::string_view table) const;
  /// Returns the table. Throws: NotAdmissible if it is missing; for `writer` mparam "no section
  /// 'chart_vertex'; run mparam first".
  const Table& need(std::string_view table, std::string_view writer) const;
  /// Replaces the table of this name, or appends it.
  void set(Table table);
  void erase(std::string_view table);
  /// Returns the name of a patch (dim 2) or line (dim 1), or "".
  std::string name_of(int dim, int tag) const;
};

/// Returns whether a column of this name holds coordinates, or lengths that msize gives.
bool is_length(std::string_view column);
/// Changes the unit of all lengths, exactly unless they vanish. Throws: NotAdmissible if one overflows.
void change_unit(Stream& stream, int unit);

/// Returns whether bytes are a stream (a PLY with the line "comment mply"), or the line that a failed program
/// leaves in its place.
bool is_stream(std::string_view bytes);

/// The bytes of a file in order, of which only some need to be in memory.
class Source {
 public:
  virtual ~Source() = default;
  /// Returns the bytes that come next: at least n, or all that are left. They stay valid until the next call.
  virtual std::string_view next(std::size_t n) = 0;
  virtual void drop(std::size_t n) = 0;
  /// Drops n bytes, or all that are left, without reading them all into memory.
  virtual void skip(std::size_t n) {
    for (std::size_t some; n > 0 && (some = std::min(n, next(1).size())) > 0; n -= some) drop(some);
  }
  /// Returns an upper bound of the number of bytes left.
  virtual std::size_t most_left() const = 0;
};

/// Bytes that are in memory.
struct MemorySource : Source {
  std::string_view left;
  explicit MemorySource(std::string_view bytes) : left(bytes) {}
  std::string_view next(std::size_t) override { return left; }
  void drop(std::size_t n) override { left.remove_prefix(n); }
  std::size_t most_left() const override { return left.size(); }
};

/// Returns whether a column of a table is to be read; column x of `vertex` stands for the points, and
/// vertex_indices of `face` for the triangles. Empty: all columns are.
using Wanted = std::function<bool(std::string_view table, std::string_view column)>;

/// Reads a stream and checks it as formats/mply.md specifies. `where`: the name of the file for messages.
/// After it nothing may follow, or with `several`, as in a shard, another stream. Columns that are not
/// `wanted` are left out, and not checked.
/// Throws: BadInput with the line (ascii) or byte (binary); UpstreamFailed for "mply-failed PROGRAM STATUS".
Stream read_stream(Source& source, const std::string& where, bool several = false, const Wanted& wanted = {});
Stream read_stream(std::string_view bytes, const std::string& where);

/// Returns the stream as bytes: ascii with the shortest numbers that read back the same, or binary.
std::string write_stream(const Stream& stream, bool ascii);
/// Takes the bytes of a file piece by piece.
using Sink = std::function<void(std::string_view)>;
/// Passes the same bytes to `sink` in pieces of about a megabyte.
void write_stream(const Stream& stream, bool ascii, const Sink& sink);

/// Thrown when a program before this one in the pipe failed and reported why.
struct UpstreamFailed {
  std::string program;
  int status;
};

}  // namespace meshpipe
