// SPDX-License-Identifier: BSD-3-Clause
#include "lib/wrap/valid.h"

#include <algorithm>

#include "lib/core/intersect.h"
#include "lib/core/topology.h"

namespace meshpipe {
namespace {

/// Shares of the way back to the base, tried one after another for a point of a bad triangle.
constexpr double back[] = {0, 1.0 / 16, 1.0 / 8, 1.0 / 4, 1.0 / 2, 1};
constexpr int last_step = (int)std::size(back) - 1;
/// Rounds of moving points back before all of them go: more have not been seen to be needed than 12.
constexpr int most_rounds = 60;

/// Are triangles s and t the sides of a fin or a crack narrower than this? Slivers may face anywhere.
bool are_too_close(const Mesh& mesh, int s, int t, double least) {
  constexpr double most_cosine = -0.9, least_kappa = 0.05;  // 154 degrees
  const Vec3 p = centroid(mesh, t), way = closest_point(mesh, s, p) - p;
  const Vec3 normal = normalized(area_vector(mesh, t)), other = normalized(area_vector(mesh, s));
  auto is_sliver = [&](const Tri& f) {
    return kappa(mesh.points[f[0]], mesh.points[f[1]], mesh.points[f[2]]) < least_kappa;
  };
  return norm(way) < least && std::abs(dot(way, normal)) > -most_cosine * norm(way) &&
         dot(normal, other) < most_cosine && !is_sliver(mesh.tris[s]) && !is_sliver(mesh.tris[t]);
}

/// Both meshes as one, the soup's triangles and points after the wrap's.
Mesh joined(const Mesh& wrap, const Mesh& soup) {
  Mesh both = wrap;
  const int n = (int)wrap.points.size();
  both.points.insert(both.points.end(), soup.points.begin(), soup.points.end());
  for (const auto& [a, b, c] : soup.tris) both.tris.push_back({a + n, b + n, c + n});
  return both;
}

/// Marks the triangles of the closed mesh near points of the soup that are not inside.
std::vector<std::uint8_t> triangles_near_lost_points(const Mesh& mesh, const Mesh& soup, double reach) {
  const std::vector<int> opposite = opposite_halfedges(mesh);
  const Bvh tree(mesh);
  const InsideTest test({mesh, opposite}, tree);
  const std::vector<char> used = used_points(soup);
  const int n = (int)soup.points.size();
  std::vector<std::uint8_t> lost(n, 0), marked(mesh.tris.size(), 0);
#pragma omp parallel for schedule(dynamic, 256)
  for (int p = 0; p < n; ++p) lost[p] = used[p] && !test.inside(soup.points[p]);
  const Vec3 margin{reach, reach, reach};
  for (int p = 0; p < n; ++p)
    if (lost[p])
      tree.overlapping({soup.points[p] - margin, soup.points[p] + margin}, [&](int t) { marked[t] = 1; });
  return marked;
}

}  // namespace

Mesh with_area(const Mesh& soup, double width) {
  Mesh m = soup;
  for (Tri& t : m.tris) {
    const Vec3 corner[3] = {m.points[t[0]], m.points[t[1]], m.points[t[2]]};
    if (has_area(corner[0], corner[1], corner[2])) continue;
    int longest = 0;
    auto length = [&](int i) { return norm(corner[(i + 1) % 3] - corner[i]); };
    for (int i : {1, 2})
      if (length(i) > length(longest)) longest = i;
    Vec3 p = corner[longest], q = corner[(longest + 1) % 3];
    if (p == q) q = p + Vec3{width, 0, 0};
    const Vec3 d = q - p;
    const Vec3 axis = std::abs(d.x) <= std::abs(d.y) && std::abs(d.x) <= std::abs(d.z) ? Vec3{1, 0, 0}
                      : std::abs(d.y) <= std::abs(d.z)                                 ? Vec3{0, 1, 0}
                                                                                       : Vec3{0, 0, 1};
    const int n = (int)m.points.size();
    m.points.insert(m.points.end(), {p, q, p + width * normalized(cross(d, axis))});
    t = {n, n + 1, n + 2};
  }
  return m;
}

std::vector<std::uint8_t> triangles_that_meet(const Mesh& wrap, const std::vector<std::uint8_t>& wanted,
                                              const Mesh& soup) {
  const Mesh both = joined(wrap, soup);
  const Bvh tree(soup);
  const int n = (int)wrap.tris.size();
  std::vector<std::uint8_t> marked(n, 0);
#pragma omp parallel for schedule(dynamic, 256)
  for (int t = 0; t < n; ++t)
    if (wanted.empty() || wanted[t])
      tree.overlapping(box_of(wrap, t),
                       [&](int s) { marked[t] = marked[t] || triangles_intersect(both, t, n + s); });
  return marked;
}

std::vector<std::uint8_t> triangles_that_meet_others(const Mesh& mesh,
                                                     const std::vector<std::uint8_t>& wanted, double least) {
  const Bvh tree(mesh);
  const Vec3 margin{least, least, least};
  const int n = (int)mesh.tris.size();
  std::vector<std::vector<int>> met(n);
#pragma omp parallel for schedule(dynamic, 256)
  for (int t = 0; t < n; ++t) {
    if (!wanted[t]) continue;
    const Box box = box_of(mesh, t);
    tree.overlapping({box.lo - margin, box.hi + margin}, [&](int s) {
      if (s != t && (triangles_intersect(mesh, s, t) || are_too_close(mesh, s, t, least)))
        met[t].push_back(s);
    });
  }
  std::vector<std::uint8_t> marked(n, 0);
  for (int t = 0; t < n; ++t)
    for (int s : met[t]) marked[s] = marked[t] = 1;
  return marked;
}

InsideTest::InsideTest(const Connectivity& mesh, const Bvh& tree)
    : mesh_(mesh), tree_(tree), face_normal_(mesh.n_tris()), vertex_normal_(mesh.n_vertices()) {
  for (int t = 0; t < mesh.n_tris(); ++t) {
    const Tri& v = mesh.mesh.tris[t];
    face_normal_[t] = normalized(mesh.area_vector(t));
    for (int i = 0; i < 3; ++i) {
      const Vec3 p = mesh.point(v[i]);
      const double turn = angle(mesh.point(v[(i + 1) % 3]) - p, mesh.point(v[(i + 2) % 3]) - p);
      vertex_normal_[v[i]] = vertex_normal_[v[i]] + turn * face_normal_[t];
    }
  }
}

bool InsideTest::inside(Vec3 p) const {
  const auto hit = tree_.nearest(p);
  const int t = hit.place.face;
  const Tri& v = mesh_.mesh.tris[t];
  const double b[3] = {hit.place.b0, hit.place.b1, hit.place.b2};
  const Vec3 near = b[0] * mesh_.point(v[0]) + b[1] * mesh_.point(v[1]) + b[2] * mesh_.point(v[2]);
  constexpr double zero = 1e-12;  // of a barycentric coordinate
  Vec3 normal = face_normal_[t];
  for (int i = 0; i < 3; ++i)
    if (b[i] < zero) normal = face_normal_[t] + face_normal_[mesh_.opposite[3 * t + (i + 1) % 3] / 3];
  for (int i = 0; i < 3; ++i)
    if (b[i] > 1 - zero) normal = vertex_normal_[v[i]];
  return dot(p - near, normal) < 0;
}

int keep_valid(Mesh& mesh, const std::vector<Vec3>& base, const Mesh& soup, double reach, double least) {
  const std::vector<Vec3> fitted = mesh.points;
  const int n = (int)mesh.points.size(), n_tris = (int)mesh.tris.size();
  std::vector<std::uint8_t> step(n, 0), wanted(n_tris, 1);
  for (int round = 0;; ++round) {
    std::vector<std::uint8_t> bad = triangles_that_meet(mesh, wanted, soup);
    const std::vector<std::uint8_t> others = triangles_that_meet_others(mesh, wanted, least);
    for (int t = 0; t < n_tris; ++t) bad[t] |= others[t];
    if (std::none_of(bad.begin(), bad.end(), [](std::uint8_t b) { return b; }))
      bad = triangles_near_lost_points(mesh, soup, reach);
    std::vector<char> move(n, round >= most_rounds);
    bool any = round == most_rounds;
    for (int t = 0; t < n_tris; ++t)
      if (bad[t])
        for (int p : mesh.tris[t]) any |= step[p] < last_step, move[p] = 1;
    if (!any) break;
    for (int p = 0; p < n; ++p) {
      if (!move[p] || step[p] == last_step) continue;
      step[p] = round >= most_rounds ? last_step : step[p] + 1;
      mesh.points[p] = lerp(fitted[p], base[p], back[step[p]]);
    }
    for (int t = 0; t < n_tris; ++t) {
      wanted[t] = 0;
      for (int p : mesh.tris[t]) wanted[t] |= move[p];
    }
  }
  return (int)std::count_if(step.begin(), step.end(), [](std::uint8_t s) { return s > 0; });
}

}  // namespace meshpipe
