// SPDX-License-Identifier: BSD-3-Clause
// A verdict as text and as a picture.
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "formats/stream.h"
#include "lib/check/check.h"
#include "lib/core/failure_facts.h"

namespace meshpipe {

/// Returns what names a patch: its name, or its label. Keeps a reference to the stream.
std::function<std::string(int)> namer(const Stream& stream);

/// Returns how far mfeature has moved points of the input, at most, in removing features.
double moved_in(const Stream& stream);

/// Returns the distance that the contract requires, over the diagonal; infinite if none.
double required_distance(const Contract& contract);

/// Returns lines on what mclean and mfeature have done to the input, which the comparison with the cleaned
/// input hides.
std::vector<std::string> warnings_of(const Stream& stream, const Findings& f);

/// Returns the figures, histograms and cleaning for --json.
nlohmann::ordered_json report_of(const Findings& findings, const Stream& stream);
nlohmann::ordered_json failures_json(const std::vector<Failure>& failures);

/// Returns the first failure and the number of the others. Requires: there is one.
std::string summary_of(const std::vector<Failure>& failures);

/// Returns what a way out is chosen by.
FailureFacts facts_about(const Failure& failure, const Mesh& mesh);

/// Returns a figure as tables show it, "-" if there is none. `decimals`: as Figure::decimals.
std::string text_of(double x, int decimals);

/// Returns the lines of a table of reference and result. Counts that are 0 in both are left out, except
/// genus, loops and self-intersections.
std::vector<std::string> figure_table(const std::vector<Figure>& figures);

/// Histograms of both meshes as SVG: kappa, its smallest values, and the smallest angle.
std::string findings_svg(const Findings& findings);

}  // namespace meshpipe
