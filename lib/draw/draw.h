// SPDX-License-Identifier: BSD-3-Clause
// A picture of a mesh, without a display: orthographic view, z-buffer, shading and mesh lines, smoothed by
// supersampling.
#pragma once
#include <array>
#include <cstdint>

#include "lib/core/mesh.h"

namespace meshpipe {

using Color = std::array<std::uint8_t, 3>;

/// A picture: rows from the top, three bytes per pixel.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

struct View {
  double azimuth = 30, elevation = 20;  ///< degrees; z is up
  double zoom = 1;                      ///< about the center of the picture
  double shift_x = 0, shift_y = 0;      ///< of the center, in units of the fitted picture's width
  bool edges = true;                    ///< draw the mesh lines
};

/// A rectangle of the plane that the viewer sees.
struct Frame {
  double left = 1e300, low = 1e300, right = -1e300, high = -1e300;
};
/// Widens a frame so that it holds a mesh.
void add_to_frame(Frame& frame, const Mesh& mesh, const View& view);

/// Draws a mesh with `frame` fitted into width x height pixels. `color`: per triangle; `strong`: per
/// triangle, bit i for the edge from corner i to i+1, edges drawn thick; or empty. Backs are gray and darker,
/// so that inverted triangles show.
Image draw_mesh(const Mesh& mesh, const std::vector<Color>& color, const std::vector<std::uint8_t>& strong,
                const View& view, const Frame& frame, int width, int height);

/// Joins pictures side by side, from the top.
Image side_by_side(const std::vector<Image>& images);

/// Returns a distinct, light color for a label.
Color label_color(int label);
/// Returns the color of a value in [0, 1] on the scale Viridis: dark blue (0) over green to yellow (1).
Color scale_color(double value);

}  // namespace meshpipe
