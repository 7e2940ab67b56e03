// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream/check_tables.h"

#include "formats/stream/spans.h"
#include "lib/core/error.h"

namespace meshpipe {
namespace {

constexpr const char* writer = "mcheck --shards";

/// A column of one number per share.
template <class T, class Share, class Of>
void set_column(Table& table, const char* name, const std::vector<Share>& shares, Of of) {
  std::vector<T> values;
  for (const Share& s : shares) values.push_back(static_cast<T>(of(s)));
  table.set(name, std::move(values));
}

constexpr std::pair<const char*, double OneWay::*> lengths[] = {
    {"largest", &OneWay::largest}, {"upper", &OneWay::upper}, {"mean", &OneWay::mean}, {"rms", &OneWay::rms}};
constexpr std::pair<const char*, double Vec3::*> axes[] = {{"x", &Vec3::x}, {"y", &Vec3::y}, {"z", &Vec3::z}};

/// Columns of table `check_share`: the rows of each in the other tables.
constexpr const char* sizes[] = {"vertices", "faces", "other_vertices", "other_faces"};

/// A table of pairs, and back.
template <class A, class B>
Table pair_table(const char* name, const char* first, const char* second,
                 const std::vector<std::pair<A, B>>& pairs) {
  Table table{name, 0, {}};
  set_column<A>(table, first, pairs, [](const auto& p) { return p.first; });
  set_column<B>(table, second, pairs, [](const auto& p) { return p.second; });
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

void ShareTables::add(int number, const CheckShare& s) {
  numbers_.push_back(number);
  heads_.push_back({s.of_result, s.own, {}, {}, {}, {}, {}, s.diagonal, s.most, s.samples, s.budget});
  auto count = [](const auto& list) { return static_cast<int>(list.size()); };
  rows_.push_back({count(s.mesh.points), count(s.mesh.tris), count(s.other.points), count(s.other.tris)});
  append_tris(meshes_.tris, s.mesh.tris, meshes_.points.size());
  append(meshes_.points, s.mesh.points);
  append_tris(others_.tris, s.other.tris, others_.points.size());
  append(others_.points, s.other.points);
  append(vertices_, s.vertices), append(triangles_, s.triangles), append(allowed_, s.allowed);
  allowed_.resize(triangles_.size());  // none of those that are only next to the share
}

void ShareTables::write(Stream& stream, int all) {
  stream.tables.clear();
  Table table{"check_share", 0, {}};
  table.set("number", std::move(numbers_));
  table.set("of", std::vector<int>(table.rows, all));
  set_column<int>(table, "of_result", heads_, [](const CheckShare& s) { return s.of_result; });
  set_column<int>(table, "own", heads_, [](const CheckShare& s) { return s.own; });
  for (int i = 0; i < 4; ++i)
    set_column<int>(table, sizes[i], rows_, [i](const auto& rows) { return rows[i]; });
  set_column<int>(table, "samples", heads_, [](const CheckShare& s) { return s.samples; });
  set_column<int>(table, "budget", heads_, [](const CheckShare& s) { return s.budget; });
  set_column<double>(table, "diagonal", heads_, [](const CheckShare& s) { return s.diagonal; });
  set_column<double>(table, "most", heads_, [](const CheckShare& s) { return s.most; });
  stream.set(std::move(table));
  stream.surface = surface_of(std::move(meshes_));
  stream.set(table_of("other_vertex", others_, true));
  stream.set(table_of("other_face", others_, false));
  Table vertices{"check_vertex", 0, {}}, triangles{"check_face", 0, {}};
  vertices.set("row", std::move(vertices_));
  triangles.set("row", std::move(triangles_));
  triangles.set("allowed", std::move(allowed_));
  stream.set(std::move(vertices));
  stream.set(std::move(triangles));
  *this = {};
}

CheckShard read_shares(const Stream& stream) {
  const Surface& s = stream.surface;
  const Table& table = stream.need("check_share", writer);
  const Table &points = stream.need("other_vertex", writer), &tris = stream.need("other_face", writer);
  const Mesh others = mesh_from(points, tris);
  const Table &rows = stream.need("check_vertex", writer), &triangles = stream.need("check_face", writer);
  const auto vertices = spans_of(table, sizes[0], s.points.size()),
             faces = spans_of(table, sizes[1], s.tris.size()),
             other_vertices = spans_of(table, sizes[2], points.rows),
             other_faces = spans_of(table, sizes[3], tris.rows);
  Span vertex, triangle;  // of a share in the tables of rows
  if (table.rows == 0) throw BadInput("it has no shares");
  CheckShard shard{table.get<int>("of")[0], table.get<int>("number"), {}};
  for (std::size_t i = 0; i < table.rows; ++i) {
    CheckShare& c = shard.shares.emplace_back();
    c.of_result = table.get<int>("of_result")[i] != 0;
    c.own = table.get<int>("own")[i];
    c.samples = table.get<int>("samples")[i], c.budget = table.get<int>("budget")[i];
    c.diagonal = table.get<double>("diagonal")[i], c.most = table.get<double>("most")[i];
    if (c.own < 1 || c.own > faces[i].size() || c.samples < 1 || !(c.diagonal > 0))
      throw BadInput("share " + std::to_string(shard.numbers[i]) + " has " + std::to_string(c.own) + " of " +
                     std::to_string(faces[i].size()) + " triangles and " + std::to_string(c.samples) +
                     " samples");
    c.mesh = {vertices[i].of(s.points), tris_of(s.tris, faces[i], vertices[i])};
    c.other = {other_vertices[i].of(others.points), tris_of(others.tris, other_faces[i], other_vertices[i])};
    vertex = {vertex.last, vertex.last + (c.of_result ? vertices[i].size() : 0)};
    triangle = {triangle.last, triangle.last + (c.of_result ? faces[i] : other_faces[i]).size()};
    if (vertex.last > static_cast<int>(rows.rows) || triangle.last > static_cast<int>(triangles.rows))
      throw BadInput("share " + std::to_string(shard.numbers[i]) + " has more rows than there are");
    c.vertices = vertex.of(rows.get<int>("row"));
    c.triangles = triangle.of(triangles.get<int>("row"));
    c.allowed = triangle.of(triangles.get<double>("allowed"));
    if (c.of_result) c.allowed.resize(c.own);
    for (double a : c.allowed)
      if (!(a > 0))
        throw BadInput("share " + std::to_string(shard.numbers[i]) + " allows no distance at a triangle");
  }
  return shard;
}

void write_findings(Stream& stream, const CheckShard& shard, const std::vector<ShareFindings>& found) {
  stream.tables.clear();
  stream.surface = {};
  Table table{"checked", 0, {}};
  table.set("number", shard.numbers);
  table.set("of", std::vector<int>(table.rows, shard.all));
  set_column<int>(table, "of_result", found, [](const ShareFindings& f) { return f.of_result; });
  set_column<double>(table, "area", found, [](const ShareFindings& f) { return f.area; });
  for (const auto& [name, length] : lengths)
    set_column<double>(table, name, found, [of = length](const ShareFindings& f) { return f.distance.*of; });
  set_column<double>(table, "worst", found,
                     [](const ShareFindings& f) { return f.distance.deviation.worst; });
  set_column<int>(table, "triangle", found,
                  [](const ShareFindings& f) { return f.distance.deviation.triangle; });
  for (const auto& [name, axis] : axes) {
    set_column<double>(table, name, found,
                       [of = axis](const ShareFindings& f) { return f.distance.place.*of; });
    set_column<double>(table, ("worst_" + std::string(name)).c_str(), found,
                       [of = axis](const ShareFindings& f) { return f.distance.deviation.place.*of; });
  }
  stream.set(std::move(table));
  ShareFindings all;
  for (const ShareFindings& f : found) {
    append(all.ratios, f.ratios), append(all.off, f.off);
    append(all.crossings, f.crossings), append(all.folds, f.folds);
  }
  stream.set(pair_table("checked_ratio", "triangle", "ratio", all.ratios));
  stream.set(pair_table("checked_vertex", "vertex", "distance", all.off));
  stream.set(pair_table("checked_crossing", "a", "b", all.crossings));
  Table folds{"checked_fold", 0, {}};
  folds.set("half_edge", std::move(all.folds));
  stream.set(std::move(folds));
}

namespace {

/// Returns what one shard has measured, and the shares' numbers; only the first has lists.
std::vector<ShareFindings> read_findings(const Stream& stream, const Surface& result, CheckShard& shard) {
  const Table& table = stream.need("checked", "mcheck");
  std::vector<ShareFindings> found(table.rows);
  if (found.empty()) throw BadInput("it has no shares");
  shard.all = table.get<int>("of")[0];
  shard.numbers = table.get<int>("number");
  const auto n_tris = static_cast<long long>(result.tris.size());
  for (std::size_t i = 0; i < table.rows; ++i) {
    ShareFindings& f = found[i];
    f.of_result = table.get<int>("of_result")[i] != 0;
    f.area = table.get<double>("area")[i];
    for (const auto& [name, length] : lengths) f.distance.*length = table.get<double>(name)[i];
    Deviation& d = f.distance.deviation;
    d.worst = table.get<double>("worst")[i];
    d.triangle = table.get<int>("triangle")[i];
    if (d.triangle != -1) expect_row(d.triangle, n_tris, "triangle");
    for (const auto& [name, axis] : axes) {
      f.distance.place.*axis = table.get<double>(name)[i];
      d.place.*axis = table.get<double>("worst_" + std::string(name))[i];
    }
  }
  ShareFindings& all = found[0];
  all.ratios = pairs_of<int, double>(stream, "checked_ratio", "triangle", "ratio");
  all.off = pairs_of<int, double>(stream, "checked_vertex", "vertex", "distance");
  all.crossings = pairs_of<int, int>(stream, "checked_crossing", "a", "b");
  all.folds = stream.need("checked_fold", "mcheck").get<int>("half_edge");
  for (const auto& [t, ratio] : all.ratios) expect_row(t, n_tris, "triangle");
  for (const auto& [v, off] : all.off) expect_row(v, static_cast<long long>(result.points.size()), "vertex");
  for (const auto& [a, b] : all.crossings)
    expect_row(a, n_tris, "triangle"), expect_row(b, n_tris, "triangle");
  for (int h : all.folds) expect_row(h, 3 * n_tris, "half-edge");
  return found;
}

}  // namespace

std::vector<ShareFindings> join_checks(const Stream& whole, const Provenance& by,
                                       const std::vector<std::string>& names,
                                       const std::function<Stream(const std::string&)>& read) {
  std::vector<ShareFindings> all;
  std::vector<const std::string*> from;
  auto text = [](const Provenance& p) {  // --accept changes only what becomes of a failure
    std::string words = p.program + (p.arguments.empty() ? "" : ' ' + p.arguments) + ' ';
    if (const std::size_t at = words.find(" --accept "); at != words.npos) words.erase(at, 9);
    return words;
  };
  for (const std::string& name : names) try {
      const Stream stream = read(name);
      if (has_check_shares(stream)) throw BadInput("its shares are not measured yet");
      const auto &made = stream.history, &known = whole.history;
      bool same = made.size() == known.size() + 1 && text(made.back()) == text(by);
      for (std::size_t i = 0; same && i < known.size(); ++i) same = text(made[i]) == text(known[i]);
      if (!same) throw BadInput("it was made of another result, or with other options");
      CheckShard shard;
      std::vector<ShareFindings> found = read_findings(stream, whole.surface, shard);
      const long long most = 2 + static_cast<long long>(whole.surface.tris.size()) +
                             static_cast<long long>(whole.need("ref_face", "mlift").rows);
      if (all.empty() && shard.all > 0 && shard.all <= most) all.resize(shard.all), from.resize(shard.all);
      if (shard.all != static_cast<int>(all.size())) throw BadInput("the check was cut otherwise");
      for (std::size_t i = 0; i < found.size(); ++i) {
        const int number = shard.numbers[i];
        expect_row(number, shard.all, "share");
        if (from[number])
          throw BadInput("share " + std::to_string(number) + " is in " + *from[number] + ", too");
        from[number] = &name;
        all[number] = std::move(found[i]);
      }
    } catch (const BadInput& e) {
      throw BadInput(name + ": " + e.what());
    } catch (const NotAdmissible& e) {
      throw BadInput(name + ": " + e.what());
    }
  for (std::size_t i = 0; i < from.size(); ++i)
    if (!from[i])
      throw BadInput("share " + std::to_string(i) + " of " + std::to_string(from.size()) + " is in no shard");
  return all;
}

}  // namespace meshpipe
