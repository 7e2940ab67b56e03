// SPDX-License-Identifier: BSD-3-Clause
#include "lib/clean.h"

#include <algorithm>
#include <numeric>

#include "lib/edges.h"
#include "lib/error.h"
#include "lib/repair.h"
#include "lib/topology.h"
#include "lib/weld.h"

namespace meshpipe {
namespace {

/// Rows of a table in another order; rows may be left out or repeated.
void take_rows(Table& table, const std::vector<int>& rows) {
  for (Column& c : table.columns)
    std::visit(
        [&](auto& old) {
          std::remove_reference_t<decltype(old)> values(rows.size());
          for (std::size_t i = 0; i < rows.size(); ++i) values[i] = old[rows[i]];
          old = std::move(values);
        },
        c.data);
  table.rows = rows.size();
}

/// What fills a hole has no fault of the input's.
void blame(CleanReport& report, int triangle, Fault fault) {
  if (triangle >= 0) report.culprits.push_back({triangle, fault});
}

void sort_culprits(CleanReport& report) {
  std::sort(report.culprits.begin(), report.culprits.end(), [](const Culprit& a, const Culprit& b) {
    return a.fault != b.fault ? a.fault < b.fault : a.triangle < b.triangle;
  });
}

/// Finds the neighbours, and the duplicates: of the triangles on an edge, those with the same third vertex as
/// an earlier one. The report tells of what it found when it was called first.
void join(Repair& r, CleanReport& report) {
  const int n = (int)r.vertex.size();
  std::vector<char> gone(r.tris.size(), 0);
  std::vector<EdgeUse> third;
  std::vector<int> many;  // triangles on non-manifold edges
  int edges = 0;
  for (bool again = true; again;) {
    again = false;
    edges = 0;
    many.clear();
    r.split.assign(n, 0);
    r.opposite.assign(3 * r.tris.size(), -1);
    for_each_edge(r.tris, n, [&](std::span<const EdgeUse> uses) {
      if (uses.size() < 2) return;
      third.clear();
      for (EdgeUse e : uses)
        third.push_back((EdgeUse)origin(r.tris, prev(half_edge(e))) << 32 | (std::uint32_t)half_edge(e));
      std::sort(third.begin(), third.end());
      for (std::size_t i = 1; i < third.size(); ++i)
        if (third[i] >> 32 == third[i - 1] >> 32) {
          gone[half_edge(third[i]) / 3] = 1;
          again = true;
        }
      const int h = half_edge(uses[0]), g = half_edge(uses[1]);
      if (uses.size() > 2) {
        ++edges;
        for (EdgeUse e : uses) many.push_back(half_edge(e) / 3);
        r.split[origin(r.tris, h)] = r.split[target(r.tris, h)] = 1;
      } else {
        r.opposite[h] = g;
        r.opposite[g] = h;
      }
    });
    if (again) {
      for (std::size_t t = 0; t < gone.size(); ++t)
        if (gone[t]) {
          report.duplicate += r.face[t] >= 0;
          blame(report, r.face[t], Fault::duplicate);
        }
      r.opposite.clear();
      drop(r, gone);
      gone.assign(r.tris.size(), 0);
    }
  }
  if (report.nonmanifold_edges) return;
  report.nonmanifold_edges = edges;
  for (int t : many) blame(report, r.face[t], Fault::nonmanifold);
}

/// Makes neighbours agree: a flood from the first triangle of each component, turned to the side of its
/// majority. Components that are not orientable are noted, their triangles marked in `gone`.
void orient(Repair& r, const std::vector<Vec3>& points, std::vector<char>& gone, CleanReport& report) {
  const int n = (int)r.tris.size();
  bool agree = true;
  for (int h = 0; agree && h < 3 * n; ++h)
    agree = r.opposite[h] < 0 || origin(r.tris, h) != origin(r.tris, r.opposite[h]);
  if (agree) return;
  enum : char { unseen, as_seed, against };
  std::vector<char> side(n, unseen);
  std::vector<int> members;
  gone.assign(n, 0);
  for (int seed = 0; seed < n; ++seed) {
    if (side[seed] != unseen) continue;
    side[seed] = as_seed;
    members.assign(1, seed);
    std::size_t turned = 0;
    int conflict = -1;
    for (std::size_t i = 0; i < members.size(); ++i) {
      const int t = members[i];
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        const int o = r.opposite[h];
        if (o < 0) continue;
        const char want =
            (origin(r.tris, h) != origin(r.tris, o)) == (side[t] == as_seed) ? as_seed : against;
        if (side[o / 3] == unseen) {
          side[o / 3] = want;
          turned += want == against;
          members.push_back(o / 3);
        } else if (side[o / 3] != want && conflict < 0) {
          conflict = h;
        }
      }
    }
    if (conflict >= 0) {
      report.nonorientable.push_back({source(r, seed), (int)members.size(), source(r, conflict / 3),
                                      source(r, r.opposite[conflict] / 3),
                                      lerp(points[r.vertex[origin(r.tris, conflict)]],
                                           points[r.vertex[target(r.tris, conflict)]], 0.5)});
      for (int t : members) {
        gone[t] = 1;
        blame(report, r.face[t], Fault::nonorientable);
      }
      continue;
    }
    const char wrong = 2 * turned > members.size() ? as_seed : against;
    for (int t : members)
      if (side[t] == wrong) turn(r, t);
  }
}

/// Gives every fan of triangles round a vertex its own copy of the vertex, the first fan keeps it. Triangles
/// of an edge that was left open and still share both its vertices lie in one fan at either end (a fan has
/// two ends), in opposite directions, so what results is an oriented manifold. The report tells of what it
/// found when it was called first.
void split_fans(Repair& r, CleanReport& report) {
  const int n = (int)r.vertex.size();
  std::vector<char> seen(r.opposite.size(), 0);
  enum : char { none, one, many };
  std::vector<char> fans(n, none);
  std::vector<int> fan, apart;  // the latter: triangles of second fans, but for those on split edges
  int vertices = 0;
  for (int seed = 0; seed < (int)r.opposite.size(); ++seed) {
    if (seen[seed]) continue;
    fan.clear();
    for_each_spoke(r, seed, [&](int g) { fan.push_back(g); });
    for (int g : fan) seen[g] = 1;
    const int v = origin(r.tris, seed);
    if (fans[v] != none) {
      vertices += fans[v] == one;
      for (int g : fan) {
        r.tris[g / 3][g % 3] = (int)r.vertex.size();
        if (!r.split[v]) apart.push_back(g / 3);
      }
      r.vertex.push_back(r.vertex[v]);
      r.copied.push_back(v);
    }
    fans[v] = fans[v] == none ? one : many;
  }
  if (std::count(r.split.begin(), r.split.end(), 1))
    r.opposite = opposite_halfedges(r.tris, (int)r.vertex.size());
  report.copies = (int)r.vertex.size() - n;
  if (report.nonmanifold_vertices) return;
  report.nonmanifold_vertices = vertices;
  for (int t : apart) blame(report, r.face[t], Fault::pinched);
}

/// Drops all components but the `keep` largest by area; whether there were more.
bool keep_largest(Repair& r, const std::vector<Vec3>& points, int keep, CleanReport& report) {
  std::vector<int> component;
  const int n = components(r.opposite, component);
  if (n <= keep) return false;
  std::vector<double> area(n, 0);
  for (std::size_t t = 0; t < r.tris.size(); ++t) {
    auto p = [&](int i) { return points[r.vertex[r.tris[t][i]]]; };
    area[component[t]] += norm(area_vector(p(0), p(1), p(2)));
  }
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return area[a] > area[b]; });
  std::vector<char> small(n, 0), gone(r.tris.size(), 0);
  for (int i = keep; i < n; ++i) small[order[i]] = 1;
  for (std::size_t t = 0; t < r.tris.size(); ++t)
    if (small[component[t]]) {
      gone[t] = 1;
      ++report.dropped_triangles;
      blame(report, r.face[t], Fault::small);
    }
  report.dropped_components += n - keep;
  r.opposite.clear();
  drop(r, gone);
  return true;
}

