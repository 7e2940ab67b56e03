// SPDX-License-Identifier: BSD-3-Clause
#include "formats/msh.h"

#include <algorithm>
#include <limits>

#include "formats/polygons.h"
#include "formats/text.h"

namespace meshpipe {
namespace {

/// Node numbers of the file, which may have gaps and any order, to rows.
class Numbers {
 public:
  void add(int number) {
    in_order_ = in_order_ && number == static_cast<int>(sorted_.size()) + 1;
    sorted_.push_back({number, static_cast<int>(sorted_.size())});
  }
  /// A number given twice, or 0.
  int sort() {
    if (in_order_) return 0;
    std::sort(sorted_.begin(), sorted_.end());
    auto twice = std::adjacent_find(sorted_.begin(), sorted_.end(),
                                    [](const auto& a, const auto& b) { return a.first == b.first; });
    return twice == sorted_.end() ? 0 : twice->first;
  }
  /// The row, or -1.
  int row(int number) const {
    if (in_order_) return number >= 1 && number <= static_cast<int>(sorted_.size()) ? number - 1 : -1;
    auto at = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair{number, 0});
    return at != sorted_.end() && at->first == number ? at->second : -1;
  }
  std::size_t size() const { return sorted_.size(); }

 private:
  std::vector<std::pair<int, int>> sorted_;
  bool in_order_ = true;
};

class MshReader {
 public:
  MshReader(std::string_view bytes, const std::string& where) : text_(bytes, where) {}

  Stream read() {
    while (text_.next_line()) {
      std::string_view section = text_.word();
      if (!section.starts_with('$')) text_.fail(quoted(section) + " where a section is due");
      section.remove_prefix(1);
      bool known = true;
      if (section == "MeshFormat")
        format();
      else if (section == "PhysicalNames")
        names();
      else if (section == "Nodes")
        nodes();
      else if (section == "Elements")
        elements();
      else
        known = false;
      while (!at_end_of(section))
        if (known) text_.fail("more lines in section " + quoted(section) + " than it declares");
    }
    if (!has_nodes_) text_.fail("the file ends where $Nodes is due");
    if (!has_elements_) text_.fail("the file ends where $Elements is due");
    label();
    set_faces(stream_, polygons_);
    return std::move(stream_);
  }

 private:
  /// Moves to the next line of a section and says if it is its end.
  bool at_end_of(std::string_view section) {
    text_.need_line("the end of the section");
    std::string_view w = text_.word();
    return w.starts_with("$End") && w.substr(4) == section;
  }

  void format() {
    text_.need_line("the format's version");
    const double version = text_.number("the format's version");
    std::string shown;
    append(shown, version);
    if (shown.find('.') == std::string::npos) shown += ".0";
    if (version < 2 || version >= 3) text_.fail("msh version " + shown + " is not built yet; 2.2 is");
    if (int kind = text_.integer("the file type"); kind != 0)
      text_.fail("binary msh (file type " + std::to_string(kind) + ") is not built yet");
    has_format_ = true;
  }

  void names() {
    text_.need_line("the count of physical names");
    const int n = text_.count("the count of physical names", 6);
    for (int i = 0; i < n; ++i) {
      text_.need_line("physical name", i, n);
      const int dim = text_.integer("a dimension"), tag = text_.integer("a physical tag");
      std::string_view name = text_.rest();
      if (name.size() >= 2 && name.front() == '"' && name.back() == '"')
        name = name.substr(1, name.size() - 2);
      if (dim == 2) stream_.names.push_back({2, tag, std::string(name)});
    }
  }

  void nodes() {
    if (!has_format_) text_.fail("$Nodes before $MeshFormat");
    if (has_nodes_) text_.fail("a second $Nodes");
    has_nodes_ = true;
    text_.need_line("the count of nodes");
    const int n = text_.count("the count of nodes", 8);
    stream_.surface.points.resize(n);
    for (int i = 0; i < n; ++i) {
      text_.need_line("node", i, n);
      const int number = text_.integer("a node number");
      if (number < 1) text_.fail("node number " + std::to_string(number) + ", but they are counted from 1");
      numbers_.add(number);
      stream_.surface.points[i] = text_.point();
    }
    if (int twice = numbers_.sort()) text_.fail("node number " + std::to_string(twice) + " is given twice");
  }

