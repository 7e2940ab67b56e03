// SPDX-License-Identifier: BSD-3-Clause
// What became of every chart, as columns of the `part` table, as text, and as JSON.
#pragma once
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lib/mesh.h"
#include "lib/param.h"

namespace meshpipe {

/// The maps, and the forms of the conformal one, as options and reports call them.
const std::map<std::string, MapKind>& map_names();
const std::map<std::string, ConformalForm>& form_names();

/// Sets the columns map, form, bend, flips_before, flips_after, anisotropy_median, _p99, _max, area_scale and
/// smallest_area; a row a part, `reports` in their order.
void add_chart_columns(Table& parts, const std::vector<ParamReport>& reports);

/// One line for -v.
std::string chart_line(const ParamReport& report, std::size_t triangles);

/// The same, and the times, for --json.
nlohmann::ordered_json chart_record(const ParamReport& report, int part, std::size_t triangles);

}  // namespace meshpipe
