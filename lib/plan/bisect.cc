// SPDX-License-Identifier: BSD-3-Clause
#include "lib/plan/bisect.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "lib/core/cut.h"
#include "lib/core/error.h"
#include "lib/core/lists.h"
#include "lib/core/neighborhood.h"
#include "lib/core/normals.h"
#include "lib/core/topology.h"
#include "lib/numeric/laplacian.h"
#include "lib/partition/partition.h"
#include "lib/plan/plan.h"

namespace meshpipe {
namespace {

/// L + s M with free borders, s M far below the first eigenvalue of L that is not zero, (pi / length)^2, and
/// enough to make the matrix definite. Positive weights: its fields have no extremes but where they are
/// driven.
Factorization<double> free_laplacian(const Mesh& mesh, const std::vector<double>& mass) {
  int n = (int)mesh.points.size();
  std::vector<double> diagonal(n);
  double area = std::accumulate(mass.begin(), mass.end(), 0.0);
  for (int v = 0; v < n; ++v) diagonal[v] = 0.01 * mass[v] / area;
  Laplacian matrix(std::move(diagonal));
  for (const Tri& t : mesh.tris) {
    const auto w = cotangent_weights(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], 0.01);
    for (int i = 0; i < 3; ++i) matrix.add_edge(t[i], t[(i + 1) % 3], w[i]);
  }
  return matrix.factorize();
}

/// By inverse iteration. Both sides of its zero level are connected (Fiedler 1975).
std::vector<double> fiedler_vector(const Mesh& mesh, const std::vector<double>& mass,
                                   const Factorization<double>& laplacian) {
  int n = (int)mesh.points.size();
  double area = std::accumulate(mass.begin(), mass.end(), 0.0);
  // from the distance to a far vertex; the constant vector is taken out each time
  int far = 0;
  for (int v = 0; v < n; ++v)
    if (norm(mesh.points[v] - mesh.points[0]) > norm(mesh.points[far] - mesh.points[0])) far = v;
  std::vector<double> x(n);
  for (int v = 0; v < n; ++v) x[v] = norm(mesh.points[v] - mesh.points[far]);
  for (int iteration = 0; iteration < 20; ++iteration) {
    double mean = 0, square = 0;
    for (int v = 0; v < n; ++v) mean += mass[v] * x[v] / area;
    for (double& xv : x) xv -= mean;
    for (int v = 0; v < n; ++v) square += mass[v] * x[v] * x[v];
    double size = std::sqrt(square);
    if (!(size > 0)) break;
    for (int v = 0; v < n; ++v) x[v] *= mass[v] / size;
    laplacian.solve(x);
  }
  return x;
}

double level_length(const Mesh& mesh, const std::vector<double>& field, double level) {
  double length = 0;
  for (const Tri& t : mesh.tris) {
    Vec3 end[2];
    int n = 0;
    for (int i = 0; i < 3; ++i) {
      int a = t[i], b = t[(i + 1) % 3];
      double fa = field[a] - level, fb = field[b] - level;
      if ((fa < 0) != (fb < 0)) end[n++] = lerp(mesh.points[a], mesh.points[b], fa / (fa - fb));
    }
    if (n == 2) length += norm(end[1] - end[0]);
  }
  return length;
}

/// True if the part falls into two connected halves without pinched vertices at this level.
bool halves_well(const Mesh& mesh, std::vector<double> field, double level) {
  Surface trial = surface_of(mesh);
  for (double& f : field) f -= level;
  std::vector<int> side, component;
  cut_by_scalar_field(trial, field, {}, side);
  for (const SubMesh& half : split_by_label(trial, side, 2)) {
    if (half.tris.empty()) return false;
    auto opposite = opposite_halfedges(half);
    if (components(opposite, component) != 1 || find_pinched_vertex({half, opposite}) >= 0) return false;
  }
  return true;
}

}  // namespace

