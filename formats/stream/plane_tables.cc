// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream/plane_tables.h"

#include <algorithm>

#include "lib/core/error.h"

namespace meshpipe {

std::vector<PlaneMesh> read_plane_meshes(const Stream& stream, const std::vector<Chart>& charts) {
  const Table& point = stream.need("chart_point", "mmesh2d");
  const Table& face = stream.need("chart_face", "mmesh2d");
  const int n_line_points = static_cast<int>(stream.need("line_vertex", "mlines").rows);
  const int n_parts = static_cast<int>(charts.size()), n_points = static_cast<int>(point.rows);
  auto bad = [](const char* table, int row, const std::string& what) {
    throw BadInput(std::string(table) + ' ' + std::to_string(row) + ' ' + what);
  };

  std::vector<PlaneMesh> meshes(n_parts);
  const auto &part = point.get<int>("part"), &row = point.get<int>("line_vertex"),
             &in = point.get<int>("face");
  const auto &u = point.get<double>("u"), &v = point.get<double>("v"), &b1 = point.get<double>("b1"),
             &b2 = point.get<double>("b2");
  std::vector<int> local(n_points);
  for (int i = 0; i < n_points; ++i) {
    if (part[i] < 0 || part[i] >= n_parts)
      bad("chart_point", i,
          "is in part " + std::to_string(part[i]) + ", but there are " + std::to_string(n_parts));
    if (row[i] < -1 || row[i] >= n_line_points)
      bad("chart_point", i,
          "is line point " + std::to_string(row[i]) + ", but there are " + std::to_string(n_line_points));
    ChartPoint p{{u[i], v[i]}, row[i], {}};
    if (row[i] < 0) {
      const std::vector<int>& faces = charts[part[i]].mesh.face;  // ascending
      const auto found = std::lower_bound(faces.begin(), faces.end(), in[i]);
      if (found == faces.end() || *found != in[i])
        bad("chart_point", i,
            "lies on face " + std::to_string(in[i]) + ", which part " + std::to_string(part[i]) +
                " does not have");
      p.place = {static_cast<int>(found - faces.begin()), 1 - b1[i] - b2[i], b1[i], b2[i]};
    }
    local[i] = static_cast<int>(meshes[part[i]].points.size());
    meshes[part[i]].points.push_back(p);
  }

  const auto &of = face.get<int>("part"), &a = face.get<int>("a"), &b = face.get<int>("b"),
             &c = face.get<int>("c");
  for (int t = 0; t < static_cast<int>(face.rows); ++t) {
    if (of[t] < 0 || of[t] >= n_parts)
      bad("chart_face", t,
          "is in part " + std::to_string(of[t]) + ", but there are " + std::to_string(n_parts));
    for (int i : {a[t], b[t], c[t]}) {
      if (i < 0 || i >= n_points)
        bad("chart_face", t,
            "uses point " + std::to_string(i) + ", but there are " + std::to_string(n_points));
      if (part[i] != of[t])
        bad("chart_face", t,
            "of part " + std::to_string(of[t]) + " uses point " + std::to_string(i) + " of part " +
                std::to_string(part[i]));
    }
    meshes[of[t]].tris.push_back({local[a[t]], local[b[t]], local[c[t]]});
  }
  return meshes;
}

void write_plane_meshes(Stream& stream, const std::vector<Chart>& charts,
                        const std::vector<PlaneMesh>& meshes) {
  std::vector<int> part, row, in, of, corner[3];
  std::vector<double> u, v, b1, b2;
  for (int p = 0; p < static_cast<int>(meshes.size()); ++p) {
    const int first = static_cast<int>(part.size());
    for (const ChartPoint& x : meshes[p].points) {
      const bool inside = x.line_point < 0;
      part.push_back(p);
      u.push_back(x.uv.x);
      v.push_back(x.uv.y);
      row.push_back(x.line_point);
      in.push_back(inside ? charts[p].mesh.face[x.place.face] : -1);
      b1.push_back(inside ? x.place.b1 : 0);
      b2.push_back(inside ? x.place.b2 : 0);
    }
    for (const Tri& t : meshes[p].tris) {
      of.push_back(p);
      for (int i = 0; i < 3; ++i) corner[i].push_back(first + t[i]);
    }
  }
  Table point{"chart_point", 0, {}};
  point.set("part", std::move(part));
  point.set("u", std::move(u));
  point.set("v", std::move(v));
  point.set("line_vertex", std::move(row));
  point.set("face", std::move(in));
  point.set("b1", std::move(b1));
  point.set("b2", std::move(b2));
  stream.set(std::move(point));
  Table face{"chart_face", 0, {}};
  face.set("part", std::move(of));
  face.set("a", std::move(corner[0]));
  face.set("b", std::move(corner[1]));
  face.set("c", std::move(corner[2]));
  stream.set(std::move(face));
}

}  // namespace meshpipe
