// SPDX-License-Identifier: BSD-3-Clause
#include <charconv>
#include <cstdio>

#include "lib/clean.h"
#include "tools/common.h"

using namespace meshpipe;

namespace {

struct Options {
  std::string weld, keep = "all", sheets = "split", culprits;
  int fill_holes = 0;
  bool drop_nonorientable = false;
};

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", x);
  return text;
}

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

void tell(Io& io, const CleanReport& r, const Surface& surface, double within) {
  const struct {
    const char* key;
    int count;
    std::string what;
  } repairs[] = {
      {"welded", r.welded, "vertices welded with an equal one"},
      {"welded_near", r.welded_near, "vertices merged with one within " + number(within)},
      {"unreferenced", r.unreferenced, "unreferenced vertices dropped"},
      {"degenerate", r.degenerate, "degenerate triangles removed"},
      {"duplicate", r.duplicate, "duplicate triangles dropped"},
      {"flipped", r.flipped, "triangles turned round"},
      {"nonorientable", (int)r.nonorientable.size(), "non-orientable components dropped"},
      {"nonmanifold_edges", r.nonmanifold_edges, "non-manifold edges split into sheets"},
      {"nonmanifold_vertices", r.nonmanifold_vertices, "vertices of several fans split into a copy for each"},
      {"copies", r.copies, "copies of vertices, which keep sheets and fans apart"},
      {"flat", r.flat, "triangles of zero area left in"},
      {"dropped_components", r.dropped_components, "smaller components dropped"},
      {"dropped_triangles", r.dropped_triangles, "triangles dropped with them"},
      {"holes_filled", r.holes_filled, "holes filled"},
      {"hole_triangles", r.hole_triangles, "triangles added in holes"},
      {"holes_left", r.holes_left,
       "holes left open, along non-manifold edges or where filling would double an edge"},
  };
  const std::string size = std::to_string(surface.points.size()) + " vertices, " +
                           std::to_string(surface.tris.size()) + " triangles, " +
                           std::to_string(r.components) + (r.components == 1 ? " component" : " components");
  if (r.nothing)
    io.say("clean: " + size);
  else
    io.say(std::to_string(r.input_vertices) + " vertices, " + std::to_string(r.input_triangles) +
           " triangles -> " + size);
  io.report["input_vertices"] = r.input_vertices;
  io.report["input_triangles"] = r.input_triangles;
  io.report["vertices"] = surface.points.size();
  io.report["triangles"] = surface.tris.size();
  io.report["components"] = r.components;
  io.report["clean"] = r.nothing;
  for (const auto& [key, count, what] : repairs) {
    io.report[key] = count;
    char line[160];  // what a clean surface tells of is how it was found
    std::snprintf(line, sizeof line, "%9d %s%s", count, what.c_str(), r.nothing ? " (so in the input)" : "");
    if (count) io.say(line);
  }
  for (const Nonorientable& c : r.nonorientable) {
    io.say("dropped: " + describe(c));
    io.report["dropped_nonorientable"].push_back({{"triangle", c.triangle},
                                                  {"triangles", c.triangles},
                                                  {"disagree", {c.a, c.b}},
                                                  {"place", {c.place.x, c.place.y, c.place.z}}});
  }
}

/// The culprits as a mesh on the input's points: a triangle for each fault that it has, `patch` the fault.
Stream culprits_of(const CleanReport& report, const Surface& input) {
  Stream stream;
  Surface& s = stream.surface;
  std::vector<int> number(input.points.size(), -1), patch, origin;
  for (const Culprit& c : report.culprits) {
    Tri t = input.tris[c.triangle];
    for (int& v : t) {
      if (number[v] < 0) {
        number[v] = (int)s.points.size();
        s.points.push_back(input.points[v]);
      }
      v = number[v];
    }
    s.tris.push_back(t);
    const int tag = (int)c.fault + 1;
    if (patch.empty() || patch.back() != tag) stream.names.push_back({2, tag, fault_names[tag - 1]});
    patch.push_back(tag);
    origin.push_back(c.triangle);
  }
  s.vertex.rows = s.points.size();
  s.face.set("patch", std::move(patch));
  s.face.set("origin", std::move(origin));
  return stream;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  return run_tool(
      argc, argv, "mclean",
      "Make a triangle soup an oriented manifold, and tell every repair."
      "\n\nExamples:\n  mclean scan.stl -o clean.ply\n  mclean --weld 0.001% --keep-components 1 scan.stl | "
      "mtopo > /dev/null\n  mclean --drop-nonorientable --culprits bad.ply scan.stl -o clean.ply",
      [&](CLI::App& app) {
        app.add_option("--weld", o.weld,
                       "merge vertices this close, after the equal ones: a length, or with % a part of the "
                       "bounding box's diagonal")
            ->type_name("TOL");
        app.add_option("--keep-components", o.keep, "keep the N largest components by area (default all)")
            ->type_name("N|all");
        app.add_option("--fill-holes", o.fill_holes, "fill border loops of at most N edges")
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
        if (o.sheets == "keep") throw BadUsage("--sheets keep is not built yet");
        CleanOptions options{.drop_nonorientable = o.drop_nonorientable,
                             .keep_components = count_or_all(o.keep),
                             .fill_holes = o.fill_holes};
        Stream stream = io.read();
        if (!o.weld.empty()) options.weld = tolerance(o.weld, stream.surface);
        Surface input;
        if (!o.culprits.empty()) static_cast<Mesh&>(input) = stream.surface;
        CleanReport report;
        auto write_culprits = [&] {
          if (!o.culprits.empty()) io.write_to(o.culprits, culprits_of(report, input));
        };
        try {
          clean(stream.surface, options, report);
        } catch (const NotAdmissible&) {
          write_culprits();
          throw;
        }
        write_culprits();
        if (!stream.surface.face.has("patch"))
          stream.surface.face.set("patch", std::vector<int>(stream.surface.tris.size(), 1));
        // whatever was found out about another surface, or by another program, does not hold for this one
        if (stream.input_triangles == 0 || !report.nothing || stream.find("ref_vertex")) {
          stream.tables.clear();
          for (const char* column : {"part", "origin"}) stream.surface.face.erase(column);
          for (const char* column : {"ref_face", "b1", "b2", "kind", "line"})
            stream.surface.vertex.erase(column);
        }
        stream.input_triangles = (int)stream.surface.tris.size();
        tell(io, report, stream.surface, options.weld);
        io.write(stream);
      });
}
