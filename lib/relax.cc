// SPDX-License-Identifier: BSD-3-Clause
#include "lib/relax.h"

#include <algorithm>
#include <cmath>

#include "lib/bvh.h"
#include "lib/edit_mesh.h"
#include "lib/intersect.h"
#include "lib/walk.h"

namespace meshpipe {
namespace {

constexpr double sqrt3 = 1.7320508075688772;

/// Shape energy of a triangle: the inverse mean ratio (l1^2 + l2^2 + l3^2) / (4 sqrt(3) A), 1 for the
/// equilateral and infinite for the degenerate (Knupp 2001), squared so that the worst count most.
double shape_energy(Vec3 a, Vec3 b, Vec3 c) {
  double n2 = norm(area_vector(a, b, c));
  if (n2 <= 0) return 1e30;
  double q = (dot(b - a, b - a) + dot(c - b, c - b) + dot(a - c, a - c)) / (2 * sqrt3 * n2);
  return q * q;
}

class Relaxer {
 public:
  Relaxer(LiftedMesh& mesh, const Surface& reference, const std::vector<int>& line_kind,
          const RelaxOptions& options)
      : lifted_(mesh),
        reference_(reference),
        ref_size_(reference.vertex.has("size") ? &reference.vertex.get<double>("size") : nullptr),
        walk_(reference, reference.face.has("model") ? reference.face.get<std::uint8_t>("model") : no_model_),
        m_(std::move(mesh.tris), (int)mesh.points.size(), mesh.model),
        options_(options) {
    points_.tris.clear();
    points_.points = std::move(mesh.points);
    held_.resize(points_.points.size());
    finer_.assign(held_.size(), 1);
    tried_.resize(held_.size());
    changed_.resize(held_.size());
    for (std::size_t v = 0; v < held_.size(); ++v) {
      int line = mesh.line[v];
      if (line >= 0 && line_kind[line] != interface_line) held_[v] = slides;
    }
    ref_normal_.resize(reference.points.size());
    for (const Tri& t : reference.tris) {
      const Vec3 n = area_vector(reference.points[t[0]], reference.points[t[1]], reference.points[t[2]]);
      for (int v : t) ref_normal_[v] = ref_normal_[v] + n;
    }
    facing_.resize(held_.size());
    for (std::size_t v = 0; v < held_.size(); ++v) facing_[v] = facing_at(lifted_.place[v]);
    std::vector<std::uint8_t> ends(held_.size());
    for (int h = 0; h < (int)m_.hard.size(); ++h)
      if (m_.hard[h] && h > m_.opp[h])
        for (int v : {m_.from(h), m_.to(h)}) {
          held_[v] = std::max<char>(held_[v], slides);
          if (m_.opp[h] >= 0) facing_[v] = {};  // a crease faces two ways
          if (ends[v] < 3) ++ends[v];
        }
    for (std::size_t v = 0; v < held_.size(); ++v)
      if (mesh.kind[v] == 2 || (held_[v] && ends[v] != 2)) held_[v] = fixed;
  }

  RelaxReport run() {
    const double target = options_.target_triangles > 0 ? options_.target_triangles : wanted_triangles();
    for (int i = 0; i < 3; ++i) {
      collapse_short_segments();
      split_long(1.4, 1e9);
      collapse_short(0.65, 0);
      flip_to_regular();
      smooth(2);
    }
    for (int i = 0; i < options_.sweeps; ++i) {
      // edits unsettle the mesh, so they come first and the last sweeps only settle it
      if (2 * i < options_.sweeps) {
        meet_count(target);
        remove_irregular();
      }
      flip_to_regular();
      smooth(1);
      flip_to_shape();
      smooth(2);
    }
    reach_tips();
    mend_worst();
    separate();
    return finish();
  }

 private:
  Vec3 at(int v) const { return points_.points[v]; }
  double size_at(int v) const { return lifted_.size[v] * finer_[v]; }
  double ratio(int a, int b) const { return 2 * norm(at(b) - at(a)) / (size_at(a) + size_at(b)); }
  /// Smooth normal of the reference at a place.
  Vec3 facing_at(const Place& p) const {
    const Tri& v = reference_.tris[p.face];
    return normalized(p.b0 * ref_normal_[v[0]] + p.b1 * ref_normal_[v[1]] + p.b2 * ref_normal_[v[2]]);
  }
  /// How well a triangle with corners p, q, r agrees with the reference's normals at them: the cosine. A fold
  /// would be < 0.
  static double agreement(Vec3 p, Vec3 q, Vec3 r, Vec3 facing) {
    const Vec3 n = area_vector(p, q, r);
    const double l = norm(n) * norm(facing);
    return l > 0 ? dot(n, facing) / l : 1;
  }
  double agreement(int a, int b, int c) const {
    return agreement(at(a), at(b), at(c), facing_[a] + facing_[b] + facing_[c]);
  }
  /// An operation may not leave a triangle that agrees less than this, unless one was worse before.
  static constexpr double least_agreement = 0.5;
  static bool folds(double before, double after) { return after < std::min(before, least_agreement) - 1e-12; }

