// SPDX-License-Identifier: BSD-3-Clause
#include <charconv>
#include <cstdio>

#include "formats/model_edges.h"
#include "lib/clean.h"
#include "tools/common.h"

using namespace meshpipe;

namespace {

struct Options : CleanOptions {
  std::string within, keep = "all", sheets = "split", culprits;
};

/// A length, or a part of the bounding box's diagonal in percent.
double tolerance(const std::string& text, const Mesh& mesh) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, value);
  const bool percent = at + 1 == end && *at == '%';
  if (error != std::errc() || !(percent || at == end) || !std::isfinite(value) || value <= 0)
    throw BadUsage("--weld: '" + text + "' is neither a positive length nor a percentage of the diagonal");
  return percent ? value / 100 * diagonal(mesh) : value;
}

int count_or_all(const std::string& text) {
  if (text == "all") return 0;
  int value = 0;
  const char* end = text.data() + text.size();
  if (const auto [at, error] = std::from_chars(text.data(), end, value);
      error != std::errc() || at != end || value < 1)
    throw BadUsage("--keep-components: '" + text + "' is neither a positive number nor 'all'");
  return value;
}

/// What was found and done, for --json; of a surface that is refused, what was found until then.
void put(Io& io, const CleanReport& r, const CleanOptions& options) {
  io.report["input_vertices"] = r.input_vertices;
  io.report["input_triangles"] = r.input_triangles;
  io.report["clean"] = r.nothing;
  for (const auto& [key, count, what] : table_of(r, options)) io.report[key] = count;
  for (const Nonorientable& c : r.nonorientable)
    io.report[options.drop_nonorientable ? "dropped_nonorientable" : "refused_nonorientable"].push_back(
        {{"triangle", c.triangle},
         {"triangles", c.triangles},
         {"disagree", {c.a, c.b}},
         {"place", {c.place.x, c.place.y, c.place.z}}});
}

void tell(Io& io, const CleanReport& r, const CleanOptions& options, const Surface& surface) {
  const std::string size = std::to_string(surface.points.size()) + " vertices, " +
                           std::to_string(surface.tris.size()) + " triangles, " +
                           std::to_string(r.components) + (r.components == 1 ? " component" : " components");
  io.say(r.nothing ? "clean: " + size
                   : std::to_string(r.input_vertices) + " vertices, " + std::to_string(r.input_triangles) +
                         " triangles -> " + size);
  io.report["vertices"] = surface.points.size();
  io.report["triangles"] = surface.tris.size();
  io.report["components"] = r.components;
  for (const auto& [key, count, what] : table_of(r, options)) {
    char line[160];  // what a clean surface tells of is how it was found
    std::snprintf(line, sizeof line, "%9d %s%s", count, what.c_str(), r.nothing ? " (so in the input)" : "");
    if (count) io.say(line);
  }
  for (const Nonorientable& c : r.nonorientable) io.say("dropped: " + describe(c));
}

/// A patch that became several has its name on each of them.
void name_sheets(Stream& stream, const CleanReport& report) {
  int number = 1, of = -1;
  for (const auto& [patch, was] : report.sheet_patches) {
    number = was == of ? number + 1 : 2;
    of = was;
    for (std::size_t i = 0; i < stream.names.size(); ++i)
      if (stream.names[i].dim == 2 && stream.names[i].tag == was) {
        stream.names.push_back({2, patch, stream.names[i].text + "-" + std::to_string(number)});
        break;
      }
  }
}

void write_culprits(const Io& io, const std::string& path, const CleanReport& report, const Mesh& input) {
  if (path.empty()) return;
  Stream stream;
  stream.surface = surface_of_culprits(report, input);
  for (int i = 0; i < (int)std::size(fault_names); ++i) stream.names.push_back({2, i + 1, fault_names[i]});
  io.write_to(path, stream);
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  return run_tool(
      argc, argv, "mclean",
      "Make a triangle soup an oriented manifold, and tell every repair.\n\n"
      "examples:\n  mclean tree.stl -o clean.ply\n"
      "  mclean --weld 0.0001% --keep-components 1 tree.stl | mtopo > topo.ply\n"
      "  mclean --drop-nonorientable --culprits bad.ply tree.stl -o clean.ply",
      [&](CLI::App& app) {
        app.add_option("--weld", o.within,
                       "merge vertices this close, after the equal ones: a length, or with % a part of the "
                       "bounding box's diagonal")
            ->type_name("TOL");
        app.add_option("--keep-components", o.keep, "keep the N largest components by area (default all)")
            ->type_name("N|all");
        app.add_option("--fill-holes", o.fill_holes, "fill border loops of at most N edges, 3 to 1000")
            ->check(CLI::Range(3, 1000))
            ->type_name("N");
        app.add_flag("--drop-nonorientable", o.drop_nonorientable,
                     "leave components out that are not orientable, instead of failing with 4");
        app.add_option("--sheets", o.sheets,
                       "what becomes of edges of more than two triangles: split (default) or keep")
            ->check(CLI::IsMember({"split", "keep"}));
        app.add_option("--culprits", o.culprits, "write the triangles that were at fault to this file")
            ->type_name("FILE")
            ->group("Reports");
      },
      [&](Io& io) {
        o.keep_components = count_or_all(o.keep);
        o.keep_sheets = o.sheets == "keep";
        if (!o.culprits.empty()) io.expect_report("--culprits", o.culprits, true);
        Stream stream = io.read();
        Surface& s = stream.surface;
        if (!o.within.empty()) o.weld = tolerance(o.within, s);
        const Mesh input = o.culprits.empty() ? Mesh{} : s;
        // lines of a foreign file, by their place: vertices are about to be renumbered
        const ModelSegments lines = stream.history.empty() ? segments_of(stream) : read_model_edges(stream);
        CleanReport report;
        std::exception_ptr refused;
        try {
          clean(s, o, report);
        } catch (const NotAdmissible&) {
          refused = std::current_exception();
        }
        put(io, report, o);
        write_culprits(io, o.culprits, report, input);
        if (refused) std::rethrow_exception(refused);
        name_sheets(stream, report);
        if (!s.face.has("patch")) s.face.set("patch", std::vector<int>(s.tris.size(), 1));
        // whatever was found out about another surface, or by another program, does not hold for this one
        if (stream.input_triangles == 0 || !report.nothing || stream.find("ref_vertex")) {
          stream.tables.clear();
          write_model_edges(stream, lines);
          for (const char* column : {"part", "origin"}) s.face.erase(column);
          for (const char* column : {"ref_face", "b1", "b2", "kind", "line"}) s.vertex.erase(column);
        }
        stream.input_triangles = (int)s.tris.size();
        tell(io, report, o, s);
        io.write(stream);
      },
      {.passes = true});
}
