// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream/shards.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "formats/stream/line_tables.h"
#include "lib/core/connectivity.h"
#include "lib/core/error.h"
#include "lib/core/take_rows.h"
#include "lib/core/topology.h"
#include "lib/mesh2d/mesh2d.h"

namespace meshpipe {
namespace {

/// Returns the row of the shard for each of `size` rows of the whole, or -1.
std::vector<int> inverse(const std::vector<int>& rows, std::size_t size) {
  std::vector<int> local(size, -1);
  for (std::size_t i = 0; i < rows.size(); ++i) local[rows[i]] = static_cast<int>(i);
  return local;
}

/// Numbers the lines that the parts use, and those that stand for the first line point at a vertex.
void number_lines(const Stream& whole, const std::vector<int>& local_part, ShardNumbers& shard) {
  const Lines lines = read_lines(whole);
  const PartLines parts(lines, static_cast<int>(local_part.size()));
  std::vector<int> used;  // lines
  for (const LineUse& u : lines.uses)
    if (local_part[u.part] >= 0) used.push_back(u.line);
  sort_unique(used);
  std::vector<char> here(lines.points.size(), 0);
  std::vector<std::pair<int, int>> first;  // row, and its line or -1
  for (int l : used) {
    const Line& line = lines.lines[l];
    first.push_back({line.first, l});
    std::fill_n(here.begin() + line.first, line.count, 1);
  }
  for (int l : used)
    for (int row = lines.lines[l].first; row < lines.lines[l].first + lines.lines[l].count; ++row)
      if (!std::exchange(here[parts.point[row]], 1)) first.push_back({parts.point[row], -1});
  std::sort(first.begin(), first.end());

  const std::vector<int> vertex = inverse(shard.vertices, whole.surface.points.size());
  std::vector<int> number(lines.lines.size(), -1);
  for (const auto& [row, l] : first) {
    Line line = l < 0 ? Line{interface_line, 0, row, 2, 0} : lines.lines[l];
    // a line that another part uses as well is a border of the parts here
    if (l >= 0 && parts.shared[l] && line.kind == model_line) line.kind = interface_line;
    if (l >= 0) number[l] = static_cast<int>(shard.lines.lines.size());
    line.first = static_cast<int>(shard.lines.points.size());
    for (int i = 0; i < line.count; ++i) {
      shard.line_points.push_back(l < 0 ? row : row + i);
      LinePoint p = lines.points[shard.line_points.back()];
      if (vertex[p.a] < 0 || vertex[p.b] < 0)
        throw BadInput("line_vertex " + std::to_string(shard.line_points.back()) + " is on edge " +
                       std::to_string(p.a) + ", " + std::to_string(p.b) + ", which its parts do not have");
      shard.lines.points.push_back({vertex[p.a], vertex[p.b], p.t});
    }
    shard.lines.lines.push_back(line);
  }
  for (const LineUse& u : lines.uses)
    if (local_part[u.part] >= 0) shard.lines.uses.push_back({number[u.line], local_part[u.part]});
}

const std::vector<int>& part_of_faces(const Stream& whole) {
  // from mlift on, lines and charts index the surface that is kept
  if (whole.find("ref_vertex")) throw NotAdmissible("the stream has passed mlift; use one from before");
  if (!whole.surface.face.has("part")) throw NotAdmissible("no face column 'part'; run mpartition first");
  return whole.surface.face.get<int>("part");
}

}  // namespace

const Table& need_rows(const Stream& stream, const char* name, const char* writer, std::size_t rows) {
  const Table& table = stream.need(name, writer);
  if (table.rows != rows)
    throw BadInput(std::string("table '") + name + "' has " + std::to_string(table.rows) + " rows, not " +
                   std::to_string(rows));
  return table;
}

std::vector<char> kept_vertices(const Stream& stream) {
  const Surface& s = stream.surface;
  const int n = static_cast<int>(s.points.size());
  std::vector<char> keep(n, 0);
  if (is_shard(stream)) {
    for (int v : stream.need("kept_vertex", "mshard").get<int>("vertex")) {
      if (v < 0 || v >= n)
        throw BadInput("kept_vertex names vertex " + std::to_string(v) + ", but there are " +
                       std::to_string(n));
      keep[v] = 1;
    }
    return keep;
  }
  const std::vector<int> opposite = opposite_halfedges(s.tris, n);
  for (const Peak& p : sharp_peaks({s, opposite, model_of(s)}, s.vertex.get<double>("size")))
    keep[p.vertex] = 1;
  return keep;
}

std::vector<std::vector<int>> share_out(const Stream& whole, int count) {
  if (is_shard(whole)) throw NotAdmissible("the stream is a shard itself");
  const std::vector<int>& part = part_of_faces(whole);
  const int n_parts = static_cast<int>(whole.need("part", "mpartition").rows);
  const Surface& s = whole.surface;
  const auto* size = s.vertex.has("size") ? &s.vertex.get<double>("size") : nullptr;
  std::vector<double> work(n_parts, 0), load(std::min(count, n_parts), 0);
  for (std::size_t t = 0; t < part.size(); ++t) {
    if (part[t] < 0)
      throw NotAdmissible("face " + std::to_string(t) + " is in no part; run mpartition first");
    const auto [a, b, c] = s.tris[t];
    const double h = size ? ((*size)[a] + (*size)[b] + (*size)[c]) / 3 : 0;
    const double area = 0.5 * norm(area_vector(s.points[a], s.points[b], s.points[c]));
    work[part[t]] += 1 + (h > 0 ? area / (std::sqrt(3) / 4 * h * h) : 0);
  }
  // the largest part first, to the shard with the least work
  std::vector<int> order(n_parts);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int p, int q) { return std::tie(work[q], p) < std::tie(work[p], q); });
  std::vector<std::vector<int>> shards(load.size());
  for (int p : order) {
    const auto least = std::min_element(load.begin(), load.end());
    *least += work[p];
    shards[least - load.begin()].push_back(p);
  }
  for (std::vector<int>& parts : shards) std::sort(parts.begin(), parts.end());
  return shards;
}

