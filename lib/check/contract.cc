// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <charconv>
#include <cmath>

#include "lib/check/check.h"
#include "lib/core/error.h"
#include "lib/core/number.h"

namespace meshpipe {
namespace {

constexpr double nan = no_figure;
// Requirements without a limit. topology: sound, components, genus and loops of the reference, no sheets
// apart; intersections: none where the reference has none; folds, creases: none is cut; patches: as they are;
// regions: sheets that meet do so as in the reference, and enclose the same (topology requires it, too).
constexpr const char* flags[] = {"topology", "intersections", "folds", "creases", "patches", "regions"};
// Lower limits: kappa (of triangles that are not forced), kappa_off_wedges, kappa_mean, angle (degrees).
// Upper limits: hausdorff (of its bound), mean, rms, boundary, features (over the diagonal), vertices (of
// Findings::off), deviation (of the local size), size (edge deviation), trace (kappa_elsewhere -
// kappa_by_cuts), volumes (of a region).
constexpr const char* limits[] = {"kappa", "kappa_off_wedges", "kappa_mean", "angle",    "hausdorff", "mean",
                                  "rms",   "boundary",         "features",   "vertices", "deviation", "size",
                                  "trace", "volumes"};

template <class Names>
bool among(const Names& names, const std::string& name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

std::string place(Vec3 p) { return "at (" + shown(p) + ")"; }

std::string triangle(const Mesh& mesh, int t) {
  return "triangle " + std::to_string(t) + " " + place(centroid(mesh, t));
}

std::string edge(const Mesh& mesh, int h) {
  return "triangle " + std::to_string(h / 3) + " " +
         place(lerp(mesh.points[origin(mesh.tris, h)], mesh.points[target(mesh.tris, h)], 0.5));
}

/// Failures of one requirement: the text, the figure, and the triangle or place of each.
struct Facts {
  const Mesh& mesh;
  std::string requirement;
  double limit = no_figure;
  std::vector<Failure> failures;
  void push_back(std::string text, double value = no_figure, int triangle = -1) {
    failures.push_back({requirement, std::move(text), value, limit, triangle});
    if (triangle >= 0) failures.back().place = centroid(mesh, triangle);
  }
};

void judge_topology(const Findings& f, const Mesh& mesh, Facts& facts) {
  const Soundness &m = f.mesh, &r = f.reference;
  auto count = [&](const std::vector<int>& t, const char* one, const char* many) {
    if (!t.empty())
      facts.push_back(std::to_string(t.size()) + " " + (t.size() == 1 ? one : many) + ", the first in " +
                          triangle(mesh, t[0]),
                      (double)t.size(), t[0]);
  };
  count(m.degenerate, "triangle with a repeated vertex", "triangles with a repeated vertex");
  count(m.nonmanifold, "edge with more than two triangles", "edges with more than two triangles");
  count(m.misoriented, "edge whose triangles disagree on orientation",
        "edges whose triangles disagree on orientation");
  count(m.pinched, "pinched vertex", "pinched vertices");
  if (!m.sound()) return;
  if (!r.sound()) return facts.push_back("the reference is not sound: nothing to compare with");
  auto same = [&](const char* what, int has, int needs, const std::string& where) {
    if (has != needs)
      facts.push_back(std::string(what) + " " + std::to_string(has) + ", the reference has " +
                          std::to_string(needs) + where,
                      has);
  };
  if (!f.reversed.empty())
    facts.push_back(std::to_string(f.reversed.size()) +
                        (f.reversed.size() == 1 ? " component is" : " components are") +
                        " inside out, the first holds " + triangle(mesh, f.reversed[0]),
                    (double)f.reversed.size(), f.reversed[0]);
  same("components", m.components, r.components, "; the smallest holds " + triangle(mesh, m.small_component));
  same("genus", m.genus, r.genus, "");
  same("boundary loops", m.loops, r.loops, m.loop < 0 ? "" : "; the shortest passes " + edge(mesh, m.loop));
}

void judge_volumes(const SheetFindings& f, double limit, Facts& facts) {
  if (!(f.volume_error > limit)) return;
  const RegionVolume& v = f.volumes[f.worst];
  facts.push_back("region " + std::to_string(v.label) + " has volume " + shown(v.result) +
                      ", in the reference " + shown(v.reference) + ": the difference is above " +
                      shown(limit) + " of it",
                  f.volume_error);
}

void judge_regions(const Findings& f, Facts& facts) {
  if (!f.sheets) return;
  for (const std::string& fault : f.sheets->faults) facts.push_back(fault);
  const RegionVolume* worst = nullptr;
  double most = 1;
  for (const RegionVolume& v : f.sheets->volumes)
    if (const double excess = std::abs(v.result - v.reference) / v.explained; excess > most)
      most = excess, worst = &v;
  if (worst)
    facts.push_back("region " + std::to_string(worst->label) + " has volume " + shown(worst->result) +
                        ", in the reference " + shown(worst->reference) +
                        ": its boundary is farther off than a tenth of an edge, in the mean",
                    f.sheets->volume_error);
}

void judge_flag(const std::string& name, const Findings& f, const Mesh& mesh, Facts& facts) {
  auto count_edges = [&](const std::vector<int>& edges, const char* one, const char* many) {
    if (!edges.empty())
      facts.push_back(std::to_string(edges.size()) + (edges.size() == 1 ? one : many) + ", the first in " +
                          edge(mesh, edges[0]),
                      (double)edges.size(), edges[0] / 3);
  };
  if (name == "topology") {
    judge_topology(f, mesh, facts);
    judge_regions(f, facts);
  } else if (name == "intersections") {
    const std::size_t n = f.new_intersections.size();
    if (n > 0)
      facts.push_back(std::to_string(n) +
                          (n == 1 ? " pair of triangles intersects" : " pairs of triangles intersect") +
                          " where the reference does not; the first is triangle " +
                          std::to_string(f.new_intersections[0].second) + " with " +
                          triangle(mesh, f.new_intersections[0].first),
                      (double)n, f.new_intersections[0].first);
  } else if (name == "folds") {
    count_edges(f.edges.folds, " edge is folded", " edges are folded");
  } else if (name == "creases") {
    count_edges(f.edges.cut_creases, " edge cuts off a crease", " edges cut off creases");
  } else if (name == "regions") {
    judge_regions(f, facts);
  } else {
    for (const PatchFault& fault : f.patch_faults) facts.push_back(fault.fact, (double)f.patch_faults.size());
    count_edges(f.edges.unmarked_borders, " edge between patches is no model edge",
                " edges between patches are no model edges");
  }
}

void judge_limit(const Requirement& r, const Findings& f, const Mesh& mesh, Facts& facts) {
  const Distance& d = f.distance;
  const double value = reached(r, f);
  auto above = [&](int worst) {
    if (value > r.limit) return;
    const std::string what =
        worst < 0 ? shown(value) : "smallest is " + shown(value) + " in " + triangle(mesh, worst);
    facts.push_back(what + ", not above " + shown(r.limit), value, worst);
  };
  auto within = [&](const std::string& where = "", int worst = -1) {
    if (value <= r.limit) return;  // what is not a number is a failure
    facts.push_back(shown(value) + where + ", above " + shown(r.limit), value, worst);
  };
  if (r.name == "kappa") return above(f.worst_unforced);
  if (r.name == "kappa_off_wedges") return above(f.worst_off_corners);
  if (is_lower_limit(r)) return above(-1);
  if (r.name == "hausdorff")
    return within(" is the bound, " + shown(d.hausdorff) + " the distance found " + place(d.place));
  if (r.name == "deviation") {
    within(" of the local size is how far the surfaces are apart " + place(d.deviation.place),
           d.deviation.triangle);
    if (!facts.failures.empty()) facts.failures.back().place = d.deviation.place;
    return;
  }
  if (r.name == "volumes") {
    if (f.sheets) judge_volumes(*f.sheets, r.limit, facts);
    return;
  }
  const bool unknown =
      (r.name == "features" && !f.features) || (r.name == "trace" && !(f.kappa_by_cuts && f.kappa_elsewhere));
  if (r.name != "vertices") return unknown ? void() : within();
  if (f.farthest >= 0)
    within(" of its edges is how far vertex " + std::to_string(f.farthest) + " lies off the reference, " +
           place(mesh.points[f.farthest]));
}

/// Of every triangle, its faults.
std::vector<std::uint8_t> faults_of(const Contract& contract, const Findings& f, const Surface& mesh) {
  std::vector<std::uint8_t> faults(mesh.tris.size(), 0);
  for (const Requirement& r : contract) {
    if (r.name == "topology")
      for (const auto* kind : {&f.mesh.degenerate, &f.mesh.nonmanifold, &f.mesh.misoriented, &f.mesh.pinched})
        for (int t : *kind) faults[t] |= offends_topology;
    if (r.name == "intersections")
      for (auto [s, t] : f.new_intersections)
        faults[s] |= offends_intersections, faults[t] |= offends_intersections;
    auto offend = [&](const std::vector<int>& edges, Offense kind) {
      for (int h : edges) faults[h / 3] |= kind, faults[f.mesh.opposite[h] / 3] |= kind;
    };
    if (r.name == "folds") offend(f.edges.folds, offends_folds);
    if (r.name == "creases") offend(f.edges.cut_creases, offends_creases);
    if (r.name == "patches") {
      std::vector<int> labels;
      for (const PatchFault& fault : f.patch_faults)
        labels.insert(labels.end(), fault.labels.begin(), fault.labels.end());
      sort_unique(labels);
      if (labels.empty()) continue;
      const std::vector<int>& patch = mesh.face.get<int>("patch");
      for (std::size_t t = 0; t < faults.size(); ++t)
        if (std::binary_search(labels.begin(), labels.end(), patch[t])) faults[t] |= offends_patches;
    }
    for (std::size_t t = 0; t < faults.size(); ++t) {
      const Tri& v = mesh.tris[t];
      if (r.name == "kappa" && !(f.quality.kappas[t] > r.limit) && (f.forced.empty() || !f.forced[t]))
        faults[t] |= offends_kappa;
      if (r.name == "vertices" &&
          !(f.off[v[0]] <= r.limit && f.off[v[1]] <= r.limit && f.off[v[2]] <= r.limit))
        faults[t] |= offends_vertices;
      if (r.name == "deviation" && most_deviation * f.distance.deviation.ratio[t] > r.limit)
        faults[t] |= offends_deviation;
    }
  }
  return faults;
}

}  // namespace

bool is_lower_limit(const Requirement& r) { return r.name.starts_with("kappa") || r.name == "angle"; }

double reached(const Requirement& r, const Findings& f) {
  const Quality& q = f.quality;
  const Distance& d = f.distance;
  if (r.name == "kappa") return f.worst_unforced < 0 ? 1 : q.kappas[f.worst_unforced];
  if (r.name == "kappa_off_wedges") return f.kappa_off_corners;
  if (r.name == "kappa_mean") return q.kappa_mean;
  if (r.name == "angle") return q.min_angle;
  if (r.name == "hausdorff") return d.hausdorff + d.bound;
  if (r.name == "mean") return d.mean;
  if (r.name == "rms") return d.rms;
  if (r.name == "boundary") return f.boundary;
  if (r.name == "features") return f.features.value_or(nan);
  if (r.name == "deviation") return most_deviation * d.deviation.worst;
  if (r.name == "size") return q.edge_deviation;
  if (r.name == "volumes" && f.sheets) return f.sheets->volume_error;
  if (r.name == "vertices") return f.farthest < 0 ? 0 : f.off[f.farthest];
  if (r.name == "trace" && f.kappa_by_cuts && f.kappa_elsewhere) return *f.kappa_elsewhere - *f.kappa_by_cuts;
  return nan;
}

const char* const default_contract =
    "topology,intersections,folds,creases,patches,vertices=0.1,kappa=0.1,deviation=0.5";

Contract parse_contract(const std::string& list) {
  Contract contract;
  for (std::size_t at = 0; at <= list.size();) {
    const std::size_t end = std::min(list.find(',', at), list.size());
    const std::string item = list.substr(at, end - at), name = item.substr(0, item.find('='));
    at = end + 1;
    if (among(flags, item)) {
      contract.push_back({item});
      continue;
    }
    if (!among(limits, name)) {
      std::string all;
      for (const char* n : flags) all += std::string(all.empty() ? "" : ", ") + n;
      for (const char* n : limits) all += std::string(", ") + n + "=X";
      throw BadUsage("no requirement '" + item + "'; there are " + all);
    }
    const std::string number = item.substr(std::min(name.size() + 1, item.size()));
    double value = 0;
    const auto r = from_chars(number.data(), number.data() + number.size(), value);
    if (r.ec != std::errc() || r.ptr != number.data() + number.size() ||
        !(value >= 0 && std::isfinite(value)))
      throw BadUsage("requirement '" + item + "' needs a number, as in " + name + "=0.1");
    contract.push_back({name, value});
  }
  return contract;
}

std::vector<Failure> judge(const Contract& contract, const Findings& findings, const Mesh& mesh) {
  std::vector<Failure> failures;
  for (const Requirement& r : contract) {
    const bool flag = among(flags, r.name);
    Facts facts{mesh, r.name, flag ? no_figure : r.limit, {}};
    if (flag)
      judge_flag(r.name, findings, mesh, facts);
    else
      judge_limit(r, findings, mesh, facts);
    std::move(facts.failures.begin(), facts.failures.end(), std::back_inserter(failures));
  }
  return failures;
}

Surface offending_faces(const Contract& contract, const Findings& findings, const Surface& result) {
  const std::vector<std::uint8_t> faults = faults_of(contract, findings, result);
  Surface s;
  s.points = result.points;
  std::vector<int> number;
  std::vector<std::uint8_t> fault;
  for (std::size_t t = 0; t < faults.size(); ++t) {
    if (!faults[t]) continue;
    s.tris.push_back(result.tris[t]);
    number.push_back((int)t);
    fault.push_back(faults[t]);
  }
  s.vertex.rows = s.points.size();
  s.face.rows = number.size();
  s.face.set("triangle", std::move(number));
  s.face.set("fault", std::move(fault));
  return s;
}

std::vector<Figure> figures(const Findings& f) {
  const Soundness &m = f.mesh, &r = f.reference;
  const Quality &q = f.quality, &p = f.reference_quality;
  const Distance& d = f.distance;
  constexpr int count = count_figure, digits = short_figure;
  auto known = [](const Soundness& c, int value) { return c.sound() ? value : nan; };
  auto met = [&](Both SheetFindings::*of, int side) { return f.sheets ? ((*f.sheets).*of)[side] : nan; };
  return {
      {"vertices", "vertices", count, (double)r.vertices, (double)m.vertices},
      {"triangles", "triangles", count, (double)r.faces, (double)m.faces},
      {"components", "components", count, known(r, r.components), known(m, m.components)},
      {"genus", "genus", count, known(r, r.genus), known(m, m.genus)},
      {"loops", "boundary loops", count, known(r, r.loops), known(m, m.loops)},
      {"regions", "regions", count, met(&SheetFindings::regions, 0), met(&SheetFindings::regions, 1)},
      {"junction_lines", "lines where sheets meet", count, met(&SheetFindings::lines, 0),
       met(&SheetFindings::lines, 1)},
      {"flip_lines", "lines of flipped orientation", count, met(&SheetFindings::flips, 0),
       met(&SheetFindings::flips, 1)},
      {"junction_corners", "points where these end", count, met(&SheetFindings::corners, 0),
       met(&SheetFindings::corners, 1)},
      {"volume_error", "difference of volumes", digits, nan, f.sheets ? f.sheets->volume_error : nan},
      {"degenerate", "repeated vertices", count, (double)r.degenerate.size(), (double)m.degenerate.size()},
      {"nonmanifold_edges", "non-manifold edges", count, (double)r.nonmanifold.size(),
       (double)m.nonmanifold.size()},
      {"turned_edges", "misoriented edges", count, (double)r.misoriented.size(),
       (double)m.misoriented.size()},
      {"pinched_vertices", "pinched vertices", count, (double)r.pinched.size(), (double)m.pinched.size()},
      {"self_intersections", "self-intersections", count,
       f.reference_pairs.all < 0 ? nan : f.reference_pairs.all, (double)f.intersections.size()},
      {"new_intersections", "where reference has none", count, nan, (double)f.new_intersections.size()},
      {"folds", "folded edges", count, nan, (double)f.edges.folds.size()},
      {"kappa_min", "kappa min", 4, p.kappa_min, q.kappa_min},
      {"kappa_p01", "kappa 1 %", 4, p.kappa_p01, q.kappa_p01},
      {"kappa_mean", "kappa mean", 4, p.kappa_mean, q.kappa_mean},
      {"needles", "needles at corners", count, nan, (double)std::count(f.forced.begin(), f.forced.end(), 1)},
      {"kappa_off_wedges", "kappa off sharp corners", 4, nan, f.kappa_off_corners},
      {"kappa_by_cuts", "kappa mean at the cuts", 4, nan, f.kappa_by_cuts.value_or(nan)},
      {"kappa_elsewhere", "kappa mean elsewhere", 4, nan, f.kappa_elsewhere.value_or(nan)},
      {"min_angle", "angle min", 2, p.min_angle, q.min_angle},
      {"mean_min_angle", "angle min, mean", 2, p.mean_min_angle, q.mean_min_angle},
      {"max_angle", "angle max", 2, p.max_angle, q.max_angle},
      {"valence567", "valence 5 to 7", 4, p.valence567, q.valence567},
      {"edge_min", "edge min", 3, p.edge_min, q.edge_min},
      {"edge_mean", "edge mean", 3, p.edge_mean, q.edge_mean},
      {"edge_max", "edge max", 3, p.edge_max, q.edge_max},
      {"edge_deviation", "edge deviation", 3, p.edge_deviation, q.edge_deviation},
      {"hausdorff_to_reference", "distance of the result", digits, nan, d.to_reference},
      {"hausdorff_to_result", "distance of the reference", digits, nan, d.to_mesh},
      {"hausdorff", "Hausdorff, at least", digits, nan, d.hausdorff},
      {"hausdorff_bound", "Hausdorff, at most", digits, nan, d.hausdorff + d.bound},
      {"deviation", "distance, in sizes", digits, nan, most_deviation * d.deviation.worst},
      {"mean_distance", "distance mean", digits, nan, d.mean},
      {"rms_distance", "distance rms", digits, nan, d.rms},
      {"boundary_distance", "distance of borders", digits, nan, f.boundary},
      {"feature_distance", "distance of features", digits, nan, f.features.value_or(nan)},
      {"vertex_distance", "vertices off, in edges", digits, nan, f.farthest < 0 ? 0 : f.off[f.farthest]},
  };
}

}  // namespace meshpipe
