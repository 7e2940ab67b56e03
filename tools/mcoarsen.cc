// SPDX-License-Identifier: BSD-3-Clause
// mcoarsen: coarsen a surface that has many times the triangles of the mesh to be made.
#include <utility>

#include "formats/stream/lift_tables.h"
#include "formats/stream/model_edges.h"
#include "formats/stream/region_tables.h"
#include "formats/stream/stages.h"
#include "lib/core/coarsen.h"
#include "lib/core/take_rows.h"
#include "lib/core/topology.h"
#include "lib/lines/lines.h"
#include "tools/common.h"

using namespace meshpipe;

namespace {

constexpr double most_per_triangle = 6;   ///< of the mesh: a surface of more is coarsened to two or three,
constexpr int few_triangles = 100000;     ///< unless it has no more than these: nothing is gained
constexpr double edge_share = 1;          ///< of the size: the longest edge of the coarse surface
constexpr double deviation_share = 0.02;  ///< of the size: less than what mfeature removes
constexpr double most_turn = 25 * degree;

struct Options {
  double size = 0, triangles = 0;
  bool keep_border = false;
};

/// Returns why a surface is left as it is; "" if it is to be coarsened. `triangles`: of the mesh, 0: unknown.
std::string reason_to_leave(const Stream& stream, double triangles) {
  const int n = (int)stream.surface.tris.size();
  if (stream.find("ref_vertex")) return "it is a mesh already";
  if (!(triangles > 0)) return "no size is asked for";
  if (n <= std::max<double>(few_triangles, most_per_triangle * triangles))
    return std::to_string(n) + " triangles for about " + std::to_string((long long)triangles);
  if (has_sheets(stream)) return "it has sheets that meet";
  if (!read_model_edges(stream).tris.empty()) return "it has lines with labels";
  return "";
}

/// Flags the vertices that stay: corners of the model, and on request all of the border.
std::vector<char> fixed_vertices(const CutSurface& cut, double size, bool border) {
  Surface& s = cut.surface;
  Table vertex = std::exchange(s.vertex, {"vertex", s.points.size(), {}});  // may have other sizes
  s.vertex.set("size", std::vector<double>(s.points.size(), size));
  s.face.set("part", std::vector<int>(s.tris.size(), 0));
  std::vector<char> fixed = model_corners(s);
  s.vertex = std::move(vertex);
  s.face.erase("part");
  const Connectivity c = cut.connectivity();
  for (int h = 0; border && h < c.n_half_edges(); ++h)
    if (c.is_border(h)) fixed[c.from(h)] = fixed[c.to(h)] = 1;
  return fixed;
}

/// Returns the coarse surface for a mesh of this size, with the columns of its vertices and triangles.
Surface coarse_surface(Surface& s, double size, bool keep_border) {
  std::vector<int> opposite = opposite_halfedges(s);
  Coarse coarse = coarsen({s, opposite, model_of(s)}, 0,
                          {most_turn, edge_share * size, deviation_share * size,
                           fixed_vertices({s, opposite}, size, keep_border)});
  Surface r;
  r.points = std::move(coarse.points);
  r.tris = std::move(coarse.tris);
  r.vertex = rows_of(s.vertex, coarse.vertex);
  r.face = rows_of(s.face, coarse.face);
  if (!coarse.model.empty()) r.face.set("model", std::move(coarse.model));
  return r;
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
    const std::string reason = reason_to_leave(stream, o.triangles);
    if (!reason.empty()) {
      io.say("left as it is: " + reason);
      return io.write(stream);
    }
    drop_downstream(stream, Stage::parts);
    for (const char* table : {"part", "line", "line_use", "line_vertex"}) stream.erase(table);
    for (const char* column : {"part", "origin"}) surface.face.erase(column);
    const std::size_t before = surface.tris.size();
    Surface coarse = coarse_surface(surface, size_for_count(area, o.triangles), o.keep_border);
    if (!stream.find("fine_vertex")) write_fine(stream, surface);
    surface = std::move(coarse);
    io.say(std::to_string(before) + " triangles -> " + std::to_string(surface.tris.size()) +
           ", to make the mesh on");
    io.report["triangles_before"] = before;
    io.report["triangles"] = surface.tris.size();
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
