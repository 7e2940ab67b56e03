// SPDX-License-Identifier: BSD-3-Clause
// mparam: a one-to-one map of every part to the plane.
#include <algorithm>

#include "formats/stream/line_tables.h"
#include "formats/stream/part_table.h"
#include "formats/stream/shards.h"
#include "formats/stream/stages.h"
#include "lib/plan/plan.h"
#include "tools/common.h"
#include "tools/report/chart_report.h"
#include "tools/report/charts_svg.h"
#include "tools/shard_files.h"

using namespace meshpipe;

namespace {

/// Reports every chart, and the worst of them.
void report_charts(Io& io, const ParamOptions& options, const std::vector<Chart>& charts,
                   const std::vector<ParamReport>& reports, int n_before) {
  const int n_parts = (int)charts.size();
  double median = 1, p99 = 1, smallest = 1;
  int other = 0, repaired = 0;
  io.report["parts"] = n_parts;
  io.report["cut"] = n_parts - n_before;
  io.report["charts"] = nlohmann::ordered_json::array();
  for (int p = 0; p < n_parts; ++p) {
    const ParamReport& r = reports[p];
    io.detail("part " + std::to_string(p) + ": " + chart_line(r, charts[p].mesh.tris.size()));
    io.report["charts"].push_back(chart_record(r, p, charts[p].mesh.tris.size()));
    median = std::max(median, r.anisotropy_median);
    p99 = std::max(p99, r.anisotropy_p99);
    smallest = std::min(smallest, r.smallest_area);
    const bool as_asked =
        r.used == options.map && (r.used != MapKind::conformal || (r.form == options.form && r.bend == 0));
    other += !as_asked;
    repaired += as_asked && (r.flips_before > 0 || !r.border_was_simple);
  }
  char text[300];
  std::snprintf(text, sizeof text,
                "%d charts, %d cut here, %d repaired, %d on another map than asked for; worst "
                "sigma1/sigma2 median %.3f, "
                "p99 %.3f, smallest area %.2e",
                n_parts, n_parts - n_before, repaired, other, median, p99, smallest);
  std::string line = text;
  const auto left = std::count_if(charts.begin(), charts.end(), [](const Chart& c) { return c.uv.empty(); });
  if (left > 0) line += "; " + std::to_string(left) + " left to --join";
  io.say(line);
}

/// Returns the maps that the stream has, as map_surface takes them.
std::vector<Chart> known_charts(const Stream& stream, int n_parts) {
  const Table& rows = stream.need("chart_vertex", "mparam");
  std::vector<Chart> charts(n_parts);
  const auto &part = rows.get<int>("part"), &vertex = rows.get<int>("vertex");
  const auto &u = rows.get<double>("u"), &v = rows.get<double>("v");
  for (std::size_t i = 0; i < rows.rows; ++i) {
    if (part[i] < 0 || part[i] >= n_parts) continue;  // of other parts than there are
    charts[part[i]].mesh.vertex.push_back(vertex[i]);
    charts[part[i]].uv.push_back({u[i], v[i]});
  }
  return charts;
}

}  // namespace

int main(int argc, char** argv) {
  ParamOptions options;
  std::string svg, from;
  auto add_options = [&](CLI::App& app) {
    auto name = [&]<class T>(const char* option, T& value, std::map<std::string, T> names, const char* help) {
      std::vector<std::string> words;
      for (const auto& [word, meaning] : names) words.push_back(word);
      app.add_option_function<std::string>(
             option, [&value, names](const std::string& word) { value = names.at(word); }, help)
          ->check(CLI::IsMember(words))
          ->type_name("NAME");
    };
    name("--map", options.map, map_names(), "map to try first: conformal (default), harmonic or convex");
    name("--conformal", options.form, form_names(),
         "method of the conformal map: boundary-first (default), least-squares or spectral");
    name("--weights", options.weights,
         std::map<std::string, Weights>{{"cotangent", Weights::cotangent},
                                        {"mean-value", Weights::mean_value},
                                        {"uniform", Weights::uniform}},
         "of the convex map: cotangent (clamped, default), mean-value or uniform");
    name("--boundary", options.neumann, std::map<std::string, bool>{{"filled", false}, {"neumann", true}},
         "holes: filled (default) in the solve, or left to the natural condition (neumann)");
    app.add_option("--optimize", options.optimize,
                   "lower the distortion of each map by at most N steps (SLIM)")
        ->check(CLI::Range(0, 10000))
        ->type_name("N");
    app.add_flag("--strict", options.strict,
                 "do not repair, replace or cut: fail with status 5 if a map is not one-to-one");
    add_join_option(app, from);
    app.add_option("--svg", svg, "draw all charts, colored by area scale, as an SVG picture")
        ->type_name("FILE")
        ->group("Reports");
  };
  auto body = [&](Io& io) {
    if (!svg.empty()) io.expect_report("--svg", svg);
    Stream& stream = io.read();
    if (!from.empty())
      join_shards(stream, shards_in(from), {io.program, "", io.arguments},
                  [&](const std::string& name) { return io.read(name); });
    if (is_shard(stream)) {
      if (!svg.empty()) throw BadUsage("--svg draws all charts, but this is a shard");
      if (options.map != MapKind::conformal && !options.strict)
        throw NotAdmissible(
            "this is a shard, but maps to the circle first split triangles of the whole surface; try "
            "--strict");
    }
    Surface& surface = stream.surface;
    if (!surface.face.has("part")) throw NotAdmissible("no face column 'part'; run mpartition first");
    const int n_before = count_parts(surface);
    std::size_t faces_before = surface.tris.size();

    std::vector<ParamReport> reports;
    std::vector<Chart> made;
    if (!from.empty()) {
      reports = read_chart_columns(stream.need("part", "mpartition"));
      made = known_charts(stream, n_before);
    }
    std::vector<Chart> charts =
        map_surface(surface, n_before, options, reports, std::move(made), is_shard(stream));
    int n_parts = (int)charts.size();
    const Table* known = stream.find("part");
    Table parts = known && surface.tris.size() == faces_before && n_parts == n_before
                      ? *known
                      : part_table(surface, n_parts, known);
    add_chart_columns(parts, reports);
    drop_downstream(stream, Stage::charts);
    stream.set(std::move(parts));
    write_charts(stream, charts);

    report_charts(io, options, charts, reports, n_before);
    if (!svg.empty()) Io::write_file(svg, charts_svg(charts, reports));
    if (is_shard(stream)) keep_made(stream, {"chart_vertex"});
    io.write(stream);
  };
  return run_tool(
      argc, argv, "mparam",
      "Map every part to the plane, one-to-one: conformal, or harmonic or convex where that fails.\n\n"
      "Example:\n  mclean tree.stl | mtopo | mfeature | mpartition | mmultiscale | mparam -o charts.ply",
      add_options, body);
}
