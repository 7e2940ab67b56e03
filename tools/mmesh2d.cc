// SPDX-License-Identifier: BSD-3-Clause
// mmesh2d: mesh every chart in the plane under the metric of its map.
#include <cmath>
#include <ctime>
#include <filesystem>
#include <map>

#include "formats/stream/line_tables.h"
#include "formats/stream/plane_tables.h"
#include "formats/stream/shards.h"
#include "lib/core/number.h"
#include "lib/core/parallel.h"
#include "lib/core/progress.h"
#include "lib/size/size.h"
#include "tools/common.h"
#include "tools/report/chart_svg.h"
#include "tools/shard_files.h"

using namespace meshpipe;

// The size at the vertices of a chart.
static std::vector<double> sizes_of(const Chart& chart, const std::vector<double>& size) {
  std::vector<double> h;
  for (int v : chart.mesh.vertex) {
    if (!(size[v] > 0)) throw NotAdmissible("vertex " + std::to_string(v) + " has size " + shown(size[v]));
    h.push_back(size[v]);
  }
  return h;
}

// A picture of each chart in a directory, which is made if it is not there.
static void draw(const std::string& directory, const std::vector<Chart>& charts,
                 const std::vector<PlaneMesh>& meshes) {
  std::error_code no;
  std::filesystem::create_directories(directory, no);
  if (no) throw CannotWrite(directory + ": " + no.message());
  for (std::size_t part = 0; part < charts.size(); ++part) {
    const std::string number = std::to_string(part);
    Io::write_file(
        directory + "/chart-" + std::string(number.size() < 4 ? 4 - number.size() : 0, '0') + number + ".svg",
        chart_svg(charts[part], meshes[part], "part " + number));
  }
}

// Adds the meshes that were made of shards.
static void join(Io& io, Stream& stream, const std::vector<std::string>& shards) {
  join_shards(stream, shards, {io.program, "", io.arguments},
              [&](const std::string& name) { return io.read(name); });
  io.say(std::to_string(shards.size()) + " shards joined");
  io.report["shards"] = shards.size();
  io.write(stream);
}

static const std::map<std::string, Mesher> meshers = {
    {"frontal", Mesher::frontal}, {"delaunay", Mesher::delaunay}, {"meshadapt", Mesher::meshadapt}};

int main(int argc, char** argv) {
  std::string mesher = "frontal", pictures, from;
  auto options = [&](CLI::App& app) {
    app.add_option("--mesher", mesher, "frontal (default), delaunay or meshadapt")
        ->check(CLI::IsMember(meshers));
    auto* shards = add_join_option(app, from);
    app.add_option("--svg", pictures,
                   "draw the map and the mesh of each chart, as SVG pictures in this directory")
        ->check([](const std::string& s) { return s.empty() ? "needs a value" : ""; })
        ->type_name("DIR")
        ->group("Reports")
        ->excludes(shards);
  };
  auto body = [&](Io& io) {
    Stream& stream = io.read();
    if (!from.empty()) return join(io, stream, shards_in(from));
    std::vector<Chart> charts = read_charts(stream);
    const Lines lines = read_lines(stream);
    if (!stream.surface.vertex.has("size"))
      throw NotAdmissible("no column 'size' in table 'vertex'; run msize first");
    const auto& size = stream.surface.vertex.get<double>("size");
    refuse_unresolved_sizes(stream.surface, size);
    refuse_more_triangles(stream.surface, size, most_triangles());

    const std::clock_t start = std::clock();
    const int n = (int)charts.size();
    std::vector<PlaneMesh> meshes(n);
    const PartLines parts(lines, n);
    const std::vector<char> keep = kept_vertices(stream);
    parallel_for(n, [&](int part) {
      index_chart(charts[part]);
      meshes[part] =
          mesh_chart(charts[part], sizes_of(charts[part], size), parts, part, meshers.at(mesher), keep);
      if (pictures.empty()) charts[part].opposite = {};
      charts[part].grid = {};
      add_progress((double)charts[part].mesh.tris.size() / (double)stream.surface.tris.size());
    });
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;

    std::size_t points = 0, triangles = 0;
    for (const PlaneMesh& m : meshes) {
      points += m.points.size();
      triangles += m.tris.size();
    }
    io.say(std::to_string(n) + " charts, " + std::to_string(points) + " points, " +
           std::to_string(triangles) + " triangles");
    if (seconds > 0)
      io.detail(std::to_string(std::lround(triangles / seconds)) + " triangles per second of a core");
    io.report["charts"] = n;
    io.report["points"] = points;
    io.report["triangles"] = triangles;
    if (!pictures.empty()) draw(pictures, charts, meshes);
    write_plane_meshes(stream, charts, meshes);
    if (is_shard(stream)) keep_made(stream, {"line_vertex", "chart_point", "chart_face"});
    io.write(stream);
  };
  return run_tool(
      argc, argv, "mmesh2d",
      "Mesh every chart in the plane with triangles that have the requested size on the surface.\n\n"
      "Examples:\n  mremesh -q --keep s tree.stl -o a.stl && mmesh2d s/09-lines.ply -o plane.ply\n"
      "  mclean tree.stl | mpartition | mmultiscale | mparam | msize | mlines | mmesh2d -o plane.ply",
      options, body);
}
