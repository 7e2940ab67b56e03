// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream.h"

#include <algorithm>
#include <cmath>

#include "formats/stream/elements.h"
#include "lib/core/error.h"
#include "lib/core/number.h"

namespace meshpipe {

std::vector<std::string_view> words(std::string_view line) {
  std::vector<std::string_view> out;
  for (std::size_t i = 0; i < line.size();) {
    if (line[i] == ' ') {
      ++i;
      continue;
    }
    std::size_t j = std::min(line.find(' ', i), line.size());
    out.push_back(line.substr(i, j - i));
    i = j;
  }
  return out;
}

const Table* Stream::find(std::string_view table) const {
  for (const Table& t : tables)
    if (t.name == table) return &t;
  return nullptr;
}

const Table& Stream::need(std::string_view table, std::string_view writer) const {
  const Table* t = find(table);
  if (!t)
    throw NotAdmissible("no section '" + std::string(table) + "'; run " + std::string(writer) + " first");
  return *t;
}

void Stream::set(Table table) {
  for (Table& t : tables)
    if (t.name == table.name) {
      t = std::move(table);
      return;
    }
  tables.push_back(std::move(table));
}

void Stream::erase(std::string_view table) {
  std::erase_if(tables, [&](const Table& t) { return t.name == table; });
}

std::string Stream::name_of(int dim, int tag) const {
  for (const Name& n : names)
    if (n.dim == dim && n.tag == tag) return n.text;
  return {};
}

bool is_length(std::string_view column) {
  constexpr std::string_view names[] = {"x",  "y",  "z",    "xa",     "ya",        "za",  "xb",
                                        "yb", "zb", "size", "radius", "thickness", "gap", "layers"};
  return std::find(std::begin(names), std::end(names), column) != std::end(names);
}

void change_unit(Stream& stream, int unit) {
  const int by = stream.unit - unit;
  if (by == 0) return;
  auto changed = [&](double value) {
    const double now = std::ldexp(value, by);
    if (!std::isfinite(now))
      throw NotAdmissible("a length of " + shown(value) + " where coordinates are below 2^" +
                          std::to_string(unit) + ": no unit holds both");
    return now;
  };
  auto scale = [&](Table& table) {
    for (Column& column : table.columns)
      if (auto* lengths = std::get_if<std::vector<double>>(&column.data); lengths && is_length(column.name))
        for (double& value : *lengths) value = changed(value);
  };
  for (Vec3& p : stream.surface.points) p = {changed(p.x), changed(p.y), changed(p.z)};
  scale(stream.surface.vertex);
  for (Table& table : stream.tables) scale(table);
  stream.unit = unit;
}

bool is_stream(std::string_view bytes) {
  if (bytes.starts_with("mply-failed ")) return true;
  if (!bytes.starts_with("ply\n")) return false;
  std::size_t second = bytes.find('\n', 4);
  return second != std::string_view::npos && bytes.substr(second + 1).starts_with("comment mply ");
}

}  // namespace meshpipe
