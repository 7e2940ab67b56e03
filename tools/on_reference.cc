// SPDX-License-Identifier: BSD-3-Clause
#include "tools/on_reference.h"

#include <optional>

#include "formats/stream/lift_tables.h"
#include "formats/stream/region_tables.h"
#include "formats/stream/second_order.h"

namespace meshpipe {

std::string write_on_reference(Stream& stream, LiftedMesh mesh, const Surface& reference, bool second_order) {
  std::string exceptions;
  auto report = [&](int n, const char* what) {
    if (n > 0) exceptions += (exceptions.empty() ? "" : "; ") + std::to_string(n) + what;
  };
  std::optional<CurvedSurface> smooth;
  if (reference.face.has("curved")) smooth.emplace(reference);
  if (smooth)
    report(raise_vertices(mesh, *smooth), " vertices stay on the input, where triangles would intersect");
  std::optional<MidPoints> middle;
  if (second_order) middle = mid_points(mesh, reference, smooth ? &*smooth : nullptr);
  write_lifted(stream, std::move(mesh));
  update_volumes(stream);
  if (middle) {
    report(middle->straight, " edges stay straight, where triangles of second order would fold");
    write_mid_points(stream, middle->points);
  }
  return exceptions;
}

}  // namespace meshpipe
