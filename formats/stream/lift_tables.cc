// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream/lift_tables.h"

#include <numeric>

#include "lib/core/error.h"

namespace meshpipe {
namespace {

template <class T>
std::vector<T> copy_or(const Table& table, const char* column, std::vector<T> otherwise) {
  return table.has(column) ? table.get<T>(column) : std::move(otherwise);
}

/// Returns whether a column of vertices belongs to the stream, not to the user.
bool is_own(const std::string& column) {
  for (const char* own : {"x", "y", "z", "size", "ref_face", "b1", "b2", "kind", "line"})
    if (column == own) return true;
  return false;
}

/// Returns the mesh that a table of points and one of corners hold.
Mesh mesh_of(const Table& vertex, const Table& face) {
  const auto &x = vertex.get<double>("x"), &y = vertex.get<double>("y"), &z = vertex.get<double>("z");
  const auto &a = face.get<int>("a"), &b = face.get<int>("b"), &c = face.get<int>("c");
  Mesh mesh;
  mesh.points.reserve(vertex.rows);
  for (std::size_t v = 0; v < vertex.rows; ++v) mesh.points.push_back({x[v], y[v], z[v]});
  mesh.tris.reserve(face.rows);
  for (std::size_t t = 0; t < face.rows; ++t) {
    for (int v : {a[t], b[t], c[t]})
      if (v < 0 || v >= (int)vertex.rows)
        throw BadInput(face.name + ' ' + std::to_string(t) + " uses vertex " + std::to_string(v) +
                       ", but there are " + std::to_string(vertex.rows));
    mesh.tris.push_back({a[t], b[t], c[t]});
  }
  return mesh;
}

Table points_table(const char* name, const Mesh& mesh) {
  std::vector<double> xyz[3];
  for (Vec3 p : mesh.points) {
    xyz[0].push_back(p.x);
    xyz[1].push_back(p.y);
    xyz[2].push_back(p.z);
  }
  Table table{name, 0, {}};
  table.set("x", std::move(xyz[0]));
  table.set("y", std::move(xyz[1]));
  table.set("z", std::move(xyz[2]));
  return table;
}

Table corners_table(const char* name, const Mesh& mesh) {
  std::vector<int> corner[3];
  for (const Tri& t : mesh.tris)
    for (int i = 0; i < 3; ++i) corner[i].push_back(t[i]);
  Table table{name, 0, {}};
  table.set("a", std::move(corner[0]));
  table.set("b", std::move(corner[1]));
  table.set("c", std::move(corner[2]));
  return table;
}

/// Interpolates the input's vertex data at the vertices of the mesh: doubles linearly on the triangles,
/// others from the nearest corner.
void interpolate_data(const Stream& stream, const LiftedMesh& mesh, Table& vertex) {
  const Table& reference = stream.need("ref_vertex", "mlift");
  const Table& face = stream.need("ref_face", "mlift");
  const auto &a = face.get<int>("a"), &b = face.get<int>("b"), &c = face.get<int>("c");
  for (const Column& column : reference.columns) {
    if (is_own(column.name)) continue;
    std::visit(
        [&]<class T>(const std::vector<T>& from) {
          std::vector<T> to;
          to.reserve(mesh.place.size());
          for (const Place& p : mesh.place) {
            const int corner[3] = {a[p.face], b[p.face], c[p.face]};
            if constexpr (std::is_same_v<T, double>)
              to.push_back(p.b0 * from[corner[0]] + p.b1 * from[corner[1]] + p.b2 * from[corner[2]]);
            else
              to.push_back(from[corner[nearest_corner(p)]]);
          }
          vertex.set(column.name, std::move(to));
        },
        column.data);
  }
}

}  // namespace

LiftedMesh take_lifted(Surface& s, int n_faces, int n_lines) {
  if (!s.vertex.has("ref_face"))
    throw NotAdmissible("the vertices have no place on a reference; run mlift first");
  LiftedMesh mesh;
  mesh.points = std::move(s.points);
  mesh.tris = std::move(s.tris);
  const auto& face = s.vertex.get<int>("ref_face");
  const auto &b1 = s.vertex.get<double>("b1"), &b2 = s.vertex.get<double>("b2");
  mesh.kind = std::move(s.vertex.get<int>("kind"));
  mesh.line = std::move(s.vertex.get<int>("line"));
  mesh.size = std::move(s.vertex.get<double>("size"));
  mesh.place.reserve(mesh.points.size());
  constexpr double slack = 1e-9;  // barycentrics are rounded when they are computed
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    auto bad = [&](const std::string& what) { throw BadInput("vertex " + std::to_string(v) + ' ' + what); };
    if (face[v] < 0 || face[v] >= n_faces)
      bad("is on ref_face " + std::to_string(face[v]) + ", but there are " + std::to_string(n_faces));
    if (!(b1[v] >= -slack && b2[v] >= -slack && b1[v] + b2[v] <= 1 + slack))
      bad("has barycentrics " + std::to_string(b1[v]) + ", " + std::to_string(b2[v]) +
          " outside its triangle");
    if (mesh.kind[v] < 0 || mesh.kind[v] > 2)
      bad("has kind " + std::to_string(mesh.kind[v]) + ", kinds are 0 to 2");
    if (mesh.line[v] < -1 || mesh.line[v] >= n_lines)
      bad("is on line " + std::to_string(mesh.line[v]) + ", but there are " + std::to_string(n_lines));
    if (!(mesh.size[v] > 0)) bad("has size " + std::to_string(mesh.size[v]) + ", but sizes are positive");
    mesh.place.push_back({face[v], 1 - b1[v] - b2[v], b1[v], b2[v]});
  }
  mesh.patch = std::move(s.face.get<int>("patch"));
  mesh.part = std::move(s.face.get<int>("part"));
  mesh.model = std::move(s.face.get<std::uint8_t>("model"));
  return mesh;
}

