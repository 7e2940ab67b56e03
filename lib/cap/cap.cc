// SPDX-License-Identifier: BSD-3-Clause
#include "lib/cap/cap.h"

#include <algorithm>

#include "lib/cap/steps.h"
#include "lib/core/largest_patch.h"
#include "lib/core/lists.h"
#include "lib/core/number.h"
#include "lib/core/take_rows.h"
#include "lib/core/topology.h"

namespace meshpipe {
namespace {

/// Share of the diagonal by which a plane rim is off for the single precision of a file: caps make it plane.
constexpr double rounding = 1e-6;
/// Share of its radius by which a rim may be off its plane and is made plane without being asked to: the
/// wobble of an extraction, up to 0.06 where vessels were clipped. Holes along a wall start at 0.17.
constexpr double almost_plane = 0.1;

/// Radii that a rim is moved at most to make it plane: one that is farther out is cut, or is no vessel's end
/// but a hole in its wall.
constexpr double most_moved = 0.25;

/// Radii by which caps that are not plane bulge, one after another until they keep off the wall.
constexpr double bulges[] = {0, 0.1, 0.2, 0.4, 0.7};
constexpr double projected = -1;  ///< a triangulation of the rim as seen along its normal, instead

constexpr const char* fill_holes = "close it with mclean --fill-holes";

using Planes = std::vector<std::optional<Plane>>;

bool is_plane(const Mesh& mesh, const End& end) { return end.planarity <= 1e-3 * rounding * diagonal(mesh); }

/// The caps to be tried for an end, one after another: membranes by their bulge, and `projected`, which is
/// plane if the rim is and comes first then. None if that is impossible: rims that cross, and are two or of
/// too many vertices.
std::vector<double> kinds_of_cap(const Mesh& mesh, const End& end) {
  std::vector<double> kinds;
  if (fits_membrane(end)) kinds.assign(std::begin(bulges), std::end(bulges));
  if (!crossing_of(mesh, end)) kinds.insert(is_plane(mesh, end) ? kinds.begin() : kinds.end(), projected);
  return kinds;
}

/// Runs the steps of treat_ends on one surface.
struct Treatment {
  Surface& surface;
  std::vector<End>& ends;
  const CapOptions& options;
  std::vector<EndReport> reports;
  Growth growth;
  std::vector<int> owner;  ///< per triangle: the end that it was made for, -1: none
  std::vector<int> like;   ///< per end: a triangle at its rim

  int n() const { return (int)ends.size(); }
  void measure_all() {
    for (End& end : ends) measure(surface, end);
  }

  bool trims(int i) const { return options.trim > 0 && (options.kept.empty() || !options.kept[i]); }
  bool extends(int i) const { return options.extend > 0 && (options.kept.empty() || !options.kept[i]); }

  Planes trim() {
    std::vector<double> length;
    std::vector<std::string> why(n());
    for (int i = 0; i < n(); ++i) {
      if (trims(i) && !(ends[i].area > 0)) why[i] = "its rim has no area";
      length.push_back(
          !trims(i) || !why[i].empty() ? 0 : options.trim * (options.trim_by_radius ? ends[i].radius : 1));
    }
    if (options.trim <= 0) return Planes(n());
    Planes planes = planes_within(surface, ends, length, why);
    cut_possible_ends(surface, ends, planes, why);
    const auto first = std::find_if(why.begin(), why.end(), [](auto& w) { return !w.empty(); });
    refuse_all(ends, why, first == why.end() || ends[first - why.begin()].area > 0 ? "cut less" : fill_holes,
               &options.kept);
    for (int i = 0; i < n(); ++i) reports[i].trimmed = length[i];
    return planes;
  }

  /// Moves rims into the planes given; returns the ends that this would fold.
  std::vector<char> flatten(const Planes& planes) {
    const std::vector<double> moved = flatten_ends(surface, ends, planes);
    std::vector<char> failed(n(), 0);
    for (int i = 0; i < n(); ++i) {
      failed[i] = moved[i] < 0;
      reports[i].moved = std::max(reports[i].moved, moved[i]);
    }
    measure_all();
    return failed;
  }

  /// Cuts off what of the ends flagged is not below all of their rims, and makes them plane. Where that would
  /// remove a branch they stay as they are.
  void cut_level(const std::vector<char>& flagged) {
    Planes planes(n());
    std::vector<double> depth(n(), 0);
    for (int i = 0; i < n(); ++i) {
      if (!flagged[i]) continue;
      const Plane plane{ends[i].center, ends[i].normal};
      double lowest = 0;
      for (const std::vector<int>& rim : ends[i].rims)
        for (int v : rim) lowest = std::min(lowest, plane.height(surface.points[v]));
      depth[i] = below_rim * ends[i].radius - lowest;
      planes[i] = Plane{plane.point - depth[i] * plane.normal, plane.normal};
    }
    std::vector<std::string> why(n());
    cut_possible_ends(surface, ends, planes, why);
    for (int i = 0; i < n(); ++i) {
      reports[i].why_not = why[i];
      if (planes[i]) reports[i].trimmed = depth[i];
    }
    split_chords(surface, ends);
    const std::vector<char> failed = flatten(planes);
    for (int i = 0; i < n(); ++i)
      if (failed[i]) refuse_to_flatten(i);
  }

