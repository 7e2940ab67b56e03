// SPDX-License-Identifier: BSD-3-Clause
// Whether boundary layers fit: prisms in layers on one side of the surface.
#pragma once
#include <string>
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

struct Layers {
  double first = 0;     ///< thickness of the first; 0: none are asked for
  double growth = 1.2;  ///< of the next one over it
  int count = 5;
  bool outside = false;  ///< else inside, as in a vessel
  /// Returns the thickness of all layers.
  double total() const;
};

/// Parses "T[,GROWTH[,N]][,outside]": first thickness, growth, number of layers. Throws: BadUsage.
Layers parse_layers(const std::string& text);

/// What leaves too little space, at how many vertices, and where it leaves least.
struct LayerReport {
  enum Cause { sheets, curvature, corner, causes };
  int vertices[causes] = {0, 0, 0};
  int all = 0;                  ///< vertices without space for the layers
  double total = 0, least = 0;  ///< thickness asked for, and the least that fits
  double measured = 0;          ///< there: thickness or gap, radius of curvature, angle in degrees
  Cause cause = sheets;         ///< there
  Vec3 at{};
};

/// Sets vertex column `layers` to the total thickness that fits: half the distance of the sheet that faces
/// the vertex, at most the radius of curvature where the surface bends towards the layers, and nothing at
/// edges with an angle below 60 degrees on their side. Throws: as opposite_halfedges.
LayerReport check_layers(Surface& surface, const Layers& layers);

/// Returns the report as lines of text; none unless layers were asked for.
std::vector<std::string> describe(const LayerReport& report);

}  // namespace meshpipe
