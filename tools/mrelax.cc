// SPDX-License-Identifier: BSD-3-Clause
// mrelax: optimize a lifted mesh on its reference surface, across interfaces that are not model edges.
#include "formats/stream/lift_tables.h"
#include "formats/stream/line_tables.h"
#include "formats/stream/region_tables.h"
#include "formats/stream/second_order.h"
#include "formats/stream/tile_tables.h"
#include "lib/clean/clean.h"
#include "lib/core/triangle_count.h"
#include "lib/lift/lift.h"
#include "lib/relax/relax.h"
#include "tools/common.h"
#include "tools/on_reference.h"
#include "tools/relax_shards.h"
#include "tools/report/relax_report.h"

using namespace meshpipe;

namespace {

struct Options {
  RelaxOptions relax;
  std::string reference;
  bool accept = false;
  ShardFiles shards;
};

/// The reference from a file, with the columns that earlier stages would have written.
Surface reference_from(const Stream& file, std::size_t triangles) {
  Surface s = file.surface;
  clean(s);
  if (s.tris.empty() || triangles == 0) throw NotAdmissible("the mesh or its reference has no triangles");
  if (!s.vertex.has("size"))
    s.vertex.set("size",
                 std::vector<double>(s.points.size(), size_for_count(total_area(s), (double)triangles)));
  if (!s.face.has("part")) s.face.set("part", std::vector<int>(s.tris.size()));
  return s;
}

/// The number of triangles that the last msize was given; 0 if none, or if bounds of sizes may forbid it.
int count_given(const Stream& stream) {
  for (auto p = stream.history.rbegin(); p != stream.history.rend(); ++p) {
    if (p->program != "msize") continue;
    const std::string all = ' ' + p->arguments, option = " --triangles=";
    const std::size_t at = all.find(option);
    if (at == all.npos || all.find(" --max=") != all.npos || all.find(" --min=") != all.npos) return 0;
    return (int)std::clamp(std::strtod(all.c_str() + at + option.size(), nullptr), 0.0, 1e9);
  }
  return 0;
}

/// The number of triangles of the input if msize took it for want of options; else 0.
int count_by_default(const Stream& stream) {
  for (auto p = stream.history.rbegin(); p != stream.history.rend(); ++p)
    if (p->program == "msize")
      return p->arguments.find("--") == std::string::npos ? stream.input_triangles : 0;
  return 0;
}

/// What is optimized: see relax.
struct Task {
  LiftedMesh mesh;
  Surface reference;
  std::vector<int> kinds;
  std::vector<char> corners;
};

/// Takes the task from the stream, and the options that it brings.
Task read_task(Io& io, Options& o) {
  Stream& stream = io.stream;
  Task task;
  Surface& reference = task.reference;
  if (o.reference.empty()) {
    stream.need("ref_face", "mlift"), stream.need("line", "mlines");  // what is missed first
    reference = read_reference(stream);
    expect_measurable(reference);
    const Lines lines = read_lines(stream);
    for (const Line& l : lines.lines) {
      task.kinds.push_back(l.kind);
      o.relax.keep_border = o.relax.keep_border || l.kept;
    }
    o.relax.target_triangles = stream.asked_triangles;
    o.relax.keep_count = count_given(stream) > 0;
    o.relax.sheets_meet = has_sheets(stream);
    if (!reference.face.has("curved")) o.relax.sheets = read_sheets(stream);
    if (o.shards.count > 0) stream.tables = {};  // frees its memory now
    if (!o.shards.from.empty()) return task;     // its tiles have the rest
    task.corners = line_corners(reference, lines);
    task.mesh = take_lifted(stream.surface, (int)reference.tris.size(), (int)task.kinds.size());
    return task;
  }
  clean(stream.surface);
  reference = reference_from(io.read(o.reference), stream.surface.tris.size());
  task.mesh = place_on(stream.surface, reference);
  task.corners = model_corners(reference);
  write_reference(stream, reference);
  if (stream.find("line_use"))  // lines on another surface
    for (const char* table : {"line", "line_use", "line_vertex"}) stream.erase(table);
  return task;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  auto add_options = [&](CLI::App& app) {
    app.add_option(
           "--sweeps", o.relax.sweeps,
           "number of sweeps of flips and moves, each of which restores the triangle count (default 4)")
        ->check(CLI::Range(0, 1000))
        ->type_name("N");
    auto* reference =
        app.add_option("--reference", o.reference, "optimize any oriented manifold mesh on this surface")
            ->type_name("FILE");
    app.add_option("--tile", o.relax.tile,
                   "optimize meshes of more than 4 N triangles in tiles of at most N (default 250000)")
        ->check(CLI::Range(100, 100000000))
        ->type_name("N");
    app.add_flag("--accept", o.accept, "write the mesh even if triangles still intersect")->group("Reports");
    add_shard_options(app, o.shards, "of tiles", reference);
  };
  auto body = [&](Io& io) {
    const bool cuts = o.shards.count > 0, joins = !o.shards.from.empty();
    if (cuts) expect_only_shards(io);
    // where tiles come, the mesh is what they are joined to
    Stream& stream = io.read([&](std::string_view table, std::string_view) {
      return !joins || (table != "vertex" && table != "face");
    });
    if (is_tile(stream)) {
      if (cuts || joins || !o.reference.empty())
        throw BadUsage("the input is a shard; expected the stream that shards are cut from");
      return relax_shard(io, o.relax.sweeps);
    }
    Task task = read_task(io, o);
    const Surface& reference = task.reference;
    const bool second_order = stream.find("mid_vertex") != nullptr;
    stream.surface = {};  // written anew later; frees its memory now
    RelaxReport r;
    if (joins)
      r = join_shards(io, task.mesh, reference, o.relax, o.shards);
    else if (cuts)
      cut_into_shards(io, std::move(task.mesh), {reference, task.kinds, task.corners, o.relax}, o.shards);
    else
      r = relax(task.mesh, reference, task.kinds, task.corners, o.relax);
    if (cuts) return;
    const std::string exceptions = write_on_reference(stream, std::move(task.mesh), reference, second_order);
    if (!exceptions.empty()) io.say(exceptions);
    const std::size_t triangles = stream.surface.tris.size();
    for (const std::string& line : relax_lines(
             r, triangles, std::max(stream.asked_triangles, count_given(stream)), count_by_default(stream)))
      io.say(line);
    io.report.update(relax_record(r, triangles));
    const std::string missed = left_over(r, stream.surface);
    if (!missed.empty() && !o.accept) throw GoalMissed(missed);
    if (!missed.empty()) io.say("accepted: " + missed);
    io.write(stream);
  };
  return run_tool(
      argc, argv, "mrelax",
      "Optimize a lifted mesh on the surface it was made from, by flips, collapses, splits and moves of "
      "vertices, across all interfaces that are not model edges.\n\n"
      "Examples:\n"
      "  mremesh -q --keep s tree.stl -o a.stl && mrelax --sweeps 20 s/11-lift.ply -o relaxed.ply\n"
      "  mclean tree.stl | mrelax --reference tree.stl -o better.ply",
      add_options, body, {.shards = true});
}
