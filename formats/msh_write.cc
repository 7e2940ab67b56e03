// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>

#include "formats/bytes.h"
#include "formats/columns.h"
#include "formats/msh.h"
#include "formats/polygons.h"
#include "formats/text.h"
#include "lib/error.h"

namespace meshpipe {
namespace {

/// Writes rows of a section, in text or binary.
class Sink {
 public:
  explicit Sink(bool ascii) : ascii_(ascii) {}

  void integer(long long v) { ascii_ ? word(v) : put(out, static_cast<int>(v)); }
  /// What version 4 writes in eight bytes.
  void wide(long long v) { ascii_ ? word(v) : put(out, v); }
  void real(double v) { ascii_ ? word(v) : put(out, v); }
  void end_row() {
    if (ascii_) out.back() = '\n';
  }
  /// A count that is text in either encoding.
  void line(std::size_t n) { out += std::to_string(n) + '\n'; }
  void end(const char* section) {
    out += ascii_ ? "$End" : "\n$End";
    out += section;
    out += '\n';
  }

  std::string out;

 private:
  template <class T>
  void word(T v) {
    append(out, v);
    out += ' ';
  }
  bool ascii_;
};

void head(Sink& sink, const char* version, bool ascii) {
  sink.out = std::string("$MeshFormat\n") + version + (ascii ? " 0 8\n" : " 1 8\n");
  if (!ascii) {
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

void names(Sink& sink, const Stream& stream, const ByPatch& by, long long shift) {
  std::string named;
  int n_named = 0;
  for (int tag : by.tags)
    if (std::string name = one_line(stream.name_of(2, tag)); !name.empty()) {
      std::replace(name.begin(), name.end(), '"', '\'');
      named += "2 " + std::to_string(tag + shift) + " \"" + name + "\"\n";
      ++n_named;
    }
  if (n_named)
    sink.out += "$PhysicalNames\n" + (std::to_string(n_named) + '\n') + named + "$EndPhysicalNames\n";
}

void data(Sink& sink, const char* section, const Table& table) {
  for (const Group& g : groups_of(table)) {
    if (g.name == "patch") continue;
    const std::size_t n = g.columns[0]->size(), m = g.columns.size();
    std::string name = one_line(g.name);
    std::replace(name.begin(), name.end(), '"', '\'');
    sink.out += std::string("$") + section + "\n1\n\"" + name + "\"\n1\n0\n3\n0\n" + std::to_string(m) +
                '\n' + std::to_string(n) + '\n';
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
    sink.end(section);
  }
}

}  // namespace

std::string write_msh2(const Stream& stream, bool ascii) {
  const Surface& s = stream.surface;
  const std::vector<int> patch = patches_of(stream);
  const ByPatch by = by_patch(stream);
  const long long shift = checked_shift(by);
  Sink sink(ascii);
  head(sink, "2.2", ascii);
  sink.out.reserve(s.points.size() * 70 + s.tris.size() * 48);
  names(sink, stream, by, shift);
  sink.out += "$Nodes\n";
  sink.line(s.points.size());
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    sink.integer(static_cast<long long>(i) + 1);
    for (double x : {s.points[i].x, s.points[i].y, s.points[i].z}) sink.real(x);
    sink.end_row();
  }
  sink.end("Nodes");
  sink.out += "$Elements\n";
  sink.line(s.tris.size());
  if (!ascii && !s.tris.empty())
    for (long long v : {2LL, static_cast<long long>(s.tris.size()), 2LL}) sink.integer(v);
  for (std::size_t t = 0; t < s.tris.size(); ++t) {
    sink.integer(static_cast<long long>(t) + 1);
    if (ascii) sink.out += "2 2 ";
    for (long long v :
         {patch[t] + shift, patch[t] + shift, s.tris[t][0] + 1LL, s.tris[t][1] + 1LL, s.tris[t][2] + 1LL})
      sink.integer(v);
    sink.end_row();
  }
  sink.end("Elements");
  data(sink, "NodeData", s.vertex);
  data(sink, "ElementData", s.face);
  return std::move(sink.out);
}

std::string write_msh4(const Stream& stream, bool ascii) {
  const Surface& s = stream.surface;
  const ByPatch by = by_patch(stream);
  const long long shift = checked_shift(by);
  Sink sink(ascii);
  head(sink, "4.1", ascii);
  sink.out.reserve(s.points.size() * 70 + s.tris.size() * 48);
  names(sink, stream, by, shift);

  // one surface a patch; nodes must be on one, and a mesh without triangles still has its nodes
  std::vector<long long> surface;
  for (int tag : by.tags) surface.push_back(tag + shift);
  if (surface.empty()) surface.push_back(1);
  sink.out += "$Entities\n";
  for (long long n : {0LL, 0LL, static_cast<long long>(surface.size()), 0LL}) sink.wide(n);
  sink.end_row();
  for (std::size_t k = 0; k < surface.size(); ++k) {
    Vec3 low, high;
    const std::size_t end = by.tags.empty() ? 0 : by.first[k + 1];
    for (std::size_t i = by.tags.empty() ? 0 : by.first[k]; i < end; ++i)
      for (int v : s.tris[by.order[i]]) {
        const Vec3 p = s.points[v];
        if (i == by.first[k] && v == s.tris[by.order[i]][0]) low = high = p;
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
      }
    sink.integer(surface[k]);
    for (double x : {low.x, low.y, low.z, high.x, high.y, high.z}) sink.real(x);
    sink.wide(1);
    sink.integer(surface[k]);
    sink.wide(0);
    sink.end_row();
  }
  sink.end("Entities");

  const auto n_points = static_cast<long long>(s.points.size()),
             n_tris = static_cast<long long>(s.tris.size());
  sink.out += "$Nodes\n";
  for (long long v : {1LL, n_points, std::min(1LL, n_points), n_points}) sink.wide(v);
  sink.end_row();
  for (long long v : {2LL, surface[0], 0LL}) sink.integer(v);
  sink.wide(n_points);
  sink.end_row();
  for (long long i = 1; i <= n_points; ++i) {
    sink.wide(i);
    sink.end_row();
  }
  for (const Vec3& p : s.points) {
    for (double x : {p.x, p.y, p.z}) sink.real(x);
    sink.end_row();
  }
  sink.end("Nodes");

  sink.out += "$Elements\n";
  for (long long v : {static_cast<long long>(by.tags.size()), n_tris, std::min(1LL, n_tris), n_tris})
    sink.wide(v);
  sink.end_row();
  for (std::size_t k = 0; k < by.tags.size(); ++k) {
    for (long long v : {2LL, surface[k], 2LL}) sink.integer(v);
    sink.wide(static_cast<long long>(by.first[k + 1] - by.first[k]));
    sink.end_row();
    for (std::size_t i = by.first[k]; i < by.first[k + 1]; ++i) {
      const int t = by.order[i];
      sink.wide(t + 1LL);
      for (int v : s.tris[t]) sink.wide(v + 1LL);
      sink.end_row();
    }
  }
  sink.end("Elements");
  data(sink, "NodeData", s.vertex);
  data(sink, "ElementData", s.face);
  return std::move(sink.out);
}

}  // namespace meshpipe
