// SPDX-License-Identifier: BSD-3-Clause
// mlines: divide borders, model edges and interfaces between parts by the size
// field.
#include "formats/stream/line_tables.h"
#include "formats/stream/model_edges.h"
#include "formats/stream/region_tables.h"
#include "formats/stream/stages.h"
#include "lib/size/size.h"
#include "tools/common.h"

using namespace meshpipe;

int main(int argc, char** argv) {
  bool keep_boundary = false;
  auto body = [&](Io& io) {
    Stream& stream = io.read();
    const Table& vertex = stream.surface.vertex;
    if (vertex.has("size"))
      refuse_more_triangles(stream.surface, vertex.get<double>("size"), most_triangles());
    for (const Provenance& p : stream.history)
      if (keep_boundary && stream.find("fine_vertex") && p.program == "mcoarsen" &&
          p.arguments.find("--keep-boundary") == p.arguments.npos)
        throw NotAdmissible("the border was coarsened; run mcoarsen with --keep-boundary");
    const ModelSegments given = read_model_edges(stream);
    std::vector<int> tag = segments_under(stream.surface, given);
    for (int& t : tag) t = t >= 0 ? given.tag[t] : 0;
    const Lines lines =
        make_lines(stream.surface, read_charts(stream), &tag, keep_boundary, has_sheets(stream));
    drop_downstream(stream, Stage::lines);
    write_lines(stream, lines);
    int lines_of[3] = {0, 0, 0}, segments = 0;
    for (const Line& l : lines.lines) {
      ++lines_of[l.kind];
      segments += l.count - 1 + l.closed;
    }
    char text[160];
    std::snprintf(text, sizeof text, "%d border, %d model, %d interface lines in %d segments",
                  lines_of[border_line], lines_of[model_line], lines_of[interface_line], segments);
    io.say(text);
    io.report["border_lines"] = lines_of[border_line];
    io.report["model_lines"] = lines_of[model_line];
    io.report["interface_lines"] = lines_of[interface_line];
    io.report["segments"] = segments;
    io.write(stream);
  };
  return run_tool(
      argc, argv, "mlines",
      "Divide borders, model edges and interfaces between parts into segments of the length that the size "
      "field asks for; no two segments cross in any chart.\n\n"
      "Example:\n  mremesh -q --keep s tree.stl -o a.stl && mlines s/08-size.ply -o lines.ply",
      [&](CLI::App& app) {
        app.add_flag("--keep-boundary", keep_boundary, "keep exactly the input's points on the border");
      },
      body);
}
