// SPDX-License-Identifier: BSD-3-Clause
// Reports on charts: columns of the table `part`, text, JSON.
#pragma once
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lib/core/mesh.h"
#include "lib/param/param.h"

namespace meshpipe {

/// Names of the maps, and of the forms of the conformal one, in options and reports.
const std::map<std::string, MapKind>& map_names();
const std::map<std::string, ConformalForm>& form_names();

/// Sets the columns map, form, bend, flips_before, flips_after, anisotropy_median, _p99, _max, area_scale and
/// smallest_area: one row per part, in the order of `reports`.
void add_chart_columns(Table& parts, const std::vector<ParamReport>& reports);

/// Returns what these columns hold; without them, as many empty reports. Throws: BadInput for a map or form
/// that is none.
std::vector<ParamReport> read_chart_columns(const Table& parts);

/// Returns one line for -v.
std::string chart_line(const ParamReport& report, std::size_t triangles);

/// Returns the same with times, for --json.
nlohmann::ordered_json chart_record(const ParamReport& report, int part, std::size_t triangles);

}  // namespace meshpipe
