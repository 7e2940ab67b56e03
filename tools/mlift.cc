// SPDX-License-Identifier: BSD-3-Clause
// mlift: map the plane meshes back to the surface and glue them along the
// lines.
#include "formats/lift_tables.h"
#include "formats/line_tables.h"
#include "formats/plane_tables.h"
#include "tools/common.h"

using namespace meshpipe;

int main(int argc, char** argv) {
  auto body = [&](Io& io) {
    Stream stream = io.read();
    const std::vector<Chart> charts = read_charts(stream);
    const LiftedMesh mesh =
        lift(stream.surface, charts, read_lines(stream), read_plane_meshes(stream, charts));
    write_reference(stream, stream.surface);
    write_lifted(stream, mesh);
    for (const char* table : {"chart_vertex", "chart_point", "chart_face"}) stream.erase(table);
    io.say(std::to_string(mesh.points.size()) + " vertices, " + std::to_string(mesh.tris.size()) +
           " triangles");
    io.report["vertices"] = mesh.points.size();
    io.report["triangles"] = mesh.tris.size();
    io.write(stream);
  };
  return run_tool(
      argc, argv, "mlift",
      "Map the plane meshes of the charts back to the surface and glue them "
      "along the lines.\n\n"
      "example:\n  mremesh -q --keep stages tree.stl -o tree-mesh.stl && mlift "
      "stages/09-mesh2d.ply -o "
      "lifted.vtu",
      [](CLI::App&) {}, body);
}
