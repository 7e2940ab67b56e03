// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/msh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "formats/foreign/columns.h"
#include "formats/foreign/number_source.h"
#include "formats/foreign/numbers.h"
#include "formats/foreign/polygons.h"
#include "formats/foreign/volumes.h"
#include "formats/stream/model_lines.h"
#include "formats/text.h"
#include "lib/core/error.h"
#include "lib/core/lists.h"

namespace meshpipe {
namespace {

/// Number of corners and nodes of the elements that are read: lines (2) and surface elements (3 or 4) of any
/// order, corners first. Volumes have 0 of these corners, and their own; other elements have none.
struct Kind {
  int corners = 0, nodes = 0, of_volume = 0;
};
Kind kind_of(int type) {
  static constexpr Kind kinds[] = {
      {},         {2, 2},     {3, 3},     {4, 4},     {0, 4, 4},  {0, 8, 8},  {0, 6, 6},  {0, 5, 5},
      {2, 3},     {3, 6},     {4, 9},     {0, 10, 4}, {0, 27, 8}, {0, 18, 6}, {0, 14, 5}, {0, 1},
      {4, 8},     {0, 20, 8}, {0, 15, 6}, {0, 13, 5}, {3, 9},     {3, 10},    {3, 12},    {3, 15},
      {3, 15},    {3, 21},    {2, 4},     {2, 5},     {2, 6},     {0, 20, 4}, {0, 35, 4}, {0, 56, 4},
      {0, 22, 4}, {0, 28, 4}, {},         {},         {4, 16},    {4, 25},    {4, 36},    {4, 12},
      {4, 16},    {4, 20},    {3, 28},    {3, 36},    {3, 45},    {3, 55},    {3, 66},    {4, 49},
      {4, 64},    {4, 81},    {4, 100},   {4, 121}};
  if (type == 92) return {0, 64, 8};
  if (type == 93) return {0, 125, 8};
  return type >= 1 && type < static_cast<int>(std::size(kinds)) ? kinds[type] : Kind{};
}

/// Reads the number 1 that shows the byte order of what follows.
void become_binary(NumberSource& in) {
  in.binary = true;
  const int one = in.get<int>("the number 1 that shows the byte order");
  in.swap = one == 0x01000000;
  if (one != 1 && !in.swap)
    in.fail("expected the number 1 that shows the byte order, found " + std::to_string(one));
}

/// Moves to the next line of a text.
void next_row(NumberSource& in, const char* what, long long i = -1, long long n = -1) {
  if (!in.binary) in.text.need_line(what, static_cast<int>(i), static_cast<int>(n));
}

/// Takes the number of a node or element: eight bytes if `is_wide`; in a text any whole number.
long long number(NumberSource& in, const char* what, bool is_wide) {
  return is_wide || !in.binary ? in.wide(what) : in.get<int>(what);
}

/// Most physical groups that one entity of version 4 may be in: each of its elements is read once for each of
/// them.
constexpr std::size_t most_groups = 64;

/// The physical tags of the curves, surfaces and volumes of version 4.
class Entities {
 public:
  void read(NumberSource& in, double version);
  /// Returns the physical tags of an entity of dimension 1 to 3; only 0 if it has none.
  std::vector<int> physical_of(int dim, int tag) const;

