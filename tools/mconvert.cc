// SPDX-License-Identifier: BSD-3-Clause
// mconvert: converts between mesh formats and the stream; strips, colors, shows charts as a flat mesh.
#include <algorithm>
#include <cmath>

#include "formats/foreign/feature_edges.h"
#include "formats/foreign/inria.h"
#include "formats/foreign/vtk_legacy.h"
#include "formats/stream/line_tables.h"
#include "formats/stream/region_tables.h"
#include "lib/core/bvh.h"
#include "lib/core/number.h"
#include "tools/common.h"

using namespace meshpipe;

namespace {

struct Options {
  bool charts = false, surface = false, polydata = false, center = false;
  double scale = 1;
  std::string color, sol, feature_edges, regions;
};

/// Returns the labels in "1,5"; none for "all". Throws: BadUsage.
std::vector<int> labels_in(const std::string& text) {
  std::vector<int> labels;
  for (std::size_t at = 0; text != "all" && at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    int label = 0;
    const auto [stop, error] = meshpipe::from_chars(text.data() + at, text.data() + end, label);
    if (error != std::errc() || stop != text.data() + end)
      throw BadUsage("--regions: expected all or labels as in 1,5, found '" + text + "'");
    labels.push_back(label);
    at = end + 1;
  }
  return labels;
}

/// Replaces the surface by its charts: vertices (u, v, 0), one for each part that a vertex touches. Face
/// columns stay.
void flatten(Stream& stream) {
  Surface& s = stream.surface;
  std::vector<Vec3> flat;
  std::vector<Tri> tris(s.tris.size());
  for (const Chart& c : read_charts(stream)) {
    const int first = static_cast<int>(flat.size());
    for (Vec2 p : c.uv) flat.push_back({p.x, p.y, 0});
    for (std::size_t t = 0; t < c.mesh.tris.size(); ++t)
      for (int i = 0; i < 3; ++i) tris[c.mesh.face[t]][i] = first + c.mesh.tris[t][i];
  }
  s.points = std::move(flat);
  s.tris = std::move(tris);
  s.vertex = Table{"vertex", s.points.size(), {}};
  stream.tables.clear();
}

/// Adds face columns red green blue: a color for each label; consecutive labels differ most.
void color_by(Surface& s, const std::string& column) {
  const std::vector<int>& label = s.face.get<int>(column);
  std::vector<std::uint8_t> rgb[3];
  for (int channel = 0; channel < 3; ++channel) {
    rgb[channel].resize(label.size());
    for (std::size_t t = 0; t < label.size(); ++t) {
      // hues step by the golden ratio; three steps of brightness
      const double hue = 6 * std::fmod(0.61803398874989485 * (label[t] & 0xffffff), 1.0);
      const double k = std::fmod(hue + 5 - 2 * channel, 6.0);
      const double strength = std::clamp(std::min(k, 4 - k), 0.0, 1.0);
      const double bright = 1 - 0.15 * ((label[t] & 0xffffff) % 3);
      rgb[channel][t] = static_cast<std::uint8_t>(std::lround(255 * bright * (1 - 0.6 * strength)));
    }
  }
  s.face.set("red", std::move(rgb[0]));
  s.face.set("green", std::move(rgb[1]));
  s.face.set("blue", std::move(rgb[2]));
}

/// Keeps only vertices, faces, patches and colors.
void strip(Stream& stream) {
  if (has_sheets(stream)) stream = with_sheets_joined(stream);
  Surface& s = stream.surface;
  stream.tables.clear();
  s.vertex.columns.clear();
  std::erase_if(s.face.columns, [](const Column& c) {
    return c.name != "patch" && c.name != "red" && c.name != "green" && c.name != "blue";
  });
}

/// Moves the middle of the bounding box to the origin, and scales, as asked. Throws: NotAdmissible for a
/// stream of the chain, whose tables have places of their own.
void place(Stream& stream, const Options& o) {
  if (!o.center && o.scale == 1) return;
  if (!stream.history.empty() && !o.surface)
    throw NotAdmissible("--scale and --center are for surfaces before mclean, or with --surface");
  Mesh& mesh = stream.surface;
  if (mesh.points.empty()) return;
  Vec3 low = mesh.points[0], high = low;
  for (const Vec3& p : mesh.points) low = lower(low, p), high = upper(high, p);
  // halves: the sum of two coordinates may be infinite
  const Vec3 from = o.center ? 0.5 * low + 0.5 * high : Vec3{};
  for (Vec3& p : mesh.points) p = o.scale * (p - from);
  for (Column& c : stream.surface.vertex.columns)
    if (auto* lengths = std::get_if<std::vector<double>>(&c.data); lengths && is_length(c.name))
      for (double& x : *lengths) x *= o.scale;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  return run_tool(
      argc, argv, "mconvert",
      "Convert between mesh formats and the stream.\n\n"
      "Examples:\n  mconvert tree.stl -o tree.vtu\n"
      "  mclean tree.stl | mconvert --ascii > tree.mply",
      [&](CLI::App& app) {
        app.add_flag("--charts", o.charts,
                     "write the charts of mparam as a flat mesh (u v 0) instead of the surface");
        app.add_option("--color", o.color, "write face columns red, green, blue by part or patch")
            ->check(CLI::IsMember({"part", "patch"}))
            ->type_name("part|patch");
        app.add_option("--sol", o.sol, "add the values of this .sol or .solb file to the vertices")
            ->type_name("FILE");
        app.add_option("--feature-edges", o.feature_edges,
                       "also write the model edges as lines to this file (.obj, .vtk or .eMesh)")
            ->type_name("FILE")
            ->group("Reports");
        app.add_option(
               "--regions", o.regions,
               "write the whole boundary of each region between sheets (or of these regions) as one patch")
            ->check([](const std::string& list) { return list.empty() ? "expected all or labels" : ""; })
            ->type_name("all|L,L");
        app.add_flag("--polydata", o.polydata, "write .vtk as POLYDATA instead of UNSTRUCTURED_GRID");
        app.add_option("--scale", o.scale, "multiply the coordinates by this factor")
            ->check(positive_number())
            ->type_name("F");
        app.add_flag("--center", o.center, "first move the center of the bounding box to the origin");
        app.add_flag("--surface", o.surface, "write only vertices, faces, patches and colors");
      },
      [&](Io& io) {
        if (o.polydata && !io.output.ends_with(".vtk"))
          throw BadUsage("--polydata is for -o FILE.vtk, not '" + io.output + "'");
        const std::vector<int> regions = labels_in(o.regions.empty() ? "all" : o.regions);
        if (!o.feature_edges.empty()) io.expect_report("--feature-edges", o.feature_edges);
        Stream& stream = io.read();
        const std::string extension = extension_of(io.output);
        const bool as_stream = extension.empty() || extension == ".mply";
        if (!as_stream || o.center || o.scale != 1) change_unit(stream, 0);
        if (!o.feature_edges.empty())
          Io::write_file(o.feature_edges, write_feature_edges(stream, o.feature_edges));
        if (!o.sol.empty()) read_sol(stream, read_bytes(o.sol), o.sol);
        place(stream, o);
        if (o.charts) flatten(stream);
        if (!o.color.empty()) color_by(stream.surface, o.color);
        if (!o.regions.empty()) stream = region_boundaries(stream, regions);
        if (o.surface) strip(stream);
        io.detail(std::to_string(stream.surface.points.size()) + " vertices, " +
                  std::to_string(stream.surface.tris.size()) + " triangles");
        io.report["vertices"] = stream.surface.points.size();
        io.report["triangles"] = stream.surface.tris.size();
        if (as_stream)
          io.write(stream);
        else if (const bool ascii = io.text_for(stream); o.polydata)
          io.write_bytes(write_vtk_polydata(has_sheets(stream) ? with_sheets_joined(stream) : stream, ascii));
        else
          io.write_bytes(write_as(stream, io.output, ascii));
      },
      {.passes = true, .any_size = true});
}
