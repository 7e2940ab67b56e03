// SPDX-License-Identifier: BSD-3-Clause
#include "lib/check/distance.h"

#include <algorithm>
#include <span>
#include <tuple>

#include "lib/check/overlay.h"
#include "lib/core/surface_walk.h"

namespace meshpipe {
namespace {

constexpr int points_at_once = 256;                 // for a thread: each search starts where the last ended
constexpr double own_sheet = 2;                     // of a distance: how much farther p's own sheet may be
constexpr double relative = 0.05, absolute = 1e-4;  // of the Hausdorff distance, of the diagonal

/// A point's distance to the other surface, and the nearest triangle.
struct Near {
  double distance = 0;
  int face = -1;
};

/// Searches for points that come close to each other one by one: what is known of the last bounds the next.
class Seeker {
 public:
  explicit Seeker(const Bvh& tree) : tree_(tree) {}
  /// Walks over the surface from where the last was nearest, for a better bound.
  Seeker(const Bvh& tree, const Connectivity& surface) : tree_(tree), surface_(&surface) {}
  /// What is not above `enough` may be more than the distance of the nearest point.
  Near operator()(Vec3 p, double enough = -1) {
    double bound = last_.face < 0 ? 1e300 : last_.distance + norm(p - at_);
    at_ = p;
    if (surface_ && last_.face >= 0) {
      last_.distance =
          walk_to(p, surface_->mesh.points, surface_->mesh.tris, surface_->opposite, last_.face, enough);
      if (last_.distance <= enough) return last_;
      bound = std::min(bound, last_.distance);
    }
    const Bvh::Hit hit = tree_.nearest(p, bound);
    return last_ = {hit.distance, hit.place.face};
  }

 private:
  const Bvh& tree_;
  const Connectivity* surface_ = nullptr;
  Near last_;
  Vec3 at_;
};

/// Vertices in the order of the triangles that use them first.
std::vector<int> vertices_of(const Mesh& mesh, std::span<const int> triangles) {
  std::vector<int> vertices;
  std::vector<char> seen(mesh.points.size(), 0);
  for (int t : triangles)
    for (int v : mesh.tris[t])
      if (!seen[v]) {
        seen[v] = 1;
        vertices.push_back(v);
      }
  return vertices;
}

/// What a distance may be at each triangle of the mesh, and whether that is the surface measured from.
struct Allowed {
  std::span<const double> at;  ///< none: anything
  bool from_mesh;
  double least = infinity;
  double most = infinity;  ///< anywhere
};

/// One direction: the distances of one surface's points from the other.
class OneSided : public OneWay {
 public:
  /// `order`: the triangles to measure from, neighbors close together.
  OneSided(const Mesh& from, std::span<const int> order, const Connectivity& to, const Bvh& to_tree,
           double diagonal, const Allowed& allowed)
      : from_(from), order_(order), to_(to), to_tree_(to_tree), diagonal_(diagonal), allowed_(allowed) {
    deviation.ratio.assign(allowed.at.size(), 0);
    for (double a : allowed.at) most_allowed_ = std::max(most_allowed_, a);
  }

  double known = 0;  ///< found on either side: what is not beyond it need not be known any better

  void sample(int samples);
  void bound(int budget);

 private:
  struct Piece {
    std::array<Vec3, 3> corner;
    std::array<Near, 3> near;
    double upper;
    int face;  ///< the triangle it is of
  };

