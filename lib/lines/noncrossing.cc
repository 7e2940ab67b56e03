// SPDX-License-Identifier: BSD-3-Clause
#include "lib/lines/noncrossing.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "lib/core/error.h"
#include "lib/core/number.h"
#include "lib/core/parallel.h"
#include "lib/core/segments.h"

namespace meshpipe {
namespace {

/// (exp(x) - 1) / x
double exp_over(double x) { return std::abs(x) < 1e-8 ? 1 + 0.5 * x : std::expm1(x) / x; }

Cut at_vertex(const Chains& chains, const Chain& c, int piece) {
  return {piece, 0, chains.measure[c.first + piece]};
}

constexpr double on_vertex = 1e-9;  // of an edge: points nearer to its end are put on the vertex

/// Returns the point at a measure: h is linear along the edge, so the position is exponential in the measure.
Cut at_measure(const Chains& chains, const Chain& c, double m) {
  const double* begin = &chains.measure[c.first];
  const int last = c.count - 1;
  int i = (int)(std::upper_bound(begin, begin + c.count, m) - begin) - 1;
  i = std::clamp(i, 0, last - 1);
  const double x = chains.ratio[c.first + i], whole = begin[i + 1] - begin[i];
  // m grows with log(1 + x t) / x; both ends of the edge are met exactly
  const double share = whole > 0 ? (m - begin[i]) / whole : 0, log_end = std::log1p(x);
  const double t = share * exp_over(share * log_end) / exp_over(log_end);
  if (t < on_vertex) return at_vertex(chains, c, i);
  if (t > 1 - on_vertex) return at_vertex(chains, c, i + 1);
  return {i, t, m};
}

/// The last vertex of the chain before this cut (or on the cut before, if there is none between).
int last_inner(const Cut& to) { return to.t > 0 ? to.piece : to.piece - 1; }
int count_inner(const Cut& from, const Cut& to) { return last_inner(to) - from.piece; }

// Limits of the drawing that segments may make instead of their chains.
constexpr double most_between = 0.3;  // area between a segment and its chain, over the segment's square:
                                      // three chords of a circle, the fewest, have 0.2
constexpr double least_area = 0.3;  // of a loop's segments, over that of its chains; the same three have 0.41
constexpr double most_step = 3;     // between the measures of neighboring segments of a refined line
constexpr double tiny_measure = 1e-6;  // of a line's mean segment: shorter ones bound no neighbors
constexpr int patience = 40;           // rounds of halving before a line is cut at all its vertices

/// A chain drawn in a chart. side: +1 the chart is on its left, -1 on its right, 0 on both.
struct Drawn {
  int line, side;
  const Vec2* uv;  ///< of the chain's vertices
};

/// Segment `index` of a line.
struct SegmentOf {
  int line, index;
  auto operator<=>(const SegmentOf&) const = default;
};

/// The drawing of one part, segment by segment, all its border with the part on the left.
struct ChartLines {
  std::vector<Segment> segments;
  std::vector<SegmentOf> source;
  std::vector<int> drawn;   ///< per segment: which chain of the part
  std::vector<int> weight;  ///< 1 on the part's border, 0 on lines inside
};

/// What is wrong in one part: segments to refine, and `meeting` lines where none of them can be.
struct Finding {
  std::vector<SegmentOf> refine;
  std::vector<int> meeting;
};

class Refinement {
 public:
  Refinement(const Chains& chains, const std::vector<Vec3>& points, const std::vector<Chart>& charts,
             const std::vector<char>& inside, Division& division)
      : chains_(chains), points_(points), division_(division), drawn_(charts.size()), inside_(charts.size()) {
    locate_chains(charts);
    for (std::size_t p = 0; p < charts.size(); ++p)
      for (std::size_t i = 0; i < charts[p].uv.size(); ++i)
        if (inside[charts[p].mesh.vertex[i]]) inside_[p].push_back(charts[p].uv[i]);
  }

  void run();

 private:
  void locate_chains(const std::vector<Chart>& charts);
  ChartLines draw(int part, const std::vector<int>& first_key) const;
  Finding examine(int part, const std::vector<int>& first_key) const;
  void examine_nesting(int part, const ChartLines& d, const SegmentTree& tree, Finding& finding) const;
  std::vector<int> loops_of(const ChartLines& d) const;
  template <class Edge>
  void for_piece(int part, const ChartLines& d, int segment, const Edge& edge) const;
  bool refinable(const SegmentOf& s) const {
    const auto& cuts = division_[s.line];
    return count_inner(cuts[s.index], cuts[s.index + 1]) > 0;
  }
  int leader_of(int line) const { return chains_.leader.empty() ? line : chains_.leader[line]; }
  double deviation(int part, const ChartLines& d, int segment) const;
  void insert(int line, const std::vector<int>& segments);
  void keep_graded(int line);