  Vec3 normal(int t) const {
    const Tri& v = m_.tris[t];
    return normalized(area_vector(at(v[0]), at(v[1]), at(v[2])));
  }

  /// Triangles the size field asks for on the reference: the integral of dA / (sqrt(3)/4 h^2).
  double wanted_triangles() const {
    if (!ref_size_) return (double)m_.live;
    double n = 0;
    for (const Tri& t : reference_.tris) {
      const double h = ((*ref_size_)[t[0]] + (*ref_size_)[t[1]] + (*ref_size_)[t[2]]) / 3;
      n += 0.5 *
           norm(area_vector(reference_.points[t[0]], reference_.points[t[1]], reference_.points[t[2]])) /
           (sqrt3 / 4 * h * h);
    }
    return n;
  }

  /// Edges (the smaller half-edge) that pass `test(h)`, ordered by `key(h)`, then by number.
  template <class Test, class Key>
  std::vector<int> ordered_edges(Test test, Key key) const {
    std::vector<std::pair<double, int>> found;
    for (int h = 0; h < (int)m_.opp.size(); ++h)
      if (!m_.dead(h / 3) && h < m_.opp[h] && !m_.hard[h] && test(h)) found.push_back({key(h), h});
    std::sort(found.begin(), found.end());
    std::vector<int> edges(found.size());
    for (std::size_t i = 0; i < found.size(); ++i) edges[i] = found[i].second;
    return edges;
  }

  // --- split ---

  /// Splits the edge of h at the place on the reference nearest to its middle; false if the pieces would
  /// fold.
  bool split(int h) {
    const int a = m_.from(h), b = m_.to(h), c = m_.apex(h), d = m_.apex(m_.opp[h]);
    const Vec3 middle = lerp(at(a), at(b), 0.5);
    const Place place = place_near(middle, {a, b, c, d}, normal(h / 3) + normal(m_.opp[h] / 3));
    const Vec3 p = walk_.point(place);
    if (norm(p - middle) > 0.5 * norm(at(b) - at(a))) return false;
    const Vec3 facing = facing_at(place);
    const double before = std::min(agreement(a, b, c), agreement(b, a, d));
    const int ring[5] = {a, d, b, c, a};
    for (int i = 0; i < 4; ++i)
      if (folds(before,
                agreement(p, at(ring[i]), at(ring[i + 1]), facing + facing_[ring[i]] + facing_[ring[i + 1]])))
        return false;
    const int low = m_.opp[h] / 3;
    points_.points.push_back(p);
    lifted_.place.push_back(place);
    lifted_.size.push_back(ref_size_ ? interpolate(place) : 0.5 * (lifted_.size[a] + lifted_.size[b]));
    finer_.push_back(std::min(finer_[a], finer_[b]));
    lifted_.kind.push_back(0);
    lifted_.line.push_back(-1);
    held_.push_back(free_);
    facing_.push_back(facing);
    tried_.push_back(0);
    changed_.push_back(0);
    for (int v : {m_.split(h), a, b, c, d}) touch(v);
    lifted_.patch.push_back(lifted_.patch[h / 3]);
    lifted_.patch.push_back(lifted_.patch[low]);
    lifted_.part.push_back(lifted_.part[h / 3]);
    lifted_.part.push_back(lifted_.part[low]);
    ++report_.splits;
    return true;
  }