  [[noreturn]] void refuse_to_flatten(int i) const {
    refuse(ends, i,
           "its rim, which is " + shown(ends[i].planarity) +
               " out of its plane, cannot be moved into it without folding or intersecting the wall; try "
               "--trim");
  }

  void make_plane(const Planes& cuts) {
    split_chords(surface, ends);
    Planes planes = cuts;
    const double noise = rounding * diagonal(surface);
    std::vector<char> winds(n(), 0);
    for (int i = 0; i < n(); ++i) {
      if (!options.flatten && !options.cap && !extends(i) && !cuts[i]) continue;
      winds[i] = !is_simple(i);
      winds[i] |= ends[i].planarity > most_moved * ends[i].radius;
      if (!cuts[i] && !winds[i] &&
          (options.flatten || ends[i].planarity <= std::max(noise, almost_plane * ends[i].radius)))
        planes[i] = Plane{ends[i].center, ends[i].normal};
    }
    std::vector<char> failed = flatten(planes);
    for (int i = 0; i < n(); ++i) {
      if (failed[i] && trims(i)) refuse_to_flatten(i);
      failed[i] |= winds[i];
    }
    if (options.flatten && std::count(failed.begin(), failed.end(), 1) > 0) cut_level(failed);
  }

  /// Returns whether a rim is a simple polygon as seen along its normal. Throws if it is not, and is neither
  /// to be cut nor to be closed as it is, by a cap that is not plane.
  bool is_simple(int i) const {
    const End& end = ends[i];
    if (!(end.area > 0)) refuse(ends, i, std::string("its rim has no area; ") + fill_holes);
    const std::string crossing = crossing_at(surface, ends[i]);
    if (!crossing.empty() && (trims(i) || (!options.flatten && (!options.cap || extends(i)))))
      refuse(ends, i,
             crossing + "; it is " + shown(end.planarity) + " out of its plane; try " +
                 (trims(i) ? "to cut more" : "--flatten or --trim"));
    return crossing.empty();
  }

  void find_faces_like() {
    const std::vector<int> opposite = opposite_halfedges(surface);
    std::vector<int> at(surface.points.size(), -1);
    for (std::size_t h = 0; h < opposite.size(); ++h)
      if (opposite[h] < 0) at[origin(surface.tris, (int)h)] = (int)h / 3;
    for (int i = 0; i < n(); ++i) like[i] = at[ends[i].rims[0][0]];
  }

  /// Ends the rims that are not plane yet by stubs. Those for which there is no space stay as they are, for a
  /// cap that is not plane; that is refused where they are to be extended, or are not to be capped.
  void raise() {
    std::vector<char> flagged(n());
    for (int i = 0; i < n(); ++i) flagged[i] = !reports[i].why_not.empty();
    const std::vector<std::string> obstacle = raise_ends(surface, ends, flagged, growth, owner);
    for (std::size_t t = 0; t < owner.size(); ++t)
      if (owner[t] >= 0) ++reports[owner[t]].stub;
    std::vector<std::string> why(n());
    for (int i = 0; i < n(); ++i) {
      if (!flagged[i]) continue;
      if (obstacle[i].empty()) {
        reports[i].why_not.clear();
        continue;
      }
      reports[i].why_not += ", and " + obstacle[i];
      if (!options.cap || extends(i))
        why[i] = "its rim, which is " + shown(ends[i].planarity) +
                 " out of its plane, cannot be made planar: " + reports[i].why_not;
    }
    refuse_all(ends, why,
               options.cap ? "try --trim, or do not extend it"
                           : "try --cap, which closes it by a cap that is not planar",
               options.cap ? &options.kept : nullptr);
    measure_all();
  }

  void extend() {
    for (int i = 0; i < n(); ++i) {
      if (!extends(i)) continue;
      reports[i].extended = options.extend * ends[i].radius;
      reports[i].extension = extend_end(surface, ends[i], reports[i].extended, growth);
      owner.resize(surface.tris.size(), i);
    }
    std::vector<std::string> why(n());
    for (const Collision& c : collisions_of_new(surface, owner)) {
      const int i = owner[c.triangle], j = owner[c.other];
      if (why[i].empty())
        why[i] = "its extension meets " +
                 (j == i  ? std::string("itself or its cap")
                  : j < 0 ? std::string("the surface")
                          : "that of " + title_of(ends, j)) +
                 " near " + shown(c.place);
    }
    refuse_all(ends, why, "extend less", &options.kept);
    measure_all();
  }

