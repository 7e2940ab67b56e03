// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>

#include "formats/foreign/bytes.h"
#include "formats/foreign/columns.h"
#include "formats/foreign/msh.h"
#include "formats/foreign/polygons.h"
#include "formats/foreign/rows.h"
#include "formats/stream/model_lines.h"
#include "formats/stream/second_order.h"
#include "formats/text.h"
#include "lib/core/error.h"

namespace meshpipe {
namespace {

class SectionWriter : public Rows {
 public:
  using Rows::Rows;
  /// Writes a count, which is text in both encodings.
  void line(std::size_t n) { out += std::to_string(n) + '\n'; }
  void end(const char* section) {
    out += ascii() ? "$End" : "\n$End";
    out += section;
    out += '\n';
  }
};

void head(SectionWriter& sink, const char* version) {
  sink.out = std::string("$MeshFormat\n") + version + (sink.ascii() ? " 0 8\n" : " 1 8\n");
  if (!sink.ascii()) {
    put(sink.out, 1);
    sink.out += '\n';
  }
  sink.out += "$EndMeshFormat\n";
}

long long checked_shift(const ByPatch& by) {
  const long long shift = shift_to_positive(by);
  if (!by.tags.empty() && by.tags.back() + shift > std::numeric_limits<int>::max())
    throw CannotWrite("patch " + std::to_string(by.tags.back()) + " counted up by " + std::to_string(shift) +
                      " is too large for msh");
  return shift;
}

/// The model edges that have a label, sorted by label.
struct Curves {
  bool all = false;  ///< all model edges have a label (and there are some): their bits need not be written
  std::vector<LineEdge> edges;
  std::vector<int> tags;
  std::vector<std::size_t> first;  ///< edges first[k] .. first[k+1] have tags[k]
};

Curves curves_of(const Stream& stream) {
  Curves c;
  c.edges = model_lines(stream);
  c.all = !c.edges.empty() && std::erase_if(c.edges, [](const LineEdge& e) { return e.tag <= 0; }) == 0;
  std::stable_sort(c.edges.begin(), c.edges.end(),
                   [](const LineEdge& x, const LineEdge& y) { return x.tag < y.tag; });
  for (std::size_t i = 0; i < c.edges.size(); ++i)
    if (i == 0 || c.edges[i].tag != c.tags.back()) {
      c.tags.push_back(c.edges[i].tag);
      c.first.push_back(i);
    }
  c.first.push_back(c.edges.size());
  return c;
}

void names(SectionWriter& sink, const Stream& stream, const ByPatch& by, long long shift,
           const Curves& curves) {
  std::string named;
  int n_named = 0;
  auto add = [&](int dim, int tag, long long shown) {
    const std::string name = one_line(stream.name_of(dim, tag));
    if (name.empty()) return;
    named += std::to_string(dim) + ' ' + std::to_string(shown) + " \"" + quotable(name) + "\"\n";
    ++n_named;
  };
  for (int tag : curves.tags) add(1, tag, tag);
  for (int tag : by.tags) add(2, tag, tag + shift);
  if (n_named)
    sink.out += "$PhysicalNames\n" + (std::to_string(n_named) + '\n') + named + "$EndPhysicalNames\n";
}

/// What both versions are written from; their first sections are written.
struct Begun {
  SecondOrder second;
  ByPatch by;
  long long shift;
  Curves curves;
  SectionWriter sink;