 private:
  std::vector<std::pair<int, int>> tags_[4];  ///< by dimension: tag of the entity, a physical tag; sorted
};

void Entities::read(NumberSource& in, double version) {
  next_row(in, "the counts of entities");
  long long counts[4];
  for (int dim = 0; dim < 4; ++dim)
    counts[dim] = in.count("the count of entities", true, dim == 0 && version > 4 ? 36 : 60, 8);
  for (int dim = 0; dim < 4; ++dim)
    for (long long i = 0; i < counts[dim]; ++i) {
      next_row(in, "entity", i, counts[dim]);
      const int tag = in.integer("the tag of an entity");
      for (int k = 0; k < (dim == 0 && version > 4 ? 3 : 6); ++k) in.real("a bound");
      const int n = in.count("the count of physical tags", true, 4, 2);
      for (int k = 0; k < n; ++k) {
        const int physical = in.integer("a physical tag");
        // a negative tag says that the elements have the opposite orientation
        if (dim > 0 && physical != std::numeric_limits<int>::min())
          tags_[dim].push_back({tag, std::abs(physical)});
      }
      if (in.binary && dim > 0)
        in.skip(4 * static_cast<std::size_t>(in.count("the count of bounding entities", true, 4, 2)),
                "a bounding entity");
    }
  for (auto& all : tags_) {
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t i = most_groups; i < all.size(); ++i)
      if (all[i].first == all[i - most_groups].first)
        in.fail("entity " + std::to_string(all[i].first) + " is in more than " + std::to_string(most_groups) +
                " physical groups");
  }
}

std::vector<int> Entities::physical_of(int dim, int tag) const {
  const auto& all = tags_[dim];
  auto at = std::lower_bound(all.begin(), all.end(), tag,
                             [](const auto& entity, int t) { return entity.first < t; });
  std::vector<int> tags;
  for (; at != all.end() && at->first == tag; ++at) tags.push_back(at->second);
  if (tags.empty()) tags.push_back(0);
  return tags;
}

/// The values with which the row of an element begins.
struct Element {
  long long number;
  Kind kind;
  int physical, elementary;
};

/// The lines and surface elements of a file, with their tags and data; without surface elements, its volumes.
class Elements {
 public:
  /// Is an element of this kind wanted?
  bool takes(const Kind& kind) const {
    return kind.corners > 0 || (kind.of_volume > 0 && polygons_.ends.empty());
  }
  /// Remembers that there are elements of a type that is not known, perhaps volumes.
  void skip(int type, const Text& text) {
    if (volumes_.unread.empty())
      volumes_.unread =
          text.here("elements of type " + std::to_string(type) + " are not read, and there are no faces");
  }
  /// Adds an element by the rows of its nodes; `again`: the one before, in another physical group.
  void add(const Element& element, const std::vector<int>& nodes, bool again);
  /// Returns the physical tags of the lines (dim 1) or of the others (2), sorted.
  std::vector<int> physical_tags(int dim) const;
  /// Names the next element for a message.
  std::string next_name(const Element& element) const;
  /// Sets the faces, patches and lines of the stream. Throws BadInput for tags that are too large.
  void finish(Stream& stream, const NumberSource& in);

  Numbers numbers;            ///< of the surface elements, or of the volumes
  Table data{"face", 0, {}};  ///< of the same

 private:
  struct Tags {
    int physical, elementary;
  };
  static std::vector<int> labels(const std::vector<Tags>& tags, const NumberSource& in);

