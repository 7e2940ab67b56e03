// SPDX-License-Identifier: BSD-3-Clause
#include "formats/msh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "formats/bytes.h"
#include "formats/columns.h"
#include "formats/numbers.h"
#include "formats/polygons.h"
#include "formats/text.h"
#include "lib/error.h"

namespace meshpipe {
namespace {

/// Nodes of an element by its type; 0 for a type that is not known.
int nodes_of_type(int type) {
  static constexpr int nodes[] = {0, 2,  3,  4,  4, 8,  6,  5,  3,  6,  9, 10, 27, 18, 14, 1,
                                  8, 20, 15, 13, 9, 10, 12, 15, 15, 21, 4, 5,  6,  20, 35, 56};
  if (type == 92) return 64;
  if (type == 93) return 125;
  return type >= 1 && type < static_cast<int>(std::size(nodes)) ? nodes[type] : 0;
}

/// Values of a section: words of the current line, or bytes.
class Source {
 public:
  Source(std::string_view bytes, const std::string& where)
      : text(bytes, where), bytes_(bytes), where_(where) {}

  void become_binary() {
    binary = true;
    const int one = get<int>("the number 1 that shows the byte order");
    swap_ = one == 0x01000000;
    if (one != 1 && !swap_)
      fail(std::to_string(one) + " where the number 1 is due that shows the byte order");
  }
  /// Moves to the next line of a text.
  void row(const char* what, long long i = -1, long long n = -1) {
    if (!binary) text.need_line(what, static_cast<int>(i), static_cast<int>(n));
  }
  int integer(const char* what) { return binary ? get<int>(what) : text.integer(what); }
  double real(const char* what) {
    if (!binary) return text.number(what);
    const double x = get<double>(what);
    if (!std::isfinite(x)) fail(std::string(what) + " that is not finite");
    return x;
  }
  /// What version 4 writes in eight bytes.
  long long wide(const char* what) {
    if (binary) return get<long long>(what);
    return whole_word(what);
  }
  Vec3 point() {
    const double x = real("a coordinate"), y = real("a coordinate"), z = real("a coordinate");
    return {x, y, z};
  }
  /// A count, in eight bytes if `is_wide`, of things of at least `least` bytes each (binary, or text).
  int count(const char* what, bool is_wide, std::size_t least_binary, std::size_t least_text) {
    if (!binary) return text.count(what, least_text);
    const long long n = is_wide ? wide(what) : integer(what);
    if (n < 0) fail(std::string(what) + " is " + std::to_string(n));
    if (n > std::numeric_limits<int>::max() || n * least_binary > left())
      fail(std::string(what) + " is " + std::to_string(n) + ", but only " + std::to_string(left()) +
           " bytes follow");
    return static_cast<int>(n);
  }
  void skip(std::size_t n, const char* what) {
    if (n > left()) ends(what, n);
    text.skip(n);
  }
  [[noreturn]] void fail(const std::string& what) const {
    if (!binary) text.fail(what);
    throw BadInput(where_ + ":" + std::to_string(bytes_.size() - left()) + ": " + what);
  }

  Text text;
  bool binary = false;

 private:
  std::size_t left() const { return text.after().size(); }
  [[noreturn]] void ends(const char* what, std::size_t n) const {
    fail("the file ends where " + std::string(what) + " is due: " + std::to_string(n) + " bytes, " +
         std::to_string(left()) + " are left");
  }
  template <class T>
  T get(const char* what) {
    if (left() < sizeof(T)) ends(what, sizeof(T));
    const T value = load<T>(text.after().data(), swap_);
    text.skip(sizeof(T));
    return value;
  }
  long long whole_word(const char* what) {
    const std::string_view w = text.word();
    long long value;
    if (!parse_integer(w, value)) text.fail(quoted(w) + " where " + what + " is due");
    return value;
  }

  std::string_view bytes_;
  const std::string& where_;
  bool swap_ = false;
};

class MshReader {
 public:
  MshReader(std::string_view bytes, const std::string& where) : in_(bytes, where) {}

