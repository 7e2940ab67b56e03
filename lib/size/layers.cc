// SPDX-License-Identifier: BSD-3-Clause
#include "lib/size/layers.h"

#include <algorithm>
#include <cmath>

#include "lib/core/error.h"
#include "lib/core/number.h"
#include "lib/core/topology.h"
#include "lib/feature/feature.h"
#include "lib/size/sheet_distance.h"

namespace meshpipe {
namespace {

constexpr double least_angle = 60;  ///< degrees between two sides, below which prisms on them meet
constexpr int most_layers = 1000;

double number(const std::string& text, const std::string& all) {
  double x = 0;
  const char* end = text.data() + text.size();
  const auto [at, error] = from_chars(text.data(), end, x);
  if (text.empty() || error != std::errc() || at != end || !(x > 0) || !std::isfinite(x))
    throw BadUsage("--layers: expected T[,GROWTH[,N]][,outside] with positive numbers, found '" + all + "'");
  return x;
}

}  // namespace

double Layers::total() const {
  double sum = 0, next = first;
  for (int i = 0; i < count; ++i, next *= growth) sum += next;
  return sum;
}

Layers parse_layers(const std::string& text) {
  Layers layers;
  std::vector<std::string> words(1);
  for (char c : text)
    if (c == ',')
      words.emplace_back();
    else
      words.back().push_back(c);
  if (words.size() > 1 && words.back() == "outside") {
    layers.outside = true;
    words.pop_back();
  }
  layers.first = number(words[0], text);
  if (words.size() > 1) layers.growth = number(words[1], text);
  if (words.size() > 2) {
    const double n = number(words[2], text);
    if (n > most_layers || n != std::floor(n)) number("", text);
    layers.count = (int)n;
  }
  if (words.size() > 3 || !std::isfinite(layers.total())) number("", text);
  return layers;
}

LayerReport check_layers(Surface& surface, const Layers& layers) {
  const std::vector<int> opposite = opposite_halfedges(surface);
  const auto model = model_of(surface);
  const Connectivity c{surface, opposite, model};
  const double sign = layers.outside ? -1 : 1;
  const SheetDistance sheets(c, layers.outside ? SheetDistance::outside : SheetDistance::inside,
                             diagonal(surface));
  std::vector<double> fits = sheets.radii();
  std::vector<LayerReport::Cause> cause(fits.size(), LayerReport::sheets);
  std::vector<double> measured = fits, bend(fits.size(), 0), sharpest(fits.size(), 180);
  for (double& x : measured) x *= 2;
  for (int h = 0; h < c.n_half_edges(); ++h) {
    if (c.is_border(h)) continue;
    const double inside = angle_behind(c, h), angle = layers.outside ? 360 - inside : inside;
    for (int v : {c.from(h), c.to(h)}) {
      bend[v] += sign * (180 - inside) * c.length(h);
      sharpest[v] = std::min(sharpest[v], angle);
    }
  }
  auto bound = [&](int v, double x, LayerReport::Cause why, double by) {
    if (x < fits[v]) fits[v] = x, cause[v] = why, measured[v] = by;
  };
  const std::vector<double> curvature = face_curvature(c);
  for (int t = 0; t < c.n_tris(); ++t)
    for (int v : surface.tris[t])
      if (bend[v] > 0 && curvature[t] > 0)
        bound(v, 1 / curvature[t], LayerReport::curvature, 1 / curvature[t]);
  LayerReport r;
  r.total = layers.total();
  r.least = infinity;
  for (int v = 0; v < c.n_vertices(); ++v) {
    if (sharpest[v] < least_angle) bound(v, 0, LayerReport::corner, sharpest[v]);
    if (fits[v] < r.total) {
      ++r.vertices[cause[v]];
      ++r.all;
    }
    if (fits[v] < r.least) {
      r.least = fits[v];
      r.measured = measured[v];
      r.cause = cause[v];
      r.at = surface.points[v];
    }
  }
  surface.vertex.set("layers", std::move(fits));
  return r;
}

std::vector<std::string> describe(const LayerReport& r) {
  if (!(r.total > 0)) return {};
  if (r.all == 0)
    return {"layers of " + shown(r.total) + " in all fit everywhere; " + shown(r.least) + " do"};
  const std::string where = " at " + shown(r.at);
  const char* const names[] = {"the distance to the next sheet", "the radius of curvature",
                               "the angle in degrees between two sides"};
  return {"layers of " + shown(r.total) + " in all do not fit at " + std::to_string(r.all) + " vertices (" +
              std::to_string(r.vertices[LayerReport::sheets]) + " between near sheets, " +
              std::to_string(r.vertices[LayerReport::curvature]) + " by curvature, " +
              std::to_string(r.vertices[LayerReport::corner]) + " in sharp corners)",
          "no more than " + shown(r.least) + " fit" + where + ", where " + names[r.cause] + " is " +
              shown(r.measured)};
}

}  // namespace meshpipe
