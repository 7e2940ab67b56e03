// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/page_item.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <span>

#include "formats/stream/line_tables.h"
#include "lib/core/bvh.h"
#include "lib/draw/draw.h"
#include "tools/report/png.h"
#include "tools/report/verdict.h"

namespace meshpipe {
namespace {

constexpr int worst_count = 10;
constexpr int picture_width = 720, picture_height = 540;  ///< pixels
/// Mesh lines of more triangles than this would fill the still picture.
constexpr std::size_t most_drawn_lines = 20000;

double smallest_angle(const Mesh& mesh, int t) {
  const Tri& v = mesh.tris[t];
  double least = std::numbers::pi;
  for (int i = 0; i < 3; ++i) {
    const Vec3 a = mesh.points[v[(i + 1) % 3]] - mesh.points[v[i]],
               b = mesh.points[v[(i + 2) % 3]] - mesh.points[v[i]];
    least = std::min(least, std::atan2(norm(cross(a, b)), dot(a, b)));
  }
  return least * 180 / std::numbers::pi;
}

double mean_edge(const Mesh& mesh, int t) {
  double sum = 0;
  for (int i = 0; i < 3; ++i) sum += edge_length(mesh, 3 * t + i);
  return sum / 3;
}

double kappa_of(const Mesh& mesh, int t) {
  const Tri& v = mesh.tris[t];
  return kappa(mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]]);
}

/// Numbers labels from 0, in increasing order, with the name of each.
LabelColumn labels_of(const std::string& name, const std::vector<int>& values,
                      const std::function<std::string(int)>& name_of) {
  std::vector<int> known(values);
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  LabelColumn column{name, {}, {}};
  for (int x : values)
    column.values.push_back((int)(std::lower_bound(known.begin(), known.end(), x) - known.begin()));
  for (int x : known) column.names.push_back(name_of(x));
  return column;
}

/// The columns that every mesh has: shape and size, and its labels.
MeshColumns columns_of(const Surface& surface, const std::function<std::string(int)>& patch_name) {
  const int n = (int)surface.tris.size();
  FigureColumn kappas{"kappa", {}}, angles{"smallest angle", {}, 0, 60}, sizes{"size", {}, HUGE_VAL, 0, true};
  for (int t = 0; t < n; ++t) {
    kappas.values.push_back(kappa_of(surface, t));
    angles.values.push_back(smallest_angle(surface, t));
    const double size = mean_edge(surface, t);
    sizes.values.push_back(size);
    if (size > 0) sizes.low = std::min(sizes.low, size);
    sizes.high = std::max(sizes.high, size);
  }
  MeshColumns columns{{std::move(kappas), std::move(angles)}, {}};
  if (sizes.high > 0) {
    for (double& x : sizes.values) x = std::max(x, sizes.low);
    columns.figures.push_back(std::move(sizes));
  }
  auto number = [](int label) { return std::to_string(label); };
  if (surface.face.has("patch"))
    columns.labels.push_back(labels_of("patch", surface.face.get<int>("patch"), patch_name));
  if (surface.face.has("part"))
    columns.labels.push_back(labels_of("part", surface.face.get<int>("part"), number));
  return columns;
}

