// SPDX-License-Identifier: BSD-3-Clause
// mmultiscale: cut every part of large aspect ratio in two, through the levels of its Laplace maps.
#include <algorithm>

#include "lib/multiscale.h"
#include "lib/partition.h"
#include "lib/topology.h"
#include "tools/common.h"

using namespace meshpipe;

int main(int argc, char** argv) {
  MultiscaleOptions options;
  std::string method = "multiscale";
  bool levels = false;
  auto add_options = [&](CLI::App& app) {
    app.add_option("--max-aspect", options.max_aspect,
                   "cut parts with a larger geodesic aspect ratio (default 4)")
        ->check(CLI::Range(0.5, 1e6))
        ->type_name("ETA");
    app.add_option("--method", method, "multiscale (default) or maxcut (not built yet)")
        ->check(CLI::IsMember({"multiscale", "maxcut"}))
        ->type_name("NAME");
    app.add_flag("--levels", levels, "keep the maps of all levels (not built yet)");
  };
  auto body = [&](Io& io) {
    if (method == "maxcut") throw BadUsage("--method maxcut is not built yet");
    if (levels) throw BadUsage("--levels is not built yet");
    Stream stream = io.read();
    if (!stream.surface.face.has("part")) throw NotAdmissible("no face column 'part'; run mpartition first");
    std::vector<MultiscaleCut> cuts;
    const int n_parts = multiscale_cut(stream.surface, options, &cuts);
    if (!stream.surface.face.has("origin")) {
      std::vector<int> same(stream.surface.tris.size());
      for (std::size_t t = 0; t < same.size(); t++) same[t] = t;
      stream.surface.face.set("origin", std::move(same));
    }
    io.report["parts"] = n_parts;
    io.report["cuts"] = nlohmann::ordered_json::array();
    for (const MultiscaleCut& c : cuts) {
      char text[200];
      std::snprintf(text, sizeof text,
                    "part %d: aspect ratio %.2f, %d levels, cut of %.3g diagonals, now parts %d and %d",
                    c.part, c.eta, c.levels, c.length, c.halves[0], c.halves[1]);
      io.say(text);
      io.report["cuts"].push_back({{"part", c.part},
                                   {"eta", c.eta},
                                   {"levels", c.levels},
                                   {"length", c.length},
                                   {"halves", {c.halves[0], c.halves[1]}}});
    }
    const Interfaces cut = measure_interfaces(stream.surface);
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
    stream.set(part_table(stream.surface, n_parts));
    io.write(stream);
  };
  return run_tool(
      argc, argv, "mmultiscale",
      "Cut every part whose aspect ratio is too large to be mapped in two, along a line through all of "
      "its holes.\n\n"
      "example:\n  mclean tree.stl | mtopo | mfeature | mpartition | mmultiscale -o parts.ply",
      add_options, body);
}
