// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/relax_report.h"

#include <cmath>
#include <cstdio>

#include "lib/core/number.h"

namespace meshpipe {

std::vector<std::string> relax_lines(const RelaxReport& r, std::size_t triangles, int asked, int by_default) {
  char text[200];
  std::snprintf(text, sizeof text,
                "%zu triangles, kappa mean %.4f, min %.3f (%d splits, %d collapses, %d flips)", triangles,
                r.kappa_mean, r.kappa_min, r.splits, r.collapses, r.flips);
  std::vector<std::string> lines{text};
  constexpr double much = 0.03, promised = 0.2;  // of the number
  const int wanted = asked > 0 ? asked : by_default;
  const double surplus = wanted > 0 ? (double)triangles / wanted - 1 : 0;
  const bool many = surplus > promised;
  const std::string number = std::to_string(wanted) + " triangles ";
  if (asked > 0 && std::abs(surplus) > much)
    lines.push_back(
        "narrow places of the model keep it from the " + number + "asked for" +
        (many ? ": there are " + shown(0.01 * std::round(100 * (1 + surplus))) + " times as many" : ""));
  else if (asked == 0 && many)
    lines.push_back("narrow places of the model take more than the " + number + "of the input: --triangles " +
                    std::to_string(wanted) + " has fewer, and worse ones");
  if (r.restarts > 0)
    lines.push_back("begun again " + std::to_string(r.restarts) + (r.restarts == 1 ? " time" : " times") +
                    ", with smaller sizes where faults were left");
  if (r.corners_merged > 0)
    lines.push_back(std::to_string(r.corners_merged) +
                    " corners merged with another that was nearer than a twentieth of the size");
  return lines;
}

nlohmann::ordered_json relax_record(const RelaxReport& r, std::size_t triangles) {
  nlohmann::ordered_json record;
  record["corners_merged"] = r.corners_merged;
  record["triangles"] = triangles;
  record["kappa_mean"] = r.kappa_mean;
  record["kappa_min"] = r.kappa_min;
  record["tries"] = r.tries;
  record["restarts"] = r.restarts;
  record["volume_error"] = r.volume_error;
  record["splits"] = r.splits;
  record["collapses"] = r.collapses;
  record["flips"] = r.flips;
  record["moves"] = r.moves;
  record["intersections"] = r.intersections;
  record["intersections_of_reference"] = r.intersections_of_reference;
  return record;
}

std::string left_over(const RelaxReport& r, const Mesh& mesh) {
  if (r.intersections.empty()) return "";
  const auto [s, t] = r.intersections.front();
  const Vec3 p = mesh.points[mesh.tris[s][0]];
  char text[200];
  std::snprintf(
      text, sizeof text,
      "%zu pairs of triangles still intersect where the reference does not, the first: %d and %d at "
      "(%.6g %.6g %.6g)",
      r.intersections.size(), s, t, p.x, p.y, p.z);
  return text;
}

}  // namespace meshpipe
