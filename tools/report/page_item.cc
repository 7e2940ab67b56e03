// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/page_item.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <span>

#include "formats/stream/line_tables.h"
#include "lib/core/bvh.h"
#include "lib/core/lists.h"
#include "lib/draw/draw.h"
#include "tools/report/page_meshes.h"
#include "tools/report/png.h"
#include "tools/report/verdict.h"

namespace meshpipe {
namespace {

constexpr int worst_count = 10;
constexpr int picture_width = 720, picture_height = 540;  ///< pixels
/// Mesh lines of more triangles than this would fill the still picture.
constexpr std::size_t most_drawn_lines = 20000;
/// Pixels between model edges that are closer in the still picture would be few.
constexpr double least_spacing = 8;
constexpr Color fault_color{226, 41, 41};  ///< as in viewer.js

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
  sort_unique(known);
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
  kappas.of_triangle = kappa_of, angles.of_triangle = smallest_angle, sizes.of_triangle = mean_edge;
  for (FigureColumn* c : {&kappas, &angles, &sizes})
    for (int t = 0; t < n; ++t) c->values.push_back(c->of_triangle(surface, t));
  for (double size : sizes.values) {
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

void add_mesh(PageItem& item, const char* kind, const Mesh& mesh, const std::vector<std::uint8_t>& thick,
              const MeshColumns& columns, const std::vector<Vec3>& dots = {}) {
  if (mesh.tris.empty()) return;
  PackedMesh packed = pack(mesh, thick, columns, dots);
  packed.head["name"] = item.name + (item.meshes.empty() ? "" : std::string(": ") + kind);
  packed.head["kind"] = kind;
  item.meshes.push_back(std::move(packed));
}

/// Adds the meshes that the view shows: the result first, or the intermediate.
void add_meshes(PageItem& item, const Stream& stream, const MeshColumns& columns, const Judgment* judgment) {
  const Surface& surface = stream.surface;
  const bool lines = stream.find("line_use") && !stream.find("ref_vertex");
  add_mesh(item, "result", surface, lines ? line_edges(surface) : model_of(surface), columns,
           lines ? line_points(stream) : std::vector<Vec3>());
  if (judgment) {
    const Surface before = before_cuts(judgment->reference);
    const std::size_t n = before.tris.size();
    if (n <= most_reference)
      add_mesh(item, "reference", before, model_of(before), columns_of(before, namer(stream)));
    else
      item.warnings.push_back("The view leaves out the surface that it was made from: it has " +
                              std::to_string(n) + " triangles, more than " + std::to_string(most_reference) +
                              ".");
  }
  if (!stream.find("chart_vertex")) return;
  const std::vector<Chart> charts = read_charts(stream);
  if (lines && stream.find("chart_face")) {
    const PlaneMeshes plane = plane_meshes(stream, charts);
    add_mesh(item, "plane meshes", {plane.flat, plane.space.tris}, model_of(plane.space),
             columns_of(plane.space, namer(stream)));
  }
  add_mesh(item, "charts", flat_charts(surface, charts), {}, {});
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
                                                   {offends_deviation, "distance"},
                                                   {offends_patches, "extent of the patch"},
                                                   {offends_creases, "cut crease"}};
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
void list_offending(PageItem& item, const Surface& mesh, const std::vector<double>& kappas,
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

void list_triangles(PageItem& item, const Surface& mesh, const std::vector<double>& kappas,
                    const Judgment* judgment) {
  std::vector<int> order = identity(kappas.size());
  const std::size_t n = std::min<std::size_t>(worst_count, order.size());
  std::partial_sort(order.begin(), order.begin() + (std::ptrdiff_t)n, order.end(),
                    [&](int a, int b) { return std::pair(kappas[a], a) < std::pair(kappas[b], b); });
  for (std::size_t i = 0; i < n; ++i)
    item.worst.push_back({order[i], kappas[order[i]], centroid(mesh, order[i]), ""});
  if (judgment) list_offending(item, mesh, kappas, *judgment);
}

/// Draws what the viewer shows at first, in its colors.
std::string still_picture(const Surface& surface, const std::vector<int>& faulty) {
  View view;
  view.edges = surface.tris.size() <= most_drawn_lines;
  Frame frame;
  add_to_frame(frame, surface, view);
  std::vector<Color> colors;
  for (int t = 0; t < (int)surface.tris.size(); ++t) colors.push_back(scale_color(kappa_of(surface, t)));
  for (int t : faulty) colors[t] = fault_color;
  const double pixel =
      std::max((frame.right - frame.left) / picture_width, (frame.high - frame.low) / picture_height);
  std::vector<std::uint8_t> thick = model_of(surface);
  const std::vector<double> spacing = spacing_of(surface, thick);
  for (std::size_t t = 0; t < thick.size(); ++t)
    if (spacing[t] < least_spacing * pixel) thick[t] = 0;
  return write_png(draw_mesh(surface, colors, thick, view, frame, picture_width, picture_height));
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
  if (!surface.tris.empty()) item.picture = still_picture(surface, item.offending_triangles);
  add_meshes(item, stream, columns, judgment);
  return item;
}

}  // namespace meshpipe
