// SPDX-License-Identifier: BSD-3-Clause
#include "lib/feature.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "lib/error.h"
#include "lib/size.h"
#include "lib/topology.h"

namespace meshpipe {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double corner_turn = 50 * degree;    ///< a chain that turns by more ends there
constexpr double continue_turn = 45 * degree;  ///< along weak edges it turns by less
constexpr double step = 60 * degree;  ///< a border that bends by more stays a crease when patches merge
constexpr double smooth_turn = 20 * degree;  ///< mean change of the turning vector from vertex to vertex
constexpr double design_share = 0.5;         ///< of the strong edges, by length, in good chains
constexpr double gap = 0.05;     ///< of the strong edges, by length: weaker ones that leave a gap between
constexpr double room = 1.5;     ///< target lengths between creases, on average
constexpr double sliver = 0.02;  ///< target lengths: no mesh shows which way a strip faces that is as thin

/// The network of crease edges while it is chosen. Flags and angles are kept on both half-edges of an edge.
class Creases {
 public:
  Creases(const Surface& surface, const FeatureOptions& options, const std::vector<int>* before,
          const std::vector<char>* given)
      : s_(surface), opposite_(opposite_halfedges(surface.tris, (int)surface.points.size())) {
    const int n = (int)opposite_.size();
    size_ = options.size > 0 ? options.size : size_for_count(total_area(s_), (double)s_.tris.size());
    const std::vector<Vec3> normal = sound_normals(s_, opposite_, sliver * size_);
    for (std::size_t t = 0; t < s_.tris.size(); ++t) {
      const Tri& v = s_.tris[t];
      const Vec3 own = area_vector(s_.points[v[0]], s_.points[v[1]], s_.points[v[2]]);
      slivers_ += angle(own, normal[t]) > continue_turn;
    }
    angle_.assign(n, 0);
    on_.assign(n, 0);
    patch_.assign(n, 0);
    given_.assign(n, 0);
    merged_.assign(n, 0);
    star_.assign(s_.points.size(), -1);
    valence_.assign(s_.points.size(), 0);
    anchor_.assign(s_.points.size(), 0);
    const std::vector<int>* patch = s_.face.has("patch") ? &s_.face.get<int>("patch") : nullptr;
    double sum = 0;
    for (int h = 0; h < n; ++h) {
      const int o = opposite_[h], v = from(h);
      if (star_[v] < 0 || o < 0) star_[v] = h;
      sum += length(h);
      if (o >= 0) angle_[h] = angle(normal[h / 3], normal[o / 3]);
      const bool border = o >= 0 && patch && (*patch)[h / 3] != (*patch)[o / 3];
      const bool merged = o >= 0 && !border && before && (*before)[h / 3] != (*before)[o / 3];
      given_[h] = o >= 0 && !merged && given && (*given)[h];
      patch_[h] = border || given_[h];
      merged_[h] = merged && options.mode == FeatureOptions::automatic && angle_[h] <= step;
      if (o < 0 || patch_[h] || merged_[h]) anchor_[v] = anchor_[to(h)] = 1;
    }
    // what looks designed is a matter of the input's own edges, what is worth keeping of the target's; a
    // coarse model of few triangles has no longer chains than a tenth of itself
    const double mean = n ? sum / n : 0, most = 0.1 * diagonal(s_);
    telling_ = std::min(5 * mean, most);
    short_ = std::min(3 * (options.size > 0 ? options.size : mean), most);
  }

  void choose(double strong, double weak) {
    for (int h = 0; h < (int)opposite_.size(); ++h)
      if (opposite_[h] > h && !patch_[h] && !merged_[h] && angle_[h] > strong) set(h, 1);
    strong_ = on_;
    const int n = (int)s_.points.size();
    std::vector<int> ends;
    for (int v = 0; v < n; ++v)
      if (free_end(v)) ends.push_back(v);
    for (int v : ends) follow(v, weak);
  }

