// SPDX-License-Identifier: BSD-3-Clause
// mrelax: optimise a lifted mesh on its reference surface, across interfaces that are not model edges.
#include "formats/lift_tables.h"
#include "formats/line_tables.h"
#include "lib/relax.h"
#include "tools/common.h"

using namespace meshpipe;

int main(int argc, char** argv) {
  RelaxOptions options;
  auto add_options = [&](CLI::App& app) {
    app.add_option("--sweeps", options.sweeps, "rounds of flips, moves and count keeping (default 6)")
        ->check(CLI::Range(0, 1000))
        ->type_name("N");
  };
  auto body = [&](Io& io) {
    Stream stream = io.read();
    LiftedMesh mesh = read_lifted(stream);
    const Surface reference = read_reference(stream);
    const Lines lines = read_lines(stream);
    std::vector<int> kinds;
    for (const Line& l : lines.lines) {
      kinds.push_back(l.kind);
      options.keep_border = options.keep_border || l.kept;
    }
    const RelaxReport r = relax(mesh, reference, kinds, line_corners(reference, lines), options);
    write_lifted(stream, mesh);
    char text[200];
    std::snprintf(text, sizeof text,
                  "%zu triangles, kappa mean %.4f, min %.3f (%d splits, %d collapses, %d flips)",
                  mesh.tris.size(), r.kappa_mean, r.kappa_min, r.splits, r.collapses, r.flips);
    io.say(text);
    io.report["triangles"] = mesh.tris.size();
    io.report["kappa_mean"] = r.kappa_mean;
    io.report["kappa_min"] = r.kappa_min;
    io.report["splits"] = r.splits;
    io.report["collapses"] = r.collapses;
    io.report["flips"] = r.flips;
    io.report["intersections"] = r.intersections.size();
    io.write(stream);
  };
  return run_tool(
      argc, argv, "mrelax",
      "Optimise a lifted mesh on the surface it came from: flip, collapse, split and move vertices over that "
      "surface, across every interface that is not a model edge.\n\n"
      "example:\n  mremesh --keep stages tree.stl -o tree-mesh.stl && mrelax --sweeps 20 stages/10-lift.ply "
      "-o relaxed.ply",
      add_options, body);
}