  Polygons polygons_;
  Volumes volumes_;
  std::vector<Tags> surfaces_, lines_;  ///< tags by surface element or volume, and by edge of a line
  std::vector<int> element_, row_;      ///< of each polygon: element, and row of its data
  std::vector<LineEdge> line_edges_;
};

std::vector<int> Elements::physical_tags(int dim) const {
  std::vector<int> tags;
  for (const Tags& t : dim == 1 ? lines_ : surfaces_) tags.push_back(t.physical);
  sort_unique(tags);
  return tags;
}

std::string Elements::next_name(const Element& element) const {
  return element.kind.corners == 2
             ? "line element " + std::to_string(lines_.size())
             : (element.kind.of_volume ? "volume " : "surface element ") + std::to_string(surfaces_.size());
}

void Elements::add(const Element& element, const std::vector<int>& nodes, bool again) {
  if (element.kind.of_volume) {
    numbers.add(element.number);
    add_volume(volumes_, nodes.data(), element.kind.of_volume, element.kind.nodes,
               static_cast<int>(surfaces_.size()));
    surfaces_.push_back({element.physical, element.elementary});
    return;
  }
  if (element.kind.corners != 2) {
    if (!volumes_.kind.empty()) volumes_ = {}, numbers = {}, surfaces_.clear();  // there are faces after all
    const int added = add_element(polygons_, nodes.data(), element.kind.corners, element.kind.nodes);
    if (!again) numbers.add(element.number);
    element_.insert(element_.end(), added, static_cast<int>(surfaces_.size()));
    row_.insert(row_.end(), added, static_cast<int>(numbers.size()) - 1);
    surfaces_.push_back({element.physical, element.elementary});
    return;
  }
  lines_.push_back({element.physical, element.elementary});
  if (element.kind.nodes == 3) {  // two edges, as add_element makes them
    line_edges_.push_back({nodes[0], nodes[2], 0});
    line_edges_.push_back({nodes[2], nodes[1], 0});
    lines_.push_back(lines_.back());
  } else {
    line_edges_.push_back({nodes[0], nodes[1], 0});
  }
}

/// Returns the label of each element: its physical tag, or else its elementary one counted on from the
/// largest physical tag.
std::vector<int> Elements::labels(const std::vector<Tags>& tags, const NumberSource& in) {
  int largest = 0;
  for (const Tags& t : tags) largest = std::max(largest, t.physical);
  std::vector<int> label;
  label.reserve(tags.size());
  for (const Tags& t : tags) {
    const long long tag = t.physical != 0 ? t.physical : static_cast<long long>(largest) + t.elementary;
    if (tag > std::numeric_limits<int>::max())
      in.text.fail("elementary tag " + std::to_string(t.elementary) + " on top of physical tag " +
                   std::to_string(largest) + " is too large");
    label.push_back(static_cast<int>(tag));
  }
  return label;
}

void Elements::finish(Stream& stream, const NumberSource& in) {
  const std::vector<int> volumes = add_outer_faces(polygons_, volumes_, stream);
  for (int volume : volumes) element_.push_back(volume), row_.push_back(volume);
  const int others = volumes.empty() ? 3 : 2;  // the dimension of names that are not of patches
  std::erase_if(stream.names, [&](const Name& n) { return n.dim == others; });
  for (Name& n : stream.names) n.dim = std::min(n.dim, 2);
  polygons_.patch = std::get<std::vector<int>>(gather({"", 1, labels(surfaces_, in)}, element_).data);
  for (Column& c : data.columns)
    std::visit(
        [&](auto& v) {
          polygons_.columns.set(
              c.name, std::get<std::decay_t<decltype(v)>>(gather({"", 1, std::move(v)}, row_).data));
        },
        c.data);
  set_faces(stream, polygons_);
  const std::vector<int> tag = labels(lines_, in);
  for (std::size_t i = 0; i < tag.size(); ++i) line_edges_[i].tag = tag[i];
  set_model_lines(stream, line_edges_);
}

/// Takes the rest of the line without the quotes around it.
std::string_view unquoted(Text& text) {
  std::string_view name = text.rest();
  return name.size() >= 2 && name.front() == '"' && name.back() == '"' ? name.substr(1, name.size() - 2)
                                                                       : name;
}

/// Skips a section of a binary file that is not read.
void skip_section(NumberSource& in, std::string_view section) {
  const std::string end = "$End" + std::string(section);
  const std::size_t at = in.text.after().find(end);
  if (at == std::string_view::npos) in.fail("expected " + quoted(end) + ", found the end of the file");
  in.text.skip(at + end.size());
}

class MshReader {
 public:
  MshReader(std::string_view bytes, const std::string& where) : in_(bytes, where) {}

  Stream read() {
    Text& text = in_.text;
    while (text.next_line()) {
      std::string_view section = text.word();
      if (!section.starts_with('$')) text.fail("expected a section, found " + quoted(section));
      section.remove_prefix(1);
      bool known = true;
      if (section == "MeshFormat")
        format();
      else if (section == "PhysicalNames")
        names();
      else if (section == "Entities" && version_ >= 4)
        entities_.read(in_, version_);
      else if (section == (version_ < 2 ? "NOD" : "Nodes"))
        nodes();
      else if (section == (version_ < 2 ? "ELM" : "Elements"))
        elements();
      else if (section == "NodeData")
        data(stream_.surface.vertex, node_numbers_);
      else if (section == "ElementData")
        data(elements_.data, elements_.numbers);
      else
        known = false;
      if (known) {
        if (!at_end_of(section)) text.fail("more lines in section " + quoted(section) + " than it declares");
      } else if (in_.binary) {
        skip_section(in_, section);
      } else {
        while (!at_end_of(section)) {
        }
      }
    }
    if (!has_nodes_) text.fail("expected $Nodes, found the end of the file");
    if (!has_elements_) text.fail("expected $Elements, found the end of the file");
    give_dimensions();
    elements_.finish(stream_, in_);
    return std::move(stream_);
  }

 private:
  /// Moves to the next line of a section and returns whether that ends it.
  bool at_end_of(std::string_view section) {
    in_.text.need_line("the end of the section");
    std::string_view w = in_.text.word();
    if (version_ < 2 && w.starts_with("$END")) return w.substr(4) == section;
    return w.starts_with("$End") && w.substr(4) == section;
  }

