// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "formats/foreign/patch_groups.h"
#include "formats/stream/model_edges.h"
#include "formats/stream/region_tables.h"
#include "formats/stream/stages.h"
#include "lib/cap/cap.h"
#include "lib/core/lists.h"
#include "lib/core/triangle_count.h"
#include "lib/defeature/defeature.h"
#include "lib/feature/feature.h"
#include "tools/common.h"
#include "tools/files.h"
#include "tools/removed.h"

using namespace meshpipe;

namespace {

struct Options : FeatureOptions {
  std::string angles = "auto", group_file, edge_file, tolerance = "auto";
  bool merge_auto = false;
  double triangles = 0;
  bool keep_boundary = false;
  double max_error = 0;
};

/// Target lengths. Measured on CAD with sliver faces: below it parts of them stay, which end in corners of 1
/// to 4 degrees (smallest kappa 0.11, or failure, instead of 0.3); from 1/15 on the two sides of a thin
/// place intersect. Clean CAD changes nowhere up to 1/10.
constexpr double default_tolerance = 0.06;
/// And at most this much of the diagonal: a size larger than the surface does not remove all of it.
constexpr double most_of_diagonal = 0.01;
/// Of the distance of --max-error: the rest is for the mesh.
constexpr double error_share = 0.25;
/// Without a strip creases may go on to another narrow place, for which the rest of the tolerance is left;
/// after that there is little.
constexpr int most_removals = 2;
/// Of the tolerance, for folds: what lies flat on itself bounds no volume.
constexpr double fold_share = 4;

/// Gives table `sheet` the merged patches, which must have the same regions on their sides.
void relabel_sheets(Stream& stream, const PatchMerge& merge) {
  if (!has_sheets(stream)) return;
  std::vector<SheetPatch> sheets = read_sheets(stream);
  for (SheetPatch& s : sheets) s.patch = merge(s.patch);
  sort_unique(sheets);
  for (std::size_t i = 1; i < sheets.size(); ++i)
    if (const SheetPatch& a = sheets[i - 1], &b = sheets[i]; a.patch == b.patch)
      throw NotAdmissible("patches merged to " + std::to_string(a.patch) +
                          " have different regions on their sides: " + std::to_string(a.front) + " and " +
                          std::to_string(a.back) + ", " + std::to_string(b.front) + " and " +
                          std::to_string(b.back));
  stream.set(sheet_table(sheets));
}

/// Gives the faces the patches that theirs have become, and the patches the names of their groups.
void relabel(const Io& io, Stream& stream, const PatchMerge& merge, const std::vector<PatchGroup>& groups) {
  relabel_sheets(stream, merge);
  for (int& label : stream.surface.face.get<int>("patch")) label = merge(label);
  std::erase_if(stream.names, [&](const Name& n) { return n.dim == 2 && merge(n.tag) != n.tag; });
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const PatchGroup& g = groups[i];
    if (g.name.empty()) continue;
    const int tag = merge(g.patches[0]);
    const auto before = std::find_if(groups.begin(), groups.begin() + i, [&](const PatchGroup& other) {
      return !other.name.empty() && merge(other.patches[0]) == tag;
    });
    if (before != groups.begin() + i)
      io.say("groups '" + before->name + "' and '" + g.name + "' have become one patch, '" + g.name + "'");
    std::erase_if(stream.names, [&](const Name& n) { return n.dim == 2 && n.tag == tag; });
    stream.names.push_back({2, tag, g.name});
  }
}

/// Merges patches as the options ask.
PatchMerge merge_patches(const Io& io, Stream& stream, const Options& o, double length) {
  PatchMerge merge = no_merge(stream.surface);
  if (!stream.surface.face.has("patch") || !(o.merge_auto || !o.group_file.empty())) return merge;
  std::vector<PatchGroup> groups;
  if (!o.group_file.empty()) groups = read_groups(read_bytes(o.group_file), o.group_file, stream);
  std::vector<std::vector<int>> members;
  for (const PatchGroup& g : groups) members.push_back(g.patches);
  merge_groups(merge, members);
  if (o.merge_auto) merge_automatically(merge, stream.surface, length);
  relabel(io, stream, merge, groups);
  io.say(std::to_string(merge.patch.size()) + " patches merged to " + std::to_string(merge.count()));
  return merge;
}

/// Returns per half-edge the number of the line of the input, or of the file of --edges, on which it lies, or
/// -1; the lines stay in the stream.
std::vector<int> given_edges(const Io& io, Stream& stream, const std::string& edge_file) {
  const bool none = edge_file == "none", other = !edge_file.empty() && !none;
  ModelSegments lines = none ? ModelSegments() : read_model_edges(stream);
  const std::size_t n_own = lines.tris.size();
  if (other) append(lines, segments_of(io.read(edge_file)));
  const std::size_t n_other = lines.tris.size() - n_own;
  if (other && n_other == 0) throw NotAdmissible(edge_file + ": expected lines, found none");
  drop_downstream(stream, Stage::features);
  write_model_edges(stream, lines);
  const std::vector<int> given = segments_under(stream.surface, lines);
  std::vector<char> used(lines.tris.size());
  for (int segment : given)
    if (segment >= 0) used[segment] = 1;
  if (other)
    io.say(edge_file + ": " + std::to_string(n_other) + " lines, " +
           std::to_string(std::count(used.begin() + (std::ptrdiff_t)n_own, used.end(), 1)) +
           " of them under edges of the surface");
  return given;
}

