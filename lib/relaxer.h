// SPDX-License-Identifier: BSD-3-Clause
// The state that the steps of relax share; for lib/relax*.cc only. relax.cc is the schedule, relax_move.cc
// moves vertices, relax_edit.cc changes the connectivity, relax_tips.cc and relax_mend.cc look after
// the few places that need it.
#pragma once
#include <initializer_list>
#include <optional>

#include "lib/edit_mesh.h"
#include "lib/relax.h"
#include "lib/walk.h"

namespace meshpipe {

constexpr double sqrt3 = 1.7320508075688772;

/// Shape energy of a triangle: the square of the inverse mean ratio (l1^2 + l2^2 + l3^2) / (4 sqrt(3) A)
/// (Knupp 2001): 1 for the equilateral, infinite for the degenerate; squared so that the worst count most.
inline double shape_energy(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 n = area_vector(a, b, c);
  const double n2 = dot(n, n), squares = dot(b - a, b - a) + dot(c - b, c - b) + dot(a - c, a - c);
  return n2 > 0 ? squares * squares / (12 * n2) : 1e30;
}

/// How well a triangle with corners p, q, r agrees with the reference's normals there, whose sum is `facing`:
/// the cosine; a fold is < 0. Vertices on model edges have no normal; a triangle of three such agrees with
/// anything.
inline double agreement(Vec3 p, Vec3 q, Vec3 r, Vec3 facing) {
  const Vec3 n = area_vector(p, q, r);
  const double l2 = dot(n, n) * dot(facing, facing);
  return l2 > 0 ? dot(n, facing) / std::sqrt(l2) : 1;
}

/// An operation may not leave a triangle that agrees less than this, unless one was worse before.
constexpr double least_agreement = 0.5;
inline bool folds(double before, double after) { return after < std::min(before, least_agreement) - 1e-12; }

/// What the energy of a vertex depends on, gathered: its triangles (p, y[i], z[i]). By coordinates, so that
/// the compiler takes several triangles at a time.
struct Star {
  static constexpr int most = 32;
  int n = 0;
  double y[3][most], z[3][most];
  double facing[3][most];  ///< the sum of the normals at the two other corners
  double normal[3][most];  ///< area vectors of the triangles with the last p that was looked at
  void look(Vec3 p);
  double energy(Vec3 p, double size);
  /// Do all triangles with the last p agree at least `least_agreement`, when its normal is `facing_p`?
  bool unfolded(Vec3 facing_p) const;
  double agreement(Vec3 p, Vec3 facing_p) const;
};

/// A place of the reference that the mesh is to be near to, and a triangle of the mesh that was near to it.
struct Tip {
  Place place;
  int near = -1;
};

/// The reference surface, ready to be walked on.
struct Ground {
  explicit Ground(const Surface& reference);
  /// Smooth unit normal at a place.
  Vec3 normal(const Place& p) const;
  double size(const Place& p) const;
  std::vector<Tip> likely_tips(double h) const;

  const Surface& surface;
  const std::vector<double>* sizes;  ///< null if the surface has none
  const std::vector<std::uint8_t> no_model;
  const SurfaceWalk walk;
  std::vector<Vec3> normals;  ///< at the vertices, not of unit length
};

class Relaxer {
 public:
  Relaxer(LiftedMesh mesh, const Ground& ground, const std::vector<int>& line_kind,
          const std::vector<char>& corner, const RelaxOptions& options);
  RelaxReport run();
  LiftedMesh take_mesh() { return std::move(lifted_); }

 private:
  enum Hold : char { loose = 0, slides = 1, fixed = 2, anchored = 3, frozen = 4, paired = 5 };
  /// A change of connectivity, as it was done.
  struct Edit {
    enum Kind { flip, split, collapse } kind;
    int h, gone;
  };

  Vec3 at(int v) const { return points_[v]; }
  double size_at(int v) const { return lifted_.size[v] * finer_[v]; }
  double ratio(int a, int b) const { return 2 * norm(at(b) - at(a)) / (size_at(a) + size_at(b)); }
  double ratio(int h) const { return ratio(m_.from(h), m_.to(h)); }
  double shape(int a, int b, int c) const { return shape_energy(at(a), at(b), at(c)); }
  double kappa_of(int t) const { return kappa(at(m_.tris[t][0]), at(m_.tris[t][1]), at(m_.tris[t][2])); }
  double agrees(int a, int b, int c) const {
    return agreement(at(a), at(b), at(c), facing_[a] + facing_[b] + facing_[c]);
  }
  Vec3 normal(int t) const {
    return normalized(area_vector(at(m_.tris[t][0]), at(m_.tris[t][1]), at(m_.tris[t][2])));
  }
  Vec3 facing_at(const Place& p) const { return ground_->normal(p); }
  /// On a border the reference has a normal; on a model edge it has two, so none.
  Vec3 facing_on_line(int v, const Place& p) const { return m_.on_border(v) ? facing_at(p) : Vec3{}; }
  void touch(int v) { changed_[v] = ++clock_; }
  void put(int v, const Place& place, Vec3 p, Vec3 facing);
  /// The mesh without gaps, for searches; number[i] is the triangle that triangle i of it is here.
  Mesh compact(std::vector<int>& number) const;

