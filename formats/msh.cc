// SPDX-License-Identifier: BSD-3-Clause
#include "formats/msh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "formats/bytes.h"
#include "formats/columns.h"
#include "formats/model_lines.h"
#include "formats/numbers.h"
#include "formats/polygons.h"
#include "formats/text.h"
#include "lib/error.h"

namespace meshpipe {
namespace {

/// What the types of elements are: lines (2 corners) and surface elements (3 or 4) of any order, their
/// corners first among their nodes; of the others, which are left out, only the number of nodes.
struct Kind {
  int corners = 0, nodes = 0;
};
Kind kind_of(int type) {
  static constexpr Kind kinds[] = {
      {},      {2, 2},  {3, 3},  {4, 4},  {0, 4},  {0, 8},  {0, 6},   {0, 5},  {2, 3},  {3, 6},  {4, 9},
      {0, 10}, {0, 27}, {0, 18}, {0, 14}, {0, 1},  {4, 8},  {0, 20},  {0, 15}, {0, 13}, {3, 9},  {3, 10},
      {3, 12}, {3, 15}, {3, 15}, {3, 21}, {2, 4},  {2, 5},  {2, 6},   {0, 20}, {0, 35}, {0, 56}, {0, 22},
      {0, 28}, {},      {},      {4, 16}, {4, 25}, {4, 36}, {4, 12},  {4, 16}, {4, 20}, {3, 28}, {3, 36},
      {3, 45}, {3, 55}, {3, 66}, {4, 49}, {4, 64}, {4, 81}, {4, 100}, {4, 121}};
  if (type == 92) return {0, 64};
  if (type == 93) return {0, 125};
  return type >= 1 && type < static_cast<int>(std::size(kinds)) ? kinds[type] : Kind{};
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
  /// A number of a node or element: eight bytes if `is_wide`, and any whole number in a text.
  long long number(const char* what, bool is_wide) {
    return is_wide || !binary ? wide(what) : get<int>(what);
  }
  double real(const char* what) {
    if (!binary) return text.number(what);
    const double x = get<double>(what);
    if (!std::isfinite(x)) fail(std::string(what) + " that is not finite");
    return x;
  }
  /// What version 4 writes in eight bytes.
  long long wide(const char* what) { return binary ? get<long long>(what) : text.wide(what); }
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
        data(elements_table_, element_numbers_);
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
    finish();
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
      if (dim == 1 || dim == 2) stream_.names.push_back({dim, tag, unescaped(unquoted())});
    }
  }

  /// What is left of the line, without quotes round it.
  std::string_view unquoted() {
    std::string_view name = in_.text.rest();
    return name.size() >= 2 && name.front() == '"' && name.back() == '"' ? name.substr(1, name.size() - 2)
                                                                         : name;
  }

