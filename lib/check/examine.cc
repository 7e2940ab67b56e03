// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <memory>
#include <optional>
#include <tuple>

#include "lib/check/check.h"
#include "lib/core/chord.h"
#include "lib/core/fold.h"
#include "lib/core/intersect.h"
#include "lib/core/junctions.h"
#include "lib/core/normals.h"
#include "lib/core/original_triangles.h"
#include "lib/core/parallel.h"
#include "lib/core/progress.h"
#include "lib/core/segments.h"
#include "lib/core/topology.h"
#include "lib/core/triangle_count.h"
#include "lib/lift/lift.h"

namespace meshpipe {
namespace {

/// The mean length of the edges at each vertex; 0 if it is unused.
std::vector<double> mean_edges(const Mesh& mesh) {
  std::vector<double> length(mesh.points.size(), 0);
  std::vector<int> count(mesh.points.size(), 0);
  for (int h = 0; h < 3 * (int)mesh.tris.size(); ++h)
    for (int v : {origin(mesh.tris, h), target(mesh.tris, h)}) length[v] += edge_length(mesh, h), ++count[v];
  for (std::size_t v = 0; v < length.size(); ++v) length[v] /= std::max(1, count[v]);
  return length;
}

/// The distance allowed at each triangle: half the size, and what the smooth surface is off. The size is that
/// of the field asked for, or of the mean edges at the vertices; where a surface admits only triangles that
/// are smaller, one and a half of their longest edge, the most that a mesh has that obeys its field. But no
/// less than the mean, or `least_size`: sizes are lowered where something fails, and that must not make the
/// contract harder to meet.
std::vector<double> allowed_distances(const Mesh& mesh, const std::vector<double>& size,
                                      const std::vector<double>& smooth_off, double least_size) {
  std::vector<double> allowed(mesh.tris.size());
  for (int t = 0; t < (int)allowed.size(); ++t) {
    const Tri& v = mesh.tris[t];
    const double edge =
        std::max({edge_length(mesh, 3 * t), edge_length(mesh, 3 * t + 1), edge_length(mesh, 3 * t + 2)});
    const double local = std::min((size[v[0]] + size[v[1]] + size[v[2]]) / 3, size_over_longest * edge);
    allowed[t] = most_deviation * std::max(local, least_size) +
                 std::max({smooth_off[v[0]], smooth_off[v[1]], smooth_off[v[2]]});
  }
  return allowed;
}

/// Lowers the distances of vertices to those from their places on the smooth surface above the reference.
void lower_to_curved(const Surface& result, const Surface& reference, std::vector<double>& distance) {
  const auto& face = result.vertex.get<int>("ref_face");
  const auto &b1 = result.vertex.get<double>("b1"), &b2 = result.vertex.get<double>("b2");
  const CurvedSurface smooth(reference);
  for (std::size_t v = 0; v < distance.size(); ++v) {
    const Vec3 p = smooth.point({face[v], 1 - b1[v] - b2[v], b1[v], b2[v]});
    distance[v] = std::min(distance[v], norm(result.points[v] - p));
  }
}

/// Finds the triangles that sharp corners of the reference force to be needles.
void find_needles(Findings& f, const Connectivity& result, const Surface& reference) {
  f.worst_unforced = f.quality.worst;
  if (!(f.quality.kappa_min <= 0.1) || !f.mesh.sound() || !f.reference.sound()) return;
  const std::vector<int> opposite = opposite_halfedges(reference);
  f.forced = forced_needles(result, f.quality.kappas, {reference, opposite, model_of(reference)});
  f.worst_unforced = -1;
  for (int t = 0; t < (int)f.forced.size(); ++t)
    if (!f.forced[t] && (f.worst_unforced < 0 || f.quality.kappas[t] < f.quality.kappas[f.worst_unforced]))
      f.worst_unforced = t;
}

}  // namespace

std::vector<int> find_folds(const Connectivity& result, const Mesh& reference, const Bvh& reference_tree) {
  const Mesh& mesh = result.mesh;
  const int n = (int)mesh.tris.size();
  const std::vector<Vec3> normal = face_normals(mesh);
  std::vector<int> folds;
  for (int h = 0; h < 3 * n; ++h) {
    const int g = result.opposite[h];
    if (g < h || !turn_back(normal[h / 3], normal[g / 3])) continue;
    if (faces_one_way(mesh.points[origin(mesh.tris, h)], mesh.points[target(mesh.tris, h)], normal[h / 3],
                      normal[g / 3], reference, reference_tree))
      folds.push_back(h);
  }
  return folds;
}

namespace {

/// Returns the means kappa_by_cuts and kappa_elsewhere. The lines lie on `surface`.
std::pair<std::optional<double>, std::optional<double>> kappa_by_lines(const Connectivity& result,
                                                                       const Quality& quality,
                                                                       const Lines& lines,
                                                                       const Mesh& surface) {
  const Mesh& mesh = result.mesh;
  std::vector<std::pair<Vec3, Vec3>> segments;
  Mesh boxes;  // around them, as triangles that have these boxes
  auto at = [&](int i) {
    const LinePoint& p = lines.points[i];
    return lerp(surface.points[p.a], surface.points[p.b], p.t);
  };
  auto add = [&](Vec3 a, Vec3 b) {
    const double r = 2 * norm(b - a);  // edges are not much longer than the line's segments
    const int first = (int)boxes.points.size();
    boxes.points.insert(boxes.points.end(), {lower(a, b) - Vec3{r, r, r}, upper(a, b) + Vec3{r, r, r}});
    boxes.tris.push_back({first, first + 1, first + 1});
    segments.push_back({a, b});
  };
  for (const Line& l : lines.lines) {
    if (l.kind != interface_line) continue;
    for (int i = 1; i < l.count; ++i) add(at(l.first + i - 1), at(l.first + i));
    if (l.closed && l.count) add(at(l.first + l.count - 1), at(l.first));
  }
  std::vector<char> close(mesh.tris.size(), 0);
  const std::unique_ptr<const Bvh> tree(segments.empty() ? nullptr : new Bvh(boxes));
  for (int t = 0; tree && t < (int)close.size(); ++t) {
    const double edge =
        (edge_length(mesh, 3 * t) + edge_length(mesh, 3 * t + 1) + edge_length(mesh, 3 * t + 2)) / 3;
    tree->overlapping(box_of(mesh, t), [&](int s) {
      close[t] |= distance_to_segment(centroid(mesh, t), segments[s].first, segments[s].second) <= edge;
    });
  }
  std::vector<char> held(mesh.points.size(), 0);
  for (int h = 0; h < result.n_half_edges(); ++h)
    if (result.is_border(h) || result.is_model(h)) held[result.from(h)] = held[result.to(h)] = 1;
  double sum[2] = {0, 0};
  int count[2] = {0, 0};
  for (std::size_t t = 0; t < close.size(); ++t) {
    const Tri& v = mesh.tris[t];
    if (held[v[0]] || held[v[1]] || held[v[2]]) continue;
    sum[(int)close[t]] += quality.kappas[t];
    ++count[(int)close[t]];
  }
  auto mean = [&](int i) { return count[i] ? std::optional(sum[i] / count[i]) : std::nullopt; };
  return {mean(1), mean(0)};
}

/// Finds intersections and chords, new ones where the reference has neither. Where sheets meet, their borders
/// are joined, and the reference's are found in any case. Trees: null if they are `measured`.
void find_intersections(Findings& f, const Connectivity& result, const Bvh* mesh_tree, const Mesh& before,
                        const Surface& given, const Bvh* before_tree, bool sheets_meet,
                        const Measured* measured) {
  Mesh joined[2];
  auto find = [&](Mesh& copy, const Mesh& surface, const Bvh& tree) {
    if (!sheets_meet) return self_intersections(surface, tree);
    copy = surface;
    return sheet_intersections(copy, tree);
  };
  f.intersections = measured ? measured->intersections : find(joined[0], result.mesh, *mesh_tree);
  const auto chords = f.mesh.sound() ? chord_pairs(result) : std::vector<std::pair<int, int>>();
  if (f.intersections.empty() && chords.empty() && !sheets_meet) return;
  const auto old = before_tree ? find(joined[1], before, *before_tree) : self_intersections(before);
  const Mesh& reference = sheets_meet ? joined[1] : before;
  f.reference_pairs.all = (int)old.size();
  f.reference_pairs.apart = (int)std::count_if(old.begin(), old.end(), [&](const auto& pair) {
    const Tri &a = reference.tris[pair.first], &b = reference.tris[pair.second];
    return std::none_of(a.begin(), a.end(), [&](int v) {
      return std::any_of(b.begin(), b.end(),
                         [&](int w) { return reference.points[v] == reference.points[w]; });
    });
  });
  f.reference_pairs.crossing = (int)crossings(reference, old).size();
  const Mesh& mesh = sheets_meet ? joined[0] : result.mesh;
  f.intersections.insert(f.intersections.end(), chords.begin(), chords.end());
  sort_unique(f.intersections);
  f.new_intersections = new_intersections(mesh, f.intersections, contacts(reference, old));
  if (f.new_intersections.empty() || !f.reference.sound()) return;
  f.new_intersections = new_intersections(mesh, f.new_intersections, reference_contacts(given, sheets_meet));
}

/// Measures the distances of borders, and of borders and model edges where both surfaces know theirs.
void measure_curves(Findings& f, const Connectivity& result, const Mesh& reference, const Surface& given) {
  const double d = diagonal(reference), unit = d > 0 ? d : 1;
  Mesh curves, reference_curves;
  add_segments(curves, result.mesh, [&](int h) { return result.is_border(h); });
  add_segments(reference_curves, reference, [&](int h) { return f.reference.opposite[h] < 0; });
  f.boundary = curve_distance(reference_curves, curves) / unit;
  const std::vector<std::uint8_t>& marks = model_of(given);
  if (result.model.empty() || marks.empty()) return;
  add_segments(curves, result.mesh, [&](int h) { return result.is_model(h); });
  add_segments(reference_curves, given, [&](int h) { return marks[h / 3] >> h % 3 & 1; });
  f.features = curve_distance(reference_curves, curves) / unit;
}

/// The reference as the result is compared with it: before cuts, if that is sound and has no other borders.
/// Where triangles with hardly any area could not be recovered, those around them leave gaps.
Mesh compared_reference(const Surface& given, Soundness& soundness) {
  Mesh reference = original_mesh(given);
  soundness = soundness_of(reference);
  if (soundness.sound() && soundness.loops == 0) return reference;
  Soundness cut = soundness_of(given);
  if (soundness.sound() && soundness.loops == cut.loops) return reference;
  soundness = std::move(cut);
  return given;
}

std::vector<double> sizes_or(const Surface& result, const std::vector<double>& otherwise) {
  return result.vertex.has("size") ? result.vertex.get<double>("size") : otherwise;
}

/// Measures distances, of vertices over their mean edges. Trees: null if they are `measured`.
void measure_distances(Findings& f, const Surface& result, const Surface& given, const Connectivity& mesh,
                       const Bvh* mesh_tree, const Connectivity& before, const Bvh* reference_tree,
                       int samples, double most, double least_size, std::optional<Measured>& measured) {
  const std::vector<double> edges = mean_edges(result);
  f.mean_size = size_for_count(total_area(result), (double)result.tris.size());
  if (measured) {
    f.off = std::move(measured->off);
    f.distance = std::move(measured->distance);
  } else {
    f.off = vertex_distances(result, mesh_tree->order(), before, *reference_tree);
    std::vector<double> smooth_off = f.off;
    if (given.face.has("curved") && result.vertex.has("ref_face")) lower_to_curved(result, given, f.off);
    for (std::size_t v = 0; v < smooth_off.size(); ++v) smooth_off[v] -= f.off[v];
    f.distance = distance_between(
        before, *reference_tree, mesh, *mesh_tree, samples,
        allowed_distances(result, sizes_or(result, edges), smooth_off, std::max(least_size, f.mean_size)),
        most);
  }
  for (std::size_t v = 0; v < f.off.size(); ++v)
    f.off[v] = edges[v] > 0 ? f.off[v] / edges[v] : f.off[v] > 0 ? 1e300 : 0;
  f.farthest = (int)(std::max_element(f.off.begin(), f.off.end(),
                                      [](double a, double b) { return !std::isnan(a) && !(b <= a); }) -
                     f.off.begin());
}

/// What is allowed of a result that does not lie on the smooth surface above its reference.
std::vector<double> allowed_on_triangles(const Surface& result, double least_size) {
  const double mean = size_for_count(total_area(result), (double)result.tris.size());
  return allowed_distances(result, sizes_or(result, mean_edges(result)),
                           std::vector<double>(result.points.size(), 0), std::max(least_size, mean));
}

}  // namespace

void cut_examination(const Surface& result, const Surface& reference, int triangles, int samples, double most,
                     const TakeShare& take) {
  Soundness soundness;
  const Mesh before = compared_reference(reference, soundness);
  const double bounded = most < infinity ? most * diagonal(before) : 0;
  cut_check(result, before, allowed_on_triangles(result, 0), triangles, samples, bounded, take);
}

Findings examine(const Surface& result, const Surface& given, const Lines* lines, int samples, double most,
                 bool sheets_meet, double least_size, const std::vector<ShareFindings>* shares) {
  Findings f;
  Mesh reference;
  parallel_for(2, [&](int side) {
    if (side == 0) {
      f.mesh = soundness_of(result);
      return;
    }
    reference = compared_reference(given, f.reference);
  });
  const std::vector<std::uint8_t> no_bits;
  const bool marked = result.face.has("model"), reference_marked = given.face.has("model");
  const auto& model = marked ? result.face.get<std::uint8_t>("model") : no_bits;
  const Connectivity mesh{result, f.mesh.opposite, model};
  f.quality = quality_of(mesh, sizes_or(result, {}));
  const Connectivity before{reference, f.reference.opposite};
  f.reference_quality = quality_of(before, {});

  add_progress(0.2);
  std::optional<Bvh> reference_tree, mesh_tree;
  if (!shares) reference_tree.emplace(reference), mesh_tree.emplace(result);
  auto tree = [](const std::optional<Bvh>& built) { return built ? &*built : nullptr; };
  std::optional<Measured> measured;
  if (shares)
    measured = join_findings(*shares, result, diagonal(reference), allowed_on_triangles(result, least_size));
  find_intersections(f, mesh, tree(mesh_tree), reference, given, tree(reference_tree), sheets_meet,
                     measured ? &*measured : nullptr);
  add_progress(0.3);
  f.edges.folds = measured ? measured->folds : find_folds(mesh, reference, *reference_tree);
  measure_distances(f, result, given, mesh, tree(mesh_tree), before, tree(reference_tree), samples, most,
                    least_size, measured);
  add_progress(0.4);
  measure_curves(f, mesh, reference, given);
  find_needles(f, mesh, given);
  f.kappa_off_corners = f.quality.kappa_min;
  f.worst_off_corners = f.quality.worst;
  if (marked) f.kappa_off_corners = kappa_off_corners(mesh, f.quality, f.worst_off_corners);
  if (f.mesh.sound()) {
    f.reversed = reversed_components(mesh, reference, tree(reference_tree));
    // the nearest sheet may be another one, where a small sheet is folded; labels of files may be others
    if (lines) leave_out_as_labeled(f.reversed, mesh, result, given);
  }
  if (marked && reference_marked && result.face.has("patch") && given.face.has("patch")) {
    f.edges.unmarked_borders = unmarked_borders(mesh, result.face.get<int>("patch"));
    if (!f.edges.unmarked_borders.empty()) {
      const std::vector<int> opposite = opposite_halfedges(given);
      if (!unmarked_borders({given, opposite, given.face.get<std::uint8_t>("model")},
                            given.face.get<int>("patch"))
               .empty())
        f.edges.unmarked_borders.clear();  // nothing that one could expect
    }
  }
  if (lines) std::tie(f.kappa_by_cuts, f.kappa_elsewhere) = kappa_by_lines(mesh, f.quality, *lines, given);
  return f;
}

}  // namespace meshpipe
