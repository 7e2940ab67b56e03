// SPDX-License-Identifier: BSD-3-Clause
// Test surfaces from formulas and from implicit functions, and what spoils them.
#pragma once
#include <functional>
#include <string>

#include "lib/mesh.h"

namespace meshpipe {

/// Tube of diameter 1 along z and height `aspect`, n vertices round; `closed` caps both ends by flat disks.
Mesh tube(double aspect, int n, bool closed);
/// Sphere of radius 1: an icosahedron whose faces are split into k^2 each, at least n triangles.
Mesh sphere(int n);
/// Torus of radii 1 and r, about n triangles.
Mesh torus(double r, int n);

/// A body made of faces: patch[t] indexes names.
struct Body : Mesh {
  std::vector<int> patch;
  std::vector<std::string> names;
};
/// Unit cube, a patch a side, about n triangles.
Body cube(int n);
/// A closed CAD-like body the way STL exporters triangulate it: a plate of columns x rows square cells, each
/// with a drilled hole or a bored boss in turn; full-length slivers on the cylinders, fans round the holes
/// and on the caps. Its genus is columns * rows. `segments` chords a circle.
Body cad_body(int columns, int rows, int segments);

/// A function of space that is negative inside a body, and changes by at most 1 per unit length.
using Implicit = std::function<double(Vec3)>;
/// Zero level of f on a cubic grid of n cells along the longest side of the box lo..hi, by marching
/// tetrahedra (six a cell): closed, oriented outward, manifold, never with two crossings close to one grid
/// point. Blocks of cells that f shows to be off the surface are skipped, and only two slices of the grid are
/// kept. Precondition: f > 0 on the box's faces.
Mesh march(const Implicit& f, Vec3 lo, Vec3 hi, int n);
/// Moves the vertices towards the middle of their neighbours and back to the zero level of f, `rounds` times;
/// those of the border slide along it in its plane.
void relax_on(Mesh& mesh, const Implicit& f, int rounds);

/// Smooth surface of genus g, a rounded plate with g round holes, about n triangles.
Mesh genus_surface(int g, int n);
/// A branching tree of tubes along z with an inlet of diameter 1: `generations` bifurcations, or as many as
/// `outlets` ends (the inlet counts) ask for when that is not 0; a child's radius is `ratio` times its
/// parent's. Its ends are cut flat and open. About n triangles. `aspect`: the branches are as long as gives
/// the tree about the area of a tube of that length and diameter 1; 0: 5.5 times their radius. Throws
/// GoalMissed if tubes touch.
Mesh branching_tree(int generations, int outlets, double ratio, int n, int seed, double aspect = 0);

/// Moves every vertex by a random vector of length up to amount times the mean edge length.
void add_noise(Mesh& mesh, double amount, int seed);
/// Splits a fraction of the edges close to one end, which leaves triangles with angles of about a degree.
/// Face columns follow.
void add_slivers(Surface& surface, double fraction, int seed);
/// Adds what files in the wild hold, each in about fraction times the number of triangles: duplicate and
/// degenerate triangles, flipped ones, vertices nobody uses, unwelded copies of vertices. Face columns
/// follow.
void add_dirt(Surface& surface, double fraction, int seed);

}  // namespace meshpipe
