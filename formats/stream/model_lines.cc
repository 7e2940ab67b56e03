// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream/model_lines.h"

#include <algorithm>
#include <optional>

#include "formats/stream/model_edges.h"
#include "lib/core/bvh.h"
#include "lib/core/edges.h"
#include "lib/core/lists.h"

namespace meshpipe {
namespace {

using Bits = std::vector<std::uint8_t>;

bool same_ends(const LineEdge& x, const LineEdge& y) {
  return std::minmax(x.a, x.b) == std::minmax(y.a, y.b);
}
bool by_ends(const LineEdge& x, const LineEdge& y) { return std::minmax(x.a, x.b) < std::minmax(y.a, y.b); }
bool alike(const LineEdge& x, const LineEdge& y) {
  return x.tag == y.tag && x.ridge == y.ridge && x.required == y.required;
}

/// Returns the edge between a and b among sorted ones, or null.
const LineEdge* find_edge(const std::vector<LineEdge>& sorted, int a, int b) {
  const LineEdge wanted{a, b, 0};
  const auto at = std::lower_bound(sorted.begin(), sorted.end(), wanted, by_ends);
  return at != sorted.end() && same_ends(*at, wanted) ? &*at : nullptr;
}

/// Sets the tables line and line_vertex from edges in their given order; a line ends where the next edge does
/// not continue it.
void set_tables(Stream& stream, const std::vector<LineEdge>& edges) {
  std::vector<int> tag, first, count, closed, ridge, required, vertex;
  auto close = [&] {
    count.push_back(static_cast<int>(vertex.size()) - first.back());
    closed.push_back(count.back() > 3 && vertex.back() == vertex[first.back()]);
    if (closed.back()) vertex.pop_back(), --count.back();
  };
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const LineEdge& e = edges[i];
    if (i == 0 || e.a != edges[i - 1].b || !alike(e, edges[i - 1])) {
      if (i) close();
      tag.push_back(e.tag);
      ridge.push_back(e.ridge);
      required.push_back(e.required);
      first.push_back(static_cast<int>(vertex.size()));
      vertex.push_back(e.a);
    }
    vertex.push_back(e.b);
  }
  close();
  Table line{"line", 0, {}}, points{"line_vertex", 0, {}};
  line.set("kind", std::vector<int>(tag.size(), 1));
  line.set("tag", std::move(tag));
  line.set("first", std::move(first));
  line.set("count", std::move(count));
  line.set("closed", std::move(closed));
  if (std::count(ridge.begin(), ridge.end(), 0)) line.set("ridge", std::move(ridge));
  if (std::count(required.begin(), required.end(), 1)) line.set("required", std::move(required));
  points.set("t", std::vector<double>(vertex.size(), 0));
  points.set("vertex_a", vertex);
  points.set("vertex_b", std::move(vertex));
  std::rotate(points.columns.begin(), points.columns.begin() + 1, points.columns.end());
  stream.set(std::move(line));
  stream.set(std::move(points));
  // vertex data of this name would be taken for rows of the table
  Table& vertices = stream.surface.vertex;
  for (Column& column : vertices.columns)
    for (int i = 2; column.name == "line"; ++i)
      if (const std::string name = "line_" + std::to_string(i); !vertices.has(name)) column.name = name;
}

/// Returns a column of ints, or null.
const std::vector<int>* ints(const Table& table, const char* column) {
  const Column* c = table.find(column);
  return c ? std::get_if<std::vector<int>>(&c->data) : nullptr;
}

/// Returns the edges between consecutive vertices of the lines in the tables, in their order.
std::vector<LineEdge> edges_of_tables(const Stream& stream) {
  std::vector<LineEdge> edges;
  const Table *line = stream.find("line"), *points = stream.find("line_vertex");
  if (!line || !points || stream.find("ref_vertex")) return edges;
  const auto *tag = ints(*line, "tag"), *first = ints(*line, "first"), *count = ints(*line, "count"),
             *closed = ints(*line, "closed"), *a = ints(*points, "vertex_a"), *b = ints(*points, "vertex_b"),
             *ridge = ints(*line, "ridge"), *required = ints(*line, "required");
  if (!tag || !first || !count || !closed || !a || !b) return edges;
  const int n = static_cast<int>(points->rows);
  for (std::size_t l = 0; l < line->rows; ++l) {
    const int begin = (*first)[l], length = (*count)[l];
    if (begin < 0 || length < 0 || length > n - begin) continue;
    for (int i = 0; i + 1 < length + ((*closed)[l] != 0); ++i) {
      const int p = begin + i, q = begin + (i + 1) % length;
      if ((*a)[p] == (*b)[p] && (*a)[q] == (*b)[q])
        edges.push_back({(*a)[p], (*a)[q], (*tag)[l], !ridge || (*ridge)[l], required && (*required)[l]});
    }
  }
  return edges;
}

/// Returns the edges on the segments of table model_edge, in its order.
std::vector<LineEdge> edges_of_segments(const Stream& stream) {
  std::vector<LineEdge> edges;
  if (stream.find("ref_vertex")) return edges;
  const Surface& s = stream.surface;
  const ModelSegments segments = read_model_edges(stream);
  const std::vector<int> under = segments_under(s, segments);
  std::vector<std::array<int, 2>> found;  // segment, half-edge
  for (int h = 0; h < static_cast<int>(under.size()); ++h)
    if (under[h] >= 0) found.push_back({under[h], h});
  std::sort(found.begin(), found.end());
  for (const auto& [i, h] : found) {
    LineEdge e{origin(s.tris, h), target(s.tris, h), segments.tag[i], segments.ridge[i] != 0,
               segments.required[i] != 0};
    const Tri& along = segments.tris[i];
    if (dot(segments.points[along[1]] - segments.points[along[0]], s.points[e.b] - s.points[e.a]) < 0)
      std::swap(e.a, e.b);
    edges.push_back(e);
  }
  return edges;
}

/// Sorts edges by their ends and keeps the first of each.
std::vector<LineEdge> sorted_by_ends(std::vector<LineEdge> edges) {
  std::stable_sort(edges.begin(), edges.end(), by_ends);
  edges.erase(std::unique(edges.begin(), edges.end(), same_ends), edges.end());
  return edges;
}

/// Finds the lines of a remeshed surface: an edge is on the line of the file that its ends and its middle are
/// near, else (where vertices are on a smooth surface) on the line that a vertex within it names.
class LinesOfVertices {
 public:
  explicit LinesOfVertices(const Stream& stream) {
    const Table* lines = stream.find("ref_vertex") ? stream.find("line") : nullptr;
    if (!lines) return;
    tag_ = ints(*lines, "tag");
    line_kind_ = ints(*lines, "kind");
    line_ = ints(stream.surface.vertex, "line");
    kind_ = ints(stream.surface.vertex, "kind");
    points_ = &stream.surface.points;
    given_ = read_model_edges(stream);
    for (std::size_t i = 0; i < given_.tag.size(); ++i)
      if (given_.tag[i] != 0)
        of_tag_.push_back({0, 0, given_.tag[i], given_.ridge[i] != 0, given_.required[i] != 0});
    std::stable_sort(of_tag_.begin(), of_tag_.end(), by_tag);
    if (!of_tag_.empty()) search_.emplace(given_);
  }
  explicit operator bool() const { return tag_ != nullptr; }
  /// Sets the label of the line that holds the edge (0 if none does), and the marks of the first edge that
  /// was given with this label.
  void describe(LineEdge& e, bool border) const {
    e.tag = tag_of(e, border);
    const auto at = std::lower_bound(of_tag_.begin(), of_tag_.end(), e, by_tag);
    if (at == of_tag_.end() || at->tag != e.tag) return;
    e.ridge = at->ridge;
    e.required = at->required;
  }

