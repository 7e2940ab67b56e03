// SPDX-License-Identifier: BSD-3-Clause
#include "lib/lines/lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "lib/core/connectivity.h"
#include "lib/core/error.h"
#include "lib/core/junctions.h"
#include "lib/core/lists.h"
#include "lib/core/number.h"
#include "lib/core/topology.h"
#include "lib/lines/noncrossing.h"
#include "lib/lines/sharp_corners.h"

namespace meshpipe {
namespace {

// What decides about corners and segments, in units of the size h unless said otherwise.
constexpr double border_reach = 2;     // borders of scans are rougher than creases, which mfeature has chosen
constexpr double corner_apart = 0.5;   // on a rough border only the sharpest corner within this counts,
constexpr double sharper = 1.1;        // unless another one turns almost as much (ratio),
constexpr double too_close = 0.15;     // and is farther away than this
constexpr double rough_end = 1;        // nearer to an end of a junction of sheets none counts
constexpr double most_sag = 1.0 / 16;  // of a segment from its model edge, before segments become shorter
constexpr double least_share = 0.8;    // of h, down to which they do
constexpr double cut_off = 0.1;        // of h: a segment that is farther off its chain cuts a bend off
constexpr double in_line = 1e-6;       // radians: border edges that turn by less are pieces of one
constexpr double most_segments = 1e8;  // of all lines: 2.4 GB

/// Where sheets meet: per vertex the first one of the border at its place; empty if none meet.
struct Places {
  std::vector<int> first;
  int operator()(int v) const { return first.empty() ? v : first[v]; }
};

/// An edge that lines run along; right = -1 on the mesh border.
struct SpecialEdge {
  int a, b, kind;
  int left, right;  ///< parts on the left and the right of a -> b
  int tag;          ///< label, 0: none
};

std::vector<SpecialEdge> special_edges(const Connectivity& mesh, const std::vector<int>& part,
                                       const std::vector<int>* tag = nullptr) {
  const std::vector<int>& opposite = mesh.opposite;
  std::vector<SpecialEdge> edges;
  for (int h = 0; h < mesh.n_half_edges(); ++h) {
    const int o = opposite[h];
    if (o >= 0 && o < h) continue;
    const int left = part[h / 3], right = o < 0 ? -1 : part[o / 3];
    const bool model = o >= 0 && (mesh.is_model(h) || mesh.is_model(o));
    if (o >= 0 && left == right && !model) continue;
    const int kind = o < 0 ? border_line : model ? model_line : interface_line;
    edges.push_back(
        {mesh.from(h), mesh.to(h), kind, left, right, tag && kind != interface_line ? (*tag)[h] : 0});
  }
  return edges;
}

/// Chains the edges between joints (vertices where their number is not two, and `corner` ones), then the
/// loops that are left, each from its smallest vertex. A change of label is a joint. Adds their labels to
/// `tag`.
Chains chain_edges(const std::vector<SpecialEdge>& edges, const std::vector<char>& corner,
                   const Places& place, std::vector<int>* tag = nullptr) {
  const int n_vertices = (int)corner.size();
  const Lists stars = lists_of(n_vertices, [&](auto use) {
    for (int i = 0; i < (int)edges.size(); ++i) use(place(edges[i].a), i), use(place(edges[i].b), i);
  });
  auto is_joint = [&](int v) {
    const auto star = stars[v];
    return corner[v] || star.size() != 2 || edges[star[0]].tag != edges[star[1]].tag;
  };

  Chains chains;
  std::vector<char> used(edges.size(), 0);
  auto walk = [&](int v, int e, bool closed) {
    const SpecialEdge& first = edges[e];
    const bool along = place(first.a) == v;
    Chain c{first.kind, (int)chains.vertex.size(),        1,
            closed,     along ? first.left : first.right, along ? first.right : first.left};
    const int origin = v;
    chains.vertex.push_back(along ? first.a : first.b);
    for (;;) {
      used[e] = 1;
      chains.vertex.push_back(place(edges[e].a) == v ? edges[e].b : edges[e].a);
      v = place(chains.vertex.back());
      ++c.count;
      if (closed ? v == origin : is_joint(v)) break;
      e = stars[v][stars[v][0] == e];
    }
    chains.chain.push_back(c);
    if (tag) tag->push_back(first.tag);
  };
  for (bool closed : {false, true})
    for (int v = 0; v < n_vertices; ++v) {
      if (stars[v].empty() || (!closed && !is_joint(v))) continue;
      for (int e : stars[v])
        if (!used[e]) walk(v, e, closed);
    }
  return chains;
}

/// Drops border edges at the same places as an earlier one.
void drop_copies(std::vector<SpecialEdge>& edges, const Places& place) {
  struct Row {
    int a, b, edge;
    auto operator<=>(const Row&) const = default;
  };
  std::vector<Row> rows;
  for (int i = 0; i < (int)edges.size(); ++i)
    if (edges[i].kind == border_line) {
      const int a = place(edges[i].a), b = place(edges[i].b);
      rows.push_back({std::min(a, b), std::max(a, b), i});
    }
  std::sort(rows.begin(), rows.end());
  std::vector<char> copy(edges.size(), 0);
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (rows[i].a == rows[i - 1].a && rows[i].b == rows[i - 1].b) copy[rows[i].edge] = 1;
  std::size_t n = 0;
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (!copy[i]) edges[n++] = edges[i];
  edges.resize(n);
}

/// The border through each vertex: the vertex before and after it, or -1.
struct Border {
  std::vector<int> before, after;
  explicit Border(const Connectivity& mesh) : before(mesh.n_vertices(), -1), after(before) {
    for (int h = 0; h < mesh.n_half_edges(); ++h)
      if (mesh.is_border(h)) after[mesh.from(h)] = mesh.to(h), before[mesh.to(h)] = mesh.from(h);
  }
};

/// Marks places where the sheets do not all go on along one and the same line.
void mark_changes(const Connectivity& mesh, const Places& place, std::vector<char>& corner) {
  const Border border(mesh);
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    if (border.after[v] < 0) continue;
    const int first = place(v);
    const std::array<int, 2> here{place(border.before[v]), place(border.after[v])},
        there{place(border.before[first]), place(border.after[first])};
    if (here[0] == here[1] || (here != there && here != std::array{there[1], there[0]})) corner[first] = 1;
  }
}

/// Replaces chains along borders by one for each sheet there, in the same direction.
void copy_lines(const Connectivity& mesh, const std::vector<int>& part, const Places& place, Chains& chains,
                std::vector<int>& tag) {
  const Border border(mesh);
  const Lists members = lists_of(mesh.n_vertices(), [&](auto use) {
    for (int v = 0; v < mesh.n_vertices(); ++v) use(place(v), v);
  });
  std::vector<int> part_after(mesh.n_vertices(), -1);  // of the border edge that leaves a vertex
  for (int h = 0; h < mesh.n_half_edges(); ++h)
    if (mesh.is_border(h)) part_after[mesh.from(h)] = part[h / 3];

  Chains all;
  std::vector<int> all_tags;
  for (std::size_t l = 0; l < chains.chain.size(); ++l) {
    const Chain& c = chains.chain[l];
    const int leader = (int)all.chain.size();
    auto add = [&](Chain copy) {
      copy.first = (int)all.vertex.size();
      all.chain.push_back(copy);
      all.leader.push_back(leader);
      all_tags.push_back(tag[l]);
    };
    const int* v = &chains.vertex[c.first];
    if (c.kind != border_line) {
      add(c);
      all.vertex.insert(all.vertex.end(), v, v + c.count);
      continue;
    }
    const int from = place(v[0]), to = place(v[1]);
    for (int member : members[from])
      for (bool along : {true, false}) {
        const std::vector<int>& beyond = along ? border.after : border.before;
        int w = member;
        if (beyond[w] < 0 || place(beyond[w]) != to) continue;
        const int p = part_after[along ? w : beyond[w]];
        add({c.kind, 0, c.count, c.closed, along ? p : -1, along ? -1 : p});
        for (int i = 0; i < c.count; ++i, w = beyond[w]) all.vertex.push_back(w);
      }
  }
  chains = std::move(all);
  tag = std::move(all_tags);
}

/// A chain by its arc length.
class Course {
 public:
  Course(const Surface& s, const Chains& chains, const Chain& c)
      : points_(s.points), vertex_(&chains.vertex[c.first]), closed_(c.closed), length_(c.count, 0) {
    for (int i = 1; i < c.count; ++i)
      length_[i] = length_[i - 1] + norm(points_[vertex(i)] - points_[vertex(i - 1)]);
  }
  int vertex(int i) const { return vertex_[i]; }
  double length(int i) const { return length_[i]; }
  /// Returns the angle by which the line turns at its vertex i between its points `reach` before and after,
  /// or its ends; on a closed line at most a twelfth of its length, where a circle turns by 30 degrees.
  double turn(int i, double reach) const {
    const auto [back, ahead] = within(i, reach);
    const Vec3 x = points_[vertex(i)];
    return angle(x - at(length_[i] - back), at(length_[i] + ahead) - x);
  }
  /// Returns one over the radius of the circle that turns as much there.
  double curvature(int i, double reach) const {
    const auto [back, ahead] = within(i, reach);
    return back > 0 && ahead > 0 ? 2 * turn(i, reach) / (back + ahead) : 0;
  }

