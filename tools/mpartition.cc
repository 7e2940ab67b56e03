// SPDX-License-Identifier: BSD-3-Clause
// mpartition: cut until every part has genus 0 and a boundary.
#include "formats/stream/part_table.h"
#include "formats/stream/stages.h"
#include "lib/core/topology.h"
#include "lib/partition/partition.h"
#include "lib/plan/plan.h"
#include "tools/common.h"

using namespace meshpipe;

int main(int argc, char** argv) {
  PartitionOptions options;
  std::string method = "metis";
  auto add_options = [&](CLI::App& app) {
    app.add_option("--seed", options.seed, "seed of the partitioner (default 1)")
        ->check(CLI::Range(0, 1000000000))
        ->type_name("N");
    app.add_option("--max-faces", options.max_faces,
                   "largest number of triangles of a part (default: 50000 on surfaces of more than 300000, "
                   "else no limit)")
        ->check(CLI::Range(100, 2147483647))
        ->type_name("N");
    app.add_option("--method", method,
                   "metis (default), or homology: also try cuts along short loops around handles, if they "
                   "give fewer parts")
        ->check(CLI::IsMember({"metis", "homology"}))
        ->type_name("NAME");
  };
  auto body = [&](Io& io) {
    options.homology = method == "homology";
    Stream& stream = io.read();
    std::vector<int> opposite;
    const int n_parts = partition_to_disks(stream.surface, options, &opposite);
    const Interfaces cut = measure_interfaces({stream.surface, opposite, model_of(stream.surface)},
                                              stream.surface.face.get<int>("part"));
    char text[200];
    std::snprintf(text, sizeof text, "%d %s, cut of %.3g diagonals, %d junctions, turning angle %.1f (90 %%)",
                  n_parts, n_parts == 1 ? "part" : "parts", cut.length, cut.junctions, cut.turning_angle);
    io.say(text);
    io.report["parts"] = n_parts;
    io.report["cut_length"] = cut.length;
    io.report["junctions"] = cut.junctions;
    io.report["turning_angle"] = cut.turning_angle;
    drop_downstream(stream, Stage::parts);
    stream.set(part_table(
        topology_of_parts({stream.surface, opposite}, stream.surface.face.get<int>("part"), n_parts)));
    io.write(stream);
  };
  return run_tool(argc, argv, "mpartition",
                  "Cut the surface until every part has genus 0 and at least one boundary.\n\n"
                  "Examples:\n  mclean tree.stl | mfeature | mpartition -o parts.ply\n"
                  "  mclean tree.stl | mpartition --max-faces 50000 -o parts.ply",
                  add_options, body);
}