 private:
  static bool by_tag(const LineEdge& x, const LineEdge& y) { return x.tag < y.tag; }
  int tag_of(const LineEdge& e, bool border) const {
    if (!tag_ || !line_kind_ || !line_ || !kind_) return 0;
    if (const int tag = search_ ? tag_near(e.a, e.b) : 0) return tag;
    int line = -1;
    for (int v : {e.a, e.b})
      if ((*kind_)[v] == 1) line = (*line_)[v];
    if (line < 0 || line >= static_cast<int>(tag_->size()) || (*line_kind_)[line] != (border ? 0 : 1))
      return 0;
    return (*tag_)[line];
  }
  int tag_near(int a, int b) const {
    constexpr double on = 0.1, along = 0.25;  // of the edge: how far ends and middle may be from its line
    const Vec3 p = (*points_)[a], q = (*points_)[b];
    const double length = norm(q - p), reach = on * length;
    const Vec3 margin{reach, reach, reach};
    std::vector<int> tags;  // of lines near one end
    search_->overlapping({p - margin, p + margin}, [&](int i) { tags.push_back(given_.tag[i]); });
    sort_unique(tags);
    int tag = 0;
    double least = infinity;
    for (int t : tags) {
      auto distance = [&](Vec3 x) { return search_->nearest_of(given_.tag, t, x, length, 0).distance; };
      const double to_p = distance(p), to_q = distance(q), to_middle = distance(lerp(p, q, 0.5));
      if (t == 0 || std::max(to_p, to_q) > reach || to_middle > along * length) continue;
      if (const double d = to_p + to_q + to_middle; d < least) least = d, tag = t;
    }
    return tag;
  }

