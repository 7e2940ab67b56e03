// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/columns.h"

#include <algorithm>
#include <cmath>

#include "formats/text.h"

namespace meshpipe {
namespace {

/// Limit of columns, whose names are searched linearly.
constexpr std::size_t max_columns = 5000;
constexpr const char* channels[] = {"red", "green", "blue"};

bool is_one_of(std::string_view name, std::initializer_list<const char*> names) {
  return std::any_of(names.begin(), names.end(), [&](const char* n) { return name == n; });
}

/// Gives a column that the stream specifies its type, if the values allow.
void give_known_type(Column& column) {
  const bool small = is_one_of(column.name, {"model", "red", "green", "blue", "corner", "required"});
  std::vector<int> whole;
  if (is_one_of(column.name, {"size", "b1", "b2"})) {
    std::visit([&](const auto& v) { column.data = std::vector<double>(v.begin(), v.end()); },
               Data(column.data));
  } else if ((small || is_one_of(column.name, {"part", "origin", "ref_face", "kind", "line", "ref"})) &&
             whole_numbers(column.data, whole)) {
    if (small && std::all_of(whole.begin(), whole.end(), [](int v) { return v >= 0 && v < 256; }))
      column.data = std::vector<std::uint8_t>(whole.begin(), whole.end());
    else
      column.data = std::move(whole);
  }
}

bool is_taken(const Table& table, const std::string& name) {
  // what the mesh itself holds has no column
  if (table.name == "vertex" && is_one_of(name, {"x", "y", "z"})) return true;
  if (table.name == "face" && is_one_of(name, {"vertex_indices", "patch"})) return true;
  return table.has(name);
}

/// Returns `start` and the first number from 2 on that no column has after it.
std::string first_free(const Table& table, const std::string& start) {
  std::vector<char> taken(table.columns.size() + 3, false);
  for (const Column& c : table.columns)
    if (long long k; c.name.starts_with(start) && c.name[start.size()] != '0' &&
                     parse_integer(std::string_view(c.name).substr(start.size()), k) && k >= 2 &&
                     k < static_cast<long long>(taken.size()))
      taken[static_cast<std::size_t>(k)] = true;
  return start + std::to_string(std::find(taken.begin() + 2, taken.end(), false) - taken.begin());
}

void add(Table& table, std::size_t rows, Column column) {
  give_known_type(column);
  if (is_taken(table, column.name)) column.name = first_free(table, column.name + '_');
  table.rows = rows;
  table.columns.push_back(std::move(column));
}

/// Returns "NAME" for "NAME.k", or nothing if the name does not end in .k.
std::string_view stem(const std::string& name, std::size_t k) {
  const std::string end = '.' + std::to_string(k);
  return name.size() > end.size() && name.ends_with(end)
             ? std::string_view(name).substr(0, name.size() - end.size())
             : std::string_view();
}

}  // namespace

bool whole_numbers(const Data& data, std::vector<int>& out) {
  if (const auto* ints = std::get_if<std::vector<int>>(&data)) {
    out = *ints;
    return true;
  }
  return std::visit(
      [&](const auto& v) {
        for (auto x : v)
          if (!(std::abs(static_cast<double>(x)) <= std::numeric_limits<int>::max()) ||
              static_cast<int>(x) != x)
            return false;
        out.assign(v.begin(), v.end());
        return true;
      },
      data);
}

Array gather(const Array& array, const std::vector<int>& row) {
  Array out{array.name, array.components, {}};
  std::visit(
      [&](const auto& v) {
        std::decay_t<decltype(v)> w;
        w.reserve(row.size() * array.components);
        for (int r : row) {
          const auto first = v.begin() + static_cast<std::ptrdiff_t>(r) * array.components;
          w.insert(w.end(), first, first + array.components);
        }
        out.data = std::move(w);
      },
      array.data);
  return out;
}

void leave_out(Stream& stream, const Table& table, std::string_view name, const std::string& why) {
  stream.remarks.push_back("left out: " + table.name + " data " + percent_encode(name.substr(0, 100)) + ", " +
                           why);
}

void add_columns(Stream& stream, Table& table, std::size_t rows, Array array) {
  if (table.columns.size() + static_cast<std::size_t>(array.components) > max_columns) {
    const std::string remark =
        "left out: " + table.name + " data beyond " + std::to_string(max_columns) + " columns";
    if (stream.remarks.empty() || stream.remarks.back() != remark) stream.remarks.push_back(remark);
    return;
  }
  if (const auto* reals = std::get_if<std::vector<double>>(&array.data)) {
    const auto bad = std::find_if(reals->begin(), reals->end(), [](double x) { return !std::isfinite(x); });
    if (bad != reals->end()) {
      const auto row = (bad - reals->begin()) / array.components;
      return leave_out(stream, table, array.name, "not finite in row " + std::to_string(row));
    }
  }
  std::string name = percent_encode(trim(array.name.substr(0, 100)));
  if (name.empty()) name = "unnamed";
  if (array.components == 1) return add(table, rows, {name, std::move(array.data)});
  const bool color = name == "color" && array.components == 3 && array.data.index() == 0;
  for (int k = 0; k < array.components; ++k) {
    Column c{color ? channels[k] : name + '.' + std::to_string(k), {}};
    std::visit(
        [&](const auto& v) {
          std::decay_t<decltype(v)> w(rows);
          for (std::size_t r = 0; r < rows; ++r) w[r] = v[r * array.components + k];
          c.data = std::move(w);
        },
        array.data);
    add(table, rows, std::move(c));
  }
}

std::vector<Group> groups_of(const Table& table) {
  std::vector<Group> groups;
  const std::vector<Column>& all = table.columns;
  for (std::size_t i = 0; i < all.size();) {
    Group group{all[i].name, {&all[i]}};
    auto same_type = [&](std::size_t k) {
      return i + k < all.size() && all[i + k].data.index() == all[i].data.index();
    };
    if (all[i].name == "red" && all[i].data.index() == 0 && same_type(1) && same_type(2) &&
        all[i + 1].name == "green" && all[i + 2].name == "blue") {
      group = {"color", {&all[i], &all[i + 1], &all[i + 2]}};
    } else if (const std::string_view name = stem(all[i].name, 0);
               !name.empty() && same_type(1) && stem(all[i + 1].name, 1) == name) {
      group.name = name;
      for (std::size_t k = 1; same_type(k) && stem(all[i + k].name, k) == name; ++k)
        group.columns.push_back(&all[i + k]);
    }
    i += group.columns.size();
    group.name = percent_decode(group.name);
    groups.push_back(std::move(group));
  }
  return groups;
}

Array array_of(const Group& group) {
  const int n = static_cast<int>(group.columns.size());
  Array out{group.name, n, group.columns[0]->data};
  if (n == 1) return out;
  std::visit(
      [&](auto& all) {
        const std::size_t rows = all.size();
        all.resize(rows * n);
        for (int k = 0; k < n; ++k) {
          const auto& v = std::get<std::decay_t<decltype(all)>>(group.columns[k]->data);
          for (std::size_t r = 0; r < rows; ++r) all[r * n + k] = v[r];
        }
      },
      out.data);
  return out;
}

}  // namespace meshpipe
