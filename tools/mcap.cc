// SPDX-License-Identifier: BSD-3-Clause
// mcap: the open ends of a vessel listed, cut back, made planar, extended and capped.
#include <algorithm>

#include "formats/foreign/end_names.h"
#include "formats/stream/model_edges.h"
#include "formats/stream/region_tables.h"
#include "lib/cap/cap.h"
#include "lib/core/number.h"
#include "tools/common.h"
#include "tools/files.h"

using namespace meshpipe;

namespace {

struct Options : CapOptions {
  std::string length, name_file, at, except;
  bool list = false;
};

/// Reads the value of --trim: a length, a share of the diagonal, or a number of radii.
void parse_trim(Options& o, double diagonal) {
  if (o.length.empty()) return;
  o.trim_by_radius = o.length.back() == 'r';
  const std::string number = o.length.substr(0, o.length.size() - o.trim_by_radius);
  const std::optional<double> value = parse_length(number, diagonal);
  if (!value || *value <= 0 || (o.trim_by_radius && number.ends_with('%')))
    throw BadUsage("--trim: expected a length, a percentage or a number of radii such as 1.5r, found '" +
                   o.length + "'");
  o.trim = *value;
}

/// One line per end, columns separated by tabs, with a head.
std::string table_of(const std::vector<End>& ends) {
  std::string text = "end\tname\tx\ty\tz\tnx\tny\tnz\tarea\tradius\troundness\tplanarity\tvertices\tloops\n";
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const End& e = ends[i];
    std::size_t vertices = 0;
    for (const std::vector<int>& rim : e.rims) vertices += rim.size();
    text += std::to_string(i + 1) + '\t' + e.name;
    for (double x : {e.center.x, e.center.y, e.center.z, e.normal.x, e.normal.y, e.normal.z, e.area, e.radius,
                     e.roundness, e.planarity})
      text += '\t' + shown(x);
    text += '\t' + std::to_string(vertices) + '\t' + std::to_string(e.rims.size()) + '\n';
  }
  return text;
}

/// Radii by which a rim is moved without a word: the rounding of files.
constexpr double hardly_moved = 1e-3;

/// Says at how many ends something was done to make them plane, and how much at most: `amount` of an end.
template <class Amount>
void report_most(Io& io, const std::vector<End>& ends, const char* one, const char* many, Amount amount) {
  int count = 0;
  std::size_t most = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    count += amount(i) > 0;
    if (amount(i) > amount(most)) most = i;
  }
  if (count > 0)
    io.say(std::to_string(count) + (count == 1 ? one : many) + shown(amount(most)) + ", at " +
           ends[most].name);
}

void report_plane(Io& io, const std::vector<End>& ends, const std::vector<EndReport>& done, bool trims) {
  report_most(
      io, ends, " rim is moved into its plane, by ", " rims are moved into their planes, by at most ",
      [&](std::size_t i) { return done[i].moved > hardly_moved * ends[i].radius ? done[i].moved : 0; });
  if (!trims)
    report_most(io, ends, " end is trimmed to be planar, by ", " ends are trimmed to be planar, by at most ",
                [&](std::size_t i) { return done[i].trimmed; });
  const auto stubs = std::count_if(done.begin(), done.end(), [](const EndReport& r) { return r.stub > 0; });
  if (stubs > 0)
    io.say(std::to_string(stubs) + (stubs == 1 ? " end is" : " ends are") + " raised to a plane by a stub");
}

void report(Io& io, const std::vector<End>& ends, const std::vector<EndReport>& done, bool flatten) {
  int not_plane = 0;
  io.report["ends"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const End& e = ends[i];
    const EndReport& r = done[i];
    io.report["ends"].push_back({{"name", e.name},
                                 {"center", {e.center.x, e.center.y, e.center.z}},
                                 {"normal", {e.normal.x, e.normal.y, e.normal.z}},
                                 {"area", e.area},
                                 {"radius", e.radius},
                                 {"roundness", e.roundness},
                                 {"planarity", e.planarity},
                                 {"loops", e.rims.size()},
                                 {"trimmed", r.trimmed},
                                 {"moved", r.moved},
                                 {"extended", r.extended},
                                 {"stub_triangles", r.stub},
                                 {"cap_triangles", r.cap},
                                 {"flat", r.flat},
                                 {"why_not", r.why_not}});
    std::string line = e.name + ": at " + shown(e.center) + ", radius " + shown(e.radius);
    if (r.trimmed > 0) line += ", cut back by " + shown(r.trimmed);
    if (r.moved > 0) line += ", moved by " + shown(r.moved);
    if (r.extended > 0) line += ", extended by " + shown(r.extended);
    if (r.stub > 0) line += ", stub of " + std::to_string(r.stub) + " triangles";
    if (r.cap > 0) line += r.flat ? ", flat cap" : ", cap out of plane by " + shown(e.planarity);
    if (!r.why_not.empty()) line += ": " + r.why_not;
    if (r.cap > 0 && !r.flat)
      io.say(line);
    else
      io.detail(line);
    not_plane += r.cap > 0 && !r.flat;
  }
  if (not_plane > 0 && !flatten)
    io.say(std::to_string(not_plane) + (not_plane == 1 ? " cap is" : " caps are") +
           " not planar, since the rim is not; --flatten cuts or raises such ends");
}

/// Throws: NotAdmissible if a new patch, with a tag from `first` on, has the name of another: solvers tell
/// them apart by it.
void expect_different(const std::vector<Name>& names, int first) {
  for (const Name& n : names)
    for (const Name& m : names)
      if (n.dim == 2 && m.dim == 2 && n.tag >= first && n.tag != m.tag && n.text == m.text)
        throw NotAdmissible("two patches would be named '" + n.text + "'; --names gives ends other names");
}

