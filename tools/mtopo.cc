// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>

#include "lib/topology.h"
#include "tools/common.h"

using namespace meshpipe;

namespace {

/// Numbers the components in face column `part`, or checks the parts that are there; returns their number.
int find_parts(Surface& surface, const std::vector<int>& opposite) {
  const int n_tris = (int)surface.tris.size();
  std::vector<int> component;
  const int n_components = components(opposite, component);
  if (n_components == n_tris && n_tris > 1)
    throw NotAdmissible("no two of the " + std::to_string(n_tris) +
                        " triangles share an edge; run mclean first");
  if (!surface.face.has("part")) {
    surface.face.set("part", std::move(component));
    return n_components;
  }
  const std::vector<int>& part = surface.face.get<int>("part");
  const int n = n_tris ? *std::max_element(part.begin(), part.end()) + 1 : 0;
  std::vector<int> faces(std::min(n, n_tris), 0);
  for (int t = 0; t < n_tris; ++t) {
    if (part[t] < 0 || part[t] >= n_tris)
      throw NotAdmissible("face " + std::to_string(t) + " has part " + std::to_string(part[t]) + " of " +
                          std::to_string(n_tris) + " triangles");
    ++faces[part[t]];
  }
  for (int p = 0; p < n; ++p)
    if (!faces[p])
      throw NotAdmissible("part " + std::to_string(p) + " of " + std::to_string(n) + " has no triangle");
  return n;
}

std::string verdict(const Topology& t) {
  if (t.components != 1) return std::to_string(t.components) + " pieces";
  if (t.genus != 0) return "genus " + std::to_string(t.genus);
  if (t.loops == 0) return "closed";
  if (!admissible(t)) return "too long";
  return "ok";
}

void tell(Io& io, const std::vector<Topology>& parts) {
  char line[256];
  io.say("part        V        E        F   G  N_B          L   eta_cyl   eta_box   eta_geo  conditions");
  int bad = 0;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const Topology& t = parts[p];
    bad += !admissible(t);
    std::snprintf(line, sizeof line, "%4zu %8d %8d %8d %3d %4d %10.4g %9.3g %9.3g %9.3g  %s", p, t.vertices,
                  t.edges, t.faces, t.genus, t.loops, t.longest_loop, t.eta_cyl, t.eta_box, t.eta_geo,
                  verdict(t).c_str());
    io.say(line);
    io.report["parts"].push_back({{"part", p},
                                  {"vertices", t.vertices},
                                  {"edges", t.edges},
                                  {"faces", t.faces},
                                  {"genus", t.genus},
                                  {"loops", t.loops},
                                  {"loop_lengths", t.loop_length},
                                  {"area", t.area},
                                  {"eta_cyl", t.eta_cyl},
                                  {"eta_box", t.eta_box},
                                  {"eta_geo", t.eta_geo},
                                  {"admissible", admissible(t)}});
  }
  io.say(std::to_string(parts.size()) + (parts.size() == 1 ? " part, " : " parts, ") +
         (bad ? std::to_string(bad) + " to be cut" : "all may be mapped to a disk"));
}

void require(const std::string& what, const std::vector<Topology>& parts) {
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const Topology& t = parts[p];
    const bool met = what == "closed" ? t.loops == 0 : t.components == 1 && t.genus == 0 && t.loops >= 1;
    if (!met)
      throw NotAdmissible("part " + std::to_string(p) + " is not " +
                          (what == "closed" ? "closed" : "a disk") + ": genus " + std::to_string(t.genus) +
                          ", " + std::to_string(t.loops) + " loops, " + std::to_string(t.components) +
                          (t.components == 1 ? " piece" : " pieces"));
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::string required;
  return run_tool(
      argc, argv, "mtopo",
      "Tell the topology and the aspect ratios of every component, or of every part."
      "\n\nExamples:\n  mclean scan.stl | mtopo -o scan.ply\n  mtopo --require closed scan.ply > /dev/null",
      [&](CLI::App& app) {
        app.add_option("--require", required,
                       "fail with 4 unless the surface is a manifold, all parts are closed, or disks (genus "
                       "0 with at least one loop)")
            ->check(CLI::IsMember({"disk", "manifold", "closed"}))
            ->group("Reports");
      },
      [&](Io& io) {
        Stream stream = io.read();
        Surface& s = stream.surface;
        const std::vector<int> opposite = opposite_halfedges(s.tris, (int)s.points.size());
        if (required == "manifold")
          if (int v = find_pinched_vertex(s.tris, opposite, (int)s.points.size()); v >= 0)
            throw NotAdmissible("vertex " + std::to_string(v) +
                                " joins triangles that share no edge; run mclean first");
        const int n = find_parts(s, opposite);
        const std::vector<Topology> parts = topology_of_parts(s, s.face.get<int>("part"), n);
        tell(io, parts);
        if (required == "disk" || required == "closed") require(required, parts);
        Table table = part_table(parts);
        if (const Table* known = stream.find("part"); known && known->rows == table.rows)
          for (const Column& c : known->columns)  // such as which map was used
            if (!table.has(c.name)) table.columns.push_back(c);
        stream.set(std::move(table));
        io.write(stream);
      });
}
