// SPDX-License-Identifier: BSD-3-Clause
#include "lib/defeature/defeature.h"

#include <algorithm>
#include <cstdio>
#include <numbers>
#include <utility>

#include "lib/core/boxes.h"
#include "lib/core/bvh.h"
#include "lib/core/error.h"
#include "lib/core/intersect.h"
#include "lib/core/lists.h"
#include "lib/core/take_rows.h"
#include "lib/core/topology.h"
#include "lib/core/union_find.h"
#include "lib/defeature/zipper.h"

namespace meshpipe {
namespace {

constexpr int most_passes = 8;    ///< closed strips leave small regions, and these new strips
constexpr int most_attempts = 6;  ///< without the places where the surface would get worse
/// Lines that meet at a smaller angle (6 degrees) force triangles with kappa below 0.2.
constexpr double needle = 6 * std::numbers::pi / 180;

/// The vertex that each has become.
std::vector<int> images(const MergedSurface& z) {
  std::vector<int> image = identity(z.points.size());
  for (std::size_t i = z.merges.size(); i-- > 0;) image[z.merges[i].gone] = image[z.merges[i].kept];
  return image;
}

/// The result; per triangle, vertex and half-edge of it the triangle of the input, the number in `z`, and the
/// given line.
Surface result_of(const MergedSurface& z, const Surface& before, std::vector<int>& face,
                  std::vector<int>& vertex, std::vector<int>& given) {
  Surface s;
  s.vertex = before.vertex, s.face = before.face;
  std::vector<int> number(z.points.size(), -1);
  std::vector<std::uint8_t> model;
  std::vector<char> used(z.points.size(), 0);
  for (const Tri& t : z.mesh.tris)
    if (t[0] >= 0) used[t[0]] = used[t[1]] = used[t[2]] = 1;
  for (int v = 0; v < (int)z.points.size(); ++v) {
    if (!used[v]) continue;
    number[v] = (int)vertex.size();
    vertex.push_back(v);
    s.points.push_back(z.points[v]);
  }
  for (int t = 0; t < (int)z.mesh.tris.size(); ++t) {
    const Tri& v = z.mesh.tris[t];
    if (v[0] < 0) continue;
    face.push_back(z.origin[t]);
    s.tris.push_back({number[v[0]], number[v[1]], number[v[2]]});
    std::uint8_t bits = 0;
    for (int i = 0; i < 3; ++i) {
      given.push_back(z.lines.given[3 * t + i]);
      if (z.is_model(3 * t + i)) bits |= 1 << i;
    }
    model.push_back(bits);
  }
  interpolate_rows(s.vertex, z.added);
  take_rows(s.vertex, vertex);
  take_rows(s.face, face);
  s.face.set("model", std::move(model));
  return s;
}

/// Triangles of the result that meet others where the input's do not.
std::vector<int> crossing_triangles(const Surface& result, const std::vector<char>& changed,
                                    const Surface& before) {
  std::vector<int> rows, crossing;
  for (int t = 0; t < (int)changed.size(); ++t)
    if (changed[t]) rows.push_back(t);
  if (rows.empty()) return crossing;
  const Mesh part = part_of(result, rows);
  const Bvh tree(part);  // of the few that have changed
  std::vector<std::pair<int, int>> pairs;
  for (int u = 0; u < (int)changed.size(); ++u)
    tree.overlapping(box_of(result, u), [&](int i) {
      const int t = rows[i];
      if (u == t || (changed[u] && u < t)) return;
      if (triangles_intersect(result, std::min(t, u), std::max(t, u)))
        pairs.push_back({std::min(t, u), std::max(t, u)});
    });
  if (pairs.empty()) return crossing;
  std::sort(pairs.begin(), pairs.end());
  for (const auto& [t, u] : new_intersections(result, pairs, contacts(before, self_intersections(before))))
    crossing.insert(crossing.end(), {t, u});
  return crossing;
}

/// Connects the vertices of the result into which others have been merged, along the seams of closed strips:
/// each set is one feature. Flags them in `merged`.
UnionFind feature_sets(const MergedSurface& z, const std::vector<int>& image, std::vector<char>& merged) {
  UnionFind sets(z.points.size());
  merged.assign(z.points.size(), 0);
  for (const Merge& m : z.merges) merged[image[m.gone]] = 1;
  for (int h = 0; h < (int)z.mesh.opp.size(); ++h)
    if (!z.mesh.dead(h / 3) && z.lines.seam[h] > 0) sets.join(z.mesh.from(h), z.mesh.to(h));
  return sets;
}

/// Flags the input's vertices that have become one of `at`, or, with `whole`, are in the same feature.
void ban(const MergedSurface& z, const std::vector<int>& image, const std::vector<int>& at, bool whole,
         std::vector<char>& banned) {
  std::vector<char> merged, hit(z.points.size(), 0), hit_set(hit);
  UnionFind sets = feature_sets(z, image, merged);
  for (int v : at) hit[v] = hit_set[sets.find(v)] = 1;
  for (std::size_t v = 0; v < banned.size(); ++v)
    banned[v] |= hit[image[v]] | (whole & merged[image[v]] & hit_set[sets.find(image[v])]);
}

/// Flags the vertices that were merged last, and so the farthest, into each of `at`.
void ban_last(const MergedSurface& z, const std::vector<int>& image, const std::vector<int>& at,
              std::vector<char>& banned) {
  std::vector<char> wanted(z.points.size(), 0);
  for (int v : at) wanted[v] = 1;
  for (std::size_t i = z.merges.size(); i-- > 0;)
    if (const int gone = z.merges[i].gone; !z.merges[i].ear && std::exchange(wanted[image[gone]], 0))
      if (gone < (int)banned.size()) banned[gone] = 1;
}

/// Vertices of features that were removed only in part, so that two lines meet there in a sharper needle than
/// before.
std::vector<int> new_needles(const MergedSurface& z, const std::vector<int>& image,
                             std::vector<double> before) {
  // a needle at the end of a line moves along it
  for (const RowBetween& r : z.added) before.push_back(std::min(before[r.a], before[r.b]));
  std::vector<char> merged;
  UnionFind sets = feature_sets(z, image, merged);
  std::vector<double> least(z.points.size(), needle);
  for (std::size_t v = 0; v < before.size(); ++v)
    if (const int w = image[v]; merged[w]) least[sets.find(w)] = std::min(least[sets.find(w)], before[v]);
  std::vector<int> found;
  for (int v = 0; v < (int)merged.size(); ++v)
    if (merged[v] && z.mesh.out[v] >= 0 && z.sharpest(v) < 0.9 * least[sets.find(v)]) found.push_back(v);
  return found;
}

/// Adds the features that were closed to those that were removed whole.
std::vector<RemovedFeature> features_of(const MergedSurface& z, const std::vector<int>& image,
                                        std::vector<RemovedFeature> all) {
  std::vector<char> merged;
  UnionFind sets = feature_sets(z, image, merged);
  std::vector<int> number(z.points.size(), -1);
  std::vector<Box> box(all.size());
  for (const Merge& m : z.merges) {
    int& i = number[sets.find(image[m.gone])];
    if (i < 0) {
      i = (int)all.size();
      all.push_back({m.at});
      box.push_back({m.at, m.at});
    }
    if (m.width > all[i].width) all[i].width = m.width, all[i].at = m.at;
    box[i] = join(box[i], {m.at, m.at});
    ++all[i].merged;
  }
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].merged > 0) all[i].length = norm(box[i].hi - box[i].lo);
  std::stable_sort(all.begin(), all.end(), [](auto& a, auto& b) { return a.width > b.width; });
  return all;
}

