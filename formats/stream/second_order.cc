// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream/second_order.h"

#include <algorithm>

#include "lib/core/error.h"

namespace meshpipe {

void write_mid_points(Stream& stream, const std::vector<MidPoint>& points) {
  std::vector<int> a, b;
  std::vector<double> x, y, z;
  for (const MidPoint& p : points) {
    a.push_back(p.a);
    b.push_back(p.b);
    x.push_back(p.point.x);
    y.push_back(p.point.y);
    z.push_back(p.point.z);
  }
  Table table{"mid_vertex", 0, {}};
  table.set("a", std::move(a));
  table.set("b", std::move(b));
  table.set("x", std::move(x));
  table.set("y", std::move(y));
  table.set("z", std::move(z));
  stream.set(std::move(table));
}

void renumber_mid_points(Stream& stream, const std::vector<int>& number) {
  const Table* table = stream.find("mid_vertex");
  if (!table) return;
  const auto &a = table->get<int>("a"), &b = table->get<int>("b");
  const auto &x = table->get<double>("x"), &y = table->get<double>("y"), &z = table->get<double>("z");
  std::vector<MidPoint> points;
  for (std::size_t i = 0; i < table->rows; ++i) {
    for (int v : {a[i], b[i]})
      if (v < 0 || v >= (int)number.size())
        throw BadInput("mid_vertex " + std::to_string(i) + " has vertex " + std::to_string(v) +
                       ", but there are " + std::to_string(number.size()));
    const auto [low, high] = std::minmax({number[a[i]], number[b[i]]});
    points.push_back({low, high, {x[i], y[i], z[i]}});
  }
  auto edge = [](const MidPoint& p) { return std::pair(p.a, p.b); };
  std::stable_sort(points.begin(), points.end(),
                   [&](const MidPoint& p, const MidPoint& q) { return edge(p) < edge(q); });
  points.erase(std::unique(points.begin(), points.end(),
                           [&](const MidPoint& p, const MidPoint& q) { return edge(p) == edge(q); }),
               points.end());
  write_mid_points(stream, points);
}

SecondOrder::SecondOrder(const Stream& stream) : stream_(stream), table_(stream.find("mid_vertex")) {
  if (!table_) return;
  const auto &a = table_->get<int>("a"), &b = table_->get<int>("b");
  const auto &x = table_->get<double>("x"), &y = table_->get<double>("y"), &z = table_->get<double>("z");
  surface_ = stream.surface;
  for (std::size_t i = 0; i < table_->rows; ++i) {
    edges_.push_back({a[i], b[i]});
    if (a[i] >= b[i] || (i > 0 && edges_[i] <= edges_[i - 1]))
      throw BadInput("mid_vertex " + std::to_string(i) + " has edge " + std::to_string(a[i]) + ", " +
                     std::to_string(b[i]) + ": edges come by a, then b, and a < b");
    surface_.points.push_back({x[i], y[i], z[i]});
  }
  for (const Tri& t : surface_.tris)
    for (int i = 0; i < 3; ++i) node(t[i], t[(i + 1) % 3]);
  surface_.vertex.rows += table_->rows;
  for (Column& column : surface_.vertex.columns)
    std::visit(
        [&]<class T>(std::vector<T>& v) {
          for (std::size_t i = 0; i < table_->rows; ++i)
            v.push_back(std::is_same_v<T, double> ? static_cast<T>((v[a[i]] + v[b[i]]) / 2) : v[a[i]]);
        },
        column.data);
}

int SecondOrder::node(int a, int b) const {
  const std::array<int, 2> edge{std::min(a, b), std::max(a, b)};
  const auto found = std::lower_bound(edges_.begin(), edges_.end(), edge);
  if (found == edges_.end() || *found != edge)
    throw BadInput("mid_vertex has no edge " + std::to_string(edge[0]) + ", " + std::to_string(edge[1]) +
                   ", which a face has");
  return static_cast<int>(stream_.surface.points.size() + (found - edges_.begin()));
}

}  // namespace meshpipe
