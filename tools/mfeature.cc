// SPDX-License-Identifier: BSD-3-Clause
#include <charconv>

#include "lib/feature.h"
#include "lib/size.h"
#include "tools/common.h"

using namespace meshpipe;

namespace {

/// auto, none, A or A,B in degrees; throws BadUsage.
void parse_angles(const std::string& text, FeatureOptions& options) {
  if (text == "auto") return;
  options.mode = FeatureOptions::none;
  if (text == "none") return;
  options.mode = FeatureOptions::angles;
  const char *at = text.data(), *end = at + text.size();
  auto [after, error] = std::from_chars(at, end, options.strong);
  options.weak = options.strong / 2;
  if (error == std::errc() && after < end && *after == ',') {
    auto second = std::from_chars(after + 1, end, options.weak);
    after = second.ptr;
    error = second.ec;
  }
  if (error != std::errc() || after != end ||
      !(0 < options.weak && options.weak <= options.strong && options.strong < 180))
    throw BadUsage("--feature-angle " + text + " is not auto, none, A or A,B with 0 < B <= A < 180 degrees");
}

}  // namespace

int main(int argc, char** argv) {
  FeatureOptions options;
  std::string angles = "auto";
  double triangles = 0;
  return run_tool(
      argc, argv, "mfeature",
      "Mark model edges: patch borders and creases."
      "\n\nExamples:\n  mclean part.stl | mfeature --triangles 20000 -o part.ply\n  mfeature --feature-angle "
      "40,20 scan.ply -o "
      "scan-features.ply",
      [&](CLI::App& app) {
        app.add_option("--feature-angle", angles,
                       "auto: creases that look designed; A,B: edges above A degrees, and above B where they "
                       "go on; none")
            ->type_name("auto|A[,B]|none");
        auto* size = app.add_option("--size", options.size, "target edge length")
                         ->check(CLI::PositiveNumber)
                         ->type_name("H");
        app.add_option("--triangles", triangles, "target number of triangles")
            ->check(CLI::PositiveNumber)
            ->excludes(size)
            ->type_name("N");
      },
      [&](Io& io) {
        parse_angles(angles, options);
        Stream stream = io.read();
        if (triangles > 0) options.size = size_for_count(total_area(stream.surface), triangles);
        const FeatureReport r = mark_features(stream.surface, options);
        io.say(std::to_string(r.model_edges) + " model edges: " + std::to_string(r.patch_edges) +
               " between patches, " + std::to_string(r.crease_edges) + " on creases; " +
               std::to_string(r.corners) + " corners");
        io.report["model_edges"] = r.model_edges;
        io.report["patch_edges"] = r.patch_edges;
        io.report["crease_edges"] = r.crease_edges;
        io.report["corners"] = r.corners;
        io.write(stream);
      });
}
