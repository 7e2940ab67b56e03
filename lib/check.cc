// SPDX-License-Identifier: BSD-3-Clause
#include "lib/check.h"

#include <algorithm>
#include <numbers>
#include <numeric>

#include "lib/bvh.h"
#include "lib/edges.h"
#include "lib/topology.h"

namespace meshpipe {
namespace {

constexpr double degree = 180 / std::numbers::pi;
constexpr int chunk = 4096;  // sums are taken by chunks, so that they are the same at any number of threads

/// Vertices where two corners of the mesh are not joined by a chain of triangles round the vertex.
void find_pinched(const Mesh& mesh, Connectivity& c) {
  const auto& opposite = c.opposite;
  const int n = 3 * (int)mesh.tris.size();
  std::vector<char> corner_seen(n, 0), vertex_seen(mesh.points.size(), 0);
  for (int h = 0; h < n; ++h) {
    if (corner_seen[h]) continue;
    char& vertex = vertex_seen[origin(mesh.tris, h)];
    if (vertex) c.pinched.push_back(h / 3);
    vertex = 1;
    int g = h;
    do {
      corner_seen[g] = 1;
      g = opposite[prev(g)];
    } while (g >= 0 && g != h);
    if (g >= 0) continue;
    // the fan ends at the border; its other half lies on the other side
    for (g = opposite[h]; g >= 0; g = opposite[g]) corner_seen[g = next(g)] = 1;
  }
}

void find_components(Connectivity& c) {
  std::vector<int> component;
  c.components = components(c.opposite, component);
  std::vector<int> faces(c.components, 0);
  for (int x : component) ++faces[x];
  const int smallest = (int)(std::min_element(faces.begin(), faces.end()) - faces.begin());
  if (c.components)
    c.small_component = (int)(std::find(component.begin(), component.end(), smallest) - component.begin());
}

void find_loops(const Mesh& mesh, Connectivity& c) {
  double shortest = 0;
  for (const std::vector<int>& loop : boundary_loops(c.opposite)) {
    double length = 0;
    for (int h : loop) length += norm(mesh.points[origin(mesh.tris, h)] - mesh.points[target(mesh.tris, h)]);
    if (c.loops++ == 0 || length < shortest) {
      shortest = length;
      c.loop = loop[0];
    }
  }
}

}  // namespace

Connectivity connectivity_of(const Mesh& mesh) {
  Connectivity c;
  c.faces = (int)mesh.tris.size();
  const int n = (int)mesh.points.size();
  std::vector<char> used(n, 0);
  for (int t = 0; t < c.faces; ++t) {
    const Tri& v = mesh.tris[t];
    for (int x : v) used[x] = 1;
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) c.degenerate.push_back(t);
  }
  c.vertices = (int)std::count(used.begin(), used.end(), 1);
  c.opposite.assign(3 * mesh.tris.size(), -1);
  for_each_edge(mesh.tris, n, [&](std::span<const EdgeUse> uses) {
    ++c.edges;
    const int h = half_edge(uses[0]);
    if (uses.size() > 2) return c.nonmanifold.push_back(half_edge(uses.back()) / 3);
    if (uses.size() < 2) return;
    const int g = half_edge(uses[1]);
    if (origin(mesh.tris, h) == origin(mesh.tris, g)) return c.turned.push_back(h / 3);
    c.opposite[h] = g;
    c.opposite[g] = h;
  });
  if (c.sound()) find_pinched(mesh, c);
  if (!c.sound()) return c;
  find_components(c);
  find_loops(mesh, c);
  c.genus = (2 * c.components - (c.vertices - c.edges + c.faces) - c.loops) / 2;  // the paper's eq. (2)
  return c;
}

