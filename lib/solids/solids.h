// SPDX-License-Identifier: BSD-3-Clause
// Solids: the regions of space that the sheets of a surface enclose.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "lib/core/error.h"
#include "lib/core/mesh.h"

namespace meshpipe {

/// Regions are numbered from 1 by their first triangle; 0 is the outside.
struct Solids {
  std::vector<std::array<int, 2>> sides;  ///< per triangle: the region its normal points to, and the other
  std::vector<double> volume{0};          ///< per region; 0 of the outside
  int count() const { return (int)volume.size() - 1; }
};

/// Finds the regions: triangles around an edge bound the same region where they follow each other in angular
/// order; what is not connected is placed by a ray. Sheets may end inside a region, and have any orientation.
/// Requires: sheets that meet share their vertices; no self-intersections, or regions may be joined.
Solids find_solids(const Mesh& mesh);

/// Returns whether a sheet has a region on either side, each of at least 1e-4 of the largest volume: smaller
/// pockets are faults of scans and of Boolean operations.
bool divides_space(const Solids& solids);

/// Returns a point inside each region, the outside's is of no use.
std::vector<Vec3> points_within(const Mesh& mesh, const Solids& solids);

/// Labels of a file contradict each other or the regions.
struct LabelsContradict : NotAdmissible {
  using NotAdmissible::NotAdmissible;
};

/// Returns the label of each region from those that a file gives for the two sides of every triangle, in any
/// order. Labels spread from the outside, which has -1 or 0. Throws: LabelsContradict naming triangles and
/// labels.
std::vector<int> labels_of(const Solids& solids, const std::vector<std::array<int, 2>>& given);

/// A patch and the labels of the regions in front of it (where normals point to) and behind; 0: the outside.
struct SheetPatch {
  int patch, front, back;
  auto operator<=>(const SheetPatch&) const = default;
};

/// Returns the row of a patch, or null. Requires: `sheets` in ascending order.
const SheetPatch* find_sheet(const std::vector<SheetPatch>& sheets, int patch);

/// Returns a row per patch that is used, in ascending order; triangles of other regions than the first of
/// their patch get a new patch, reported in `added` with the one that it was. `label` is per region.
std::vector<SheetPatch> sheet_patches(Surface& surface, const Solids& solids, const std::vector<int>& label,
                                      std::vector<std::array<int, 2>>& added);

/// What bounds the regions of one label.
struct RegionMeasure {
  int label = 0;
  double volume = 0, area = 0;
  int triangles = 0;
};

/// Measures the regions that have a label in `sheets`, by the divergence theorem; in ascending order.
std::vector<RegionMeasure> measure_regions(const Surface& surface, const std::vector<SheetPatch>& sheets);

/// Returns the volumes of n regions, the outside's negative. `sides` is as in Solids. Requires: a point.
std::vector<double> region_volumes(const Mesh& mesh, const std::vector<std::array<int, 2>>& sides,
                                   std::size_t n);

/// Returns the number of the row of a label, or -1.
int row_of(const std::vector<RegionMeasure>& regions, int label);

/// How vertices give way when regions are to have other volumes.
struct Compliance {
  std::vector<double> share;     ///< of the motion, per vertex; 0: stays
  std::vector<double> farthest;  ///< per vertex: it is moved by no more than this, and then stays
  std::vector<Vec3> from{};      ///< per vertex: where that is measured from; empty: where it is
};

/// Moves vertices so that region r has the volume `volume[r]`, as pressure in each region would: along
/// normals, alike where vertices have the same share. `sides` is as in Solids, `volume[0]` is not looked at.
/// Requires: triangles that meet share their vertices. Returns the largest relative difference left.
double match_volumes(Mesh& mesh, const std::vector<std::array<int, 2>>& sides,
                     const std::vector<double>& volume, Compliance compliance);

}  // namespace meshpipe
