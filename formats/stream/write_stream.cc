// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <charconv>
#include <cstring>

#include "formats/stream.h"
#include "formats/stream/elements.h"
#include "formats/text.h"

namespace meshpipe {
namespace {

template <class T>
void append_text(std::string& out, T value) {
  char buffer[32];
  char* end;
  if constexpr (sizeof(T) == 1)
    end = std::to_chars(buffer, buffer + 32, int{value}).ptr;
  else
    end = std::to_chars(buffer, buffer + 32, value).ptr;
  out.append(buffer, end - buffer);
}

void declare(std::string& out, const Table& table, std::size_t rows) {
  out += "element " + table.name + ' ' + std::to_string(rows) + '\n';
  if (table.name == "vertex") out += "property double x\nproperty double y\nproperty double z\n";
  if (table.name == "face") out += "property list uchar int vertex_indices\n";
  for (const Column& c : table.columns)
    out += std::string("property ") + type_names[c.data.index()] + ' ' + c.name + '\n';
}

/// Writes the rows of a table, in blocks that go to `sink` when `out` is full. `mesh_row(r, row)` writes what
/// the mesh itself holds of row r (`mesh_bytes` of it) to `row`, or appends it to `out` as text if that is
/// null.
template <class MeshRow>
void write_rows(std::string& out, const Sink& sink, const Table& table, std::size_t rows, bool ascii,
                std::size_t mesh_bytes, const MeshRow& mesh_row) {
  constexpr std::size_t block_bytes = 1 << 20;
  std::size_t stride = mesh_bytes;
  for (const Column& c : table.columns) stride += type_sizes[c.data.index()];
  const std::size_t block = std::max<std::size_t>(1, block_bytes / std::max<std::size_t>(1, stride));
  for (std::size_t first = 0; first < rows; first += block) {
    const std::size_t end = std::min(first + block, rows);
    if (ascii) {
      for (std::size_t r = first; r < end; ++r) {
        mesh_row(r, nullptr);
        for (const Column& c : table.columns) {
          std::visit([&](const auto& v) { append_text(out, v[r]); }, c.data);
          out += ' ';
        }
        out.back() = '\n';
      }
    } else {
      const std::size_t start = out.size();
      out.resize(start + (end - first) * stride);
      char* const base = out.data() + start;
      if (mesh_bytes)
        for (std::size_t r = first; r < end; ++r) mesh_row(r, base + (r - first) * stride);
      std::size_t offset = mesh_bytes;
      for (const Column& c : table.columns)
        std::visit(
            [&](const auto& v) {
              for (std::size_t r = first; r < end; ++r)
                std::memcpy(base + (r - first) * stride + offset, &v[r], sizeof v[r]);
              offset += sizeof v[0];
            },
            c.data);
    }
    if (out.size() >= block_bytes) {
      sink(out);
      out.clear();
    }
  }
}

std::string header(const Stream& stream, bool ascii) {
  std::string out = ascii ? "ply\nformat ascii 1.0\n" : "ply\nformat binary_little_endian 1.0\n";
  out += "comment mply 1.0\n";
  for (const Provenance& p : stream.history) {
    // some viewers read lines of at most 500 bytes
    std::string line =
        "comment pg " + p.program + ' ' + p.version + (p.arguments.empty() ? "" : " ") + p.arguments;
    if (line.size() > 400) line.replace(397, std::string::npos, "...");
    out += line + '\n';
  }
  if (stream.input_triangles > 0)
    out += "comment input_triangles " + std::to_string(stream.input_triangles) + '\n';
  if (stream.asked_triangles > 0)
    out += "comment asked_triangles " + std::to_string(stream.asked_triangles) + '\n';
  if (stream.unit != 0) out += "comment unit " + std::to_string(stream.unit) + '\n';
  for (const Name& n : stream.names)
    out += "comment name " + std::to_string(n.dim) + ' ' + std::to_string(n.tag) + ' ' +
           percent_encode(n.text) + '\n';
  for (const std::string& r : stream.remarks) out += "comment " + r + '\n';
  const Surface& s = stream.surface;
  declare(out, s.vertex, s.points.size());
  declare(out, s.face, s.tris.size());
  for (const Table& t : stream.tables) declare(out, t, t.rows);
  out += "end_header\n";
  return out;
}

}  // namespace

std::string write_stream(const Stream& stream, bool ascii) {
  std::string all;
  write_stream(stream, ascii, [&](std::string_view bytes) { all += bytes; });
  return all;
}

void write_stream(const Stream& stream, bool ascii, const Sink& sink) {
  std::string out = header(stream, ascii);
  const Surface& s = stream.surface;
  write_rows(out, sink, s.vertex, s.points.size(), ascii, 24, [&](std::size_t r, char* row) {
    const Vec3& p = s.points[r];
    if (row) {
      std::memcpy(row, &p, 24);
      return;
    }
    for (double x : {p.x, p.y, p.z}) {
      append_text(out, x);
      out += ' ';
    }
  });
  write_rows(out, sink, s.face, s.tris.size(), ascii, 13, [&](std::size_t r, char* row) {
    if (row) {
      *row = 3;
      std::memcpy(row + 1, s.tris[r].data(), 12);
      return;
    }
    out += "3 ";
    for (int v : s.tris[r]) {
      append_text(out, v);
      out += ' ';
    }
  });
  for (const Table& t : stream.tables) write_rows(out, sink, t, t.rows, ascii, 0, [](std::size_t, char*) {});
  sink(out);
}

}  // namespace meshpipe
