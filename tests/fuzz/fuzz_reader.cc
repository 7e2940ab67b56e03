// SPDX-License-Identifier: BSD-3-Clause
// One libFuzzer entry for every reader: READER is its name, HEADER where it is declared. Any bytes are either
// read or refused by BadInput; what is read is a sound mesh, which the stream can hold.
#include HEADER

#include "formats/foreign/inria.h"
#include "formats/foreign/size_table.h"
#include "formats/formats.h"
#include "lib/core/error.h"

using namespace meshpipe;

/// A .sol file goes with a mesh.
[[maybe_unused]] static Stream read_sol_file(std::string_view bytes, const std::string& where) {
  Stream stream;
  stream.surface.points.resize(4);
  stream.surface.vertex.rows = 4;
  read_sol(stream, bytes, where);
  return stream;
}

/// A table of sizes is no mesh.
[[maybe_unused]] static Stream read_size_file(std::string_view bytes, const std::string& where) {
  for (double h : read_size_table(bytes, "", where).size)
    if (!(h > 0)) __builtin_trap();
  return {};
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Stream stream;
  try {
    stream = READER({reinterpret_cast<const char*>(data), size}, "in");
  } catch (const BadInput&) {
    return 0;
  } catch (const UpstreamFailed&) {
    return 0;
  }
  for (bool ascii : {false, true}) {
    const Stream again = read_stream(write_stream(stream, ascii), "again");
    if (again.surface.tris != stream.surface.tris) __builtin_trap();
  }
  return 0;
}
