// SPDX-License-Identifier: BSD-3-Clause
// The tables `sheet` and `region`, of surfaces that divide space into regions.
#pragma once
#include "formats/stream.h"
#include "lib/solids/solids.h"

namespace meshpipe {

/// Returns whether sheets of the stream meet: then border vertices with the same coordinates are one.
bool has_sheets(const Stream& stream);
/// Throws NotAdmissible, with the reason, if sheets of the stream meet along an edge or at a vertex.
void expect_no_sheets(const Stream& stream, const std::string& why);
/// Returns table `sheet`, by patch; empty if the stream has none.
/// Throws: BadInput for a patch that is there twice.
std::vector<SheetPatch> read_sheets(const Stream& stream);
Table sheet_table(const std::vector<SheetPatch>& sheets);
/// Sets tables `sheet` and `region`. `label`, `volume`: per region.
void write_regions(Stream& stream, const std::vector<SheetPatch>& sheets, const std::vector<int>& label,
                   const std::vector<double>& volume);

/// Sets the volumes of table `region` to those of the surface as it is; regions of one label share theirs as
/// before.
void update_volumes(Stream& stream);

/// Returns per triangle the labels of both sides that other programs write: face columns boundary_labels.0
/// and .1 (VTK's, PyVista's; or BoundaryLabels). Empty if there are none.
std::vector<std::array<int, 2>> side_labels(const Surface& surface);

/// Returns the stream as other formats have it: sheets share their vertices, and face columns
/// boundary_labels.0 and .1 hold the regions in front and behind.
Stream with_sheets_joined(const Stream& stream);

/// A point in each region, and the region's label.
struct RegionSeeds {
  std::vector<Vec3> point;
  std::vector<int> label;
};
RegionSeeds region_seeds(const Surface& surface);

/// Returns each region's whole boundary, oriented away from it, as a patch of its own, region-LABEL:
/// triangles between two regions are there twice. `labels`: only these; empty: all. Throws: NotAdmissible if
/// the stream has no sheets, or not one of these labels.
Stream region_boundaries(const Stream& stream, const std::vector<int>& labels);

}  // namespace meshpipe
