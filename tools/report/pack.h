// SPDX-License-Identifier: BSD-3-Clause
// Meshes packed for the viewer of mreport's page (viewer.js): a fifth of their size in the stream.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lib/core/mesh.h"

namespace meshpipe {

/// A figure of each triangle, shown to 1 part in 255 of [low, high], or of its logarithm.
struct FigureColumn {
  std::string name;
  std::vector<double> values;
  double low = 0, high = 1;
  bool logarithmic = false;
  /// Returns the values, if not null: those that viewer.js computes from the rounded positions are then
  /// corrected by bytes that are almost all 0.
  double (*of_triangle)(const Mesh&, int) = nullptr;
};

/// A name for each triangle: names[values[t]].
struct LabelColumn {
  std::string name;
  std::vector<int> values;
  std::vector<std::string> names;
};

struct MeshColumns {
  std::vector<FigureColumn> figures;
  std::vector<LabelColumn> labels;
};

/// `head` describes the bytes: counts, box, columns. The bytes are deflated, in base64.
struct PackedMesh {
  nlohmann::ordered_json head;
  std::string bytes;
};

/// Packs a mesh. Triangles keep their numbers; positions are rounded to 1/65535 of the bounding box.
/// `thick` (bits of edges to draw thick) may be empty. `dots` are more points to draw, on the mesh.
/// Requires: every column has a value for each triangle.
PackedMesh pack(const Mesh& mesh, const std::vector<std::uint8_t>& thick, const MeshColumns& columns,
                const std::vector<Vec3>& dots = {});

/// Returns bytes deflated, in base64.
std::string packed_bytes(const std::string& bytes);

/// Returns bytes in base64.
std::string base64(std::string_view bytes);

}  // namespace meshpipe
