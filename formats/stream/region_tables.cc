// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream/region_tables.h"

#include <algorithm>

#include "lib/core/error.h"
#include "lib/core/junctions.h"
#include "lib/core/take_rows.h"

namespace meshpipe {

bool has_sheets(const Stream& stream) { return stream.find("sheet") != nullptr; }

void expect_no_sheets(const Stream& stream, const std::string& why) {
  if (has_sheets(stream))
    throw NotAdmissible("sheets of the surface meet, and " + why +
                        "; run mclean --resolve outer first to keep only what bounds the outside");
}

std::vector<SheetPatch> read_sheets(const Stream& stream) {
  std::vector<SheetPatch> sheets;
  const Table* table = stream.find("sheet");
  if (!table) return sheets;
  const auto &patch = table->get<int>("patch"), &front = table->get<int>("front"),
             &back = table->get<int>("back");
  for (std::size_t i = 0; i < table->rows; ++i) sheets.push_back({patch[i], front[i], back[i]});
  std::sort(sheets.begin(), sheets.end());
  for (std::size_t i = 1; i < sheets.size(); ++i)
    if (sheets[i].patch == sheets[i - 1].patch)
      throw BadInput("table 'sheet' has patch " + std::to_string(sheets[i].patch) + " twice");
  return sheets;
}

void write_regions(Stream& stream, const std::vector<SheetPatch>& sheets, const std::vector<int>& label,
                   const std::vector<double>& volume) {
  std::vector<int> column[3];
  for (const SheetPatch& s : sheets) {
    column[0].push_back(s.patch);
    column[1].push_back(s.front);
    column[2].push_back(s.back);
  }
  Table sheet{"sheet", 0, {}}, region{"region", 0, {}};
  sheet.set("patch", std::move(column[0]));
  sheet.set("front", std::move(column[1]));
  sheet.set("back", std::move(column[2]));
  region.set("label", std::vector<int>(label.begin() + 1, label.end()));
  region.set("volume", std::vector<double>(volume.begin() + 1, volume.end()));
  stream.set(std::move(sheet));
  stream.set(std::move(region));
}

std::vector<std::array<int, 2>> side_labels(const Surface& surface) {
  std::vector<std::array<int, 2>> labels;
  for (const std::string name : {"boundary_labels", "BoundaryLabels"}) {
    const Column *a = surface.face.find(name + ".0"), *b = surface.face.find(name + ".1");
    if (!a || !b) continue;
    const auto value = [](const Column& c, std::size_t t) {
      return std::visit([&](const auto& v) { return (double)v[t]; }, c.data);
    };
    for (std::size_t t = 0; t < surface.tris.size(); ++t) {
      const std::array<double, 2> pair{value(*a, t), value(*b, t)};
      for (double x : pair)
        if (x != (int)x)
          throw BadInput("face " + std::to_string(t) + " has " + name + ' ' + std::to_string(x) +
                         ", but labels are whole numbers");
      labels.push_back({(int)pair[0], (int)pair[1]});
    }
    return labels;
  }
  return labels;
}

Stream with_sheets_joined(const Stream& stream) {
  Stream joined = stream;
  Surface& s = joined.surface;
  const std::vector<SheetPatch> sheets = read_sheets(stream);
  if (s.face.has("patch")) {
    std::vector<int> front, back;
    for (int patch : s.face.get<int>("patch")) {
      const auto row = std::lower_bound(sheets.begin(), sheets.end(), patch,
                                        [](const SheetPatch& r, int p) { return r.patch < p; });
      const bool known = row != sheets.end() && row->patch == patch;
      front.push_back(known ? row->front : 0);
      back.push_back(known ? row->back : 0);
    }
    for (const char* name : {"BoundaryLabels.0", "BoundaryLabels.1"}) s.face.erase(name);
    s.face.set("boundary_labels.0", std::move(front));
    s.face.set("boundary_labels.1", std::move(back));
  }
  const std::vector<int> vertex = join_borders(s);
  take_rows(s.vertex, vertex);
  if (s.vertex.columns.empty()) s.vertex.rows = s.points.size();
  return joined;
}

}  // namespace meshpipe
