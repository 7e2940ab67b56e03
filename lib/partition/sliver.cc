// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <numeric>

#include "lib/core/regions.h"
#include "lib/partition/partition.h"

namespace meshpipe {
namespace {

/// The smallest height of each triangle of the input, from the pieces that it is cut into: its corners are
/// among theirs, so that its longest edge is the largest distance between these.
struct Origins {
  std::vector<int> of;         ///< per triangle of the surface, counted from 0 on
  std::vector<double> height;  ///< per origin
};
Origins origins_of(const Surface& s) {
  const std::vector<int>& of = s.face.get<int>("origin");
  Origins origins{std::vector<int>(of.size()), {}};
  std::vector<int> order(of.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return of[a] < of[b]; });
  std::vector<Vec3> corners;
  for (std::size_t first = 0, end; first < order.size(); first = end) {
    corners.clear();
    double twice = 0, longest = 0;
    for (end = first; end < order.size() && of[order[end]] == of[order[first]]; ++end) {
      origins.of[order[end]] = (int)origins.height.size();
      for (int v : s.tris[order[end]]) corners.push_back(s.points[v]);
      const std::size_t k = corners.size();
      twice += norm(area_vector(corners[k - 3], corners[k - 2], corners[k - 1]));
    }
    // what is farthest from a point of a triangle is a corner of it, so that one of these steps is along its
    // longest edge
    Vec3 at = corners[0];
    for (int step = 0; step < 3; ++step) {
      const Vec3 from = at;
      for (Vec3 p : corners)
        if (norm(p - from) > norm(at - from)) at = p;
      longest = std::max(longest, norm(at - from));
    }
    origins.height.push_back(longest > 0 ? twice / longest : 0);
  }
  return origins;
}

/// Maximal sets of triangles of one part with no model edge between them: region i has the triangles
/// list[first[i]..first[i+1]).
struct Pieces {
  std::vector<int> of, list, first;
  int count() const { return (int)first.size() - 1; }
};
Pieces pieces_between_edges(const Connectivity& mesh, const std::vector<int>& part) {
  Pieces p;
  p.of.assign(part.size(), -1);
  p.first.push_back(0);
  for (int seed = 0; seed < (int)part.size(); ++seed) {
    if (p.of[seed] >= 0) continue;
    p.of[seed] = p.count();
    p.list.push_back(seed);
    for (std::size_t i = p.first.back(); i < p.list.size(); ++i)
      for (int h = 3 * p.list[i]; h < 3 * p.list[i] + 3; ++h) {
        const int o = mesh.opposite[h] / 3;
        if (mesh.opposite[h] < 0 || mesh.is_model(h) || p.of[o] >= 0 || part[o] != part[seed]) continue;
        p.of[o] = p.of[seed];
        p.list.push_back(o);
      }
    p.first.push_back((int)p.list.size());
  }
  return p;
}

/// A region that goes from one part to another.
struct Move {
  int region, from, to;
  double area;
};

class Slivers {
 public:
  Slivers(const CutSurface& cut, int n_parts, int max_faces)
      : s_(cut.surface),
        n_parts_(n_parts),
        max_faces_(max_faces),
        opposite_(cut.opposite),
        model_(s_.face.get<std::uint8_t>("model")),
        origins_(origins_of(s_)),
        part_(s_.face.get<int>("part")) {}

