// SPDX-License-Identifier: BSD-3-Clause
// mdraw: a picture of one or several meshes, side by side.
#include "lib/core/connectivity.h"
#include "lib/core/number.h"
#include "lib/core/take_rows.h"
#include "tools/common.h"
#include "tools/report/png.h"

using namespace meshpipe;

namespace {

/// Drops the triangles beyond a plane: "y" or "y=0.3", at this share of the bounding box. Throws: BadUsage.
void clip(Surface& s, const std::string& where) {
  double share = 0.5;
  const char* end = where.data() + where.size();
  const bool given = where.size() > 2 && where[1] == '=';
  const auto [at, error] =
      given ? meshpipe::from_chars(where.data() + 2, end, share) : std::from_chars_result{end, std::errc()};
  if (where.empty() || where[0] < 'x' || where[0] > 'z' || (!given && where.size() > 1) || at != end ||
      error != std::errc())
    throw BadUsage("--clip: expected x, y or z, or as in y=0.3, found '" + where + "'");
  auto along = [&](Vec3 p) { return where[0] == 'x' ? p.x : where[0] == 'y' ? p.y : p.z; };
  double lo = 1e300, hi = -1e300;
  for (const Tri& t : s.tris)
    for (int v : t) lo = std::min(lo, along(s.points[v])), hi = std::max(hi, along(s.points[v]));
  std::vector<int> kept;
  for (int t = 0; t < (int)s.tris.size(); ++t)
    if (along(centroid(s, t)) <= lo + share * (hi - lo)) kept.push_back(t);
  for (std::size_t i = 0; i < kept.size(); ++i) s.tris[i] = s.tris[kept[i]];
  s.tris.resize(kept.size());
  take_rows(s.face, kept);
}

}  // namespace

int main(int argc, char** argv) {
  View view;
  std::string color = "plain";
  int width = 800, height = 800;
  std::vector<std::string> others;
  std::string plane;
  bool smooth = false;
  auto add_options = [&](CLI::App& app) {
    app.add_option("--color", color, "plain, part, patch or kappa (default plain)")
        ->check(CLI::IsMember({"plain", "part", "patch", "kappa"}))
        ->type_name("BY");
    app.add_option("--beside", others, "more meshes, drawn to the right at the same scale")
        ->allow_extra_args(false)
        ->type_name("FILE");
    app.add_option("--clip", plane,
                   "cut away the part beyond this share of the bounding box along x, y or z (default 0.5)")
        ->type_name("x|y|z[=SHARE]");
    app.add_option("--azimuth", view.azimuth, "azimuth of the viewer around the z axis, degrees (default 30)")
        ->check(finite_number());
    app.add_option("--elevation", view.elevation, "elevation of the viewer, degrees (default 20)")
        ->check(finite_number());
    app.add_option("--zoom", view.zoom, "magnification about the center (default 1)")
        ->check(positive_number());
    app.add_option("--right", view.shift_x, "move the center right by this share of the width")
        ->check(finite_number());
    app.add_option("--up", view.shift_y, "move the center up by this share of the width")
        ->check(finite_number());
    app.add_option("--width", width, "width of one picture in pixels (default 800)")
        ->check(CLI::Range(16, 8192));
    app.add_option("--height", height, "height in pixels (default 800)")->check(CLI::Range(16, 8192));
    app.add_flag("--no-edges", smooth, "draw no mesh lines");
  };
  Frame frame;
  auto picture = [&](const Stream& s) {
    const Mesh& mesh = s.surface;
    std::vector<Color> colors(mesh.tris.size(), Color{235, 225, 205});
    const bool labels = color == "part" || color == "patch";
    if (labels) {
      const auto& label = s.surface.face.get<int>(color);
      for (std::size_t t = 0; t < colors.size(); ++t) colors[t] = label_color(label[t]);
    } else if (color == "kappa") {
      for (std::size_t t = 0; t < colors.size(); ++t) {
        const Tri& v = mesh.tris[t];
        colors[t] = scale_color(kappa(mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]]));
      }
    }
    std::vector<std::uint8_t> strong;
    if (s.surface.face.has("model")) strong = s.surface.face.get<std::uint8_t>("model");
    return draw_mesh(mesh, colors, strong, view, frame, width, height);
  };
  auto body = [&](Io& io) {
    view.edges = !smooth;
    std::vector<Stream> meshes;
    meshes.push_back(std::move(io.read()));
    for (const std::string& path : others) meshes.push_back(io.read(path));
    for (Stream& s : meshes) {
      add_to_frame(frame, s.surface, view);
      if (!plane.empty()) clip(s.surface, plane);
    }
    std::vector<Image> images;
    for (const Stream& s : meshes) images.push_back(picture(s));
    io.write_bytes(write_png(side_by_side(images)));
  };
  return run_tool(argc, argv, "mdraw",
                  "Draw a mesh as a PNG picture; model edges are drawn thick. Needs no display.\n\n"
                  "Example:\n  mdraw tree.stl -o tree.png",
                  add_options, body, {.writes = ".png"});
}
