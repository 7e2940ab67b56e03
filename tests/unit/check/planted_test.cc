// SPDX-License-Identifier: BSD-3-Clause
// Every kind of defect that a result may have, planted at many places of good ones, is found by the default
// contract; and good results give no alarm.
#include <gtest/gtest.h>
#include <omp.h>

#include <functional>

#include "lib/check/check.h"
#include "lib/core/topology.h"
#include "lib/shape/shape.h"

namespace meshpipe {
namespace {

constexpr int places = 27;

/// A mesh of several components: `of` is the component of each triangle.
struct Scene : Surface {
  std::vector<int> of, patch;
  void add(const Mesh& mesh, Vec3 shift, const std::vector<int>& labels, int component) {
    const int n = (int)points.size();
    for (Vec3 p : mesh.points) points.push_back(p + shift);
    for (std::size_t t = 0; t < mesh.tris.size(); ++t) {
      tris.push_back({mesh.tris[t][0] + n, mesh.tris[t][1] + n, mesh.tris[t][2] + n});
      of.push_back(component);
      patch.push_back(labels.empty() ? 10 + component : labels[t]);
    }
  }
  Vec3 normal(int t) const { return normalized(area_vector(*this, t)); }
  double edge(int t) const { return edge_length(*this, 3 * t); }
  /// A triangle of a component, another one for each place.
  int triangle(int component, int place) const {
    std::vector<int> all;
    for (int t = 0; t < (int)of.size(); ++t)
      if (of[t] == component) all.push_back(t);
    return all[(std::size_t)place * 7919 % all.size()];
  }
};

/// A cube of six patches, a torus, two spheres and an open tube; `fine` times as many
/// triangles.
enum Component { cube_, torus_, sphere_, tube_, other_sphere_ };
Scene scene(int fine) {
  Scene s;
  const Body c = cube(100 * fine);
  s.add(c, {0, 0, 0}, c.patch, cube_);
  s.add(torus(0.4, 160 * fine), {4, 0, 0}, {}, torus_);
  s.add(sphere(80 * fine), {0, 4, 0}, {}, sphere_);
  s.add(tube(3, fine > 1 ? 18 : 10, false), {4, 4, 0}, {}, tube_);
  s.add(sphere(80 * fine), {0, 8, 0}, {}, other_sphere_);
  return s;
}

/// Fills the columns; model edges are where patches meet in `marks`, which has the same triangles.
Surface finished(const Scene& scene, const std::vector<int>& marks) {
  Surface s;
  static_cast<Mesh&>(s) = scene;
  s.vertex.rows = s.points.size();
  s.face.rows = s.tris.size();
  std::vector<std::uint8_t> model(s.tris.size(), 0);
  const std::vector<int> opposite = soundness_of(s).opposite;
  for (std::size_t h = 0; h < opposite.size(); ++h)
    if (opposite[h] >= 0 && marks[h / 3] != marks[opposite[h] / 3]) model[h / 3] |= 1 << h % 3;
  s.face.set("model", std::move(model));
  s.face.set("patch", scene.patch);
  return s;
}

std::vector<Failure> verdict(const Surface& result, const Surface& reference) {
  const auto name = [](int label) { return std::to_string(label); };
  Findings f = examine(result, reference, nullptr, 200);
  f.edges.cut_creases = find_cut_creases({result, f.mesh.opposite}, reference);
  f.patch_faults =
      compare_patches(patches_of(reference, {}, name), patches_of(result, f.mesh.opposite, name));
  return judge(parse_contract(default_contract), f, result);
}

/// A kind of defect: what finds it, and how it is planted at a place.
struct Kind {
  const char* name;
  const char* requirement;
  std::function<void(Scene&, int place)> plant;
};

void add_triangle(Scene& s, Tri t, int like) {
  s.tris.push_back(t);
  s.of.push_back(s.of[like]);
  s.patch.push_back(s.patch[like]);
}

void erase(Scene& s, const std::function<bool(int)>& gone) {
  std::size_t n = 0;
  for (int t = 0; t < (int)s.of.size(); ++t) {
    if (gone(t)) continue;
    s.tris[n] = s.tris[t];
    s.of[n] = s.of[t];
    s.patch[n++] = s.patch[t];
  }
  s.tris.resize(n);
  s.of.resize(n);
  s.patch.resize(n);
}

void move(Scene& s, int component, const std::function<Vec3(Vec3)>& to) {
  std::vector<char> moved(s.points.size(), 0);
  for (int t = 0; t < (int)s.of.size(); ++t)
    for (int v : s.tris[t])
      if (s.of[t] == component && !std::exchange(moved[v], 1)) s.points[v] = to(s.points[v]);
}

void reverse(Scene& s, const std::function<bool(int)>& which) {
  for (int t = 0; t < (int)s.of.size(); ++t)
    if (which(t)) std::swap(s.tris[t][1], s.tris[t][2]);
}

int any(int place) { return std::array{torus_, sphere_, other_sphere_, tube_}[place % 4]; }
int round_one(int place) { return std::array{torus_, sphere_, other_sphere_}[place % 3]; }

/// Splits triangle t by a vertex at these weights.
void split(Scene& s, int t, double a, double b, double c) {
  const Tri v = s.tris[t];
  const int n = (int)s.points.size();
  s.points.push_back(a * s.points[v[0]] + b * s.points[v[1]] + c * s.points[v[2]]);
  s.tris[t] = {v[0], v[1], n};
  add_triangle(s, {v[1], v[2], n}, t);
  add_triangle(s, {v[2], v[0], n}, t);
}

const std::vector<Kind> connectivity{
    {"flipped triangle", "topology",
     [](Scene& s, int i) {
       const int t = s.triangle(any(i), i);
       reverse(s, [&](int u) { return u == t; });
     }},
    {"hole", "topology",
     [](Scene& s, int i) {
       const int t = s.triangle(round_one(i), i);
       erase(s, [&](int u) { return u == t; });
     }},
    {"hole of a vertex", "topology",
     [](Scene& s, int i) {
       const int v = s.tris[s.triangle(round_one(i), i)][0];
       erase(s, [&](int u) { return s.tris[u][0] == v || s.tris[u][1] == v || s.tris[u][2] == v; });
     }},
    {"doubled triangle", "topology",
     [](Scene& s, int i) {
       const int t = s.triangle(any(i), i);
       add_triangle(s, s.tris[t], t);
     }},
    {"doubled and reversed triangle", "topology",
     [](Scene& s, int i) {
       const int t = s.triangle(any(i), i);
       add_triangle(s, {s.tris[t][0], s.tris[t][2], s.tris[t][1]}, t);
     }},
    {"repeated vertex", "topology",
     [](Scene& s, int i) {
       const int t = s.triangle(any(i), i);
       s.tris[t][1] = s.tris[t][0];
     }},
    {"duplicated vertex", "topology",
     [](Scene& s, int i) {
       const int t = s.triangle(round_one(i), i);
       s.points.push_back(s.points[s.tris[t][i % 3]]);
       s.tris[t][i % 3] = (int)s.points.size() - 1;
     }},
    {"pinched vertex", "topology",
     [](Scene& s, int i) {
       const int a = s.tris[s.triangle(sphere_, i)][0], b = s.tris[s.triangle(torus_, i)][0];
       for (Tri& t : s.tris)
         for (int& v : t) v = v == a ? b : v;
     }},
    {"fin", "topology",
     [](Scene& s, int i) {
       const int t = s.triangle(any(i), i);
       s.points.push_back(centroid(s, t) + s.edge(t) * s.normal(t));
       add_triangle(s, {s.tris[t][0], s.tris[t][1], (int)s.points.size() - 1}, t);
     }},
    {"vertex on one side of an edge", "topology",
     [](Scene& s, int i) {
       const int t = s.triangle(any(i), i), n = (int)s.points.size();
       const Tri v = s.tris[t];
       s.points.push_back(lerp(s.points[v[0]], s.points[v[1]], 0.5));
       s.tris[t] = {v[0], n, v[2]};
       add_triangle(s, {n, v[1], v[2]}, t);
     }},
    {"handle", "topology",
     [](Scene& s, int i) {
       const Tri a = s.tris[s.triangle(sphere_, i)], b = s.tris[s.triangle(sphere_, i + 11)];
       const int t = s.triangle(sphere_, i);
       for (int k = 0; k < 3; ++k) {
         const int l = (k + 1) % 3;
         add_triangle(s, {a[k], a[l], b[(3 - k) % 3]}, t);
         add_triangle(s, {a[l], b[(3 - l) % 3], b[(3 - k) % 3]}, t);
       }
       erase(s, [&](int u) { return s.tris[u] == a || s.tris[u] == b; });
     }},
    {"components joined", "topology",
     [](Scene& s, int i) {
       const int t = s.triangle(sphere_, i);
       const Tri a = s.tris[t], b = s.tris[s.triangle(other_sphere_, i)];
       for (int k = 0; k < 3; ++k) {
         const int l = (k + 1) % 3;
         add_triangle(s, {a[k], a[l], b[(3 - k) % 3]}, t);
         add_triangle(s, {a[l], b[(3 - l) % 3], b[(3 - k) % 3]}, t);
       }
       erase(s, [&](int u) { return s.tris[u] == a || s.tris[u] == b; });
     }},
    {"lost component", "topology",
     [](Scene& s, int i) {
       const int c = i % 5;
       erase(s, [&](int u) { return s.of[u] == c; });
     }},
    {"component too many", "topology",
     [](Scene& s, int i) {
       s.add(sphere(20), {8, 0.1 * i, 0}, {}, sphere_);
     }},
    {"border closed", "topology",
     [](Scene& s, int i) {
       const std::vector<int> opposite = soundness_of(s).opposite;
       const std::vector<std::vector<int>> loops = boundary_loops(opposite);
       const std::vector<int>& loop = loops[i % loops.size()];
       s.points.push_back({4 + 0.02 * i, 4, s.points[origin(s.tris, loop[0])].z});
       for (int h : loop)
         add_triangle(s, {target(s.tris, h), origin(s.tris, h), (int)s.points.size() - 1}, h / 3);
     }},
    {"reversed component", "topology",
     [](Scene& s, int i) {
       const int c = i % 5;
       reverse(s, [&](int u) { return s.of[u] == c; });
     }},
    {"all reversed", "topology", [](Scene& s, int) { reverse(s, [](int) { return true; }); }},
};

const std::vector<Kind> geometry{
    {"moved vertex", "vertices",
     [](Scene& s, int i) {
       const int t = s.triangle(round_one(i), i);
       Vec3& p = s.points[s.tris[t][0]];
       p = p + (i % 2 ? 0.3 : -0.3) * s.edge(t) * s.normal(t);
     }},
    {"spike", "deviation",
     [](Scene& s, int i) {
       const int t = s.triangle(i % 2 ? sphere_ : other_sphere_, i);
       Vec3& p = s.points[s.tris[t][0]];
       p = p + 3 * s.edge(t) * s.normal(t);
     }},
    {"needle", "kappa",
     [](Scene& s, int i) {
       const Tri v = s.tris[s.triangle(round_one(i), i)];
       s.points[v[0]] = lerp(s.points[v[1]], s.points[v[0]], 0.02);
     }},
    {"cap", "kappa", [](Scene& s, int i) { split(s, s.triangle(any(i), i), 0.49, 0.49, 0.02); }},
    {"foldover", "folds",
     [](Scene& s, int i) {
       const Tri v = s.tris[s.triangle(other_sphere_, i)];
       // across the opposite edge, along the sphere
       const Vec3 center{0, 8, 0}, p = lerp(s.points[v[1]], s.points[v[2]], 0.5);
       s.points[v[0]] = center + normalized(p + 0.6 * (p - s.points[v[0]]) - center);
     }},
    {"edge across a crease", "creases",
     [](Scene& s, int i) {
       const std::vector<int> opposite = soundness_of(s).opposite;
       std::vector<char> on_crease(s.points.size(), 0);
       std::vector<int> creases;
       for (bool count : {false, true})
         for (int h = 0; h < (int)opposite.size(); ++h) {
           if (s.of[h / 3] != cube_ || s.patch[h / 3] == s.patch[opposite[h] / 3]) continue;
           on_crease[origin(s.tris, h)] = 1;
           const bool free =
               !on_crease[origin(s.tris, prev(h))] && !on_crease[origin(s.tris, prev(opposite[h]))];
           if (count && free) creases.push_back(h);
         }
       const int h = creases[(std::size_t)i * 7919 % creases.size()], g = opposite[h];
       const int a = origin(s.tris, h), b = target(s.tris, h), c = origin(s.tris, prev(h)),
                 d = origin(s.tris, prev(g));
       s.tris[h / 3] = {c, d, b};
       s.tris[g / 3] = {d, c, a};
     }},
    {"intersection", "intersections",
     [](Scene& s, int i) {
       move(s, other_sphere_, [&](Vec3 p) { return p + Vec3{0, -2.2 - 0.02 * i, 0}; });
     }},
    {"shifted surface", "vertices",
     [](Scene& s, int i) {
       for (Vec3& p : s.points) p = p + Vec3{0.06 + 0.002 * i, 0.04, 0};
     }},
    {"scaled component", "vertices",
     [](Scene& s, int i) {
       move(s, sphere_, [&](Vec3 p) { return Vec3{0, 4, 0} + (1.1 + 0.01 * i) * (p - Vec3{0, 4, 0}); });
     }},
    {"lost end", "deviation",
     [](Scene& s, int i) {
       const double end = 2.2 - 0.02 * i;
       move(s, tube_, [&](Vec3 p) { return Vec3{p.x, p.y, p.z * end / 3}; });
     }},
    {"lost dent or limb", "deviation",
     [](Scene& s, int i) {
       const double height = 0.2 + 0.01 * i;
       move(s, cube_, [&](Vec3 p) { return Vec3{p.x, p.y, std::min(p.z, height)}; });
     }},
    {"one component twice, another lost", "deviation",
     [](Scene& s, int i) {
       move(s, i % 2 ? other_sphere_ : sphere_, [&](Vec3 p) {
         return i % 2 ? p + Vec3{0, -4, 0} : p + Vec3{0, 4, 0};
       });
     }},
};

const std::vector<Kind> labels{
    {"label of a triangle", "patches",
     [](Scene& s, int i) {
       int& p = s.patch[s.triangle(i % 2 ? cube_ : torus_, i)];
       p = p == 3 ? 4 : 3;
     }},
    {"swapped labels", "patches",
     [](Scene& s, int i) {
       std::vector<int> own = s.patch;
       std::sort(own.begin(), own.end());
       own.erase(std::unique(own.begin(), own.end()), own.end());
       const int a = own[i % own.size()], b = own[(i + 1 + i / 8) % own.size()];
       for (int& p : s.patch) p = p == a ? b : p == b ? a : p;
     }},
    {"lost label", "patches",
     [](Scene& s, int i) {
       const int c = 1 + i % 4;
       for (std::size_t t = 0; t < s.patch.size(); ++t)
         if (s.of[t] == c) s.patch[t] = 11 + c % 4;
     }},
    {"label of a few triangles only", "patches",
     [](Scene& s, int i) {
       const int c = 1 + i % 4, kept = s.triangle(c, i);
       for (int t = 0; t < (int)s.patch.size(); ++t)
         if (s.of[t] == c && t != kept) s.patch[t] = 11 + c % 4;
     }},
};

void expect_found(const std::vector<Kind>& kinds) {
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);  // meshes this small gain nothing by more
  const Scene fine = scene(2), good = scene(1);
  const Surface reference = finished(fine, fine.patch);
  for (const Kind& kind : kinds)
    for (int place = 0; place < places; ++place) {
      Scene s = good;
      kind.plant(s, place);
      // model edges stay where they were if labels change
      const Surface result = finished(s, s.tris == good.tris ? good.patch : s.patch);
      const std::vector<Failure> failures = verdict(result, reference);
      EXPECT_TRUE(std::any_of(failures.begin(), failures.end(),
                              [&](const Failure& f) { return f.requirement == kind.requirement; }))
          << kind.name << " at place " << place << ": "
          << (failures.empty() ? "nothing found" : failures[0].requirement + ": " + failures[0].fact);
    }
  omp_set_num_threads(threads);
}

TEST(planted, faults_of_connectivity_are_found) { expect_found(connectivity); }
TEST(planted, faults_of_geometry_are_found) { expect_found(geometry); }
TEST(planted, faults_of_labels_are_found) { expect_found(labels); }

TEST(planted, a_sheet_faces_as_its_patch_does) {
  // a sheet of two triangles, and one far away
  Surface reference =
      surface_of({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.9}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}},
                  {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}}});
  reference.face.set<int>("patch", {5, 5, 6});
  auto left = [](const Surface& result, const Surface& given) {
    const std::vector<int> opposite = opposite_halfedges(result);
    std::vector<int> reversed{0, (int)result.tris.size() - 1};
    leave_out_as_labeled(reversed, {result, opposite}, result, given);
    return reversed;
  };
  Surface result = reference;
  EXPECT_EQ(left(result, reference), std::vector<int>{});
  for (int t : {0, 1}) std::swap(result.tris[t][1], result.tris[t][2]);
  EXPECT_EQ(left(result, reference), std::vector<int>{0});
  result.face.set<int>("patch", {5, 5, 5});  // which is no longer of one sheet
  EXPECT_EQ(left(result, reference), (std::vector<int>{0, 2}));
  for (double sign : {1.0, -1.0}) {  // closed ones by their volumes
    Scene s;
    s.add(sphere(80), {0, 0, 0}, {}, sphere_);
    Surface ball = finished(s, s.patch), other = ball;
    for (Vec3& p : other.points) p = Vec3{sign * p.x, p.y, p.z};
    EXPECT_EQ(left(other, ball).empty(), sign > 0);
  }
}

