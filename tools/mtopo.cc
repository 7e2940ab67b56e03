// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>

#include "formats/stream/part_table.h"
#include "lib/clean/clean.h"
#include "lib/core/topology.h"
#include "tools/common.h"

using namespace meshpipe;

namespace {

constexpr std::size_t most_rows = 40;  ///< of a table on standard error, without -v

/// Which of the conditions on parts fail, in words separated by commas: "2 pieces", "genus 1", "closed", "too
/// long"; or "ok".
std::string verdict(const Topology& t) {
  std::string why;
  auto add = [&](const std::string& what) { why += (why.empty() ? "" : ", ") + what; };
  if (t.components != 1) add(std::to_string(t.components) + " pieces");
  if (t.genus != 0) add("genus " + std::to_string(t.genus));
  if (t.loops == 0) add("closed");
  if (why.empty() && !admissible(t)) add("too long");
  return why.empty() ? "ok" : why;
}

std::string plural(std::size_t n, const std::string& what) {
  return std::to_string(n) + ' ' + what + (n == 1 ? "" : "s");
}

/// The table of one kind of pieces, "component" or "part": on standard error, for JSON, for TSV.
void say(Io& io, const std::string& kind, const std::vector<Topology>& pieces, std::string& tsv) {
  char line[320];
  std::snprintf(
      line, sizeof line,
      "%-9s        V        E        F   G  N_B          L   eta_cyl   eta_box   eta_geo  conditions",
      kind.c_str());
  io.say(line);
  int bad = 0;
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const Topology& t = pieces[p];
    bad += !admissible(t);
    std::snprintf(line, sizeof line, "%9zu %8d %8d %8d %3d %4d %10.4g %9.3g %9.3g %9.3g  %s", p, t.vertices,
                  t.edges, t.faces, t.genus, t.loops, t.longest_loop, t.eta_cyl, t.eta_box, t.eta_geo,
                  verdict(t).c_str());
    if (p < most_rows)
      io.say(line);
    else
      io.detail(line);
    std::string lengths;
    for (double l : t.loop_length) {
      std::snprintf(line, sizeof line, "%s%.9g", lengths.empty() ? "" : ",", l);
      lengths += line;
    }
    if (t.loops) io.detail(kind + ' ' + std::to_string(p) + " has loops of length " + lengths);
    std::snprintf(line, sizeof line, "%s\t%zu\t%d\t%d\t%d\t%d\t%d\t%d\t%.9g\t%.9g\t%.9g\t%.9g\t%.9g\t",
                  kind.c_str(), p, t.vertices, t.edges, t.faces, t.components, t.genus, t.loops,
                  t.longest_loop, t.area, t.eta_cyl, t.eta_box, t.eta_geo);
    tsv += line + verdict(t) + '\t' + lengths + '\n';
    rows.push_back({{kind, p},
                    {"vertices", t.vertices},
                    {"edges", t.edges},
                    {"faces", t.faces},
                    {"pieces", t.components},
                    {"genus", t.genus},
                    {"loops", t.loops},
                    {"loop_lengths", t.loop_length},
                    {"area", t.area},
                    {"eta_cyl", t.eta_cyl},
                    {"eta_box", t.eta_box},
                    {"eta_geo", t.eta_geo},
                    {"admissible", admissible(t)},
                    {"verdict", verdict(t)}});
  }
  if (pieces.size() > most_rows)
    io.say("rows " + std::to_string(most_rows) + " to " + std::to_string(pieces.size() - 1) +
           " are in --tsv and --json, and here with -v");
  io.report[kind + 's'] = std::move(rows);
  io.say(plural(pieces.size(), kind) + ", " +
         (bad ? std::to_string(bad) + " to be cut" : "all may be mapped to a disk"));
}

void require(const std::string& what, const std::string& kind, const std::vector<Topology>& parts) {
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const Topology& t = parts[p];
    const bool met = what == "closed" ? t.loops == 0 : t.components == 1 && t.genus == 0 && t.loops >= 1;
    if (!met)
      throw NotAdmissible(kind + ' ' + std::to_string(p) + " is not " +
                          (what == "closed" ? "closed" : "a disk") + ": genus " + std::to_string(t.genus) +
                          ", " + plural(t.loops, "loop") + ", " + plural(t.components, "piece"));
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::string required, tsv_file;
  return run_tool(
      argc, argv, "mtopo",
      "Report the topology and the aspect ratios of every component and every part.\n\n"
      "Examples:\n  mclean tree.stl | mtopo -o topo.ply\n"
      "  mclean -q --fill-holes 200 tree.stl | mtopo --require closed --tsv topo.tsv > closed.ply",
      [&](CLI::App& app) {
        app.add_option("--require", required,
                       "fail with status 4 unless the surface is a manifold; closed: every part is; disk: "
                       "every part has genus 0 and a border")
            ->check(CLI::IsMember({"disk", "manifold", "closed"}))
            ->group("Reports");
        app.add_option("--tsv", tsv_file, "write the table to this file, tab-separated")
            ->type_name("FILE")
            ->group("Reports");
      },
      [&](Io& io) {
        if (!tsv_file.empty()) io.expect_report("--tsv", tsv_file);
        Stream& stream = io.read();
        Surface& s = stream.surface;
        const bool cleaned = stream.input_triangles > 0;
        std::vector<int> component;
        auto components_of = [&](const Mesh& mesh) {
          const std::vector<int> opposite = opposite_halfedges(mesh);
          const int n = components(opposite, component);
          if (n == (int)s.tris.size() && n > 1 && !cleaned)
            throw NotAdmissible("no two of the " + std::to_string(n) +
                                " triangles share an edge; run mclean first");
          if (required == "manifold")
            if (int v = find_pinched_vertex({s, opposite}); v >= 0)
              throw NotAdmissible("vertex " + std::to_string(v) +
                                  " joins triangles that share no edge; run mclean first");
          return topology_of_components({mesh, opposite}, component, n);
        };
        Surface apart;
        const Mesh* mesh = &s;
        std::vector<Topology> pieces;
        try {
          pieces = components_of(s);
        } catch (const NotAdmissible&) {
          if (!cleaned || required == "manifold") throw;
          apart = surface_of(s);  // as mclean --sheets keep has left it
          split_sheets(apart);
          mesh = &apart;
          pieces = components_of(apart);
        }
        std::string tsv =
            "kind\tid\tvertices\tedges\tfaces\tpieces\tgenus\tloops\tlongest_loop\tarea\teta_cyl\teta_"
            "box\teta_geo\t"
            "verdict\tloop_lengths\n";
        std::string kind = "component";
        say(io, kind, pieces, tsv);
        if (s.face.has("part")) {
          kind = "part";
          pieces = topology_of_parts(*mesh, s.face.get<int>("part"), count_parts(s));
          say(io, kind, pieces, tsv);
        } else {
          s.face.set("part", std::move(component));
        }
        if (!tsv_file.empty()) Io::write_file(tsv_file, tsv);
        if (required == "disk" || required == "closed") require(required, kind, pieces);
        Table table = part_table(pieces);
        if (const Table* known = stream.find("part"); known && known->rows == table.rows)
          for (const Column& c : known->columns)  // such as which map was used
            if (!table.has(c.name)) table.columns.push_back(c);
        stream.set(std::move(table));
        io.write(stream);
      },
      {.passes = true});
}
