// SPDX-License-Identifier: BSD-3-Clause
// msize: the size field, the target edge length at every vertex.
#include <cmath>
#include <filesystem>

#include "formats/foreign/inria.h"
#include "formats/foreign/size_table.h"
#include "formats/stream/region_tables.h"
#include "formats/stream/stages.h"
#include "lib/core/bvh.h"
#include "lib/core/number.h"
#include "lib/numeric/expression.h"
#include "lib/size/size.h"
#include "tools/common.h"
#include "tools/files.h"
#include "tools/report/size_report.h"

using namespace meshpipe;

namespace {

/// Reads a .sol file, which has values only, with the mesh of the same name.
Stream read_with_mesh(const Io& io, const std::string& path) {
  for (const char* extension : {".mesh", ".meshb"})
    if (const auto mesh = std::filesystem::path(path).replace_extension(extension);
        std::filesystem::exists(mesh)) {
      Stream stream = io.read(mesh.string());
      stream.surface.vertex = Table{"vertex", stream.surface.points.size(), {}};
      read_sol(stream, read_bytes(path), path);
      return stream;
    }
  throw BadInput(path + ": expected its mesh next to it, a .mesh or .meshb of the same name");
}

/// Splits FILE:COLUMN; into the text and nothing if a file has that name.
std::pair<std::string, std::string> file_and_column(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || std::filesystem::exists(text)) return {text, ""};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

/// Reads FILE or FILE:COLUMN into `sizes`, and its unit. Returns its search tree.
std::unique_ptr<Bvh> read_field(const Io& io, const std::string& text, SizeField& sizes, int& unit) {
  const auto [path, column] = file_and_column(text);
  if (path.ends_with(".sol") || path.ends_with(".solb")) {
    sizes = size_field_of(read_with_mesh(io, path), column, path);
  } else {
    const std::string bytes = read_bytes(path);
    if (is_size_table(bytes)) {
      sizes = read_size_table(bytes, column, path);
    } else {
      const Stream field = read_any(bytes, path);
      unit = field.unit;
      sizes = size_field_of(field, column, path);
    }
  }
  return std::make_unique<Bvh>(sizes);
}

void report(Io& io, const SizeOptions& o, const SizeReport& r, bool counted) {
  for (const std::string& line : size_lines(r, o, counted)) io.say(line);
  io.report["size"] = r.smallest;
  io.report["largest_size"] = r.largest;
  io.report["expected_triangles"] = r.triangles;
  io.report["factor"] = r.scale;
  io.report["split_edges"] = r.added;
  for (const MeasuredSize& m : r.measured)
    io.report[m.column] = {
        {"smallest", m.value}, {"at", {m.at.x, m.at.y, m.at.z}}, {"size", m.size}, {"vertices", m.vertices}};
  if (o.layers.first > 0)
    io.report["layers"] = {{"total", r.layers.total},
                           {"too_thick_at_vertices", r.layers.all},
                           {"fits", r.layers.least},
                           {"at", {r.layers.at.x, r.layers.at.y, r.layers.at.z}}};
  if (r.narrow.places > 0)
    io.report["narrow"] = {{"places", r.narrow.places},
                           {"at", {r.narrow.at.x, r.narrow.at.y, r.narrow.at.z}},
                           {"gap", r.narrow.gap},
                           {"asked", r.narrow.from},
                           {"permitted", r.narrow.to}};
}

/// Drops lines that came with the file, and counts the triangles of the parts again.
void follow_split(Stream& stream) {
  for (const char* table : {"line", "line_vertex"}) stream.erase(table);
  for (Table& t : stream.tables)
    if (t.name == "part" && t.has("faces")) {
      auto& faces = t.get<int>("faces");
      std::fill(faces.begin(), faces.end(), 0);
      for (int p : stream.surface.face.get<int>("part")) ++faces[p];
    }
}

struct Options : SizeOptions {
  std::string field, formula, boundary_layers;
};

void add_options(CLI::App& app, Options& o) {
  auto length = [&](const char* name, double& value, const char* what, const char* type) {
    return app.add_option(name, value, what)->check(positive_number())->type_name(type);
  };
  auto* fixed = length("--size", o.size, "target edge length", "H");
  app.add_option(
         "--triangles", o.triangles,
         "number of triangles, distributed as the other options ask (default: about that of the input)")
      ->check(count_between(1, 715827882))
      ->type_name("N")
      ->excludes(fixed);
  length("--curvature", o.per_turn, "edges per full turn, along the direction of largest curvature", "N");
  length("--chord", o.chord, "largest distance between an edge and the arc that it spans", "EPS");
  auto text = [&](const char* name, std::string& value, const char* what, const char* type) {
    app.add_option(name, value, what)
        ->check([](const std::string& s) { return s.empty() ? "needs a value" : ""; })
        ->type_name(type);
  };
  length("--around", o.around, "edges around tubes and other bodies, by their local radius", "N");
  length("--across", o.across, "elements across the thickness of a body", "N");
  length("--gap", o.gap, "elements across the gap between bodies", "N");
  text("--layers", o.boundary_layers,
       "check that boundary layers fit; T: thickness of the first (default growth: 1.2, 5 layers, inside)",
       "T[,GROWTH[,N]][,outside]");
  text("--data", o.data, "the input's vertex data of this name", "NAME");
  text("--field", o.field, "sizes in a file: a mesh with vertex data, .sol, or a table x y z h",
       "FILE[:NAME]");
  text("--expression", o.formula, "size as a formula of x, y, z and curvature", "EXPR");
  length("--min", o.min, "no size below this", "H");
  length("--max", o.max, "no size above this", "H");
  length("--gradation", o.gradation, "growth of the size per unit of length, where it varies (default 0.3)",
         "G");
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  auto body = [&](Io& io) {
    if (o.min > 0 && o.max > 0 && o.min > o.max)
      throw BadUsage("--min " + shown(o.min) + " is larger than --max " + shown(o.max));
    if (!o.boundary_layers.empty()) o.layers = parse_layers(o.boundary_layers);
    SizeField sizes;
    int unit = 0;  // of the field
    std::unique_ptr<Bvh> tree;
    std::unique_ptr<Expression> expression;
    if (!o.formula.empty())
      expression =
          std::make_unique<Expression>(o.formula, std::vector<std::string>{"x", "y", "z", "curvature"});
    // before the input, since mremesh checks the options without one; but a pipe can be read only once
    if (!o.field.empty() && can_be_read_again(file_and_column(o.field).first))
      tree = read_field(io, o.field, sizes, unit);
    Stream& stream = io.read();
    Surface& s = stream.surface;
    if (!o.field.empty() && !tree) tree = read_field(io, o.field, sizes, unit);
    if (tree && unit != stream.unit)
      throw BadUsage("--field: its lengths are multiples of 2^" + std::to_string(unit) +
                     ", those of the surface of 2^" + std::to_string(stream.unit) +
                     "; run mconvert --scale on both before mclean");
    o.at_curvature = expression && expression->uses("curvature");
    if (tree || expression)
      o.at = [&](Vec3 p, double curvature) {
        double h = std::numeric_limits<double>::infinity();
        if (tree) h = size_near(sizes, *tree, p, o.gradation);
        if (!expression) return h;
        const double e = (*expression)({p.x, p.y, p.z, curvature});
        return e < h || std::isnan(e) ? e : h;
      };
    const bool counted = o.triangles > 0;
    const bool other =
        o.per_turn > 0 || o.chord > 0 || o.around > 0 || o.across > 0 || o.gap > 0 || !o.data.empty() || o.at;
    if (!(o.size > 0) && !(o.triangles > 0) && !other)
      o.triangles = stream.input_triangles > 0 ? stream.input_triangles : static_cast<double>(s.tris.size());

    Table* chart = nullptr;
    for (Table& t : stream.tables)
      if (t.name == "chart_vertex") chart = &t;
    o.most_triangles = most_triangles();
    SizeReport r = set_size(s, chart, o, !stream.find("ref_vertex"));
    if (has_sheets(stream) && !stream.find("ref_vertex")) r.added += match_sheets(s, chart, o.gradation);
    drop_downstream(stream, Stage::sizes);
    stream.asked_triangles = counted && met_count(r, o) ? static_cast<int>(o.triangles) : 0;
    if (r.added > 0) follow_split(stream);
    report(io, o, r, counted);
    io.write(stream);
  };
  return run_tool(
      argc, argv, "msize",
      "Set the size field: the target edge length at every vertex, the smallest of those that the options "
      "ask for.\n\n"
      "Examples:\n  msize --size 0.8 tree.stl -o sized.ply\n"
      "  msize --triangles 20000 --curvature 24 tree.stl -o sized.ply\n"
      "  msize --around 10 --max 0.1 tree.stl -o sized.ply\n"
      "  msize --expression '0.02 + 0.1 * sqrt(x^2 + y^2)' tree.stl -o sized.ply",
      [&](CLI::App& app) { add_options(app, o); }, body);
}
