// SPDX-License-Identifier: BSD-3-Clause
#include "tools/compare.h"

#include "formats/stream/lift_tables.h"
#include "formats/stream/line_tables.h"
#include "formats/stream/region_tables.h"
#include "lib/clean/clean.h"
#include "lib/core/error.h"
#include "lib/core/junctions.h"
#include "lib/core/lists.h"
#include "lib/core/take_rows.h"
#include "lib/core/union_find.h"
#include "lib/core/weld.h"
#include "lib/feature/feature.h"
#include "tools/report/verdict.h"

namespace meshpipe {
namespace {

/// Files as STL hold every triangle on its own.
bool is_soup(const Mesh& m) { return m.points.size() == 3 * m.tris.size() && m.tris.size() > 1; }

bool has_patch_names(const Stream& stream) {
  return std::any_of(stream.names.begin(), stream.names.end(), [](const Name& n) { return n.dim == 2; });
}

/// Compares the patches of two files by name, or by number unless both have names. A file of one patch may be
/// of a format without patches.
std::vector<PatchFault> compare_patches(const Io& io, const Stream& reference, const Surface& surface,
                                        const Stream& result, const Findings& f) {
  const bool named = has_patch_names(result) && has_patch_names(reference);
  auto number = [](int label) { return std::to_string(label); };
  auto name = [&](const Stream& of) { return named ? namer(of) : number; };
  const std::vector<Patch> before = patches_of(surface, {}, name(reference)),
                           after = patches_of(result.surface, f.mesh.opposite, name(result));
  if (before.size() < 2) return {};
  if (after.size() < 2) {
    io.say("the result is not divided into patches: they are not compared");
    return {};
  }
  if (has_patch_names(reference) && !named)
    io.say("the result has no names of patches: they are compared by their numbers");
  return compare_patches(before, after);
}

/// Gives each fan of triangles at a vertex a copy of its own, as files do not that merge equal points.
void part_fans(Surface& s, const Soundness& found) {
  const std::vector<int>& opposite = found.opposite;
  UnionFind fan(opposite.size());  // of corners
  for (int h = 0; h < (int)opposite.size(); ++h)
    if (opposite[h] >= 0) fan.join(h, next(opposite[h]));
  std::vector<int> rows = identity(s.points.size()), first(rows.size(), -1), copy(opposite.size(), -1);
  for (int h = 0; h < (int)opposite.size(); ++h) {
    int& v = s.tris[h / 3][h % 3];
    int &at = copy[fan.find(h)], &taken = first[v];
    if (at < 0) at = std::exchange(taken, 0) < 0 ? v : (int)rows.size();
    if (at == (int)rows.size()) rows.push_back(v);
    v = at;
  }
  for (std::size_t i = s.points.size(); i < rows.size(); ++i) s.points.push_back(s.points[rows[i]]);
  take_rows(s.vertex, rows);
}

/// Cleans the reference; where its sheets meet, takes those of both surfaces apart. Returns whether they do.
/// `apart`: are those of the result so already? Adds to `faults` what else would be repaired in the result.
bool clean_both(Surface& reference, Surface& result, bool apart, std::vector<std::string>& faults) {
  CleanReport report;
  clean(reference, {.sheets = CleanOptions::automatic}, report);
  if (is_soup(result)) weld(result);
  if (report.nonmanifold_vertices > 0)
    if (const Soundness found = soundness_of(result);
        !found.pinched.empty() && (int)found.pinched.size() <= report.nonmanifold_vertices)
      part_fans(result, found);
  if (!report.sheets.kept) return false;
  // what the reference itself has is no fault of the result
  const bool as_given = take_apart(reference).reversed + report.flipped + report.welded == 0;
  if (apart)
    join_borders(result);
  else if (const std::vector<int> slits = slits_of(result); !slits.empty() && as_given)
    faults.push_back(std::to_string(slits.size()) + " triangles are along slits, the first is triangle " +
                     std::to_string(slits[0]));
  result.vertex = Table{"vertex", result.points.size(), {}};
  if (const int reversed = take_apart(result).reversed; reversed > 0 && as_given)
    faults.push_back(std::to_string(reversed) + (reversed == 1 ? " sheet is" : " sheets are") +
                     " inside out");
  return true;
}

/// Finds the creases that are cut off; in a file without lines, those that mfeature would find.
std::vector<int> cut_creases(const Surface& result, const Findings& f, const Surface& reference, bool own) {
  const Connectivity mesh{result, f.mesh.opposite};
  if (own || reference.face.has("model")) return find_cut_creases(mesh, reference);
  Surface marked = reference;
  mark_features(marked, {});
  return find_cut_creases(mesh, marked);
}

}  // namespace

Findings compare(const Io& io, Stream& stream, const std::string& file, const Contract& contract, int samples,
                 Surface& reference, double least_size, const std::vector<ShareFindings>* shares) {
  Surface& result = stream.surface;
  const bool own = file.empty();
  Stream other;
  Lines lines;
  bool meet = has_sheets(stream);
  std::vector<std::string> faults;
  if (own) {
    reference = read_reference(stream);
    if (stream.find("line_use")) lines = read_lines(stream);
  } else {
    other = io.read(file);
    reference = std::move(other.surface);
    meet = clean_both(reference, result, meet, faults);
  }
  expect_measurable(reference);
  if (result.tris.empty()) throw NotAdmissible("the result has no triangles");
  const double removed = own ? moved_in(stream) / diagonal(reference) : 0;
  Findings f = examine(result, reference, own ? &lines : nullptr, samples,
                       required_distance(contract) - removed, meet, least_size, shares);
  f.distance.bound += removed;
  f.edges.cut_creases = cut_creases(result, f, reference, own);
  if (meet) {
    f.sheets = compare_sheets(reference, result, read_sheets(stream), own, f.reference_pairs.all == 0);
    f.sheets->faults.insert(f.sheets->faults.end(), faults.begin(), faults.end());
  }
  if (own)
    f.patch_faults = compare_patches(patches_of(reference, {}, namer(stream)),
                                     patches_of(result, f.mesh.opposite, namer(stream)));
  else if (!meet)
    f.patch_faults = compare_patches(io, other, reference, stream, f);
  return f;
}

double distance_to_know(const Stream& stream, const Contract& contract, const Surface& reference) {
  return required_distance(contract) - moved_in(stream) / diagonal(reference);
}

}  // namespace meshpipe
