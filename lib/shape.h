// SPDX-License-Identifier: BSD-3-Clause
// Test surfaces from formulas and from implicit functions.
#pragma once
#include <functional>
#include <string>

#include "lib/mesh.h"

namespace meshpipe {

/// Tube of diameter 1 along z and height `aspect`, n vertices round; `closed` caps both ends by flat disks.
Mesh tube(double aspect, int n, bool closed);
/// Sphere of radius 1 by subdivision of an icosahedron, at least n triangles.
Mesh sphere(int n);
/// Torus of radii 1 and r, about n triangles.
Mesh torus(double r, int n);
/// Unit cube with its six faces labelled in `patch`, about n triangles.
Mesh cube(int n, std::vector<int>& patch);
/// A closed CAD-like body (plate with bosses and drilled holes) the way STL exporters triangulate it: full-length slivers on
/// its cylinders, fans on its caps; `patch` labels its faces.
Mesh cad_body(std::vector<int>& patch);

/// Zero level of f (negative inside) on a cubic grid of about n^3 cells over the box lo..hi, by marching tetrahedra or a
/// table-free dual method; closed, oriented outward, manifold. Precondition: f > 0 on the box's faces.
Mesh march(const std::function<double(Vec3)>& f, Vec3 lo, Vec3 hi, int n);

/// Surface of genus g: a plate with g holes.
Mesh genus_surface(int g, int n);
/// A branching tree of tubes of `generations` bifurcations (outlets = 2^generations + 1 with the inlet, or exactly `outlets`
/// when given), child radius = ratio times the parent's; its ends are cut flat and open.
Mesh branching_tree(int generations, int outlets, double ratio, int n, int seed);

/// Moves every vertex by a uniform random vector of length up to amount times the mean edge length.
void add_noise(Mesh& mesh, double amount, int seed);
/// Splits a fraction of the edges close to one end, which leaves triangles with angles of about a degree.
void add_slivers(Mesh& mesh, double fraction, int seed);
/// Adds what files in the wild hold: duplicate and degenerate triangles, flipped ones, unreferenced vertices, unwelded copies.
void add_dirt(Mesh& mesh, double fraction, int seed);

}  // namespace meshpipe
