// SPDX-License-Identifier: BSD-3-Clause
// The thresholds of the optimization, in one table; for lib/relax/ only. Lengths are in units of the size
// field, shapes are shape energies (state.h: 1 is equilateral, 4 has kappa 0.6 or so), cosines compare
// normals.
#pragma once
#include <numbers>

namespace meshpipe::rules {

/// Limits of a collapse: the shape energy and the edge length, in sizes, that it may leave; may it fold?
struct Collapse {
  double shape, length;
  bool may_fold = false;
};

// normals
constexpr double least_cosine = 0.5;   // of normal and reference normal: a triangle with less is folded
constexpr double same_cosine = 1e-12;  // cosines that differ by less are rounding errors

// moves (move.cc)
constexpr double size_weight = 0.012;    // area against shape: equal areas without giving up equal angles
constexpr double strip_weight = 0.5;     // of 1/kappa^2 on lines: it decides where they are nearer than 0.15
constexpr double shortest_step = 3e-3;   // length: shorter steps do not show, and would keep neighbors awake
constexpr double overrelaxation = 1.6;   // factor: errors over many edges even out in fewer sweeps
constexpr double line_relaxation = 1.3;  // factor: the same along a line, where a parabola is less exact
constexpr double longest_step = 0.5;     // length: beyond it the star is another
constexpr int halvings = 3;              // tries: a step that does not help at a quarter will not
constexpr double flat = 1e-3;  // area over the target's: below it Newton's model of a triangle is wrong
constexpr double longest_segment = 1.2;  // length: a longer segment of a line cuts its bends,
constexpr double straight = 0.02;        // length: unless its middle is this near to the line
constexpr double probe = 0.1,
                 reach = 0.4;        // of the shorter segment: where a slide looks, and the farthest it goes
constexpr double least_gain = 1e-4;  // of the energy: what a slide must gain
constexpr int largest_star = 32;     // triangles: stars are arrays of this length; larger ones stay
constexpr int block_bits = 9;  // vertices moved at a time, with all around them, are 2^this: they fit a cache
constexpr int level_bits = 3;  // by which the blocks of those left grow
constexpr int vertices_worth_threads = 800;  // below it starting threads takes longer than moving

// splits and collapses (split.cc, collapse.cc)
constexpr double split_above = 1.4,
                 collapse_below = 0.65;  // length: sqrt(2) and its inverse, with hysteresis
constexpr double stretch_above = 1.05, squeeze_below = 0.95;  // length: edges that may go to meet a count
constexpr double count_tolerance = 0.005;                     // of the triangles: what sweeps keep
constexpr double off_edge = 0.5,
                 off_line = 0.3;         // of the edge: a new vertex farther away is on another sheet
constexpr double same_side = 0.3;        // cosine: sides of a model edge that differ by less are one
constexpr double short_segment = 0.6;    // length: segments that an interface left next to a corner
constexpr double merged_corners = 0.05;  // length: no good triangle between corners this close
constexpr double line_deviation = 0.1;   // length: what a line may change by a collapse, or sag after a slide
constexpr double junction_segment = 1.3;  // length: below it one segment is nearer to the size than two
constexpr int largest_valence = 9;        // of a vertex that a collapse leaves
constexpr Collapse short_edge{4, 1.4}, short_line{4, 1.6}, irregular{4, 1.6};
constexpr Collapse near_corners{1e9, 1.6};  // needles between three of them go with the last one only
constexpr Collapse into_peak{1e9, 1e9};     // the ring around it is narrower than a triangle
constexpr Collapse kept_border{2000, 3};    // almost anything, to have no new vertex on it
constexpr Collapse on_trial{1e9, 2};        // the objective judges
constexpr Collapse at_fault{1e9, 8, true};  // the same: a needle at a corner may take in those next to it
constexpr double sharp_peak = 9 * std::numbers::pi / 180;  // radians around: needles there are forced
constexpr double around_peak = 3.5;  // sizes of the ring: between three triangles and four
constexpr double same_place = 1e-6;  // length: copies of a vertex this close are at the same place
constexpr double open_seam = 1e-3;   // length: borders this close are two sides of a seam

// flips (flip.cc)
constexpr double sound_for_valence = 3;          // shape: what a flip for the valence may leave
constexpr double shape_gain = 0.9;               // of the worse shape: smaller gains go back and forth
constexpr double along_plane = 1e-3;             // sine: an edge at this angle to a triangle lies on it
constexpr double bend = 0.9;                     // cosine: 26 degrees across the new edge are always allowed
constexpr int half_edges_worth_threads = 30000;  // below it starting threads takes longer than a look at them
constexpr double sound_for_smoothing = 4;        // shape: smoothing repairs better ones
constexpr int dislocation_depth = 3;  // flips: each one more multiplies the search by the edges around

// repair (patch.cc, repair.cc)
constexpr double good_kappa = 0.75;  // triangles below it are repaired; mcheck asks for 0.1
constexpr double good_angle = 35 * 3.14159265358979323846 / 180;   // radians: the same
constexpr double acute_angle = 86 * 3.14159265358979323846 / 180;  // radians: the largest inside
constexpr double margin = 1.05;                    // of the quality: no triangle is improved beyond it
constexpr double tangent_with_margin = 0.747;      // of margin * good_angle
constexpr double cotangent_with_margin = 0.153;    // of pi - margin * (pi - acute_angle)
constexpr double needle = 0.05;                    // of the quality: one needle counts more than two slivers
constexpr double irregular_vertex = 1e-3;          // of the objective: a tie-break
constexpr double gain_share = 0.1, gain = 0.05;    // of the objective: the smaller of both is worth a change
constexpr int promising = 8, promising_pairs = 5;  // trials that go on, of about 100
constexpr double promising_at_once = 0.3;          // of the trials go on after a sweep
constexpr double sharp_turn = 0.5;  // radians, between model edges: a needle unless both are as long
constexpr double releases[] = {0.25, 0.5, 1};  // of a step of smoothing: what anchored vertices move; 1: free
constexpr double few_bad = 0.005;     // of the triangles: smooth surfaces have at most a half, others double
constexpr double least_piece = 0.02;  // of a segment: shorter pieces are needles themselves
constexpr int rings = 2, thorough_rings = 3;  // of triangles in a patch
constexpr int largest_patch = 400;  // triangles: trials grow with its square; without large fans it has 100
constexpr int sweeps_to_settle = 3;
constexpr double repair_growth = 1.1;  // of the triangles: what repair of shapes may add to a count asked for
constexpr int repair_rounds = 4;
constexpr int repairs = 200, triangles_per_repair = 100;             // beyond the sum, sizes are at fault
constexpr int thorough_repairs = 30, triangles_per_thorough = 1000;  // of pairs of edits, until as many fail
constexpr int hopeless = 100;  // triangles: of more bad ones it is seen whether rounds help
constexpr double forced_share = 0.8, same_share = 0.98;  // of the bad ones are left: lines force them

// faults (faults.cc)
constexpr double parallel = 0.8;        // cosine: no edge between normals this close sags by `too_far`
constexpr double too_far = 0.475;       // of the size; a half is the limit of mcheck
constexpr double within_limit = 0.495;  // of the size: mcheck accepts less, with any rounding
constexpr double own_sheet = 2;         // of the distance: where the mesh of a missed place's sheet is sought
constexpr double as_near = 1e-6;        // of a distance: rounding errors
constexpr double long_side = 1.5;   // of the mean size: shorter triangles are looked at where the mesh bends
constexpr double same_mean = 0.99;  // of the mean size: if it is less, looks at distances begin again
constexpr double doubtful = 0.4;    // of the bearable, walked to: from there all of a triangle is searched
constexpr double needed_kappa = 0.1, failing_kappa = 0.11;  // the limit of mcheck, and a margin over it
constexpr double bearable_kappa = 0.25, worst_needle = 10;  // kappa, and what a needle adds at most
constexpr double sharp_half = 0.34;  // sine of 20 degrees: wider corners have room for good triangles
constexpr double leaning = 0.85;     // of the isosceles triangle's kappa: what leaning ones have
constexpr double refinement = 0.8;   // of the size, each round
constexpr double pair_excess =
    2;  // of a pair or fold; by counts alone, 2 pairs and 100 needles beat 10 pairs
constexpr double less_excess = 0.99;       // of that and the sum of distances over the bearable: a gain
constexpr double stale_share = 0.1;        // of the triangles: more that are new are worth a new search tree
constexpr double growth = 1.6, few = 300;  // of the triangles, and triangles: what removal of faults may add
constexpr double much_worse = 2;  // than the best seen: what is wrong does not go away at smaller sizes
constexpr int fault_rounds = 24, useless_rounds = 3;
constexpr double worth_a_turn = 0.7;  // of the sum: what a turn has to leave at most for another
constexpr double nearly_accepted =
    30;                         // sum of faults: with more, neither another turn nor other limits help
constexpr int few_pairs = 50;   // of more, the reference very likely has contacts near some
constexpr int many_pairs = 30;  // of more single edits are tried first: they take less time
constexpr int fault_repairs = 10, few_faults = 300;  // rounds; places: more take too long
// of 435 runs, those that left no fault began with a sum of 688 at most, and had 167 at most after refinement
constexpr double most_sum = 1000, most_sum_share = 0.01;  // and of the triangles: of more none is removed
constexpr double most_repaired = 250;                     // after refinement: of more none is repaired
constexpr double reduced_at_pair = 0.35,
                 reduced_at_needle = 0.3;     // of the size, where the mesh is begun again
constexpr double reduced_at_distance = 0.27;  // over the distance in sizes: the same, well within a half,
constexpr double least_reduced = 0.25, most_reduced = 0.6;  // within these bounds
constexpr double reduced_gradation = 0.5;                   // growth of the size per length away from there
constexpr double reduced_growth = 0.5;                      // of the triangles: what smaller sizes may add
constexpr double most_left = 80;  // sum of faults: of 77 begun again none with over 78 became good
constexpr double halved = 0.5;    // of the sum: starts after one that leaves more have all been in vain
constexpr int most_restarts = 3;  // each takes as long as the first time
constexpr double far_weight = 10, pair_weight = 5;  // of the objective
constexpr double reach_of_patch = 0.3;  // mean sizes: how far from it a change of a patch may meet others
constexpr int most_around = 300;        // triangles: more of them would take longer than the patch
constexpr double length_share = 0.5;    // of a pair's weight: by how far it intersects, up to the mean size

// bends (bends.cc)
constexpr double near_bend = 0.6;   // of the longest edge: how far a vertex goes to where the reference bends
constexpr double same_bend = 0.05;  // of it: places that differ by less are tried once
constexpr double end_of_edge = 0.1;  // of an edge: nearer to an end there is no room for another vertex
constexpr int bends_tried = 5;       // for a vertex or an edge, the nearest
constexpr int faces_of_bends = 300;  // of the reference are looked at around a triangle
constexpr int steps_to_passing = 5;  // of projections from one segment on the other

// missed features (missed_features.cc)
constexpr double bent = 10 * std::numbers::pi / 180;  // from there on edges have samples
constexpr double samples_per_edge = 3;                // of the mesh: one is half way at most
constexpr double samples_per_flat_edge = 0.5;         // none on edges up to twice as long
constexpr double most_samples = 50;                   // of an edge
constexpr int guess_rounds = 4;         // sweeps over the reference, to guess which triangles are near
constexpr double missed = 0.1;          // length: the distance from which features are reached
constexpr double farthest_share = 0.7;  // of the largest distance: those are reached first
constexpr double larger_size = 1.2;     // over the mean: from here the distance is seen against it
constexpr double retry = 1.2;           // of the wanted distance: from where half way is worth it
constexpr double along_border = 0.1;    // of the distance: a sample that slides less is on no border
constexpr int features = 4, triangles_per_feature = 800;  // the larger: more cost the mesh its regularity
constexpr double spoils = 1.8e-3;        // of the objective: one triangle with 0.9 of the quality wanted
constexpr double spoils_farther = 5;     // of `missed`: up to where distance excuses more
constexpr double spoils_if_lost = 3;     // of the objective: five triangles of kappa 0.3
constexpr int tries_per_feature = 20;    // places tried for each that may be reached; real surfaces take 8
constexpr int places_per_feature = 100;  // looked at; coarse meshes of assemblies miss thousands for good
constexpr int promising_features = 3;    // trials that go on, of 6
constexpr double reached = 1e-6;         // length

// schedule (relax.cc)
constexpr int coarse_rounds = 3;    // of splits and collapses before the first sweep
constexpr int feature_rounds = 5;   // what is repaired misses features, what reaches them needs repair
constexpr double goal_range = 0.6;  // of the count: sizes are not scaled beyond
constexpr double spoilt = 0.7;      // of the first try's worst quality: what another may come to
constexpr double count_first = 0.025,
                 count_aimed = 0.015;   // of the count: good enough at once, and when aimed
constexpr double least_response = 0.2;  // triangles gone per triangle less asked for
constexpr int tries = 3, sweeps_to_count = 3;

// tiles (tiles.cc, relax.cc)
constexpr int seam_rings = 6;   // of triangles that seams are optimized with: farther away all is as it was
constexpr int seam_rounds = 3;  // seams, and seams of seams, until they are not split
constexpr double around_tile = 2;       // edges: walks from vertices inside of a tile end in their stars
constexpr double around_seams = 8;      // edges: what the tiles of seams change is nearer to other tiles
constexpr int intersection_rounds = 2;  // of repair where tiles intersect each other
constexpr int intersection_rings = 12;  // of triangles around

}  // namespace meshpipe::rules
