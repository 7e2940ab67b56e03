// SPDX-License-Identifier: BSD-3-Clause
// Tiny meshes drawn in ASCII, as states to test single operations on.
#pragma once
#include <sstream>
#include <string>
#include <vector>

#include "lib/relax/state.h"

namespace meshpipe {

/// A mesh as a surface whose size asks for this number of triangles.
inline Surface sized(const Mesh& mesh, double triangles) {
  Surface s = surface_of(mesh);
  const double h = std::sqrt(4 * total_area(mesh) / (std::sqrt(3.0) * triangles));
  s.vertex.set("size", std::vector<double>(mesh.points.size(), h));
  return s;
}

/// A surface as the lifted mesh of itself: every vertex at its own place.
inline LiftedMesh lifted_of(const Surface& s) {
  LiftedMesh m;
  m.points = s.points;
  m.tris = s.tris;
  const std::size_t n = s.points.size();
  m.place.resize(n);
  for (int t = 0; t < (int)s.tris.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      Place p{t, 0, 0, 0};
      (i == 0 ? p.b0 : i == 1 ? p.b1 : p.b2) = 1;
      m.place[s.tris[t][i]] = p;
    }
  m.kind.assign(n, 0);
  m.line.assign(n, -1);
  m.size = s.vertex.get<double>("size");
  m.patch = s.face.has("patch") ? s.face.get<int>("patch") : std::vector<int>(s.tris.size(), 1);
  m.part.assign(s.tris.size(), 0);
  m.model =
      s.face.has("model") ? s.face.get<std::uint8_t>("model") : std::vector<std::uint8_t>(s.tris.size(), 0);
  return m;
}

/// Vertices are letters, from a on without gaps: x is the column, y twice the row counted from below.
/// Triangles are words of three letters, counterclockwise. The size field is 4, and `model` names model
/// edges: "ab cd".
inline Surface drawn_surface(const std::vector<std::string>& rows, const std::string& triangles,
                             const std::string& model = "") {
  Mesh mesh;
  for (int j = 0; j < (int)rows.size(); ++j)
    for (int i = 0; i < (int)rows[j].size(); ++i) {
      if (rows[j][i] == ' ') continue;
      const std::size_t v = rows[j][i] - 'a';
      if (mesh.points.size() <= v) mesh.points.resize(v + 1);
      mesh.points[v] = {(double)i, 2.0 * ((double)rows.size() - 1 - j), 0};
    }
  std::istringstream words(triangles);
  for (std::string w; words >> w;) mesh.tris.push_back({w[0] - 'a', w[1] - 'a', w[2] - 'a'});
  Surface s = surface_of(mesh);
  s.vertex.set("size", std::vector<double>(s.points.size(), 4));
  std::vector<std::uint8_t> bits(s.tris.size());
  std::istringstream edges(model);
  for (std::string e; edges >> e;)
    for (std::size_t t = 0; t < s.tris.size(); ++t)
      for (int i = 0; i < 3; ++i) {
        const int a = s.tris[t][i], b = s.tris[t][(i + 1) % 3];
        if ((a == e[0] - 'a' && b == e[1] - 'a') || (b == e[0] - 'a' && a == e[1] - 'a')) bits[t] |= 1 << i;
      }
  s.face.set("model", bits);
  return s;
}

/// A roof with the ridge c-d at height 0 above y = 1; its eaves go through a and b.
inline Surface roof(double drop) {
  Surface s = drawn_surface({"    b    ",  //
                             "c       d",  //
                             "    a    "},
                            "adc bcd");
  for (char v : {'a', 'b'}) {
    Vec3& p = s.points[v - 'a'];
    p = {p.x, 0.5 * p.y, -drop};
  }
  for (char v : {'c', 'd'}) s.points[v - 'a'].y = 1;
  return s;
}

/// The state of a drawn surface, which is its own reference.
struct Drawn {
  explicit Drawn(Surface of, const Surface* mesh = nullptr)
      : surface(std::move(of)),
        reference(surface),
        lifted(lifted_of(mesh ? *mesh : surface)),
        s(start_state(lifted, reference, {}, {})) {}
  Drawn(const Drawn&) = delete;
  /// The half-edge from one letter to another; -1 if there is none.
  int edge(char a, char b) const {
    for (int h = 0; h < (int)s.mesh.opp.size(); ++h)
      if (!s.mesh.dead(h / 3) && s.mesh.from(h) == a - 'a' && s.mesh.to(h) == b - 'a') return h;
    return -1;
  }
  double area() const {
    double sum = 0;
    for (const auto& [a, b, c] : s.mesh.tris)
      if (a >= 0) sum += 0.5 * area_vector(s.points[a], s.points[b], s.points[c]).z;
    return sum;
  }

  Surface surface;
  Reference reference;
  LiftedMesh lifted;
  State s;
};

/// Puts the vertices of a mesh at those of its reference, which has other triangles.
inline void put_at_corners(Drawn& m, const Surface& reference) {
  for (int t = 0; t < (int)reference.tris.size(); ++t)
    for (int i = 0; i < 3; ++i)
      m.s.place[reference.tris[t][i]] = {t, 1.0 * (i == 0), 1.0 * (i == 1), 1.0 * (i == 2)};
}

}  // namespace meshpipe