  /// Drops chains with a free end that are shorter than `least`.
  void prune(double least) {
    std::vector<int> ends;
    for (int v = 0; v < (int)s_.points.size(); ++v)
      if (free_end(v)) ends.push_back(v);
    std::vector<int> chain;
    while (!ends.empty()) {
      const int v = ends.back();
      ends.pop_back();
      if (!free_end(v)) continue;
      chain.clear();
      double along = 0;
      int h = leaving(v, -1);
      for (;;) {
        chain.push_back(h);
        along += length(h);
        if (valence_[to(h)] != 2 || anchor_[to(h)]) break;
        h = leaving(to(h), opposite_[h]);
      }
      if (along >= least) continue;
      for (int g : chain) set(g, 0);
      if (free_end(to(h))) ends.push_back(to(h));
    }
  }

  /// Takes no crease on components that do not look designed. Two things tell: at least half of the strong
  /// edges are in long smooth chains; or there is next to nothing between smooth and sharp, where noise has
  /// every angle, and the creases leave room for triangles, which the steps of a segmented image do not.
  void keep_designed(double sharp, double weak) {
    std::vector<int> component;
    const int n = components(opposite_, component);
    std::vector<double> strong(n, 0), good(n, 0), between(n, 0), area(n, 0);
    for (int t = 0; t < (int)s_.tris.size(); ++t) {
      const Tri& v = s_.tris[t];
      area[component[t]] += 0.5 * norm(area_vector(s_.points[v[0]], s_.points[v[1]], s_.points[v[2]]));
    }
    for (int h = 0; h < (int)opposite_.size(); ++h)
      if (opposite_[h] > h && angle_[h] > weak && angle_[h] <= sharp) between[component[h / 3]] += length(h);
    for (int h = 0; h < (int)opposite_.size(); ++h)
      if (opposite_[h] > h && (strong_[h] || (patch_[h] && angle_[h] > sharp))) {
        strong[component[h / 3]] += length(h);
        if (patch_[h]) good[component[h / 3]] += length(h);
      }
    for (const std::vector<int>& chain : chains()) {
      double along = 0, counted = 0;
      for (int h : chain) {
        along += length(h);
        if (strong_[h]) counted += length(h);
      }
      if (along > telling_ && roughness(chain) < smooth_turn) good[component[chain[0] / 3]] += counted;
    }
    std::vector<char> designed(n);
    for (int c = 0; c < n; ++c)
      designed[c] = good[c] >= design_share * strong[c] ||
                    (between[c] < gap * strong[c] && area[c] > room * size_ * strong[c]);
    for (int h = 0; h < (int)opposite_.size(); ++h)
      if (on_[h] && !designed[component[h / 3]]) set(h, 0);
  }

  /// Drops connected pieces of the network that are short in all and hang on nothing.
  void drop_small_pieces() {
    std::vector<char> seen(s_.points.size(), 0);
    std::vector<int> piece;
    for (int seed = 0; seed < (int)s_.points.size(); ++seed) {
      if (seen[seed] || !valence_[seed]) continue;
      piece.assign(1, seed);
      seen[seed] = 1;
      double twice = 0;
      bool held = false;
      for (std::size_t i = 0; i < piece.size(); ++i) {
        held = held || anchor_[piece[i]];
        around(piece[i], [&](int h) {
          if (!on_[h]) return;
          twice += length(h);
          if (!seen[to(h)]) piece.push_back(to(h));
          seen[to(h)] = 1;
        });
      }
      if (held || twice >= 2 * short_) continue;
      for (int v : piece)
        around(v, [&](int h) {
          if (on_[h]) set(h, 0);
        });
    }
  }

