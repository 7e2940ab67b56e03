// SPDX-License-Identifier: BSD-3-Clause
#include "formats/obj.h"

#include <algorithm>
#include <limits>
#include <set>
#include <unordered_map>

#include "formats/colors.h"
#include "formats/model_lines.h"
#include "formats/polygons.h"
#include "formats/text.h"

namespace meshpipe {
namespace {

/// One way in which an OBJ file sorts its faces: names by number, and the number of each face; 0 is none.
struct Sorting {
  std::vector<std::string> names;
  std::unordered_map<std::string, int> number;
  std::vector<int> of_face;
  int current = 0;

  void enter(std::string_view name) {
    if (name.empty()) name = "default";
    auto [at, is_new] = number.try_emplace(std::string(name), static_cast<int>(names.size()) + 1);
    if (is_new) names.push_back(at->first);
    current = at->second;
  }
  bool tells_apart() const {
    return std::any_of(of_face.begin(), of_face.end(), [&](int k) { return k != of_face[0]; });
  }
  bool names_any() const {
    return std::any_of(of_face.begin(), of_face.end(), [](int k) { return k != 0; });
  }
};

/// The number of "patch_NUMBER", positive and as it would be written.
bool patch_number(std::string_view name, long long& number) {
  return name.starts_with("patch_") && parse_integer(name.substr(6), number) && number > 0 &&
         number < std::numeric_limits<int>::max() && name == "patch_" + std::to_string(number);
}

/// The vertex number of a corner, from 0 on.
int corner(const Text& text, long long v, std::size_t n_vertices) {
  if (v == 0) text.fail("vertex 0, but vertices are counted from 1");
  if (v < -static_cast<long long>(n_vertices))
    text.fail("a face uses vertex " + std::to_string(v) + ", but there are " + std::to_string(n_vertices) +
              " before it");
  if (v > std::numeric_limits<int>::max())
    text.fail("a face uses vertex " + std::to_string(v) + ", beyond the largest, " +
              std::to_string(std::numeric_limits<int>::max()));
  return static_cast<int>(v < 0 ? static_cast<long long>(n_vertices) + v : v - 1);
}

}  // namespace

bool is_obj(std::string_view bytes) {
  static constexpr const char* keywords[] = {"v", "vt", "vn", "vp", "f",      "l",
                                             "p", "g",  "o",  "s",  "usemtl", "mtllib"};
  Text text(bytes, "", '#');
  if (!text.next_line()) return false;
  std::string_view w = text.word();
  return std::any_of(std::begin(keywords), std::end(keywords), [&](const char* k) { return w == k; });
}

Stream read_obj(std::string_view bytes, const std::string& where) {
  Text text(bytes, where, '#');
  Stream stream;
  std::vector<Vec3>& points = stream.surface.points;
  Polygons polygons;
  Sorting groups, objects, materials;
  Colors colors;  // an extension: r g b after x y z
  std::vector<double> after_point;
  int largest = -1;  // a face may use vertices that come after it
  std::size_t largest_line = 0;
  std::vector<LineEdge> lines;
  auto next_corner = [&](int& v) {  // "v", "v/vt", "v//vn" or "v/vt/vn"; false at the end of the line
    int small;
    long long number;
    if (text.leading_integer(small)) {
      number = small;
    } else {
      std::string_view w = text.word();
      while (w == "\\" && text.line_ends()) {
        text.need_line("the rest of a face");
        w = text.word();
      }
      if (w.empty()) return false;
      if (!parse_integer(w.substr(0, w.find('/')), number)) text.fail(quoted(w) + " where a corner is due");
    }
    v = corner(text, number, points.size());
    if (v > largest) {
      largest = v;
      largest_line = text.line();
    }
    return true;
  };
  while (text.next_line()) {
    std::string_view w = text.word();
    if (w == "v") {
      points.push_back(text.point());
      if (!text.line_ends()) {
        std::vector<double>& c = after_point;
        for (c.clear(); !text.line_ends();) c.push_back(text.number("a colour"));
        colors.add(c.data(), c.size(),
                   c.size() == 3 && std::any_of(c.begin(), c.end(), [](double x) { return x > 1; }));
      }
    } else if (w == "f") {
      const std::size_t first = polygons.corners.size();
      for (int v; next_corner(v);) {
        polygons.corners.push_back(v);
        if (polygons.corners.size() - first > max_corners)
          text.fail("a face of more than " + std::to_string(max_corners) + " corners, which is the limit");
      }
      if (polygons.corners.size() - first < 3)
        text.fail("a face of " + std::to_string(polygons.corners.size() - first) +
                  " corners, at least 3 are due");
      polygons.ends.push_back(polygons.corners.size());
      for (Sorting* s : {&groups, &objects, &materials}) s->of_face.push_back(s->current);
    } else if (w == "l") {
      int a, b;
      if (!next_corner(a)) text.fail("a line of 0 points, at least 2 are due");
      if (!next_corner(b)) text.fail("a line of 1 point, at least 2 are due");
      do lines.push_back({a, b, 0});
      while (a = b, next_corner(b));
    } else if (w == "g") {
      groups.enter(text.rest());
    } else if (w == "o") {
      objects.enter(text.rest());
    } else if (w == "usemtl") {
      materials.enter(text.rest());
    }
  }
  // the format has no mark of its own: a file without a face is hardly meant as one
  if (polygons.ends.empty()) text.fail("the file ends without a face");
  if (largest >= static_cast<int>(points.size()))
    text.fail_at(largest_line, "a face or line uses vertex " + std::to_string(largest + 1) +
                                   ", but there are " + std::to_string(points.size()));

  Sorting* const sortings[] = {&groups, &objects, &materials};
  auto chosen =
      std::find_if(std::begin(sortings), std::end(sortings), [](Sorting* s) { return s->tells_apart(); });
  if (chosen == std::end(sortings))
    chosen =
        std::find_if(std::begin(sortings), std::end(sortings), [](Sorting* s) { return s->names_any(); });
  if (chosen == std::end(sortings)) chosen = std::begin(sortings);
  // names no face has are left out; patch_7, as written for a patch without a name, keeps its number, the
  // others are numbered in the order of the faces
  std::vector<int> tag((*chosen)->names.size() + 1, 0);
  std::set<int> taken;
  for (const int k : (*chosen)->of_face)
    if (long long number = 0; k != 0 && tag[k] == 0 && patch_number((*chosen)->names[k - 1], number) &&
                              taken.insert(static_cast<int>(number)).second)
      tag[k] = static_cast<int>(number);
  std::vector<char> named(tag.size(), 0);
  int last = 0;
  for (int& k : (*chosen)->of_face) {
    if (k != 0 && !named[k]) {
      named[k] = 1;
      if (tag[k] == 0) {
        do ++last;
        while (taken.count(last));
        tag[k] = last;
      }
      stream.names.push_back({2, tag[k], (*chosen)->names[k - 1]});
    }
    k = tag[k];
  }
  polygons.patch = std::move((*chosen)->of_face);
  colors.give(stream, stream.surface.vertex, points.size());
  set_faces(stream, polygons);
  set_model_lines(stream, lines);
  return stream;
}

std::string write_obj(const Stream& stream, bool) {
  const Surface& s = stream.surface;
  const ByPatch by = by_patch(stream);
  std::string out;
  out.reserve(s.points.size() * 60 + s.tris.size() * 24);
  const Rgb colors(s.vertex);
  for (std::size_t v = 0; v < s.points.size(); ++v) {
    append_point(out, "v ", s.points[v]);
    if (!colors) continue;
    out.pop_back();
    colors.append_to(out, v, false);
    out += '\n';
  }
  for (std::size_t k = 0; k < by.tags.size(); ++k) {
    std::string name = one_line(stream.name_of(2, by.tags[k]));
    if (!name.empty())
      out += "g " + name + '\n';
    else if (by.tags.size() > 1)
      out += "g patch_" + std::to_string(by.tags[k]) + '\n';
    for (std::size_t i = by.first[k]; i < by.first[k + 1]; ++i) {
      out += 'f';
      for (int v : s.tris[by.order[i]]) {
        out += ' ';
        append(out, static_cast<long long>(v) + 1);
      }
      out += '\n';
    }
  }
  return out;
}

}  // namespace meshpipe