/// Undoes split_fans.
void unite(Repair& r) {
  for (Tri& t : r.tris)
    for (int& v : t) v = base(r, v);
  r.vertex.resize(r.vertex.size() - r.copied.size());
  r.copied.clear();
}

/// Leaves out vertices that no triangle uses, and numbers the others by first use.
void number_by_first_use(Repair& r) {
  std::vector<int> number(r.vertex.size(), -1), vertex;
  for (Tri& t : r.tris)
    for (int& v : t) {
      if (number[v] < 0) {
        number[v] = (int)vertex.size();
        vertex.push_back(r.vertex[v]);
      }
      v = number[v];
    }
  r.vertex = std::move(vertex);
}

/// Whether the repairs undid each other: copies of vertices were welded and split again, and the triangles
/// are as they were.
bool as_it_was(const Repair& r, const Surface& surface) {
  if (r.tris.size() != surface.tris.size()) return false;
  std::vector<int> now(surface.points.size(), -1), before(r.vertex.size(), -1);
  for (std::size_t t = 0; t < r.tris.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const int v = surface.tris[t][i], w = r.tris[t][i];
      if (now[v] < 0) now[v] = w;
      if (before[w] < 0) before[w] = v;
      if (now[v] != w || before[w] != v) return false;
    }
  return std::find(now.begin(), now.end(), -1) == now.end();
}