/// Names new patches after their ends, and a single one that is not named: wall.
void name_patches(Stream& stream, const std::vector<End>& ends, const std::vector<EndReport>& done) {
  const std::vector<int>& patch = stream.surface.face.get<int>("patch");
  std::vector<int> added;
  for (std::size_t i = 0; i < ends.size(); ++i)
    for (const auto& [tag, more] :
         {std::pair{done[i].cap_patch, ""}, std::pair{done[i].extension_patch, "_extension"}})
      if (tag > 0) {
        stream.names.push_back({2, tag, ends[i].name + more});
        added.push_back(tag);
      }
  if (added.empty()) return;
  const auto [first, last] = std::minmax_element(added.begin(), added.end());
  const int least = *first;
  stream.remarks.push_back(remark_of({least, *last}));
  const bool one =
      std::all_of(patch.begin(), patch.end(), [&](int p) { return p >= least || p == patch[0]; });
  if (one && stream.name_of(2, patch[0]).empty()) stream.names.push_back({2, patch[0], "wall"});
  expect_different(stream.names, least);
}

void run(Io& io, Options& o) {
  if (!o.length.empty()) parse_trim(o, 1);
  if (!o.name_file.empty()) expect_readable(o.name_file);
  const std::string chosen = o.at + o.except;
  if (!chosen.empty() && o.length.empty() && !(o.extend > 0))
    throw BadUsage("--at and --except choose the ends for --trim and --extend");
  Stream& stream = io.read();
  Surface& surface = stream.surface;
  expect_no_sheets(stream, "the lines where they meet are no open ends");
  parse_trim(o, diagonal(surface));
  if (const int n = orient_outward(surface))
    io.say(std::to_string(n) + (n == 1 ? " surface was" : " surfaces were") +
           " inside out: all triangles of it are reversed");
  std::vector<End> ends = find_ends(surface);
  if (!o.name_file.empty()) name_ends(ends, read_end_names(read_bytes(o.name_file), o.name_file));
  if (!chosen.empty()) o.kept = ends_in(ends, chosen);
  if (!o.at.empty())
    for (char& kept : o.kept) kept = !kept;
  if (o.list && io.output == "-") {
    report(io, ends, std::vector<EndReport>(ends.size()), o.flatten);
    return io.write_bytes(table_of(ends));
  }
  io.say(std::to_string(ends.size()) + (ends.size() == 1 ? " open end" : " open ends"));
  if (ends.empty() && (o.trim > 0 || o.extend > 0))
    throw NotAdmissible("the surface has no open end to " + std::string(o.trim > 0 ? "cut back" : "extend"));
  if (ends.empty() && (o.flatten || o.cap)) io.warn("warning: no open ends: nothing is flattened or capped");
  if (ends.empty() || !(o.trim > 0 || o.flatten || o.extend > 0 || o.cap)) {
    report(io, ends, std::vector<EndReport>(ends.size()), o.flatten);
  } else {
    const double area = total_area(surface);
    const ModelSegments lines = read_model_edges(stream);
    const Mesh before = surface;
    const std::vector<EndReport> done = treat_ends(surface, ends, o);
    report_plane(io, ends, done, o.trim > 0);
    report(io, ends, done, o.flatten);
    name_patches(stream, ends, done);
    // nothing that is known of the surface as it was holds; the number of triangles that stands for its size
    // grows with it
    stream.tables.clear();
    write_model_edges(stream, segments_after_ends(lines, before, surface));
    for (const char* column : {"part", "origin"}) surface.face.erase(column);
    for (const char* column : {"ref_face", "b1", "b2", "kind", "line"}) surface.vertex.erase(column);
    if (stream.input_triangles > 0 && area > 0)
      stream.input_triangles =
          (int)std::min(7e8, stream.input_triangles * (total_area(surface) / area) + 0.5);
  }
  if (o.list) Io::write_file("-", table_of(ends));
  io.write(stream);
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  return run_tool(
      argc, argv, "mcap",
      "List the open ends of a surface; trim, flatten, extend and cap them.\n\n"
      "Examples:\n  mclean tree.stl | mcap --list\n"
      "  mclean tree.stl | mcap --flatten --cap -o closed.ply\n"
      "  mclean tree.stl | mcap --trim 0.5r --extend 3 --cap -o model.ply",
      [&](CLI::App& app) {
        app.add_flag("--list", o.list,
                     "write a table of the ends to standard output; write the surface only with -o FILE")
            ->group("Reports");
        app.add_option(
               "--names", o.name_file,
               "names of ends, one per line: NAME X Y Z for the end nearest to that point, NAME for the "
               "next one by area (default: inlet, outlet_1 ...)")
            ->type_name("FILE");
        app.add_option(
               "--trim", o.length,
               "cut off this much of each end: a length, % of the diagonal, or radii of the end (0.5r)")
            ->type_name("L|P%|Kr");
        auto* at = app.add_option("--at", o.at, "trim and extend only these ends (names or numbers)")
                       ->type_name("END,...");
        app.add_option("--except", o.except, "trim and extend all ends except these")
            ->type_name("END,...")
            ->excludes(at);
        app.add_flag("--flatten", o.flatten, "make all rims planar: move, cut or raise them");
        app.add_option("--extend", o.extend,
                       "extend each end along its normal by K of its radii, to a circular section")
            ->check(positive_number())
            ->type_name("K");
        app.add_flag(
            "--cap", o.cap,
            "close each end by a cap, a patch with the end's name; almost planar rims are made planar");
      },
      [&](Io& io) { run(io, o); });
}
