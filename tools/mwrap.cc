// SPDX-License-Identifier: BSD-3-Clause
// mwrap: a closed surface around any triangle soup.
#include "lib/core/number.h"
#include "lib/wrap/wrap.h"
#include "tools/common.h"

using namespace meshpipe;

namespace {

/// alpha as a share of the bounding box's diagonal, the offset as a share of alpha. At this offset the two
/// sides of a thin sheet are as far apart as the wrap's edges are long, so that the wrap can be remeshed.
constexpr double default_alpha = 1.0 / 50, default_offset = 1.0 / 5;

/// Reads a length, or a part of the bounding box's diagonal in percent.
double length(const std::string& option, const std::string& text, double diagonal) {
  const std::optional<double> value = parse_length(text, diagonal);
  const double given = parse_length(text, 1).value_or(0);
  if (!value || !(given >= 1e-50) || !(given <= 1e50))
    throw BadUsage(option + ": expected a positive length or a percentage of the diagonal, found '" + text +
                   "'");
  return *value;
}

void report(Io& io, const Mesh& soup, const WrapOptions& o, const Mesh& mesh, const WrapReport& r) {
  io.report = {{"input_triangles", soup.tris.size()},
               {"alpha", o.alpha},
               {"offset", o.offset},
               {"spacing", r.spacing},
               {"bytes", r.bytes},
               {"vertices", mesh.points.size()},
               {"triangles", mesh.tris.size()},
               {"components", r.components},
               {"genus", r.genus},
               {"held", r.held},
               {"clearance", r.clearance},
               {"farthest", r.farthest}};
  io.say(std::to_string(soup.tris.size()) + " triangles -> " + std::to_string(mesh.points.size()) +
         " vertices, " + std::to_string(mesh.tris.size()) + " triangles, " + std::to_string(r.components) +
         (r.components == 1 ? " component" : " components") + ", genus " + std::to_string(r.genus));
  io.say("closed, no self-intersection, the input inside; alpha " + shown(o.alpha) + ", offset " +
         shown(o.offset) + ", nowhere farther than " + shown(r.farthest) + " from the input");
  io.detail("grid spacing " + shown(r.spacing) + ", predicted memory " + shown((double)r.bytes / (1 << 20)) +
            " MiB, smallest distance of a vertex " + shown(r.clearance));
  if (r.held)
    io.detail(std::to_string(r.held) + " vertices are farther out, where the surface would meet itself");
}

}  // namespace

int main(int argc, char** argv) {
  std::string alpha, offset;
  return run_tool(
      argc, argv, "mwrap",
      "Wrap any triangle soup in a closed surface at a distance.\n\n"
      "Examples:\n  mwrap tree.stl -o wrapped.stl\n"
      "  mwrap --alpha 5% --offset 0.5% tree.stl | mremesh --triangles 5000 - -o mesh.vtu",
      [&](CLI::App& app) {
        app.add_option("--alpha", alpha,
                       "width of the narrowest hole, slot or cavity that is entered: a length, or % of the "
                       "bounding box's diagonal (default 2%)")
            ->type_name("LENGTH");
        app.add_option(
               "--offset", offset,
               "distance of the result from the input: a length, or % of the diagonal (default: a fifth "
               "of alpha)")
            ->type_name("LENGTH");
      },
      [&](Io& io) {
        Stream& stream = io.read();
        const Mesh soup = std::move(static_cast<Mesh&>(stream.surface));
        const double size = soup.tris.empty() ? 0 : diagonal(soup);
        WrapOptions o;
        o.alpha = alpha.empty() ? default_alpha * size : length("--alpha", alpha, size);
        o.offset = offset.empty() ? default_offset * o.alpha : length("--offset", offset, size);
        if (!soup.tris.empty() && (o.alpha == 0 || o.offset == 0))
          throw NotAdmissible("all triangles are at one point; give --alpha and --offset as lengths");
        WrapReport r;
        Mesh mesh = wrap(soup, o, r);
        report(io, soup, o, mesh, r);
        Stream result;
        result.history = stream.history;
        result.ascii = stream.ascii;
        result.surface = surface_of(std::move(mesh));
        io.write(result);
      });
}
