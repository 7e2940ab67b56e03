// SPDX-License-Identifier: BSD-3-Clause
#include "lib/draw/draw.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace meshpipe {
namespace {

constexpr int samples = 3;  // a pixel is the mean of samples x samples

/// Coordinates seen by the viewer: x to the right, y up, z towards the viewer.
Vec3 seen(Vec3 p, const View& v) {
  const double a = v.azimuth * std::numbers::pi / 180, e = v.elevation * std::numbers::pi / 180;
  const Vec3 right{-std::sin(a), std::cos(a), 0};
  const Vec3 back{std::cos(a) * std::cos(e), std::sin(a) * std::cos(e), std::sin(e)};
  return {dot(p, right), dot(p, cross(back, right)), dot(p, back)};
}

/// Returns the picture whose pixels are the means of samples x samples of `fine`.
Image shrunk(const std::vector<std::uint8_t>& fine, int width, int height) {
  Image image{width, height, std::vector<std::uint8_t>(std::size_t(width) * height * 3)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int k = 0; k < 3; ++k) {
        int sum = 0;
        for (int j = 0; j < samples; ++j)
          for (int i = 0; i < samples; ++i)
            sum += fine[3 * (std::size_t(y * samples + j) * width * samples + x * samples + i) + k];
        image.rgb[3 * (std::size_t(y) * width + x) + k] = (std::uint8_t)(sum / (samples * samples));
      }
  return image;
}

}  // namespace

void add_to_frame(Frame& frame, const Mesh& mesh, const View& view) {
  for (const Tri& t : mesh.tris)
    for (int v : t) {
      const Vec3 p = seen(mesh.points[v], view);
      frame = {std::min(frame.left, p.x), std::min(frame.low, p.y), std::max(frame.right, p.x),
               std::max(frame.high, p.y)};
    }
}

Image draw_mesh(const Mesh& mesh, const std::vector<Color>& color, const std::vector<std::uint8_t>& strong,
                const View& view, const Frame& frame, int width, int height) {
  const int w = width * samples, h = height * samples;
  std::vector<Vec3> p(mesh.points.size());
  for (std::size_t v = 0; v < p.size(); ++v) p[v] = seen(mesh.points[v], view);
  const double fit = std::max({(frame.right - frame.left) / w, (frame.high - frame.low) / h, 1e-300});
  const double scale = 0.94 * view.zoom / fit;
  const Vec2 center{0.5 * (frame.left + frame.right) + view.shift_x * w * fit,
                    0.5 * (frame.low + frame.high) + view.shift_y * w * fit};
  for (Vec3& q : p) q = {w / 2.0 + (q.x - center.x) * scale, h / 2.0 - (q.y - center.y) * scale, q.z * scale};

  std::vector<float> depth(std::size_t(w) * h, -1e30f);
  std::vector<std::uint8_t> fine(std::size_t(w) * h * 3, 255);
  for (std::size_t t = 0; t < mesh.tris.size(); ++t) {
    const Vec3 q[3] = {p[mesh.tris[t][0]], p[mesh.tris[t][1]], p[mesh.tris[t][2]]};
    const Vec3 n = area_vector(q[0], q[1], q[2]);
    if (n.z == 0) continue;
    // y runs down on the picture, so a triangle seen from its front has n.z < 0
    const bool front = n.z < 0;
    const Vec3 unit = normalized(n);
    const double light = 0.35 + 0.65 * std::abs(0.25 * unit.x + 0.35 * unit.y + 0.9 * unit.z) / 1.0;
    double edge_length[3];
    for (int i = 0; i < 3; ++i) {
      Vec3 e = q[(i + 1) % 3] - q[i];
      edge_length[i] = std::sqrt(e.x * e.x + e.y * e.y);
    }
    const int x0 = std::max(0, (int)std::floor(std::min({q[0].x, q[1].x, q[2].x})));
    const int x1 = std::min(w - 1, (int)std::ceil(std::max({q[0].x, q[1].x, q[2].x})));
    const int y0 = std::max(0, (int)std::floor(std::min({q[0].y, q[1].y, q[2].y})));
    const int y1 = std::min(h - 1, (int)std::ceil(std::max({q[0].y, q[1].y, q[2].y})));
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const double px = x + 0.5, py = y + 0.5;
        double b[3];  // twice the area opposite to corner i+2, i.e. along edge i
        bool inside = true;
        for (int i = 0; i < 3; ++i) {
          const Vec3 &a = q[i], &c = q[(i + 1) % 3];
          b[i] = ((c.x - a.x) * (py - a.y) - (c.y - a.y) * (px - a.x)) * (front ? -1 : 1);
          inside = inside && b[i] >= 0;
        }
        if (!inside) continue;
        const double area = b[0] + b[1] + b[2];
        const double z = (b[1] * q[0].z + b[2] * q[1].z + b[0] * q[2].z) / area;
        const std::size_t at = std::size_t(y) * w + x;
        if (z <= depth[at]) continue;
        depth[at] = (float)z;
        double shade = light;
        for (int i = 0; i < 3; ++i) {
          const double distance = edge_length[i] > 0 ? b[i] / edge_length[i] : 0;
          const bool thick = !strong.empty() && (strong[t] >> i & 1);
          if (thick ? distance < 1.2 * samples : view.edges && distance < 0.25 * samples)
            shade = thick ? 0.05 : 0.45 * light;
        }
        for (int k = 0; k < 3; ++k)
          fine[3 * at + k] = (std::uint8_t)std::clamp(shade * (front ? color[t][k] : 110), 0.0, 255.0);
      }
  }
  return shrunk(fine, width, height);
}

Image side_by_side(const std::vector<Image>& images) {
  Image all;
  for (const Image& i : images) {
    all.width += i.width;
    all.height = std::max(all.height, i.height);
  }
  all.rgb.assign(std::size_t(all.width) * all.height * 3, 255);
  std::size_t left = 0;
  for (const Image& i : images) {
    for (int y = 0; y < i.height; ++y)
      std::copy_n(i.rgb.begin() + std::size_t(y) * i.width * 3, i.width * 3,
                  all.rgb.begin() + (std::size_t(y) * all.width + left) * 3);
    left += i.width;
  }
  return all;
}

Color label_color(int label) {
  // hues a golden angle apart never come close for neighboring labels
  const double hue = std::fmod(0.58 + label * 0.3819660112501051, 1.0) * 6;
  auto channel = [&](double shift) {
    double x = std::fmod(hue + shift, 6);
    double on = std::clamp(std::abs(x - 3) - 1, 0.0, 1.0);
    return (std::uint8_t)(120 + 125 * on);
  };
  return {channel(0), channel(4), channel(2)};
}

Color scale_color(double value) {
  constexpr Color stops[] = {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}};
  const double y = 4 * std::clamp(value, 0.0, 1.0), i = std::min(std::floor(y), 3.0);
  const Color &a = stops[(int)i], &b = stops[(int)i + 1];
  auto byte = [&](int k) { return (std::uint8_t)std::lround(a[k] + (y - i) * (b[k] - a[k])); };
  return {byte(0), byte(1), byte(2)};
}

}  // namespace meshpipe
