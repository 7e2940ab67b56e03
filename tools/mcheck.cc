// SPDX-License-Identifier: BSD-3-Clause
// mcheck: verify a result against the surface it was made from.
#include <algorithm>
#include <cstdio>

#include "formats/histogram.h"
#include "formats/lift_tables.h"
#include "lib/clean.h"
#include "lib/contract.h"
#include "lib/intersect.h"
#include "lib/weld.h"
#include "tools/common.h"

using namespace meshpipe;

namespace {

struct Options {
  std::string reference, require = "topology,intersections,patches,kappa=0.1", histogram;
  bool accept = false;
  int samples = 100000;
};

/// Files as STL hold every triangle on its own.
bool is_soup(const Mesh& m) { return m.points.size() == 3 * m.tris.size() && m.tris.size() > 1; }

/// A label of a patch as a user knows it.
std::string patch_name(const Stream& stream, int tag) {
  const std::string name = stream.name_of(2, tag);
  return name.empty() ? std::to_string(tag) : name;
}

std::vector<std::string> patch_names(const Stream& stream, const Surface& surface) {
  std::vector<std::string> names;
  if (!surface.face.has("patch")) return names;
  std::vector<int> tags = surface.face.get<int>("patch");
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  for (int tag : tags) names.push_back(patch_name(stream, tag));
  std::sort(names.begin(), names.end());
  return names;
}

Findings examine(const Mesh& mesh, const std::vector<double>& size, const Mesh& reference, int samples) {
  Findings f;
  f.mesh = connectivity_of(mesh);
  f.reference = connectivity_of(reference);
  f.quality = quality_of(mesh, size);
  f.reference_quality = quality_of(reference, {});
  const Bvh mesh_tree(mesh), reference_tree(reference);
  f.intersections = self_intersections(mesh, mesh_tree);
  if (!f.intersections.empty())
    f.reference_intersections = (int)self_intersections(reference, reference_tree).size();
  f.distance = distance_between(reference, reference_tree, mesh, mesh_tree, samples);
  return f;
}

void tell(Io& io, const Findings& f, bool sized) {
  const Connectivity &m = f.mesh, &r = f.reference;
  const Quality &q = f.quality, &p = f.reference_quality;
  const Distance& d = f.distance;
  char line[160];
  auto row = [&](const char* name, const char* format, auto before, auto after) {
    char a[40], b[40];
    std::snprintf(a, sizeof a, format, before);
    std::snprintf(b, sizeof b, format, after);
    std::snprintf(line, sizeof line, "%-24s %12s %12s", name, a, b);
    io.say(line);
  };
  row("", "%s", "reference", "result");
  row("vertices", "%d", r.vertices, m.vertices);
  row("triangles", "%d", r.faces, m.faces);
  if (m.sound() && r.sound()) {
    row("components", "%d", r.components, m.components);
    row("genus", "%d", r.genus, m.genus);
    row("boundary loops", "%d", r.loops, m.loops);
  }
  const std::string crossings =
      f.reference_intersections < 0 ? "-" : std::to_string(f.reference_intersections);
  row("self-intersections", "%s", crossings.c_str(), std::to_string(f.intersections.size()).c_str());
  row("kappa min", "%.4f", p.kappa_min, q.kappa_min);
  row("kappa 1 %", "%.4f", p.kappa_p01, q.kappa_p01);
  row("kappa mean", "%.4f", p.kappa_mean, q.kappa_mean);
  row("angle min", "%.2f", p.min_angle, q.min_angle);
  row("angle min, mean", "%.2f", p.mean_min_angle, q.mean_min_angle);
  row("angle max", "%.2f", p.max_angle, q.max_angle);
  row("valence 5 to 7", "%.4f", p.valence567, q.valence567);
  std::snprintf(line, sizeof line, "edge over %-13s  min %.3f  mean %.3f  max %.3f  deviation %.3f",
                sized ? "size field" : "mean edge", q.edge_min, q.edge_mean, q.edge_max, q.edge_deviation);
  io.say(line);
  std::snprintf(line, sizeof line,
                "distance over diagonal   Hausdorff %.3g (at most %.3g)  mean %.3g  rms %.3g  border %.3g",
                d.hausdorff, d.hausdorff + d.bound, d.mean, d.rms, d.boundary);
  io.say(line);

  auto& j = io.report;
  j["vertices"] = m.vertices;
  j["triangles"] = m.faces;
  j["nonmanifold_edges"] = m.nonmanifold;
  j["turned_edges"] = m.turned;
  j["pinched_vertices"] = m.pinched;
  j["degenerate"] = m.degenerate;
  j["components"] = m.components;
  j["genus"] = m.genus;
  j["loops"] = m.loops;
  j["topology_same"] =
      m.sound() && r.sound() && m.components == r.components && m.genus == r.genus && m.loops == r.loops;
  j["self_intersections"] = f.intersections.size();
  j["kappa_min"] = q.kappa_min;
  j["kappa_p01"] = q.kappa_p01;
  j["kappa_mean"] = q.kappa_mean;
  j["min_angle"] = q.min_angle;
  j["mean_min_angle"] = q.mean_min_angle;
  j["max_angle"] = q.max_angle;
  j["valence567"] = q.valence567;
  j["edge_unit"] = sized ? "size" : "mean";
  j["edge_min"] = q.edge_min;
  j["edge_mean"] = q.edge_mean;
  j["edge_max"] = q.edge_max;
  j["edge_deviation"] = q.edge_deviation;
  j["hausdorff"] = d.hausdorff;
  j["hausdorff_bound"] = d.hausdorff + d.bound;
  j["hausdorff_to_reference"] = d.to_reference;
  j["hausdorff_to_result"] = d.to_mesh;
  j["mean_distance"] = d.mean;
  j["rms_distance"] = d.rms;
  j["boundary_distance"] = d.boundary;
  j["kappa_histogram"] = q.kappa_histogram;
  j["reference"] = {
      {"vertices", r.vertices},     {"triangles", r.faces},     {"components", r.components},
      {"genus", r.genus},           {"loops", r.loops},         {"kappa_min", p.kappa_min},
      {"kappa_mean", p.kappa_mean}, {"min_angle", p.min_angle}, {"kappa_histogram", p.kappa_histogram}};
  if (f.reference_intersections >= 0) j["reference"]["self_intersections"] = f.reference_intersections;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  auto add_options = [&](CLI::App& app) {
    app.add_option("--reference", o.reference,
                   "the surface to compare with; without it the stream's own, from mlift")
        ->type_name("FILE");
    app.add_option(
           "--require", o.require,
           "what must be met: topology, intersections, patches, kappa=X, kappa_mean=X, angle=DEGREES, "
           "hausdorff=X, boundary=X (default " +
               o.require + ")")
        ->type_name("LIST");
    app.add_flag("--accept", o.accept,
                 "pass the stream on even if the contract is missed; the status is still 6");
    app.add_option("--samples", o.samples, "points on each surface for the distance (default 100000)")
        ->check(CLI::Range(1, 100000000))
        ->group("Reports");
    app.add_option("--histogram", o.histogram, "draw the kappas of both meshes")
        ->type_name("FILE.svg")
        ->group("Reports");
  };
  auto body = [&](Io& io) {
    const Contract contract = parse_contract(o.require);
    Stream stream = io.read();
    Surface result = stream.surface, reference;
    std::vector<std::string> reference_names;
    if (o.reference.empty()) {
      reference = read_reference(stream);
      reference_names = patch_names(stream, reference);
    } else {
      Stream other = io.read(o.reference);
      reference_names = patch_names(other, other.surface);
      reference = std::move(other.surface);
      clean(reference);
      if (is_soup(result)) weld(result);
    }
    if (result.tris.empty()) throw NotAdmissible("the result has no triangles");
    const bool sized = result.vertex.has("size");
    Findings f = examine(result, sized ? result.vertex.get<double>("size") : std::vector<double>(), reference,
                         o.samples);
    const std::vector<std::string> names = patch_names(stream, result);
    // a file that holds one patch comes from a format without patches, as a rule
    if (o.reference.empty() || names.size() > 1)
      std::set_difference(reference_names.begin(), reference_names.end(), names.begin(), names.end(),
                          std::back_inserter(f.lost_patches));
    tell(io, f, sized);
    if (!o.histogram.empty())
      Io::write_file(o.histogram,
                     kappa_histogram_svg(f.reference_quality.kappa_histogram, f.quality.kappa_histogram));

    const std::vector<Failure> failures = judge(contract, f, result);
    io.report["failed"] = nlohmann::ordered_json::array();
    for (const Failure& x : failures) {
      io.say("failed: " + x.requirement + ": " + x.fact);
      io.report["failed"].push_back({{"requirement", x.requirement}, {"fact", x.fact}});
    }
    if (failures.empty() || o.accept) io.write(stream);
    if (!failures.empty())
      throw ContractMissed(
          "contract missed: " + failures[0].requirement + ": " + failures[0].fact +
          (failures.size() > 1 ? " (and " + std::to_string(failures.size() - 1) + " more)" : ""));
  };
  return run_tool(
      argc, argv, "mcheck",
      "Verify a result: connectivity, self-intersections, quality, and distance to the surface it was made "
      "from.\n\nexamples:\n  mremesh -q --keep stages tree.stl -o tree-mesh.ply && mcheck "
      "stages/11-relax.ply "
      "-o checked.ply\n  mcheck tree.stl --reference tree.stl --require topology,hausdorff=0.01 --json "
      "tree.json "
      "-o tree.ply",
      add_options, body);
}
