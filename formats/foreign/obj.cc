// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/obj.h"

#include <algorithm>
#include <limits>
#include <set>
#include <unordered_map>

#include "formats/foreign/colors.h"
#include "formats/foreign/polygons.h"
#include "formats/stream/model_lines.h"
#include "formats/text.h"

namespace meshpipe {
namespace {

/// One way in which an OBJ file groups its faces: the names, and the number of each face's name (0: none).
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
  bool distinguishes() const {
    return std::any_of(of_face.begin(), of_face.end(), [&](int k) { return k != of_face[0]; });
  }
  bool names_any() const {
    return std::any_of(of_face.begin(), of_face.end(), [](int k) { return k != 0; });
  }
};

/// Returns whether a name is "patch_NUMBER", the number positive and as it would be written.
bool patch_number(std::string_view name, long long& number) {
  return name.starts_with("patch_") && parse_integer(name.substr(6), number) && number > 0 &&
         number < std::numeric_limits<int>::max() && name == "patch_" + std::to_string(number);
}

class ObjReader {
 public:
  ObjReader(std::string_view bytes, const std::string& where) : text_(bytes, where, '#') {}

  Stream read();

 private:
  bool next_corner(int& v);
  int vertex(long long v) const;
  void point();
  void face();
  void line();
  Sorting& chosen_sorting();
  void set_patches(Sorting& sorting);

