// SPDX-License-Identifier: BSD-3-Clause
// Test surfaces from formulas and from implicit functions, and typical faults of files.
#pragma once
#include <array>
#include <functional>
#include <string>

#include "lib/core/mesh.h"

namespace meshpipe {

/// Makes a tube of diameter 1 from z = 0 to `aspect`, n >= 3 vertices around; `closed`: by flat disks.
Mesh tube(double aspect, int n, bool closed);
/// Makes a sphere of radius 1: an icosahedron whose faces are split into k^2 each, at least n triangles.
Mesh sphere(int n);
/// Makes a torus of radii 1 and r, about n triangles.
Mesh torus(double r, int n);

/// A body made of faces: patch[t] is an index of `names`.
struct Body : Mesh {
  std::vector<int> patch;
  std::vector<std::string> names;
};
/// Makes the unit cube, one patch per side, about n triangles.
Body cube(int n);
/// Makes a closed CAD-like body as STL exporters triangulate it: a plate of columns x rows squares, in turn
/// with a drilled hole or a bored boss; full-length slivers on the cylinders, fans around the holes and on
/// the caps. Its genus is columns * rows; circles have `segments` chords.
Body cad_body(int columns, int rows, int segments);

/// A function of space that is negative inside a body, with a gradient of at most 1.
using Implicit = std::function<double(Vec3)>;
/// Returns the zero level of f on a grid of n cubes along the longest side of the box lo..hi, by marching
/// tetrahedra (six per cube): closed, oriented outward, manifold. Skips blocks that f shows to be off the
/// surface, and stores two slices of the grid. Requires: f > 0 on the box's faces. Throws: GoalMissed with
/// the number of cubes if they are too many.
Mesh march(const Implicit& f, Vec3 lo, Vec3 hi, int n);
/// Moves the vertices towards the middle of their neighbors and back to the zero level of f, `rounds` times;
/// those of the border slide along it in its plane.
void relax_on(Mesh& mesh, const Implicit& f, int rounds);

/// Makes a smooth surface of genus g: a plate with g circular holes, its edges rounded, about n triangles.
Mesh genus_surface(int g, int n);
/// Makes a branching tree of tubes along z with an inlet of diameter 1 and open ends, about n triangles.
/// `generations`: bifurcations up to each outlet; `outlets`: number of ends, if not 0; `ratio`: a child's
/// radius over its parent's; `aspect`: the length over the diameter of a tube of the same area, 0: branches
/// are 5.5 radii long. Throws: GoalMissed if tubes touch, their radii differ too much for one grid, or
/// triangles intersect.
Mesh branching_tree(int generations, int outlets, double ratio, int n, int seed, double aspect = 0);

/// Returns the faces between voxels of side h whose center is inside the mesh and those outside, two
/// triangles each. Border loops are closed first, towards their centers. Edges and vertices where voxels
/// touch diagonally are not manifold. Throws: GoalMissed with the number of voxels if there are too many, or
/// if none is inside.
Mesh voxels(Mesh mesh, double h);
/// Makes count[0] x count[1] x count[2] unit cubes, each face between them once, about n triangles.
Mesh brick(std::array<int, 3> count, int n);
/// Makes spheres around one center, of radii 1/count, 2/count ... 1, about n triangles.
Mesh nested_spheres(int count, int n);
/// Makes the Voronoi diagram of seeds in the unit cube, spread by Lloyd's method, about n triangles; with
/// `ball`, in a polyhedron of up to 1000 facets around the unit ball.
Mesh voronoi(int seeds, bool ball, int n, int seed);
/// Makes a Voronoi diagram in the unit cube, or with `ball` the unit ball, as a labeled image shows it:
/// smoothed surface nets, or with `blocks` the sides of voxels. About n triangles.
Mesh labeled_image(int seeds, bool ball, bool blocks, int n, int seed);

/// Moves every vertex by a random vector no longer than `amount` times the mean edge length.
void add_noise(Mesh& mesh, double amount, int seed);
/// Splits a fraction of the edges close to an end: angles of about a degree. Face columns follow.
void add_slivers(Surface& surface, double fraction, int seed);
/// Adds faults of files in the wild, each to about `fraction` of the triangles: duplicate, degenerate and
/// inconsistently oriented triangles, unused vertices, unwelded copies of vertices. Face columns follow.
void add_dirt(Surface& surface, double fraction, int seed);

}  // namespace meshpipe