namespace {

/// Shapes of the triangles of one chunk.
struct Shapes {
  double kappa_sum = 0, angle_sum = 0, min_angle = 180, max_angle = 0;
  std::array<int, 60> angles{};
};

/// kappa as 8 A^2 / (s a b c), the same number as the paper's eq. (6) without trigonometry; of the angles
/// only those at the ends of the shortest and the longest side are asked for.
Shapes shapes(const Mesh& mesh, int first, int last, std::vector<float>& kappas) {
  Shapes s;
  double cotangent = 1e300;  // of the largest angle; it falls as the angle grows
  for (int t = first; t < last; ++t) {
    const Vec3 &a = mesh.points[mesh.tris[t][0]], &b = mesh.points[mesh.tris[t][1]],
               &c = mesh.points[mesh.tris[t][2]];
    const Vec3 x = c - b, y = a - c, z = b - a;
    const double xx = dot(x, x), yy = dot(y, y), zz = dot(z, z), n = norm(cross(y, z));
    const double p = std::sqrt(xx), q = std::sqrt(yy), r = std::sqrt(zz), d = p * q * r * (p + q + r);
    const double k = d > 0 ? 4 * n * n / d : 0;
    kappas[t] = (float)k;
    s.kappa_sum += k;
    const double shortest = std::min({xx, yy, zz}), longest = std::max({xx, yy, zz}), all = xx + yy + zz;
    const double least = std::atan2(2 * n, all - 2 * shortest) * degree;  // dot = (all - 2 l^2) / 2
    s.angle_sum += least;
    s.min_angle = std::min(s.min_angle, least);
    ++s.angles[std::clamp((int)least, 0, 59)];
    if (n > 0)
      cotangent = std::min(cotangent, (all - 2 * longest) / (2 * n));
    else
      s.max_angle = 180;
  }
  s.max_angle = std::max(s.max_angle, std::atan2(1, cotangent) * degree);
  return s;
}

struct Lengths {
  double sum = 0, squares = 0, least = 1e300, largest = 0;
  int count = 0;
};

}  // namespace

Quality quality_of(const Mesh& mesh, std::span<const int> opposite, const std::vector<double>& size) {
  Quality q;
  q.angle_histogram.assign(60, 0);
  const int n = (int)mesh.tris.size(), chunks = (n + chunk - 1) / chunk;
  if (n == 0) return q;
  q.kappas.resize(n);
  std::vector<Shapes> shape(chunks);
  std::vector<Lengths> length(chunks);
#pragma omp parallel for schedule(dynamic) if (chunks > 1)
  for (int k = 0; k < chunks; ++k) {
    const int first = k * chunk, last = std::min(n, first + chunk);
    shape[k] = shapes(mesh, first, last, q.kappas);
    Lengths& l = length[k];
    for (int h = 3 * first; h < 3 * last; ++h) {
      if (opposite[h] > h) continue;
      const int a = origin(mesh.tris, h), b = target(mesh.tris, h);
      double x = norm(mesh.points[a] - mesh.points[b]);
      if (!size.empty()) x *= 2 / (size[a] + size[b]);
      l.sum += x;
      l.squares += x * x;
      l.least = std::min(l.least, x);
      l.largest = std::max(l.largest, x);
      ++l.count;
    }
  }
  q.min_angle = 180;
  for (const Shapes& s : shape) {
    q.kappa_mean += s.kappa_sum / n;
    q.mean_min_angle += s.angle_sum / n;
    q.min_angle = std::min(q.min_angle, s.min_angle);
    q.max_angle = std::max(q.max_angle, s.max_angle);
    for (int i = 0; i < 60; ++i) q.angle_histogram[i] += s.angles[i];
  }
  q.worst = (int)(std::min_element(q.kappas.begin(), q.kappas.end()) - q.kappas.begin());
  const Tri& w = mesh.tris[q.worst];
  q.kappa_min = kappa(mesh.points[w[0]], mesh.points[w[1]], mesh.points[w[2]]);
  std::vector<float> sorted = q.kappas;
  std::nth_element(sorted.begin(), sorted.begin() + n / 100, sorted.end());
  q.kappa_p01 = sorted[n / 100];

  Lengths all;
  for (const Lengths& l : length) {
    all.sum += l.sum;
    all.squares += l.squares;
    all.least = std::min(all.least, l.least);
    all.largest = std::max(all.largest, l.largest);
    all.count += l.count;
  }
  const double mean = all.sum / all.count, unit = size.empty() && mean > 0 ? mean : 1;
  q.edge_min = all.least / unit;
  q.edge_max = all.largest / unit;
  q.edge_mean = mean / unit;
  q.edge_deviation = std::sqrt(std::max(0.0, all.squares / all.count - mean * mean)) / unit;

  std::vector<int> valence(mesh.points.size(), 0);
  constexpr int border = 1 << 28;
  for (int h = 0; h < 3 * n; ++h) {
    ++valence[origin(mesh.tris, h)];
    if (opposite[h] < 0) valence[origin(mesh.tris, h)] |= border, valence[target(mesh.tris, h)] |= border;
  }
  int inner = 0, good = 0;
  for (int v : valence)
    if (v > 0 && v < border) {
      ++inner;
      good += v >= 5 && v <= 7;
    }
  q.valence567 = inner ? (double)good / inner : 1;
  return q;
}

