// SPDX-License-Identifier: BSD-3-Clause
// The size field: target edge length at every vertex.
#pragma once
#include <functional>
#include <string>

#include "lib/mesh.h"

namespace meshpipe {

/// The edge length at which a mesh of equilateral triangles of this area has n of them.
double size_for_count(double area, double n);

/// How many equilateral triangles a field asks for: the integral of dA / (sqrt(3)/4 h^2), h the mean of a
/// triangle's corners. size[v] > 0.
double count_for_size(const Mesh& mesh, const std::vector<double>& size);

/// Throws GoalMissed, with both numbers, if a field asks for more triangles than `limit`. Sizes
/// that are not positive are not its business.
void refuse_more_triangles(const Mesh& mesh, const std::vector<double>& size, double limit);

/// Lowers sizes until they grow by at most `slope` per unit of length along every edge (Borouchaki, Hecht and
/// Frey 1998), by one sweep from small to large.
void limit_gradation(const Mesh& mesh, double slope, std::vector<double>& size);

/// What is asked of the size; 0 or empty means not asked.
struct SizeOptions {
  double size = 0;       ///< the same length everywhere
  double triangles = 0;  ///< as many triangles as this, however many the rest asks for
  double per_turn = 0;   ///< edges a full turn of the most curved direction
  double chord = 0;      ///< largest distance of a chord from its arc
  std::string data;      ///< a vertex column
  /// A size by the point and the largest absolute curvature there; infinite: none asked for.
  std::function<double(Vec3, double)> at;
  bool at_curvature = true;  ///< `at` reads the curvature; else it gets 0, which takes less time
  double min = 0, max = 0;
  double gradation = 0.3;             ///< growth per unit of length
  double most_triangles = 715827882;  ///< half-edges are numbered by int
};

struct SizeReport {
  double smallest = 0, largest = 0;
  double triangles = 0;  ///< that the field asks for
  double scale =
      1;          ///< by which the other sources were multiplied, since they asked for more than `triangles`
  int added = 0;  ///< vertices
  /// Vertices where a larger size was asked for than there is room for (edge_room), and the place where that
  /// is most.
  int lowered = 0;
  Vec3 lowered_at{};
  double asked = 0, room = 0;
};

/// Sets vertex column `size`: the minimum of all that is asked, at most `max`, graded, at least `min`. Where
/// edges of the surface are too long for linear interpolation to follow the field, they are split
/// (split_edges; `chart` is the table chart_vertex or null), unless `may_split` is false. With `triangles` a
/// uniform length is added to the sources so that the field asks for that many; if the sources ask for more
/// already, they are multiplied by one factor instead. Where sources alone leave the size open it is a tenth
/// of the diagonal. A uniform field is not graded. Curvature is that of face_curvature.
/// Throws NotAdmissible if the surface has no area, GoalMissed if the field asks for too many triangles,
/// BadInput if a value of a source is not positive.
SizeReport set_size(Surface& surface, Table* chart, const SizeOptions& options, bool may_split = true);

}  // namespace meshpipe
