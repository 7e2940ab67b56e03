// SPDX-License-Identifier: BSD-3-Clause
// mparam: a one-to-one map of every part to the plane.
#include <algorithm>

#include "formats/line_tables.h"
#include "formats/stages.h"
#include "lib/param.h"
#include "lib/param_svg.h"
#include "lib/topology.h"
#include "tools/common.h"

using namespace meshpipe;

namespace {

const std::map<std::string, MapKind> maps{
    {"conformal", MapKind::conformal}, {"harmonic", MapKind::harmonic}, {"convex", MapKind::convex}};
const std::map<std::string, ConformalForm> forms{{"boundary-first", ConformalForm::boundary_first},
                                                 {"least-squares", ConformalForm::least_squares},
                                                 {"spectral", ConformalForm::spectral}};

template <class T>
std::string name_of(T value, const std::map<std::string, T>& names) {
  for (const auto& [name, meaning] : names)
    if (meaning == value) return name;
  return {};
}

/// Of a conformal map also how it was found.
std::string name_of(const ParamReport& r) {
  return name_of(r.used, maps) + (r.used == MapKind::conformal ? ", " + name_of(r.form, forms) : "");
}

void add_columns(Table& parts, const std::vector<ParamReport>& reports) {
  auto add = [&]<class T>(const char* name, auto value) {
    std::vector<T> column;
    for (const ParamReport& r : reports) column.push_back((T)value(r));
    parts.set<T>(name, std::move(column));
  };
  add.template operator()<int>("map", [](auto& r) { return r.used; });
  add.template operator()<int>("form", [](auto& r) { return r.form; });
  add.template operator()<double>("bend", [](auto& r) { return r.bend; });
  add.template operator()<int>("flips_before", [](auto& r) { return r.flips_before; });
  add.template operator()<int>("flips_after", [](auto& r) { return r.flips_after; });
  add.template operator()<double>("anisotropy_median", [](auto& r) { return r.anisotropy_median; });
  add.template operator()<double>("anisotropy_p99", [](auto& r) { return r.anisotropy_p99; });
  add.template operator()<double>("anisotropy_max", [](auto& r) { return r.anisotropy_max; });
  add.template operator()<double>("area_scale", [](auto& r) { return r.area_scale; });
  add.template operator()<double>("smallest_area", [](auto& r) { return r.smallest_area; });
}

std::string line_of(const ParamReport& r, std::size_t triangles) {
  char text[400];
  std::snprintf(text, sizeof text,
                "%zu triangles, map %s, sigma1/sigma2 median %.3f, p99 %.3f, max %.3g, area scale %.3g, "
                "smallest area %.2e, order %.4f s, factorise %.4f s, solve %.4f s",
                triangles, name_of(r).c_str(), r.anisotropy_median, r.anisotropy_p99, r.anisotropy_max,
                r.area_scale, r.smallest_area, r.time.ordering, r.time.factorisation, r.time.solve);
  std::string line = text;
  if (r.bend > 0) line += ", border bent " + std::to_string((int)std::lround(100 * r.bend)) + " %";
  if (!r.border_was_simple) line += ", border crossed itself before";
  if (r.flips_before)
    line += ", " + std::to_string(r.flips_before) + " flips before, " + std::to_string(r.flips_after) +
            " after repair";
  if (r.steps) line += ", " + std::to_string(r.steps) + " steps of optimisation";
  return line;
}

nlohmann::ordered_json record_of(const ParamReport& r, int part, std::size_t triangles) {
  return {{"part", part},
          {"triangles", triangles},
          {"map", name_of(r.used, maps)},
          {"form", r.used == MapKind::conformal ? name_of(r.form, forms) : ""},
          {"bend", r.bend},
          {"flips_before", r.flips_before},
          {"flips_after", r.flips_after},
          {"border_was_simple", r.border_was_simple},
          {"steps", r.steps},
          {"anisotropy_mean", r.anisotropy_mean},
          {"anisotropy_median", r.anisotropy_median},
          {"anisotropy_p99", r.anisotropy_p99},
          {"anisotropy_max", r.anisotropy_max},
          {"area_scale", r.area_scale},
          {"smallest_area", r.smallest_area},
          {"seconds_ordering", r.time.ordering},
          {"seconds_factorisation", r.time.factorisation},
          {"seconds_solve", r.time.solve}};
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
    name("--map", options.map, maps, "conformal (default), harmonic or convex");
    name("--conformal", options.form, forms, "how: boundary-first (default), least-squares or spectral");
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
    app.add_option("--svg", svg, "draw the charts, coloured by area scale")
        ->type_name("FILE")
        ->group("Reports");
  };
  auto body = [&](Io& io) {
    if (!svg.empty()) io.expect_report("--svg", svg);
    Stream stream = io.read();
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
    add_columns(parts, reports);
    drop_downstream(stream, Stage::charts);
    stream.set(std::move(parts));
    write_charts(stream, charts);

    double median = 1, p99 = 1, smallest = 1;
    int other = 0, repaired = 0;
    io.report["parts"] = n_parts;
    io.report["cut"] = n_parts - n_before;
    io.report["charts"] = nlohmann::ordered_json::array();
    for (int p = 0; p < n_parts; ++p) {
      const ParamReport& r = reports[p];
      io.detail("part " + std::to_string(p) + ": " + line_of(r, charts[p].mesh.tris.size()));
      io.report["charts"].push_back(record_of(r, p, charts[p].mesh.tris.size()));
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
    if (!svg.empty()) Io::write_file(svg, charts_svg(charts, reports));
    io.write(stream);
  };
  return run_tool(
      argc, argv, "mparam",
      "Map every part to the plane, one-to-one: conformal, or harmonic or convex where that fails.\n\n"
      "example:\n  mclean tree.stl | mtopo | mfeature | mpartition | mmultiscale | mparam -o charts.ply",
      add_options, body);
}
