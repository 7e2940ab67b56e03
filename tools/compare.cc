// SPDX-License-Identifier: BSD-3-Clause
#include "tools/compare.h"

#include "formats/stream/lift_tables.h"
#include "formats/stream/line_tables.h"
#include "formats/stream/region_tables.h"
#include "lib/clean/clean.h"
#include "lib/core/error.h"
#include "lib/core/junctions.h"
#include "lib/core/weld.h"
#include "lib/feature/feature.h"
#include "tools/report/verdict.h"

namespace meshpipe {
namespace {

/// Files as STL hold every triangle on its own.
bool is_soup(const Mesh& m) { return m.points.size() == 3 * m.tris.size() && m.tris.size() > 1; }

/// Is the result of a format without patches? These are read as patch 0 or 1 without a name.
bool has_no_patches(const std::vector<Patch>& patches) {
  return patches.empty() || (patches.size() == 1 && (patches[0].name == "0" || patches[0].name == "1"));
}

bool has_patch_names(const Stream& stream) {
  return std::any_of(stream.names.begin(), stream.names.end(), [](const Name& n) { return n.dim == 2; });
}

/// Compares the patches of two files by name, or by number if the result has no names. A reference of one
/// patch without a name is not divided.
std::vector<PatchFault> compare_patches(const Io& io, const Stream& reference, const Surface& surface,
                                        const Stream& result, const Findings& f) {
  const bool named = has_patch_names(result), names = has_patch_names(reference);
  auto number = [](int label) { return std::to_string(label); };
  const std::vector<Patch> before = patches_of(surface, {}, named ? namer(reference) : number),
                           after = patches_of(result.surface, f.mesh.opposite, namer(result));
  if (before.size() < 2 && !names) return {};
  if (has_no_patches(after)) {
    io.say("the result is not divided into patches: they are not compared");
    return {};
  }
  if (names && !named) io.say("the result has no names of patches: they are compared by their numbers");
  return compare_patches(before, after);
}

/// Cleans the reference; where its sheets meet, takes those of both surfaces apart. Returns whether they do.
/// `apart`: are those of the result so already? Adds to `faults` what else would be repaired in the result.
bool clean_both(Surface& reference, Surface& result, bool apart, std::vector<std::string>& faults) {
  CleanReport report;
  clean(reference, {.sheets = CleanOptions::automatic}, report);
  if (is_soup(result)) weld(result);
  // some files join the copies of vertices that keep fans apart
  if (report.nonmanifold_vertices > 0 && !soundness_of(result).pinched.empty()) split_sheets(result);
  if (!report.sheets.kept) return false;
  const bool as_given = take_apart(reference).reversed + report.flipped == 0;
  if (apart)
    join_borders(result);
  else if (const std::vector<int> slits = slits_of(result); !slits.empty())
    faults.push_back(std::to_string(slits.size()) + " triangles are along slits, the first is triangle " +
                     std::to_string(slits[0]));
  result.vertex = Table{"vertex", result.points.size(), {}};
  if (const int reversed = take_apart(result).reversed; reversed > 0 && as_given)
    faults.push_back(std::to_string(reversed) + (reversed == 1 ? " sheet is" : " sheets are") +
                     " inside out");
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
  if (!own && !reference.face.has("model")) mark_features(reference, {});
  if (result.tris.empty()) throw NotAdmissible("the result has no triangles");
  const double removed = own ? moved_in(stream) / diagonal(reference) : 0;
  Findings f = examine(result, reference, own ? &lines : nullptr, samples,
                       required_distance(contract) - removed, meet, least_size, shares);
  f.distance.bound += removed;
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