  /// The place nearest to p that can be walked to from one of the vertices round it. A vertex on a model edge
  /// has two sides, of which the one that faces along `facing` is meant; so a vertex that is free is asked
  /// first.
  Place place_near(Vec3 p, std::initializer_list<int> round, Vec3 facing) const {
    for (int v : round)
      if (held_[v] == free_) return walk_.closest(lifted_.place[v], p);
    Place best = lifted_.place[*round.begin()];
    double least = 1e300;
    for (int v : round)
      for (const Place& start : {lifted_.place[v], walk_.across(lifted_.place[v])}) {
        const Place q = walk_.closest(start, p);
        const Vec3 d = walk_.point(q) - p;
        const double score = dot(d, d) * (dot(walk_.normal(q), facing) > 0.3 * norm(facing) ? 1 : 1e6);
        if (score < least) least = score, best = q;
      }
    return best;
  }

  double interpolate(const Place& p) const {
    const Tri& v = reference_.tris[p.face];
    return p.b0 * (*ref_size_)[v[0]] + p.b1 * (*ref_size_)[v[1]] + p.b2 * (*ref_size_)[v[2]];
  }

  void split_long(double above, double most) {
    auto edges = ordered_edges([&](int h) { return ratio(m_.from(h), m_.to(h)) > above; },
                               [&](int h) { return -ratio(m_.from(h), m_.to(h)); });
    for (int h : edges) {
      if (m_.live >= most) break;
      if (ratio(m_.from(h), m_.to(h)) > above) split(h);
    }
  }

  // --- collapse ---

  /// Takes the vertex `gone` of the edge of h out, into the edge's other end (or a better point if that is
  /// free), when the star stays unfolded, sound in shape (energy at most `worst`, or no worse than now) and
  /// no edge gets longer than `longest` times the size. A vertex on a border or model edge goes only along
  /// it, and only if the line hardly changes.
  bool collapse(int h, int gone, double worst, double longest) {
    const int kept = m_.from(h) == gone ? m_.to(h) : m_.from(h), g = m_.opp[h];
    if (held_[gone] >= fixed || (held_[gone] == slides && !m_.hard[h]) || !m_.can_collapse(h, gone))
      return false;
    const int c = m_.apex(h), d = g < 0 ? -1 : m_.apex(g);
    if (g >= 0 && m_.valence(gone) + m_.valence(kept) - 4 > 9) return false;
    if (d >= 0 && held_[c] && held_[d] && held_[kept] && !m_.hard[h]) return false;
    Place place = lifted_.place[kept];
    Vec3 p = at(kept);
    if (!held_[kept]) {
      place = walk_.closest(lifted_.place[kept], lerp(at(gone), p, 0.5));
      p = walk_.point(place);
    }
    if (held_[gone] == slides) {
      // the line's next vertex on the other side
      int beyond = -1;
      m_.star(gone, [&](int e) {
        if (m_.hard[e] && m_.to(e) != kept) beyond = m_.to(e);
        if (m_.hard[prev(e)] && m_.apex(e) != kept) beyond = m_.apex(e);
      });
      if (beyond < 0) return false;
      const Vec3 chord = p - at(beyond);
      if (norm(cross(chord, at(gone) - at(beyond))) > 0.1 * size_at(gone) * norm(chord)) return false;
    }
    const Vec3 facing = held_[kept] ? facing_[kept] : facing_at(place);
    double now = 0, after = 0, agreed = 1, agrees = 1;
    bool ok = true;
    for (int v : {gone, kept})
      m_.star(v, [&](int e) {
        const Vec3 x = at(v), y = at(m_.to(e)), z = at(m_.apex(e));
        now = std::max(now, shape_energy(x, y, z));
        agreed = std::min(agreed, agreement(v, m_.to(e), m_.apex(e)));
        if (e / 3 == h / 3 || (g >= 0 && e / 3 == g / 3)) return;
        after = std::max(after, shape_energy(p, y, z));
        agrees = std::min(agrees, agreement(p, y, z, facing + facing_[m_.to(e)] + facing_[m_.apex(e)]));
        if (norm(y - p) > longest * 0.5 * (size_at(m_.to(e)) + size_at(kept)) && norm(y - p) > norm(y - x))
          ok = false;
      });
    if (!ok || (after > worst && after > now) || folds(agreed, agrees)) return false;
    m_.collapse(h, gone);
    points_.points[kept] = p;
    lifted_.place[kept] = place;
    facing_[kept] = facing;
    touch(kept);
    m_.neighbours(kept, [&](int v) { touch(v); });
    ++report_.collapses;
    return true;
  }

  /// Collapses the edge whichever way works.
  bool collapse_either(int h, double worst, double longest) {
    const int a = m_.from(h), b = m_.to(h);
    return collapse(h, a, worst, longest) || collapse(h, b, worst, longest);
  }

