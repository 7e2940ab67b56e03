// SPDX-License-Identifier: BSD-3-Clause
// Where sheets meet: vertices and edges that are there once for each sheet, and change together; for
// lib/relax/ only.
#pragma once
#include <utility>
#include <vector>

#include "lib/relax/state.h"

namespace meshpipe {

/// Makes border vertices at the same place copies of each other. Those where other sheets or lines meet than
/// next to them are held.
void share_vertices(State& s);

/// A vertex or half-edge, with the place on its sheet and the normal there.
struct CopyPlace {
  int at;
  Place place;
  Vec3 normal;
};

/// Returns v and its copies when v is at `place`, whose point is p; none if one of them cannot get there.
std::vector<CopyPlace> copies_at(const State& s, int v, const Place& place, Vec3 p);
/// Returns h and the half-edges of other sheets along its edge for a vertex at `place`, whose point is p;
/// none if one of them does not pass there.
std::vector<CopyPlace> places_on_edge(const State& s, int h, const Place& place, Vec3 p);
/// Puts a vertex at p on each of these half-edges, which are copies of each other.
void insert_copies(State& s, const std::vector<CopyPlace>& edges, Vec3 p);

/// Returns the half-edges along the edge of h and their ends that are copies of `gone`; none unless every
/// copy has one.
std::vector<std::pair<int, int>> with_copies(const State& s, int h, int gone);

/// Is there an edge between a and b, one of them another copy? A second one would make sheets meet along it.
bool joined_elsewhere(const State& s, int a, int b);
/// Would collapsing the edge of h into its other vertex than `gone` make such edges?
bool doubles_edges(const State& s, int h, int gone);
/// Flips or splits edges between the same vertices as one of another sheet.
void part_double_edges(State& s);

/// Sets the copies of a patch with these vertices of s. Where some are outside of it, all are frozen.
void extract_copies(const State& s, const std::vector<int>& vertices, State& patch);

}  // namespace meshpipe
