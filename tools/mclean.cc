// SPDX-License-Identifier: BSD-3-Clause
#include "lib/clean.h"
#include "tools/common.h"

using namespace meshpipe;

namespace {

void tell(Io& io, const CleanReport& r, const Surface& surface) {
  const struct {
    const char* key;
    int count;
    const char* what;
  } repairs[] = {
      {"welded", r.welded, "vertices welded with an equal one"},
      {"unreferenced", r.unreferenced, "unreferenced vertices dropped"},
      {"degenerate", r.degenerate, "degenerate triangles removed"},
      {"duplicate", r.duplicate, "duplicate triangles dropped"},
      {"flipped", r.flipped, "triangles turned round"},
      {"nonmanifold_edges", r.nonmanifold_edges, "non-manifold edges split into sheets"},
      {"pinched", r.pinched, "pinched vertices split"},
      {"flat", r.flat, "triangles of zero area left in"},
  };
  const std::string size = std::to_string(surface.points.size()) + " vertices, " +
                           std::to_string(surface.tris.size()) + " triangles";
  if (r.nothing())
    io.say("clean: " + size);
  else
    io.say(std::to_string(r.input_vertices) + " vertices, " + std::to_string(r.input_triangles) +
           " triangles -> " + size);
  io.report["input_vertices"] = r.input_vertices;
  io.report["input_triangles"] = r.input_triangles;
  io.report["vertices"] = surface.points.size();
  io.report["triangles"] = surface.tris.size();
  io.report["clean"] = r.nothing();
  for (const auto& [key, count, what] : repairs) {
    io.report[key] = count;
    if (count) io.say(std::to_string(count) + " " + what);
  }
}

}  // namespace

int main(int argc, char** argv) {
  return run_tool(
      argc, argv, "mclean",
      "Make a triangle soup an oriented manifold, and tell every repair."
      "\n\nExamples:\n  mclean scan.stl -o clean.ply\n  mclean scan.stl | mtopo --require manifold > "
      "/dev/null",
      [](CLI::App&) {},
      [](Io& io) {
        Stream stream = io.read();
        const CleanReport report = clean(stream.surface);
        if (!stream.surface.face.has("patch"))
          stream.surface.face.set("patch", std::vector<int>(stream.surface.tris.size(), 1));
        // whatever was found out about another surface, or by another program, does not hold for this one
        if (stream.input_triangles == 0 || !report.nothing()) {
          stream.tables.clear();
          stream.surface.face.erase("part");
          stream.surface.face.erase("origin");
        }
        stream.input_triangles = (int)stream.surface.tris.size();
        tell(io, report, stream.surface);
        io.write(stream);
      });
}
