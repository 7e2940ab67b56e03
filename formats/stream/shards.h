// SPDX-License-Identifier: BSD-3-Clause
// Shards of a stream: streams of some of its parts, on which mparam and mmesh2d work as on the whole.
#pragma once
#include "formats/stream.h"
#include "lib/lines/lines.h"

namespace meshpipe {

/// Rows of the whole, by those of a shard (all but line points ascend), and the shard's lines.
struct ShardNumbers {
  std::vector<int> parts, faces, vertices, line_points;
  Lines lines;
};

/// Returns whether the stream is a shard: table `shard` has the number in the whole of each of its parts.
inline bool is_shard(const Stream& stream) { return stream.find("shard") != nullptr; }

/// Flags the vertices that the mesh has too, although they are on no line (sharp_peaks); in a shard, those of
/// its table `kept_vertex`, which are known from the whole. Requires: vertex column `size`.
std::vector<char> kept_vertices(const Stream& stream);

/// Distributes the parts to `count` shards (fewer if there are fewer parts), each with almost the same number
/// of triangles, those of the result included where sizes are known. Returns the parts of each, ascending.
/// Throws: NotAdmissible for a stream that has no parts, is a shard, or has passed mlift.
std::vector<std::vector<int>> share_out(const Stream& whole, int count);

/// Numbers the faces, vertices and line points of a shard. A line point that stands for another one at its
/// vertex (PartLines::point) does so in the shard, too: if that is on none of the shard's lines, it gets a
/// line of its own, which no part uses, with two points there. Requires: parts ascending.
ShardNumbers number_shard(const Stream& whole, std::vector<int> parts);

/// Returns the shard as a stream: its surface, with the rows of its parts in the tables of maps and lines.
/// `kept`: kept_vertices of the whole; empty if sizes are not known yet.
Stream cut_shard(const Stream& whole, const ShardNumbers& numbers, const std::vector<char>& kept);

/// Drops from a shard all that join_shards takes from the whole: the surface, and tables other than `shard`,
/// `part` and `tables`.
void keep_made(Stream& shard, std::initializer_list<std::string_view> tables);

/// Reads the file of this name, and passes the streams in it on one by one.
using ReadShard = std::function<void(const std::string&, const std::function<void(Stream)>&)>;

/// Returns a table that has this number of rows. Throws: BadInput if it has another; as Stream::need.
const Table& need_rows(const Stream& stream, const char* table, const char* writer, std::size_t rows);
inline const Table& need_row(const Stream& stream, const char* table, const char* writer) {
  return need_rows(stream, table, writer, 1);
}

/// Throws BadInput unless a shard with history `made` is what `by`, in any version, has made of a shard of
/// the whole.
void expect_made_of(const Stream& whole, const std::vector<Provenance>& made, const Provenance& by);

/// Calls `take`; errors get the name of the shard in front. Throws: BadInput.
void of_shard(const std::string& name, const std::function<void()>& take);

/// Adds to the whole what a program has made of its shards, as it would make it of the whole: plane meshes,
/// else charts, without those that are missing. `read` returns a shard by its name. Throws: BadInput, with a
/// shard's name, for one that is none of the whole, parts that are missing, doubled or cut, and shards that
/// were not made by `by`, in any version.
void join_shards(Stream& whole, const std::vector<std::string>& names, const Provenance& by,
                 const std::function<Stream(const std::string&)>& read);

}  // namespace meshpipe