  void elements() {
    if (!has_nodes_) text_.fail("$Elements before $Nodes");
    if (has_elements_) text_.fail("a second $Elements");
    has_elements_ = true;
    text_.need_line("the count of elements");
    const int n = text_.count("the count of elements", 8);
    for (int i = 0; i < n; ++i) {
      text_.need_line("element", i, n);
      text_.integer("an element number");
      const int type = text_.integer("an element type"), tags = text_.integer("a number of tags");
      const int corners = type == 2 ? 3 : type == 3 ? 4 : 0;
      // the kinds of surface element of higher order: their corners alone would be another surface
      for (int curved : {9, 10, 16, 20, 21, 22, 23, 24, 25})
        if (type == curved) text_.fail("element type " + std::to_string(type) + " (curved) is not built yet");
      if (corners == 0) continue;
      int tag[2] = {0, 0};
      for (int k = 0; k < tags; ++k) {
        const int t = text_.integer("a tag");
        if (k < 2) tag[k] = t;
      }
      physical_.push_back(tag[0]);
      elementary_.push_back(tag[1]);
      for (int k = 0; k < corners; ++k) {
        const int number = text_.integer("a node number"), row = numbers_.row(number);
        if (row < 0)
          text_.fail("element " + std::to_string(i) + " uses node " + std::to_string(number) +
                     ", which is none of the " + std::to_string(numbers_.size()));
        polygons_.corners.push_back(row);
      }
      if (!text_.line_ends())
        text_.fail("element " + std::to_string(i) + " has more than its " + std::to_string(corners) +
                   " nodes");
      polygons_.ends.push_back(polygons_.corners.size());
    }
  }

  void label() {
    const int largest =
        physical_.empty() ? 0 : std::max(0, *std::max_element(physical_.begin(), physical_.end()));
    polygons_.patch.resize(physical_.size());
    for (std::size_t i = 0; i < physical_.size(); ++i) {
      const long long tag =
          physical_[i] != 0 ? physical_[i] : static_cast<long long>(largest) + elementary_[i];
      if (tag > std::numeric_limits<int>::max())
        text_.fail("elementary tag " + std::to_string(elementary_[i]) + " on top of physical tag " +
                   std::to_string(largest) + " is too large");
      polygons_.patch[i] = static_cast<int>(tag);
    }
  }

  Text text_;
  Stream stream_;
  Polygons polygons_;
  Numbers numbers_;
  std::vector<int> physical_, elementary_;  ///< tags by surface element
  bool has_format_ = false, has_nodes_ = false, has_elements_ = false;
};

}  // namespace

bool is_msh(std::string_view bytes) { return trim(bytes.substr(0, 64)).starts_with("$MeshFormat"); }

Stream read_msh(std::string_view bytes, const std::string& where) { return MshReader(bytes, where).read(); }

std::string write_msh(const Stream& stream, bool) {
  const Surface& s = stream.surface;
  const std::vector<int> patch = patches_of(stream);
  const ByPatch by = by_patch(stream);
  const long long shift = by.tags.empty() || by.tags[0] > 0 ? 0 : 1 - static_cast<long long>(by.tags[0]);
  std::string out = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  out.reserve(s.points.size() * 70 + s.tris.size() * 48);
  std::string named;
  int n_named = 0;
  for (int tag : by.tags)
    if (std::string name = one_line(stream.name_of(2, tag)); !name.empty()) {
      std::replace(name.begin(), name.end(), '"', '\'');
      named += "2 " + std::to_string(tag + shift) + " \"" + name + "\"\n";
      ++n_named;
    }
  if (n_named) out += "$PhysicalNames\n" + std::to_string(n_named) + '\n' + named + "$EndPhysicalNames\n";
  out += "$Nodes\n" + std::to_string(s.points.size()) + '\n';
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    append(out, static_cast<long long>(i) + 1);
    append_point(out, " ", s.points[i]);
  }
  out += "$EndNodes\n$Elements\n" + std::to_string(s.tris.size()) + '\n';
  for (std::size_t t = 0; t < s.tris.size(); ++t) {
    append(out, static_cast<long long>(t) + 1);
    out += " 2 2";
    for (long long v :
         {patch[t] + shift, patch[t] + shift, s.tris[t][0] + 1LL, s.tris[t][1] + 1LL, s.tris[t][2] + 1LL}) {
      out += ' ';
      append(out, v);
    }
    out += '\n';
  }
  return out + "$EndElements\n";
}

}  // namespace meshpipe