ShardNumbers number_shard(const Stream& whole, std::vector<int> parts) {
  const std::vector<int>& part = part_of_faces(whole);
  const std::vector<int> local = inverse(parts, whole.need("part", "mpartition").rows);
  ShardNumbers shard;
  std::vector<char> used(whole.surface.points.size(), 0);
  for (std::size_t t = 0; t < part.size(); ++t) {
    if (local[part[t]] < 0) continue;
    shard.faces.push_back(static_cast<int>(t));
    for (int v : whole.surface.tris[t]) used[v] = 1;
  }
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v]) shard.vertices.push_back(static_cast<int>(v));
  if (whole.find("line_use")) number_lines(whole, local, shard);
  shard.parts = std::move(parts);
  return shard;
}

Stream cut_shard(const Stream& whole, const ShardNumbers& numbers, const std::vector<char>& kept) {
  Stream shard;
  shard.names = whole.names;
  shard.history = whole.history;
  shard.remarks = whole.remarks;
  shard.input_triangles = whole.input_triangles;
  shard.asked_triangles = whole.asked_triangles;
  shard.unit = whole.unit;
  shard.ascii = whole.ascii;
  const Table& parts = whole.need("part", "mpartition");
  const std::vector<int> vertex = inverse(numbers.vertices, whole.surface.points.size());
  const std::vector<int> part = inverse(numbers.parts, parts.rows);
  Surface& s = shard.surface;
  s.vertex = rows_of(whole.surface.vertex, numbers.vertices);
  s.face = rows_of(whole.surface.face, numbers.faces);
  for (int v : numbers.vertices) s.points.push_back(whole.surface.points[v]);
  for (int t : numbers.faces) {
    const Tri& tri = whole.surface.tris[t];
    s.tris.push_back({vertex[tri[0]], vertex[tri[1]], vertex[tri[2]]});
  }
  for (int& p : s.face.get<int>("part")) p = part[p];
  shard.set(rows_of(parts, numbers.parts));
  if (const Table* charts = whole.find("chart_vertex")) {
    const auto &of = charts->get<int>("part"), &at = charts->get<int>("vertex");
    std::vector<int> rows;
    for (std::size_t r = 0; r < charts->rows; ++r)
      if (part[of[r]] >= 0 && vertex[at[r]] >= 0) rows.push_back(static_cast<int>(r));
    Table table = rows_of(*charts, rows);
    for (int& p : table.get<int>("part")) p = part[p];
    for (int& v : table.get<int>("vertex")) v = vertex[v];
    shard.set(std::move(table));
  }
  if (whole.find("line_use")) write_lines(shard, numbers.lines);
  if (!kept.empty()) {
    std::vector<int> here;
    for (int v : numbers.vertices)
      if (kept[v]) here.push_back(vertex[v]);
    Table table{"kept_vertex", 0, {}};
    table.set("vertex", std::move(here));
    shard.set(std::move(table));
  }
  Table table{"shard", 0, {}};
  table.set("part", numbers.parts);
  shard.set(std::move(table));
  return shard;
}

}  // namespace meshpipe
