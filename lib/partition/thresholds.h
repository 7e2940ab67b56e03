// SPDX-License-Identifier: BSD-3-Clause
// Every limit by which the planner decides to cut: what it is, why, and what it does on 40 surfaces (34 real
// ones, CAD, scans and segmentations, and 6 generated ones, with 2200 maps in all).
#pragma once
#include <cstddef>

namespace meshpipe::limit {

// Of a surface, before any map is known.

/// Triangles of a component above which its parts are bounded, and that bound: solves stay near linear, and
/// there is work for all threads. Effect: none below 300000 triangles.
constexpr int large_component = 300000, faces_of_large = 50000;
/// Cuts within cuts of one part, after which it counts as one that does not get shorter. Effect: 4 levels
/// are the most, on 2 surfaces.
constexpr int cut_depth = 12;
/// Fraction of an edge within which a cut is moved to the edge's end: no slivers.
constexpr double snap = 0.1;

// Of labelings, before the best is chosen.

/// Share of a component's area below which a part goes to a neighbor, and its triangles; both fall with each
/// round, so that a part no neighbor can take becomes one of its own.
constexpr double fragment = 0.01;
constexpr int fragment_triangles = 20;
/// Aspect ratio (Region::aspect) above which a part counts as two: eta_max of the paper's eq. (5).
constexpr double aspect = 4;

// Of a map, when its part is cut again.

/// Area scale (p99 / p1) above which a part is cut along its limbs: a limb that shrinks so much does so by a
/// factor over every few elements, and loses its shape. Effect: 51 maps on 10 surfaces.
constexpr double area_scale = 1e8;
/// Area scale above which a part is cut by any line: edges of 1e-8 of the chart keep half their digits.
/// Effect: with the next one, 58 cuts on 4 surfaces.
constexpr double unresolved_area_scale = 1e16;
/// Mean of sigma1/sigma2 over the area above which a part is cut: coarse tubes and rings of CAD, which have
/// nothing between their ends to follow a ring in the plane, lie flat once they are open. Effect: 92 maps on
/// 5 surfaces.
constexpr double mean_anisotropy = 4;
constexpr double anisotropy = 100;  ///< the 99th percentile of sigma1/sigma2, above which a part is cut
constexpr std::size_t least_triangles = 50;  ///< below it no part is cut for the mean of sigma1/sigma2
/// Parts that one cut along limbs may end in: a ragged part keeps its aspect ratio through many cuts. Effect:
/// 80 of 121 cuts are given up, on 4 surfaces.
constexpr int limb_parts = 4;

// Rounds of mapping and cutting, after which a kind of cut is no longer tried.

constexpr int limb_rounds = 2;        ///< cuts along limbs; then halves come before pairs of places
constexpr int stretched_rounds = 12;  ///< cuts for the mean of sigma1/sigma2; 10 of 228 surfaces get there
constexpr int most_rounds = 24;       ///< cuts of any kind; 13 rounds are the most

}  // namespace meshpipe::limit
