// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream/part_table.h"

#include <algorithm>

namespace meshpipe {

namespace {
/// Calls visit(name, member) for the columns of the table.
template <class Visit>
void for_each_column(Visit visit) {
  visit("genus", &Topology::genus);
  visit("loops", &Topology::loops);
  visit("faces", &Topology::faces);
  visit("area", &Topology::area);
  visit("eta_cyl", &Topology::eta_cyl);
  visit("eta_box", &Topology::eta_box);
  visit("eta_geo", &Topology::eta_geo);
}
}  // namespace

Table part_table(const std::vector<Topology>& parts) {
  Table table{"part", parts.size(), {}};
  for_each_column([&]<class T>(const char* name, T Topology::*member) {
    std::vector<T> column;
    for (const Topology& t : parts) column.push_back(t.*member);
    table.set<T>(name, std::move(column));
  });
  return table;
}

std::vector<Topology> known_parts(const Surface& surface, int n, const Table* known) {
  std::vector<Topology> parts(n), measured(n);
  const std::vector<int>& part = surface.face.get<int>("part");
  for (std::size_t t = 0; t < part.size(); ++t) {
    ++measured[part[t]].faces;
    measured[part[t]].area += triangle_area(surface, (int)t);
  }
  bool complete = known;
  for_each_column([&](const char* name, auto) { complete = complete && known->has(name); });
  for (int p = 0; complete && p < std::min(n, (int)known->rows); ++p) {
    Topology row;
    row.components = 1;
    for_each_column(
        [&]<class T>(const char* name, T Topology::*member) { row.*member = known->get<T>(name)[p]; });
    if (row.faces == measured[p].faces && row.area == measured[p].area) parts[p] = row;
  }
  return parts;
}

Table part_table(const Surface& surface, int n, const Table* known) {
  std::vector<Topology> parts = known_parts(surface, n, known);
  std::vector<int> part = surface.face.get<int>("part");
  for (int& p : part)
    if (parts[p].faces > 0) p = -1;
  const std::vector<Topology> measured = topology_of_parts(surface, part, n);
  for (int p = 0; p < n; ++p)
    if (parts[p].faces == 0) parts[p] = measured[p];
  return part_table(parts);
}

}  // namespace meshpipe
