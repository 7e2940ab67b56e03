// SPDX-License-Identifier: BSD-3-Clause
// Solids: the regions of space that the sheets of a surface enclose.
#pragma once
#include <array>
#include <vector>

#include "lib/core/error.h"
#include "lib/core/mesh.h"

namespace meshpipe {

/// The regions that a surface encloses, numbered from 1 by their first triangle; 0 is the outside.
struct Solids {
  std::vector<std::array<int, 2>> sides;  ///< per triangle: the region its normal points to, and the other
  std::vector<double> volume{0};          ///< per region; 0 of the outside
  int count() const { return (int)volume.size() - 1; }
};

/// Finds the regions: triangles around an edge bound the same region where they follow each other in angular
/// order; components are placed by a ray. Sheets may end inside a region, and have any orientation. Requires:
/// sheets that meet share their vertices; no self-intersections, or regions may be joined.
Solids find_solids(const Mesh& mesh);

/// Returns whether a sheet lies between two different regions, neither of them the outside, each of at least
/// 1e-4 of the largest volume: smaller pockets are faults of scans and of Boolean operations.
bool divides_space(const Solids& solids);

/// Returns a point inside each region; the first, for the outside, means nothing.
std::vector<Vec3> points_within(const Mesh& mesh, const Solids& solids);

/// Thrown if labels of a file contradict each other or the regions.
struct LabelsContradict : NotAdmissible {
  using NotAdmissible::NotAdmissible;
};

/// Returns the label of each region from the two labels that a file gives for the sides of every triangle
/// (`given`), in any order. Labels spread from the outside, which has -1 or 0. Throws: LabelsContradict
/// naming triangles and labels.
std::vector<int> labels_of(const Solids& solids, const std::vector<std::array<int, 2>>& given);

/// A patch and the labels of the regions in front of it (where normals point to) and behind; 0: the outside.
struct SheetPatch {
  int patch, front, back;
  auto operator<=>(const SheetPatch&) const = default;
};

/// Returns the row of a patch, or null. Requires: `sheets` in ascending order.
const SheetPatch* find_sheet(const std::vector<SheetPatch>& sheets, int patch);

/// Returns a row per patch in use, ascending. `label`: per region. Triangles between other regions than the
/// first triangle of their patch get a new patch, reported in `added` with the former one.
std::vector<SheetPatch> sheet_patches(Surface& surface, const Solids& solids, const std::vector<int>& label,
                                      std::vector<std::array<int, 2>>& added);

/// Volume, area and number of the triangles that bound the regions of one label.
struct RegionMeasure {
  int label = 0;
  double volume = 0, area = 0;
  int triangles = 0;
};

/// Measures the regions that have a label in `sheets`, by the divergence theorem; by ascending label.
/// Requires: face column `patch`.
std::vector<RegionMeasure> measure_regions(const Surface& surface, const std::vector<SheetPatch>& sheets);

/// Returns the volumes of n regions; the unbounded one's is negative. `sides`: per triangle the regions in
/// front and behind, as in Solids. Requires: a point.
std::vector<double> region_volumes(const Mesh& mesh, const std::vector<std::array<int, 2>>& sides,
                                   std::size_t n);

/// Returns the row of a label, or -1.
int row_of(const std::vector<RegionMeasure>& regions, int label);

/// How vertices give way when regions are to have other volumes.
struct Compliance {
  std::vector<double> share;     ///< of the motion, per vertex; 0: stays
  std::vector<double> farthest;  ///< per vertex: it is moved by no more than this, and then stays
  std::vector<Vec3> from{};      ///< per vertex: where that is measured from; empty: where it is
};

/// Moves vertices along normals so that region r has the volume `volume[r]`, as pressure in each region
/// would: alike where vertices have the same share. `sides`: as in Solids; `volume[0]` is not read. Requires:
/// triangles that meet share their vertices. Returns the largest relative difference left.
double match_volumes(Mesh& mesh, const std::vector<std::array<int, 2>>& sides,
                     const std::vector<double>& volume, Compliance compliance);

}  // namespace meshpipe
