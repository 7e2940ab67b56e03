// SPDX-License-Identifier: BSD-3-Clause
// mmultiscale: cut every part of large aspect ratio in two, through the levels of its Laplace maps.
#include <algorithm>
#include <filesystem>

#include "formats/stream/part_table.h"
#include "formats/stream/stages.h"
#include "lib/core/cut.h"
#include "lib/core/number.h"
#include "lib/core/topology.h"
#include "lib/multiscale/multiscale.h"
#include "lib/partition/partition.h"
#include "lib/plan/plan.h"
#include "tools/common.h"
#include "tools/report/level_svg.h"

using namespace meshpipe;

namespace {

/// Every cut's levels as pictures in a directory.
void draw_levels(const std::string& directory, const std::vector<MultiscaleCut>& cuts) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw CannotWrite(directory + ": " + error.message());
  for (std::size_t c = 0; c < cuts.size(); ++c) {
    const CutMaps& maps = cuts[c].maps;
    const std::string stem = "cut-" + std::to_string(c);
    std::vector<std::string> files = level_names(maps.levels);
    for (std::size_t l = 0; l < files.size(); ++l) {
      files[l] = stem + "-level-" + files[l] + ".svg";
      Io::write_file(directory + "/" + files[l], level_svg(maps, l));
    }
    Io::write_file(directory + "/" + stem + ".svg", levels_svg(maps.levels, files));
  }
}

/// Reports every cut, and the parts that no cut makes short enough.
void report_cuts(Io& io, const MultiscaleOptions& options, const std::vector<MultiscaleCut>& cuts,
                 const std::vector<Topology>& topology) {
  io.report["cuts"] = nlohmann::ordered_json::array();
  for (const MultiscaleCut& c : cuts) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "part %d: aspect ratio %.2f, %d levels, cut of %.3g diagonals, now parts %d and %d", c.part,
                  c.eta, c.levels, c.length, c.halves[0], c.halves[1]);
    io.say(text);
    io.report["cuts"].push_back({{"part", c.part},
                                 {"eta", c.eta},
                                 {"levels", c.levels},
                                 {"length", c.length},
                                 {"halves", {c.halves[0], c.halves[1]}}});
  }
  for (std::size_t p = 0; p < topology.size(); ++p)
    if (topology[p].eta_geo > options.max_aspect)
      io.say("part " + std::to_string(p) + " keeps aspect ratio " + shown(topology[p].eta_geo) +
             ": no cut makes it shorter");
}

/// Reports how long and how straight the interfaces are.
void report_interfaces(Io& io, int n_parts, const Interfaces& cut) {
  char text[200];
  std::snprintf(text, sizeof text,
                "%d %s, cut of %.3g diagonals, %d junctions, turning angle %.1f (90 %%), %.0f at most",
                n_parts, n_parts == 1 ? "part" : "parts", cut.length, cut.junctions, cut.turning_angle,
                cut.largest_angle);
  io.say(text);
  io.report["cut_length"] = cut.length;
  io.report["junctions"] = cut.junctions;
  io.report["turning_angle"] = cut.turning_angle;
  io.report["largest_angle"] = cut.largest_angle;
}

}  // namespace

int main(int argc, char** argv) {
  MultiscaleOptions options;
  std::string directory;
  auto add_options = [&](CLI::App& app) {
    app.add_option("--max-aspect", options.max_aspect,
                   "cut parts with a larger geodesic aspect ratio (default 4)")
        ->check(CLI::Range(0.5, 1e6))
        ->type_name("ETA");
    app.add_option("--levels", directory, "draw the maps of all levels, as SVG pictures in this directory")
        ->type_name("DIR")
        ->group("Reports");
  };
  auto body = [&](Io& io) {
    options.keep_maps = !directory.empty();
    Stream& stream = io.read();
    if (!stream.surface.face.has("part")) throw NotAdmissible("no face column 'part'; run mpartition first");
    const int given = count_parts(stream.surface);  // refuses what no partition has
    std::vector<MultiscaleCut> cuts;
    std::vector<Topology> topology = known_parts(stream.surface, given, stream.find("part"));
    if (std::any_of(topology.begin(), topology.end(), [](const Topology& t) { return t.faces == 0; }))
      topology.clear();
    std::vector<int> opposite;
    const int n_parts = multiscale_cut(stream.surface, options, &cuts, &topology, &opposite);
    if (options.keep_maps) draw_levels(directory, cuts);
    name_origins(stream.surface);
    io.report["parts"] = n_parts;
    report_cuts(io, options, cuts, topology);
    report_interfaces(io, n_parts,
                      measure_interfaces({stream.surface, opposite, model_of(stream.surface)},
                                         stream.surface.face.get<int>("part")));
    drop_downstream(stream, Stage::parts);
    stream.set(part_table(topology));
    io.write(stream);
  };
  return run_tool(
      argc, argv, "mmultiscale",
      "Cut every part that is too long to be mapped into two, along a line through all of its holes.\n\n"
      "Example:\n  mclean tree.stl | mtopo | mfeature | mpartition | mmultiscale -o parts.ply",
      add_options, body);
}