  Stream read() {
    Text& text = in_.text;
    while (text.next_line()) {
      std::string_view section = text.word();
      if (!section.starts_with('$')) text.fail(quoted(section) + " where a section is due");
      section.remove_prefix(1);
      bool known = true;
      if (section == "MeshFormat")
        format();
      else if (section == "PhysicalNames")
        names();
      else if (section == "Entities" && version_ >= 4)
        entities();
      else if (section == (version_ < 2 ? "NOD" : "Nodes"))
        nodes();
      else if (section == (version_ < 2 ? "ELM" : "Elements"))
        elements();
      else if (section == "NodeData")
        data(stream_.surface.vertex, node_numbers_);
      else if (section == "ElementData")
        data(polygons_.columns, element_numbers_);
      else
        known = false;
      if (known) {
        if (!at_end_of(section)) text.fail("more lines in section " + quoted(section) + " than it declares");
      } else if (in_.binary) {
        skip_section(section);
      } else {
        while (!at_end_of(section)) {
        }
      }
    }
    if (!has_nodes_) text.fail("the file ends where $Nodes is due");
    if (!has_elements_) text.fail("the file ends where $Elements is due");
    label();
    set_faces(stream_, polygons_);
    return std::move(stream_);
  }

 private:
  /// Moves to the next line of a section and says if it is its end.
  bool at_end_of(std::string_view section) {
    in_.text.need_line("the end of the section");
    std::string_view w = in_.text.word();
    if (version_ < 2 && w.starts_with("$END")) return w.substr(4) == section;
    return w.starts_with("$End") && w.substr(4) == section;
  }

  void skip_section(std::string_view section) {
    const std::string end = "$End" + std::string(section);
    const std::size_t at = in_.text.after().find(end);
    if (at == std::string_view::npos) in_.fail("the file ends where " + quoted(end) + " is due");
    in_.text.skip(at + end.size());
  }

  void format() {
    Text& text = in_.text;
    text.need_line("the format's version");
    version_ = text.number("the format's version");
    if (!(version_ >= 2 && version_ < 3) && version_ != 4 && version_ != 4.1) {
      std::string shown;
      append(shown, version_);
      text.fail("msh version " + shown + ", known are 1, 2, 4 and 4.1");
    }
    const int kind = text.integer("the file type");
    if (kind != 0 && kind != 1)
      text.fail("file type " + std::to_string(kind) + " where 0 (text) or 1 is due");
    if (const int size = text.integer("the size of a number"); kind == 1 && size != 8)
      text.fail("numbers of " + std::to_string(size) + " bytes, 8 are due");
    if (kind == 1) in_.become_binary();
  }

  void names() {
    Text& text = in_.text;
    text.need_line("the count of physical names");
    const int n = text.count("the count of physical names", 6);
    for (int i = 0; i < n; ++i) {
      text.need_line("physical name", i, n);
      const int dim = text.integer("a dimension"), tag = text.integer("a physical tag");
      if (dim == 2) stream_.names.push_back({2, tag, std::string(unquoted())});
    }
  }

  /// What is left of the line, without quotes round it.
  std::string_view unquoted() {
    std::string_view name = in_.text.rest();
    return name.size() >= 2 && name.front() == '"' && name.back() == '"' ? name.substr(1, name.size() - 2)
                                                                         : name;
  }

