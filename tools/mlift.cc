// SPDX-License-Identifier: BSD-3-Clause
// mlift: map the plane meshes back to the surface and glue them along the lines.
#include "formats/stream/lift_tables.h"
#include "formats/stream/line_tables.h"
#include "formats/stream/plane_tables.h"
#include "tools/common.h"
#include "tools/on_reference.h"

using namespace meshpipe;

namespace {

struct Options {
  bool curved = false;
  int order = 1;
};

/// Names the face data that triangles of another mesh do not have; "" if there are none.
std::string lost_data(const Surface& s) {
  std::string names;
  for (const Column& c : s.face.columns)
    if (c.name != "patch" && c.name != "part" && c.name != "origin" && c.name != "model" &&
        c.name != "curved")
      names += (names.empty() ? "" : ", ") + c.name;
  return names;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  auto add_options = [&](CLI::App& app) {
    app.add_flag("--curved", o.curved,
                 "put the vertices on a smooth surface through the vertices of the input");
    app.add_option("--order", o.order, "2: triangles of second order, with a node in the middle of each edge")
        ->check(CLI::Range(1, 2))
        ->type_name("N");
  };
  auto body = [&](Io& io) {
    Stream& stream = io.read();
    std::vector<Chart> charts = read_charts(stream);
    const std::vector<PlaneMesh> meshes = read_plane_meshes(stream, charts);
    for (const char* table : {"chart_vertex", "chart_point", "chart_face"}) stream.erase(table);
    if (const std::string names = lost_data(stream.surface); !names.empty())
      io.say("face data left out, since the result has other triangles: " + names);
    Lines lines = read_lines(stream);
    LiftedMesh mesh = lift(stream.surface, std::move(charts), lines, meshes);
    Surface reference = std::move(stream.surface);
    if (std::optional<Surface> fine = take_fine(stream)) {
      move_to_fine(mesh, lines, reference, *fine);
      write_lines(stream, lines);
      reference = std::move(*fine);
    }
    reference.face.erase("curved");
    if (o.curved) reference.face.set("curved", std::vector<std::uint8_t>(reference.tris.size(), 1));
    write_reference(stream, reference);
    const std::string exceptions = write_on_reference(stream, std::move(mesh), reference, o.order == 2);
    if (!exceptions.empty()) io.say(exceptions);
    const Mesh& lifted = stream.surface;
    io.say(std::to_string(lifted.points.size()) + " vertices, " + std::to_string(lifted.tris.size()) +
           " triangles");
    io.report["vertices"] = lifted.points.size();
    io.report["triangles"] = lifted.tris.size();
    io.write(stream);
  };
  return run_tool(
      argc, argv, "mlift",
      "Map the plane meshes of the charts back to the surface and glue them "
      "along the lines.\n\n"
      "Examples:\n"
      "  mremesh -q --keep s tree.stl -o a.stl && mlift s/10-mesh2d.ply -o lifted.vtu\n"
      "  mremesh -q --keep s tree.stl -o a.stl && mlift --curved --order 2 s/10-mesh2d.ply -o order-2.vtu",
      add_options, body);
}