  void format() {
    Text& text = in_.text;
    text.need_line("the format's version");
    version_ = text.number("the format's version");
    if (!(version_ >= 2 && version_ < 3) && version_ != 4 && version_ != 4.1) {
      std::string shown;
      append(shown, version_);
      text.fail("msh version " + shown + ", expected 1, 2, 4 or 4.1");
    }
    const int kind = text.integer("the file type");
    if (kind != 0 && kind != 1)
      text.fail("expected file type 0 (text) or 1 (binary), found " + std::to_string(kind));
    if (const int size = text.integer("the size of a number"); kind == 1 && size != 8)
      text.fail("expected numbers of 8 bytes, found " + std::to_string(size));
    if (kind == 1) become_binary(in_);
  }

  void names() {
    Text& text = in_.text;
    text.need_line("the count of physical names");
    const int n = text.count("the count of physical names", 6);
    for (int i = 0; i < n; ++i) {
      text.need_line("physical name", i, n);
      const int first = text.integer("a dimension");
      if (text.peek().starts_with('"')) {  // as early files of version 2 have it
        names_of_any_dimension_.push_back({0, first, unescaped(unquoted(text))});
        continue;
      }
      const int tag = text.integer("a physical tag");
      if (first >= 1 && first <= 3) stream_.names.push_back({first, tag, unescaped(unquoted(text))});
    }
  }

