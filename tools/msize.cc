// SPDX-License-Identifier: BSD-3-Clause
// msize: the size field, the target edge length at every vertex.
#include <cmath>

#include "lib/size.h"
#include "tools/common.h"

using namespace meshpipe;

/// Half-edges are numbered by int.
constexpr int most_triangles = 715827882;

int main(int argc, char** argv) {
  double size = 0;
  int triangles = 0;
  auto add_options = [&](CLI::App& app) {
    const CLI::Validator positive(
        [](std::string& text) {
          double h = 0;
          const bool good = CLI::detail::lexical_cast(text, h) && std::isfinite(h) && h > 0;
          return good ? std::string() : "'" + text + "' is not a positive length";
        },
        "");
    auto* fixed = app.add_option("--size", size, "target edge length")->check(positive)->type_name("H");
    app.add_option("--triangles", triangles,
                   "the length that gives this many triangles (default: as many as the input had)")
        ->check(CLI::Range(1, most_triangles))
        ->type_name("N")
        ->excludes(fixed);
  };
  auto body = [&](Io& io) {
    Stream stream = io.read();
    Surface& s = stream.surface;
    if (s.tris.empty()) throw NotAdmissible("the surface has no triangles");
    if (size == 0) {
      const int own = stream.input_triangles > 0 ? stream.input_triangles : static_cast<int>(s.tris.size());
      size = size_for_count(total_area(s), triangles > 0 ? triangles : own);
      if (!(size > 0)) throw NotAdmissible("the surface has no area");
    }
    const double wanted = total_area(s) / (std::sqrt(3.0) / 4 * size * size);
    if (!(wanted < most_triangles)) {
      char why[120];
      std::snprintf(why, sizeof why, "size %.6g asks for %.3g triangles, the limit is %d", size, wanted,
                    most_triangles);
      throw NotAdmissible(why);
    }
    s.vertex.set("size", std::vector<double>(s.points.size(), size));
    char text[64];
    std::snprintf(text, sizeof text, "target edge length %.6g", size);
    io.say(text);
    io.report["size"] = size;
    io.write(stream);
  };
  return run_tool(argc, argv, "msize",
                  "Set the size field, the target edge length at every vertex of the surface.\n\n"
                  "examples:\n  msize --size 0.8 tree.stl -o sized.ply\n"
                  "  msize --triangles 20000 tree.stl -o sized.ply",
                  add_options, body);
}
