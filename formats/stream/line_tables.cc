// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream/line_tables.h"

#include <algorithm>

#include "lib/core/error.h"

namespace meshpipe {
namespace {

[[noreturn]] void bad(const char* table, std::size_t row, const std::string& what) {
  throw BadInput(std::string(table) + ' ' + std::to_string(row) + ' ' + what);
}

/// Reads table `line`, whose rows must tile the n_points points in order.
void read_line_rows(const Table& line, int n_points, Lines& lines) {
  const auto &kind = line.get<int>("kind"), &tag = line.get<int>("tag"), &first = line.get<int>("first"),
             &count = line.get<int>("count"), &closed = line.get<int>("closed");
  const std::vector<int>* kept = line.has("kept") ? &line.get<int>("kept") : nullptr;
  int covered = 0;
  for (std::size_t i = 0; i < line.rows; ++i) {
    if (kind[i] < border_line || kind[i] > interface_line)
      bad("line", i, "has kind " + std::to_string(kind[i]) + ", expected 0 to 2");
    if (closed[i] != 0 && closed[i] != 1)
      bad("line", i, "has closed " + std::to_string(closed[i]) + ", expected 0 or 1");
    if (first[i] != covered)
      bad("line", i, "starts at point " + std::to_string(first[i]) + ", expected " + std::to_string(covered));
    if (count[i] < 2 + closed[i])
      bad("line", i,
          "has " + std::to_string(count[i]) + " points, expected at least " + std::to_string(2 + closed[i]));
    if (count[i] > n_points - covered)
      bad("line", i,
          "has " + std::to_string(count[i]) + " points, but " + std::to_string(n_points - covered) +
              " are left");
    covered += count[i];
    lines.lines.push_back({kind[i], tag[i], first[i], count[i], closed[i], kept ? (*kept)[i] : 0});
  }
  if (covered != n_points)
    throw BadInput("the lines have " + std::to_string(covered) + " points, table 'line_vertex' has " +
                   std::to_string(n_points));
}

void read_line_uses(const Table& use, int n_lines, const Table* parts, Lines& lines) {
  const auto &line = use.get<int>("line"), &part = use.get<int>("part");
  for (std::size_t i = 0; i < use.rows; ++i) {
    if (line[i] < 0 || line[i] >= n_lines)
      bad("line_use", i,
          "has line " + std::to_string(line[i]) + ", but there are " + std::to_string(n_lines));
    if (part[i] < 0 || (parts && part[i] >= static_cast<int>(parts->rows)))
      bad("line_use", i,
          "has part " + std::to_string(part[i]) + ", but there are " +
              std::to_string(parts ? parts->rows : 0));
    lines.uses.push_back({line[i], part[i]});
  }
}

void read_line_points(const Table& point, int n_vertices, Lines& lines) {
  const auto &a = point.get<int>("vertex_a"), &b = point.get<int>("vertex_b");
  const auto& t = point.get<double>("t");
  lines.points.reserve(point.rows);
  for (std::size_t i = 0; i < point.rows; ++i) {
    for (int v : {a[i], b[i]})
      if (v < 0 || v >= n_vertices)
        bad("line_vertex", i,
            "is on vertex " + std::to_string(v) + ", but there are " + std::to_string(n_vertices));
    if (!(t[i] >= 0 && t[i] <= 1))
      bad("line_vertex", i, "has t = " + std::to_string(t[i]) + ", expected 0 to 1");
    lines.points.push_back({a[i], b[i], t[i]});
  }
}

}  // namespace

std::vector<Chart> read_charts(const Stream& stream) {
  const Table& rows = stream.need("chart_vertex", "mparam");
  return make_charts(stream.surface, rows, static_cast<int>(stream.need("part", "mparam").rows));
}

void write_charts(Stream& stream, const std::vector<Chart>& charts) {
  std::vector<int> part, vertex;
  std::vector<double> u, v;
  for (std::size_t p = 0; p < charts.size(); ++p)
    for (std::size_t i = 0; i < charts[p].uv.size(); ++i) {
      part.push_back(static_cast<int>(p));
      vertex.push_back(charts[p].mesh.vertex[i]);
      u.push_back(charts[p].uv[i].x);
      v.push_back(charts[p].uv[i].y);
    }
  Table table{"chart_vertex", 0, {}};
  table.set("part", std::move(part));
  table.set("vertex", std::move(vertex));
  table.set("u", std::move(u));
  table.set("v", std::move(v));
  stream.set(std::move(table));
}

Lines read_lines(const Stream& stream) {
  const Table& line = stream.need("line", "mlines");
  const Table& use = stream.need("line_use", "mlines");
  const Table& point = stream.need("line_vertex", "mlines");
  Lines lines;
  read_line_rows(line, static_cast<int>(point.rows), lines);
  read_line_uses(use, static_cast<int>(line.rows), stream.find("part"), lines);
  const Table* reference = stream.find("ref_vertex");
  read_line_points(point, static_cast<int>(reference ? reference->rows : stream.surface.points.size()),
                   lines);
  return lines;
}

void write_lines(Stream& stream, const Lines& lines) {
  std::vector<int> column[5];
  for (const Line& l : lines.lines) {
    const int row[] = {l.kind, l.tag, l.first, l.count, l.closed};
    for (int i = 0; i < 5; ++i) column[i].push_back(row[i]);
  }
  Table line{"line", 0, {}};
  const char* names[] = {"kind", "tag", "first", "count", "closed"};
  for (int i = 0; i < 5; ++i) line.set(names[i], std::move(column[i]));
  std::vector<int> kept;
  for (const Line& l : lines.lines) kept.push_back(l.kept);
  if (std::count(kept.begin(), kept.end(), 1)) line.set("kept", std::move(kept));
  stream.set(std::move(line));

  std::vector<int> use_line, use_part;
  for (const LineUse& u : lines.uses) {
    use_line.push_back(u.line);
    use_part.push_back(u.part);
  }
  Table use{"line_use", 0, {}};
  use.set("line", std::move(use_line));
  use.set("part", std::move(use_part));
  stream.set(std::move(use));

  std::vector<int> a, b;
  std::vector<double> t;
  for (const LinePoint& p : lines.points) {
    a.push_back(p.a);
    b.push_back(p.b);
    t.push_back(p.t);
  }
  Table point{"line_vertex", 0, {}};
  point.set("vertex_a", std::move(a));
  point.set("vertex_b", std::move(b));
  point.set("t", std::move(t));
  stream.set(std::move(point));
}

}  // namespace meshpipe
