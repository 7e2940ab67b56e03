// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <map>
#include <set>

#include "formats/stream/model_edges.h"
#include "formats/stream/region_tables.h"
#include "lib/cap/cap.h"
#include "lib/clean/clean.h"
#include "lib/core/number.h"
#include "lib/size/size.h"
#include "tools/common.h"

using namespace meshpipe;

namespace {

struct Options : CleanOptions {
  double spikes = 1000;  ///< extents of the neighbors, more than any needle has; 0: none are moved
  std::string within = "auto", most = "all", how = "auto", resolving = "none", data, offending;
};

/// Throws: BadUsage for values that no surface makes valid.
void check(Options& o) {
  if (o.within != "auto" && !parse_length(o.within, 1))
    throw BadUsage("--weld: expected auto, a length or a percentage, found '" + o.within + "'");
  if (o.most == "all") return;
  const char* end = o.most.data() + o.most.size();
  const auto [at, error] = meshpipe::from_chars(o.most.data(), end, o.keep_components);
  if (error != std::errc() || at != end || o.keep_components <= 0)
    throw BadUsage("--keep-components: expected a number or all, found '" + o.most + "'");
}

/// Fills the report of --json; of a surface that is refused, with what was found until then.
void put(Io& io, const CleanReport& r, const CleanOptions& options) {
  io.report["input_vertices"] = r.input_vertices;
  io.report["input_triangles"] = r.input_triangles;
  io.report["clean"] = r.nothing;
  io.report["weld_tolerance"] = r.tolerance;
  for (const auto& [key, count, what] : table_of(r, options)) io.report[key] = count;
  if (options.resolve != options.none) {
    io.report["dropped_area"] = r.resolved.dropped_area;
    io.report["closed"] = r.resolved.closed;
  }
  for (const auto& [t, n] : r.nonorientable)
    io.report["dropped_nonorientable"].push_back({{"triangle", t}, {"triangles", n}});
}

void drop_labels(Surface& surface) {
  for (const char* column :
       {"boundary_labels.0", "boundary_labels.1", "BoundaryLabels.0", "BoundaryLabels.1"})
    surface.face.erase(column);
}

/// The label of the region of a patch: N if its name is region-N, as mconvert --regions writes it, else its
/// number.
int label_of(const Stream& stream, int patch) {
  const std::string prefix = "region-", name = stream.name_of(2, patch);
  int label = patch;
  if (name.starts_with(prefix)) {
    const char* end = name.data() + name.size();
    const auto [at, error] = meshpipe::from_chars(name.data() + prefix.size(), end, label);
    if (error != std::errc() || at != end || label <= 0) label = patch;
  }
  return label;
}

/// Takes kept sheets apart, with the labels of both sides that the file has; or where each solid that touches
/// others is one patch, with theirs.
RegionReport take_apart_labeled(Stream& stream, const SheetCounts& sheets) {
  const std::vector<std::array<int, 2>> given = side_labels(stream.surface);
  if (given.empty() && !sheets.solids.empty()) {
    // their numbers where names would give two solids one label
    std::map<int, int> label;
    for (const auto& pair : sheets.solids)
      for (int patch : pair)
        if (patch > 0) label[patch] = label_of(stream, patch);
    std::set<int> different;
    for (const auto& [patch, l] : label) different.insert(l);
    std::vector<std::array<int, 2>> labels = sheets.solids;
    for (auto& pair : labels)
      for (int& side : pair)
        if (side > 0 && different.size() == label.size()) side = label.at(side);
    try {
      return take_apart(stream.surface, labels);
    } catch (const LabelsContradict&) {  // patches are not solids, as of a design whose faces they are
    }
  }
  return take_apart(stream.surface, given);
}

/// Takes kept sheets apart, and reports the regions between them.
void divide(Io& io, Stream& stream, CleanReport& report) {
  const RegionReport regions = take_apart_labeled(stream, report.sheets);
  drop_labels(stream.surface);  // tables hold them now
  report.sheets.patches.insert(report.sheets.patches.end(), regions.added.begin(), regions.added.end());
  write_regions(stream, regions.sheets, regions.label, regions.volume);
  const int n = (int)regions.label.size() - 1;
  for (int i = 1; i <= n; ++i) {
    io.detail("region " + std::to_string(regions.label[i]) + " has volume " + shown(regions.volume[i]));
    io.report["regions"].push_back({{"label", regions.label[i]}, {"volume", regions.volume[i]}});
  }
  io.report["free_edges"] = regions.free_edges;
  if (regions.free_edges > 0)
    io.say("sheets end in " + std::to_string(regions.free_edges) +
           (regions.free_edges == 1 ? " free edge" : " free edges") + ", the first at " +
           shown(regions.free_at));
  const auto [least, most] = std::minmax_element(regions.volume.begin() + 1, regions.volume.end());
  if (n > 0)
    io.say(std::to_string(n) + (n == 1 ? " region" : " regions") + " between the sheets, of volume " +
           shown(*least) + (n == 1 ? "" : " to " + shown(*most)));
}

void say(Io& io, const CleanReport& r, const CleanOptions& options, const Surface& surface) {
  auto counts = [](std::size_t vertices, std::size_t triangles) {
    return std::to_string(vertices) + " vertices, " + std::to_string(triangles) + " triangles";
  };
  io.say((r.nothing ? "clean: " : counts(r.input_vertices, r.input_triangles) + " -> ") +
         counts(surface.points.size(), surface.tris.size()) + ", " + std::to_string(r.components) +
         (r.components == 1 ? " component" : " components"));
  io.report["vertices"] = surface.points.size();
  io.report["triangles"] = surface.tris.size();
  io.report["components"] = r.components;
  for (const auto& [key, count, what] : table_of(r, options)) {
    char line[160];  // a clean surface may still have copies and flat triangles
    std::snprintf(line, sizeof line, "%9d %s%s", count, what.c_str(), r.nothing ? " (as in the input)" : "");
    if (count) io.say(line);
  }
  if (r.opened_edges > 0)  // not to go unseen
    io.warn("warning: sheets are split at " + std::to_string(r.opened_edges) +
            (r.opened_edges == 1 ? " edge" : " edges") +
            " where they met: the parts will not fit together there any more");
  if (const FlipCounts& f = r.sheets.flips; f.edges > 0)
    io.warn("warning: the surface cannot be oriented: components of " + std::to_string(f.triangles) +
            " triangles are cut along " + std::to_string(f.edges) + (f.edges == 1 ? " edge" : " edges") +
            ", the first at " + shown(f.place) +
            (r.sheets.kept ? ": both sides have the same vertices there, but are oriented differently"
                           : ": both sides are borders there, --sheets keep keeps them together"));
  for (const auto& [t, n] : r.nonorientable)
    io.say("dropped: the component of triangle " + std::to_string(t) + " (" + std::to_string(n) +
           " triangles), which is not orientable");
}

/// Names the patches that were added: one that became several has its name on each of them.
void name_patches(Stream& stream, const CleanReport& report) {
  int number = 1, of = -1;
  for (const auto& [patch, was] : report.sheets.patches) {
    number = std::exchange(of, was) == was ? number + 1 : 2;
    if (const std::string name = stream.name_of(2, was); !name.empty())
      stream.names.push_back({2, patch, name + "-" + std::to_string(number)});
  }
  for (std::size_t i = 0; i < report.holes.patches.size(); ++i)
    stream.names.push_back({2, report.holes.patches[i], "cap-" + std::to_string(i + 1)});
}

void write_offending(const Io& io, const std::string& path, const CleanReport& report, const Mesh& input) {
  Stream stream;
  stream.surface = offending_faces(report, input);
  for (int i = 0; i < (int)std::size(fault_names); ++i) stream.names.push_back({2, i + 1, fault_names[i]});
  io.write_to(path, std::move(stream));
}

/// What earlier runs of mclean and mfeature have done to a surface that is the input now.
bool is_of_former_run(const std::string& remark) {
  return remark.starts_with("clean ") || remark.starts_with("spikes ") || remark.starts_with("gaps ") ||
         remark.starts_with("removed ");
}

void add_options(CLI::App& app, Options& o) {
  app.add_option(
         "--weld", o.within,
         "merge vertices closer than this: auto (default: far below the edges around them), a length, or "
         "% of the diagonal")
      ->type_name("auto|TOL");
  app.add_option("--keep-components", o.most, "keep the N components of largest area (default: all)")
      ->type_name("N|all");
  auto* fill = app.add_option("--fill-holes", o.fill_holes, "fill border loops of at most N edges")
                   ->check(CLI::Range(3, 100000))
                   ->type_name("N");
  app.add_flag("--cap-patches", o.cap_patches,
               "give each filled hole a separate patch, named cap-1, cap-2 ...")
      ->needs(fill);
  app.add_flag("--drop-nonorientable", o.drop_nonorientable,
               "drop components that cannot be oriented instead of cutting them open");
  app.add_option(
         "--sheets", o.how,
         "edges of more than two triangles: auto (default), keep (one conforming mesh), pair (by solid) or "
         "split; see mclean(1)")
      ->check(CLI::IsMember({"auto", "pair", "split", "keep"}));
  app.add_option("--require-data", o.data, "fail with status 4 unless the vertices have data of this name")
      ->type_name("NAME")
      ->group("Reports");
  app.add_option("--resolve", o.resolving,
                 "self-intersections: none (default) leaves them, outer keeps the outer surface only, all "
                 "keeps all pieces")
      ->check(CLI::IsMember({"none", "outer", "all"}));
  app.add_option("--drop-spikes", o.spikes,
                 "move a vertex to the mean of its neighbors if all are farther from it than R times their "
                 "extent (default 1000; 0: never)")
      ->check(CLI::NonNegativeNumber)
      ->type_name("R");
  app.add_option("--culprits", o.offending, "write the offending triangles to this file")
      ->type_name("FILE")
      ->group("Reports");
}

/// Moves spikes as the options ask; returns their number.
int flatten(Io& io, Surface& s, const Options& o) {
  const int n = o.spikes > 0 ? flatten_spikes(s, o.spikes) : 0;
  if (n > 0)
    io.say("vertices that stuck out and were moved to the mean of their neighbors: " + std::to_string(n));
  io.report["spikes"] = n;
  return n;
}

/// Remarks on borders that almost fit and on vertices that stick out, for programs that fail on them.
void remark_on_flaws(const Io& io, Stream& stream, const CleanReport& report) {
  if (const Gaps gaps = find_gaps(stream.surface, report); gaps.closed > 0) {
    stream.remarks.push_back("gaps " + gaps.text());
    io.say(gaps.text() + ": --weld " + shown(gaps.within) + " joins them");
  }
  const Spikes spikes = find_spikes(stream.surface);
  if (spikes.count == 0) return;
  stream.remarks.push_back("spikes " + std::to_string(spikes.count));
  const Vec3 p = spikes.longest;
  io.say("vertices that stick out: " + std::to_string(spikes.count) + ", the farthest at " + shown(p));
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  return run_tool(
      argc, argv, "mclean",
      "Make a triangle soup an oriented manifold, and report every repair.\n\n"
      "Examples:\n  mclean tree.stl -o clean.ply\n"
      "  mclean --weld 0.0001% --keep-components 1 tree.stl | mtopo > topo.ply\n"
      "  mclean --drop-nonorientable --culprits bad.ply tree.stl -o clean.ply",
      [&](CLI::App& app) { add_options(app, o); },
      [&](Io& io) {
        check(o);
        o.sheets = o.how == "keep"    ? o.keep
                   : o.how == "split" ? o.split
                   : o.how == "pair"  ? o.pair
                                      : o.automatic;
        o.resolve = o.resolving == "all" ? o.all : o.resolving == "outer" ? o.outer : o.none;
        if (!o.offending.empty()) io.expect_report("--culprits", o.offending, true);
        Stream& stream = io.read();
        Surface& s = stream.surface;
        if (has_sheets(stream)) stream = with_sheets_joined(stream);
        if (o.resolve == o.outer) drop_labels(s);  // only one region stays
        if (o.sheets == o.automatic && !side_labels(s).empty()) o.sheets = o.keep;
        if (!o.data.empty()) expect_data(s, o.data);
        o.weld = o.within == "auto" ? -1 : *parse_length(o.within, diagonal(s));
        const Mesh input = o.offending.empty() ? Mesh{} : s;
        // lines of a foreign file, by their place: vertices are about to be renumbered
        const ModelSegments lines = stream.history.empty() ? segments_of(stream) : read_model_edges(stream);
        CleanReport report;
        auto report_faults = [&] {
          put(io, report, o);
          if (!o.offending.empty()) write_offending(io, o.offending, report, input);
        };
        try {
          const int moved = flatten(io, s, o);
          clean(s, o, report);
          report.nothing = report.nothing && moved == 0;
        } catch (const NotAdmissible&) {
          report_faults();
          throw;
        }
        report_faults();
        if (!s.face.has("patch")) s.face.set("patch", std::vector<int>(s.tris.size(), 1));
        // a vessel with caps keeps the count that mcap scaled from the open one: caps are meshed more finely
        const bool counted = report.nothing && stream.input_triangles > 0 && !stream.find("ref_vertex") &&
                             std::any_of(stream.remarks.begin(), stream.remarks.end(),
                                         [](const std::string& r) { return parse_caps(r).last > 0; });
        // whatever was found out about another surface, or by another program, does not hold for this one
        if (stream.input_triangles == 0 || !report.nothing || stream.find("ref_vertex")) {
          stream.tables.clear();
          write_model_edges(stream, lines);
          for (const char* column : {"part", "origin"}) s.face.erase(column);
          for (const char* column : {"ref_face", "b1", "b2", "kind", "line"}) s.vertex.erase(column);
        }
        for (const char* table : {"sheet", "region"}) stream.erase(table);
        if (report.sheets.kept) divide(io, stream, report);
        if (stream.input_triangles == 0 || !report.nothing) {
          std::erase_if(stream.remarks, is_of_former_run);
          if (const std::string r = remark_of(report); r.size()) stream.remarks.push_back(r);
          remark_on_flaws(io, stream, report);
        }
        name_patches(stream, report);
        if (!counted) stream.input_triangles = (int)s.tris.size();
        say(io, report, o, s);
        io.write(stream);
      },
      {.passes = true, .sets_unit = true});
}
