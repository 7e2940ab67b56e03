// SPDX-License-Identifier: BSD-3-Clause
// What mreport's page shows of one mesh: tables, pictures, and the mesh itself.
#pragma once
#include <optional>

#include "formats/stream.h"
#include "lib/check/check.h"
#include "tools/report/pack.h"

namespace meshpipe {

/// A result compared with its reference, by a contract.
struct Judgment {
  Contract contract;
  Findings findings;
  Surface reference;
};

/// A triangle that the page leads to.
struct ListedTriangle {
  int triangle;
  double kappa;
  Vec3 center;
  std::string why;
};

struct PatchRow {
  std::string name;
  double area = 0;
  int triangles = 0;
  double kappa = 1;  ///< the smallest
  int worst = -1;    ///< the triangle that has it
};

struct PageItem {
  std::string name;  ///< of the file
  int triangles = 0;
  std::optional<Contract> contract;  ///< none: there is nothing to compare with
  std::vector<Failure> failures;
  std::vector<double> reached;  ///< per requirement of the contract, NaN: no figure
  std::vector<Figure> figures;
  std::vector<std::string> warnings;
  std::vector<PatchRow> patches;
  std::vector<ListedTriangle> worst;      ///< up to ten, the worst first
  std::vector<ListedTriangle> offending;  ///< up to most_rows, the worst first
  std::vector<int> offending_triangles;   ///< all
  std::vector<Provenance> history;
  std::string histograms, picture;  ///< SVG, PNG
  std::vector<PackedMesh> meshes;   ///< the mesh first
  nlohmann::ordered_json report;    ///< as mcheck --json
};

/// Offending triangles that can be rows of the page's table, and that are at first.
constexpr std::size_t most_rows = 2000, first_rows = 100;
/// Triangles of a reference that is still shown: it may be much larger than the result.
constexpr std::size_t most_reference = 150000;

/// Collects what the page shows. Without `judgment` the mesh is measured alone. Charts are shown where the
/// stream has them. Throws: BadInput or NotAdmissible where the stream's tables do not fit together.
PageItem page_item(const Stream& stream, const std::string& name, const Judgment* judgment);

}  // namespace meshpipe