/// What keep_sheets adds: the bits of face column `model` on the borders between sheets, and patches of their
/// own. The report tells the patches; returns whether anything was changed.
bool mark_sheets(Surface& surface, const std::vector<int>& opposite, CleanReport& report) {
  const int n = (int)surface.tris.size();
  std::vector<int> component;
  const int n_sheets = components(opposite, component);
  std::vector<std::uint8_t> model(n, 0);
  if (surface.face.has("model")) model = surface.face.get<std::uint8_t>("model");
  std::vector<char> meets(n_sheets, 0);
  bool changed = false;
  for_each_edge(surface.tris, (int)surface.points.size(), [&](std::span<const EdgeUse> uses) {
    if (uses.size() < 2) return;
    for (EdgeUse e : uses) {
      const int h = half_edge(e);
      if (uses.size() == 2 && opposite[h] >= 0) continue;
      meets[component[h / 3]] = 1;
      changed = changed || !(model[h / 3] >> h % 3 & 1);
      model[h / 3] |= 1 << h % 3;
    }
  });
  if (changed) surface.face.set("model", std::move(model));

  std::vector<int> patch(n, 1);
  if (surface.face.has("patch")) patch = surface.face.get<int>("patch");
  struct Label {
    int patch, sheet, triangle;
    auto operator<=>(const Label&) const = default;
  };
  std::vector<Label> labels;
  for (int t = 0; t < n; ++t)
    if (meets[component[t]]) labels.push_back({patch[t], component[t], t});
  std::sort(labels.begin(), labels.end());
  int last = n ? *std::max_element(patch.begin(), patch.end()) : 0;
  for (std::size_t i = 1; i < labels.size(); ++i) {
    const Label &before = labels[i - 1], &l = labels[i];
    if (l.patch != before.patch) continue;
    if (l.sheet != before.sheet) report.sheet_patches.push_back({++last, l.patch});
    const bool first = report.sheet_patches.empty() || report.sheet_patches.back()[1] != l.patch;
    if (!first) patch[l.triangle] = last;
  }
  if (report.sheet_patches.empty()) return changed;
  surface.face.set("patch", std::move(patch));
  return true;
}

