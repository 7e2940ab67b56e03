// SPDX-License-Identifier: BSD-3-Clause
// What is wrong with a mesh, next to what is wrong with its reference already.
#include "lib/relax/faults.h"

#include <gtest/gtest.h>

#include "tests/unit/relax/drawn.h"

using namespace meshpipe;

namespace {

TEST(Faults, ReferenceIsTheSurfaceBeforeCuts) {
  // a triangle cut at d, which rounding has put above the sheet e f g next to it
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {1, 1, 2e-5}, {0, 0, 1e-5}, {3, 0, 1e-5}, {0, 3, 1e-5}};
  mesh.tris = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {4, 5, 6}};
  Surface surface = surface_of(mesh);
  surface.vertex.set("size", std::vector<double>(7, 3));
  auto pairs_where = [&](std::vector<int> origin) {
    surface.face.set("origin", std::move(origin));
    Drawn m(surface);
    Samples samples{feature_samples(m.reference, 3), {}};
    Known known{m.reference.surface, samples};
    return find_faults(m.s, known).pairs.size();
  };
  EXPECT_EQ(pairs_where({0, 1, 2, 3}), 0u);  // the reference intersects, too
  EXPECT_EQ(pairs_where({0, 0, 0, 1}), 3u);
}

}  // namespace
