// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream/check_tables.h"

#include "formats/stream/mesh_tables.h"
#include "lib/core/error.h"

namespace meshpipe {
namespace {

constexpr const char* writer = "mcheck --shards";

/// A column with one row.
template <class T>
void set_value(Table& table, const std::string& name, T value) {
  table.set(name, std::vector<T>{value});
}

constexpr std::pair<const char*, double OneWay::*> lengths[] = {
    {"largest", &OneWay::largest}, {"upper", &OneWay::upper}, {"mean", &OneWay::mean}, {"rms", &OneWay::rms}};
constexpr std::pair<const char*, double Vec3::*> axes[] = {{"x", &Vec3::x}, {"y", &Vec3::y}, {"z", &Vec3::z}};

/// A table of pairs, and back.
template <class A, class B>
Table pair_table(const char* name, const char* first, const char* second,
                 const std::vector<std::pair<A, B>>& pairs) {
  Table table{name, 0, {}};
  std::vector<A> a;
  std::vector<B> b;
  for (const auto& [x, y] : pairs) a.push_back(x), b.push_back(y);
  table.set(first, std::move(a));
  table.set(second, std::move(b));
  return table;
}
template <class A, class B>
std::vector<std::pair<A, B>> pairs_of(const Stream& stream, const char* name, const char* first,
                                      const char* second) {
  const Table& table = stream.need(name, writer);
  const auto& a = table.get<A>(first);
  const auto& b = table.get<B>(second);
  std::vector<std::pair<A, B>> pairs;
  for (std::size_t i = 0; i < table.rows; ++i) pairs.push_back({a[i], b[i]});
  return pairs;
}

/// Throws: BadInput if a row is none of `rows`.
void expect_row(long long row, long long rows, const char* what) {
  if (row < 0 || row >= rows)
    throw BadInput(std::string(what) + ' ' + std::to_string(row) + " was measured, but there are " +
                   std::to_string(rows));
}

}  // namespace

Stream stream_of(CheckJob job) {
  Stream stream;
  CheckShare& s = job.share;
  Table table{"check_share", 0, {}};
  set_value(table, "number", job.number);
  set_value(table, "of", job.all);
  set_value(table, "own", s.own);
  set_value(table, "other_own", s.other_own);
  set_value(table, "diagonal", s.diagonal);
  set_value(table, "most", s.most);
  stream.set(std::move(table));
  stream.surface = surface_of(std::move(s.mesh));
  stream.set(point_table("other_vertex", s.other));
  stream.set(triangle_table("other_face", s.other));
  Table vertices{"check_vertex", 0, {}}, triangles{"check_face", 0, {}}, sides{"check_side", 0, {}};
  sides.set("samples", std::vector<int>(s.samples.begin(), s.samples.end()));
  sides.set("budget", std::vector<int>(s.budget.begin(), s.budget.end()));
  stream.set(std::move(sides));
  vertices.set("row", std::move(s.vertices));
  triangles.set("row", std::move(s.triangles));
  triangles.set("allowed", std::move(s.allowed));
  stream.set(std::move(vertices));
  stream.set(std::move(triangles));
  return stream;
}

CheckJob take_share(Stream stream) {
  const Table& table = need_row(stream, "check_share", writer);
  CheckJob job{table.get<int>("number")[0], table.get<int>("of")[0], {}};
  CheckShare& s = job.share;
  s.own = table.get<int>("own")[0], s.other_own = table.get<int>("other_own")[0];
  const Table& sides = need_rows(stream, "check_side", writer, 2);
  for (int side : {0, 1})
    s.samples[side] = sides.get<int>("samples")[side], s.budget[side] = sides.get<int>("budget")[side];
  s.diagonal = table.get<double>("diagonal")[0], s.most = table.get<double>("most")[0];
  s.mesh = std::move(static_cast<Mesh&>(stream.surface));
  s.other = mesh_from(stream.need("other_vertex", writer), stream.need("other_face", writer));
  s.vertices = stream.need("check_vertex", writer).get<int>("row");
  const Table& triangles = stream.need("check_face", writer);
  s.triangles = triangles.get<int>("row");
  s.allowed = triangles.get<double>("allowed");
  const std::string name = "share " + std::to_string(job.number);
  const auto expect = [&](bool right, int found, std::size_t of, const char* what) {
    if (!right)
      throw BadInput(name + " has " + std::to_string(found) + ' ' + what + ", and a mesh of " +
                     std::to_string(of));
  };
  const auto outside = [](int own, const Mesh& mesh) {
    return own < 0 || own > static_cast<int>(mesh.tris.size());
  };
  expect(!outside(s.own, s.mesh), s.own, s.mesh.tris.size(), "own triangles");
  expect(!outside(s.other_own, s.other), s.other_own, s.other.tris.size(), "own triangles of the reference");
  expect(s.vertices.size() == s.mesh.points.size(), static_cast<int>(s.vertices.size()), s.mesh.points.size(),
         "rows of vertices");
  expect(s.triangles.size() == s.mesh.tris.size(), static_cast<int>(s.triangles.size()), s.mesh.tris.size(),
         "rows of triangles");
  if (s.samples[0] < 1 || s.samples[1] < 1 || !(s.diagonal > 0))
    throw BadInput(name + " has no samples or no size");
  for (double a : s.allowed)
    if (!(a > 0)) throw BadInput(name + " allows no distance at a triangle");
  return job;
}

Stream stream_of(int number, int all, ShareFindings f) {
  Stream stream;
  Table table{"checked", 0, {}};
  set_value(table, "number", number);
  set_value(table, "of", all);
  stream.set(std::move(table));
  const OneWay &a = f.distance[0], &b = f.distance[1];
  Table sides{"checked_side", 0, {}};
  sides.set("area", std::vector<double>{f.area[0], f.area[1]});
  for (const auto& [name, length] : lengths) sides.set(name, std::vector<double>{a.*length, b.*length});
  sides.set("worst", std::vector<double>{a.deviation.worst, b.deviation.worst});
  sides.set("triangle", std::vector<int>{a.deviation.triangle, b.deviation.triangle});
  for (const auto& [name, axis] : axes) {
    sides.set(name, std::vector<double>{a.place.*axis, b.place.*axis});
    sides.set("worst_" + std::string(name),
              std::vector<double>{a.deviation.place.*axis, b.deviation.place.*axis});
  }
  stream.set(std::move(sides));
  stream.set(pair_table("checked_ratio", "triangle", "ratio", f.ratios));
  stream.set(pair_table("checked_vertex", "vertex", "distance", f.off));
  stream.set(pair_table("checked_crossing", "a", "b", f.intersections));
  Table folds{"checked_fold", 0, {}};
  folds.set("half_edge", std::move(f.folds));
  stream.set(std::move(folds));
  return stream;
}

namespace {

/// Returns what was measured of a share, and its number. Throws: BadInput for rows that the result has not.
std::pair<int, ShareFindings> read_findings(const Stream& stream, const Surface& result, int& all) {
  const Table& table = need_row(stream, "checked", "mcheck");
  ShareFindings f;
  all = table.get<int>("of")[0];
  const auto n_tris = static_cast<long long>(result.tris.size());
  const Table& sides = need_rows(stream, "checked_side", "mcheck", 2);
  for (int side : {0, 1}) {
    OneWay& way = f.distance[side];
    f.area[side] = sides.get<double>("area")[side];
    for (const auto& [name, length] : lengths) way.*length = sides.get<double>(name)[side];
    Deviation& d = way.deviation;
    d.worst = sides.get<double>("worst")[side];
    d.triangle = sides.get<int>("triangle")[side];
    if (d.triangle != -1) expect_row(d.triangle, n_tris, "triangle");
    for (const auto& [name, axis] : axes) {
      way.place.*axis = sides.get<double>(name)[side];
      d.place.*axis = sides.get<double>("worst_" + std::string(name))[side];
    }
  }
  f.ratios = pairs_of<int, double>(stream, "checked_ratio", "triangle", "ratio");
  f.off = pairs_of<int, double>(stream, "checked_vertex", "vertex", "distance");
  f.intersections = pairs_of<int, int>(stream, "checked_crossing", "a", "b");
  f.folds = stream.need("checked_fold", "mcheck").get<int>("half_edge");
  for (const auto& [t, ratio] : f.ratios) expect_row(t, n_tris, "triangle");
  for (const auto& [v, off] : f.off) expect_row(v, static_cast<long long>(result.points.size()), "vertex");
  for (const auto& [a, b] : f.intersections)
    expect_row(a, n_tris, "triangle"), expect_row(b, n_tris, "triangle");
  for (int h : f.folds) expect_row(h, 3 * n_tris, "half-edge");
  return {table.get<int>("number")[0], std::move(f)};
}

}  // namespace

std::vector<ShareFindings> join_checks(const Stream& whole, const Provenance& by,
                                       const std::vector<std::string>& names, const ReadShard& read) {
  std::vector<ShareFindings> all;
  std::vector<const std::string*> from;
  const long long most = 2 + static_cast<long long>(whole.surface.tris.size()) +
                         static_cast<long long>(whole.need("ref_face", "mlift").rows);
  auto take = [&](const std::string& name, const Stream& stream) {
    if (is_check_share(stream)) throw BadInput("its shares are not measured yet");
    expect_made_of(whole, stream.history, by);
    int shares = 0;
    auto [number, found] = read_findings(stream, whole.surface, shares);
    if (all.empty() && shares > 0 && shares <= most) all.resize(shares), from.resize(shares);
    if (shares != static_cast<int>(all.size())) throw BadInput("the check was cut otherwise");
    expect_row(number, shares, "share");
    if (from[number]) throw BadInput("share " + std::to_string(number) + " is in " + *from[number] + ", too");
    from[number] = &name;
    all[number] = std::move(found);
  };
  for (const std::string& name : names)
    read(name, [&](const Stream& stream) { of_shard(name, [&] { take(name, stream); }); });
  for (std::size_t i = 0; i < from.size(); ++i)
    if (!from[i])
      throw BadInput("share " + std::to_string(i) + " of " + std::to_string(from.size()) + " is in no shard");
  return all;
}

}  // namespace meshpipe