/// Whether no triangle is as low as the tolerance at a line (model edge, border) or at an edge of a step, and
/// there is no fragment: then there is nothing to merge or to remove.
bool nothing_is_narrow(const Connectivity& c, double tolerance) {
  std::vector<char> on_line(c.n_vertices(), 0);
  for (int h = 0; h < c.n_half_edges(); ++h)
    if (c.is_border(h) || c.is_model(h)) on_line[c.from(h)] = on_line[c.to(h)] = 1;
  if (std::find(on_line.begin(), on_line.end(), 1) == on_line.end()) return true;
  std::vector<int> component;
  if (components(c.opposite, component) > 1) return false;
  bool found = false;
#pragma omp parallel for schedule(static) reduction(|| : found)
  for (int t = 0; t < c.n_tris(); ++t) {
    const Vec3 n = c.area_vector(t);
    const double longest = std::max({c.length(3 * t), c.length(3 * t + 1), c.length(3 * t + 2)});
    if (norm(n) > tolerance * longest) continue;
    for (int h = 3 * t; h < 3 * t + 3; ++h)
      found =
          found || on_line[c.from(h)] || !(angle(n, c.area_vector(c.opposite[h] / 3)) < sharp_edge_of_step);
  }
  return !found;
}

std::vector<int> labels(const Surface& s) {
  std::vector<int> all = s.face.has("patch") ? s.face.get<int>("patch") : std::vector<int>();
  sort_unique(all);
  return all;
}

}  // namespace