std::vector<int> bins(std::span<const float> values, double low, double high, int n) {
  std::vector<int> counts(n, 0);
  for (float x : values)
    if (x >= low && x <= high) ++counts[std::min(n - 1, (int)(n * (x - low) / (high - low)))];
  return counts;
}

std::vector<NeedleTip> needle_tips(const Mesh& mesh, std::span<const int> opposite,
                                   const std::vector<std::uint8_t>& model) {
  constexpr double least = 3 / degree;
  std::vector<NeedleTip> tips;
  auto marked = [&](int h) { return opposite[h] < 0 || (!model.empty() && (model[h / 3] >> h % 3 & 1)); };
  auto corner = [&](int g) {
    const Vec3& p = mesh.points[origin(mesh.tris, g)];
    return angle(mesh.points[target(mesh.tris, g)] - p, mesh.points[origin(mesh.tris, prev(g))] - p);
  };
  for (int h = 0; h < 3 * (int)mesh.tris.size(); ++h) {
    const bool wedge = marked(h);
    const double limit = wedge ? least : 3 * least;
    double sum = corner(h);
    int first = h;  // of all round
    bool all_round = false;
    for (int g = h; sum < limit && !marked(prev(g)) && !all_round;) {
      g = opposite[prev(g)];
      first = std::min(first, g);
      all_round = g == h;
      if (!all_round) sum += corner(g);
    }
    // a fan that ends at a marked edge is looked at from its other one
    if (sum < limit && (wedge || (all_round && first == h)))
      tips.push_back({mesh.points[origin(mesh.tris, h)], wedge ? sum : sum / 3});
  }
  return tips;
}

std::vector<char> forced_needles(const Mesh& mesh, const std::vector<float>& kappas,
                                 const std::vector<NeedleTip>& tips) {
  constexpr double touches = 0.1;  // of its longest edge
  std::vector<char> forced(mesh.tris.size(), 0);
  std::vector<int> bad;
  for (int t = 0; t < (int)kappas.size(); ++t)
    if (!(kappas[t] > 0.1F)) bad.push_back(t);
  if (bad.empty() || tips.empty()) return forced;
  auto point = [&](int t, int i) { return mesh.points[mesh.tris[t][i]]; };
  std::vector<double> length(bad.size());
  Mesh boxes;  // of each bad triangle, with what it reaches, as a segment between its ends
  std::vector<std::pair<int, int>> corners;  // vertex, place in `bad`
  for (int i = 0; i < (int)bad.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      length[i] = std::max(length[i], norm(point(bad[i], (k + 1) % 3) - point(bad[i], k)));
      corners.push_back({mesh.tris[bad[i]][k], i});
    }
  std::sort(corners.begin(), corners.end());
  for (int i = 0; i < (int)bad.size(); ++i) {
    const Box box = box_of(mesh, bad[i]);
    const double reach = touches * length[i];
    boxes.points.push_back(box.lo - Vec3{reach, reach, reach});
    boxes.points.push_back(box.hi + Vec3{reach, reach, reach});
    boxes.tris.push_back({2 * i, 2 * i + 1, 2 * i + 1});
  }
  const Bvh tree(boxes);
  std::vector<int> reached, seen(bad.size(), -1);
  for (int tip = 0; tip < (int)tips.size(); ++tip) {
    const Vec3 p = tips[tip].point;
    const double room = tips[tip].room;
    reached.clear();
    tree.overlapping({p, p}, [&](int i) {
      const Vec3 a = point(bad[i], 0), b = point(bad[i], 1), c = point(bad[i], 2);
      const auto w = closest_on_triangle(p, a, b, c);
      if (norm(w[0] * a + w[1] * b + w[2] * c - p) <= touches * length[i])
        reached.push_back(i), seen[i] = tip;
    });
    for (std::size_t k = 0; k < reached.size(); ++k) {
      const int t = bad[reached[k]];
      forced[t] = 1;
      for (int v : mesh.tris[t])
        for (auto at = std::lower_bound(corners.begin(), corners.end(), std::pair{v, -1});
             at != corners.end() && at->first == v; ++at) {
          const int i = at->second;
          const Vec3 centre = 1.0 / 3 * (point(bad[i], 0) + point(bad[i], 1) + point(bad[i], 2));
          if (seen[i] == tip || norm(centre - p) * room > length[i]) continue;
          seen[i] = tip;
          reached.push_back(i);
        }
    }
  }
  return forced;
}

