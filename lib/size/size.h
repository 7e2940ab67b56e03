// SPDX-License-Identifier: BSD-3-Clause
// The size field: target edge length at every vertex.
#pragma once
#include <functional>
#include <string>

#include "lib/core/connectivity.h"
#include "lib/core/lists.h"
#include "lib/core/mesh.h"
#include "lib/core/triangle_count.h"
#include "lib/size/layers.h"
#include "lib/size/size_field.h"

namespace meshpipe {

/// Sources and bounds of the size; 0 or empty: none.
struct SizeOptions {
  double size = 0;       ///< the same length everywhere
  double triangles = 0;  ///< number to ask for: a uniform size is added, or the other sources are scaled
  double per_turn = 0;   ///< edges per full turn along the most curved direction
  double chord = 0;      ///< largest distance of a chord from its arc
  double around = 0;     ///< edges around a tube, or around any other body that has a section
  double across = 0;     ///< elements across what is between two sides of the surface, inside
  double gap = 0;        ///< the same outside
  Layers layers;         ///< that are checked; they bound no size
  std::string data;      ///< a vertex column
  /// The size at a point with this largest absolute curvature (1 / length); infinity: not bounded there.
  std::function<double(Vec3, double)> at;
  bool at_curvature = true;  ///< `at` reads the curvature; else it gets 0, which takes less time
  double min = 0, max = 0;
  double gradation = 0.3;             ///< growth per unit of length
  double most_triangles = 715827882;  ///< half-edges are numbered by int
};

/// What --around, --across or --gap have measured and asked for.
struct MeasuredSize {
  std::string column;  ///< of the vertices: radius, thickness or gap
  double edges = 0;    ///< around or across it
  int vertices = 0;    ///< where there is one
  double value = 0, size = 0;
  Vec3 at{};  ///< of the smallest
};

/// Where sizes are lowered, and the place where that is most.
struct LoweredSize {
  int places = 0;
  Vec3 at{};
  double from = 0, to = 0, gap = 0;  ///< sizes asked for and permitted; the distance of lines or sheets
};

struct SizeReport {
  std::vector<MeasuredSize> measured;
  LayerReport layers;
  double smallest = 0, largest = 0;
  double triangles = 0;  ///< that the field asks for, with those of `strips`
  double least = 0;      ///< of the result: narrow parts have more than `triangles`, see count_with_borders
  double strips = 0;     ///< more of them, as narrow strips have more than their area stands for
  double scale = 1;      ///< factor of the other sources where they ask for more than `triangles`
  int added = 0;         ///< vertices
  LoweredSize lowered;   ///< vertices where the local feature size is below the size that was asked for
  LoweredSize narrow;    ///< where lines or sheets so near each other permit no uniform size
};

/// Sets vertex column `size` to the minimum of all sources (a tenth of the diagonal if none sets it), bounded
/// by the local feature size, graded unless uniform, within `min` and `max`. Splits edges along which
/// interpolation does not follow the field, unless `may_split` is false. `chart`: table chart_vertex, which
/// gets rows for new vertices, or null.
/// Throws: NotAdmissible if the surface has no area or no column `data`; GoalMissed if the field asks for too
/// many triangles; BadInput if a source has a value that is not positive.
SizeReport set_size(Surface& surface, Table* chart, const SizeOptions& options, bool may_split = true);

/// Makes the copies of border edges where sheets meet the same: split at the same points (match_borders),
/// with the same size, the least of all, smaller along shorter lines, graded by `slope`. `chart`: as above.
/// Returns the number of vertices added.
int match_sheets(Surface& surface, Table* chart, double slope);

/// Throws GoalMissed, with both numbers, if a field (per vertex) asks for more triangles than `limit`. Fields
/// with a value that is not positive pass.
void refuse_more_triangles(const Mesh& mesh, const std::vector<double>& size, double limit);

/// The least size, over the spacing of doubles at the coordinates: below it lengths are rounded by a tenth,
/// and meshing need not end. A sphere of 1,500 triangles passes with 70 spacings, and hangs with 12.
constexpr double least_spacings = 16;

/// Throws GoalMissed naming a vertex whose size, if positive, is below least_spacings times the spacing of
/// its coordinates.
void refuse_unresolved_sizes(const Mesh& mesh, const std::vector<double>& size);

/// Reduces sizes (per vertex) until they grow by at most `slope` per unit of length along every edge. `next`:
/// as neighbors_of. Source: Borouchaki, Hecht and Frey, Mesh gradation control, 1998.
void limit_gradation(const Mesh& mesh, const Lists& next, double slope, std::vector<double>& size);

/// The point of a cone or spike: a vertex, and the angle of the surface around it in radians.
struct Peak {
  int vertex;
  double angle;
};

/// Returns the vertices on no border or model edge around which the surface has less than half a turn (pi),
/// both in their own triangles and within half the size (per vertex).
std::vector<Peak> sharp_peaks(const Connectivity& surface, const std::vector<double>& size);

}  // namespace meshpipe