Surface surface_from(LiftedMesh mesh) {
  Surface s;
  s.points = std::move(mesh.points);
  s.tris = std::move(mesh.tris);
  std::vector<int> face;
  std::vector<double> b1, b2;
  for (const Place& p : mesh.place) {
    face.push_back(p.face);
    b1.push_back(p.b1);
    b2.push_back(p.b2);
  }
  s.vertex.set("size", std::move(mesh.size));
  s.vertex.set("ref_face", std::move(face));
  s.vertex.set("b1", std::move(b1));
  s.vertex.set("b2", std::move(b2));
  s.vertex.set("kind", std::move(mesh.kind));
  s.vertex.set("line", std::move(mesh.line));
  s.face.set("patch", std::move(mesh.patch));
  s.face.set("part", std::move(mesh.part));
  s.face.set("model", std::move(mesh.model));
  return s;
}

void write_lifted(Stream& stream, LiftedMesh mesh) {
  Table data{"vertex", 0, {}};
  interpolate_data(stream, mesh, data);
  stream.surface = surface_from(std::move(mesh));
  for (Column& c : data.columns) stream.surface.vertex.columns.push_back(std::move(c));
  stream.erase("mid_vertex");
}

Surface read_reference(const Stream& stream) {
  const Table& vertex = stream.need("ref_vertex", "mlift");
  const Table& face = stream.need("ref_face", "mlift");
  Surface s = surface_of(mesh_of(vertex, face));
  if (vertex.has("size")) s.vertex.set("size", vertex.get<double>("size"));
  for (const char* name : {"patch", "part", "origin"}) s.face.set(name, face.get<int>(name));
  for (const char* name : {"model", "curved"})
    if (face.has(name)) s.face.set(name, face.get<std::uint8_t>(name));
  return s;
}

void write_reference(Stream& stream, const Surface& reference) {
  for (const char* table : {"fine_vertex", "fine_face"}) stream.erase(table);
  Table vertex = points_table("ref_vertex", reference);
  if (reference.vertex.has("size")) vertex.set("size", reference.vertex.get<double>("size"));
  for (const Column& c : reference.vertex.columns)
    if (!is_own(c.name)) vertex.columns.push_back(c);
  stream.set(std::move(vertex));

  const std::size_t n = reference.tris.size();
  std::vector<int> zero(n, 0), self(n);
  std::iota(self.begin(), self.end(), 0);
  Table face = corners_table("ref_face", reference);
  face.set("patch", copy_or<int>(reference.face, "patch", zero));
  face.set("part", copy_or<int>(reference.face, "part", zero));
  face.set("origin", copy_or<int>(reference.face, "origin", self));
  face.set("model", copy_or<std::uint8_t>(reference.face, "model", std::vector<std::uint8_t>(n, 0)));
  if (reference.face.has("curved")) face.set("curved", reference.face.get<std::uint8_t>("curved"));
  stream.set(std::move(face));
}

std::optional<Surface> take_fine(Stream& stream) {
  if (!stream.find("fine_vertex") && !stream.find("fine_face")) return std::nullopt;
  const Table& vertex = stream.need("fine_vertex", "mcoarsen");
  const Table& face = stream.need("fine_face", "mcoarsen");
  if (face.rows == 0) throw BadInput("'fine_face' has no rows");
  Surface s = surface_of(mesh_of(vertex, face));
  for (const Column& c : vertex.columns)
    if (!is_own(c.name)) s.vertex.columns.push_back(c);
  s.face.set("patch", face.get<int>("patch"));
  s.face.set("model", face.get<std::uint8_t>("model"));
  for (const char* table : {"fine_vertex", "fine_face"}) stream.erase(table);
  return s;
}

void write_fine(Stream& stream, const Surface& fine) {
  Table vertex = points_table("fine_vertex", fine), face = corners_table("fine_face", fine);
  for (const Column& c : fine.vertex.columns)
    if (!is_own(c.name)) vertex.columns.push_back(c);
  face.set("patch", copy_or<int>(fine.face, "patch", std::vector<int>(fine.tris.size(), 0)));
  face.set("model",
           copy_or<std::uint8_t>(fine.face, "model", std::vector<std::uint8_t>(fine.tris.size(), 0)));
  stream.set(std::move(vertex));
  stream.set(std::move(face));
}

}  // namespace meshpipe