void report(Io& io, const FeatureReport& r) {
  io.say(std::to_string(r.model_edges) + " model edges: " + std::to_string(r.patch_edges) +
         " between patches, " + (r.given_edges ? std::to_string(r.given_edges) + " given, " : std::string()) +
         std::to_string(r.crease_edges) + " on creases; " + std::to_string(r.corners) + " corners");
  if (r.slivers > 0)
    io.say(std::to_string(r.slivers) + " triangles thinner than 0.06 of the size make no creases");
  for (const auto& [key, n] : {std::pair{"slivers", r.slivers},
                               {"model_edges", r.model_edges},
                               {"patch_edges", r.patch_edges},
                               {"given_edges", r.given_edges},
                               {"crease_edges", r.crease_edges},
                               {"corners", r.corners}})
    io.report[key] = n;
}

/// Removes what is narrower than the tolerance, and adds it to `all`. Returns whether the surface has
/// changed: then its edges are to be marked again. `before`, by face, and `given`, by half-edge, follow.
bool defeature(CutSurface s, const DefeatureOptions& o, std::vector<int>& before, std::vector<int>& given,
               DefeatureReport& all) {
  const DefeatureReport r = remove_small_features(s, o, &given);
  if (all.removed.empty()) all.stopped = r.stopped;
  all.removed.insert(all.removed.end(), r.removed.begin(), r.removed.end());
  all.vanished.insert(all.vanished.end(), r.vanished.begin(), r.vanished.end());
  all.moved += r.moved;
  if (r.removed.empty()) return false;
  for (const char* column : {"part", "origin"}) s.surface.face.erase(column);
  given = r.given;
  std::vector<int> labels;
  for (int t : r.face) labels.push_back(before.empty() ? 0 : before[t]);
  if (!before.empty()) before = std::move(labels);
  return true;
}

/// Brings the tables of the stream up to date: lines of the input, which were under the half-edges `before`
/// and are under those `after`, names of patches that vanished, and what these bounded.
void follow_removal(Stream& stream, const DefeatureReport& r, const std::vector<int>& before,
                    const std::vector<int>& after) {
  const ModelSegments lines = read_model_edges(stream);
  stream.remarks.push_back(remark_of(r));
  drop_downstream(stream, Stage::parts);
  for (const char* table : {"part", "line", "line_use", "line_vertex"}) stream.erase(table);
  write_model_edges(stream, moved_segments(lines, before, stream.surface, after));
  auto vanished = [&](int patch) { return std::binary_search(r.vanished.begin(), r.vanished.end(), patch); };
  std::erase_if(stream.names, [&](const Name& n) { return n.dim == 2 && vanished(n.tag); });
  if (!has_sheets(stream)) return;
  std::vector<SheetPatch> sheets = read_sheets(stream);
  std::erase_if(sheets, [&](const SheetPatch& s) { return vanished(s.patch); });
  stream.set(sheet_table(sheets));
}

/// Flags the triangles that are not removed with fragments: those between two regions, and of patches with
/// names if there are several.
std::vector<char> kept_triangles(const Stream& stream, bool keep_boundary) {
  const Surface& surface = stream.surface;
  std::vector<char> flags(surface.tris.size(), keep_boundary);
  if (!surface.face.has("patch")) return flags;
  const std::vector<int>& patch = surface.face.get<int>("patch");
  const std::vector<SheetPatch> sheets = has_sheets(stream) ? read_sheets(stream) : std::vector<SheetPatch>();
  std::vector<int> named;
  for (const Name& n : stream.names)
    if (n.dim == 2) named.push_back(n.tag);
  sort_unique(named);
  for (std::size_t t = 0; t < flags.size(); ++t) {
    const SheetPatch* sheet = find_sheet(sheets, patch[t]);
    flags[t] |= (sheet && sheet->front != sheet->back) ||
                (named.size() > 1 && std::binary_search(named.begin(), named.end(), patch[t]));
  }
  return flags;
}

double tolerance_of(const Options& o, double length, double diagonal) {
  if (o.tolerance != "auto") return *parse_length(o.tolerance, diagonal);
  const double share = std::min(default_tolerance * length, most_of_diagonal * diagonal);
  return o.max_error > 0 ? std::min(share, error_share * o.max_error * diagonal) : share;
}