bool bisect_part(Surface& surface, int part, int new_part, const std::vector<std::array<int, 2>>& apart) {
  const auto& label = surface.face.get<int>("part");
  std::vector<int> only(label.size());
  for (std::size_t t = 0; t < label.size(); ++t) only[t] = label[t] == part ? 0 : -1;
  SubMesh mesh = std::move(split_by_label(surface, only, 1)[0]);
  const std::vector<double> mass = vertex_areas(mesh);
  const double area = std::accumulate(mass.begin(), mass.end(), 0.0);
  if (!(area > 0)) return false;
  Factorization<double> laplacian = free_laplacian(mesh, mass);
  std::vector<std::vector<double>> fields;
  // the part's own numbers follow its triangles, which cuts of its neighbors split
  auto own = [&](int v) {
    return std::find(mesh.vertex.begin(), mesh.vertex.end(), v) - mesh.vertex.begin();
  };
  for (const auto& pair : apart) {
    const std::size_t source = own(pair[0]), sink = own(pair[1]);
    if (source == mesh.vertex.size() || sink == mesh.vertex.size()) continue;
    auto& field = fields.emplace_back(mesh.points.size(), 0);
    field[source] = 1;
    field[sink] = -1;
    laplacian.solve(field);
  }
  if (fields.empty()) fields.push_back(fiedler_vector(mesh, mass, laplacian));

  struct Line {
    double cost;
    std::size_t field;
    double level;
    auto operator<=>(const Line&) const = default;
  };
  std::vector<Line> lines;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    // levels by the share of the area below them
    const auto& field = fields[f];
    std::vector<int> order = identity(mesh.points.size());
    std::sort(order.begin(), order.end(),
              [&](int a, int b) { return std::tie(field[a], a) < std::tie(field[b], b); });
    constexpr int shares = 50;
    double below = 0;
    int next_share = 1;
    for (int v : order) {
      below += mass[v];
      for (; next_share < shares && below >= next_share * area / shares; ++next_share) {
        const double smaller = area * std::min(next_share, shares - next_share) / shares;
        lines.push_back({level_length(mesh, field, field[v]) / std::sqrt(smaller), f, field[v]});
      }
    }
  }
  std::sort(lines.begin(), lines.end());
  for (const Line& line : lines) {
    const auto& field = fields[line.field];
    if (!halves_well(mesh, field, line.level)) continue;
    std::vector<double> whole(surface.points.size(), 1);
    for (std::size_t v = 0; v < field.size(); ++v) whole[mesh.vertex[v]] = field[v] - line.level;
    std::vector<char> active(only.size());
    for (std::size_t t = 0; t < only.size(); ++t) active[t] = only[t] == 0;
    std::vector<int> side;
    cut_by_scalar_field(surface, whole, active, side);
    auto& relabel = surface.face.get<int>("part");
    for (std::size_t t = 0; t < side.size(); ++t)
      if (side[t] == 1) relabel[t] = new_part;
    return true;
  }
  return false;
}

int cut_along_limbs(Surface& surface, int part, int n_parts) {
  // the neighborhood, of which only this part has a label, and a limit just below its aspect ratio; the
  // labels of all go through the cut in a column of their own
  name_origins(surface);
  std::vector<int> unknown, only = surface.face.get<int>("part");
  Neighborhood near = take_neighborhood({surface, unknown}, only, part);
  Surface& work = near.surface;
  only = work.face.get<int>("part");
  work.face.set("whole", only);
  for (int& label : only) label = label == part ? 0 : -1;
  MultiscaleOptions options;
  std::vector<int> opposite = opposite_halfedges(work);
  std::vector<Topology> topology = topology_of_parts({work, opposite}, only, 1);
  options.max_aspect = 0.9 * topology[0].eta_geo;
  options.most_parts = limit::limb_parts;
  work.face.set("part", std::move(only));
  int pieces = 0;
  try {
    pieces = multiscale_cut(work, options, nullptr, &topology, &opposite);
  } catch (const GoalMissed&) {
    return n_parts;
  }
  if (pieces < 2) return n_parts;  // halves may have been joined again
  std::vector<int> label = work.face.get<int>("whole");
  const auto& piece = work.face.get<int>("part");
  for (std::size_t t = 0; t < label.size(); ++t)
    if (piece[t] > 0) label[t] = n_parts + piece[t] - 1;
  work.face.set("part", std::move(label));
  work.face.erase("whole");
  put_back(near, {surface, unknown});
  return n_parts + pieces - 1;
}

}  // namespace meshpipe
