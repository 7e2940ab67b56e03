// SPDX-License-Identifier: BSD-3-Clause
// mparam: a one-to-one map of every part to the plane.
#include <algorithm>

#include "lib/param.h"
#include "lib/topology.h"
#include "tools/common.h"

using namespace meshpipe;

namespace {

const char* name_of(MapKind kind) {
  return kind == MapKind::conformal ? "conformal" : kind == MapKind::harmonic ? "harmonic" : "convex";
}

Table chart_table(const std::vector<Chart>& charts) {
  std::vector<int> part, vertex;
  std::vector<double> u, v;
  for (std::size_t p = 0; p < charts.size(); ++p)
    for (std::size_t i = 0; i < charts[p].uv.size(); ++i) {
      part.push_back((int)p);
      vertex.push_back(charts[p].mesh.vertex[i]);
      u.push_back(charts[p].uv[i].x);
      v.push_back(charts[p].uv[i].y);
    }
  Table table{"chart_vertex", 0, {}};
  table.set("part", std::move(part));
  table.set("vertex", std::move(vertex));
  table.set("u", std::move(u));
  table.set("v", std::move(v));
  return table;
}

void add_columns(Table& parts, const std::vector<ParamReport>& reports) {
  auto add = [&]<class T>(const char* name, auto value) {
    std::vector<T> column;
    for (const ParamReport& r : reports) column.push_back((T)value(r));
    parts.set<T>(name, std::move(column));
  };
  add.template operator()<int>("map", [](auto& r) { return r.used; });
  add.template operator()<int>("flips_before", [](auto& r) { return r.flips_before; });
  add.template operator()<double>("anisotropy_median", [](auto& r) { return r.anisotropy_median; });
  add.template operator()<double>("anisotropy_p99", [](auto& r) { return r.anisotropy_p99; });
  add.template operator()<double>("anisotropy_max", [](auto& r) { return r.anisotropy_max; });
  add.template operator()<double>("area_scale", [](auto& r) { return r.area_scale; });
  add.template operator()<double>("smallest_area", [](auto& r) { return r.smallest_area; });
}

}  // namespace

int main(int argc, char** argv) {
  std::string map = "conformal";
  bool strict = false;
  auto add_options = [&](CLI::App& app) {
    app.add_option("--map", map, "conformal (default), convex or harmonic (not built yet)")
        ->check(CLI::IsMember({"conformal", "convex", "harmonic"}))
        ->type_name("NAME");
    app.add_flag("--strict", strict, "no repair, no other map, no cut: fail (5) if a map is not one-to-one");
  };
  auto body = [&](Io& io) {
    if (map == "harmonic") throw BadUsage("--map harmonic is not built yet");
    MapKind kind = map == "convex" ? MapKind::convex : MapKind::conformal;
    Stream stream = io.read();
    Surface& surface = stream.surface;
    if (!surface.face.has("part")) throw NotAdmissible("no face column 'part'; run mpartition first");
    const auto& part = surface.face.get<int>("part");
    int n_before = part.empty() ? 0 : *std::max_element(part.begin(), part.end()) + 1;

    std::vector<ParamReport> reports;
    std::vector<Chart> charts = map_surface(surface, n_before, kind, strict, reports);
    int n_parts = (int)charts.size();
    const Table* known = stream.find("part");
    Table parts = known && n_parts == n_before ? *known : part_table(surface, n_parts);
    add_columns(parts, reports);
    stream.set(std::move(parts));
    stream.set(chart_table(charts));

    double median = 1, p99 = 1, smallest = 1;
    int other = 0;
    io.report["parts"] = n_parts;
    io.report["cut"] = n_parts - n_before;
    io.report["charts"] = nlohmann::ordered_json::array();
    for (int p = 0; p < n_parts; ++p) {
      const ParamReport& r = reports[p];
      char text[300];
      std::snprintf(text, sizeof text,
                    "part %d: %zu triangles, %s map, sigma1/sigma2 median %.3f, p99 %.3f, max %.3g, "
                    "area scale %.3g, smallest area %.2e%s",
                    p, charts[p].mesh.tris.size(), name_of(r.used), r.anisotropy_median, r.anisotropy_p99,
                    r.anisotropy_max, r.area_scale, r.smallest_area,
                    r.border_was_simple ? "" : ", border crossed itself before");
      io.detail(std::string(text) +
                (r.flips_before ? ", " + std::to_string(r.flips_before) + " flips before" : ""));
      io.report["charts"].push_back({{"part", p},
                                     {"triangles", charts[p].mesh.tris.size()},
                                     {"map", name_of(r.used)},
                                     {"flips_before", r.flips_before},
                                     {"border_was_simple", r.border_was_simple},
                                     {"anisotropy_median", r.anisotropy_median},
                                     {"anisotropy_p99", r.anisotropy_p99},
                                     {"anisotropy_max", r.anisotropy_max},
                                     {"area_scale", r.area_scale},
                                     {"smallest_area", r.smallest_area}});
      median = std::max(median, r.anisotropy_median);
      p99 = std::max(p99, r.anisotropy_p99);
      smallest = std::min(smallest, r.smallest_area);
      other += r.used != kind;
    }
    char text[300];
    std::snprintf(
        text, sizeof text,
        "%d charts, %d cut here, %d on another map than %s; worst sigma1/sigma2 median %.3f, p99 %.3f, "
        "smallest area %.2e",
        n_parts, n_parts - n_before, other, map.c_str(), median, p99, smallest);
    io.say(text);
    io.write(stream);
  };
  return run_tool(
      argc, argv, "mparam",
      "Map every part to the plane, one-to-one: conformal, or convex where that fails.\n\n"
      "example:\n  mclean tree.stl | mtopo | mfeature | mpartition | mmultiscale | mparam -o charts.ply",
      add_options, body);
}
