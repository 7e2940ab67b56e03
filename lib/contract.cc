// SPDX-License-Identifier: BSD-3-Clause
#include "lib/contract.h"

#include <charconv>
#include <cstdio>

#include "lib/error.h"

namespace meshpipe {
namespace {

std::string text(double x) {
  char s[32];
  std::snprintf(s, sizeof s, "%.6g", x);
  return s;
}

std::string place(Vec3 p) { return "at (" + text(p.x) + " " + text(p.y) + " " + text(p.z) + ")"; }

std::string triangle(const Mesh& mesh, int t) {
  const Tri& v = mesh.tris[t];
  return "triangle " + std::to_string(t) + " " +
         place(1.0 / 3 * (mesh.points[v[0]] + mesh.points[v[1]] + mesh.points[v[2]]));
}

std::optional<double>* limit(Contract& c, const std::string& name) {
  if (name == "kappa") return &c.kappa;
  if (name == "kappa_mean") return &c.kappa_mean;
  if (name == "angle") return &c.angle;
  if (name == "hausdorff") return &c.hausdorff;
  if (name == "boundary") return &c.boundary;
  return nullptr;
}

bool* flag(Contract& c, const std::string& name) {
  if (name == "topology") return &c.topology;
  if (name == "intersections") return &c.intersections;
  if (name == "patches") return &c.patches;
  return nullptr;
}

void judge_topology(const Findings& f, const Mesh& mesh, std::vector<Failure>& failures) {
  const Connectivity &m = f.mesh, &r = f.reference;
  auto culprits = [&](int count, int first, const char* one, const char* many) {
    if (count)
      failures.push_back({"topology", std::to_string(count) + " " + (count == 1 ? one : many) +
                                          ", the first in " + triangle(mesh, first)});
  };
  culprits(m.degenerate, m.first_degenerate, "triangle with a repeated vertex",
           "triangles with a repeated vertex");
  culprits(m.nonmanifold, m.first_nonmanifold, "edge with more than two triangles",
           "edges with more than two triangles");
  culprits(m.turned, m.first_turned, "edge whose triangles disagree on orientation",
           "edges whose triangles disagree on orientation");
  culprits(m.pinched, m.first_pinched, "pinched vertex", "pinched vertices");
  if (!m.sound() || !r.sound()) return;
  auto same = [&](const char* what, int has, int needs) {
    if (has != needs)
      failures.push_back({"topology", std::string(what) + " " + std::to_string(has) + ", the reference has " +
                                          std::to_string(needs)});
  };
  same("components", m.components, r.components);
  same("genus", m.genus, r.genus);
  same("boundary loops", m.loops, r.loops);
}

}  // namespace

Contract parse_contract(const std::string& list) {
  Contract c;
  for (std::size_t at = 0; at <= list.size();) {
    const std::size_t end = std::min(list.find(',', at), list.size());
    const std::string item = list.substr(at, end - at), name = item.substr(0, item.find('='));
    at = end + 1;
    if (bool* b = flag(c, item)) {
      *b = true;
      continue;
    }
    std::optional<double>* x = limit(c, name);
    if (!x)
      throw BadUsage("no requirement '" + item +
                     "'; there are topology, intersections, patches, kappa=X, kappa_mean=X, angle=DEGREES, "
                     "hausdorff=X and boundary=X");
    const std::string number = item.substr(std::min(name.size() + 1, item.size()));
    double value = 0;
    const auto r = std::from_chars(number.data(), number.data() + number.size(), value);
    if (r.ec != std::errc() || r.ptr != number.data() + number.size() || !(value >= 0))
      throw BadUsage("requirement '" + item + "' needs a number, as in " + name + "=0.1");
    *x = value;
  }
  return c;
}

std::vector<Failure> judge(const Contract& c, const Findings& f, const Mesh& mesh) {
  std::vector<Failure> failures;
  if (c.topology) judge_topology(f, mesh, failures);
  if (c.intersections && (int)f.intersections.size() > std::max(0, f.reference_intersections))
    failures.push_back({"intersections", std::to_string(f.intersections.size()) +
                                             " pairs of triangles intersect, the reference has " +
                                             std::to_string(f.reference_intersections) +
                                             "; the first is triangle " +
                                             std::to_string(f.intersections[0].second) + " with " +
                                             triangle(mesh, f.intersections[0].first)});
  if (c.patches)
    for (const std::string& name : f.lost_patches)
      failures.push_back({"patches", "patch " + name + " is lost"});
  if (c.kappa && !(f.quality.kappa_min > *c.kappa) && f.quality.worst >= 0)
    failures.push_back({"kappa", "smallest is " + text(f.quality.kappa_min) + " in " +
                                     triangle(mesh, f.quality.worst) + ", not above " + text(*c.kappa)});
  auto above = [&](const char* name, double value, const std::optional<double>& bound) {
    if (bound && !(value > *bound)) failures.push_back({name, text(value) + ", not above " + text(*bound)});
  };
  above("kappa_mean", f.quality.kappa_mean, c.kappa_mean);
  above("angle", f.quality.min_angle, c.angle);
  if (c.hausdorff && !(f.distance.hausdorff <= *c.hausdorff))
    failures.push_back({"hausdorff", text(f.distance.hausdorff) + " " + place(f.distance.place) + ", above " +
                                         text(*c.hausdorff)});
  if (c.boundary && !(f.distance.boundary <= *c.boundary))
    failures.push_back({"boundary", text(f.distance.boundary) + ", above " + text(*c.boundary)});
  return failures;
}

}  // namespace meshpipe
