// SPDX-License-Identifier: BSD-3-Clause
// mrelax: optimize a lifted mesh on its reference surface, across interfaces that are not model edges.
#include "formats/stream/lift_tables.h"
#include "formats/stream/line_tables.h"
#include "formats/stream/region_tables.h"
#include "formats/stream/second_order.h"
#include "lib/clean/clean.h"
#include "lib/lift/lift.h"
#include "lib/relax/relax.h"
#include "tools/common.h"
#include "tools/on_reference.h"

using namespace meshpipe;

namespace {

struct Options {
  RelaxOptions relax;
  std::string reference;
  bool accept = false;
};

/// The reference from a file, with the columns that earlier stages would have written.
Surface reference_from(const Stream& file, std::size_t triangles) {
  Surface s = file.surface;
  clean(s);
  if (s.tris.empty() || triangles == 0) throw NotAdmissible("the mesh or its reference has no triangles");
  if (!s.vertex.has("size"))
    s.vertex.set("size", std::vector<double>(s.points.size(), std::sqrt(4 / std::sqrt(3.0) * total_area(s) /
                                                                        (double)triangles)));
  if (!s.face.has("part")) s.face.set("part", std::vector<int>(s.tris.size()));
  return s;
}

/// Describes the pairs of the result that intersect where the reference does not; empty if there are none.
std::string left_over(const RelaxReport& r, const LiftedMesh& mesh) {
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

void put(Io& io, const RelaxReport& r, std::size_t triangles) {
  io.report["corners_merged"] = r.corners_merged;
  io.report["triangles"] = triangles;
  io.report["kappa_mean"] = r.kappa_mean;
  io.report["kappa_min"] = r.kappa_min;
  io.report["tries"] = r.tries;
  io.report["volume_error"] = r.volume_error;
  io.report["splits"] = r.splits;
  io.report["collapses"] = r.collapses;
  io.report["flips"] = r.flips;
  io.report["moves"] = r.moves;
  io.report["intersections"] = r.intersections;
  io.report["intersections_of_reference"] = r.intersections_of_reference;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  auto add_options = [&](CLI::App& app) {
    app.add_option("--sweeps", o.relax.sweeps, "rounds of flips, moves and count keeping (default 4)")
        ->check(CLI::Range(0, 1000))
        ->type_name("N");
    app.add_option("--reference", o.reference, "relax any mesh on this surface")->type_name("FILE");
    app.add_flag("--accept", o.accept, "write the mesh even when triangles still intersect")
        ->group("Reports");
  };
  auto body = [&](Io& io) {
    Stream& stream = io.read();
    LiftedMesh mesh;
    Surface reference;
    std::vector<int> kinds;
    std::vector<char> corners;
    if (o.reference.empty()) {
      mesh = read_lifted(stream);
      reference = read_reference(stream);
      expect_measurable(reference);
      const Lines lines = read_lines(stream);
      for (const Line& l : lines.lines) {
        kinds.push_back(l.kind);
        o.relax.keep_border = o.relax.keep_border || l.kept;
      }
      corners = line_corners(reference, lines);
      o.relax.sheets_meet = has_sheets(stream);
      if (!reference.face.has("curved")) o.relax.sheets = read_sheets(stream);
      o.relax.target_triangles = stream.asked_triangles;
    } else {
      clean(stream.surface);
      reference = reference_from(io.read(o.reference), stream.surface.tris.size());
      mesh = place_on(stream.surface, reference);
      corners = model_corners(reference);
      write_reference(stream, reference);
      if (stream.find("line_use"))  // lines on another surface
        for (const char* table : {"line", "line_use", "line_vertex"}) stream.erase(table);
    }
    stream.surface = {};  // written anew later; frees its memory now
    const RelaxReport r = relax(mesh, reference, kinds, corners, o.relax);
    const std::string exceptions =
        write_on_reference(stream, mesh, reference, stream.find("mid_vertex") != nullptr);
    if (!exceptions.empty()) io.say(exceptions);
    char text[200];
    std::snprintf(text, sizeof text,
                  "%zu triangles, kappa mean %.4f, min %.3f (%d splits, %d collapses, %d flips)",
                  mesh.tris.size(), r.kappa_mean, r.kappa_min, r.splits, r.collapses, r.flips);
    io.say(text);
    constexpr double much = 0.03;
    if (const double asked = o.relax.target_triangles;
        std::abs((double)mesh.tris.size() - asked) > much * asked && asked > 0)
      io.say("narrow places of the model keep it from the " + std::to_string(stream.asked_triangles) +
             " triangles asked for");
    if (r.corners_merged > 0)
      io.say(std::to_string(r.corners_merged) +
             " corners merged with another that was nearer than a twentieth of the size");
    put(io, r, mesh.tris.size());
    const std::string missed = left_over(r, mesh);
    if (!missed.empty() && !o.accept) throw GoalMissed(missed);
    if (!missed.empty()) io.say("accepted: " + missed);
    io.write(stream);
  };
  return run_tool(
      argc, argv, "mrelax",
      "Optimize a lifted mesh on the surface it came from: flip, collapse, split and move vertices over "
      "that surface, across every interface that is not a model edge.\n\n"
      "examples:\n"
      "  mremesh --keep stages tree.stl -o tree-mesh.stl && mrelax --sweeps 20 stages/10-lift.ply -o "
      "relaxed.ply\n"
      "  mclean tree.stl | mrelax --reference tree.stl -o better.ply",
      add_options, body);
}
