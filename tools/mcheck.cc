// SPDX-License-Identifier: BSD-3-Clause
// mcheck: verify a result against the surface it was made from.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "formats/stream/lift_tables.h"
#include "formats/stream/line_tables.h"
#include "lib/check/check.h"
#include "lib/clean/clean.h"
#include "lib/core/number.h"
#include "lib/core/weld.h"
#include "lib/defeature/defeature.h"
#include "tools/common.h"
#include "tools/report/rounds.h"
#include "tools/report/verdict.h"

using namespace meshpipe;

namespace {

struct Options {
  std::string reference, require = default_contract, histogram, offending, refine, verdict;
  double max_error = 0;
  bool accept = false;
  int samples = 10000;
};

/// Files as STL hold every triangle on its own.
bool is_soup(const Mesh& m) { return m.points.size() == 3 * m.tris.size() && m.tris.size() > 1; }

/// The name of a patch as a user knows it: or its label.
std::function<std::string(int)> namer(const Stream& stream) {
  return [&stream](int label) {
    const std::string name = stream.name_of(2, label);
    return name.empty() ? std::to_string(label) : name;
  };
}

/// How far mfeature has moved points of the input, at most, in removing features.
double moved(const Stream& stream) {
  double sum = 0;
  for (const std::string& remark : stream.remarks) sum += moved_by(remark);
  return sum;
}

Findings compare(Io& io, Stream& stream, const Options& o, Surface& reference) {
  Surface& result = stream.surface;
  const bool own = o.reference.empty();
  Stream other;
  Lines lines;
  int opened = 0;
  if (own) {
    reference = read_reference(stream);
    if (stream.find("line_use")) lines = read_lines(stream);
  } else {
    other = io.read(o.reference);
    reference = std::move(other.surface);
    opened = clean(reference).opened_edges;
    if (is_soup(result)) weld(result);
  }
  expect_measurable(reference);
  if (result.tris.empty()) throw NotAdmissible("the result has no triangles");
  Findings f = examine(result, reference, own ? &lines : nullptr, o.samples);
  f.opened = opened;
  if (own) f.distance.bound += moved(stream) / diagonal(reference);
  const std::vector<Patch> patches = patches_of(result, f.mesh.opposite, namer(stream));
  // a file that holds one patch comes from a format without patches, as a rule
  if (own || patches.size() > 1)
    f.patch_faults = compare_patches(patches_of(reference, {}, namer(own ? stream : other)), patches);
  return f;
}

void say(Io& io, const Findings& f) {
  for (const std::string& line : figure_table(figures(f))) io.say(line);
  auto &report = io.report, reference = nlohmann::ordered_json::object();
  for (const Figure& x : figures(f))
    for (auto [where, value] : {std::pair{&report, x.result}, std::pair{&reference, x.reference}}) {
      if (std::isnan(value)) continue;
      if (x.decimals == count_figure)
        (*where)[x.key] = (long long)value;
      else
        (*where)[x.key] = value;
    }
  const Soundness &m = f.mesh, &r = f.reference;
  report["topology_same"] =
      m.sound() && r.sound() && m.components == r.components && m.genus == r.genus && m.loops == r.loops;
  for (auto [where, q] : {std::pair{&report, &f.quality}, std::pair{&reference, &f.reference_quality}}) {
    (*where)["kappa_histogram"] = bins(q->kappas, 0, 1, 50);
    (*where)["angle_histogram"] = q->angle_histogram;
  }
  report["reference"] = reference;
}

/// Where the surfaces are farther apart than half the size, which the contract may allow.
void warn_of_distance(Io& io, const Findings& f) {
  const Deviation& d = f.distance.deviation;
  if (d.worst <= 1) return;
  io.say("the surfaces are " + shown(most_deviation * d.worst) + " of the local size apart at (" +
         shown(d.place.x) + " " + shown(d.place.y) + " " + shown(d.place.z) +
         "): detail as fine as the size is lost; --max-error bounds the distance");
}

/// Reports what mclean and mfeature have done to the input, which the comparison with their result hides.
/// Returns the number of edges it has opened without being asked to.
int say_cleaning(Io& io, const Stream& stream) {
  int opened = 0;
  if (const double most = moved(stream); most > 0) {
    io.say("mfeature has moved points by up to " + shown(most) + ": this is part of the distance at most");
    io.report["moved"] = most;
  }
  for (const std::string& text : stream.remarks) {
    const Remark r = parse_remark(text);
    if (r.opened + r.split + r.dropped == 0) continue;
    io.say("of the input, mclean has opened " + std::to_string(r.opened) + " edges, split " +
           std::to_string(r.split) + " vertices, dropped " + std::to_string(r.dropped) + " triangles");
    io.report["input"] = {{"opened", r.opened}, {"split", r.split}, {"dropped", r.dropped}};
    opened = r.opened;
  }
  for (const Provenance& p : stream.history)
    if (p.program == "mclean" && p.arguments.find("--sheets") != p.arguments.npos) opened = 0;
  return opened;
}

/// Writes the result with sizes that may meet the contract. Returns whether any size changed: if not, nothing
/// is written.
bool write_refined(const Io& io, const Stream& stream, const std::string& file, std::vector<double> size) {
  if (size == stream.surface.vertex.get<double>("size")) return false;
  Stream refined;
  static_cast<Mesh&>(refined.surface) = stream.surface;
  refined.surface.vertex.set("size", std::move(size));
  io.write_to(file, refined);
  return true;
}

/// The verdict on one round of a chain, added to the file that holds those of the rounds before it.
class Verdict {
 public:
  Verdict(Io& io, const Options& o) : file_(o.verdict) {
    if (file_.empty()) return;
    io.expect_report("--verdict", file_);
    if (std::filesystem::is_regular_file(file_)) before_ = Io::read_bytes(file_);
    outcome.bounded_distance = o.max_error > 0;
    io.on_failure = [this, &io](int status, const std::string& why, const std::string& program) {
      outcome.status = status;
      outcome.program = program;
      outcome.message = why;
      try {
        write();
      } catch (const CannotWrite& e) {
        std::fprintf(stderr, "mcheck: error: %s\n", e.what());
      }
      return !repeats();
    };
  }
  /// Returns whether the chain is to be repeated: then this round writes nothing else.
  bool repeats() const { return !file_.empty() && is_repeated(before_, outcome); }
  void write() const {
    if (!file_.empty()) Io::write_file(file_, before_ + verdict_block(before_, outcome));
  }

