// SPDX-License-Identifier: BSD-3-Clause
// The parts of a surface with its connectivity, for tests that have only the surface.
#pragma once
#include "lib/core/topology.h"
#include "lib/partition/partition.h"

namespace meshpipe {

inline std::string part_fault(const Surface& s) {
  return part_fault({s, opposite_halfedges(s.tris, (int)s.points.size())}, s.face.get<int>("part"));
}
inline Interfaces measure_interfaces(const Surface& s) {
  return measure_interfaces({s, opposite_halfedges(s.tris, (int)s.points.size()), model_of(s)},
                            s.face.get<int>("part"));
}

}  // namespace meshpipe
