// SPDX-License-Identifier: BSD-3-Clause
// Vertices of two rows that are fitted to the same sharp edge leave slivers between them; here they go.
#include <algorithm>
#include <optional>

#include "lib/core/edit_mesh.h"
#include "lib/core/spatial_order.h"
#include "lib/wrap/valid.h"

namespace meshpipe {
namespace {

/// Triangles below this kappa are slivers.
constexpr double least_kappa = 0.2;
/// Edges shorter than this, in voxels, are contracted.
constexpr double shortest = 0.3;
/// Cosine of the angle by which the normal of a triangle that is no sliver may turn.
constexpr double most_turn = 0.9;
/// Rounds of independent operations: slivers lie in clusters along sharp edges, of which a round cures one
/// each.
constexpr int sliver_rounds = 60;

/// A contraction of the edge of half-edge h, or a flip if gone < 0.
struct Operation {
  int h, gone;
};
/// One bit for each of the three operations at a half-edge.
int bit_of(const EditMesh& m, const Operation& o) { return o.gone < 0 ? 1 : o.gone == m.from(o.h) ? 2 : 4; }

double kappa_of(const std::vector<Vec3>& p, const Tri& t) { return kappa(p[t[0]], p[t[1]], p[t[2]]); }
Vec3 normal_of(const std::vector<Vec3>& p, const Tri& t) {
  return normalized(area_vector(p[t[0]], p[t[1]], p[t[2]]));
}

/// How far a triangle is from being no sliver.
double deficit(const std::vector<Vec3>& p, const Tri& t) {
  return std::max(0.0, least_kappa - kappa_of(p, t));
}

/// What an operation makes of the triangles around: the sums of their deficits before and after, and the
/// worst cosine between the normals before and after of those that were no slivers.
struct Effect {
  double before = 0, after = 0, turn = 1;
  void compare_normals(const std::vector<Vec3>& p, const Tri& old, const Tri& now) {
    if (kappa_of(p, old) > least_kappa) turn = std::min(turn, dot(normal_of(p, old), normal_of(p, now)));
  }
};

Effect effect_of_contraction(const EditMesh& m, const std::vector<Vec3>& p, int h, int gone) {
  const int kept = m.from(h) == gone ? m.to(h) : m.from(h);
  Effect e;
  m.star(gone, [&](int g) {
    const Tri& old = m.tris[g / 3];
    e.before += deficit(p, old);
    if (old[0] == kept || old[1] == kept || old[2] == kept) return;
    Tri now = old;
    for (int& v : now)
      if (v == gone) v = kept;
    e.after += deficit(p, now);
    e.compare_normals(p, old, now);
  });
  return e;
}

/// The new triangles face the same way as each old one that was no sliver.
Effect effect_of_flip(const EditMesh& m, const std::vector<Vec3>& p, int h) {
  const int a = m.from(h), b = m.to(h), c = m.apex(h), d = m.apex(m.opp[h]);
  const Tri old[2] = {{a, b, c}, {b, a, d}}, now[2] = {{c, d, b}, {d, c, a}};
  Effect e;
  for (int i = 0; i < 2; ++i) {
    e.before += deficit(p, old[i]);
    e.after += deficit(p, now[i]);
    for (const Tri& n : now) e.compare_normals(p, old[i], n);
  }
  return e;
}

/// The best operation at an edge of triangle t, if that is a sliver or has a short edge; `refused` has the
/// bits of those that are out of the question, per half-edge.
std::optional<Operation> cure(const EditMesh& m, const std::vector<Vec3>& p, int t, double short_edge,
                              const std::vector<std::uint8_t>& refused) {
  auto length = [&](int h) { return norm(p[m.to(h)] - p[m.from(h)]); };
  const double least = std::min({length(3 * t), length(3 * t + 1), length(3 * t + 2)});
  const bool is_short = least < short_edge;
  if (!is_short && kappa_of(p, m.tris[t]) >= least_kappa) return {};
  std::optional<Operation> best;
  double best_gain = 0;
  auto consider = [&](const Operation& o, const Effect& e, double bonus) {
    const double gain = e.before - e.after + bonus;
    if (e.turn > most_turn && gain > best_gain && !(refused[o.h] & bit_of(m, o))) best = o, best_gain = gain;
  };
  for (int h = 3 * t; h < 3 * t + 3; ++h) {
    // slivers apart, the gain of a contraction is that a short edge is gone
    const double bonus = length(h) < short_edge ? least_kappa / 4 : 0;
    for (int gone : {m.from(h), m.to(h)})
      if (m.can_collapse(h, gone)) consider({h, gone}, effect_of_contraction(m, p, h, gone), bonus);
    if (!m.joined(m.apex(h), m.apex(m.opp[h]))) consider({h, -1}, effect_of_flip(m, p, h), 0);
  }
  return best;
}

/// Chooses operations whose surroundings share no vertex, slivers of the lowest number first.
std::vector<Operation> independent(const EditMesh& m, const std::vector<Vec3>& p, double short_edge,
                                   const std::vector<std::uint8_t>& refused) {
  std::vector<char> taken(p.size(), 0);
  std::vector<Operation> chosen;
  std::vector<int> around;
  for (int t = 0; t < (int)m.tris.size(); ++t) {
    if (m.dead(t)) continue;
    const auto o = cure(m, p, t, short_edge, refused);
    if (!o) continue;
    around.clear();
    for (int v : {m.from(o->h), m.to(o->h), m.apex(o->h), m.apex(m.opp[o->h])}) {
      around.push_back(v);
      m.neighbors(v, [&](int w) { around.push_back(w); });
    }
    if (std::any_of(around.begin(), around.end(), [&](int v) { return taken[v]; })) continue;
    for (int v : around) taken[v] = 1;
    chosen.push_back({o->h, o->gone});
  }
  return chosen;
}

}  // namespace

void remove_slivers(Mesh& mesh, const Mesh& soup, double spacing, double least,
                    const std::function<bool(const Mesh&, int)>& allowed) {
  const int n_points = (int)mesh.points.size();
  EditMesh m(mesh.tris, n_points, {});
  std::vector<std::uint8_t> refused(3 * m.tris.size(), 0);
  for (int round = 0; round < sliver_rounds; ++round) {
    std::vector<Operation> chosen = independent(m, mesh.points, shortest * spacing, refused);
    if (chosen.empty()) break;
    for (;;) {
      EditMesh trial = m;
      std::vector<int> by(trial.tris.size(), -1);  // the operation that has changed a triangle
      for (int i = 0; i < (int)chosen.size(); ++i) {
        const auto [h, gone] = chosen[i];
        if (gone < 0) {
          by[h / 3] = by[trial.opp[h] / 3] = i;
          trial.flip(h);
        } else {
          trial.star(gone, [&](int g) { by[g / 3] = i; });
          trial.collapse(h, gone);
        }
      }
      Mesh now;
      now.points = mesh.points;
      std::vector<int> number;
      for (int t = 0; t < (int)trial.tris.size(); ++t)
        if (!trial.dead(t)) now.tris.push_back(trial.tris[t]), number.push_back(t);
      std::vector<std::uint8_t> wanted(now.tris.size());
      for (std::size_t t = 0; t < number.size(); ++t) wanted[t] = by[number[t]] >= 0;
      const auto met = triangles_that_meet(now, wanted, soup),
                 others = triangles_that_meet_others(now, wanted, least);
      std::vector<char> bad(chosen.size(), 0);
      for (std::size_t t = 0; t < number.size(); ++t)
        if (by[number[t]] >= 0 && (met[t] || others[t] || !allowed(now, (int)t))) bad[by[number[t]]] = 1;
      if (std::none_of(bad.begin(), bad.end(), [](char b) { return b; })) {
        m = std::move(trial);
        break;
      }
      std::size_t kept = 0;
      for (std::size_t i = 0; i < chosen.size(); ++i) {
        if (bad[i])
          refused[chosen[i].h] |= bit_of(m, chosen[i]);
        else
          chosen[kept++] = chosen[i];
      }
      chosen.resize(kept);
      if (chosen.empty()) break;
    }
  }
  // without gaps
  mesh.tris.clear();
  for (int t = 0; t < (int)m.tris.size(); ++t)
    if (!m.dead(t)) mesh.tris.push_back(m.tris[t]);
  mesh.points = rearranged(mesh.points, number_by_first_use(mesh.tris, mesh.points.size()));
}

}  // namespace meshpipe
