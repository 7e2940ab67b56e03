// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/size_table.h"

#include <algorithm>

#include "formats/text.h"
#include "lib/core/error.h"
#include "lib/core/number.h"

namespace meshpipe {
namespace {

/// Returns the words of a line, separated by blanks, commas or semicolons.
std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t i = 0; i < line.size();) {
    const std::size_t begin = line.find_first_not_of(" \t\r,;", i);
    if (begin == std::string_view::npos) break;
    i = std::min(line.find_first_of(" \t\r,;", begin), line.size());
    words.push_back(line.substr(begin, i - begin));
  }
  return words;
}

bool is_row(const std::vector<std::string_view>& words) {
  double value;
  return words.size() >= 4 && std::all_of(words.begin(), words.begin() + 4,
                                          [&](std::string_view w) { return parse_number(w, value); });
}

/// Returns whether a line names the columns.
bool names_only(const std::vector<std::string_view>& words) {
  double value;
  return std::none_of(words.begin(), words.end(), [&](std::string_view w) { return parse_number(w, value); });
}

const Column* column_of(const Table& table, const std::string& name, const std::string& where) {
  std::string known;
  const Column* only = nullptr;
  for (const Column& c : table.columns) {
    known += (known.empty() ? "" : ", ") + c.name;
    only = &c;
  }
  if (!name.empty()) {
    if (const Column* c = table.find(name)) return c;
    throw BadInput(where + ": no vertex data '" + name + "'; there is " + (known.empty() ? "none" : known));
  }
  for (const char* usual : {"size", "h"})
    if (const Column* c = table.find(usual)) return c;
  if (table.columns.size() != 1)
    throw BadInput(where + ": expected vertex data 'size' or 'h' or only one, found " +
                   (known.empty() ? "none" : known) + "; name it as FILE:NAME");
  return only;
}

}  // namespace

SizeField size_field_of(const Stream& mesh, const std::string& column, const std::string& where) {
  SizeField field;
  field.points = mesh.surface.points;
  field.tris = mesh.surface.tris;
  const Column* c = column_of(mesh.surface.vertex, column, where);
  std::visit([&](const auto& v) { field.size.assign(v.begin(), v.end()); }, c->data);
  for (std::size_t v = 0; v < field.size.size(); ++v)
    if (!(field.size[v] > 0))
      throw BadInput(where + ": vertex " + std::to_string(v) + " has " + c->name + ' ' +
                     shown(field.size[v]) + ", but sizes are positive");
  if (field.points.empty()) throw BadInput(where + ": no vertices");
  add_lone_points(field);
  return field;
}

bool is_size_table(std::string_view bytes) {
  Text text(bytes, "", '#');
  return text.next_line() &&
         (is_row(words_of(text.rest())) || (text.next_line() && is_row(words_of(text.rest()))));
}

SizeField read_size_table(std::string_view bytes, const std::string& column, const std::string& where) {
  Text text(bytes, where, '#');
  SizeField field;
  if (!column.empty()) {
    text.next_line();
    const std::vector<std::string_view> names = words_of(text.rest());
    const std::string known = names_only(names) && names.size() == 4 ? std::string(names[3]) : "none";
    if (known != column) text.fail("no column '" + column + "' of sizes; there is " + known);
  }
  for (bool first = true; text.next_line(); first = false) {
    const std::vector<std::string_view> words = words_of(text.rest());
    if (words.empty() || (first && names_only(words))) continue;
    if (words.size() != 4) text.fail("expected the 4 values x y z h, found " + std::to_string(words.size()));
    double x[4];
    for (int i = 0; i < 4; ++i)
      if (!parse_number(words[i], x[i])) text.fail("expected a number, found " + quoted(words[i]));
    if (!(x[3] > 0)) text.fail("size " + shown(x[3]) + ", but sizes are positive");
    field.points.push_back({x[0], x[1], x[2]});
    field.size.push_back(x[3]);
  }
  if (field.points.empty()) text.fail("no row of x y z h");
  add_lone_points(field);
  return field;
}

}  // namespace meshpipe