/// Neighbours, orientation, a copy of the vertex for every fan; components dropped as the options say.
void join_and_split(Repair& r, const std::vector<Vec3>& points, const CleanOptions& options,
                    CleanReport& report) {
  std::vector<char> gone;
  for (;;) {  // what shares an edge with others no more joins two of them, and those may disagree: once again
    join(r, report);
    const std::size_t before = report.nonorientable.size();
    orient(r, points, gone, report);
    if (report.nonorientable.size() > before) {
      if (!options.drop_nonorientable) {
        sort_culprits(report);
        const std::size_t more = report.nonorientable.size() - 1;
        throw NotAdmissible(describe(report.nonorientable[0]) +
                            (more ? ", and " + std::to_string(more) + " more components" : ""));
      }
      r.opposite.clear();
      drop(r, gone);
      continue;
    }
    split_fans(r, report);
    if (!options.keep_components || !keep_largest(r, points, options.keep_components, report)) return;
    unite(r);
  }
}

/// All repairs that change neighbours, once. False if that may have left something to repair: where triangles
/// go or come, copies of an edge or of a triangle on different sheets may have become one, or only two.
bool make_manifold(Repair& r, const std::vector<Vec3>& points, const CleanOptions& options,
                   CleanReport& report) {
  join_and_split(r, points, options, report);
  FlatCounts flat = remove_flat(r, points);
  bool changed = !flat.removed.empty();
  for (int t : flat.removed) {
    report.degenerate += t >= 0;
    blame(report, t, Fault::degenerate);
  }
  if (options.fill_holes) {
    const HoleCounts holes = fill_holes(r, points, options.fill_holes);
    report.holes_filled += holes.filled;
    report.hole_triangles += holes.triangles;
    report.holes_left = holes.left;
    changed = changed || holes.filled;
    if (holes.filled) flat = remove_flat(r, points);  // where a hole's corners are in line
  }
  report.flat = flat.left;
  return !changed || (r.copied.empty() && !options.fill_holes);
}

}  // namespace

void turn(Repair& r, int t) {
  std::swap(r.tris[t][1], r.tris[t][2]);
  std::swap(r.opposite[3 * t], r.opposite[3 * t + 2]);
  for (int h : {3 * t, 3 * t + 2})
    if (r.opposite[h] >= 0) r.opposite[r.opposite[h]] = h;
  r.flipped[t] ^= 1;
}

void drop(Repair& r, const std::vector<char>& gone) {
  std::vector<int> number(r.opposite.empty() ? 0 : gone.size(), -1);
  std::size_t n = 0;
  for (std::size_t t = 0; t < gone.size(); ++t) {
    if (gone[t]) continue;
    r.tris[n] = r.tris[t];
    r.face[n] = r.face[t];
    if (!r.flipped.empty()) r.flipped[n] = r.flipped[t];
    if (!r.opposite.empty()) {
      std::copy_n(r.opposite.begin() + 3 * t, 3, r.opposite.begin() + 3 * n);
      number[t] = (int)n;
    }
    ++n;
  }
  r.tris.resize(n);
  r.face.resize(n);
  if (!r.flipped.empty()) r.flipped.resize(n);
  if (r.opposite.empty()) return;
  r.opposite.resize(3 * n);
  for (int& o : r.opposite)
    if (o >= 0) o = number[o / 3] < 0 ? -1 : 3 * number[o / 3] + o % 3;
}

