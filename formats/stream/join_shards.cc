// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "formats/stream/shards.h"
#include "formats/stream/stages.h"
#include "lib/core/error.h"

namespace meshpipe {
namespace {

/// What is left of a shard once it has been read.
struct Taken {
  std::string name;
  ShardNumbers numbers;
  std::vector<Table> tables;
  const Table* find(std::string_view name) const {
    for (const Table& t : tables)
      if (t.name == name) return &t;
    return nullptr;
  }
  const Table& table(std::string_view name) const {
    if (const Table* found = find(name)) return *found;
    throw BadInput(this->name + ": there is no table '" + std::string(name) + "', but other shards have it");
  }
  template <class T>
  const std::vector<T>& column(std::string_view of_table, const std::string& column) const {
    try {
      return table(of_table).get<T>(column);
    } catch (const NotAdmissible& e) {
      throw BadInput(name + ": " + e.what() + ", but other shards have it");
    }
  }
};

/// The shard that has a part, and the part's number there.
struct Home {
  int shard = -1, part = -1;
};

/// Throws: BadInput if the shard has other parts or lines than the numbers cut out of the whole.
void expect_cut_from(const Stream& whole, const Stream& shard, const ShardNumbers& n) {
  const Table &all = whole.need("part", "mpartition"), &some = shard.need("part", "mpartition");
  auto same = [&]<class T>(const char* column) {
    if (!all.has(column)) return true;
    const auto &a = all.get<T>(column), &b = some.get<T>(column);
    for (std::size_t i = 0; i < b.size(); ++i)
      if (b[i] != a[n.parts[i]]) return false;
    return true;
  };
  const Table* points = shard.find("line_vertex");
  if (!same.operator()<int>("faces") || !same.operator()<double>("area") ||
      (points && points->rows != n.line_points.size()))
    throw BadInput("the surface or the lines are not those of these parts of the whole");
}

/// Checks a shard, and takes the tables that its program has made.
Taken take_shard(const Stream& whole, const std::string& name, Stream shard, const Provenance& by) {
  const int n_parts = static_cast<int>(whole.need("part", "mpartition").rows);
  const std::vector<int>& parts = shard.need("shard", "mshard").get<int>("part");
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (const int least = i ? parts[i - 1] + 1 : 0; parts[i] < least)
      throw BadInput("row " + std::to_string(i) + " of table 'shard': expected a part of at least " +
                     std::to_string(least) + ", found " + std::to_string(parts[i]));
    if (parts[i] >= n_parts)
      throw BadInput("expected a shard of this stream, whose parts are 0 to " + std::to_string(n_parts - 1) +
                     ", found part " + std::to_string(parts[i]));
  }
  if (const std::size_t rows = shard.need("part", "mpartition").rows; rows != parts.size())
    throw BadInput("there are " + std::to_string(rows) + " parts, but " + std::to_string(parts.size()) +
                   " were cut out of the whole");
  expect_made_of(whole, shard.history, by);
  Taken taken{name, number_shard(whole, parts), {}};
  expect_cut_from(whole, shard, taken.numbers);
  if (shard.find("chart_point")) shard.need("line_vertex", "mlines");  // which its rows point to
  taken.tables = std::move(shard.tables);
  return taken;
}

/// Returns the first row of each part in a table sorted by part, and one more.
std::vector<int> first_rows(const Taken& shard, const char* table) {
  const auto& part = shard.column<int>(table, "part");
  if (!std::is_sorted(part.begin(), part.end()))
    throw BadInput(shard.name + ": rows of " + table + " are not in the order of parts");
  std::vector<int> first;
  for (int p = 0; p <= static_cast<int>(shard.numbers.parts.size()); ++p)
    first.push_back(static_cast<int>(std::lower_bound(part.begin(), part.end(), p) - part.begin()));
  return first;
}

/// Puts a table of the shards together, by parts of the whole.
class Merged {
 public:
  Merged(const char* name, const std::vector<Taken>& taken, const std::vector<Home>& homes)
      : name_(name), taken_(taken), homes_(homes) {
    for (const Taken& t : taken) rows_.push_back(first_rows(t, name));
    for (const Home& h : homes) first_.push_back(first_.back() + end(h) - begin(h));
  }
  int begin(const Home& h) const { return rows_[h.shard][h.part]; }
  int end(const Home& h) const { return rows_[h.shard][h.part + 1]; }
  /// Returns the number of a row of a part of the whole, by that in its shard.
  int number(int part, int row) const { return first_[part] + row - begin(homes_[part]); }

  /// Returns the table; `points`: the table of which columns a, b and c have rows.
  Table table(const Merged* points = nullptr) const {
    Table out{name_, 0, {}};
    for (const Column& like : taken_[0].table(name_).columns)
      std::visit(
          [&]<class T>(const std::vector<T>&) {
            std::vector<T> values;
            values.reserve(first_.back());
            for (int p = 0; p < static_cast<int>(homes_.size()); ++p) {
              const Home& h = homes_[p];
              const std::vector<T>& from = taken_[h.shard].template column<T>(name_, like.name);
              const std::size_t start = values.size();
              values.insert(values.end(), from.begin() + begin(h), from.begin() + end(h));
              if constexpr (std::is_same_v<T, int>)
                for (std::size_t i = start; i < values.size(); ++i)
                  values[i] = of_whole(like.name, p, values[i], points);
            }
            out.set(like.name, std::move(values));
          },
          like.data);
    return out;
  }

