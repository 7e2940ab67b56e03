// SPDX-License-Identifier: BSD-3-Clause
// The files of shards: DIR/1.ply, DIR/2.ply, ...
#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/io.h"

namespace meshpipe {

/// Where shards go, and where those come from that are to be joined.
struct ShardFiles {
  int count = 0;  ///< 0: none are cut
  std::string into, from;
};
/// Adds --shards, --into and --join, which exclude another option. `what`: the shards are of.
void add_shard_options(CLI::App& app, ShardFiles& shards, const std::string& what, CLI::Option* excluded);
/// Adds --join DIR.
CLI::Option* add_join_option(CLI::App& app, std::string& from);

/// Throws: BadUsage for -o FILE, which a program that cuts does not write.
void expect_only_shards(const Io& io);

/// Makes a directory if it is not there. Throws: CannotWrite.
void make_directory(const std::string& directory);

/// Returns the name of a shard's file; the first is shard 0.
std::string shard_name(const std::string& directory, std::size_t shard);

/// Returns the names of all shards in a directory. Throws: BadInput if there are none.
std::vector<std::string> shards_in(const std::string& directory);

/// Reads a file for what joins shards.
void read_shard(const std::string& name, const std::function<void(Stream)>& take);

/// Writes a number of streams into shards, as they come.
class ShardWriter {
 public:
  ShardWriter(const Io& io, const ShardFiles& to, int streams);
  void add(const Stream& stream);
  int count() const { return count_; }

 private:
  bool ascii_;
  std::string directory_;
  int streams_, count_, next_ = 0, shard_ = 0;
  std::optional<AtomicFile> file_;
};

}  // namespace meshpipe
