// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shard_files.h"

#include <filesystem>

#include "lib/core/error.h"

namespace meshpipe {

void add_shard_options(CLI::App& app, ShardFiles& shards, const std::string& what, CLI::Option* excluded) {
  auto* count =
      app.add_option("--shards", shards.count, "write N shards " + what + ", to be run as separate jobs")
          ->check(CLI::Range(1, 100000))
          ->type_name("N");
  auto* into = app.add_option("--into", shards.into, "directory of the shards: DIR/1.ply, DIR/2.ply, ...")
                   ->type_name("DIR");
  auto* join = add_join_option(app, shards.from);
  count->needs(into), into->needs(count);
  for (CLI::Option* option : {count, into, join}) option->group("Shards")->excludes(excluded);
}

CLI::Option* add_join_option(CLI::App& app, std::string& from) {
  return app.add_option("--join", from, "join the results of the shards in this directory")
      ->type_name("DIR")
      ->group("Shards");
}

void expect_only_shards(const Io& io) {
  if (io.output != "-") throw BadUsage("-o " + io.output + ": --shards writes shards only, to --into DIR");
}

void make_directory(const std::string& directory) {
  std::error_code no;
  std::filesystem::create_directories(directory, no);
  if (no) throw CannotWrite(directory + ": " + no.message());
}

std::string shard_name(const std::string& directory, std::size_t shard) {
  return directory + '/' + std::to_string(shard + 1) + ".ply";
}

std::vector<std::string> shards_in(const std::string& directory) {
  std::vector<std::string> names;
  for (std::error_code no;;) {
    std::string name = shard_name(directory, names.size());
    if (!std::filesystem::exists(name, no)) break;
    names.push_back(std::move(name));
  }
  if (names.empty()) throw BadInput(directory + "/1.ply: No such file or directory");
  return names;
}

void read_shard(const std::string& name, const std::function<void(Stream)>& take) {
  InputFile file(name);
  for (int i = 1; i == 1 || !file.next(1).empty(); ++i)
    take(read_next(file, i == 1 ? name : name + " stream " + std::to_string(i), true));
}

ShardWriter::ShardWriter(const Io& io, const ShardFiles& to, int streams)
    : ascii_(io.ascii), directory_(to.into), streams_(streams), count_(std::min(to.count, streams)) {
  make_directory(directory_);
}

void ShardWriter::add(const Stream& stream) {
  if (!file_) file_.emplace(shard_name(directory_, shard_));
  write_stream(stream, ascii_, [this](std::string_view bytes) { file_->write(bytes); });
  if (++next_ < (shard_ + 1LL) * streams_ / count_) return;
  file_->finish();
  file_.reset();
  ++shard_;
}

}  // namespace meshpipe