  /// Gives names without a dimension to the lines and surface elements that have their tag.
  void give_dimensions() {
    if (names_of_any_dimension_.empty()) return;
    for (int dim : {1, 2}) {
      const std::vector<int> tags = elements_.physical_tags(dim);
      for (const Name& n : names_of_any_dimension_)
        if (std::binary_search(tags.begin(), tags.end(), n.tag))
          stream_.names.push_back({dim, n.tag, n.text});
    }
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
        next_row(in_, "node", i, n);
        add_node_number(number(in_, "a node number", false));
        points.push_back(in_.point());
      }
    } else {
      next_row(in_, "the counts of nodes");
      const int blocks = in_.count("the count of blocks", true, 20, 6);
      const int n = in_.count("the count of nodes", true, 28, 8);
      points.reserve(n);
      if (version_ > 4) in_.wide("the least node number"), in_.wide("the largest node number");
      for (int b = 0; b < blocks; ++b) node_block(b, blocks);
      if (static_cast<int>(points.size()) != n)
        in_.fail("expected " + std::to_string(n) + " nodes, but the blocks have " +
                 std::to_string(points.size()));
    }
    if (const long long twice = node_numbers_.finish(); twice != 0)
      in_.fail("node number " + std::to_string(twice) + " is given twice");
  }

  void node_block(int block, int blocks) {
    next_row(in_, "block of nodes", block, blocks);
    const int a = in_.integer("the dimension of an entity"), b = in_.integer("the tag of an entity");
    const int parametric = in_.integer("whether there are parameters");
    const int n = in_.count("the count of nodes", true, 28, version_ > 4 ? 8 : 6);
    // 4.0 has the tag first; a node has as many parameters as its entity has dimensions
    const std::size_t more = in_.binary && parametric ? 8 * std::clamp(version_ > 4 ? a : b, 0, 3) : 0;
    if (version_ > 4)
      for (int i = 0; i < n; ++i) {
        next_row(in_, "node number", i, n);
        add_node_number(in_.wide("a node number"));
      }
    for (int i = 0; i < n; ++i) {
      next_row(in_, "node", i, n);
      if (version_ == 4) add_node_number(number(in_, "a node number", false));
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
    elements_.numbers.finish();
  }

  /// Reads an element of these physical groups: lines are of the first one only.
  void element(Element e, const std::vector<int>& groups, bool is_wide) {
    nodes_.clear();
    for (int k = 0; k < e.kind.nodes; ++k) {
      const long long node = number(in_, "a node number", is_wide);
      nodes_.push_back(node_numbers_.row(node));
      if (nodes_.back() < 0)
        in_.fail(elements_.next_name(e) + " uses node " + std::to_string(node) + ", which is none of the " +
                 std::to_string(node_numbers_.size()));
    }
    if (!in_.binary && !in_.text.line_ends())
      in_.fail(elements_.next_name(e) + " has more than its " + std::to_string(e.kind.nodes) + " nodes");
    for (std::size_t k = 0; k < (e.kind.corners == 2 || e.kind.of_volume ? 1 : groups.size()); ++k) {
      e.physical = groups[k];
      elements_.add(e, nodes_, k > 0);
    }
  }

  void elements_text() {
    Text& text = in_.text;
    text.need_line("the count of elements");
    const int n = text.count("the count of elements", 8);
    for (int i = 0; i < n; ++i) {
      text.need_line("element", i, n);
      const long long number = text.wide("an element number");
      const int type = text.integer("an element type");
      const Kind kind = kind_of(type);
      if (kind.nodes == 0) elements_.skip(type, in_.text);
      if (!elements_.takes(kind)) continue;
      // version 1 has two tags and the number of nodes, version 2 the number of tags and the tags
      const int tags = version_ < 2 ? 2 : text.integer("a number of tags");
      int tag[2] = {0, 0};
      for (int k = 0; k < tags; ++k) {
        const int t = text.integer("a tag");
        if (k < 2) tag[k] = t;
      }
      if (version_ < 2)
        if (const int nodes = text.integer("the number of nodes"); nodes != kind.nodes)
          text.fail("element " + std::to_string(i) + " has " + std::to_string(nodes) + " nodes, expected " +
                    std::to_string(kind.nodes));
      element({number, kind, 0, tag[1]}, {tag[0]}, false);
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
        if (elements_.takes(kind))
          element({number, kind, 0, elementary}, {physical}, false);
        else
          in_.skip(4 * static_cast<std::size_t>(kind.nodes), "a node number");
      }
    }
  }

  void elements_4() {
    next_row(in_, "the counts of elements");
    const int blocks = in_.count("the count of blocks", true, 20, 6);
    const int n = in_.count("the count of elements", true, 8, 4);
    if (version_ > 4) in_.wide("the least element number"), in_.wide("the largest element number");
    const bool is_wide = version_ > 4;
    int left = n;
    for (int b = 0; b < blocks; ++b) {
      next_row(in_, "block of elements", b, blocks);
      int dim = in_.integer("the dimension of an entity"), tag = in_.integer("the tag of an entity");
      if (!is_wide) std::swap(dim, tag);
      const int type = in_.integer("an element type");
      const Kind kind = kind_of(type);
      const std::vector<int> groups = entities_.physical_of(kind.of_volume      ? 3
                                                            : kind.corners == 2 ? 1
                                                                                : 2,
                                                            tag);
      const int in_block = in_.count("the count of elements", true, 8, 4);
      if (in_block > left)
        in_.fail("a block of " + std::to_string(in_block) + " elements, but " + std::to_string(left) +
                 " are left");
      left -= in_block;
      const bool takes = elements_.takes(kind);
      if (dim == 3 && kind.nodes == 0) elements_.skip(type, in_.text);
      if (in_.binary && !takes) {
        if (kind.nodes == 0) in_.fail("element type " + std::to_string(type) + " is not known");
        in_.skip((is_wide ? 8 : 4) * static_cast<std::size_t>(kind.nodes + 1) * in_block, "an element");
        continue;
      }
      for (int i = 0; i < in_block; ++i) {
        next_row(in_, "element", i, in_block);
        if (!takes) continue;
        const long long number_of_element = number(in_, "an element number", is_wide);
        element({number_of_element, kind, 0, tag}, groups, is_wide);
      }
    }
    if (left)
      in_.fail("expected " + std::to_string(n) + " elements, but the blocks have " +
               std::to_string(n - left));
  }

  /// Reads $NodeData or $ElementData: string, real and integer tags, then a number and values in each row.
  void data(Table& table, const Numbers& numbers) {
    Text& text = in_.text;
    if (!has_elements_) text.fail("data before $Elements");
    Array array;
    text.need_line("the number of string tags");
    for (int i = 0, n = text.count("the number of string tags", 1); i < n; ++i) {
      text.need_line("string tag", i, n);
      if (i == 0) array.name = unescaped(unquoted(text));
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
      text.fail("data with " + std::to_string(tags[1]) + " components, expected 1 to 9");
    const std::size_t least = in_.binary ? 4 + 8 * array.components : 3;
    if (tags[2] < 0 || tags[2] * least > text.after().size() + 1)
      text.fail("data has " + std::to_string(tags[2]) + " rows, but only " +
                std::to_string(text.after().size()) + " bytes follow");
    std::vector<double> values(numbers.size() * array.components);
    std::vector<bool> given(numbers.size(), false);
    std::size_t n_given = 0;
    for (int i = 0; i < tags[2]; ++i) {
      next_row(in_, "a row of data", i, tags[2]);
      const int row = numbers.row(number(in_, "a number", false));
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

  NumberSource in_;
  double version_ = 1;  ///< the one that has no $MeshFormat
  Stream stream_;
  Entities entities_;
  Numbers node_numbers_;
  Elements elements_;
  std::vector<Name> names_of_any_dimension_;
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