  /// The first physical tag of each surface of version 4.
  void entities() {
    in_.row("the counts of entities");
    long long counts[4];
    for (int dim = 0; dim < 4; ++dim)
      counts[dim] = in_.count("the count of entities", true, dim == 0 && version_ > 4 ? 36 : 60, 8);
    for (int dim = 0; dim < 4; ++dim)
      for (long long i = 0; i < counts[dim]; ++i) {
        in_.row("entity", i, counts[dim]);
        const int tag = in_.integer("the tag of an entity");
        for (int k = 0; k < (dim == 0 && version_ > 4 ? 3 : 6); ++k) in_.real("a bound");
        const int n = in_.count("the count of physical tags", true, 4, 2);
        int physical = 0;
        for (int k = 0; k < n; ++k)
          if (const int p = in_.integer("a physical tag"); k == 0) physical = p;
        // a negative one says that the elements are turned round
        if (dim == 2 && physical != std::numeric_limits<int>::min())
          surfaces_.push_back({tag, std::abs(physical)});
        if (in_.binary && dim > 0)
          in_.skip(4 * static_cast<std::size_t>(in_.count("the count of bounding entities", true, 4, 2)),
                   "a bounding entity");
      }
    std::stable_sort(surfaces_.begin(), surfaces_.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
  }

  int physical_of(int surface) const {
    const auto at = std::lower_bound(surfaces_.begin(), surfaces_.end(), std::pair{surface, 0});
    return at != surfaces_.end() && at->first == surface ? at->second : 0;
  }

  void add_node_number(long long number) {
    if (number < 1) in_.fail("node number " + std::to_string(number) + ", but they are counted from 1");
    node_numbers_.add(number);
  }

  void nodes() {
    if (has_nodes_) in_.fail("a second $Nodes");
    has_nodes_ = true;
    std::vector<Vec3>& points = stream_.surface.points;
    if (version_ < 4) {
      in_.text.need_line("the count of nodes");
      const int n = in_.text.count("the count of nodes", 8);
      points.reserve(n);
      for (int i = 0; i < n; ++i) {
        in_.row("node", i, n);
        add_node_number(in_.integer("a node number"));
        points.push_back(in_.point());
      }
    } else {
      in_.row("the counts of nodes");
      const int blocks = in_.count("the count of blocks", true, 20, 6);
      const int n = in_.count("the count of nodes", true, 28, 8);
      points.reserve(n);
      if (version_ > 4) in_.wide("the least node number"), in_.wide("the largest node number");
      for (int b = 0; b < blocks; ++b) node_block(b, blocks);
      if (static_cast<int>(points.size()) != n)
        in_.fail("the blocks have " + std::to_string(points.size()) + " nodes, " + std::to_string(n) +
                 " are due");
    }
    if (const long long twice = node_numbers_.finish(); twice != 0)
      in_.fail("node number " + std::to_string(twice) + " is given twice");
  }

  void node_block(int block, int blocks) {
    in_.row("block of nodes", block, blocks);
    const int a = in_.integer("the dimension of an entity"), b = in_.integer("the tag of an entity");
    const int parametric = in_.integer("whether there are parameters");
    const int n = in_.count("the count of nodes", true, 28, version_ > 4 ? 8 : 6);
    // 4.0 has the tag first; a node has as many parameters as its entity has dimensions
    const std::size_t more = in_.binary && parametric ? 8 * std::clamp(version_ > 4 ? a : b, 0, 3) : 0;
    if (version_ > 4)
      for (int i = 0; i < n; ++i) {
        in_.row("node number", i, n);
        add_node_number(in_.wide("a node number"));
      }
    for (int i = 0; i < n; ++i) {
      in_.row("node", i, n);
      if (version_ == 4) add_node_number(in_.integer("a node number"));
      stream_.surface.points.push_back(in_.point());
      in_.skip(more, "the parameters of a node");
    }
  }

  void elements() {
    if (!has_nodes_) in_.fail("$Elements before $Nodes");
    if (has_elements_) in_.fail("a second $Elements");
    has_elements_ = true;
    if (version_ >= 4)
      elements_4();
    else if (in_.binary)
      elements_2_binary();
    else
      elements_text();
    element_numbers_.finish();
  }

  /// Corners of a surface element, 0 for another; throws for the kinds of higher order: their corners alone
  /// would be another surface.
  int corners_of(int type) const {
    for (int curved : {9, 10, 16, 20, 21, 22, 23, 24, 25})
      if (type == curved)
        in_.fail("element type " + std::to_string(type) +
                 " is curved, but only triangles and quadrilaterals of the first order are read");
    return type == 2 ? 3 : type == 3 ? 4 : 0;
  }

  /// A surface element whose nodes come next.
  void element(long long number, int corners, int physical, int elementary, bool is_wide) {
    const std::size_t i = physical_.size();
    element_numbers_.add(number);
    physical_.push_back(physical);
    elementary_.push_back(elementary);
    for (int k = 0; k < corners; ++k) {
      const long long node = is_wide ? in_.wide("a node number") : in_.integer("a node number");
      const int row = node_numbers_.row(node);
      if (row < 0)
        in_.fail("surface element " + std::to_string(i) + " uses node " + std::to_string(node) +
                 ", which is none of the " + std::to_string(node_numbers_.size()));
      polygons_.corners.push_back(row);
    }
    if (!in_.binary && !in_.text.line_ends())
      in_.fail("surface element " + std::to_string(i) + " has more than its " + std::to_string(corners) +
               " nodes");
    polygons_.ends.push_back(polygons_.corners.size());
  }

  void elements_text() {
    Text& text = in_.text;
    text.need_line("the count of elements");
    const int n = text.count("the count of elements", 8);
    for (int i = 0; i < n; ++i) {
      text.need_line("element", i, n);
      const int number = text.integer("an element number"), type = text.integer("an element type");
      const int corners = corners_of(type);
      if (corners == 0) continue;
      // version 1 has two tags and the number of nodes, version 2 the number of tags and the tags
      const int tags = version_ < 2 ? 2 : text.integer("a number of tags");
      int tag[2] = {0, 0};
      for (int k = 0; k < tags; ++k) {
        const int t = text.integer("a tag");
        if (k < 2) tag[k] = t;
      }
      if (version_ < 2)
        if (const int nodes = text.integer("the number of nodes"); nodes != corners)
          text.fail("element " + std::to_string(i) + " has " + std::to_string(nodes) + " nodes, " +
                    std::to_string(corners) + " are due");
      element(number, corners, tag[0], tag[1], false);
    }
  }

  void elements_2_binary() {
    in_.text.need_line("the count of elements");
    const int n = in_.text.count("the count of elements", 8);
    for (int done = 0; done < n;) {
      const int type = in_.integer("an element type"), follow = in_.integer("the number of elements"),
                tags = in_.integer("a number of tags"), corners = corners_of(type),
                nodes = nodes_of_type(type);
      if (nodes == 0) in_.fail("element type " + std::to_string(type) + " is not known");
      if (follow < 1 || follow > n - done)
        in_.fail("a block of " + std::to_string(follow) + " elements, but " + std::to_string(n - done) +
                 " are left");
      if (tags < 0) in_.fail("elements with " + std::to_string(tags) + " tags");
      done += follow;
      for (int i = 0; i < follow; ++i) {
        const int number = in_.integer("an element number");
        const int physical = tags > 0 ? in_.integer("a tag") : 0,
                  elementary = tags > 1 ? in_.integer("a tag") : 0;
        in_.skip(4 * static_cast<std::size_t>(std::max(tags - 2, 0)), "a tag");
        if (corners)
          element(number, corners, physical, elementary, false);
        else
          in_.skip(4 * static_cast<std::size_t>(nodes), "a node number");
      }
    }
  }

  void elements_4() {
    in_.row("the counts of elements");
    const int blocks = in_.count("the count of blocks", true, 20, 6);
    const int n = in_.count("the count of elements", true, 8, 4);
    if (version_ > 4) in_.wide("the least element number"), in_.wide("the largest element number");
    const bool is_wide = version_ > 4;
    int left = n;
    for (int b = 0; b < blocks; ++b) {
      in_.row("block of elements", b, blocks);
      int dim = in_.integer("the dimension of an entity"), tag = in_.integer("the tag of an entity");
      if (!is_wide) std::swap(dim, tag);
      const int type = in_.integer("an element type"), corners = corners_of(type),
                nodes = nodes_of_type(type);
      const int physical = corners ? physical_of(tag) : 0;
      const int in_block = in_.count("the count of elements", true, 8, 4);
      if (in_block > left)
        in_.fail("a block of " + std::to_string(in_block) + " elements, but " + std::to_string(left) +
                 " are left");
      left -= in_block;
      if (in_.binary && corners == 0) {
        if (nodes == 0) in_.fail("element type " + std::to_string(type) + " is not known");
        in_.skip((is_wide ? 8 : 4) * static_cast<std::size_t>(nodes + 1) * in_block, "an element");
        continue;
      }
      for (int i = 0; i < in_block; ++i) {
        in_.row("element", i, in_block);
        if (corners == 0) continue;
        const long long number = is_wide ? in_.wide("an element number") : in_.integer("an element number");
        element(number, corners, physical, tag, is_wide);
      }
    }
    if (left)
      in_.fail("the blocks have " + std::to_string(n - left) + " elements, " + std::to_string(n) +
               " are due");
  }

  /// $NodeData or $ElementData: string, real and integer tags, then a number and the values a row.
  void data(Table& table, const Numbers& numbers) {
    Text& text = in_.text;
    if (!has_elements_) text.fail("data before $Elements");
    Array array;
    text.need_line("the number of string tags");
    for (int i = 0, n = text.count("the number of string tags", 1); i < n; ++i) {
      text.need_line("string tag", i, n);
      if (i == 0) array.name = unquoted();
    }
    text.need_line("the number of real tags");
    for (int i = 0, n = text.count("the number of real tags", 1); i < n; ++i)
      text.need_line("real tag", i, n);
    text.need_line("the number of integer tags");
    const int n_tags = text.count("the number of integer tags", 1);
    int tags[3] = {0, 1, 0};  // step, components, rows
    for (int i = 0; i < n_tags; ++i) {
      text.need_line("integer tag", i, n_tags);
      const int tag = text.integer("an integer tag");
      if (i < 3) tags[i] = tag;
    }
    array.components = tags[1];
    if (array.components < 1 || array.components > 9)
      text.fail("data with " + std::to_string(tags[1]) + " components, 1 to 9 are due");
    const std::size_t least = in_.binary ? 4 + 8 * array.components : 3;
    if (tags[2] < 0 || tags[2] * least > text.after().size() + 1)
      text.fail("data has " + std::to_string(tags[2]) + " rows, but only " +
                std::to_string(text.after().size()) + " bytes follow");
    std::vector<double> values(numbers.size() * array.components);
    std::vector<bool> given(numbers.size(), false);
    std::size_t n_given = 0;
    for (int i = 0; i < tags[2]; ++i) {
      in_.row("a row of data", i, tags[2]);
      const int row = numbers.row(in_.integer("a number"));
      for (int k = 0; k < array.components; ++k) {
        const double x = in_.real("a value");
        if (row >= 0) values[static_cast<std::size_t>(row) * array.components + k] = x;
      }
      if (row >= 0 && !given[row]) {
        given[row] = true;
        ++n_given;
      }
    }
    if (n_given != numbers.size())
      return leave_out(stream_, table, array.name,
                       "given for " + std::to_string(n_given) + " of " + std::to_string(numbers.size()));
    array.data = std::move(values);
    add_columns(stream_, table, numbers.size(), std::move(array));
  }

  void label() {
    const int largest =
        physical_.empty() ? 0 : std::max(0, *std::max_element(physical_.begin(), physical_.end()));
    polygons_.patch.resize(physical_.size());
    for (std::size_t i = 0; i < physical_.size(); ++i) {
      const long long tag =
          physical_[i] != 0 ? physical_[i] : static_cast<long long>(largest) + elementary_[i];
      if (tag > std::numeric_limits<int>::max())
        in_.text.fail("elementary tag " + std::to_string(elementary_[i]) + " on top of physical tag " +
                      std::to_string(largest) + " is too large");
      polygons_.patch[i] = static_cast<int>(tag);
    }
  }

  Source in_;
  double version_ = 1;  ///< the one that has no $MeshFormat
  Stream stream_;
  Polygons polygons_;
  Numbers node_numbers_, element_numbers_;
  std::vector<int> physical_, elementary_;     ///< tags by surface element
  std::vector<std::pair<int, int>> surfaces_;  ///< tag of a surface of version 4, its physical tag
  bool has_nodes_ = false, has_elements_ = false;
};

}  // namespace

bool is_msh(std::string_view bytes) {
  const std::string_view start = trim(bytes.substr(0, 64));
  return start.starts_with("$MeshFormat") || start.starts_with("$NOD");
}

Stream read_msh(std::string_view bytes, const std::string& where) { return MshReader(bytes, where).read(); }

}  // namespace meshpipe
