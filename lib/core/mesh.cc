// SPDX-License-Identifier: BSD-3-Clause
#include "lib/core/mesh.h"

#include <omp.h>

#include <algorithm>
#include <cmath>

#include "lib/core/connectivity.h"
#include "lib/core/error.h"
#include "lib/core/lists.h"
#include "lib/core/number.h"
#include "lib/core/parallel.h"

namespace meshpipe {

std::size_t Column::size() const {
  return std::visit([](const auto& v) { return v.size(); }, data);
}

const Column* Table::find(std::string_view column) const {
  for (const Column& c : columns)
    if (c.name == column) return &c;
  return nullptr;
}

template <class T>
std::vector<T>& Table::get(std::string_view column) {
  return const_cast<std::vector<T>&>(static_cast<const Table*>(this)->get<T>(column));
}

template <class T>
const std::vector<T>& Table::get(std::string_view column) const {
  const Column* c = find(column);
  if (!c) throw NotAdmissible("no column '" + std::string(column) + "' in table '" + name + "'");
  const auto* v = std::get_if<std::vector<T>>(&c->data);
  if (!v)
    throw NotAdmissible("column '" + std::string(column) + "' of table '" + name + "' has another type");
  return *v;
}

template <class T>
std::vector<T>& Table::set(std::string_view column, std::vector<T> values) {
  if (columns.empty()) rows = values.size();
  if (values.size() != rows)
    throw std::logic_error("column '" + std::string(column) + "' has " + std::to_string(values.size()) +
                           " values, table '" + name + "' has " + std::to_string(rows) + " rows");
  for (Column& c : columns)
    if (c.name == column) return c.data = std::move(values), std::get<std::vector<T>>(c.data);
  columns.push_back({std::string(column), std::move(values)});
  return std::get<std::vector<T>>(columns.back().data);
}

void Table::erase(std::string_view column) {
  std::erase_if(columns, [&](const Column& c) { return c.name == column; });
}

#define MESHPIPE_INSTANTIATE(T)                                         \
  template std::vector<T>& Table::get<T>(std::string_view);             \
  template const std::vector<T>& Table::get<T>(std::string_view) const; \
  template std::vector<T>& Table::set<T>(std::string_view, std::vector<T>);
MESHPIPE_INSTANTIATE(std::uint8_t)
MESHPIPE_INSTANTIATE(int)
MESHPIPE_INSTANTIATE(double)
#undef MESHPIPE_INSTANTIATE

Surface surface_of(Mesh mesh) {
  Surface s;
  static_cast<Mesh&>(s) = std::move(mesh);
  s.vertex.rows = s.points.size();
  s.face.rows = s.tris.size();
  return s;
}

SubMesh sub_mesh(const Mesh& mesh, std::vector<int> faces, std::vector<int>& number) {
  SubMesh part;
  part.face = std::move(faces);
  part.tris.reserve(part.face.size());
  for (int t : part.face) {
    Tri& corners = part.tris.emplace_back(mesh.tris[t]);
    for (int& v : corners) {
      if (number[v] < 0) {
        number[v] = (int)part.vertex.size();
        part.vertex.push_back(v);
      }
      v = number[v];
    }
  }
  part.points.reserve(part.vertex.size());
  for (int v : part.vertex) {
    part.points.push_back(mesh.points[v]);
    number[v] = -1;
  }
  return part;
}

std::vector<SubMesh> split_by_label(const Mesh& mesh, const std::vector<int>& label, int n) {
  const Lists faces = lists_of(n, [&](auto use) {
    for (int t = 0; t < (int)mesh.tris.size(); ++t)
      if (0 <= label[t] && label[t] < n) use(label[t], t);
  });
  std::vector<std::vector<int>> number(omp_get_max_threads());
  std::vector<SubMesh> parts(n);
  const bool worth = mesh.tris.size() > 30000;
  auto take = [&](int l) {
    std::vector<int>& mine = number[thread_of_loop(n, worth)];
    mine.resize(mesh.points.size(), -1);
    parts[l] = sub_mesh(mesh, {faces[l].begin(), faces[l].end()}, mine);
  };
  parallel_for(n, take, worth);
  return parts;
}

namespace {

/// The box of points, and the largest of their coordinates.
struct Extent {
  double far = 0;
  Vec3 lo{infinity, infinity, infinity}, hi{-infinity, -infinity, -infinity};
  void add(const Vec3& p) {
    far = std::max({far, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    lo = lower(lo, p), hi = upper(hi, p);
  }
  double size() const { return std::max({0.0, hi.x - lo.x, hi.y - lo.y, hi.z - lo.z}); }
};

constexpr double least_size = 1e-50, most_far = 1e50;

bool is_measurable(const Extent& e) { return e.far <= most_far && !(e.size() > 0 && e.size() < least_size); }

/// That of all points, or of those that triangles use if that is not measurable.
Extent extent_of(const Mesh& mesh) {
  Extent all, used;
  for (const Vec3& p : mesh.points) all.add(p);
  if (is_measurable(all)) return all;
  for (const Tri& t : mesh.tris)
    for (int v : t) used.add(mesh.points[v]);
  return used;
}

}  // namespace

int measurable_unit(const Mesh& mesh) {
  const Extent e = extent_of(mesh);
  int exponent = 0;
  if (!is_measurable(e)) std::frexp(e.far, &exponent);
  return exponent;
}

void expect_measurable(const Mesh& mesh) {
  const Extent e = extent_of(mesh);
  if (is_measurable(e)) return;
  const bool far = e.far > most_far;
  throw NotAdmissible((far ? "a coordinate of " + shown(e.far) : "a size of " + shown(e.size())) +
                      " is beyond the limit of " + shown(far ? most_far : least_size) +
                      ": try mconvert --scale 1e" + std::to_string(-(int)std::log10(e.far)));
}

std::vector<char> used_points(const Mesh& mesh) {
  std::vector<char> used(mesh.points.size(), 0);
  for (const Tri& t : mesh.tris)
    for (int v : t) used[v] = 1;
  return used;
}

double diagonal(const Mesh& mesh) {
  const Extent e = extent_of(mesh);
  return mesh.tris.empty() ? 0 : norm(e.hi - e.lo);
}

double total_area(const Mesh& mesh) {
  double a = 0;
  for (std::size_t t = 0; t < mesh.tris.size(); ++t) a += triangle_area(mesh, (int)t);
  return a;
}

double kappa(Vec3 a, Vec3 b, Vec3 c) {
  // 2 r_in / R_circ = 16 A^2 / (abc (a+b+c)), the same number without trigonometry
  double la = norm(b - c), lb = norm(c - a), lc = norm(a - b), n = norm(area_vector(a, b, c));
  double d = la * lb * lc * (la + lb + lc);
  return d > 0 ? 4 * n * n / d : 0;
}

}  // namespace meshpipe
