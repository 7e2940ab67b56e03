// SPDX-License-Identifier: BSD-3-Clause
// Micro-benchmarks of the primitives that the chain spends its time in, over the number of elements.
#include <benchmark/benchmark.h>

#include "lib/core/bvh.h"
#include "lib/core/cdt.h"
#include "lib/core/chart.h"
#include "lib/core/cut.h"
#include "lib/core/edit_mesh.h"
#include "lib/core/intersect.h"
#include "lib/core/random.h"
#include "lib/core/topology.h"
#include "lib/numeric/laplacian.h"
#include "lib/shape/shape.h"

namespace meshpipe {
namespace {

void per_triangle(benchmark::State& state, std::size_t triangles) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(triangles));
}

void connectivity(benchmark::State& state) {
  const Mesh m = torus(0.4, (int)state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(opposite_halfedges(m.tris, (int)m.points.size()));
  per_triangle(state, m.tris.size());
}

void cut(benchmark::State& state) {
  Surface s = surface_of(torus(0.4, (int)state.range(0)));
  std::vector<double> field;
  for (Vec3 p : s.points) field.push_back(p.x + 0.3 * p.y - 0.137);
  for (auto _ : state) {
    Surface copy = s;
    std::vector<int> side;
    benchmark::DoNotOptimize(cut_by_scalar_field(copy, field, {}, side));
  }
  per_triangle(state, s.tris.size());
}

/// A square of n by n points, its border fixed.
struct Grid {
  std::vector<Tri> tris;
  std::vector<Vec2> points;
  std::vector<char> fixed;

  explicit Grid(int n) {
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        points.push_back({(double)x / n, (double)y / n});
        fixed.push_back(x == 0 || y == 0 || x == n - 1 || y == n - 1);
      }
    for (int y = 0; y + 1 < n; ++y)
      for (int x = 0; x + 1 < n; ++x) {
        const int a = y * n + x;
        tris.push_back({a, a + 1, a + n + 1});
        tris.push_back({a, a + n + 1, a + n});
      }
  }
};

void solve(benchmark::State& state) {
  const Grid g((int)std::sqrt(state.range(0) / 2.0));
  const std::vector<double> weights(3 * g.tris.size(), 1.0);
  for (auto _ : state) {
    std::vector<Vec2> uv = g.points;
    solve_dirichlet(g.tris, weights, g.fixed, uv);
    benchmark::DoNotOptimize(uv.data());
  }
  per_triangle(state, g.tris.size());
}

/// Random points inside a square, the corners first.
std::vector<Vec2> scattered(int n) {
  std::vector<Vec2> points{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  Random random(1);
  while ((int)points.size() < n) {
    const Vec3 p = random.in_ball();
    points.push_back({0.5 + 0.49 * p.x, 0.5 + 0.49 * p.y});
  }
  return points;
}

const std::vector<FixedEdge> square{{0, 1, true}, {1, 2, true}, {2, 3, true}, {3, 0, true}};

void insert(benchmark::State& state) {
  const std::vector<Vec2> points = scattered((int)state.range(0) / 2);
  for (auto _ : state) benchmark::DoNotOptimize(Cdt(points, square).tris.data());
  per_triangle(state, (std::size_t)state.range(0));
}

void flip(benchmark::State& state) {
  Cdt mesh(scattered((int)state.range(0) / 2), square);
  const int n = 3 * (int)mesh.tris.size();
  std::int64_t flips = 0;
  for (auto _ : state)
    for (int h = 0; h < n; ++h)
      if (mesh.can_flip(h)) {
        mesh.flip(h);
        ++flips;
      }
  state.SetItemsProcessed(flips);
}

void flip_on_surface(benchmark::State& state) {
  const Mesh m = torus(0.4, (int)state.range(0));
  EditMesh edit(m.tris, (int)m.points.size(), std::vector<std::uint8_t>(m.tris.size(), 0));
  const int n = 3 * (int)m.tris.size();
  std::int64_t flips = 0;
  for (auto _ : state)
    for (int h = 0; h < n; ++h)
      if (edit.degree[edit.from(h)] > 4 && edit.degree[edit.to(h)] > 4 &&
          !edit.joined(edit.apex(h), edit.apex(edit.opp[h]))) {
        edit.flip(h);
        ++flips;
      }
  state.SetItemsProcessed(flips);
}

void locate_in_chart(benchmark::State& state) {
  const Grid g((int)std::sqrt(state.range(0) / 2.0));
  Chart chart;
  for (Vec2 p : g.points) chart.mesh.points.push_back({p.x, p.y, 0});
  chart.mesh.tris = g.tris;
  chart.uv = g.points;
  index_chart(chart);
  const std::vector<Vec2> points = scattered(1000);
  int hint = 0;
  for (auto _ : state)
    for (Vec2 p : points) hint = std::max(0, locate(chart, p, hint).face);
  state.SetItemsProcessed(state.iterations() * 1000);
}

void nearest(benchmark::State& state) {
  const Mesh m = torus(0.4, (int)state.range(0)), other = torus(0.401, 2000);
  const Bvh tree(m);
  for (auto _ : state)
    for (Vec3 p : other.points) benchmark::DoNotOptimize(tree.nearest(p).distance);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(other.points.size()));
}

void intersections(benchmark::State& state) {
  const Mesh m = torus(0.4, (int)state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(self_intersections(m).size());
  per_triangle(state, m.tris.size());
}

BENCHMARK(connectivity)->RangeMultiplier(10)->Range(1000, 1000000);
BENCHMARK(cut)->RangeMultiplier(10)->Range(1000, 1000000);
BENCHMARK(solve)->RangeMultiplier(10)->Range(1000, 100000);
BENCHMARK(insert)->RangeMultiplier(10)->Range(1000, 100000);
BENCHMARK(flip)->RangeMultiplier(10)->Range(1000, 100000);
BENCHMARK(flip_on_surface)->RangeMultiplier(10)->Range(1000, 100000);
BENCHMARK(locate_in_chart)->RangeMultiplier(10)->Range(1000, 1000000);
BENCHMARK(nearest)->RangeMultiplier(10)->Range(1000, 1000000);
BENCHMARK(intersections)->RangeMultiplier(10)->Range(1000, 1000000);

}  // namespace
}  // namespace meshpipe

BENCHMARK_MAIN();