 private:
  int of_whole(const std::string& column, int part, int row, const Merged* points) const {
    const ShardNumbers& n = taken_[homes_[part].shard].numbers;
    if (column == "part") return part;
    if (row < 0) return row;
    const auto* of = column == "vertex"        ? &n.vertices
                     : column == "face"        ? &n.faces
                     : column == "line_vertex" ? &n.line_points
                                               : nullptr;
    if (!of) return points ? points->number(part, row) : row;
    if (row >= static_cast<int>(of->size()))
      throw BadInput(taken_[homes_[part].shard].name + ": " + name_ + " has " + column + ' ' +
                     std::to_string(row) + ", but its parts have " + std::to_string(of->size()));
    return (*of)[row];
  }
  const char* name_;
  const std::vector<Taken>& taken_;
  const std::vector<Home>& homes_;
  std::vector<std::vector<int>> rows_;  // per shard
  std::vector<int> first_{0};           // per part of the whole
};

/// Returns the rows of table `part` as the shards have them.
Table joined_parts(const std::vector<Taken>& taken, std::size_t n_parts) {
  Table out{"part", n_parts, {}};
  for (const Column& like : taken[0].table("part").columns)
    std::visit(
        [&]<class T>(const std::vector<T>&) {
          std::vector<T> values(n_parts);
          for (const Taken& t : taken) {
            const std::vector<T>& from = t.template column<T>("part", like.name);
            for (std::size_t p = 0; p < from.size(); ++p) values[t.numbers.parts[p]] = from[p];
          }
          out.set(like.name, std::move(values));
        },
        like.data);
  return out;
}

}  // namespace

void expect_made_of(const Stream& whole, const std::vector<Provenance>& made, const Provenance& by) {
  auto text = [](const Provenance& p) {  // --accept changes only what becomes of a failure
    std::string words = p.program + (p.arguments.empty() ? "" : ' ' + p.arguments) + ' ';
    if (const std::size_t at = words.find(" --accept "); at != words.npos) words.erase(at, 9);
    words.pop_back();
    return words;
  };
  const std::vector<Provenance>& known = whole.history;
  if (made.size() <= known.size()) throw BadInput("no program has run on the shard");
  if (text(made.back()) != text(by))
    throw BadInput("it was made by '" + text(made.back()) + "', not by '" + text(by) + "'");
  if (!std::equal(known.begin(), known.end(), made.begin(), made.end() - 1,
                  [&](const Provenance& a, const Provenance& b) { return text(a) == text(b); }))
    throw BadInput("it was made of another stream");
}

void keep_made(Stream& shard, std::initializer_list<std::string_view> tables) {
  shard.surface = {};
  std::erase_if(shard.tables, [&](const Table& t) {
    return t.name != "shard" && t.name != "part" &&
           std::find(tables.begin(), tables.end(), t.name) == tables.end();
  });
}

void of_shard(const std::string& name, const std::function<void()>& take) {
  try {
    take();
  } catch (const BadInput& e) {
    throw BadInput(name + ": " + e.what());
  } catch (const NotAdmissible& e) {
    throw BadInput(name + ": " + e.what());
  }
}

void join_shards(Stream& whole, const std::vector<std::string>& names, const Provenance& by,
                 const std::function<Stream(const std::string&)>& read) {
  std::vector<Taken> taken;
  std::vector<Home> homes(whole.need("part", "mpartition").rows);
  for (const std::string& name : names) {
    Stream shard = read(name);
    of_shard(name, [&] { taken.push_back(take_shard(whole, name, std::move(shard), by)); });
    const std::vector<int>& parts = taken.back().numbers.parts;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (homes[parts[i]].shard >= 0)
        throw BadInput(name + ": part " + std::to_string(parts[i]) + " is in " +
                       names[homes[parts[i]].shard] + ", too");
      homes[parts[i]] = {static_cast<int>(taken.size()) - 1, static_cast<int>(i)};
    }
  }
  for (std::size_t p = 0; p < homes.size(); ++p)
    if (homes[p].shard < 0)
      throw BadInput("part " + std::to_string(p) + " of " + std::to_string(homes.size()) + " is in no shard");
  if (taken[0].find("chart_point")) {
    const Merged points("chart_point", taken, homes), faces("chart_face", taken, homes);
    whole.set(points.table());
    whole.set(faces.table(&points));
    return;
  }
  const Merged charts("chart_vertex", taken, homes);
  drop_downstream(whole, Stage::charts);
  whole.set(joined_parts(taken, homes.size()));
  whole.set(charts.table());
}

}  // namespace meshpipe