 private:
  std::array<double, 2> within(int i, double reach) const {
    const double total = length_.back(), most = closed_ ? total / 12 : total;
    return {std::min({reach, most, closed_ ? most : length_[i]}),
            std::min({reach, most, closed_ ? most : total - length_[i]})};
  }
  Vec3 at(double l) const {
    const double total = length_.back();
    if (closed_) l = l < 0 ? l + total : l > total ? l - total : l;
    int i = (int)(std::upper_bound(length_.begin(), length_.end(), l) - length_.begin());
    i = std::clamp(i, 1, (int)length_.size() - 1);
    const double d = length_[i] - length_[i - 1];
    const double t = d > 0 ? std::clamp((l - length_[i - 1]) / d, 0.0, 1.0) : 0;
    return lerp(points_[vertex(i - 1)], points_[vertex(i)], t);
  }

  const std::vector<Vec3>& points_;
  const int* vertex_;
  bool closed_;
  std::vector<double> length_;
};

/// Marks the inner vertices of a chain that turn by more than corner_turn at every scale from its edges up to
/// the size. The zig-zag of a scan's border fades with scale; a circle is straight at the small ones. Next to
/// its ends the larger scales are missing: with `rough_ends` there are no corners there.
void mark_corners(const Surface& s, const std::vector<double>& size, const Chains& chains, const Chain& c,
                  bool rough_ends, std::vector<char>& corner) {
  const Course course(s, chains, c);
  struct Candidate {
    int index;
    double turn;
  };
  std::vector<Candidate> found;
  for (int i = c.closed ? 0 : 1; i < c.count - 1; ++i) {
    const int v = course.vertex(i);
    const Vec3 x = s.points[v];
    double turn =
        angle(x - s.points[course.vertex(i > 0 ? i - 1 : c.count - 2)], s.points[course.vertex(i + 1)] - x);
    const double reach = (c.kind == border_line ? border_reach : 1) * size[v];
    const double to_end = std::min(course.length(i), course.length(c.count - 1) - course.length(i));
    if (rough_ends && !c.closed && to_end < rough_end * size[v]) continue;
    for (double scale : {0.25, 0.5, 1.0})
      if (turn > corner_turn) turn = std::min(turn, course.turn(i, scale * reach));
    if (turn > corner_turn) found.push_back({i, turn});
  }
  // on a rough border the neighbors of a corner turn as well, but less
  const int n = (int)found.size();
  for (int k = 0; k < n; ++k) {
    const double h = size[course.vertex(found[k].index)];
    bool sharpest = true;
    for (int step : {-1, 1}) {
      if (c.kind != border_line) break;
      for (int far = 1; far < n && sharpest; ++far) {
        int j = k + step * far;
        if (!c.closed && (j < 0 || j >= n)) break;
        j = (j + n) % n;
        double apart = std::abs(course.length(found[j].index) - course.length(found[k].index));
        if (c.closed) apart = std::min(apart, course.length(c.count - 1) - apart);
        if (apart > corner_apart * h) break;
        // much closer than h even corners that are equally sharp cannot both be kept
        sharpest = apart > too_close * h
                       ? found[j].turn < sharper * found[k].turn
                       : found[j].turn < found[k].turn || (found[j].turn == found[k].turn && j > k);
      }
    }
    if (sharpest) corner[course.vertex(found[k].index)] = 1;
  }
}

/// Marks ends, junctions and turns of the border and model edges, whatever the parts, and peaks.
std::vector<char> mark_corners(const Surface& s, const std::vector<SpecialEdge>& edges, const Places& place,
                               const std::vector<Peak>& peaks) {
  const auto& size = s.vertex.get<double>("size");
  std::vector<char> corner(s.points.size(), 0);
  std::vector<SpecialEdge> kept;
  for (const SpecialEdge& e : edges)
    if (e.kind != interface_line) kept.push_back(e);
  std::vector<int> degree(s.points.size(), 0), kinds(s.points.size(), 0);
  for (const SpecialEdge& e : kept)
    for (int v : {place(e.a), place(e.b)}) {
      ++degree[v];
      kinds[v] |= 1 << e.kind;
    }
  for (std::size_t v = 0; v < s.points.size(); ++v)
    corner[v] = degree[v] != 0 && (degree[v] != 2 || kinds[v] == (1 << border_line | 1 << model_line));
  const Chains chains = chain_edges(kept, corner, place);
  for (const Chain& c : chains.chain) mark_corners(s, size, chains, c, !place.first.empty(), corner);
  for (const Peak& p : peaks) corner[p.vertex] = 1;
  return corner;
}

/// log(1 + x) / x
double log_over(double x) { return std::abs(x) < 1e-8 ? 1 - 0.5 * x : std::log1p(x) / x; }

/// Returns the sizes along a chain, reduced where a model edge bends so much that its segments would sag, as
/// around a hole of about that size.
std::vector<double> sizes_along(const Surface& s, const std::vector<double>& size, const Chains& chains,
                                const Chain& c) {
  std::vector<double> along(c.count);
  for (int i = 0; i < c.count; ++i) along[i] = size[chains.vertex[c.first + i]];
  if (c.kind != model_line) return along;
  const Course course(s, chains, c);
  for (int i = 0; i < c.count; ++i) {
    const double h = along[i];
    // the sag of a segment of length l is l^2 / 8R
    if (const double bend = h * course.curvature(i, 0.5 * h); bend > 0)
      along[i] = h * std::clamp(std::sqrt(8 * most_sag / bend), least_share, 1.0);
  }
  return along;
}

/// Computes the integral of 1/h along each chain up to each of its vertices, exact for h linear on edges.
void measure_chains(const Surface& s, const std::vector<double>& size, Chains& chains) {
  chains.measure.assign(chains.vertex.size(), 0);
  chains.ratio.assign(chains.vertex.size(), 0);
  for (const Chain& c : chains.chain) {
    const std::vector<double> h = sizes_along(s, size, chains, c);
    for (int i = 1; i < c.count; ++i) {
      const int at = c.first + i;
      const double x = (h[i] - h[i - 1]) / h[i - 1];
      chains.ratio[at - 1] = x;
      chains.measure[at] =
          chains.measure[at - 1] +
          norm(s.points[chains.vertex[at]] - s.points[chains.vertex[at - 1]]) / h[i - 1] * log_over(x);
    }
  }
}

/// Does a segment of the divided line cut a bend off, since the number of segments was rounded down? Only
/// where its sag, which grows with the square of its length, is a tenth larger than that of length h.
bool cuts_off_a_bend(const Surface& s, const std::vector<double>& size, const Chains& chains, const Chain& c,
                     const std::vector<Cut>& cuts) {
  const int n = (int)cuts.size() - 1;
  const double segment = (cuts[n].measure - cuts[0].measure) / n;
  if (c.kind == interface_line || segment * segment <= 1.1) return false;
  const int* v = &chains.vertex[c.first];
  auto point = [&](const Cut& cut) {
    return cut.t > 0 ? lerp(s.points[v[cut.piece]], s.points[v[cut.piece + 1]], cut.t)
                     : s.points[v[cut.piece]];
  };
  for (int k = 0; k < n; ++k) {
    const Vec3 p = point(cuts[k]), chord = point(cuts[k + 1]) - p;
    for (int i = cuts[k].piece + 1; i <= cuts[k + 1].piece; ++i)
      if (norm(cross(chord, s.points[v[i]] - p)) > cut_off * size[v[i]] * norm(chord)) return true;
  }
  return false;
}

/// Returns the number of segments that each line is divided into at first: the rounded integral of 1/h, at
/// least 1, or 3 where a loop ends at its start, or at a copy of that.
std::vector<int> segment_counts(const Surface& s, const Chains& chains, const Places& place) {
  std::vector<int> count;
  std::vector<std::array<int, 3>> single;  // ends and line of those with one segment
  double all = 0;
  auto total = [&](int line) {
    const Chain& c = chains.chain[line];
    return chains.measure[c.first + c.count - 1];
  };
  for (int l = 0; l < (int)chains.chain.size(); ++l) {
    const Chain& c = chains.chain[l];
    const int a = place(chains.vertex[c.first]), b = place(chains.vertex[c.first + c.count - 1]);
    if (!chains.leader.empty() && chains.leader[l] != l) {
      count.push_back(0);  // as its leader
      auto ends = [&](int k) {
        const Chain& x = chains.chain[k];
        return std::minmax(chains.vertex[x.first], chains.vertex[x.first + x.count - 1]);
      };
      // the two sides of a slit, with the same ends, would be one edge if they were single segments
      for (int k = chains.leader[l]; k < l; ++k)
        if (ends(k) == ends(l)) count[chains.leader[l]] = std::max(2, count[chains.leader[l]]);
      continue;
    }
    all += total(l);
    if (!(all <= most_segments))
      throw GoalMissed("the sizes ask for more than " + shown(most_segments) +
                       " segments of lines; ask for larger sizes");
    const int n = (int)std::round(total(l));
    count.push_back(std::max(s.points[a] == s.points[b] ? 3 : 1, n));
    if (count.back() == 1) single.push_back({std::min(a, b), std::max(a, b), l});
  }
  // of several lines between the same two vertices only the shortest may be a single segment
  std::sort(single.begin(), single.end(), [&](const auto& x, const auto& y) {
    const double mx = total(x[2]), my = total(y[2]);
    return std::tie(x[0], x[1], mx, x[2]) < std::tie(y[0], y[1], my, y[2]);
  });
  for (std::size_t i = 1; i < single.size(); ++i)
    if (single[i][0] == single[i - 1][0] && single[i][1] == single[i - 1][1]) count[single[i][2]] = 2;
  return count;
}

/// Marks the border vertices that the surface had before cuts: not those that a cut inserted, whose two
/// border edges are in line and pieces of one triangle (face column `origin`). All of them without that
/// column.
std::vector<char> input_border(const Surface& surface) {
  const std::vector<int> opposite = opposite_halfedges(surface);
  const Connectivity mesh{surface, opposite};
  const std::vector<int>* source = surface.face.has("origin") ? &surface.face.get<int>("origin") : nullptr;
  std::vector<char> found(mesh.n_vertices(), 0);
  std::vector<int> in(mesh.n_vertices(), -1);  // the border half-edge that ends at a vertex
  for (int h = 0; h < mesh.n_half_edges(); ++h)
    if (mesh.is_border(h)) in[mesh.to(h)] = h;
  for (int h = 0; h < mesh.n_half_edges(); ++h) {
    if (!mesh.is_border(h)) continue;
    const int v = mesh.from(h), before = in[v];
    const Vec3 p = mesh.point(v), a = mesh.point(mesh.from(before)), b = mesh.point(mesh.to(h));
    found[v] = !source || (*source)[h / 3] != (*source)[before / 3] || angle(p - a, b - p) > in_line;
  }
  return found;
}

/// Throws NotAdmissible without sizes, BadInput naming a vertex or a face whose size or part is wrong.
void check_columns(const Surface& surface, int n_charts) {
  if (!surface.vertex.has("size")) throw NotAdmissible("the vertices have no size; run msize first");
  const auto& size = surface.vertex.get<double>("size");
  for (std::size_t v = 0; v < size.size(); ++v)
    if (!(size[v] > 0))
      throw BadInput("vertex " + std::to_string(v) + " has size " + shown(size[v]) +
                     ", but sizes are positive");
  refuse_unresolved_sizes(surface, size);
  const auto& part = surface.face.get<int>("part");
  for (std::size_t t = 0; t < part.size(); ++t)
    if (part[t] < 0 || part[t] >= n_charts)
      throw BadInput("face " + std::to_string(t) + " is in part " + std::to_string(part[t]) +
                     ", but there are " + std::to_string(n_charts) + " charts");
}

/// Divides borders at the input's points only.
void keep_input_points(const Surface& surface, const Places& place, const Chains& chains,
                       Division& division) {
  std::vector<char> kept = input_border(surface);
  for (int v = 0; v < (int)kept.size(); ++v) kept[place(v)] |= kept[v];
  for (std::size_t l = 0; l < division.size(); ++l) {
    const Chain& c = chains.chain[l];
    if (c.kind != border_line) continue;
    division[l].clear();
    for (int i = 0; i < c.count; ++i)
      if (i == 0 || i == c.count - 1 || kept[place(chains.vertex[c.first + i])])
        division[l].push_back({i, 0, chains.measure[c.first + i]});
  }
}

/// The lines of divided chains, and the parts that use them.
Lines lines_of(const Chains& chains, const std::vector<int>& tag, const Division& division,
               bool keep_border) {
  Lines lines;
  for (int l = 0; l < (int)division.size(); ++l) {
    const Chain& c = chains.chain[l];
    const int n = (int)division[l].size() - (c.closed ? 1 : 0);
    lines.lines.push_back({c.kind, tag[l], (int)lines.points.size(), n, c.closed ? 1 : 0,
                           keep_border && c.kind == border_line});
    for (int i = 0; i < n; ++i) {
      const Cut& cut = division[l][i];
      const int a = chains.vertex[c.first + cut.piece];
      lines.points.push_back({a, cut.t > 0 ? chains.vertex[c.first + cut.piece + 1] : a, cut.t});
    }
    const int low = std::min(c.left, c.right), high = std::max(c.left, c.right);
    if (low >= 0 && low != high) lines.uses.push_back({l, low});
    lines.uses.push_back({l, high});
  }
  return lines;
}

}  // namespace

