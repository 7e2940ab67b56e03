// SPDX-License-Identifier: BSD-3-Clause
// mparam: a one-to-one map of every part to the plane.
#include <algorithm>

#include "formats/stream/line_tables.h"
#include "formats/stream/stages.h"
#include "lib/core/topology.h"
#include "lib/plan/plan.h"
#include "tools/common.h"
#include "tools/report/chart_report.h"
#include "tools/report/charts_svg.h"

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
    const bool as_asked = r.used == options.map && (r.used != MapKind::conformal || r.form == options.form);
    other += !as_asked;
    repaired += as_asked && (r.flips_before > 0 || !r.border_was_simple);
  }
  char text[300];
  std::snprintf(text, sizeof text,
                "%d charts, %d cut here, %d repaired, %d on another map than asked for; worst "
                "sigma1/sigma2 median %.3f, "
                "p99 %.3f, smallest area %.2e",
                n_parts, n_parts - n_before, repaired, other, median, p99, smallest);
  io.say(text);
}

}  // namespace

int main(int argc, char** argv) {
  ParamOptions options;
  std::string svg;
  auto add_options = [&](CLI::App& app) {
    auto name = [&]<class T>(const char* option, T& value, std::map<std::string, T> names, const char* help) {
      std::vector<std::string> words;
      for (const auto& [word, meaning] : names) words.push_back(word);
      app.add_option_function<std::string>(
             option, [&value, names](const std::string& word) { value = names.at(word); }, help)
          ->check(CLI::IsMember(words))
          ->type_name("NAME");
    };
    name("--map", options.map, map_names(), "conformal (default), harmonic or convex");
    name("--conformal", options.form, form_names(),
         "how: boundary-first (default), least-squares or spectral");
    name("--weights", options.weights,
         std::map<std::string, Weights>{{"cotangent", Weights::cotangent},
                                        {"mean-value", Weights::mean_value},
                                        {"uniform", Weights::uniform}},
         "of the convex map: cotangent (clamped, default), mean-value or uniform");
    name("--boundary", options.neumann, std::map<std::string, bool>{{"filled", false}, {"neumann", true}},
         "holes: filled (default) in the solve, or left to the natural condition (neumann)");
    app.add_option("--optimize", options.optimize, "at most N steps that lower distortion (SLIM)")
        ->check(CLI::Range(0, 10000))
        ->type_name("N");
    app.add_flag("--strict", options.strict,
                 "no repair, no other map, no cut: fail (5) if a map is not one-to-one");
    app.add_option("--svg", svg, "draw the charts, colored by area scale")
        ->type_name("FILE")
        ->group("Reports");
  };
  auto body = [&](Io& io) {
    if (!svg.empty()) io.expect_report("--svg", svg);
    Stream& stream = io.read();
    Surface& surface = stream.surface;
    if (!surface.face.has("part")) throw NotAdmissible("no face column 'part'; run mpartition first");
    const int n_before = count_parts(surface);
    std::size_t faces_before = surface.tris.size();

    std::vector<ParamReport> reports;
    std::vector<Chart> charts = map_surface(surface, n_before, options, reports);
    int n_parts = (int)charts.size();
    const Table* known = stream.find("part");
    Table parts = known && surface.tris.size() == faces_before && n_parts == n_before
                      ? *known
                      : part_table(surface, n_parts);
    add_chart_columns(parts, reports);
    drop_downstream(stream, Stage::charts);
    stream.set(std::move(parts));
    write_charts(stream, charts);

    report_charts(io, options, charts, reports, n_before);
    if (!svg.empty()) Io::write_file(svg, charts_svg(charts, reports));
    io.write(stream);
  };
  return run_tool(
      argc, argv, "mparam",
      "Map every part to the plane, one-to-one: conformal, or harmonic or convex where that fails.\n\n"
      "example:\n  mclean tree.stl | mtopo | mfeature | mpartition | mmultiscale | mparam -o charts.ply",
      add_options, body);
}