double kappa_off_wedges(const Mesh& mesh, std::span<const int> opposite,
                        const std::vector<std::uint8_t>& model, const Quality& quality, int& worst) {
  constexpr double limit = 40 / degree;
  const int n = 3 * (int)mesh.tris.size();
  auto marked = [&](int h) { return opposite[h] < 0 || (model[h / 3] >> h % 3 & 1); };
  std::vector<char> tip(mesh.points.size(), 0);
  for (int h = 0; h < n; ++h) {
    if (!marked(h)) continue;
    double sum = 0;
    for (int g = h;; g = opposite[prev(g)]) {
      const Vec3& p = mesh.points[origin(mesh.tris, g)];
      sum += angle(mesh.points[target(mesh.tris, g)] - p, mesh.points[origin(mesh.tris, prev(g))] - p);
      if (sum >= limit || marked(prev(g))) break;
    }
    if (sum < limit) tip[origin(mesh.tris, h)] = 1;
  }
  std::vector<char> close = tip;
  for (const Tri& t : mesh.tris)
    if (tip[t[0]] || tip[t[1]] || tip[t[2]]) close[t[0]] = close[t[1]] = close[t[2]] = 1;
  worst = -1;
  for (int t = 0; t < n / 3; ++t) {
    const Tri& v = mesh.tris[t];
    if (!close[v[0]] && !close[v[1]] && !close[v[2]] &&
        (worst < 0 || quality.kappas[t] < quality.kappas[worst]))
      worst = t;
  }
  return worst < 0 ? 1 : quality.kappas[worst];
}

namespace {

/// The corners of the largest triangle of some points, if it covers all the pieces.
bool hull_of_pieces(const Mesh& mesh, std::span<const int> pieces, Tri& corners) {
  std::vector<int> v;
  Vec3 whole{};
  for (int t : pieces) {
    v.insert(v.end(), mesh.tris[t].begin(), mesh.tris[t].end());
    const Tri& p = mesh.tris[t];
    whole = whole + area_vector(mesh.points[p[0]], mesh.points[p[1]], mesh.points[p[2]]);
  }
  std::sort(v.begin(), v.end());
  v.erase(std::unique(v.begin(), v.end()), v.end());
  if (v.size() > 64) {
    // the farthest point of a triangle from any other is a corner, and so is the farthest from a side
    auto farthest = [&](auto distance) {
      return *std::max_element(v.begin(), v.end(), [&](int i, int j) { return distance(i) < distance(j); });
    };
    auto from = [&](int a) { return farthest([&](int i) { return norm(mesh.points[i] - mesh.points[a]); }); };
    auto area = [&](int a, int b, int c) {
      return dot(area_vector(mesh.points[a], mesh.points[b], mesh.points[c]), whole);
    };
    const int a = from(v[0]), b = from(a), c = farthest([&](int i) { return std::abs(area(a, b, i)); });
    v = {a, b, c};
  }
  double best = 0;
  for (std::size_t i = 0; i < v.size(); ++i)
    for (std::size_t j = i + 1; j < v.size(); ++j)
      for (std::size_t k = j + 1; k < v.size(); ++k) {
        const double a = dot(area_vector(mesh.points[v[i]], mesh.points[v[j]], mesh.points[v[k]]), whole);
        if (std::abs(a) <= best) continue;
        best = std::abs(a);
        corners = a > 0 ? Tri{v[i], v[j], v[k]} : Tri{v[i], v[k], v[j]};
      }
  return std::abs(best - dot(whole, whole)) <= 1e-6 * dot(whole, whole);
}

}  // namespace

Mesh uncut(const Mesh& mesh, const std::vector<int>& origin, std::vector<int>* now) {
  const int n = (int)mesh.tris.size();
  Mesh whole;
  whole.points = mesh.points;
  whole.tris.reserve(n);
  // the triangles in the order of their origins, by counting
  std::vector<int> start(n == 0 ? 1 : *std::max_element(origin.begin(), origin.end()) + 2, 0), order(n);
  for (int o : origin) ++start[o + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  for (int t = 0; t < n; ++t) order[start[origin[t]]++] = t;
  if (now) now->resize(n);
  for (int first = 0, last; first < n; first = last) {
    for (last = first + 1; last < n && origin[order[last]] == origin[order[first]];) ++last;
    Tri corners;
    const bool one =
        last - first > 1 && hull_of_pieces(mesh, std::span(order).subspan(first, last - first), corners);
    if (one) whole.tris.push_back(corners);
    for (int i = first; i < last; ++i) {
      if (!one) whole.tris.push_back(mesh.tris[order[i]]);
      if (now) (*now)[order[i]] = static_cast<int>(whole.tris.size()) - 1;
    }
  }
  return whole;
}

}  // namespace meshpipe
