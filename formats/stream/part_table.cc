// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream/part_table.h"

#include <algorithm>

namespace meshpipe {

Table part_table(const std::vector<Topology>& parts) {
  Table table{"part", parts.size(), {}};
  auto add = [&]<class T, class M>(const char* name, M member) {
    std::vector<T> column;
    for (const Topology& t : parts) column.push_back(t.*member);
    table.set<T>(name, std::move(column));
  };
  add.template operator()<int>("genus", &Topology::genus);
  add.template operator()<int>("loops", &Topology::loops);
  add.template operator()<int>("faces", &Topology::faces);
  add.template operator()<double>("area", &Topology::area);
  add.template operator()<double>("eta_cyl", &Topology::eta_cyl);
  add.template operator()<double>("eta_box", &Topology::eta_box);
  add.template operator()<double>("eta_geo", &Topology::eta_geo);
  return table;
}

Table part_table(const Surface& surface, int n, const Table* known) {
  std::vector<int> part = surface.face.get<int>("part"), faces(n, 0);
  std::vector<double> area(n, 0);
  for (std::size_t t = 0; t < part.size(); ++t) {
    ++faces[part[t]];
    area[part[t]] += triangle_area(surface, (int)t);
  }
  auto stays = [&](int p) {
    return known && p < (int)known->rows && known->get<int>("faces")[p] == faces[p] &&
           known->get<double>("area")[p] == area[p];
  };
  for (int& p : part)
    if (stays(p)) p = -1;
  Table table = part_table(topology_of_parts(surface, part, n));
  for (Column& c : table.columns)
    std::visit(
        [&]<class T>(std::vector<T>& values) {
          for (int p = 0; p < n; ++p)
            if (stays(p)) values[p] = known->get<T>(c.name)[p];
        },
        c.data);
  return table;
}

}  // namespace meshpipe