TEST(planted, a_patch_that_the_reference_lacks_is_found) {
  const std::vector<Patch> reference{{"inlet", {1}}, {"wall", {2}}}, result{{"inlet", {1}}, {"junk", {3}}};
  std::vector<std::string> facts;
  for (const PatchFault& f : compare_patches(reference, result)) facts.push_back(f.fact);
  EXPECT_EQ(facts, (std::vector<std::string>{"patch wall is lost", "patch junk is not in the reference"}));
}

TEST(planted, kinds_are_many) { EXPECT_GE(connectivity.size() + geometry.size() + labels.size(), 27u); }

TEST(planted, good_results_give_no_alarm) {
  int count = 0;
  auto expect_good = [&](const Scene& result, const Scene& reference) {
    const auto failures = verdict(finished(result, result.patch), finished(reference, reference.patch));
    EXPECT_TRUE(failures.empty()) << "result " << count << ": " << failures[0].requirement << ": "
                                  << failures[0].fact;
    ++count;
  };
  for (int coarse : {1, 2, 3}) expect_good(scene(coarse), scene(4));
  for (int n : {100, 200, 400, 600, 900, 1500})
    for (int k = 0; k < 3; ++k) {
      Scene s, r;
      const Body c = cube(n), finer = cube(2 * n);
      if (k == 0) s.add(c, {}, c.patch, 0), r.add(finer, {}, finer.patch, 0);
      if (k == 1) s.add(torus(0.3, 2 * n), {}, {}, 0), r.add(torus(0.3, 8 * n), {}, {}, 0);
      if (k == 2) s.add(sphere(n), {}, {}, 0), r.add(sphere(5 * n), {}, {}, 0);
      expect_good(s, r);
    }
  EXPECT_GE(count, 20);
}

}  // namespace
}  // namespace meshpipe