/// Lays the charts of a surface in rows, the highest first, each as large as its part. Triangles keep their
/// numbers; those of no chart have no area.
Mesh flat_charts(const Surface& surface, const std::vector<Chart>& charts) {
  struct Sheet {
    Vec2 low, size;
    double scale = 1;
  };
  std::vector<Sheet> sheets;
  double area = 0;
  for (const Chart& c : charts) {
    Vec2 low = c.uv.at(0), high = low;
    double plane = 0;
    for (Vec2 p : c.uv)
      low = {std::min(low.x, p.x), std::min(low.y, p.y)},
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    for (const Tri& t : c.mesh.tris) plane += 0.5 * cross(c.uv[t[1]] - c.uv[t[0]], c.uv[t[2]] - c.uv[t[0]]);
    const double scale = plane > 0 ? std::sqrt(total_area(c.mesh) / plane) : 1;
    sheets.push_back({low, scale * (high - low), scale});
    area += sheets.back().size.x * sheets.back().size.y;
  }
  std::vector<int> order(charts.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return sheets[a].size.y > sheets[b].size.y; });
  const double gap = 0.03 * std::sqrt(area), width = 1.5 * std::sqrt(area);
  Mesh flat{{}, std::vector<Tri>(surface.tris.size(), Tri{0, 0, 0})};
  double x = 0, y = 0, row = 0;
  for (int k : order) {
    const Sheet& s = sheets[k];
    if (x > 0 && x + s.size.x > width) x = 0, y -= row + gap, row = 0;
    row = std::max(row, s.size.y);
    const int first = (int)flat.points.size();
    for (Vec2 p : charts[k].uv)
      flat.points.push_back({x + s.scale * (p.x - s.low.x), y - s.size.y + s.scale * (p.y - s.low.y), 0});
    const SubMesh& m = charts[k].mesh;
    for (std::size_t t = 0; t < m.tris.size(); ++t)
      for (int i = 0; i < 3; ++i) flat.tris[m.face[t]][i] = first + m.tris[t][i];
    x += s.size.x + gap;
  }
  return flat;
}

void add_mesh(PageItem& item, const char* kind, const Mesh& mesh, const std::vector<std::uint8_t>& model,
              const MeshColumns& columns) {
  if (mesh.tris.empty()) return;
  PackedMesh packed = pack(mesh, model, columns);
  packed.head["name"] = item.name + (item.meshes.empty() ? "" : std::string(": ") + kind);
  packed.head["kind"] = kind;
  item.meshes.push_back(std::move(packed));
}

std::vector<PatchRow> patch_rows(const Surface& surface, const std::function<std::string(int)>& name) {
  if (!surface.face.has("patch")) return {};
  const auto& label = surface.face.get<int>("patch");
  std::map<int, PatchRow> rows;
  for (int t = 0; t < (int)label.size(); ++t) {
    PatchRow& row = rows[label[t]];
    row.area += triangle_area(surface, t);
    ++row.triangles;
    if (const double k = kappa_of(surface, t); row.worst < 0 || k < row.kappa) row.kappa = k, row.worst = t;
  }
  std::vector<PatchRow> list;
  for (auto& [l, row] : rows) {
    row.name = name(l);
    list.push_back(row);
  }
  return list;
}