  const std::vector<Vec3>* points_ = nullptr;
  ModelSegments given_;             ///< of the file
  std::optional<Bvh> search_;       ///< for `given_`; none if no line has a label
  std::vector<LineEdge> of_tag_{};  ///< of the file, sorted
  const std::vector<int>*tag_ = nullptr, *line_kind_ = nullptr, *line_ = nullptr, *kind_ = nullptr;
};

}  // namespace

void set_model_lines(Stream& stream, const std::vector<LineEdge>& edges) {
  if (edges.empty()) return;
  const std::vector<Tri>& tris = stream.surface.tris;
  if (tris.empty()) return write_model_edges(stream, segments_between(stream.surface.points, edges));
  const std::vector<LineEdge> sorted = sorted_by_ends(edges);
  std::vector<char> found(sorted.size(), 0);
  // edges without a label are in the column only
  const Column* column = stream.surface.face.find("model");
  const Bits* before = column ? std::get_if<Bits>(&column->data) : nullptr;
  Bits model = before ? *before : Bits(tris.size(), 0);
  for (int h = 0; h < 3 * static_cast<int>(tris.size()); ++h)
    if (const LineEdge* e = find_edge(sorted, origin(tris, h), target(tris, h))) {
      model[h / 3] |= static_cast<std::uint8_t>(1 << h % 3);
      found[e - sorted.data()] = 1;
    }
  stream.surface.face.set("model", std::move(model));
  std::vector<LineEdge> kept;
  for (const LineEdge& e : edges)
    if (found[find_edge(sorted, e.a, e.b) - sorted.data()]) kept.push_back(e);
  if (kept.size() < edges.size())
    stream.remarks.push_back("left out: " + std::to_string(edges.size() - kept.size()) +
                             " line elements that are no edge of a triangle");
  if (std::any_of(kept.begin(), kept.end(), [](const LineEdge& e) { return !alike(e, {0, 0, 0}); }))
    set_tables(stream, kept);
}

std::vector<LineEdge> model_lines(const Stream& stream) {
  const Surface& s = stream.surface;
  const Column* column = s.face.find("model");
  const Bits* model = column ? std::get_if<Bits>(&column->data) : nullptr;
  std::vector<LineEdge> in_tables = edges_of_tables(stream);
  const bool segments = in_tables.empty();
  if (segments) in_tables = edges_of_segments(stream);
  const std::vector<LineEdge> known = sorted_by_ends(in_tables);
  const LinesOfVertices lines(stream);
  if (!model && known.empty() && !lines) return {};
  std::vector<char> found(known.size(), 0);
  std::vector<LineEdge> others;
  for_each_edge(s.tris, static_cast<int>(s.points.size()), [&](std::span<const EdgeUse> uses) {
    const int h = half_edge(uses[0]);
    LineEdge e{origin(s.tris, h), target(s.tris, h), 0};
    const bool marked = model && std::any_of(uses.begin(), uses.end(), [&](EdgeUse use) {
                          return (*model)[half_edge(use) / 3] >> half_edge(use) % 3 & 1;
                        });
    if (const LineEdge* k = find_edge(known, e.a, e.b)) {
      found[k - known.data()] = marked || segments || (k->tag != 0 && uses.size() == 1);
      return;
    }
    if (!marked && uses.size() > 1) return;
    lines.describe(e, uses.size() == 1);
    if (marked || e.tag != 0) others.push_back(e);
  });
  std::vector<LineEdge> edges;
  for (const LineEdge& e : in_tables)
    if (char& once = found[find_edge(known, e.a, e.b) - known.data()]) {
      edges.push_back(e);
      once = 0;
    }
  edges.insert(edges.end(), others.begin(), others.end());
  return edges;
}

}  // namespace meshpipe
