// SPDX-License-Identifier: BSD-3-Clause
#include "tools/check_shards.h"

#include <atomic>

#include "formats/stream/check_tables.h"
#include "formats/stream/lift_tables.h"
#include "formats/stream/region_tables.h"
#include "lib/core/error.h"
#include "tools/compare.h"

namespace meshpipe {

void check_shard(Io& io) {
  std::atomic<int> all = 0;
  const int n = io.write_each([&](Stream stream) {
    const CheckJob job = take_share(std::move(stream));
    all = job.all;
    return stream_of(job.number, job.all, measure(job.share));
  });
  io.say(std::to_string(n) + (n == 1 ? " share" : " shares") + " of " + std::to_string(all) + " measured");
  io.report["shares"] = n;
}

void cut_into_shards(Io& io, const ShardFiles& to, int tile, int samples, const Contract& contract) {
  Surface reference = read_reference(io.stream);
  expect_measurable(reference);
  const Surface& result = io.stream.surface;
  const bool small = (double)result.tris.size() <= 4.0 * tile;
  io.report["shards"] = 0;
  if (small || has_sheets(io.stream) || reference.face.has("curved")) {
    io.say(std::to_string(result.tris.size()) + " triangles are checked at once: no shards");
    return;
  }
  const double most = distance_to_know(io.stream, contract, reference);
  io.stream.tables.clear();  // frees its memory now, as the next
  for (const char* column : {"patch", "part"}) reference.face.erase(column);
  std::optional<ShardWriter> shards;
  cut_examination(result, reference, tile, samples, most, [&](CheckShare share, int number, int all) {
    if (!shards) shards.emplace(io, to, all);
    Stream stream = stream_of({number, all, std::move(share)});
    stream.history = io.stream.history;
    shards->add(stream);
  });
  io.say(std::to_string(shards->count()) + (shards->count() == 1 ? " shard of " : " shards of ") +
         std::to_string(result.tris.size()) + " triangles");
  io.report["shards"] = shards->count();
}

std::vector<ShareFindings> read_checked(const Io& io, const ShardFiles& shards) {
  if (has_sheets(io.stream) || (io.stream.find("ref_face") && io.stream.find("ref_face")->has("curved")))
    throw NotAdmissible("--join: this result is checked at once");
  return join_checks(io.stream, {io.program, "", io.arguments}, shards_in(shards.from), read_shard);
}

}  // namespace meshpipe