  Begun(const Stream& stream, const char* version, bool ascii)
      : second(stream),
        by(by_patch(stream)),
        shift(checked_shift(by)),
        curves(curves_of(stream)),
        sink(ascii) {
    const Surface& s = second.surface();
    head(sink, version);
    sink.out.reserve(s.points.size() * 70 + s.tris.size() * 48);
    names(sink, stream, by, shift, curves);
  }
};

int triangle_type(const SecondOrder& second) { return second ? 9 : 2; }
int line_type(const SecondOrder& second) { return second ? 8 : 1; }

template <class Visit>
void for_each_node(const Tri& t, const SecondOrder& second, const Visit& visit) {
  for (int v : t) visit(v);
  for (int i = 0; second && i < 3; ++i) visit(second.node(t[i], t[(i + 1) % 3]));
}
template <class Visit>
void for_each_node(const LineEdge& e, const SecondOrder& second, const Visit& visit) {
  visit(e.a);
  visit(e.b);
  if (second) visit(second.node(e.a, e.b));
}

/// Writes data of all vertices or faces. Line elements get zeros, since readers want data for all elements.
void data(SectionWriter& sink, const char* section, const Table& table, const Curves& curves) {
  const std::size_t more = table.name == "face" ? curves.edges.size() : 0;
  for (const Group& g : groups_of(table)) {
    if (g.name == "patch" || (g.name == "model" && curves.all)) continue;
    const std::size_t n = g.columns[0]->size(), m = g.columns.size();
    sink.out += std::string("$") + section + "\n1\n\"" + quotable(one_line(g.name)) + "\"\n1\n0\n3\n0\n" +
                std::to_string(m) + '\n' + std::to_string(n + more) + '\n';
    const Array array = array_of(g);
    std::visit(
        [&](const auto& v) {
          for (std::size_t i = 0; i < n; ++i) {
            sink.integer(static_cast<long long>(i) + 1);
            for (std::size_t k = 0; k < m; ++k) sink.real(static_cast<double>(v[i * m + k]));
            sink.end_row();
          }
        },
        array.data);
    for (std::size_t i = n; i < n + more; ++i) {
      sink.integer(static_cast<long long>(i) + 1);
      for (std::size_t k = 0; k < m; ++k) sink.real(0);
      sink.end_row();
    }
    sink.end(section);
  }
}

/// The box of some points; the origin if there are none.
struct Bounds {
  Vec3 low, high;
  bool is_empty = true;

  void cover(Vec3 p) {
    if (is_empty) low = high = p;
    is_empty = false;
    low = lower(low, p), high = upper(high, p);
  }
};

/// Writes an entity: its box, one physical tag, nothing that bounds it.
void entity_4(SectionWriter& sink, long long tag, const Bounds& box) {
  sink.integer(tag);
  for (double x : {box.low.x, box.low.y, box.low.z, box.high.x, box.high.y, box.high.z}) sink.real(x);
  sink.wide(1);
  sink.integer(tag);
  sink.wide(0);
  sink.end_row();
}

void entities_4(Begun& begun, const std::vector<long long>& surfaces) {
  SectionWriter& sink = begun.sink;
  const Surface& s = begun.second.surface();
  const Curves& curves = begun.curves;
  sink.out += "$Entities\n";
  for (std::size_t n : {std::size_t{0}, curves.tags.size(), surfaces.size(), std::size_t{0}})
    sink.wide(static_cast<long long>(n));
  sink.end_row();
  for (std::size_t k = 0; k < curves.tags.size(); ++k) {
    Bounds box;
    for (std::size_t i = curves.first[k]; i < curves.first[k + 1]; ++i)
      for (int v : {curves.edges[i].a, curves.edges[i].b}) box.cover(s.points[v]);
    entity_4(sink, curves.tags[k], box);
  }
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    Bounds box;
    for (std::size_t i = begun.by.first[k]; k < begun.by.tags.size() && i < begun.by.first[k + 1]; ++i)
      for (int v : s.tris[begun.by.order[i]]) box.cover(s.points[v]);
    entity_4(sink, surfaces[k], box);
  }
  sink.end("Entities");
}

/// Writes all nodes as one block on a surface.
void nodes_4(SectionWriter& sink, const std::vector<Vec3>& points, long long surface) {
  const auto n = static_cast<long long>(points.size());
  sink.out += "$Nodes\n";
  for (long long v : {1LL, n, std::min(1LL, n), n}) sink.wide(v);
  sink.end_row();
  for (long long v : {2LL, surface, 0LL}) sink.integer(v);
  sink.wide(n);
  sink.end_row();
  for (long long i = 1; i <= n; ++i) {
    sink.wide(i);
    sink.end_row();
  }
  for (const Vec3& p : points) {
    for (double x : {p.x, p.y, p.z}) sink.real(x);
    sink.end_row();
  }
  sink.end("Nodes");
}

void elements_4(Begun& begun, const std::vector<long long>& surfaces) {
  SectionWriter& sink = begun.sink;
  const SecondOrder& second = begun.second;
  const std::vector<Tri>& tris = second.surface().tris;
  const Curves& curves = begun.curves;
  const auto n_tris = static_cast<long long>(tris.size()),
             n_elements = n_tris + static_cast<long long>(curves.edges.size());
  auto begin_block = [&](int dim, long long tag, int type, std::size_t n) {
    for (long long v : {static_cast<long long>(dim), tag, static_cast<long long>(type)}) sink.integer(v);
    sink.wide(static_cast<long long>(n));
    sink.end_row();
  };
  auto element = [&](long long number, const auto& corners) {
    sink.wide(number + 1);
    for_each_node(corners, second, [&](int v) { sink.wide(v + 1LL); });
    sink.end_row();
  };
  sink.out += "$Elements\n";
  for (long long v : {static_cast<long long>(begun.by.tags.size() + curves.tags.size()), n_elements,
                      std::min(1LL, n_elements), n_elements})
    sink.wide(v);
  sink.end_row();
  for (std::size_t k = 0; k < begun.by.tags.size(); ++k) {
    begin_block(2, surfaces[k], triangle_type(second), begun.by.first[k + 1] - begun.by.first[k]);
    for (std::size_t i = begun.by.first[k]; i < begun.by.first[k + 1]; ++i)
      element(begun.by.order[i], tris[begun.by.order[i]]);
  }
  for (std::size_t k = 0; k < curves.tags.size(); ++k) {
    begin_block(1, curves.tags[k], line_type(second), curves.first[k + 1] - curves.first[k]);
    for (std::size_t i = curves.first[k]; i < curves.first[k + 1]; ++i)
      element(n_tris + static_cast<long long>(i), curves.edges[i]);
  }
  sink.end("Elements");
}

}  // namespace