  void collapse_short(double below, double least) {
    auto edges = ordered_edges([&](int h) { return ratio(m_.from(h), m_.to(h)) < below; },
                               [&](int h) { return ratio(m_.from(h), m_.to(h)); });
    for (int h : edges) {
      if (m_.live <= least) break;
      if (!m_.dead(h / 3) && !m_.hard[h] && ratio(m_.from(h), m_.to(h)) < below) collapse_either(h, 4, 1.4);
    }
  }

  /// Segments of borders and model edges much shorter than the size: an interface that ended close to a
  /// corner leaves them.
  void collapse_short_segments() {
    for (int h = 0; h < (int)m_.opp.size(); ++h)
      if (!m_.dead(h / 3) && m_.hard[h] && h > m_.opp[h] && ratio(m_.from(h), m_.to(h)) < 0.5)
        collapse_either(h, 4, 1.6);
  }

  /// Splits the longest or collapses the shortest edges until the count is within half a percent of the
  /// target.
  void meet_count(double target) {
    if (m_.live > 1.005 * target) collapse_short(0.95, target);
    if (m_.live < 0.995 * target) split_long(1.05, target);
  }

  /// Inside vertices of valence 3 and 4 go: their star becomes one or two triangles.
  void remove_irregular() {
    const int n = (int)m_.out.size();
    for (int v = 0; v < n; ++v) {
      if (m_.out[v] < 0 || held_[v] || m_.on_border(v)) continue;
      const int valence = m_.valence(v);
      if (valence > 4) continue;
      int best = -1;
      double shortest = 1e300;
      m_.star(v, [&](int h) {
        double l = norm(at(m_.to(h)) - at(v));
        if (l < shortest) shortest = l, best = h;
      });
      collapse(best, v, 4, 1.6);
    }
  }

  // --- flip ---

  bool may_flip(int h) const {
    const int g = m_.opp[h];
    if (g < 0 || m_.hard[h]) return false;
    const int a = m_.from(h), b = m_.to(h), c = m_.apex(h), d = m_.apex(g);
    if (c == d || m_.valence(a) <= 3 || m_.valence(b) <= 3 || m_.joined(c, d)) return false;
    // the surface may not bend more across the new edge than across the old one, but for little
    const Vec3 n0 = normal(h / 3), n1 = normal(g / 3);
    const Vec3 m0 = normalized(area_vector(at(a), at(d), at(c))),
               m1 = normalized(area_vector(at(b), at(c), at(d)));
    if (dot(m0, n0 + n1) <= 0 || dot(m1, n0 + n1) <= 0) return false;
    if (folds(std::min(agreement(a, b, c), agreement(b, a, d)),
              std::min(agreement(a, d, c), agreement(b, c, d))))
      return false;
    return dot(m0, m1) >= std::min(dot(n0, n1), 0.9) - 1e-12;
  }

  double worst_now(int h) const {
    const int a = m_.from(h), b = m_.to(h), c = m_.apex(h), d = m_.apex(m_.opp[h]);
    return std::max(shape_energy(at(a), at(b), at(c)), shape_energy(at(b), at(a), at(d)));
  }
  double worst_flipped(int h) const {
    const int a = m_.from(h), b = m_.to(h), c = m_.apex(h), d = m_.apex(m_.opp[h]);
    return std::max(shape_energy(at(a), at(d), at(c)), shape_energy(at(b), at(c), at(d)));
  }

  void do_flip(int h) {
    for (int v : {m_.from(h), m_.to(h), m_.apex(h), m_.apex(m_.opp[h])}) touch(v);
    m_.flip(h);
    ++report_.flips;
  }

  /// Neighbours a vertex should have: 6 inside; at the border or on a model edge in proportion to the angle
  /// is not known here, so 4 on a border.
  int excess(int v) const { return m_.valence(v) - (m_.on_border(v) ? 4 : 6); }

  /// Flips that bring valences nearer to 6 and leave triangles of sound shape.
  void flip_to_regular() {
    for (int h = 0; h < (int)m_.opp.size(); ++h) {
      if (m_.dead(h / 3) || h > m_.opp[h] || m_.hard[h]) continue;
      const int a = m_.from(h), b = m_.to(h), c = m_.apex(h), d = m_.apex(m_.opp[h]);
      if ((held_[a] && !m_.on_border(a)) || (held_[b] && !m_.on_border(b))) continue;
      const int ea = excess(a), eb = excess(b), ec = excess(c), ed = excess(d);
      const int before = ea * ea + eb * eb + ec * ec + ed * ed;
      const int after = (ea - 1) * (ea - 1) + (eb - 1) * (eb - 1) + (ec + 1) * (ec + 1) + (ed + 1) * (ed + 1);
      if (after >= before || !may_flip(h)) continue;
      const double w = worst_flipped(h);
      if (w > 3 && w > worst_now(h)) continue;
      do_flip(h);
    }
  }

