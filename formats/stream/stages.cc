// SPDX-License-Identifier: BSD-3-Clause
#include "formats/stream/stages.h"

namespace meshpipe {

void drop_downstream(Stream& stream, Stage remade) {
  const bool maps = remade == Stage::parts || remade == Stage::charts;
  auto drop = [&](std::initializer_list<const char*> tables) {
    for (const char* table : tables) stream.erase(table);
  };
  if (remade == Stage::features) drop({"fine_vertex", "fine_face"});
  if (stream.find("ref_vertex")) {
    if (!maps) return;
    drop({"ref_vertex", "ref_face", "mid_vertex"});
    for (const char* column : {"ref_face", "b1", "b2", "kind", "line"}) stream.surface.vertex.erase(column);
  }
  drop({"chart_point", "chart_face"});
  if (remade != Stage::lines && stream.find("line_use")) drop({"line", "line_use", "line_vertex"});
  if (remade == Stage::parts) drop({"chart_vertex"});
}

}  // namespace meshpipe