  Outcome outcome;

 private:
  std::string file_, before_;
};

void check(Io& io, const Options& o, Verdict& verdict) {
  Contract contract = parse_contract(o.require);
  if (o.max_error > 0) contract.push_back({"hausdorff", o.max_error});
  if (!o.histogram.empty()) io.expect_report("--histogram", o.histogram);
  if (!o.offending.empty()) io.expect_report("--culprits", o.offending, true);
  if (!o.refine.empty()) io.expect_report("--refine", o.refine, true);
  Stream stream = io.read();
  if (!o.refine.empty() && !stream.surface.vertex.has("size"))
    throw NotAdmissible("--refine needs vertex data 'size' in the result, and there is none");
  Surface reference;
  Findings f = compare(io, stream, o, reference);
  say(io, f);
  warn_of_distance(io, f);
  f.opened += say_cleaning(io, stream);
  if (!o.histogram.empty()) Io::write_file(o.histogram, findings_svg(f));
  if (!o.offending.empty()) {
    Stream faulty;
    faulty.surface = offending_faces(contract, f, stream.surface);
    io.write_to(o.offending, faulty);
  }
  const std::vector<Failure> failures = judge(contract, f, stream.surface);
  io.report["failed"] = nlohmann::ordered_json::array();
  for (const Failure& x : failures) {
    io.say("failed: " + x.requirement + ": " + x.fact);
    io.report["failed"].push_back({{"requirement", x.requirement}, {"fact", x.fact}});
  }
  verdict.outcome.failures = failures;
  if (!o.refine.empty() && !failures.empty())
    verdict.outcome.refined =
        write_refined(io, stream, o.refine, smaller_sizes(contract, f, stream.surface, reference));
  if (verdict.repeats())
    io.json.clear();
  else if (failures.empty() || o.accept)
    io.write(stream);
  if (failures.empty()) return verdict.write();
  throw ContractMissed(
      "contract missed: " + failures[0].requirement + ": " + failures[0].fact +
      (failures.size() > 1 ? " (and " + std::to_string(failures.size() - 1) + " more)" : ""));
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  std::optional<Verdict> verdict;  // outlives the body, which may fail
  auto add_options = [&](CLI::App& app) {
    app.add_option("--reference", o.reference,
                   "the surface to compare with; without it the stream's own, from mlift")
        ->type_name("FILE");
    app.add_option("--require", o.require, "what must be met, see mcheck(1) (default " + o.require + ")")
        ->type_name("LIST");
    app.add_option("--max-error", o.max_error, "requires hausdorff=E, too")
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
    report("--refine", o.refine, "if the contract is missed, write the sizes that may meet it")
        ->type_name("FILE");
    report("--verdict", o.verdict, "add the outcome as lines key=value, errors too: see mcheck(1)")
        ->type_name("FILE");
    report("--culprits", o.offending, "write the triangles at fault")->type_name("FILE");
  };
  return run_tool(
      argc, argv, "mcheck",
      "Verify a result: connectivity, self-intersections, quality, and distance to the surface it was "
      "made from.\n\nexamples:\n"
      "  mremesh -q --keep stages tree.stl -o tree-mesh.ply && mcheck stages/11-relax.ply -o checked.ply\n"
      "  mcheck tree.stl --reference tree.stl --require topology,hausdorff=0.01 --json tree.json -o tree.ply",
      add_options, [&](Io& io) { check(io, o, verdict.emplace(io, o)); });
}