std::string write_msh2(const Stream& stream, bool ascii) {
  Begun begun(stream, "2.2", ascii);
  SectionWriter& sink = begun.sink;
  const SecondOrder& second = begun.second;
  const Surface& s = second.surface();
  const Curves& curves = begun.curves;
  const std::vector<int> patch = patches_of(stream);
  sink.out += "$Nodes\n";
  sink.line(s.points.size());
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    sink.integer(static_cast<long long>(i) + 1);
    for (double x : {s.points[i].x, s.points[i].y, s.points[i].z}) sink.real(x);
    sink.end_row();
  }
  sink.end("Nodes");
  sink.out += "$Elements\n";
  sink.line(s.tris.size() + curves.edges.size());
  // text has the type and the number of tags in each row, binary once per block
  auto begin = [&](int type, std::size_t n) {
    if (!ascii && n > 0)
      for (long long v : {static_cast<long long>(type), static_cast<long long>(n), 2LL}) sink.integer(v);
  };
  auto element = [&](std::size_t number, int type, long long label) {
    sink.integer(static_cast<long long>(number) + 1);
    if (ascii) sink.out += std::to_string(type) + " 2 ";
    sink.integer(label);
    sink.integer(label);
  };
  begin(triangle_type(second), s.tris.size());
  for (std::size_t t = 0; t < s.tris.size(); ++t) {
    element(t, triangle_type(second), patch[t] + begun.shift);
    for_each_node(s.tris[t], second, [&](int v) { sink.integer(v + 1LL); });
    sink.end_row();
  }
  begin(line_type(second), curves.edges.size());
  for (std::size_t i = 0; i < curves.edges.size(); ++i) {
    element(s.tris.size() + i, line_type(second), curves.edges[i].tag);
    for_each_node(curves.edges[i], second, [&](int v) { sink.integer(v + 1LL); });
    sink.end_row();
  }
  sink.end("Elements");
  data(sink, "NodeData", s.vertex, curves);
  data(sink, "ElementData", s.face, curves);
  return std::move(sink.out);
}

std::string write_msh4(const Stream& stream, bool ascii) {
  Begun begun(stream, "4.1", ascii);
  // one surface per patch; nodes must be on one, and a mesh without triangles still has its nodes
  std::vector<long long> surfaces;
  for (int tag : begun.by.tags) surfaces.push_back(tag + begun.shift);
  if (surfaces.empty()) surfaces.push_back(1);
  entities_4(begun, surfaces);
  nodes_4(begun.sink, begun.second.surface().points, surfaces[0]);
  elements_4(begun, surfaces);
  data(begun.sink, "NodeData", begun.second.surface().vertex, begun.curves);
  data(begun.sink, "ElementData", begun.second.surface().face, begun.curves);
  return std::move(begun.sink.out);
}

}  // namespace meshpipe