  /// Flips that make the worse of the two triangles better.
  void flip_to_shape() {
    for (int h = 0; h < (int)m_.opp.size(); ++h) {
      if (m_.dead(h / 3) || h > m_.opp[h] || m_.hard[h]) continue;
      if (worst_flipped(h) < 0.9 * worst_now(h) && may_flip(h)) do_flip(h);
    }
  }

  // --- move ---

  /// Energy of the star of v if it were at p with this normal of the reference, and how badly its triangles
  /// then agree.
  struct StarState {
    double energy = 0, agreement = 1;
  };
  StarState star_state(int v, Vec3 p, Vec3 facing) const {
    StarState s;
    const double h = size_at(v), a0 = sqrt3 / 4 * h * h;
    m_.star(v, [&](int g) {
      const Vec3 y = at(m_.to(g)), z = at(m_.apex(g));
      const Vec3 n = area_vector(p, y, z);
      const double area = 0.5 * norm(n);
      s.energy += shape_energy(p, y, z) + (area > 0 ? size_weight * (area / a0 + a0 / area) : 1e30);
      s.agreement =
          std::min(s.agreement, agreement(p, y, z, facing + facing_[m_.to(g)] + facing_[m_.apex(g)]));
    });
    return s;
  }

  static constexpr double size_weight = 0.1;
  static constexpr double settled = 3e-3;  ///< a step below this share of the size is none

  /// On a border the reference has a normal; on a model edge it has two, so none.
  Vec3 border_facing(int v, const Place& place) const { return m_.on_border(v) ? facing_at(place) : Vec3{}; }

  /// The same for a vertex on a border or model edge, which slides along it: a parabola through three
  /// energies.
  bool slide(int v) {
    Vec3 ahead{}, behind{};
    m_.star(v, [&](int e) {
      if (m_.hard[e]) ahead = at(m_.to(e));
      if (m_.hard[prev(e)]) behind = at(m_.from(prev(e)));
    });
    const Vec3 x = at(v);
    const double size = size_at(v), reach = std::min(norm(ahead - x), norm(behind - x)), probe = 0.1 * reach;
    const Vec3 direction = normalized(ahead - behind);
    if (reach <= 0) return false;
    auto place_at = [&](double s) { return walk_.slide(lifted_.place[v], x + s * direction); };
    auto state = [&](double s) {
      const Place p = place_at(s);
      return star_state(v, walk_.point(p), border_facing(v, p));
    };
    const StarState now = star_state(v, x, facing_[v]);
    const double e0 = now.energy, left = state(-probe).energy, right = state(probe).energy;
    const double bend = left - 2 * e0 + right;
    double s = bend > 0 ? 0.5 * probe * (left - right) / bend : left < right ? -2 * probe : 2 * probe;
    s = std::clamp(s, -0.4 * reach, 0.4 * reach);
    if (!(std::abs(s) >= settled * size)) return false;
    const StarState then = state(s);
    if (then.energy > e0 * (1 - 1e-4) || folds(now.agreement, then.agreement)) return false;
    lifted_.place[v] = place_at(s);
    points_.points[v] = walk_.point(lifted_.place[v]);
    facing_[v] = border_facing(v, lifted_.place[v]);
    ++report_.moves;
    return true;
  }

