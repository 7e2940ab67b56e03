// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/chart_report.h"

#include <cmath>
#include <cstdio>

#include "lib/core/error.h"

namespace meshpipe {
namespace {

template <class T>
std::string name_of(T value, const std::map<std::string, T>& names) {
  for (const auto& [name, meaning] : names)
    if (meaning == value) return name;
  return {};
}

/// Names the map, and how a conformal one was found.
std::string name_of(const ParamReport& r) {
  return name_of(r.used, map_names()) +
         (r.used == MapKind::conformal ? ", " + name_of(r.form, form_names()) : "");
}

}  // namespace

const std::map<std::string, MapKind>& map_names() {
  static const std::map<std::string, MapKind> names{
      {"conformal", MapKind::conformal}, {"harmonic", MapKind::harmonic}, {"convex", MapKind::convex}};
  return names;
}

const std::map<std::string, ConformalForm>& form_names() {
  static const std::map<std::string, ConformalForm> names{{"boundary-first", ConformalForm::boundary_first},
                                                          {"least-squares", ConformalForm::least_squares},
                                                          {"spectral", ConformalForm::spectral}};
  return names;
}

void add_chart_columns(Table& parts, const std::vector<ParamReport>& reports) {
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

std::vector<ParamReport> read_chart_columns(const Table& parts) {
  std::vector<ParamReport> reports(parts.rows);
  if (!parts.has("map")) return reports;
  for (std::size_t p = 0; p < parts.rows; ++p) {
    ParamReport& r = reports[p];
    const int map = parts.get<int>("map")[p], form = parts.get<int>("form")[p];
    if (map < 0 || map > 2 || form < 0 || form > 2)
      throw BadInput("part " + std::to_string(p) + " has map " + std::to_string(map) + " of form " +
                     std::to_string(form) + ", expected 0 to 2");
    r.used = static_cast<MapKind>(map);
    r.form = static_cast<ConformalForm>(form);
    r.bend = parts.get<double>("bend")[p];
    r.flips_before = parts.get<int>("flips_before")[p];
    r.flips_after = parts.get<int>("flips_after")[p];
    r.anisotropy_median = parts.get<double>("anisotropy_median")[p];
    r.anisotropy_p99 = parts.get<double>("anisotropy_p99")[p];
    r.anisotropy_max = parts.get<double>("anisotropy_max")[p];
    r.area_scale = parts.get<double>("area_scale")[p];
    r.smallest_area = parts.get<double>("smallest_area")[p];
  }
  return reports;
}

std::string chart_line(const ParamReport& r, std::size_t triangles) {
  char text[400];
  std::snprintf(text, sizeof text,
                "%zu triangles, map %s, sigma1/sigma2 median %.3f, p99 %.3f, max %.3g, area scale %.3g, "
                "smallest area %.2e",
                triangles, name_of(r).c_str(), r.anisotropy_median, r.anisotropy_p99, r.anisotropy_max,
                r.area_scale, r.smallest_area);
  std::string line = text;
  if (r.bend > 0) line += ", border bent " + std::to_string((int)std::lround(100 * r.bend)) + " %";
  if (!r.border_was_simple) line += ", border crossed itself before";
  if (r.flips_before)
    line += ", " + std::to_string(r.flips_before) + " flips before, " + std::to_string(r.flips_after) +
            " after repair";
  if (r.steps) line += ", " + std::to_string(r.steps) + " steps of optimization";
  return line;
}

nlohmann::ordered_json chart_record(const ParamReport& r, int part, std::size_t triangles) {
  return {{"part", part},
          {"triangles", triangles},
          {"map", name_of(r.used, map_names())},
          {"form", r.used == MapKind::conformal ? name_of(r.form, form_names()) : ""},
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
          {"smallest_area", r.smallest_area}};
}

}  // namespace meshpipe
