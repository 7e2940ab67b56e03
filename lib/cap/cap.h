// SPDX-License-Identifier: BSD-3-Clause
// The open ends of a surface, such as a vessel's: cut back, made planar, extended and capped.
#pragma once
#include <string>
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// An open end: a border loop, or two of which one lies within the other, as at the end of a thick wall.
struct End {
  std::string name;
  /// Vertices of each loop, the outer one first; it is counterclockwise as seen from outside.
  std::vector<std::vector<int>> rims;
  Vec3 center;           ///< mean over the length of the rims
  Vec3 normal;           ///< outward unit vector along the loops' area vector, zero if that vanishes
  double area = 0;       ///< length of the area vector: what a cap covers
  double radius = 0;     ///< of the circle of the outer loop's area
  double roundness = 0;  ///< 4 pi area / length^2 of the outer loop: 1 for a circle
  double planarity = 0;  ///< largest distance of a rim's vertex from the plane of `center` and `normal`
};

/// Reverses the triangles of each vessel (components that share an end) that has a negative volume with its
/// ends closed; of a single vessel also closed components in it. Returns how many are reversed. Throws: as
/// find_ends.
int orient_outward(Surface& surface);

/// Returns the ends, the largest area first, named inlet, outlet_1, outlet_2 ... Throws: NotAdmissible unless
/// the surface is an oriented manifold without pinched vertices.
std::vector<End> find_ends(const Mesh& mesh);

/// A name for the end nearest to a place, or for the next in the order of area.
struct EndName {
  std::string text;
  bool placed = false;
  Vec3 place{};
};
/// Names ends: first the nearest to each name with a place, then the others in order; ends left keep their
/// names, with another number if that is taken. Throws: NotAdmissible if more names than ends, or two for
/// one.
void name_ends(std::vector<End>& ends, const std::vector<EndName>& names);

/// Flags the ends in a list of names and numbers from 1, such as "inlet,3". Throws: NotAdmissible for others.
std::vector<char> ends_in(const std::vector<End>& ends, const std::string& list);

/// Returns "end 3, outlet_2, at x y z" for messages; `i` counts from 0.
std::string title_of(const std::vector<End>& ends, int i);

/// The first and the last of the patches that were added; last < first: none.
struct CapPatches {
  int first = 0, last = -1;
};
/// Returns the remark for the stream: "capped FIRST LAST".
std::string remark_of(const CapPatches& patches);
/// Returns the patches that a remark names; none for other texts.
CapPatches parse_caps(const std::string& remark);
/// Flags triangles of the patches that are plane to 1e-9 of the diagonal. Requires: face column `patch`.
std::vector<char> plane_triangles(const Surface& surface, const CapPatches& patches);

struct CapOptions {
  double trim = 0;              ///< cuts this length off each end; 0: nothing
  bool trim_by_radius = false;  ///< `trim` is in radii of the end
  bool flatten = false;         ///< moves the rims into planes
  double extend = 0;            ///< straight extension, in radii of the end; 0: none
  bool cap = false;             ///< closes the ends
  std::vector<char> kept;       ///< per end: is not trimmed and not extended; empty: none
};

/// What became of an end.
struct EndReport {
  double trimmed = 0;                      ///< length cut off along its axis
  double moved = 0;                        ///< farthest that a vertex was moved to make the rim planar
  double extended = 0;                     ///< length of the extension
  int stub = 0, extension = 0, cap = 0;    ///< triangles
  int extension_patch = 0, cap_patch = 0;  ///< new patches; 0: none
  bool flat = false;                       ///< whether the cap is plane
  std::string why_not;                     ///< why the rim could not be made plane, if that was asked for
};

/// Trims, flattens, extends and caps the ends, as far as asked, and measures them again. Rims that can be
/// neither moved into a plane nor cut get stubs of the wall. Extensions and caps are new patches (face column
/// `patch`, added if missing), bounded by model edges (face column `model`). Returns a report per end.
/// Throws: NotAdmissible naming the end and the place where a rim crosses itself, trimming would remove a
/// branch, or an extension or a cap would meet the surface.
std::vector<EndReport> treat_ends(Surface& surface, std::vector<End>& ends, const CapOptions& options);

}  // namespace meshpipe
