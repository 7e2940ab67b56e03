// SPDX-License-Identifier: BSD-3-Clause
#include "tools/check_shards.h"

#include "formats/stream/check_tables.h"
#include "formats/stream/lift_tables.h"
#include "formats/stream/region_tables.h"
#include "lib/core/error.h"
#include "lib/core/parallel.h"
#include "tools/compare.h"

namespace meshpipe {

void check_shard(Io& io) {
  CheckShard shard = read_shares(io.stream);
  io.stream.surface = {}, io.stream.tables.clear();  // frees its memory now
  const int n = (int)shard.shares.size();
  std::vector<ShareFindings> found(n);
  parallel_for(n, [&](int i) {
    found[i] = measure(shard.shares[i]);
    shard.shares[i] = {};
  });
  io.say(std::to_string(n) + (n == 1 ? " share" : " shares") + " of " + std::to_string(shard.all) +
         " measured");
  io.report["shares"] = n;
  write_findings(io.stream, shard, found);
  io.write(io.stream);
}

void cut_into_shards(Io& io, const ShardFiles& to, int tile, int samples, const Contract& contract) {
  const Surface reference = read_reference(io.stream);
  expect_measurable(reference);
  const Surface& result = io.stream.surface;
  const bool small = (double)result.tris.size() <= 4.0 * tile;
  io.report["shards"] = 0;
  if (small || has_sheets(io.stream) || reference.face.has("curved")) {
    io.say(std::to_string(result.tris.size()) + " triangles are checked at once: no shards");
    return write_as_it_is(io, io.stream);
  }
  const double most = distance_to_know(io.stream, contract, reference);
  make_directory(to.into);
  write_as_it_is(io, io.stream);
  io.stream.tables.clear();  // frees its memory now
  ShareTables some;
  int written = 0;
  cut_examination(result, reference, tile, samples, most, [&](const CheckShare& share, int number, int all) {
    const int count = std::min(to.count, all);
    some.add(number, share);
    if (number + 1 < (long long)(written + 1) * all / count) return;
    Stream stream;
    stream.history = io.stream.history;
    stream.ascii = io.stream.ascii;
    some.write(stream, all);
    io.write_to(shard_name(to.into, written++), stream);
  });
  io.say(std::to_string(written) + (written == 1 ? " shard of " : " shards of ") +
         std::to_string(result.tris.size()) + " triangles");
  io.report["shards"] = written;
}

std::vector<ShareFindings> read_checked(const Io& io, const ShardFiles& shards) {
  if (has_sheets(io.stream) || (io.stream.find("ref_face") && io.stream.find("ref_face")->has("curved")))
    throw NotAdmissible("--join: this result is checked at once");
  return join_checks(io.stream, {io.program, "", io.arguments}, shards_in(shards.from),
                     [&](const std::string& name) { return io.read(name); });
}

}  // namespace meshpipe