  /// Caps all ends, and those again that meet something, until none does. Throws if that is impossible.
  void cap() {
    const std::size_t before = surface.tris.size(), points = surface.points.size();
    const Growth extensions = growth;
    std::vector<std::vector<double>> kinds;
    for (int i = 0; i < n(); ++i) {
      kinds.push_back(kinds_of_cap(surface, ends[i]));
      if (kinds[i].empty()) refuse_cap(i, "would need a single rim of fewer vertices");
    }
    std::vector<int> tries(n(), 0);
    for (bool again = true; again;) {
      surface.tris.resize(before);
      surface.points.resize(points);
      growth = extensions;
      owner.resize(before);
      for (int i = 0; i < n(); ++i) {
        const double kind = kinds[i][tries[i]];
        reports[i].flat = kind == projected && is_plane(surface, ends[i]);
        reports[i].cap = kind == projected ? projected_cap(surface, ends[i], growth)
                                           : fair_cap(surface, ends[i], kind, growth);
        owner.resize(surface.tris.size(), i);
      }
      again = try_again(before, kinds, tries);
    }
  }

  /// Returns whether caps meet anything; tries[i] then counts what has failed for end i.
  bool try_again(std::size_t before, const std::vector<std::vector<double>>& kinds, std::vector<int>& tries) {
    std::vector<char> flagged(before, 0), meets(n(), 0);
    flagged.resize(surface.tris.size(), 1);
    for (const Collision& c : collisions(surface, flagged)) {
      const int i = owner[c.triangle];
      if (tries[i] + 1 == (int)kinds[i].size())
        refuse_cap(i, "would meet the surface near " + shown(c.place));
      meets[i] = 1;
    }
    for (int i = 0; i < n(); ++i) tries[i] += meets[i];
    return std::count(meets.begin(), meets.end(), 1) > 0;
  }

  [[noreturn]] void refuse_cap(int i, const std::string& why) const {
    const std::string crossing = crossing_at(surface, ends[i]);
    refuse(
        ends, i,
        (crossing.empty() ? "" : crossing + "; ") + "its cap " + why + "; its rim is " +
            shown(ends[i].planarity) + " out of its plane; try " +
            (options.flatten || ends[i].planarity <= rounding * diagonal(surface) ? "--trim" : "--flatten"));
  }

  /// Gives columns to all that was added, new patches, and model edges around them.
  void finish() {
    std::vector<int> rows = identity(surface.vertex.rows);
    rows.insert(rows.end(), growth.vertex_like.begin(), growth.vertex_like.end());
    take_rows(surface.vertex, rows);
    const std::size_t before = surface.face.rows;
    rows = identity(before);
    for (std::size_t t = before; t < surface.tris.size(); ++t) rows.push_back(like[owner[t]]);
    take_rows(surface.face, rows);
    if (!surface.face.has("model")) surface.face.set("model", std::vector<std::uint8_t>(surface.tris.size()));
    std::vector<int>& patch = surface.face.get<int>("patch");
    std::size_t more = 0;
    for (const EndReport& r : reports) more += (r.cap > 0) + (r.extension > 0);
    int next = largest_patch(patch, more) + 1;
    const int first_new = next;
    for (EndReport& r : reports)
      if (r.cap) r.cap_patch = next++;
    for (EndReport& r : reports)
      if (r.extension) r.extension_patch = next++;
    std::size_t t = before;
    for (const EndReport& r : reports) t += (std::size_t)r.stub;  // their patch is the wall's
    for (const EndReport& r : reports)
      for (int k = 0; k < r.extension; ++k) patch[t++] = r.extension_patch;
    for (const EndReport& r : reports)
      for (int k = 0; k < r.cap; ++k) patch[t++] = r.cap_patch;
    if (t > before) mark_borders(first_new);
  }

  /// Marks the borders of patches from `first` on as model edges.
  void mark_borders(int first) {
    const auto& patch = surface.face.get<int>("patch");
    auto& model = surface.face.get<std::uint8_t>("model");
    for (std::size_t t = 0; t < owner.size(); ++t)
      if (owner[t] >= 0) model[t] = 0;
    const std::vector<int> opposite = opposite_halfedges(surface);
    for (int h = 0; h < (int)opposite.size(); ++h) {
      const int g = opposite[h];
      if (g < 0 || patch[h / 3] == patch[g / 3] || std::max(patch[h / 3], patch[g / 3]) < first) continue;
      model[h / 3] |= (std::uint8_t)(1 << h % 3);
      model[g / 3] |= (std::uint8_t)(1 << g % 3);
    }
  }
};

}  // namespace

std::vector<EndReport> treat_ends(Surface& surface, std::vector<End>& ends, const CapOptions& options) {
  const std::size_t n = ends.size();
  Treatment work{surface, ends, options, std::vector<EndReport>(n), {}, {}, std::vector<int>(n, 0)};
  if (!surface.face.has("patch")) surface.face.set("patch", std::vector<int>(surface.tris.size(), 1));
  if (n == 0) return {};
  work.make_plane(work.trim());
  work.find_faces_like();
  work.owner.assign(surface.tris.size(), -1);
  work.growth.first = surface.points.size();
  work.raise();
  if (options.extend > 0) work.extend();
  if (options.cap) work.cap();
  work.finish();
  return work.reports;
}

}  // namespace meshpipe
