// SPDX-License-Identifier: BSD-3-Clause
#include "lib/size/section.h"

#include "lib/size/local_feature_size.h"
#include "lib/size/size.h"

namespace meshpipe {
namespace {

constexpr double least_length = 1e-5;  ///< of the diagonal: shorter sections are no features
constexpr int most_lines = 2;  ///< along a tube; three keep its section, even with one triangle between them

}  // namespace

Sections::Sections(const Connectivity& surface, const std::vector<double>& asked)
    : surface_(surface),
      peak_(surface.mesh.points.size(), 0),
      least_(least_length * diagonal(surface.mesh)),
      least_at_peaks_(ring_edges * least_at_peaks(surface.mesh, asked)) {
  for (const Peak& x : sharp_peaks(surface, asked)) peak_[x.vertex] = 1;
}

double Sections::length(int h, Vec3 p, double asked, double most, long long& work) const {
  const Vec3 along = normalized(surface_.point(surface_.to(h)) - surface_.point(surface_.from(h)));
  auto height = [&](int v) { return dot(surface_.point(v) - p, along); };
  // rounding may leave p at an end: the section need not return there
  if (surface_.is_border(h) || (height(surface_.from(h)) > 0) == (height(surface_.to(h)) > 0))
    return infinity;
  double length = 0;
  int lines = 0, g = h;
  Vec3 x = p;
  do {
    ++work;
    const bool apex_ahead = height(surface_.apex(g)) > 0, from_ahead = height(surface_.from(g)) > 0;
    g = apex_ahead == from_ahead ? next(g) : prev(g);  // the other edge with ends on both sides
    if (surface_.is_border(g)) return infinity;
    const double at_from = height(surface_.from(g)), at_to = height(surface_.to(g));
    const Vec3 y =
        lerp(surface_.point(surface_.from(g)), surface_.point(surface_.to(g)), at_from / (at_from - at_to));
    length += norm(y - x);
    lines += surface_.is_model(g) || surface_.is_model(surface_.opposite[g]);
    if (length > most || lines > most_lines) return infinity;
    x = y;
    g = surface_.opposite[g];
  } while (g != h);
  auto tapers = [&](int v) {
    return peak_[v] && (norm(p - surface_.point(v)) < asked || length < least_at_peaks_);
  };
  return length > least_ && !tapers(surface_.from(h)) && !tapers(surface_.to(h)) ? length : infinity;
}

}  // namespace meshpipe