  /// The first physical tag of each curve and surface of version 4.
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
        if ((dim == 1 || dim == 2) && physical != std::numeric_limits<int>::min())
          entities_[dim].push_back({tag, std::abs(physical)});
        if (in_.binary && dim > 0)
          in_.skip(4 * static_cast<std::size_t>(in_.count("the count of bounding entities", true, 4, 2)),
                   "a bounding entity");
      }
    for (auto& all : entities_)
      std::stable_sort(all.begin(), all.end(),
                       [](const auto& a, const auto& b) { return a.first < b.first; });
  }

  int physical_of(int dim, int tag) const {
    const auto& all = entities_[dim];
    const auto at = std::lower_bound(all.begin(), all.end(), tag,
                                     [](const auto& entity, int t) { return entity.first < t; });
    return at != all.end() && at->first == tag ? at->second : 0;
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
        add_node_number(in_.number("a node number", false));
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
      if (version_ == 4) add_node_number(in_.number("a node number", false));
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

  /// An element whose nodes come next.
  void element(long long number, Kind kind, int physical, int elementary, bool is_wide) {
    const bool is_line = kind.corners == 2;
    const std::string what = (is_line ? "line element " : "surface element ") +
                             std::to_string(is_line ? lines_.size() : surfaces_.size());
    nodes_.clear();
    for (int k = 0; k < kind.nodes; ++k) {
      const long long node = in_.number("a node number", is_wide);
      nodes_.push_back(node_numbers_.row(node));
      if (nodes_.back() < 0)
        in_.fail(what + " uses node " + std::to_string(node) + ", which is none of the " +
                 std::to_string(node_numbers_.size()));
    }
    if (!in_.binary && !in_.text.line_ends())
      in_.fail(what + " has more than its " + std::to_string(kind.nodes) + " nodes");
    if (is_line) {
      lines_.push_back({physical, elementary});
      if (kind.nodes == 3) {  // as add_element has it
        line_edges_.push_back({nodes_[0], nodes_[2], 0});
        line_edges_.push_back({nodes_[2], nodes_[1], 0});
        lines_.push_back(lines_.back());
      } else {
        line_edges_.push_back({nodes_[0], nodes_[1], 0});
      }
      return;
    }
    const int added = add_element(polygons_, nodes_.data(), kind.corners, kind.nodes);
    element_.insert(element_.end(), added, static_cast<int>(surfaces_.size()));
    element_numbers_.add(number);
    surfaces_.push_back({physical, elementary});
  }

  void elements_text() {
    Text& text = in_.text;
    text.need_line("the count of elements");
    const int n = text.count("the count of elements", 8);
    for (int i = 0; i < n; ++i) {
      text.need_line("element", i, n);
      const long long number = text.wide("an element number");
      const Kind kind = kind_of(text.integer("an element type"));
      if (kind.corners == 0) continue;
      // version 1 has two tags and the number of nodes, version 2 the number of tags and the tags
      const int tags = version_ < 2 ? 2 : text.integer("a number of tags");
      int tag[2] = {0, 0};
      for (int k = 0; k < tags; ++k) {
        const int t = text.integer("a tag");
        if (k < 2) tag[k] = t;
      }
      if (version_ < 2)
        if (const int nodes = text.integer("the number of nodes"); nodes != kind.nodes)
          text.fail("element " + std::to_string(i) + " has " + std::to_string(nodes) + " nodes, " +
                    std::to_string(kind.nodes) + " are due");
      element(number, kind, tag[0], tag[1], false);
    }
  }

  void elements_2_binary() {
    in_.text.need_line("the count of elements");
    const int n = in_.text.count("the count of elements", 8);
    for (int done = 0; done < n;) {
      const int type = in_.integer("an element type"), follow = in_.integer("the number of elements"),
                tags = in_.integer("a number of tags");
      const Kind kind = kind_of(type);
      if (kind.nodes == 0) in_.fail("element type " + std::to_string(type) + " is not known");
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
        if (kind.corners)
          element(number, kind, physical, elementary, false);
        else
          in_.skip(4 * static_cast<std::size_t>(kind.nodes), "a node number");
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
      const int type = in_.integer("an element type");
      const Kind kind = kind_of(type);
      const int physical = kind.corners ? physical_of(kind.corners == 2 ? 1 : 2, tag) : 0;
      const int in_block = in_.count("the count of elements", true, 8, 4);
      if (in_block > left)
        in_.fail("a block of " + std::to_string(in_block) + " elements, but " + std::to_string(left) +
                 " are left");
      left -= in_block;
      if (in_.binary && kind.corners == 0) {
        if (kind.nodes == 0) in_.fail("element type " + std::to_string(type) + " is not known");
        in_.skip((is_wide ? 8 : 4) * static_cast<std::size_t>(kind.nodes + 1) * in_block, "an element");
        continue;
      }
      for (int i = 0; i < in_block; ++i) {
        in_.row("element", i, in_block);
        if (kind.corners == 0) continue;
        const long long number = in_.number("an element number", is_wide);
        element(number, kind, physical, tag, is_wide);
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
      if (i == 0) array.name = unescaped(unquoted());
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
      const int row = numbers.row(in_.number("a number", false));
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

  struct Tags {
    int physical, elementary;
  };
  /// The label of an element: its physical tag, or its elementary one counted on from the largest physical.
  std::vector<int> labels(const std::vector<Tags>& tags) const {
    int largest = 0;
    for (const Tags& t : tags) largest = std::max(largest, t.physical);
    std::vector<int> label;
    label.reserve(tags.size());
    for (const Tags& t : tags) {
      const long long tag = t.physical != 0 ? t.physical : static_cast<long long>(largest) + t.elementary;
      if (tag > std::numeric_limits<int>::max())
        in_.text.fail("elementary tag " + std::to_string(t.elementary) + " on top of physical tag " +
                      std::to_string(largest) + " is too large");
      label.push_back(static_cast<int>(tag));
    }
    return label;
  }

  void finish() {
    polygons_.patch = std::get<std::vector<int>>(gather({"", 1, labels(surfaces_)}, element_).data);
    for (Column& c : elements_table_.columns)
      std::visit(
          [&](auto& v) {
            polygons_.columns.set(
                c.name, std::get<std::decay_t<decltype(v)>>(gather({"", 1, std::move(v)}, element_).data));
          },
          c.data);
    set_faces(stream_, polygons_);
    const std::vector<int> tag = labels(lines_);
    for (std::size_t i = 0; i < tag.size(); ++i) line_edges_[i].tag = tag[i];
    set_model_lines(stream_, line_edges_);
  }

  Source in_;
  double version_ = 1;  ///< the one that has no $MeshFormat
  Stream stream_;
  Polygons polygons_;
  Numbers node_numbers_, element_numbers_;
  std::vector<Tags> surfaces_, lines_;   ///< tags by surface element, and by edge of a line
  std::vector<int> element_;             ///< surface element of each polygon
  Table elements_table_{"face", 0, {}};  ///< data of the surface elements
  std::vector<LineEdge> line_edges_;
  std::vector<std::pair<int, int>>
      entities_[3];         ///< by dimension: tag of an entity of version 4, its physical tag
  std::vector<int> nodes_;  ///< rows of the current element's nodes
  bool has_nodes_ = false, has_elements_ = false;
};

}  // namespace

std::string quotable(std::string_view name) {
  std::string out;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const std::string_view next = name.substr(i + 1, 2);
    if (name[i] == '"')
      out += "%22";
    else if (name[i] == '%' && (next == "22" || next == "25"))
      out += "%25";
    else
      out += name[i];
  }
  return out;
}

std::string unescaped(std::string_view name) {
  std::string out;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const std::string_view code = name.substr(i, 3);
    out += code == "%22" ? '"' : name[i];
    if (code == "%22" || code == "%25") i += 2;
  }
  return out;
}

bool is_msh(std::string_view bytes) {
  const std::string_view start = trim(bytes.substr(0, 64));
  return start.starts_with("$MeshFormat") || start.starts_with("$NOD");
}

Stream read_msh(std::string_view bytes, const std::string& where) { return MshReader(bytes, where).read(); }

}  // namespace meshpipe
