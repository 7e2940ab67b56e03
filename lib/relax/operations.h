// SPDX-License-Identifier: BSD-3-Clause
// The operations of the optimization: split, collapse, flip and move; for lib/relax/ only. Each keeps the
// mesh a manifold on its reference, with its borders and model edges, and unfolded.
#pragma once
#include "lib/relax/state.h"

namespace meshpipe {

// --- split.cc ---

/// Splits the edge of h at the place on the reference nearest to its point `at` (a fraction from its origin);
/// a border or model edge at a place on its line, with the edges of other sheets along it. Returns false, and
/// changes nothing, if the place is too far from the edge, the edge may not be split, or pieces would fold
/// and `may_fold` is false.
bool split_edge(State& s, int h, double at = 0.5, bool may_fold = false);
/// Puts a new vertex at p, the point of `place`, on the edge of h, without looking at the triangles.
void insert_vertex(State& s, int h, const Place& place, Vec3 p, Vec3 normal);
/// Returns an end of the edge a-b of a line that slides, and so knows its line; -1 if both are corners.
int end_on_line(const State& s, int a, int b);
/// Splits inside edges longer than `above` sizes, the longest first, while triangles are fewer than `most`.
void split_long(State& s, double above, double most);

/// Returns whether an edge from the origin of half-edge `spoke` to q would be a chord; see lib/core/chord.h.
bool starts_chord(const State& s, int spoke, Vec3 q);
/// Flips or splits chords next to which a vertex is loose, until there are none that can be.
void split_chords(State& s);

// --- collapse.cc ---

/// Collapses the edge of h: takes its vertex `gone` out, into the other end, which moves to the middle if it
/// is loose. Returns false, and changes nothing, if the star would fold or exceed `limits` (unless it did
/// before) or the vertex is held. A vertex on a line goes only along it, if the line hardly changes, and with
/// its copies. With `merge`, `gone` is a corner that goes into another.
bool collapse_edge(State& s, int h, int gone, const rules::Collapse& limits, bool merge = false);
/// Collapses the edge of h, takes its vertex `gone` out, without looking at the triangles.
void remove_vertex(State& s, int h, int gone);
/// Collapses inside edges below `below` sizes, the shortest first, down to `least` triangles.
void collapse_short(State& s, double below, double least);
/// Collapses segments of borders and model edges shorter than 0.6 of the size. Where the border is kept,
/// collapses every border segment that can be: only vertices that the input does not have can go.
void collapse_short_segments(State& s);
/// Merges corners joined by a line's edge shorter than 0.05 of the size: no good triangle fits between them.
void merge_corners(State& s);
/// Takes vertices out around peaks of less than 9 degrees until the ring is wide enough for good triangles:
/// one fan of needles is forced there. Sets the sizes at the peaks.
void open_peaks(State& s);
/// Collapses loose inside vertices of valence 3 and 4.
void remove_irregular(State& s);

// --- flip.cc ---

/// Returns whether h may be flipped: not if a triangle folds, the surface bends more or a chord appears.
bool may_flip(const State& s, int h);
void flip_edge(State& s, int h);
/// Returns the number of neighbors that v has beyond the regular one: 6 inside, 4 on a border.
int excess(const State& s, int v);
/// Flips edges where that brings valences nearer to the regular ones and leaves triangles of sound shape.
void flip_to_regular(State& s);
/// Flips edges where that makes the worse of two triangles better; only where something changed since last.
void flip_to_shape(State& s);
/// Removes pairs of dislocations of the triangular lattice that are up to `depth` flips apart. A dislocation
/// is a pair of vertices of valence 5 and 7: a flip moves it one step along its glide line at no cost in
/// valence, and two opposite ones that meet annihilate.
void remove_dislocations(State& s, int depth);

// --- move.cc ---

/// Moves a loose vertex by a Newton step on the energy of its star in the tangent plane, from where it walks
/// to the reference. Returns false, and moves nothing, if the energy does not fall.
bool move_vertex(State& s, int v);
/// Slides a vertex and its copies along their border or model edge to the minimum of a parabola through three
/// energies. Returns false if nothing moves.
bool slide_vertex(State& s, int v);
/// Moves or slides v unless it is held or nothing around it has changed. Returns whether it moved.
bool improve_vertex(State& s, int v);
/// Moves every vertex once per sweep, block by block; the same result at any number of threads.
void smooth(State& s, int sweeps);

}  // namespace meshpipe
