// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream/region_tables.h"

#include <algorithm>

#include "formats/stream/second_order.h"
#include "lib/core/error.h"
#include "lib/core/junctions.h"
#include "lib/core/take_rows.h"

namespace meshpipe {

bool has_sheets(const Stream& stream) { return stream.find("sheet") != nullptr; }

void expect_no_sheets(const Stream& stream, const std::string& why) {
  if (!has_sheets(stream)) return;
  Mesh joined = stream.surface;
  if (join_borders(joined).size() < stream.surface.points.size())
    throw NotAdmissible("sheets of the surface meet, and " + why +
                        "; run mclean --resolve outer first to keep only what bounds the outside, or mwrap");
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

Table sheet_table(const std::vector<SheetPatch>& sheets) {
  std::vector<int> column[3];
  for (const SheetPatch& s : sheets) {
    column[0].push_back(s.patch);
    column[1].push_back(s.front);
    column[2].push_back(s.back);
  }
  Table table{"sheet", 0, {}};
  table.set("patch", std::move(column[0]));
  table.set("front", std::move(column[1]));
  table.set("back", std::move(column[2]));
  return table;
}

void write_regions(Stream& stream, const std::vector<SheetPatch>& sheets, const std::vector<int>& label,
                   const std::vector<double>& volume) {
  Table region{"region", 0, {}};
  region.set("label", std::vector<int>(label.begin() + 1, label.end()));
  region.set("volume", std::vector<double>(volume.begin() + 1, volume.end()));
  stream.set(sheet_table(sheets));
  stream.set(std::move(region));
}

void update_volumes(Stream& stream) {
  if (!stream.find("region")) return;
  Table table = *stream.find("region");
  const auto& label = table.get<int>("label");
  auto& volume = table.get<double>("volume");
  const std::vector<RegionMeasure> measured = measure_regions(stream.surface, read_sheets(stream));
  std::vector<double> before(measured.size(), 0);
  for (std::size_t i = 0; i < label.size(); ++i)
    if (const int r = row_of(measured, label[i]); r >= 0) before[r] += volume[i];
  for (std::size_t i = 0; i < label.size(); ++i)
    if (const int r = row_of(measured, label[i]); r >= 0 && before[r] != 0)
      volume[i] *= measured[r].volume / before[r];
  stream.set(std::move(table));
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
      const SheetPatch* sheet = find_sheet(sheets, patch);
      front.push_back(sheet ? sheet->front : 0);
      back.push_back(sheet ? sheet->back : 0);
    }
    for (const char* name : {"BoundaryLabels.0", "BoundaryLabels.1"}) s.face.erase(name);
    s.face.set("boundary_labels.0", std::move(front));
    s.face.set("boundary_labels.1", std::move(back));
  }
  const std::vector<int> vertex = join_borders(s);
  std::vector<int> number(stream.surface.points.size(), 0);
  for (std::size_t t = 0; t < s.tris.size(); ++t)
    for (int i : {0, 1, 2}) number[stream.surface.tris[t][i]] = s.tris[t][i];
  renumber_mid_points(joined, number);
  take_rows(s.vertex, vertex);
  if (s.vertex.columns.empty()) s.vertex.rows = s.points.size();
  return joined;
}

RegionSeeds region_seeds(const Surface& surface) {
  const Solids solids = find_solids(surface);
  const std::vector<std::array<int, 2>> labels = side_labels(surface);
  const std::vector<Vec3> points = points_within(surface, solids);
  RegionSeeds seeds{{points.begin() + 1, points.end()}, std::vector<int>(solids.count(), 0)};
  for (std::size_t t = labels.size(); t-- > 0;)
    for (int i : {0, 1})
      if (solids.sides[t][i] > 0) seeds.label[solids.sides[t][i] - 1] = labels[t][i];
  return seeds;
}

static void drop_unused_vertices(Surface& s) {
  std::vector<int> number(s.points.size(), -1), used;
  for (const Tri& t : s.tris)
    for (int v : t) number[v] = 0;
  for (int v = 0; v < (int)number.size(); ++v)
    if (number[v] == 0) {
      number[v] = (int)used.size();
      s.points[used.size()] = s.points[v];
      used.push_back(v);
    }
  s.points.resize(used.size());
  take_rows(s.vertex, used);
  for (Tri& t : s.tris)
    for (int& v : t) v = number[v];
}

Stream region_boundaries(const Stream& stream, const std::vector<int>& labels) {
  if (!has_sheets(stream)) throw NotAdmissible("no section 'sheet'; run mclean --sheets keep first");
  Stream out = with_sheets_joined(stream);
  const std::vector<std::array<int, 2>> sides = side_labels(out.surface);
  std::vector<int> wanted = labels;
  if (wanted.empty())
    for (const auto& [front, back] : sides) wanted.insert(wanted.end(), {front, back});
  sort_unique(wanted);
  out.tables.clear();
  out.names.clear();
  const std::vector<Tri> tris = std::move(out.surface.tris);
  out.surface.tris.clear();
  std::vector<int> patch;
  for (int label : wanted) {
    if (labels.empty() && label <= 0) continue;
    const std::size_t before = patch.size();
    for (std::size_t t = 0; t < sides.size(); ++t) {
      if (sides[t][0] == sides[t][1] || (sides[t][0] != label && sides[t][1] != label)) continue;
      Tri tri = tris[t];
      if (sides[t][0] == label) std::swap(tri[1], tri[2]);
      out.surface.tris.push_back(tri);
      patch.push_back(label);
    }
    if (patch.size() == before) throw NotAdmissible("no region has label " + std::to_string(label));
    out.names.push_back({2, label, "region-" + std::to_string(label)});
  }
  out.surface.face = Table{"face", patch.size(), {}};
  out.surface.face.set("patch", std::move(patch));
  drop_unused_vertices(out.surface);
  return out;
}

}  // namespace meshpipe
