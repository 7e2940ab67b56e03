// SPDX-License-Identifier: BSD-3-Clause
// mshard: cut a stream into shards of whole parts, for mparam and mmesh2d as separate jobs.
#include "formats/stream/shards.h"
#include "tools/common.h"
#include "tools/shard_files.h"

using namespace meshpipe;

namespace {

/// Writes each shard into a directory, which is made if it is not there, as 1.ply, 2.ply, ...
void cut(Io& io, int count, const std::string& directory) {
  expect_only_shards(io);
  const Stream& whole = io.read();
  const std::vector<std::vector<int>> shares = share_out(whole, count);
  make_directory(directory);
  const std::vector<char> kept =
      whole.surface.vertex.has("size") ? kept_vertices(whole) : std::vector<char>();
  std::size_t largest = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    Stream shard = cut_shard(whole, number_shard(whole, shares[i]), kept);
    largest = std::max(largest, shard.surface.tris.size());
    io.write_to(shard_name(directory, i), std::move(shard));
  }
  auto counted = [](std::size_t n, const char* what) {
    return std::to_string(n) + ' ' + what + (n == 1 ? "" : "s");
  };
  io.say(counted(shares.size(), "shard") + " of " + counted(whole.surface.tris.size(), "triangle") + " in " +
         counted(whole.need("part", "mpartition").rows, "part") + ", the largest of " +
         std::to_string(largest));
  io.report["shards"] = shares.size();
  io.report["largest"] = largest;
}

}  // namespace

int main(int argc, char** argv) {
  int count = 0;
  std::string into;
  auto options = [&](CLI::App& app) {
    app.add_option("--shards", count, "number of shards; all get almost the same number of triangles")
        ->required()
        ->check(CLI::Range(1, 100000))
        ->type_name("N");
    app.add_option("--into", into, "directory of the shards: DIR/1.ply, DIR/2.ply, ...")
        ->required()
        ->type_name("DIR");
  };
  return run_tool(
      argc, argv, "mshard",
      "Cut a stream into shards of whole parts, for mparam and mmesh2d as separate jobs; their --join puts "
      "the results together.\n\nexamples:\n"
      "  mremesh -q --keep stages tree.stl -o tree-mesh.stl && "
      "mshard --shards 2 --into in stages/09-lines.ply\n"
      "  mremesh -q --keep s tree.stl -o a.stl && mshard --shards 2 --into in s/09-lines.ply && "
      "mkdir out && mmesh2d in/1.ply -o out/1.ply && mmesh2d in/2.ply -o out/2.ply && "
      "mmesh2d --join out s/09-lines.ply | mlift -o lifted.ply",
      options, [&](Io& io) { cut(io, count, into); }, {.passes = true, .any_size = true});
}