  /// The slivers there are go over, the smallest first, except those next to one that has gone already.
  bool hand_over() {
    pieces_ = pieces_between_edges({s_, opposite_, model_}, part_);
    std::vector<Move> moves = find();
    if (moves.empty()) return false;
    std::sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) {
      return a.area != b.area ? a.area < b.area : a.region < b.region;
    });
    std::vector<char> touched(pieces_.count(), 0);
    std::erase_if(moves, [&](const Move& m) {
      bool near = false;
      each_cut(m.region, [&](int h) { near |= touched[pieces_.of[opposite_[h] / 3]] != 0; });
      if (!near) touched[m.region] = 1;
      return near;
    });
    for (const Move& m : moves) give(m.region, m.to);
    while (!moves.empty()) {
      const std::vector<char> broken = broken_parts({s_, opposite_}, part_, n_parts_, max_faces_);
      if (std::find(broken.begin(), broken.end(), 1) == broken.end()) break;
      // all moves of a broken part are undone; what else broke goes with them
      const std::size_t before = moves.size();
      std::erase_if(moves, [&](const Move& m) {
        const bool at_fault = broken[m.from] || broken[m.to];
        if (at_fault) give(m.region, m.from);
        return at_fault;
      });
      if (moves.size() == before) break;
    }
    return !moves.empty();
  }

 private:
  /// Calls visit(h) for the half-edges of a region towards other parts that are no model edges.
  template <class Visit>
  void each_cut(int region, Visit visit) const {
    for (int i = pieces_.first[region]; i < pieces_.first[region + 1]; ++i)
      for (int h = 3 * pieces_.list[i]; h < 3 * pieces_.list[i] + 3; ++h)
        if (const int o = opposite_[h];
            o >= 0 && !(model_[h / 3] >> h % 3 & 1) && part_[o / 3] != part_[h / 3] && part_[o / 3] >= 0)
          visit(h);
  }

  void give(int region, int to) {
    for (int i = pieces_.first[region]; i < pieces_.first[region + 1]; ++i) part_[pieces_.list[i]] = to;
  }

  /// Twice the area over the perimeter of a region, over the mean height of the input's triangles there.
  double width(int region, double& area) {
    double perimeter = 0, heights = 0;
    int origins = 0;
    area = 0;
    const std::vector<int>& of = origins_.of;
    seen_.resize(origins_.height.size(), -1);
    for (int i = pieces_.first[region]; i < pieces_.first[region + 1]; ++i) {
      const int t = pieces_.list[i];
      const Tri& v = s_.tris[t];
      area += 0.5 * norm(area_vector(s_.points[v[0]], s_.points[v[1]], s_.points[v[2]]));
      for (int h = 3 * t; h < 3 * t + 3; ++h)
        if (opposite_[h] < 0 || pieces_.of[opposite_[h] / 3] != region || model_[t] >> h % 3 & 1)
          perimeter += edge_length(s_, h);
      if (seen_[of[t]] == region) continue;
      seen_[of[t]] = region;
      heights += origins_.height[of[t]];
      ++origins;
    }
    return perimeter > 0 && heights > 0 ? 2 * area / perimeter * origins / heights : 1;
  }

  std::vector<Move> find() {
    constexpr double thin = 0.4;
    std::vector<Move> moves;
    std::vector<std::pair<int, double>> with;  // by the part across: length of the cut
    seen_.clear();
    for (int r = 0; r < pieces_.count(); ++r) {
      const int mine = part_[pieces_.list[pieces_.first[r]]];
      if (mine < 0) continue;
      with.clear();
      each_cut(r, [&](int h) {
        const int theirs = part_[opposite_[h] / 3];
        auto found = std::find_if(with.begin(), with.end(), [&](auto& w) { return w.first == theirs; });
        if (found == with.end()) found = with.insert(found, {theirs, 0.});
        found->second += edge_length(s_, h);
      });
      double area;
      if (with.empty() || width(r, area) >= thin) continue;
      const auto longest =
          std::max_element(with.begin(), with.end(), [](auto& a, auto& b) { return a.second < b.second; });
      moves.push_back({r, mine, longest->first, area});
    }
    return moves;
  }

  Surface& s_;
  const int n_parts_, max_faces_;
  const std::vector<int>& opposite_;
  const std::vector<std::uint8_t>& model_;
  const Origins origins_;
  std::vector<int>& part_;
  Pieces pieces_;
  std::vector<int> seen_;  // scratch: of the input's triangles, the region that has counted it last
};

}  // namespace

bool hand_over_slivers(const CutSurface& cut, int n_parts, int max_faces) {
  const Surface& surface = cut.surface;
  if (!surface.face.has("model") || n_parts < 2) return false;
  const std::vector<std::uint8_t>& model = surface.face.get<std::uint8_t>("model");
  if (std::all_of(model.begin(), model.end(), [](std::uint8_t m) { return m == 0; })) return false;
  constexpr int most_rounds = 4;  // a sliver may lie behind another
  Slivers slivers(cut, n_parts, max_faces);
  bool any = false;
  for (int round = 0; round < most_rounds && slivers.hand_over(); ++round) any = true;
  return any;
}

}  // namespace meshpipe
