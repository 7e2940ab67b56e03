// SPDX-License-Identifier: BSD-3-Clause
// mcoarsen: coarsen a surface that has many times the triangles of the mesh to be made.
#include <cmath>
#include <optional>

#include "formats/stream/lift_tables.h"
#include "formats/stream/model_edges.h"
#include "formats/stream/region_tables.h"
#include "formats/stream/stages.h"
#include "lib/core/number.h"
#include "lib/core/triangle_count.h"
#include "tools/common.h"

using namespace meshpipe;

namespace {

constexpr double most_per_triangle = 6;  ///< of the mesh: a surface of more is coarsened to two or three,
constexpr int few_triangles = 20000;     ///< unless it has no more than these

struct Options {
  double size = 0, triangles = 0;
  bool keep_border = false;
};

/// Returns why a surface is left as it is; "" if it is to be coarsened. `triangles`: of the mesh, 0: unknown.
std::string reason_to_leave(const Stream& stream, double triangles) {
  const int n = (int)stream.surface.tris.size();
  if (stream.find("ref_vertex")) return "it is a mesh already";
  if (!(triangles > 0)) return "no size is given that holds everywhere";
  if (n <= std::max<double>(few_triangles, most_per_triangle * triangles))
    return std::to_string(n) + " triangles for about " + shown(std::round(triangles));
  if (has_sheets(stream)) return "it has sheets that meet";
  if (!read_model_edges(stream).tris.empty()) return "it has lines with labels";
  return "";
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  auto add_options = [&](CLI::App& app) {
    auto* size = app.add_option("--size", o.size, "target edge length of the mesh to be made")
                     ->check(positive_number())
                     ->type_name("H");
    app.add_option("--triangles", o.triangles, "its number of triangles")
        ->check(count_between(1, 715827882))
        ->excludes(size)
        ->type_name("N");
    app.add_flag("--keep-boundary", o.keep_border, "keep the points of the border");
  };
  auto body = [&](Io& io) {
    Stream& stream = io.read();
    Surface& surface = stream.surface;
    const double area = total_area(surface);
    if (o.size > 0) o.triangles = area / (0.25 * std::sqrt(3.0) * o.size * o.size);
    std::string reason = reason_to_leave(stream, o.triangles);
    std::optional<Surface> coarse;
    if (reason.empty())
      coarse = coarse_surface(surface, size_for_count(area, o.triangles), o.keep_border, reason);
    if (!coarse) {
      io.say("left as it is: " + reason);
      return io.write(stream);
    }
    const std::size_t before = surface.tris.size(), after = coarse->tris.size();
    drop_downstream(stream, Stage::parts);
    for (const char* table : {"part", "line", "line_use", "line_vertex"}) stream.erase(table);
    for (const char* column : {"part", "origin"}) coarse->face.erase(column);
    if (!stream.find("fine_vertex")) write_fine(stream, surface);
    surface = std::move(*coarse);
    io.say(std::to_string(before) + " triangles -> " + std::to_string(after) + ", to make the mesh on");
    io.report["triangles_before"] = before;
    io.report["triangles"] = after;
    io.write(stream);
  };
  return run_tool(argc, argv, "mcoarsen",
                  "Coarsen a surface that has many times the triangles of the mesh to be made. The stream "
                  "keeps the surface as it was, and mlift puts the mesh on it.\n\n"
                  "Examples:\n"
                  "  mclean tree.stl | mtopo | mfeature | mcoarsen --triangles 2000 -o coarse.ply\n"
                  "  mclean tree.stl | mcoarsen --triangles 2000 | mconvert - -o coarse.stl",
                  add_options, body);
}
