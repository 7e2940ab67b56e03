// SPDX-License-Identifier: BSD-3-Clause
#include "formats/size_field.h"

#include <algorithm>
#include <cmath>

#include "formats/text.h"
#include "lib/error.h"
#include "lib/number.h"

namespace meshpipe {
namespace {

/// Words of a line of a table; blanks, commas and semicolons part them.
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

/// Is it a line of names above the columns?
bool names_only(const std::vector<std::string_view>& words) {
  double value;
  return std::none_of(words.begin(), words.end(), [&](std::string_view w) { return parse_number(w, value); });
}

/// Points that no triangle holds become triangles of their own.
void complete(SizeField& field) {
  std::vector<char> used(field.points.size(), 0);
  for (const Tri& t : field.tris)
    for (int v : t) used[v] = 1;
  for (int v = 0; v < static_cast<int>(used.size()); ++v)
    if (!used[v]) field.tris.push_back({v, v, v});
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
    throw BadInput(where + ": which vertex data is the size? " +
                   (known.empty() ? "there is none" : "there is " + known));
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
  complete(field);
  return field;
}

bool is_size_table(std::string_view bytes) {
  Text text(bytes, "", '#');
  return text.next_line() &&
         (is_row(words_of(text.rest())) || (text.next_line() && is_row(words_of(text.rest()))));
}

SizeField read_size_table(std::string_view bytes, const std::string& where) {
  Text text(bytes, where, '#');
  SizeField field;
  for (bool first = true; text.next_line(); first = false) {
    const std::vector<std::string_view> words = words_of(text.rest());
    if (words.empty() || (first && names_only(words))) continue;
    if (words.size() != 4)
      text.fail("a row of " + std::to_string(words.size()) + " values, the 4 of x y z h are due");
    double x[4];
    for (int i = 0; i < 4; ++i)
      if (!parse_number(words[i], x[i])) text.fail("no number: " + quoted(words[i]));
    if (!(x[3] > 0)) text.fail("size " + shown(x[3]) + ", but sizes are positive");
    field.points.push_back({x[0], x[1], x[2]});
    field.size.push_back(x[3]);
  }
  if (field.points.empty()) text.fail("no row of x y z h");
  complete(field);
  return field;
}

double size_near(const SizeField& field, const Bvh& tree, Vec3 p) {
  constexpr double equally = 0.1;  // of the size
  auto size_at = [&](int t, double b0, double b1, double b2) {
    const Tri& v = field.tris[t];
    return b0 * field.size[v[0]] + b1 * field.size[v[1]] + b2 * field.size[v[2]];
  };
  const Bvh::Hit hit = tree.nearest(p);
  const double nearest = size_at(hit.place.face, hit.place.b0, hit.place.b1, hit.place.b2);
  double least = nearest;
  const double reach = hit.distance + equally * nearest;
  tree.overlapping({p - Vec3{reach, reach, reach}, p + Vec3{reach, reach, reach}}, [&](int t) {
    const Vec3 a = field.points[field.tris[t][0]], b = field.points[field.tris[t][1]],
               c = field.points[field.tris[t][2]];
    const auto w = closest_on_triangle(p, a, b, c);
    if (norm(w[0] * a + w[1] * b + w[2] * c - p) <= reach)
      least = std::min(least, size_at(t, w[0], w[1], w[2]));
  });
  return least;
}

}  // namespace meshpipe
