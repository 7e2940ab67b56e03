// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <charconv>

#include "formats/groups.h"
#include "formats/model_edges.h"
#include "formats/stages.h"
#include "lib/feature.h"
#include "lib/merge.h"
#include "lib/size.h"
#include "tools/common.h"

using namespace meshpipe;

namespace {

/// auto, none, A or A,B in degrees; throws BadUsage.
void parse_angles(const std::string& text, FeatureOptions& options) {
  if (text == "auto") return;
  options.mode = FeatureOptions::none;
  if (text == "none") return;
  options.mode = FeatureOptions::angles;
  const char *at = text.data(), *end = at + text.size();
  auto [after, error] = std::from_chars(at, end, options.strong);
  options.weak = options.strong / 2;
  if (error == std::errc() && after < end && *after == ',') {
    auto second = std::from_chars(after + 1, end, options.weak);
    after = second.ptr;
    error = second.ec;
  }
  if (error != std::errc() || after != end ||
      !(0 < options.weak && options.weak <= options.strong && options.strong < 180))
    throw BadUsage("--feature-angle " + text + " is not auto, none, A or A,B with 0 < B <= A < 180 degrees");
}

constexpr double tangent = 20 * 3.14159265358979324 / 180;  ///< patches that meet at less are tangent

/// Gives the faces the patches that theirs have become, and the patches the names of their groups.
void relabel(const Io& io, Stream& stream, const PatchMerge& merge, const std::vector<PatchGroup>& groups) {
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

}  // namespace

int main(int argc, char** argv) {
  FeatureOptions options;
  std::string angles = "auto";
  std::string group_file, edge_file;
  bool merge_auto = false;
  double triangles = 0;
  return run_tool(
      argc, argv, "mfeature",
      "Mark model edges: patch borders and creases."
      "\n\nexamples:\n  mclean tree.stl | mfeature --triangles 20000 -o tree.ply\n"
      "  mclean tree.stl | mfeature --feature-angle 40,20 -o creases.ply",
      [&](CLI::App& app) {
        app.add_option("--feature-angle", angles,
                       "auto: creases that look designed; A,B: edges above A degrees, and above B where they "
                       "go on; none")
            ->type_name("auto|A[,B]|none");
        auto* size = app.add_option("--size", options.size, "target edge length")
                         ->check(positive_number())
                         ->type_name("H");
        app.add_option("--triangles", triangles, "target number of triangles")
            ->check(positive_number())
            ->excludes(size)
            ->type_name("N");
        app.add_option("--merge", group_file, "make one patch of each group of patches in this file")
            ->type_name("FILE");
        app.add_option("--edges", edge_file,
                       "the lines of this mesh are model edges too; none: nor are those of the input's file")
            ->type_name("FILE|none");
        app.add_flag("--merge-auto", merge_auto,
                     "merge patches that are tangent to each other, or smaller than the mesh size");
      },
      [&](Io& io) {
        parse_angles(angles, options);
        Stream stream = io.read();
        Surface& surface = stream.surface;
        const bool asked = options.size > 0 || triangles > 0;
        if (triangles == 0)
          triangles = stream.input_triangles > 0 ? stream.input_triangles : (double)surface.tris.size();
        const double length =
            options.size > 0 ? options.size : size_for_count(total_area(surface), triangles);
        if (asked) options.size = length;
        PatchMerge merge = no_merge(surface);
        std::vector<int> before;
        if (surface.face.has("patch")) before = surface.face.get<int>("patch");
        if (!before.empty() && (merge_auto || !group_file.empty())) {
          std::vector<PatchGroup> groups;
          if (!group_file.empty()) groups = read_groups(Io::read_bytes(group_file), group_file, stream);
          std::vector<std::vector<int>> members;
          for (const PatchGroup& g : groups) members.push_back(g.patches);
          merge_groups(merge, members);
          if (merge_auto) merge_automatically(merge, surface, length, tangent);
          relabel(io, stream, merge, groups);
          io.say(std::to_string(merge.patch.size()) + " patches merged to " + std::to_string(merge.count()));
        }
        io.report["patches_before"] = merge.patch.size();
        io.report["patches"] = merge.count();
        ModelSegments lines = edge_file == "none" ? ModelSegments() : read_model_edges(stream);
        const std::size_t n_own = lines.tris.size();
        if (!edge_file.empty() && edge_file != "none") append(lines, segments_of(io.read(edge_file)));
        drop_downstream(stream, Stage::features);
        write_model_edges(stream, lines);
        std::vector<char> given(3 * surface.tris.size());
        const std::vector<int> under = segments_under(surface, lines);
        std::vector<char> used(lines.tris.size());
        for (std::size_t h = 0; h < given.size(); ++h)
          if (under[h] >= 0) given[h] = used[under[h]] = 1;
        if (const std::size_t n = lines.tris.size() - n_own; !edge_file.empty() && edge_file != "none")
          io.say(edge_file + ": " + std::to_string(n) + " lines" +
                 (n ? ", " + std::to_string(std::count(used.begin() + n_own, used.end(), 1)) +
                          " of them under edges of the surface"
                    : ""));
        const FeatureReport r = mark_features(surface, options, before.empty() ? nullptr : &before, &given);
        io.say(std::to_string(r.model_edges) + " model edges: " + std::to_string(r.patch_edges) +
               " between patches, " +
               (r.given_edges ? std::to_string(r.given_edges) + " given, " : std::string()) +
               std::to_string(r.crease_edges) + " on creases; " + std::to_string(r.corners) + " corners");
        if (r.slivers > 0)
          io.say(std::to_string(r.slivers) +
                 " triangles thinner than a fiftieth of the size make no creases of their own");
        io.report["slivers"] = r.slivers;
        io.report["model_edges"] = r.model_edges;
        io.report["patch_edges"] = r.patch_edges;
        io.report["given_edges"] = r.given_edges;
        io.report["crease_edges"] = r.crease_edges;
        io.report["corners"] = r.corners;
        io.write(stream);
      });
}