std::string offenses(int bits) {
  constexpr std::pair<int, const char*> names[] = {{offends_topology, "topology"},
                                                   {offends_intersections, "intersection"},
                                                   {offends_folds, "fold"},
                                                   {offends_kappa, "kappa"},
                                                   {offends_vertices, "vertices off the reference"},
                                                   {offends_deviation, "distance"}};
  std::string text;
  for (auto [bit, name] : names)
    if (bits & bit) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

/// Returns the triangle that a failure is about, or next to its place; -1: it names neither.
int triangle_of(const Failure& failure, const Findings& findings, const Mesh& mesh) {
  const Vec3 p = failure.requirement == "hausdorff" ? findings.distance.place : failure.place;
  if (failure.triangle >= 0 || !std::isfinite(p.x)) return failure.triangle;
  int nearest = -1;
  double least = HUGE_VAL;
  for (int t = 0; t < (int)mesh.tris.size(); ++t)
    if (const double d = norm(closest_point(mesh, t, p) - p); d < least) least = d, nearest = t;
  return nearest;
}

/// Lists the triangles at fault: those that failures name, then the others by kappa.
void list_offending(PageItem& item, const Mesh& mesh, const std::vector<double>& kappas,
                    const Judgment& judgment) {
  const Surface faulty = offending_faces(judgment.contract, judgment.findings, mesh);
  std::map<int, std::string> fault;
  std::vector<int>& order = item.offending_triangles;
  for (const Failure& f : item.failures)
    if (const int t = triangle_of(f, judgment.findings, mesh);
        t >= 0 && fault.emplace(t, f.requirement).second)
      order.push_back(t);
  const auto named = (std::ptrdiff_t)order.size();
  for (std::size_t i = 0; i < faulty.tris.size(); ++i) {
    const int t = faulty.face.get<int>("triangle")[i];
    if (fault.try_emplace(t).second) order.push_back(t);
    fault[t] = offenses(faulty.face.get<std::uint8_t>("fault")[i]);
  }
  std::stable_sort(order.begin() + named, order.end(), [&](int s, int t) { return kappas[s] < kappas[t]; });
  for (int t : std::span(order).first(std::min(most_rows, order.size())))
    item.offending.push_back({t, kappas[t], centroid(mesh, t), fault[t]});
}

void list_triangles(PageItem& item, const Mesh& mesh, const std::vector<double>& kappas,
                    const Judgment* judgment) {
  std::vector<int> order(kappas.size());
  std::iota(order.begin(), order.end(), 0);
  const std::size_t n = std::min<std::size_t>(worst_count, order.size());
  std::partial_sort(order.begin(), order.begin() + (std::ptrdiff_t)n, order.end(),
                    [&](int a, int b) { return std::pair(kappas[a], a) < std::pair(kappas[b], b); });
  for (std::size_t i = 0; i < n; ++i)
    item.worst.push_back({order[i], kappas[order[i]], centroid(mesh, order[i]), ""});
  if (judgment) list_offending(item, mesh, kappas, *judgment);
}

std::string still_picture(const Surface& surface) {
  View view;
  view.edges = surface.tris.size() <= most_drawn_lines;
  Frame frame;
  add_to_frame(frame, surface, view);
  std::vector<Color> colors;
  for (int t = 0; t < (int)surface.tris.size(); ++t) colors.push_back(scale_color(kappa_of(surface, t)));
  return write_png(draw_mesh(surface, colors, model_of(surface), view, frame, picture_width, picture_height));
}

}  // namespace

PageItem page_item(const Stream& stream, const std::string& name, const Judgment* judgment) {
  PageItem item;
  const Surface& surface = stream.surface;
  item.name = name;
  item.triangles = (int)surface.tris.size();
  item.history = stream.history;
  const auto patch_name = namer(stream);
  Findings alone;
  if (!judgment) {
    alone.mesh = soundness_of(surface);
    const std::vector<double> none;
    alone.quality = quality_of({surface, alone.mesh.opposite, model_of(surface)},
                               surface.vertex.has("size") ? surface.vertex.get<double>("size") : none);
  }
  const Findings& f = judgment ? judgment->findings : alone;
  item.figures = figures(f);
  item.histograms = findings_svg(f);
  item.report = report_of(f, stream);
  item.patches = patch_rows(surface, patch_name);
  MeshColumns columns = columns_of(surface, patch_name);
  if (judgment) {
    item.contract = judgment->contract;
    item.failures = judge(judgment->contract, f, surface);
    for (const Requirement& r : judgment->contract) item.reached.push_back(reached(r, f));
    item.warnings = warnings_of(stream, f);
    item.report["failed"] = failures_json(item.failures);
    FigureColumn distance{"distance, in sizes", f.distance.deviation.ratio, 0, 1};
    for (double& x : distance.values) distance.high = std::max(distance.high, x *= most_deviation);
    if (!distance.values.empty()) columns.figures.push_back(std::move(distance));
  } else {
    item.report.erase("reference");
    item.report.erase("topology_same");
  }
  list_triangles(item, surface, columns.figures[0].values, judgment);
  if (!surface.tris.empty()) item.picture = still_picture(surface);
  add_mesh(item, "result", surface, model_of(surface), columns);
  if (judgment && judgment->reference.tris.size() <= most_reference)
    add_mesh(item, "reference", judgment->reference, model_of(judgment->reference),
             columns_of(judgment->reference, patch_name));
  if (stream.find("chart_vertex"))
    add_mesh(item, "charts", flat_charts(surface, read_charts(stream)), model_of(surface), columns);
  return item;
}

}  // namespace meshpipe