  FeatureReport mark(std::vector<std::uint8_t>& model) const {
    FeatureReport r;
    r.slivers = slivers_;
    std::vector<int> lines(s_.points.size(), 0);
    for (int h = 0; h < (int)opposite_.size(); ++h) {
      if (!on_[h] && !patch_[h]) continue;
      model[h / 3] |= 1 << h % 3;
      if (opposite_[h] < h) continue;
      (given_[h] ? r.given_edges : patch_[h] ? r.patch_edges : r.crease_edges) += 1;
      ++lines[from(h)];
      ++lines[to(h)];
    }
    r.model_edges = r.patch_edges + r.given_edges + r.crease_edges;
    for (int v = 0; v < (int)s_.points.size(); ++v) {
      if (!lines[v]) continue;
      bool corner = lines[v] != 2;
      if (!corner) {
        int two[2], k = 0;
        around(v, [&](int h) {
          if (on_[h] || patch_[h]) two[k++] = h;
        });
        corner = turn(opposite_[two[0]], two[1]) > corner_turn;
      }
      r.corners += corner;
    }
    return r;
  }

  double shortest() const { return short_; }

 private:
  int from(int h) const { return origin(s_.tris, h); }
  int to(int h) const { return target(s_.tris, h); }
  Vec3 along(int h) const { return s_.points[to(h)] - s_.points[from(h)]; }
  double length(int h) const { return norm(along(h)); }
  double turn(int in, int out) const { return angle(along(in), along(out)); }
  bool free_end(int v) const { return valence_[v] == 1 && !anchor_[v]; }

  void set(int h, char on) {
    on_[h] = on_[opposite_[h]] = on;
    valence_[from(h)] += on ? 1 : -1;
    valence_[to(h)] += on ? 1 : -1;
  }

  /// Calls visit(h) for the half-edges that leave v, but for those on the border.
  template <class Visit>
  void around(int v, Visit visit) const {
    int h = star_[v];
    do {
      const int after = opposite_[prev(h)];
      if (opposite_[h] >= 0) visit(h);
      h = after;
    } while (h >= 0 && h != star_[v]);
  }

  /// The first crease half-edge that leaves v, other than `except`; -1 if none.
  int leaving(int v, int except) const {
    int found = -1;
    around(v, [&](int h) {
      if (found < 0 && on_[h] && h != except) found = h;
    });
    return found;
  }

  /// Goes on from the free end v along weak edges, as straight as they allow, until it meets the network.
  void follow(int v, double weak) {
    if (!free_end(v)) return;
    for (int in = opposite_[leaving(v, -1)];;) {
      int best = -1;
      double least = continue_turn;
      around(v, [&](int h) {
        if (on_[h] || patch_[h] || merged_[h] || angle_[h] <= weak) return;
        if (double a = turn(in, h); a < least) {
          least = a;
          best = h;
        }
      });
      if (best < 0) return;
      v = to(best);
      const bool met = valence_[v] > 0 || anchor_[v];
      set(best, 1);
      if (met) return;
      in = best;
    }
  }

  /// The chains between corners and junctions, then the closed ones without any.
  std::vector<std::vector<int>> chains() const {
    std::vector<std::vector<int>> all;
    std::vector<char> seen(on_.size(), 0);
    auto passes = [&](int in) {  // the half-edge after `in`; -1 at the end of the chain
      const int v = to(in);
      if (valence_[v] != 2 || anchor_[v]) return -1;
      const int out = leaving(v, opposite_[in]);
      return turn(in, out) > corner_turn ? -1 : out;
    };
    for (bool closed : {false, true})
      for (int h = 0; h < (int)on_.size(); ++h) {
        if (!on_[h] || seen[h] || (!closed && passes(opposite_[h]) >= 0)) continue;
        std::vector<int>& chain = all.emplace_back();
        for (int g = h; g >= 0 && !seen[g]; g = passes(g)) {
          seen[g] = seen[opposite_[g]] = 1;
          chain.push_back(g);
        }
      }
    return all;
  }