  // relax.cc
  void hold_pairs();
  void meet_count_in_the_end(double target);
  void optimise(double target);
  void meet_count(double target);
  RelaxReport finish();

  // relax_move.cc
  bool gather(int v, Star& star) const;
  bool settled(int v) const;
  bool move(int v);
  bool slide(int v);
  bool improve(int v);
  signed char free_color(int v) const;
  void edited(int v);
  void list_by_color();
  bool advance(int v, int now);
  void smooth(int sweeps);

  // relax_edit.cc
  template <class Test, class Key>
  std::vector<int> ordered_edges(Test test, Key key) const;
  Place place_near(Vec3 p, std::initializer_list<int> round, Vec3 facing) const;
  bool split(int h);
  int on_line(int a, int b) const;
  void insert(int h, const Place& place, Vec3 p, Vec3 facing);
  void split_long(double above, double most);
  bool collapse(int h, int gone, double worst, double longest, bool merge = false);
  bool collapse_either(int h, double worst, double longest);
  void collapse_short(double below, double least);
  void collapse_short_segments();
  void merge_corners();
  void remove_irregular();
  bool may_flip(int h) const;
  double worst_now(int h) const;
  double worst_flipped(int h) const;
  void flip(int h);
  int excess(int v) const;
  int flip_gain(int h) const;
  bool flip_is_free(int h) const;
  void flip_to_regular();
  void flip_to_shape();
  bool unravel(int h, int depth, int gained);
  void remove_dislocations(int depth);

  // relax_tips.cc
  bool reach_tips(std::vector<Tip>& tips);
  double walk_near(Vec3 p, int& t, double enough) const;
  double nearest_triangle(Vec3 p, int& t, Vec3& q) const;
  std::optional<Relaxer> reached(const Place& tip, Vec3 q, double least, double far_enough,
                                 const std::vector<int>& round) const;
  std::optional<Relaxer> gone_to(const Place& tip, double least, const std::vector<int>& round) const;

  // relax_mend.cc
  struct Trial;
  static void sort_trials(std::vector<Trial>& trials, std::size_t most);
  double quality(int t) const;
  int irregularity(int v) const;
  double badness() const;
  std::vector<int> triangles_round(int t, int rings) const;
  std::vector<int> vertices_of(const std::vector<int>& triangles) const;
  Relaxer patch(const std::vector<int>& triangles, const std::vector<int>& vertices) const;
  void settle(int times);
  double least_agreeing() const;
  double farthest() const;
  bool try_edit(const Edit& edit);
  void adopt(const Relaxer& mended, std::vector<int> triangles, std::vector<int> vertices);
  int worst() const;
  std::vector<Edit> edits_round(int t, bool wide) const;
  std::optional<Relaxer> mended(const std::vector<int>& triangles, bool thorough) const;
  bool in_vain(int t, const std::vector<int>& round, bool thorough) const;
  template <class Wanted>
  int mend_each(std::vector<int> triangles, bool thorough, Wanted wanted);
  void mend_worst();
  void separate();

  const Ground* ground_;
  LiftedMesh lifted_;
  EditMesh m_;
  RelaxOptions options_;
  RelaxReport report_;
  std::vector<Vec3> points_;
  std::vector<Vec3> facing_;   ///< the reference's normal at each vertex's place; zero on model edges
  std::vector<char> held_;     ///< per vertex: free, on a border or model edge, a corner, put on a tip, at
                               ///< the rim of a patch, or on a seam
  std::vector<double> finer_;  ///< factor on the size field, smaller where intersections asked for refinement
  std::vector<int> tried_, changed_;  ///< when a vertex was last tried to move, and when it last changed
  std::vector<int> edited_;           ///< when its neighbours last became others
  int clock_ = 0;
  std::vector<int> in_vain_[2];     ///< when mending a triangle was last in vain: as it is done, thoroughly
  bool forced_ = false;             ///< are most of the bad triangles there to stay?
  int flipped_at_ = 0;              ///< when flip_to_shape last looked
  std::vector<signed char> color_;  ///< no two joined vertices have the same; -1: none, not moved
  std::vector<int> by_color_, color_start_;
  bool listed_ = false;
  bool recording_ = false;
  std::vector<Edit> edits_;  ///< while recording
};

/// A neighbourhood changed on trial.
struct Relaxer::Trial {
  double badness;
  Relaxer state;
};

}  // namespace meshpipe