  double limit() const {
    const double d = std::max(largest, known), about = std::max((1 + relative) * d, d + absolute * diagonal_);
    return d < allowed_.most ? std::min(about, allowed_.most) : about;
  }
  void found(const Near& near, Vec3 p, int face) {
    if (near.distance > largest) largest = near.distance, place = p;
    if (allowed_.at.empty()) return;
    int t = allowed_.from_mesh ? face : near.face;
    double r = near.distance / allowed_.at[t];
    // no other triangle allows more than `most_allowed_`: a search that far may meet all of them
    if (r > 1 && !allowed_.from_mesh && near.distance <= most_allowed_)
      judge_by_others(p, near.distance, r, t);
    deviation.ratio[t] = std::max(deviation.ratio[t], r);
    if (r > deviation.worst) deviation.worst = r, deviation.triangle = t, deviation.place = p;
  }
  /// Finds the triangle that allows the most, as a ratio, of those that are not much farther from p than the
  /// nearest: where sheets of different sizes meet, that may be of another sheet than p.
  void judge_by_others(Vec3 p, double distance, double& ratio, int& triangle) const {
    const Vec3 reach = own_sheet * distance * Vec3{1, 1, 1};
    to_tree_.overlapping({p - reach, p + reach}, [&](int t) {
      const double r = from_triangle(p, t) / allowed_.at[t];
      if (r < ratio || (r == ratio && t < triangle)) ratio = r, triangle = t;
    });
  }
  /// Below this, a piece's distance need not be known any better.
  double enough(const Piece& p) const {
    double most = limit();
    if (allowed_.at.empty() || allowed_.least >= most) return most;
    if (allowed_.from_mesh) return std::min(most, allowed_.at[p.face]);
    for (const Near& near : p.near) most = std::min(most, allowed_.at[near.face]);
    return most;
  }
  std::vector<int> doubtful_triangles();
  /// Returns the pieces that are not near enough; of the others only `upper` is raised.
  std::vector<Piece> doubtful_pieces(std::span<const int> triangles);
  void set_upper(Piece& piece) const;
  double from_triangle(Vec3 p, int face) const;
  double farthest_corner(const Piece& piece, int face) const;