void clean(Surface& surface, const CleanOptions& options, CleanReport& report) {
  expect_measurable(surface);
  report = {};
  const int n = (int)surface.points.size();
  report.input_vertices = n;
  report.input_triangles = (int)surface.tris.size();

  std::vector<char> used(n, 0);
  for (const Tri& t : surface.tris)
    for (int v : t) used[v] = 1;
  std::vector<int> number = first_equal(surface.points, used);
  for (int v = 0; v < n; ++v) report.welded += number[v] != v;
  if (options.weld > 0) report.welded_near = merge_near(surface.points, used, options.weld, number);

  Repair r;  // on the vertices that are left, in their order
  for (int v = 0; v < n; ++v)
    if (number[v] == v) {
      number[v] = (int)r.vertex.size();
      r.vertex.push_back(v);
    } else {
      number[v] = number[number[v]];  // which came before
    }
  r.tris.reserve(surface.tris.size());
  r.face.reserve(surface.tris.size());
  used.assign(r.vertex.size(), 0);
  for (int t = 0; t < (int)surface.tris.size(); ++t) {
    const Tri s = surface.tris[t], w{number[s[0]], number[s[1]], number[s[2]]};
    if (w[0] == w[1] || w[1] == w[2] || w[2] == w[0]) {
      ++report.degenerate;
      blame(report, t, Fault::degenerate);
      continue;
    }
    r.tris.push_back(w);
    r.face.push_back(t);
    for (int v : w) used[v] = 1;
  }
  report.unreferenced = (int)std::count(used.begin(), used.end(), 0);
  std::vector<int>().swap(number);

  r.flipped.assign(r.tris.size(), 0);
  constexpr int most_rounds =
      50;  // two or three do; that holes filled and sheets split come to an end is not proved
  for (int round = 1; !make_manifold(r, surface.points, options, report) && round < most_rounds; ++round)
    unite(r);
  std::vector<int> component;
  report.components = components(r.opposite, component);
  face_outward(r, surface.points, component, report.components);  // last, when holes are filled
  for (std::size_t t = 0; t < r.tris.size(); ++t) {
    if (!r.flipped[t] || r.face[t] < 0) continue;  // what fills a hole had no side before
    ++report.flipped;
    blame(report, r.face[t], Fault::turned);
  }
  for (int t = 0; t < (int)r.tris.size(); ++t) r.face[t] = source(r, t);
  sort_culprits(report);
  if (r.tris.empty()) throw NotAdmissible(describe_nothing_left(report));

  if (options.keep_sheets) {
    unite(r);
    report.copies = 0;
  }
  const bool renumber = report.welded || report.welded_near || report.unreferenced || report.degenerate ||
                        report.dropped_triangles || !report.nonorientable.empty();
  report.nothing = !(renumber || report.duplicate || report.flipped || report.nonmanifold_edges ||
                     report.nonmanifold_vertices || report.holes_filled);
  if (report.nothing) return;
  if (as_it_was(r, surface)) {
    report.nothing = !options.keep_sheets || !mark_sheets(surface, r.opposite, report);
    report.welded = report.welded_near = 0;
    return;
  }
  if (renumber) number_by_first_use(r);
  std::vector<Vec3> points(r.vertex.size());
  for (std::size_t v = 0; v < points.size(); ++v) points[v] = surface.points[r.vertex[v]];
  surface.points = std::move(points);
  surface.tris = std::move(r.tris);
  surface.face.erase("model");
  take_rows(surface.vertex, r.vertex);
  take_rows(surface.face, r.face);
  if (options.keep_sheets) mark_sheets(surface, r.opposite, report);
}

CleanReport clean(Surface& surface, const CleanOptions& options) {
  CleanReport report;
  clean(surface, options, report);
  return report;
}

Mesh sheets_apart(const Mesh& mesh) {
  Surface s = surface_of(mesh);
  const CleanReport r = clean(s);
  if (s.tris.size() != mesh.tris.size() || r.flipped || r.degenerate || r.duplicate)
    throw NotAdmissible("the surface has " + std::to_string(r.flipped) + " triangles turned round, " +
                        std::to_string(r.degenerate) + " degenerate, " + std::to_string(r.duplicate) +
                        " doubled; run mclean first");
  return s;
}

}  // namespace meshpipe
