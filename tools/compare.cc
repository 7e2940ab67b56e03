// SPDX-License-Identifier: BSD-3-Clause
#include "tools/compare.h"

#include "formats/stream/lift_tables.h"
#include "formats/stream/line_tables.h"
#include "formats/stream/region_tables.h"
#include "lib/clean/clean.h"
#include "lib/core/error.h"
#include "lib/core/junctions.h"
#include "lib/core/weld.h"
#include "tools/report/verdict.h"

namespace meshpipe {
namespace {

/// Files as STL hold every triangle on its own.
bool is_soup(const Mesh& m) { return m.points.size() == 3 * m.tris.size() && m.tris.size() > 1; }

/// Cleans the reference; where its sheets meet, takes those of both surfaces apart. Returns whether they do.
bool clean_both(Surface& reference, Surface& result) {
  CleanReport report;
  clean(reference, {.sheets = CleanOptions::automatic}, report);
  if (is_soup(result)) weld(result);
  if (!report.sheets.kept) return false;
  take_apart(reference);
  join_borders(result);
  result.vertex = Table{"vertex", result.points.size(), {}};
  take_apart(result);
  return true;
}

}  // namespace

Findings compare(const Io& io, Stream& stream, const std::string& file, const Contract& contract, int samples,
                 Surface& reference, double least_size, const std::vector<ShareFindings>* shares) {
  Surface& result = stream.surface;
  const bool own = file.empty();
  Stream other;
  Lines lines;
  bool meet = has_sheets(stream);
  if (own) {
    reference = read_reference(stream);
    if (stream.find("line_use")) lines = read_lines(stream);
  } else {
    other = io.read(file);
    reference = std::move(other.surface);
    meet = clean_both(reference, result);
  }
  expect_measurable(reference);
  if (result.tris.empty()) throw NotAdmissible("the result has no triangles");
  const double removed = own ? moved_in(stream) / diagonal(reference) : 0;
  Findings f = examine(result, reference, own ? &lines : nullptr, samples,
                       required_distance(contract) - removed, meet, least_size, shares);
  f.distance.bound += removed;
  if (meet)
    f.sheets = compare_sheets(reference, result, read_sheets(stream), own, f.reference_intersections == 0);
  const std::vector<Patch> patches = patches_of(result, f.mesh.opposite, namer(stream));
  // a file that holds one patch comes from a format without patches, as a rule
  if (own || (!meet && patches.size() > 1))
    f.patch_faults = compare_patches(patches_of(reference, {}, namer(own ? stream : other)), patches);
  return f;
}

double distance_to_know(const Stream& stream, const Contract& contract, const Surface& reference) {
  return required_distance(contract) - moved_in(stream) / diagonal(reference);
}

}  // namespace meshpipe