DefeatureReport remove_small_features(CutSurface s, const DefeatureOptions& options,
                                      const std::vector<int>* given) {
  Surface& surface = s.surface;
  std::vector<int>& opposite = s.opposite;
  DefeatureReport report;
  if (!(options.tolerance > 0)) return report;
  const std::vector<std::uint8_t> model = surface.face.get<std::uint8_t>("model");
  const Connectivity c{surface, opposite, model};
  if (const int v = find_pinched_vertex(c); v >= 0)
    throw NotAdmissible("vertex " + std::to_string(v) +
                        " joins triangles that share no edge; run mclean first");
  if (nothing_is_narrow(c, options.tolerance)) return report;
  std::vector<char> banned(surface.points.size(), 0);
  EditMesh edited(c);
  std::vector<double> drift(surface.points.size(), 0);
  const std::vector<RemovedFeature> fragments = remove_fragments(surface, options, edited, drift);
  for (int attempt = 0; attempt <= most_attempts; ++attempt) {
    report.stopped = attempt == most_attempts;  // then only fragments go
    Zipper z(surface, edited, options, given, banned);
    z.drift = drift;
    std::vector<double> sharpest(banned.size(), std::numbers::pi);
    const std::vector<char> on_line = z.vertices_on_lines();
    for (int v = 0; v < (int)banned.size(); ++v)
      if (on_line[v]) sharpest[v] = z.sharpest(v);
    for (int pass = 0; pass < most_passes && !report.stopped; ++pass)
      if (z.contract_clusters() + z.close_strips() + z.contract_regions() == 0) break;
    if (z.merges.empty() && fragments.empty()) return report;
    std::vector<int> face, vertex, lines;
    const std::vector<int> image = images(z);
    Surface result = result_of(z, surface, face, vertex, lines);
    std::vector<char> touched(z.points.size(), 0), changed(result.tris.size(), 0);
    for (const Merge& m : z.merges) touched[image[m.gone]] = 1;
    for (std::size_t t = 0; t < changed.size(); ++t)
      for (int v : result.tris[t]) changed[t] |= touched[vertex[v]];
    const std::vector<int> crossing = crossing_triangles(result, changed, surface);
    const std::vector<int> needles = new_needles(z, image, sharpest);
    if (crossing.empty() && needles.empty()) {
      report.removed = features_of(z, image, fragments);
      report.merged = (int)z.merges.size();
      report.moved = *std::max_element(z.drift.begin(), z.drift.end());
      const std::vector<int> before = labels(surface), after = labels(result);
      std::set_difference(before.begin(), before.end(), after.begin(), after.end(),
                          std::back_inserter(report.vanished));
      report.face = std::move(face);
      report.given = std::move(lines);
      surface = std::move(result);
      opposite = opposite_halfedges(surface);
      return report;
    }
    std::vector<int> at;
    for (int t : crossing)
      for (int v : result.tris[t]) at.push_back(vertex[v]);
    ban(z, image, at, attempt > 0, banned);
    if (attempt == 0)
      ban_last(z, image, needles, banned);
    else
      ban(z, image, needles, true, banned);
  }
  return report;
}

std::string remark_of(const DefeatureReport& report) {
  char text[64];
  std::snprintf(text, sizeof text, "removed %zu moved %.17g", report.removed.size(), report.moved);
  return text;
}

double moved_by(const std::string& remark) {
  std::size_t n = 0;
  double moved = 0;
  return std::sscanf(remark.c_str(), "removed %zu moved %lg", &n, &moved) == 2 ? moved : 0;
}

}  // namespace meshpipe