  /// One Newton step on the star's energy in the tangent plane, walked to on the reference and kept only if
  /// the energy in space falls.
  bool move(int v) {
    const Vec3 x = at(v);
    Vec3 n{};
    m_.star(v, [&](int g) { n = n + area_vector(x, at(m_.to(g)), at(m_.apex(g))); });
    n = normalized(n);
    const Vec3 s = normalized(std::abs(n.x) < 0.6 ? cross(n, {1, 0, 0}) : cross(n, {0, 1, 0})),
               t = cross(n, s);
    const double size = size_at(v), l0 = sqrt3 / 2 * size * size;  // twice the target area
    double gx = 0, gy = 0, hxx = 0, hxy = 0, hyy = 0;
    bool flat = true;
    m_.star(v, [&](int e) {
      const Vec3 py = at(m_.to(e)) - x, pz = at(m_.apex(e)) - x;
      const Vec2 y{dot(py, s), dot(py, t)}, z{dot(pz, s), dot(pz, t)};
      // twice the area is linear in the vertex's position p: L = L0 + dL.p; the sum of squared edges is
      // quadratic
      const double area = cross(y, z);
      if (area <= 1e-3 * l0) {
        flat = false;
        return;
      }
      const Vec2 da{y.y - z.y, z.x - y.x};
      const double squares = dot(y, y) + dot(z, z) + dot(z - y, z - y), k = 1 / (2 * sqrt3);
      const Vec2 ds = -2.0 * (y + z);
      const double q = k * squares / area;
      const Vec2 dq = (k / area) * (ds - (squares / area) * da);
      // second derivatives of q, then of q^2 + w (L/l0 + l0/L)
      const double u = k / area, w = size_weight * 2 * l0 / (area * area * area);
      auto second = [&](double dsi, double dsj, double dai, double daj, double same) {
        return u * (4 * same - (dsi * daj + dsj * dai) / area + 2 * squares * dai * daj / (area * area));
      };
      hxx += 2 * (dq.x * dq.x + q * second(ds.x, ds.x, da.x, da.x, 1)) + w * da.x * da.x;
      hxy += 2 * (dq.x * dq.y + q * second(ds.x, ds.y, da.x, da.y, 0)) + w * da.x * da.y;
      hyy += 2 * (dq.y * dq.y + q * second(ds.y, ds.y, da.y, da.y, 1)) + w * da.y * da.y;
      const double size_slope = size_weight * (1 / l0 - l0 / (area * area));
      gx += 2 * q * dq.x + size_slope * da.x;
      gy += 2 * q * dq.y + size_slope * da.y;
    });
    Vec2 step;
    const double det = hxx * hyy - hxy * hxy;
    if (flat && det > 1e-12 * hxx * hyy && hxx > 0)
      step = {-(hyy * gx - hxy * gy) / det, -(hxx * gy - hxy * gx) / det};
    else {
      // a star with folded triangles: towards its centre
      Vec3 centre{};
      int count = 0;
      m_.star(v, [&](int e) { centre = centre + (at(m_.to(e)) - x), ++count; });
      centre = (1.0 / count) * centre;
      step = {dot(centre, s), dot(centre, t)};
    }
    const double length = norm(step);
    if (length < settled * size) return false;
    if (length > 0.5 * size) step = (0.5 * size / length) * step;
    const StarState before = star_state(v, x, facing_[v]);
    for (int halving = 0; halving < 3; ++halving, step = 0.5 * step) {
      Place place = walk_.closest(lifted_.place[v], x + step.x * s + step.y * t);
      const Vec3 p = walk_.point(place);
      const Vec3 facing = facing_at(place);
      const StarState after = star_state(v, p, facing);
      if (after.energy < before.energy && !folds(before.agreement, after.agreement)) {
        points_.points[v] = p;
        facing_[v] = facing;
        lifted_.place[v] = place;
        if (ref_size_) lifted_.size[v] = interpolate(place);
        ++report_.moves;
        return true;
      }
    }
    return false;
  }

  /// Moves v unless nothing round it has changed since it was last tried.
  void improve(int v) {
    if (m_.out[v] < 0 || held_[v] >= fixed || (tried_[v] && tried_[v] > changed_[v])) return;
    tried_[v] = ++clock_;
    if (held_[v] == slides ? slide(v) : move(v)) {
      touch(v);
      m_.star(v, [&](int h) { touch(m_.to(h)), touch(m_.apex(h)); });
    }
  }
  void touch(int v) { changed_[v] = ++clock_; }

  void smooth(int sweeps) {
    const int n = (int)m_.out.size();
    for (int i = 0; i < sweeps; ++i)
      for (int v = 0; v < n; ++v) improve(v);
  }

  // --- the last few ---