  const Mesh& from_;
  const std::span<const int> order_;
  const Connectivity& to_;
  const Bvh& to_tree_;
  const double diagonal_;
  const Allowed allowed_;
  double most_allowed_ = 0;
};

void OneSided::sample(int samples) {
  const auto order = order_;
  const int n = (int)order.size();
  std::vector<double> area(n);
  double total = 0;
  for (int i = 0; i < n; ++i) {
    const Tri& t = from_.tris[order[i]];
    area[i] = total += 0.5 * norm(area_vector(from_.points[t[0]], from_.points[t[1]], from_.points[t[2]]));
  }
  const int chunks = (samples + points_at_once - 1) / points_at_once;
  struct Part {
    double sum = 0, squares = 0;
    std::vector<std::tuple<Near, Vec3, int>> found;
  };
  std::vector<Part> part(chunks);
#pragma omp parallel for schedule(dynamic) if (chunks > 1)
  for (int k = 0; k < chunks; ++k) {
    Seeker seek(to_tree_, to_);
    for (int j = k * points_at_once; j < std::min(samples, (k + 1) * points_at_once); ++j) {
      const double at = (j + 0.5) / samples * total;
      const int i = std::min(n - 1, (int)(std::lower_bound(area.begin(), area.end(), at) - area.begin()));
      // within the triangle by the additive sequence of the plane's golden ratio, folded
      double u = std::fmod(0.5 + 0.7548776662466927 * j, 1.0),
             v = std::fmod(0.5 + 0.5698402909980532 * j, 1.0);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Tri& t = from_.tris[order[i]];
      const Vec3 p = (1 - u - v) * from_.points[t[0]] + u * from_.points[t[1]] + v * from_.points[t[2]];
      const Near near = seek(p);
      part[k].found.push_back({near, p, order[i]});
      part[k].sum += near.distance;
      part[k].squares += near.distance * near.distance;
    }
  }
  for (const Part& p : part) {
    for (const auto& [near, point, face] : p.found) found(near, point, face);
    mean += p.sum / samples;
    rms += p.squares / samples;
  }
  rms = std::sqrt(rms);
}

/// Returns the triangles that bounding balls of groups of neighbors do not prove to be near enough.
std::vector<int> OneSided::doubtful_triangles() {
  const auto order = order_;
  const int n = (int)order.size();
  const double most = std::min(limit(), allowed_.least);
  std::vector<int> groups, split;  // where in the order they start
  for (int first = 0; first < n; first += 64) groups.push_back(first);
  for (int size = 64; size > 1; size /= 4) {
    std::vector<double> reach(groups.size());
#pragma omp parallel for schedule(dynamic, 64) if (groups.size() > 256)
    for (std::size_t g = 0; g < groups.size(); ++g) {
      Box box = box_of(from_, order[groups[g]]);
      for (int i = groups[g]; i < std::min(n, groups[g] + size); ++i)
        box = join(box, box_of(from_, order[i]));
      reach[g] = 0.5 * norm(box.hi - box.lo);
      // a search only where it can be expected to settle the matter
      reach[g] += reach[g] + mean < most ? to_tree_.nearest(0.5 * (box.lo + box.hi)).distance : infinity;
    }
    split.clear();
    for (std::size_t g = 0; g < groups.size(); ++g)
      if (reach[g] <= most)
        upper = std::max(upper, reach[g]);
      else
        for (int i = groups[g]; i < std::min(n, groups[g] + size); i += size / 4) split.push_back(i);
    groups.swap(split);
  }
  for (int& g : groups) g = order[g];
  return groups;
}

double OneSided::from_triangle(Vec3 p, int face) const { return norm(closest_point(to_.mesh, face, p) - p); }

/// The largest distance of the corners from one triangle of the other surface.
double OneSided::farthest_corner(const Piece& piece, int face) const {
  double farthest = 0;
  for (int i = 0; i < 3; ++i)
    farthest = std::max(
        farthest, piece.near[i].face == face ? piece.near[i].distance : from_triangle(piece.corner[i], face));
  return farthest;
}

/// No point of a triangle is farther from a corner than its longest side over sqrt(3). And distance from a
/// convex set is convex: a triangle is within the largest distance of its corners from any one triangle of
/// the other surface. The dearer bounds are looked at only if the cheaper ones are not `enough`.
void OneSided::set_upper(Piece& p) const {
  const double enough = this->enough(p);
  double side = 0, distance = 0;
  for (int i = 0; i < 3; ++i) {
    side = std::max(side, norm(p.corner[(i + 1) % 3] - p.corner[i]));
    distance = std::max(distance, p.near[i].distance);
  }
  p.upper = distance + side / std::sqrt(3.0);
  auto look = [&](auto bound) {
    if (p.upper > enough) p.upper = std::min(p.upper, bound());
  };
  look([&] { return farthest_corner(p, p.near[0].face); });
  look([&] { return sheet_height(to_, p.near[0].face, p.corner, enough); });
  for (int i = 1; i < 3; ++i)
    if (p.near[i].face != p.near[0].face && p.near[i].face != p.near[i - 1].face)
      look([&] { return farthest_corner(p, p.near[i].face); });
  look([&] { return overlay_height(to_.mesh, to_tree_, p.corner, enough); });
}

std::vector<OneSided::Piece> OneSided::doubtful_pieces(std::span<const int> triangles) {
  const std::vector<int> vertices = vertices_of(from_, triangles);
  std::vector<Near> near(from_.points.size());
  const int n = (int)vertices.size(), faces = (int)triangles.size();
  // what is neither the farthest nor the farthest over what is allowed need not be known exactly
  const double small =
      allowed_.at.empty() ? largest : std::min(largest, std::min(deviation.worst, 0.5) * allowed_.least);
#pragma omp parallel for schedule(dynamic) if (n > points_at_once)
  for (int first = 0; first < n; first += points_at_once) {
    Seeker seek(to_tree_, to_);
    for (int i = first; i < std::min(n, first + points_at_once); ++i)
      near[vertices[i]] = seek(from_.points[vertices[i]], small);
  }
  for (int t : triangles)
    for (int v : from_.tris[t]) found(near[v], from_.points[v], t);
  // most are near enough: only the others are kept, since pieces are large
  constexpr int few = 1024;
  const int parts = (faces + few - 1) / few;
  std::vector<std::vector<Piece>> kept(parts);
  std::vector<double> settled(parts, 0);
#pragma omp parallel for schedule(dynamic) if (parts > 1)
  for (int part = 0; part < parts; ++part)
    for (int i = part * few; i < std::min(faces, (part + 1) * few); ++i) {
      const Tri& t = from_.tris[triangles[i]];
      Piece p;
      for (int k = 0; k < 3; ++k) p.corner[k] = from_.points[t[k]], p.near[k] = near[t[k]];
      p.face = triangles[i];
      set_upper(p);
      if (p.upper > enough(p))
        kept[part].push_back(p);
      else
        settled[part] = std::max(settled[part], p.upper);
    }
  std::vector<Piece> pieces;
  std::size_t count = 0;
  for (const auto& k : kept) count += k.size();
  pieces.reserve(count);
  for (int part = 0; part < parts; ++part) {
    upper = std::max(upper, settled[part]);
    pieces.insert(pieces.end(), kept[part].begin(), kept[part].end());
    kept[part] = {};
  }
  return pieces;
}

void OneSided::bound(int budget) {
  std::vector<Piece> pieces = doubtful_pieces(doubtful_triangles()), halves;
  for (;;) {
    const auto done =
        std::partition(pieces.begin(), pieces.end(), [&](const Piece& p) { return p.upper > enough(p); });
    for (auto p = done; p < pieces.end(); ++p) upper = std::max(upper, p->upper);
    pieces.erase(done, pieces.end());
    const int n = (int)pieces.size();
    budget -= n;
    if (n == 0 || budget < 0) break;
    halves.resize(2 * n);
#pragma omp parallel for schedule(dynamic, 64) if (n > 256)
    for (int i = 0; i < n; ++i) {
      const Piece& p = pieces[i];
      int longest = 0;
      double length = -1;
      for (int k = 0; k < 3; ++k)
        if (const double l = norm(p.corner[(k + 1) % 3] - p.corner[k]); l > length) length = l, longest = k;
      const int a = longest, b = (longest + 1) % 3;
      const Vec3 middle = lerp(p.corner[a], p.corner[b], 0.5);
      const auto hit =
          to_tree_.nearest(middle, std::min(p.near[a].distance, p.near[b].distance) + 0.5 * length);
      const Near near{hit.distance, hit.place.face};
      for (int side = 0; side < 2; ++side) {
        Piece& half = halves[2 * i + side] = p;
        half.corner[side ? a : b] = middle;
        half.near[side ? a : b] = near;
        set_upper(half);
        half.upper = std::min(half.upper, p.upper);
      }
    }
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < 3; ++k) found(halves[2 * i].near[k], halves[2 * i].corner[k], halves[2 * i].face);
    pieces.swap(halves);
  }
  for (const Piece& p : pieces) upper = std::max(upper, p.upper);
  upper = std::max(upper, largest);
}

}  // namespace