  const Chains& chains_;
  const std::vector<Vec3>& points_;
  Division& division_;
  std::vector<Vec2> uv_;
  std::vector<std::vector<Drawn>> drawn_;  ///< per part
  std::vector<std::vector<Vec2>> inside_;  ///< the same, points that its border has inside
};

void Refinement::locate_chains(const std::vector<Chart>& charts) {
  std::size_t total = 0;
  for (int l = 0; l < (int)chains_.chain.size(); ++l) {
    const Chain& c = chains_.chain[l];
    for (int p : {c.left, c.right}) {
      if (p < 0 || (p == c.right && p == c.left && !drawn_[p].empty() && drawn_[p].back().line == l))
        continue;
      drawn_[p].push_back({l, c.left == c.right ? 0 : p == c.left ? 1 : -1, nullptr});
      total += c.count;
    }
  }
  uv_.reserve(total);  // Drawn points into it
  std::vector<int> local(points_.size(), -1);
  for (int p = 0; p < (int)charts.size(); ++p) {
    const auto& vertex = charts[p].mesh.vertex;
    for (int i = 0; i < (int)vertex.size(); ++i) local[vertex[i]] = i;
    for (Drawn& d : drawn_[p]) {
      const Chain& c = chains_.chain[d.line];
      d.uv = uv_.data() + uv_.size();
      for (int i = 0; i < c.count; ++i) uv_.push_back(charts[p].uv[local[chains_.vertex[c.first + i]]]);
    }
  }
}

ChartLines Refinement::draw(int part, const std::vector<int>& first_key) const {
  ChartLines d;
  for (int i = 0; i < (int)drawn_[part].size(); ++i) {
    const Drawn& use = drawn_[part][i];
    const Chain& c = chains_.chain[use.line];
    const auto& cuts = division_[use.line];
    auto point = [&](int k) {
      const Cut& cut = cuts[k];
      return cut.t > 0 ? lerp(use.uv[cut.piece], use.uv[cut.piece + 1], cut.t) : use.uv[cut.piece];
    };
    auto key = [&](int k) {
      return cuts[k].t > 0 ? first_key[use.line] + k : chains_.vertex[c.first + cuts[k].piece];
    };
    for (int k = 0; k + 1 < (int)cuts.size(); ++k) {
      Segment s{point(k), point(k + 1), key(k), key(k + 1)};
      if (use.side < 0) s = {s.q, s.p, s.to, s.from};
      d.segments.push_back(s);
      d.source.push_back({use.line, k});
      d.drawn.push_back(i);
      d.weight.push_back(use.side != 0);
    }
  }
  return d;
}

/// Calls edge(a, b) along the piece of the chain that a segment stands for, in the segment's direction.
template <class Edge>
void Refinement::for_piece(int part, const ChartLines& d, int segment, const Edge& edge) const {
  const Drawn& use = drawn_[part][d.drawn[segment]];
  const auto& cuts = division_[use.line];
  const int k = d.source[segment].index;
  const Segment& s = d.segments[segment];
  const int first = cuts[k].piece + 1, last = last_inner(cuts[k + 1]);
  Vec2 at = s.p;
  for (int i = 0; i <= last - first; ++i) {
    const Vec2 to = use.uv[use.side < 0 ? last - i : first + i];
    edge(at, to);
    at = to;
  }
  edge(at, s.q);
}

/// Returns how far the chain strays from the segment.
double Refinement::deviation(int part, const ChartLines& d, int segment) const {
  const Segment& s = d.segments[segment];
  double most = 0;
  for_piece(part, d, segment, [&](Vec2, Vec2 x) {
    most = std::max(most, norm(x - lerp(s.p, s.q, nearest_fraction(x, s.p, s.q))));
  });
  return most;
}

Finding Refinement::examine(int part, const std::vector<int>& first_key) const {
  Finding finding;
  const ChartLines d = draw(part, first_key);
  const SegmentTree tree(d.segments);
  const auto pairs = tree.crossings();
  for (const auto& pair : pairs) {
    // refine what strays from its chain, not the straight line that it runs into
    double stray[2] = {-1, -1};
    for (int i : {0, 1})
      if (refinable(d.source[pair[i]])) stray[i] = deviation(part, d, pair[i]);
    for (int i : {0, 1}) {
      if (stray[i] >= 0 && 2 * stray[i] >= stray[1 - i]) finding.refine.push_back(d.source[pair[i]]);
      if (std::max(stray[0], stray[1]) < 0) finding.meeting.push_back(d.source[pair[i]].line);
    }
  }
  // the signed area, so that zig-zag cancels
  for (int i = 0; i < (int)d.segments.size(); ++i) {
    if (!refinable(d.source[i])) continue;
    const Segment& s = d.segments[i];
    double between = 0;
    for_piece(part, d, i, [&](Vec2 a, Vec2 b) { between += 0.5 * cross(a - s.p, b - s.p); });
    if (std::abs(between) > most_between * dot(s.q - s.p, s.q - s.p)) finding.refine.push_back(d.source[i]);
  }
  if (pairs.empty()) examine_nesting(part, d, tree, finding);
  return finding;
}

/// Numbers the border loops: per segment its loop, -1 on lines inside.
std::vector<int> Refinement::loops_of(const ChartLines& d) const {
  const int n = (int)d.segments.size();
  std::vector<int> by_from;
  for (int i = 0; i < n; ++i)
    if (d.weight[i]) by_from.push_back(i);
  auto from = [&](int i) { return d.segments[i].from; };
  std::sort(by_from.begin(), by_from.end(), [&](int i, int j) { return from(i) < from(j); });
  std::vector<int> loop(n, -1);
  int loops = 0;
  for (int start = 0; start < n; ++start) {
    if (!d.weight[start] || loop[start] >= 0) continue;
    for (int i = start; loop[i] < 0;) {
      loop[i] = loops;
      const int key = d.segments[i].to;
      auto found = std::partition_point(by_from.begin(), by_from.end(), [&](int j) { return from(j) < key; });
      if (found == by_from.end() || from(*found) != key) break;
      i = *found;
    }
    ++loops;
  }
  return loop;
}

/// Finds what is wrong where no two segments meet: border loops of reversed orientation, with too little
/// area, or inside another one that did not hold them, and inner lines and points outside the border.
void Refinement::examine_nesting(int part, const ChartLines& d, const SegmentTree& tree,
                                 Finding& finding) const {
  const int n = (int)d.segments.size();
  const std::vector<int> loop = loops_of(d);
  const int loops = n == 0 ? 0 : *std::max_element(loop.begin(), loop.end()) + 1;
  std::vector<int> first(loops, -1);
  std::vector<double> area(loops, 0), chain_area(loops, 0);
  for (int i = 0; i < n; ++i) {
    const int l = loop[i];
    if (l < 0) continue;
    if (first[l] < 0) first[l] = i;
    const Vec2 o = d.segments[first[l]].p;
    area[l] += cross(d.segments[i].p - o, d.segments[i].q - o);
    for_piece(part, d, i, [&](Vec2 a, Vec2 b) { chain_area[l] += cross(a - o, b - o); });
  }
  auto ask = [&](int i) {
    if (refinable(d.source[i])) finding.refine.push_back(d.source[i]);
  };
  for (int i = 0; i < n; ++i)
    if (loop[i] >= 0 && !(area[loop[i]] / chain_area[loop[i]] > least_area)) ask(i);

  // a point on the wrong side of the border: a segment and its chain have it between them
  auto between = [&](int i, Vec2 x) {
    int turns = -ray_crossing(x, d.segments[i].p, d.segments[i].q);
    for_piece(part, d, i, [&](Vec2 a, Vec2 b) { turns += ray_crossing(x, a, b); });
    return turns != 0;
  };
  auto expect = [&](Vec2 x, const std::vector<int>& weight, int turns) {
    if (tree.winding(x, weight) == turns) return true;
    for (int i = 0; i < n; ++i)
      if (weight[i] && between(i, x)) ask(i);
    return false;
  };
  std::vector<int> weight = d.weight;
  for (int l = 0; l < loops; ++l) {
    for (int i = 0; i < n; ++i)
      if (loop[i] == l) weight[i] = 0;
    expect(d.segments[first[l]].p, weight, chain_area[l] > 0 ? 0 : 1);
    for (int i = 0; i < n; ++i)
      if (loop[i] == l) weight[i] = 1;
  }
  for (int i = 0; i < n; ++i)
    if (loop[i] < 0 && d.source[i].index == 0 &&
        !expect(lerp(d.segments[i].p, d.segments[i].q, 0.5), d.weight, 1))
      ask(i);
  for (const Vec2& x : inside_[part]) expect(x, d.weight, 1);
}

/// Halves segments of a line in measure; one with a single inner vertex is cut there, so that refinement
/// ends.
void Refinement::insert(int line, const std::vector<int>& segments) {
  const Chain& c = chains_.chain[line];
  auto& cuts = division_[line];
  std::vector<Cut> out;
  std::size_t next = 0;
  for (int k = 0; k < (int)cuts.size(); ++k) {
    out.push_back(cuts[k]);
    if (next == segments.size() || segments[next] != k) continue;
    ++next;
    const Cut &from = cuts[k], &to = cuts[k + 1];
    const int inner = count_inner(from, to);
    Cut cut = inner == 1 ? at_vertex(chains_, c, from.piece + 1)
                         : at_measure(chains_, c, 0.5 * (from.measure + to.measure));
    auto before = [](const Cut& a, const Cut& b) { return std::tie(a.piece, a.t) < std::tie(b.piece, b.t); };
    if (!before(from, cut) || !before(cut, to)) {  // edges of no length
      if (inner == 0) continue;
      cut = at_vertex(chains_, c, from.piece + (inner + 1) / 2);
    }
    out.push_back(cut);
  }
  cuts = std::move(out);
}

void Refinement::keep_graded(int line) {
  const bool closed = chains_.chain[line].closed;
  for (;;) {
    const auto& cuts = division_[line];
    const int n = (int)cuts.size() - 1;
    auto measure = [&](int k) { return cuts[k + 1].measure - cuts[k].measure; };
    const double tiny = tiny_measure * cuts.back().measure / n;
    std::vector<int> large;
    for (int k = 0; k < n; ++k) {
      const int before = k > 0 ? k - 1 : closed ? n - 1 : k, after = k + 1 < n ? k + 1 : closed ? 0 : k;
      if (measure(k) > most_step * std::max(tiny, std::min(measure(before), measure(after))))
        large.push_back(k);
    }
    if (large.empty()) return;
    insert(line, large);
    if ((int)division_[line].size() == n + 1) return;
  }
}

void Refinement::run() {
  const int n_parts = (int)drawn_.size(), n_lines = (int)division_.size();
  std::vector<char> dirty(n_parts, 1), bare(n_lines, 0);
  for (int round = 0;; ++round) {
    std::vector<int> first_key(n_lines);
    int key = (int)points_.size();
    for (int l = 0; l < n_lines; ++l) {
      first_key[l] = key;
      key += (int)division_[l].size();
    }
    std::vector<Finding> findings(n_parts);
    parallel_for(n_parts, [&](int p) {
      if (dirty[p]) findings[p] = examine(p, first_key);
    });

    std::vector<SegmentOf> refine;
    std::vector<int> strip;  // lines to be cut at their vertices only
    for (int p = 0; p < n_parts; ++p) {
      const Finding& f = findings[p];
      refine.insert(refine.end(), f.refine.begin(), f.refine.end());
      bool hopeless = !f.meeting.empty();
      for (int l : f.meeting)
        if (!bare[l]) {
          strip.push_back(l);
          hopeless = false;
        }
      if (hopeless)
        throw GoalMissed("lines " + std::to_string(f.meeting[0]) + " and " + std::to_string(f.meeting[1]) +
                         " meet in the map of part " + std::to_string(p) + ", the first begins at (" +
                         shown(points_[chains_.vertex[chains_.chain[f.meeting[0]].first]]) + ")");
    }
    if (round >= patience)
      for (const SegmentOf& s : refine)
        if (!bare[s.line]) strip.push_back(s.line);
    if (refine.empty() && strip.empty()) return;
    if (!chains_.leader.empty()) {
      for (SegmentOf& r : refine) r.line = chains_.leader[r.line];
      for (int& l : strip) l = chains_.leader[l];
    }
    sort_unique(refine);

    std::fill(dirty.begin(), dirty.end(), 0);
    auto touch = [&](int line) {
      for (int l = line; l < n_lines && (l == line || leader_of(l) == line); ++l) {
        division_[l] = division_[line];
        bare[l] = bare[line];
        for (int p : {chains_.chain[l].left, chains_.chain[l].right})
          if (p >= 0) dirty[p] = 1;
      }
    };
    for (int l : strip) {
      const Chain& c = chains_.chain[l];
      division_[l].clear();
      for (int i = 0; i < c.count; ++i) division_[l].push_back(at_vertex(chains_, c, i));
      bare[l] = 1;
      touch(l);
    }
    std::vector<int> segments;
    for (std::size_t i = 0; i < refine.size();) {
      const int l = refine[i].line;
      segments.clear();
      for (; i < refine.size() && refine[i].line == l; ++i) segments.push_back(refine[i].index);
      if (bare[l]) continue;
      insert(l, segments);
      keep_graded(l);
      touch(l);
    }
  }
}

}  // namespace

std::vector<Cut> divide(const Chains& chains, int line, int n) {
  const Chain& c = chains.chain[line];
  const double total = chains.measure[c.first + c.count - 1];
  std::vector<Cut> cuts{at_vertex(chains, c, 0)};
  for (int i = 1; i < n; ++i) cuts.push_back(at_measure(chains, c, total * i / n));
  cuts.push_back(at_vertex(chains, c, c.count - 1));
  return cuts;
}

void refine_until_noncrossing(const Chains& chains, const std::vector<Vec3>& points,
                              const std::vector<Chart>& charts, const std::vector<char>& inside,
                              Division& division) {
  Refinement(chains, points, charts, inside, division).run();
}

}  // namespace meshpipe