std::vector<char> model_corners(const Surface& surface) {
  const std::vector<int> opposite = opposite_halfedges(surface);
  const Connectivity mesh{surface, opposite, model_of(surface)};
  return mark_corners(surface, special_edges(mesh, surface.face.get<int>("part")), {},
                      sharp_peaks(mesh, surface.vertex.get<double>("size")));
}

std::vector<char> line_corners(const Surface& surface, const Lines& lines) {
  std::vector<char> corner = model_corners(surface);
  std::vector<int> tag(surface.points.size(), -1);  // of a line that ends at the vertex
  for (const Line& l : lines.lines)
    for (int i : {l.first, l.first + l.count - 1}) {
      const LinePoint& p = lines.points[i];
      if (l.closed || l.kind == interface_line || p.a != p.b) continue;
      if (tag[p.a] >= 0 && tag[p.a] != l.tag) corner[p.a] = 1;
      tag[p.a] = l.tag;
    }
  if (std::none_of(lines.lines.begin(), lines.lines.end(), [](const Line& l) { return l.kept != 0; }))
    return corner;
  const std::vector<char> kept = input_border(surface);
  for (std::size_t v = 0; v < corner.size(); ++v) corner[v] |= kept[v];
  return corner;
}

Lines make_lines(const Surface& surface, const std::vector<Chart>& charts, const std::vector<int>* tag,
                 bool keep_border, bool sheets_meet) {
  check_columns(surface, (int)charts.size());
  const int n_vertices = (int)surface.points.size();
  const auto& size = surface.vertex.get<double>("size");
  const auto& part = surface.face.get<int>("part");
  const std::vector<int> opposite = opposite_halfedges(surface.tris, n_vertices);
  const Connectivity mesh{surface, opposite, model_of(surface)};
  const Places place{sheets_meet ? first_at_border(mesh) : std::vector<int>()};
  std::vector<SpecialEdge> edges = special_edges(mesh, part, tag);
  if (sheets_meet) drop_copies(edges, place);
  const std::vector<Peak> peaks = sharp_peaks(mesh, size);
  std::vector<char> corners = mark_corners(surface, edges, place, peaks);
  for (int v = 0; v < n_vertices; ++v) corners[place(v)] |= corners[v];
  if (sheets_meet) mark_changes(mesh, place, corners);
  std::vector<int> chain_tag;
  Chains chains = chain_edges(edges, corners, place, &chain_tag);
  if (sheets_meet) copy_lines(mesh, part, place, chains, chain_tag);
  measure_chains(surface, size, chains);
  Division division(chains.chain.size());
  const std::vector<int> count = segment_counts(surface, chains, place);
  for (int l = 0; l < (int)count.size(); ++l) {
    if (count[l] == 0) continue;
    division[l] = divide(chains, l, count[l]);
    if (cuts_off_a_bend(surface, size, chains, chains.chain[l], division[l]))
      division[l] = divide(chains, l, count[l] + 1);
  }
  if (keep_border)
    keep_input_points(surface, place, chains, division);
  else
    divide_at_sharp_corners(mesh, size, chains, division);
  for (std::size_t l = 0; l < chains.leader.size(); ++l) division[l] = division[chains.leader[l]];
  std::vector<char> inside(n_vertices, 0);
  for (const Peak& p : peaks) inside[p.vertex] = 1;
  for (int v : chains.vertex) inside[v] = 0;
  refine_until_noncrossing(chains, surface.points, charts, inside, division);
  return lines_of(chains, chain_tag, division, keep_border);
}

}  // namespace meshpipe