  /// Mean change of the turning vector (the angle times the axis) from vertex to vertex: 0 on straight lines
  /// and circles however coarse, twice the angle on a zigzag.
  double roughness(const std::vector<int>& chain) const {
    double sum = 0;
    Vec3 last;
    for (std::size_t i = 1; i < chain.size(); ++i) {
      const Vec3 axis =
          turn(chain[i - 1], chain[i]) * normalized(cross(along(chain[i - 1]), along(chain[i])));
      if (i > 1) sum += norm(axis - last);
      last = axis;
    }
    return chain.size() > 2 ? sum / (double)(chain.size() - 2) : 0;
  }

  const Surface& s_;
  std::vector<int> opposite_;
  std::vector<double> angle_;      ///< between the normals on either side
  std::vector<char> on_, strong_;  ///< chosen; chosen by its angle alone
  std::vector<char> patch_;        ///< between two patches, or given
  std::vector<char> given_;        ///< by the caller
  std::vector<char> merged_;       ///< between two patches that have become one
  std::vector<int> star_;          ///< a half-edge that leaves the vertex, on the border the border's
  std::vector<int> valence_;       ///< of the network of creases
  std::vector<char> anchor_;  ///< on a patch border, former ones too, or the surface's: chains may end there
  double short_ = 0;          ///< pieces below this length are dropped
  double size_ = 0;           ///< target edge length
  int slivers_ = 0;           ///< triangles whose own normal tells nothing
  double telling_ = 0;        ///< chains above this length tell whether the surface is designed
};

}  // namespace

std::vector<Vec3> sound_normals(const Mesh& mesh, const std::vector<int>& opposite, double thin) {
  constexpr double slender = 0.05;
  const double rounding = 3e-6 * diagonal(mesh);
  const int n = (int)mesh.tris.size();
  std::vector<Vec3> normal(n);
  std::vector<int> heir(n, -1), second(n, -1);
  for (int t = 0; t < n; ++t) {
    const Tri& c = mesh.tris[t];
    const Vec3 a = area_vector(mesh.points[c[0]], mesh.points[c[1]], mesh.points[c[2]]);
    int longest = 3 * t, other = 3 * t + 1;
    double length = 0, shorter = 0;
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      const double l = norm(mesh.points[target(mesh.tris, h)] - mesh.points[origin(mesh.tris, h)]);
      if (l > length) {
        other = longest, longest = h;
        shorter = length, length = l;
      } else if (l > shorter) {
        other = h, shorter = l;
      }
    }
    normal[t] = normalized(a);
    const double least = std::max(rounding, std::min(thin, slender * length));
    if (norm(a) >= least * length) continue;
    heir[t] = opposite[longest] >= 0 ? opposite[longest] / 3 : -1;
    second[t] = opposite[other] >= 0 ? opposite[other] / 3 : -1;
  }
  // the two halves of a thin strip go with its two sides
  if (thin > 0) {
    const std::vector<int> first = heir;
    for (int t = 0; t < n; ++t)
      if (first[t] >= 0 && first[first[t]] == t) heir[t] = second[t];
  }
  for (int t = 0; t < n; ++t) {
    int u = t;
    for (int steps = 0; heir[u] >= 0 && steps < 16; ++steps) u = heir[u];
    normal[t] = normal[u];
  }
  return normal;
}

FeatureReport mark_features(Surface& surface, const FeatureOptions& options, const std::vector<int>* before,
                            const std::vector<char>* given) {
  Creases creases(surface, options, before, given);
  if (options.mode != FeatureOptions::none) {
    creases.choose(options.strong * degree, options.weak * degree);
    if (options.mode == FeatureOptions::automatic) {
      creases.prune(std::numeric_limits<double>::infinity());
      creases.keep_designed(options.strong * degree, options.weak * degree);
      creases.drop_small_pieces();
    } else {
      creases.prune(creases.shortest());
    }
  }
  std::vector<std::uint8_t> model(surface.tris.size(), 0);
  const FeatureReport report = creases.mark(model);
  surface.face.set("model", std::move(model));
  return report;
}

}  // namespace meshpipe
