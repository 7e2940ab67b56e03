// SPDX-License-Identifier: BSD-3-Clause
// mlines: divide borders, model edges and interfaces between parts by the size
// field.
#include <algorithm>

#include "formats/stream/line_tables.h"
#include "formats/stream/model_edges.h"
#include "formats/stream/region_tables.h"
#include "formats/stream/stages.h"
#include "lib/size/size.h"
#include "tools/common.h"

using namespace meshpipe;

namespace {

/// Throws: NotAdmissible if a program before this one has removed points of the border, or may have.
void expect_given_border(const Stream& stream) {
  const bool removed = std::any_of(stream.remarks.begin(), stream.remarks.end(), [](const auto& remark) {
    return remark.starts_with("removed ") && !remark.starts_with("removed 0 ");
  });
  for (const Provenance& p : stream.history)
    if (((p.program == "mfeature" && removed) || (p.program == "mcoarsen" && stream.find("fine_vertex"))) &&
        p.arguments.find("--keep-boundary") == p.arguments.npos)
      throw NotAdmissible("the border may have changed; run " + p.program + " with --keep-boundary");
}

}  // namespace

int main(int argc, char** argv) {
  bool keep_boundary = false;
  auto body = [&](Io& io) {
    Stream& stream = io.read();
    const Table& vertex = stream.surface.vertex;
    if (vertex.has("size"))
      refuse_more_triangles(stream.surface, vertex.get<double>("size"), most_triangles());
    if (keep_boundary) expect_given_border(stream);
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
