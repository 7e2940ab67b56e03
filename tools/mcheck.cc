// SPDX-License-Identifier: BSD-3-Clause
// mcheck: verify a result against the surface it was made from.
#include <algorithm>
#include <optional>

#include "formats/stream/check_tables.h"
#include "lib/check/check.h"
#include "lib/clean/clean.h"
#include "lib/core/number.h"
#include "tools/check_shards.h"
#include "tools/common.h"
#include "tools/compare.h"
#include "tools/report/verdict.h"
#include "tools/rounds/round_file.h"

using namespace meshpipe;

namespace {

struct Options {
  std::string reference, require = default_contract, histogram, offending, refine, verdict, tsv;
  double max_error = 0;
  bool accept = false;
  int samples = 10000;
  ShardFiles shards;
  int tile = 250000;
};

void say(Io& io, const Findings& f, const std::vector<Failure>& failures) {
  for (const std::string& line : figure_table(figures(f))) io.say(line);
  for (const std::string& line : warnings_of(io.stream, f)) io.say(line);
  for (const Failure& x : failures) io.say("failed: " + x.requirement + ": " + x.fact);
  const auto& history = io.stream.history;
  const bool resolved = std::any_of(history.begin(), history.end(), [](const Provenance& p) {
    return p.program == "mclean" && p.arguments.find("--resolve") != std::string::npos;
  });
  const Gaps gaps = gaps_of(io.stream.remarks);
  const std::size_t n = f.intersections.size() - f.new_intersections.size();
  if (n > 0 && f.reference_pairs.crossing == 0)
    io.say(std::to_string(n) + " pairs of triangles touch, as in the input");
  else if (n > 0)
    io.say(std::to_string(n) + " pairs of triangles intersect, as in the input: " +
           (gaps.closed > 0 ? "try mclean --weld " + shown(gaps.within) + " (" + gaps.text() + ")"
            : resolved      ? "mwrap resolves them"
                            : "--resolve outer resolves those of closed components, mwrap all of them"));
  io.report.update(report_of(f, io.stream));
  io.report["failed"] = failures_json(failures);
}

/// Writes the stream, in no unit.
void write_result(Io& io, Stream& stream) {
  const int unit = stream.unit;
  change_unit(stream, 0);
  io.write(stream);
  change_unit(stream, unit);
}

void write_refined(const Io& io, const Mesh& result, const std::string& file, std::vector<double> size) {
  Stream refined;
  static_cast<Mesh&>(refined.surface) = result;
  refined.surface.vertex.set("size", std::move(size));
  io.write_to(file, std::move(refined));
}

void check(Io& io, const Options& o, RoundFile& verdict, Summary& summary) {
  Contract contract = parse_contract(o.require);
  if (o.max_error > 0) contract.push_back({"hausdorff", o.max_error});
  if (!o.histogram.empty()) io.expect_report("--histogram", o.histogram);
  if (!o.offending.empty()) io.expect_report("--culprits", o.offending, true);
  if (!o.refine.empty()) io.expect_report("--refine", o.refine, true);
  if (!o.tsv.empty()) io.expect_report("--tsv", o.tsv), expect_heading(o.tsv, summary_heading());
  if (o.shards.count > 0) expect_only_shards(io);
  // of the result a cut needs its shape only
  Stream& stream = read(io, summary, [&](std::string_view table, std::string_view column) {
    return o.shards.count == 0 || (table != "vertex" && table != "face") || column == "x" ||
           column == "size" || column == "vertex_indices";
  });
  if (!o.refine.empty() && !stream.surface.vertex.has("size"))
    throw NotAdmissible("--refine needs vertex data 'size' in the result, and there is none");
  if (is_check_share(stream)) return check_shard(io);
  if (stream.find("checked")) throw NotAdmissible("these are measurements of a shard; expected --join DIR");
  if (o.shards.count > 0) return cut_into_shards(io, o.shards, o.tile, o.samples, contract);
  std::vector<ShareFindings> shares;
  if (!o.shards.from.empty()) shares = read_checked(io, o.shards);
  Surface reference;
  const Findings f = compare(io, stream, o.reference, contract, o.samples, reference, verdict.first_size(),
                             shares.empty() ? nullptr : &shares);
  verdict.outcome.mean_size = f.mean_size;
  verdict.outcome.triangles = (double)stream.surface.tris.size();
  const std::vector<Failure>& failures = verdict.outcome.failures = judge(contract, f, stream.surface);
  Surface faulty;
  if (!failures.empty() || !o.offending.empty()) faulty = offending_faces(contract, f, stream.surface);
  verdict.outcome.faulty = (double)faulty.tris.size();
  if (!o.refine.empty() && !failures.empty()) {
    std::vector<double> size = smaller_sizes(contract, f, stream.surface, reference);
    if (size != stream.surface.vertex.get<double>("size")) {
      if (!o.verdict.empty()) verdict.outcome.refined = triangles_asked_for(stream.surface, size, reference);
      write_refined(io, stream.surface, o.refine, std::move(size));
    }
  }
  summary.failures = failures;
  summary.figures = figures(f);
  const bool last = io.names_way_out = summary.counts = !verdict.repeats();
  if (last) say(io, f, failures);  // the figures of the last round are those of the result
  if (!o.histogram.empty()) Io::write_file(o.histogram, findings_svg(f));
  if (!o.offending.empty()) {
    Stream offending;
    offending.surface = std::move(faulty);
    io.write_to(o.offending, std::move(offending));
  }
  if (!last)
    io.json.clear();
  else if (failures.empty() || o.accept)
    write_result(io, stream);
  if (failures.empty()) return verdict.write();
  FailureFacts facts = facts_about(failures[0], stream.surface);
  if (facts.requirement == "hausdorff") facts.value = verdict.least_distance(facts.value);
  throw Informed<ContractMissed>(summary_of(failures), facts);
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  std::optional<RoundFile> verdict;  // outlives the body, which may fail
  Summary summary;
  auto add_options = [&](CLI::App& app) {
    auto* reference =
        app.add_option("--reference", o.reference,
                       "the surface to compare with (default: the one in the stream, from mlift on)")
            ->type_name("FILE");
    app.add_option("--require", o.require,
                   "requirements of the contract, separated by commas (see mcheck(1), also for the default)")
        ->type_name("LIST");
    app.add_option("--max-error", o.max_error, "also require hausdorff=E")
        ->check(positive_number())
        ->type_name("E");
    app.add_flag("--accept", o.accept,
                 "pass the stream on even if the contract is missed; the status is still 6");
    auto report = [&](const char* name, auto& value, const char* what) {
      return app.add_option(name, value, what)->group("Reports");
    };
    report("--samples", o.samples, "points on each surface for the distance (default 10000)")
        ->check(CLI::Range(1, 100000000));
    report("--histogram", o.histogram, "draw kappa and angles of both meshes")->type_name("FILE.svg");
    report("--refine", o.refine,
           "if the contract is missed, write smaller sizes that may meet it, for msize --field")
        ->type_name("FILE");
    report("--verdict", o.verdict, "append the outcome to this file, as lines key=value: see mcheck(1)")
        ->type_name("FILE");
    report("--tsv", o.tsv, "append the verdict to this tab-separated table, as one row")->type_name("FILE");
    report("--culprits", o.offending, "write the offending triangles to this file")->type_name("FILE");
    app.add_option("--tile", o.tile,
                   "triangles per share (default 250000); results of up to four times as many are not shared")
        ->check(CLI::Range(100, 100000000))
        ->type_name("N")
        ->group("Shards");
    add_shard_options(app, o.shards, "of measurements", reference);
  };
  const int status = run_tool(
      argc, argv, "mcheck",
      "Verify a result: connectivity, self-intersections, quality, and distance to the surface it was "
      "made from.\n\nexamples:\n"
      "  mremesh -q --keep stages tree.stl -o tree-mesh.ply && mcheck stages/12-relax.ply -o checked.ply\n"
      "  mcheck tree.stl --reference tree.stl --require topology,hausdorff=0.01 -o tree.ply",
      add_options, [&](Io& io) { check(io, o, verdict.emplace(io, o.verdict, o.max_error > 0), summary); },
      {.shards = true});
  return o.tsv.empty() ? status : add_to_table(o.tsv, summary, status);
}