OneWay distance_from(const Mesh& from, std::span<const int> triangles, const Connectivity& to,
                     const Bvh& to_tree, const OneWayOptions& options, std::span<const double> allowed) {
  const double least = allowed.empty() ? infinity : *std::min_element(allowed.begin(), allowed.end());
  OneSided side(from, triangles, to, to_tree, options.diagonal,
                {allowed, options.allowed_of_from, least, options.most > 0 ? options.most : infinity});
  side.sample(options.samples);
  side.bound(options.budget);
  return std::move(static_cast<OneWay&>(side));
}

Distance distance_between(const Connectivity& reference, const Bvh& reference_tree, const Connectivity& mesh,
                          const Bvh& mesh_tree, int samples, std::span<const double> allowed, double most) {
  const double d = diagonal(reference.mesh), unit = d > 0 ? d : 1;
  // small meshes need no more than this for the mean to be right within a percent
  const long long enough = ((long long)reference.n_tris() + mesh.n_tris()) / 4 + 500;
  const int n = (int)std::min<long long>(samples, enough);
  const double least = allowed.empty() ? infinity : *std::min_element(allowed.begin(), allowed.end());
  OneSided there(mesh.mesh, mesh_tree.order(), reference, reference_tree, d,
                 {allowed, true, least, most * unit}),
      back(reference.mesh, reference_tree.order(), mesh, mesh_tree, d, {allowed, false, least, most * unit});
  for (OneSided* side : {&there, &back}) side->sample(n);
  there.known = back.largest;
  const int budget = (most < infinity ? 64 : 8) * samples;
  there.bound(budget);
  back.known = there.largest;
  back.bound(budget);
  const OneSided& worse = there.largest >= back.largest ? there : back;
  Distance r;
  r.to_reference = there.largest / unit;
  r.to_mesh = back.largest / unit;
  r.hausdorff = worse.largest / unit;
  r.place = worse.place;
  r.bound = std::max(there.upper, back.upper) / unit - r.hausdorff;
  r.mean = std::max(there.mean, back.mean) / unit;
  r.rms = std::max(there.rms, back.rms) / unit;
  if (there.deviation.worst < back.deviation.worst) std::swap(there.deviation, back.deviation);
  r.deviation = std::move(there.deviation);
  r.deviation.allowed.assign(allowed.begin(), allowed.end());
  for (std::size_t t = 0; t < allowed.size(); ++t)
    r.deviation.ratio[t] = std::max(r.deviation.ratio[t], back.deviation.ratio[t]);
  return r;
}

