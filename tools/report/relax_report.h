// SPDX-License-Identifier: BSD-3-Clause
// What mrelax says of its result.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lib/relax/relax.h"

namespace meshpipe {

/// Returns the lines for people. `asked`: number of triangles; 0: none. `by_default`: then that of the input,
/// if the sizes stand for it.
std::vector<std::string> relax_lines(const RelaxReport& r, std::size_t triangles, int asked, int by_default);

nlohmann::ordered_json relax_record(const RelaxReport& r, std::size_t triangles);

/// Describes the pairs of the result that intersect where the reference does not; empty if there are none.
std::string left_over(const RelaxReport& r, const Mesh& mesh);

}  // namespace meshpipe
