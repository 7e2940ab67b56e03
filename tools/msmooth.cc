// SPDX-License-Identifier: BSD-3-Clause
// msmooth: smooth a segmentation within a bound.
#include "formats/stream/model_edges.h"
#include "formats/stream/region_tables.h"
#include "formats/stream/stages.h"
#include "lib/smooth/smooth.h"
#include "tools/common.h"

using namespace meshpipe;

namespace {

void report(Io& io, const SmoothReport& r) {
  for (const std::string& line : describe(r)) io.say(line);
  io.report = {{"within", r.within},
               {"farthest", r.farthest},
               {"farthest_at", {r.farthest_at.x, r.farthest_at.y, r.farthest_at.z}},
               {"volume", r.volume},
               {"volume_change", r.volume_change},
               {"region_change", r.region_change},
               {"angle_before", r.angle_before},
               {"angle_after", r.angle_after},
               {"bounded_vertices", r.bounded},
               {"moved_back_vertices", r.moved_back},
               {"planar_ends", r.planar_ends},
               {"kept_ends", r.kept_ends}};
}

/// Drops what holds only for the surface as it was: parts and charts, and all of a former remeshing.
void drop_stale(Stream& stream) {
  if (stream.find("ref_vertex")) {
    stream.tables.clear();
    for (const char* column : {"ref_face", "b1", "b2", "kind", "line"}) stream.surface.vertex.erase(column);
  }
  drop_downstream(stream, Stage::parts);
  for (const char* column : {"part", "origin"}) stream.surface.face.erase(column);
  for (const char* table : {"part", "line", "line_use", "line_vertex", "fine_vertex", "fine_face"})
    stream.erase(table);
}

}  // namespace

int main(int argc, char** argv) {
  SmoothOptions o;
  std::string within;
  return run_tool(
      argc, argv, "msmooth",
      "Smooth the stairs of a segmentation. No vertex moves farther than a bound.\n\n"
      "Examples:\n  mshape tree --voxels 0.05 | mclean | msmooth -o smooth.ply\n"
      "  mclean tree.stl | msmooth --within 0.02 -o smooth.stl",
      [&](CLI::App& app) {
        app.add_option(
               "--within", within,
               "largest displacement of a vertex: a length, or % of the bounding box's diagonal (default: "
               "the mean edge length, about a voxel)")
            ->type_name("D");
        app.add_flag("--keep-features", o.keep_features,
                     "do not move vertices of model edges (see mfeature)");
      },
      [&](Io& io) {
        if (!within.empty() && parse_length(within, 1).value_or(0) <= 0)
          throw BadUsage("--within: expected a positive length or a percentage of the diagonal, found '" +
                         within + "'");
        io.names_way_out = false;  // the messages have the number that helps
        Stream& stream = io.read();
        Surface& s = stream.surface;
        if (!within.empty() && !s.tris.empty()) o.within = *parse_length(within, diagonal(s));
        if (o.keep_features && !s.face.has("model"))
          throw NotAdmissible("no face column 'model'; run mfeature first");
        // lines that came with a file, and those of mfeature, by their place
        const ModelSegments lines = stream.history.empty() ? segments_of(stream) : read_model_edges(stream);
        const bool sheets = has_sheets(stream);
        if (sheets) flip_ears(s);
        const std::vector<int> under = segments_under(s, lines);
        const SmoothReport r = sheets ? smooth_sheets(s, o) : smooth(s, o);
        drop_stale(stream);
        update_volumes(stream);
        write_model_edges(stream, moved_segments(lines, under, s, under));
        report(io, r);
        io.write(stream);
      });
}
