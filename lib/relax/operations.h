// SPDX-License-Identifier: BSD-3-Clause
// The operations of the optimization: split, collapse, flip and move; for lib/relax/ only. Each keeps the
// mesh a manifold on its reference, with its borders and model edges, and unfolded.
#pragma once
#include "lib/relax/state.h"

namespace meshpipe {

// --- split.cc ---

/// Splits the edge of h at the place on the reference nearest to its point `at` (0 to 1 from where h starts);
/// a border or model edge at a place on the line, and the edges of other sheets there alike. False if the
/// pieces would fold, unless they may.
bool split_edge(State& s, int h, double at = 0.5, bool may_fold = false);
/// Puts a new vertex on the edge of h, without a look at the triangles.
void insert_vertex(State& s, int h, const Place& place, Vec3 p, Vec3 normal);
/// The end of a line's edge that is no corner, so that it knows which line; -1 if both are.
int end_on_line(const State& s, int a, int b);
/// Splits edges longer than `above` times the size, the longest first, while there are fewer triangles than
/// `most`.
void split_long(State& s, double above, double most);

/// Would an edge from the origin of half-edge `spoke` to q be a chord? See lib/core/chord.h.
bool starts_chord(const State& s, int spoke, Vec3 q);
/// Splits chords, where a vertex next to them is loose.
void split_chords(State& s);

// --- collapse.cc ---

/// Takes the vertex `gone` of the edge of h out, into the edge's other end, or into the middle if that end is
/// loose. False if the star would fold or leave `limits` (unless it did before). A vertex on a line goes only
/// along it, if the line hardly changes, and with its copies. With `merge`, `gone` is a corner that goes into
/// another.
bool collapse_edge(State& s, int h, int gone, const rules::Collapse& limits, bool merge = false);
/// Takes the vertex `gone` out without a look at the triangles.
void remove_vertex(State& s, int h, int gone);
/// Collapses edges shorter than `below` times the size, the shortest first, while there are more triangles
/// than `least`.
void collapse_short(State& s, double below, double least);
/// Collapses segments of borders and model edges much shorter than the size. Of a border to be kept, every
/// segment with a vertex that the input does not have.
void collapse_short_segments(State& s);
/// Merges corners joined by a line that are too close for a good triangle between them.
void merge_corners(State& s);
/// Collapses inside vertices of valence 3 and 4.
void remove_irregular(State& s);

// --- flip.cc ---

/// May the edge of h be flipped? Not if that folds a triangle, bends the surface more or makes a chord.
bool may_flip(const State& s, int h);
void flip_edge(State& s, int h);
/// Neighbors that v has beyond the regular number: 6 inside, 4 on a border.
int excess(const State& s, int v);
/// Flips that bring valences nearer to the regular ones and leave triangles of sound shape.
void flip_to_regular(State& s);
/// Flips that make the worse of two triangles better, where something changed since the last time.
void flip_to_shape(State& s);
/// Removes pairs of dislocations of the triangular lattice that are up to `depth` flips apart. A dislocation
/// is a pair of vertices of valence 5 and 7: a flip moves it one step along its glide line at no cost in
/// valence, and two opposite ones that meet annihilate.
void remove_dislocations(State& s, int depth);

// --- move.cc ---

/// Moves a loose vertex by a Newton step on the energy of its star along the tangent plane, walked to on the
/// reference; kept if the energy falls. False if it stays.
bool move_vertex(State& s, int v);
/// Slides a vertex and its copies along their border or model edge to the minimum of a parabola through three
/// energies.
bool slide_vertex(State& s, int v);
/// Moves or slides v unless it is held or nothing around it has changed since the last try.
bool improve_vertex(State& s, int v);
/// Moves every vertex once a sweep, block by block; the same result with any number of threads.
void smooth(State& s, int sweeps);

}  // namespace meshpipe