  Text text_;
  Stream stream_;
  Polygons polygons_;
  Sorting groups_, objects_, materials_;
  Colors colors_;  ///< an extension: r g b after x y z
  std::vector<double> numbers_;
  std::vector<LineEdge> lines_;
  int largest_ = -1;  ///< vertex number, and its line: a face may use vertices that come after it
  std::size_t largest_line_ = 0;
};

Stream ObjReader::read() {
  while (text_.next_line()) {
    const std::string_view w = text_.word();
    if (w == "v")
      point();
    else if (w == "f")
      face();
    else if (w == "l")
      line();
    else if (w == "g")
      groups_.enter(text_.rest(true));
    else if (w == "o")
      objects_.enter(text_.rest(true));
    else if (w == "usemtl")
      materials_.enter(text_.rest(true));
  }
  // the format has no mark of its own: a file without a face or line is probably another one
  if (polygons_.ends.empty() && lines_.empty()) text_.fail("the file ends without a face");
  const std::size_t n = stream_.surface.points.size();
  if (largest_ >= static_cast<int>(n))
    text_.fail_at(largest_line_, "a face or line uses vertex " + std::to_string(largest_ + 1LL) +
                                     ", but there are " + std::to_string(n));
  set_patches(chosen_sorting());
  colors_.give(stream_, stream_.surface.vertex, n);
  set_faces(stream_, polygons_);
  set_model_lines(stream_, lines_);
  return std::move(stream_);
}

/// Takes "v", "v/vt", "v//vn" or "v/vt/vn"; returns false at the end of the line.
bool ObjReader::next_corner(int& v) {
  int small;
  long long number;
  if (text_.leading_integer(small)) {
    number = small;
  } else {
    std::string_view w = text_.word();
    while (w == "\\" && text_.line_ends()) {
      text_.need_line("the rest of a face");
      w = text_.word();
    }
    if (w.empty()) return false;
    if (!parse_integer(w.substr(0, w.find('/')), number)) text_.fail("expected a corner, found " + quoted(w));
  }
  v = vertex(number);
  if (v > largest_) {
    largest_ = v;
    largest_line_ = text_.line();
  }
  return true;
}

/// Returns the row of a vertex number, which counts from 1, or back from the last vertex if it is negative.
int ObjReader::vertex(long long v) const {
  const auto n = static_cast<long long>(stream_.surface.points.size());
  if (v == 0) text_.fail("vertex 0, but vertices are counted from 1");
  if (v < -n)
    text_.fail("a face uses vertex " + std::to_string(v) + ", but there are " + std::to_string(n) +
               " before it");
  if (v > std::numeric_limits<int>::max())
    text_.fail("a face uses vertex " + std::to_string(v) + ", the limit is " +
               std::to_string(std::numeric_limits<int>::max()));
  return static_cast<int>(v < 0 ? n + v : v - 1);
}

void ObjReader::point() {
  stream_.surface.points.push_back(next_point(text_));
  if (text_.line_ends()) return;
  std::vector<double>& c = numbers_;
  rest_of_line(text_, c);
  colors_.add(c.data(), c.size(),
              c.size() == 3 && std::any_of(c.begin(), c.end(), [](double x) { return x > 1; }));
}

void ObjReader::face() {
  const std::size_t first = polygons_.corners.size();
  for (int v; next_corner(v);) {
    polygons_.corners.push_back(v);
    if (polygons_.corners.size() - first > max_corners)
      text_.fail("a face of more than " + std::to_string(max_corners) + " corners, which is the limit");
  }
  if (polygons_.corners.size() - first < 3)
    text_.fail("a face of " + std::to_string(polygons_.corners.size() - first) +
               " corners, expected at least 3");
  polygons_.ends.push_back(polygons_.corners.size());
  for (Sorting* s : {&groups_, &objects_, &materials_}) s->of_face.push_back(s->current);
}

void ObjReader::line() {
  int a, b;
  if (!next_corner(a)) text_.fail("a line of 0 points, expected at least 2");
  if (!next_corner(b)) text_.fail("a line of 1 point, expected at least 2");
  do lines_.push_back({a, b, 0});
  while (a = b, next_corner(b));
}

/// Returns the first of groups, objects and materials that distinguishes faces, or else the first that names
/// any.
Sorting& ObjReader::chosen_sorting() {
  Sorting* const sortings[] = {&groups_, &objects_, &materials_};
  for (Sorting* s : sortings)
    if (s->distinguishes()) return *s;
  for (Sorting* s : sortings)
    if (s->names_any()) return *s;
  return groups_;
}

/// Makes patches of the groups that have faces: patch_7, as write_obj names a patch without a name, keeps its
/// number; the others are numbered in the order of their first faces.
void ObjReader::set_patches(Sorting& sorting) {
  std::vector<int> tag(sorting.names.size() + 1, 0);
  std::set<int> taken;
  for (const int k : sorting.of_face)
    if (long long number = 0; k != 0 && tag[k] == 0 && patch_number(sorting.names[k - 1], number) &&
                              taken.insert(static_cast<int>(number)).second)
      tag[k] = static_cast<int>(number);
  std::vector<char> named(tag.size(), 0);
  int last = 0;
  for (int& k : sorting.of_face) {
    if (k != 0 && !named[k]) {
      named[k] = 1;
      if (tag[k] == 0) {
        do ++last;
        while (taken.count(last));
        tag[k] = last;
      }
      stream_.names.push_back({2, tag[k], sorting.names[k - 1]});
    }
    k = tag[k];
  }
  polygons_.patch = std::move(sorting.of_face);
}

}  // namespace

bool is_obj(std::string_view bytes) {
  static constexpr const char* keywords[] = {"v", "vt", "vn", "vp", "f",      "l",
                                             "p", "g",  "o",  "s",  "usemtl", "mtllib"};
  const auto known = [&](std::string_view w) {
    return std::any_of(std::begin(keywords), std::end(keywords), [&](const char* k) { return w == k; });
  };
  Text text(bytes, "", '#');
  if (!text.next_line()) return false;
  if (known(text.word())) return true;
  // after lines of other words, a vertex must stand: words such as "s" are common
  for (int line = 0; line < 1000 && text.next_line(); ++line) {
    double x;
    if (text.word() == "v" && parse_number(text.word(), x) && parse_number(text.word(), x)) return true;
  }
  return false;
}

Stream read_obj(std::string_view bytes, const std::string& where) { return ObjReader(bytes, where).read(); }

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
  std::set<std::string> taken;
  for (std::size_t k = 0; k < by.tags.size(); ++k) {
    const std::string tag = std::to_string(by.tags[k]);
    std::string name = one_line(stream.name_of(2, by.tags[k]));
    if (name.empty() && by.tags.size() > 1) name = "patch_" + tag;
    if (!name.empty() && !taken.insert(name).second) name += '_' + tag;  // groups of one name are one
    if (!name.empty()) out += "g " + name + '\n';
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
