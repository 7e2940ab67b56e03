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
  set_value(table, "of_result", static_cast<int>(s.of_result));
  set_value(table, "own", s.own);
  set_value(table, "samples", s.samples);
  set_value(table, "budget", s.budget);
  set_value(table, "diagonal", s.diagonal);
  set_value(table, "most", s.most);
  stream.set(std::move(table));
  stream.surface = surface_of(std::move(s.mesh));
  stream.set(point_table("other_vertex", s.other));
  stream.set(triangle_table("other_face", s.other));
  Table vertices{"check_vertex", 0, {}}, triangles{"check_face", 0, {}};
  vertices.set("row", std::move(s.vertices));
  s.allowed.resize(s.triangles.size());  // none of those that are only next to the share
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
  s.of_result = table.get<int>("of_result")[0] != 0;
  s.own = table.get<int>("own")[0];
  s.samples = table.get<int>("samples")[0], s.budget = table.get<int>("budget")[0];
  s.diagonal = table.get<double>("diagonal")[0], s.most = table.get<double>("most")[0];
  s.mesh = std::move(static_cast<Mesh&>(stream.surface));
  s.other = mesh_from(stream.need("other_vertex", writer), stream.need("other_face", writer));
  s.vertices = stream.need("check_vertex", writer).get<int>("row");
  const Table& triangles = stream.need("check_face", writer);
  s.triangles = triangles.get<int>("row");
  s.allowed = triangles.get<double>("allowed");
  const std::string name = "share " + std::to_string(job.number);
  if (s.own < 1 || s.own > static_cast<int>(s.mesh.tris.size()) || s.samples < 1 || !(s.diagonal > 0))
    throw BadInput(name + " has " + std::to_string(s.own) + " of " + std::to_string(s.mesh.tris.size()) +
                   " triangles and " + std::to_string(s.samples) + " samples");
  if (s.vertices.size() != (s.of_result ? s.mesh.points.size() : 0) ||
      s.triangles.size() != (s.of_result ? s.mesh : s.other).tris.size())
    throw BadInput(name + " has " + std::to_string(s.vertices.size()) + " rows of vertices and " +
                   std::to_string(s.triangles.size()) + " of triangles, others than it has in its meshes");
  if (s.of_result) s.allowed.resize(s.own);
  for (double a : s.allowed)
    if (!(a > 0)) throw BadInput(name + " allows no distance at a triangle");
  return job;
}

Stream stream_of(int number, int all, ShareFindings f) {
  Stream stream;
  Table table{"checked", 0, {}};
  set_value(table, "number", number);
  set_value(table, "of", all);
  set_value(table, "of_result", static_cast<int>(f.of_result));
  set_value(table, "area", f.area);
  const OneWay& d = f.distance;
  for (const auto& [name, length] : lengths) set_value(table, name, d.*length);
  set_value(table, "worst", d.deviation.worst);
  set_value(table, "triangle", d.deviation.triangle);
  for (const auto& [name, axis] : axes) {
    set_value(table, name, d.place.*axis);
    set_value(table, "worst_" + std::string(name), d.deviation.place.*axis);
  }
  stream.set(std::move(table));
  stream.set(pair_table("checked_ratio", "triangle", "ratio", f.ratios));
  stream.set(pair_table("checked_vertex", "vertex", "distance", f.off));
  stream.set(pair_table("checked_crossing", "a", "b", f.crossings));
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
  f.of_result = table.get<int>("of_result")[0] != 0;
  f.area = table.get<double>("area")[0];
  for (const auto& [name, length] : lengths) f.distance.*length = table.get<double>(name)[0];
  Deviation& d = f.distance.deviation;
  d.worst = table.get<double>("worst")[0];
  d.triangle = table.get<int>("triangle")[0];
  if (d.triangle != -1) expect_row(d.triangle, n_tris, "triangle");
  for (const auto& [name, axis] : axes) {
    f.distance.place.*axis = table.get<double>(name)[0];
    d.place.*axis = table.get<double>("worst_" + std::string(name))[0];
  }
  f.ratios = pairs_of<int, double>(stream, "checked_ratio", "triangle", "ratio");
  f.off = pairs_of<int, double>(stream, "checked_vertex", "vertex", "distance");
  f.crossings = pairs_of<int, int>(stream, "checked_crossing", "a", "b");
  f.folds = stream.need("checked_fold", "mcheck").get<int>("half_edge");
  for (const auto& [t, ratio] : f.ratios) expect_row(t, n_tris, "triangle");
  for (const auto& [v, off] : f.off) expect_row(v, static_cast<long long>(result.points.size()), "vertex");
  for (const auto& [a, b] : f.crossings) expect_row(a, n_tris, "triangle"), expect_row(b, n_tris, "triangle");
  for (int h : f.folds) expect_row(h, 3 * n_tris, "half-edge");
  return {table.get<int>("number")[0], std::move(f)};
}

}  // namespace

std::vector<ShareFindings> join_checks(const Stream& whole, const Provenance& by,
                                       const std::vector<std::string>& names, const ReadShard& read) {
  std::vector<ShareFindings> all;
  std::vector<const std::string*> from;
  auto text = [](const Provenance& p) {  // --accept changes only what becomes of a failure
    std::string words = p.program + (p.arguments.empty() ? "" : ' ' + p.arguments) + ' ';
    if (const std::size_t at = words.find(" --accept "); at != words.npos) words.erase(at, 9);
    return words;
  };
  const long long most = 2 + static_cast<long long>(whole.surface.tris.size()) +
                         static_cast<long long>(whole.need("ref_face", "mlift").rows);
  auto take = [&](const std::string& name, const Stream& stream) {
    if (is_check_share(stream)) throw BadInput("its shares are not measured yet");
    const auto &made = stream.history, &known = whole.history;
    bool same = made.size() == known.size() + 1 && text(made.back()) == text(by);
    for (std::size_t i = 0; same && i < known.size(); ++i) same = text(made[i]) == text(known[i]);
    if (!same) throw BadInput("it was made of another result, or with other options");
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