std::vector<double> vertex_distances(const Mesh& mesh, std::span<const int> triangles,
                                     const Connectivity& surface, const Bvh& tree) {
  const std::vector<int> vertices = vertices_of(mesh, triangles);
  std::vector<double> distances(mesh.points.size(), 0);
  const int n = (int)vertices.size();
#pragma omp parallel for schedule(dynamic) if (n > points_at_once)
  for (int first = 0; first < n; first += points_at_once) {
    Seeker seek(tree, surface);
    for (int i = first; i < std::min(n, first + points_at_once); ++i)
      distances[vertices[i]] = seek(mesh.points[vertices[i]]).distance;
  }
  return distances;
}

std::vector<double> triangle_errors(const Mesh& reference, const Bvh& reference_tree, const Mesh& mesh,
                                    const Bvh& mesh_tree) {
  std::vector<double> errors(mesh.tris.size(), 0);
  struct Found {
    int triangle;
    double distance;
  };
  for (const bool back : {false, true}) {
    const Mesh& from = back ? reference : mesh;
    const Bvh &from_tree = back ? reference_tree : mesh_tree, &tree = back ? mesh_tree : reference_tree;
    const auto& order = from_tree.order();
    const int n = (int)order.size(), chunks = (n + points_at_once - 1) / points_at_once;
    constexpr double weights[7][3] = {{1, 0, 0},   {0, 1, 0},   {0, 0, 1},  {1.0 / 3, 1.0 / 3, 1.0 / 3},
                                      {.5, .5, 0}, {0, .5, .5}, {.5, 0, .5}};
    std::vector<std::vector<Found>> found(chunks);
#pragma omp parallel for schedule(dynamic) if (chunks > 1)
    for (int c = 0; c < chunks; ++c) {
      Seeker seek(tree);
      for (int i = c * points_at_once; i < std::min(n, (c + 1) * points_at_once); ++i) {
        const Tri& t = from.tris[order[i]];
        for (const auto& w : weights) {
          const Near near =
              seek(w[0] * from.points[t[0]] + w[1] * from.points[t[1]] + w[2] * from.points[t[2]]);
          if (near.distance > 0) found[c].push_back({back ? near.face : order[i], near.distance});
        }
      }
    }
    for (const auto& part : found)
      for (const Found& f : part) errors[f.triangle] = std::max(errors[f.triangle], f.distance);
  }
  return errors;
}

std::vector<double> refined_size(const Mesh& mesh, const std::vector<double>& size,
                                 const std::vector<double>& errors, double limit) {
  std::vector<double> factor(size.size(), 1);
  for (std::size_t t = 0; t < mesh.tris.size(); ++t) {
    if (errors[t] <= 0.6 * limit) continue;  // well within, since the next mesh is another
    for (int v : mesh.tris[t]) factor[v] = std::min(factor[v], std::max(0.25, 0.6 * limit / errors[t]));
  }
  // the neighbors too, or a dip as narrow as a triangle would be lost in the next mesh
  std::vector<double> refined = size;
  for (const Tri& t : mesh.tris) {
    const double least = std::min({factor[t[0]], factor[t[1]], factor[t[2]]});
    for (int v : t) refined[v] = std::min(refined[v], least * size[v]);
  }
  return refined;
}

double curve_distance(const Mesh& a, const Mesh& b) {
  if (a.tris.empty() && b.tris.empty()) return 0;
  if (a.tris.empty() || b.tris.empty()) return infinity;
  double worst = 0;
  for (bool swapped : {false, true}) {
    const Mesh *from = swapped ? &b : &a, *to = swapped ? &a : &b;
    const Bvh from_tree(*from), tree(*to);
    const int n = (int)from->tris.size();
#pragma omp parallel for schedule(dynamic) reduction(max : worst) if (n > points_at_once)
    for (int first = 0; first < n; first += points_at_once) {
      Seeker seek(tree);
      for (int i = first; i < std::min(n, first + points_at_once); ++i) {
        const Tri& t = from->tris[from_tree.order()[i]];
        for (int k = 0; k <= 8; ++k)
          worst = std::max(worst, seek(lerp(from->points[t[0]], from->points[t[1]], k / 8.0)).distance);
      }
    }
  }
  return worst;
}

}  // namespace meshpipe