void add_options(CLI::App& app, Options& o) {
  app.add_option("--feature-angle", o.angles,
                 "auto (default): creases that look designed; A,B: creases start at edges above A degrees "
                 "and continue along edges above B; none")
      ->type_name("auto|A[,B]|none");
  auto* size =
      app.add_option("--size", o.size, "target edge length")->check(positive_number())->type_name("H");
  app.add_option("--triangles", o.triangles, "target number of triangles")
      ->check(count_between(1, 715827882))
      ->excludes(size)
      ->type_name("N");
  app.add_option("--merge", o.group_file,
                 "merge each group of patches that this file lists, one group per line")
      ->type_name("FILE");
  app.add_option(
         "--edges", o.edge_file,
         "add the lines of this mesh to the model edges; none: ignore the lines of the input's file as well")
      ->type_name("FILE|none");
  app.add_option("--tolerance", o.tolerance,
                 "remove features narrower than this: a length, P% of the diagonal, or auto (default): 0.06 "
                 "of the target edge length, at most 1% of the diagonal; 0: none")
      ->type_name("D|P%|auto");
  app.add_option("--max-error", o.max_error,
                 "limit the automatic tolerance to a quarter of this share of the diagonal")
      ->check(positive_number())
      ->type_name("E");
  app.add_flag("--keep-boundary", o.keep_boundary, "move no point of the border when features are removed");
  app.add_flag("--merge-auto", o.merge_auto,
               "merge patches that are tangent to each other, or smaller than the mesh size");
}

void mark(Io& io, Options& o) {
  parse_angles(o.angles, o);
  if (o.tolerance != "auto" && !parse_length(o.tolerance, 1))
    throw BadUsage("--tolerance: expected auto, a length or a percentage, found '" + o.tolerance + "'");
  if (!o.group_file.empty()) expect_readable(o.group_file);
  if (!o.edge_file.empty() && o.edge_file != "none") expect_readable(o.edge_file);
  Stream& stream = io.read();
  Surface& surface = stream.surface;
  const bool asked = o.size > 0 || o.triangles > 0;
  if (o.triangles == 0)
    o.triangles = stream.input_triangles > 0 ? stream.input_triangles : (double)surface.tris.size();
  const double length = o.size > 0 ? o.size : size_for_count(total_area(surface), o.triangles);
  if (asked) o.size = length;
  std::vector<int> opposite;
  Flips flips;  // charts, and vertices in the middle of edges, do not follow
  if (o.edge_file.empty() && parse_length(o.tolerance, 1) != 0.0 && !surface.face.has("origin") &&
      !stream.find("chart_vertex") && !stream.find("mid_vertex")) {
    const std::vector<int> lines = segments_under(surface, read_model_edges(stream));
    opposite = opposite_halfedges(surface);
    flips = flip_caps_and_folds({surface, opposite}, lines,
                                fold_share * tolerance_of(o, length, diagonal(surface)));
  }
  report_flips(io, flips);
  DefeatureReport unfolded;
  unfolded.moved = flips.moved;
  if (flips.moved > 0) stream.remarks.push_back(remark_of(unfolded));
  std::vector<int> before = surface.face.has("patch") ? surface.face.get<int>("patch") : std::vector<int>();
  CapPatches caps;
  for (const std::string& remark : stream.remarks)
    if (const CapPatches more = parse_caps(remark); more.first <= more.last) caps = more;
  if (caps.first <= caps.last) o.first_cap = caps.first, o.last_cap = caps.last;
  const PatchMerge merge = merge_patches(io, stream, o, length);
  io.report["patches_before"] = merge.patch.size();
  io.report["patches"] = merge.count();
  std::vector<int> given = given_edges(io, stream, o.edge_file);
  if (opposite.empty()) opposite = opposite_halfedges(surface);
  auto features = [&] {
    return mark_features({surface, opposite}, o, before.empty() ? nullptr : &before, &given);
  };
  FeatureReport marked = features();
  // a border that moved would part from those of the other sheets that meet there
  DefeatureOptions narrow{tolerance_of(o, length, diagonal(surface)), o.keep_boundary || has_sheets(stream)};
  const double tolerance = narrow.tolerance;
  const std::vector<int> first_given = given;
  DefeatureReport removed;
  for (int pass = 0; pass < most_removals; ++pass) {
    narrow.tolerance = tolerance - removed.moved;
    if (caps.first <= caps.last && surface.face.has("patch")) narrow.plane = plane_triangles(surface, caps);
    narrow.kept = kept_triangles(stream, o.keep_boundary);
    if (!defeature({surface, opposite}, narrow, before, given, removed)) break;
    o.again = true;
    marked = features();
  }
  std::stable_sort(removed.removed.begin(), removed.removed.end(),
                   [](const RemovedFeature& a, const RemovedFeature& b) { return a.width > b.width; });
  sort_unique(removed.vanished);
  report_removed(io, removed, tolerance, stream);
  io.report["patches"] = merge.count() - (int)removed.vanished.size();  // what is removed is known by now
  if (!removed.removed.empty()) follow_removal(stream, removed, first_given, given);
  report(io, marked);
  io.write(stream);
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  return run_tool(
      argc, argv, "mfeature",
      "Mark model edges: patch borders and creases."
      "\n\nexamples:\n  mclean tree.stl | mfeature --triangles 20000 -o tree.ply\n"
      "  mclean tree.stl | mfeature --feature-angle 40,20 -o creases.ply",
      [&](CLI::App& app) { add_options(app, o); }, [&](Io& io) { mark(io, o); });
}