  /// Tips and ridges that the mesh cuts off are where it is farthest from the reference. For the vertices of
  /// the reference that lie farther than a tenth of the size, the farthest first, the mesh vertex nearest by
  /// goes there and stays, if it can walk there and leaves its star in good shape.
  void reach_tips() {
    Mesh now{points_.points, {}};
    std::vector<int> number;
    for (int t = 0; t < (int)m_.tris.size(); ++t)
      if (!m_.dead(t)) now.tris.push_back(m_.tris[t]), number.push_back(t);
    if (now.tris.empty()) return;
    const Bvh tree(now);
    const int n = (int)reference_.points.size();
    std::vector<Bvh::Hit> hit(n);
#pragma omp parallel for schedule(static)
    for (int v = 0; v < n; ++v) hit[v] = tree.nearest(reference_.points[v]);
    const double h = std::sqrt(4 / sqrt3 * total_area(now) / (double)now.tris.size());
    std::vector<std::pair<double, int>> far;
    double farthest = 0;
    for (int v = 0; v < n; ++v) farthest = std::max(farthest, hit[v].distance);
    const double far_enough = std::max(0.1 * h, 0.5 * farthest);
    for (int v = 0; v < n; ++v)
      if (hit[v].distance > far_enough) far.push_back({-hit[v].distance, v});
    std::sort(far.begin(), far.end());
    int left = (int)now.tris.size() / 400;  // more would cost the mesh its regularity
    for (auto [minus_distance, v] : far) {
      if (left == 0) break;
      const Vec3 tip = reference_.points[v];
      int nearest = -1;
      for (int w : m_.tris[number[hit[v].place.face]])
        if (held_[w] == free_ && (nearest < 0 || norm(at(w) - tip) < norm(at(nearest) - tip))) nearest = w;
      if (nearest < 0) continue;
      const Place place = walk_.closest(lifted_.place[nearest], tip);
      const Vec3 p = walk_.point(place), facing = facing_at(place);
      if (norm(p - tip) > 1e-6 * h) continue;
      double worst = 0;
      m_.star(nearest,
              [&](int e) { worst = std::max(worst, shape_energy(p, at(m_.to(e)), at(m_.apex(e)))); });
      if (worst > 1.9 || folds(star_state(nearest, at(nearest), facing_[nearest]).agreement,
                               star_state(nearest, p, facing).agreement))
        continue;
      points_.points[nearest] = p;
      lifted_.place[nearest] = place;
      facing_[nearest] = facing;
      if (ref_size_) lifted_.size[nearest] = interpolate(place);
      held_[nearest] = anchored;
      --left;
      touch(nearest);
      m_.neighbours(nearest, [&](int w) { touch(w); });
    }
    smooth(3);
    flip_to_shape();
    smooth(2);
  }

  double kappa_of(int t) const { return kappa(at(m_.tris[t][0]), at(m_.tris[t][1]), at(m_.tris[t][2])); }

  /// Triangles of low quality one by one: whatever of flip, collapse, split and moves of the neighbourhood
  /// helps.
  void mend_worst() {
    for (int round = 0; round < 6; ++round) {
      std::vector<std::pair<double, int>> bad;
      for (int t = 0; t < (int)m_.tris.size(); ++t)
        if (!m_.dead(t))
          if (double k = kappa_of(t); k < 0.7) bad.push_back({k, t});
      if (bad.empty()) return;
      std::sort(bad.begin(), bad.end());
      for (auto [k, t] : bad) {
        if (m_.dead(t) || kappa_of(t) > 0.75) continue;
        for (int i = 0; i < 3 && !m_.dead(t); ++i) {
          const int h = 3 * t + i;
          if (m_.hard[h]) continue;
          if (worst_flipped(h) < 0.95 * worst_now(h) && may_flip(h)) do_flip(h);
        }
        if (kappa_of(t) < 0.5) {
          int shortest = 3 * t;
          for (int h = 3 * t; h < 3 * t + 3; ++h)
            if (norm(at(m_.to(h)) - at(m_.from(h))) < norm(at(m_.to(shortest)) - at(m_.from(shortest))))
              shortest = h;
          if (collapse_either(shortest, 1, 1.8)) continue;
        }
        for (int repeat = 0; repeat < 2; ++repeat)
          for (int v : m_.tris[t]) {
            improve(v);
            std::vector<int> ring;
            m_.star(v, [&](int e) { ring.push_back(m_.to(e)); });
            for (int w : ring) improve(w);
          }
      }
    }
  }

