// SPDX-License-Identifier: BSD-3-Clause
// Where sheets meet: vertices and edges once per sheet, which change together; for lib/relax/ only.
#pragma once
#include <utility>
#include <vector>

#include "lib/relax/state.h"

namespace meshpipe {

/// Makes border vertices with the same coordinates copies of each other (State::copy). Copies are held where
/// not all of them slide between the same two neighbors.
void share_vertices(State& s);

/// A vertex or a half-edge (`at`), with a place on its sheet and the normal there.
struct CopyPlace {
  int at;
  Place place;
  Vec3 normal;
};

/// Returns v at `place`, whose point is p, and its copies at that point; none if one cannot get there.
std::vector<CopyPlace> copies_at(const State& s, int v, const Place& place, Vec3 p);
/// Returns h at `place`, whose point is p, and the half-edges of other sheets along its edge at the same
/// point; none if one of them does not pass there.
std::vector<CopyPlace> places_on_edge(const State& s, int h, const Place& place, Vec3 p);
/// Puts a vertex at p on each of these half-edges; the new vertices are copies of each other.
void insert_copies(State& s, const std::vector<CopyPlace>& edges, Vec3 p);

/// Returns half-edges along the edge of h with the end that is a copy of `gone`; none if a copy has none.
std::vector<std::pair<int, int>> with_copies(const State& s, int h, int gone);

/// Returns whether an edge joins other copies of a and b: then sheets would meet along an edge from a to b.
bool joined_elsewhere(const State& s, int a, int b);
/// Returns whether collapsing the edge of h, which takes out its vertex `gone`, would make such edges.
bool doubles_edges(const State& s, int h, int gone);
/// Flips or splits inside edges that join the same places as an edge of another sheet.
void part_double_edges(State& s);

/// Sets the copies in a patch of these triangles, whose vertices are these vertices of s (ascending). Where
/// some copies are outside of the patch, or triangles at an edge between copies are, all are frozen.
void extract_copies(const State& s, const std::vector<int>& triangles, const std::vector<int>& vertices,
                    State& patch);

}  // namespace meshpipe