  /// Where triangles of the result intersect, the surface is too thin or bends too much for their size:
  /// refine there, and ask for smaller triangles from then on. Gives up when that does not help.
  void separate() {
    const int most = m_.live + m_.live / 4 + 1000;
    for (int round = 0;; ++round) {
      Mesh now{points_.points, {}};
      std::vector<int> number;
      for (int t = 0; t < (int)m_.tris.size(); ++t)
        if (!m_.dead(t)) now.tris.push_back(m_.tris[t]), number.push_back(t);
      const auto pairs = self_intersections(now);
      report_.intersections = (int)pairs.size();
      if (pairs.empty() || round == 12 || m_.live > most) return;
      std::vector<int> culprits;
      for (auto [s, t] : pairs) culprits.insert(culprits.end(), {number[s], number[t]});
      std::sort(culprits.begin(), culprits.end());
      culprits.erase(std::unique(culprits.begin(), culprits.end()), culprits.end());
      std::vector<int> around;
      for (int t : culprits)
        for (int v : m_.tris[t]) {
          around.push_back(v);
          m_.star(v, [&](int e) { around.push_back(m_.to(e)); });
        }
      std::sort(around.begin(), around.end());
      around.erase(std::unique(around.begin(), around.end()), around.end());
      for (int v : around) {
        finer_[v] *= 0.8;
        touch(v);
      }
      for (int t : culprits) {
        int longest = -1;
        double length = 0;
        for (int h = 3 * t; h < 3 * t + 3; ++h) {
          double l = norm(at(m_.to(h)) - at(m_.from(h)));
          if (!m_.hard[h] && l > length) length = l, longest = h;
        }
        if (longest >= 0 && split(longest)) around.push_back((int)m_.out.size() - 1);
      }
      flip_to_shape();
      for (int repeat = 0; repeat < 3; ++repeat)
        for (int v : around) improve(v);
    }
  }

  RelaxReport finish() {
    std::vector<int> number(m_.out.size(), -1);
    LiftedMesh& r = lifted_;
    int n = 0;
    for (std::size_t v = 0; v < m_.out.size(); ++v) {
      if (m_.out[v] < 0) continue;
      number[v] = n;
      const bool on_line = held_[v] == slides || held_[v] == fixed;
      r.place[n] = r.place[v], r.kind[n] = on_line ? r.kind[v] : 0, r.line[n] = on_line ? r.line[v] : -1;
      r.size[n] = r.size[v];
      points_.points[n++] = points_.points[v];
    }
    points_.points.resize(n), r.place.resize(n), r.kind.resize(n), r.line.resize(n), r.size.resize(n);
    r.points = std::move(points_.points);
    r.tris.clear();
    r.model.clear();
    double sum = 0;
    report_.kappa_min = 1;
    for (int t = 0, k = 0; t < (int)m_.tris.size(); ++t) {
      if (m_.dead(t)) continue;
      Tri v;
      std::uint8_t model = 0;
      for (int i = 0; i < 3; ++i) {
        v[i] = number[m_.tris[t][i]];
        if (m_.hard[3 * t + i] && m_.opp[3 * t + i] >= 0) model |= 1 << i;
      }
      r.tris.push_back(v);
      r.model.push_back(model);
      r.patch[k] = r.patch[t], r.part[k] = r.part[t];
      ++k;
      double q = kappa(r.points[v[0]], r.points[v[1]], r.points[v[2]]);
      sum += q;
      report_.kappa_min = std::min(report_.kappa_min, q);
    }
    r.patch.resize(r.tris.size()), r.part.resize(r.tris.size());
    report_.kappa_mean = sum / std::max<std::size_t>(1, r.tris.size());
    return report_;
  }

  LiftedMesh& lifted_;
  const Surface& reference_;
  const std::vector<double>* ref_size_;
  const std::vector<std::uint8_t> no_model_;
  SurfaceWalk walk_;
  EditMesh m_;
  Mesh points_;
  std::vector<Vec3> ref_normal_;  ///< at the reference's vertices, not of unit length
  std::vector<Vec3> facing_;      ///< the reference's normal at each vertex's place; zero on model edges
  enum : char { free_ = 0, slides = 1, fixed = 2, anchored = 3 };
  std::vector<char> held_;     ///< per vertex: free, on a border or model edge, or a corner
  std::vector<double> finer_;  ///< factor on the size field, below 1 where intersections asked for refinement
  std::vector<int> tried_,
      changed_;  ///< when a vertex was last tried to move, and when its star last changed
  int clock_ = 0;
  RelaxOptions options_;
  RelaxReport report_;
};

}  // namespace

RelaxReport relax(LiftedMesh& mesh, const Surface& reference, const std::vector<int>& line_kind,
                  const RelaxOptions& options) {
  return Relaxer(mesh, reference, line_kind, options).run();
}

}  // namespace meshpipe
