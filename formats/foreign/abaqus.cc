// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/abaqus.h"

#include "formats/foreign/polygons.h"
#include "formats/text.h"

namespace meshpipe {
namespace {

/// Names of sets begin with a letter and have at most 80 letters, digits, '_' and '-'. Case does not count.
std::string label(const Stream& stream, int tag) {
  std::string name = one_line(stream.name_of(2, tag)).substr(0, 60);
  for (char& c : name) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (!letter && !(c >= '0' && c <= '9') && c != '-') c = '_';
  }
  if (name.empty()) return "patch_" + std::to_string(tag);
  const char first = name[0];
  if ((first >= 'a' && first <= 'z') || (first >= 'A' && first <= 'Z')) return name;
  return "patch_" + name;
}

std::string upper(std::string name) {
  for (char& c : name)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 32);
  return name;
}

}  // namespace

std::string write_abaqus(const Stream& stream, bool) {
  const Surface& s = stream.surface;
  const ByPatch by = by_patch(stream);
  std::string out = "*HEADING\nmeshpipe\n*NODE\n";
  out.reserve(s.points.size() * 70 + s.tris.size() * 40);
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    append(out, static_cast<long long>(i) + 1);
    for (double x : {s.points[i].x, s.points[i].y, s.points[i].z}) {
      out += ", ";
      append(out, x);
    }
    out += '\n';
  }
  std::vector<std::string> taken;
  for (std::size_t k = 0; k < by.tags.size(); ++k) {
    std::string name = label(stream, by.tags[k]);
    for (const std::string& other : taken)
      if (other == upper(name)) {
        name += '_' + std::to_string(by.tags[k]);
        break;
      }
    taken.push_back(upper(name));
    out += "*ELEMENT, TYPE=S3, ELSET=" + name + '\n';
    for (std::size_t i = by.first[k]; i < by.first[k + 1]; ++i) {
      const int t = by.order[i];
      append(out, t + 1LL);
      for (int v : s.tris[t]) {
        out += ", ";
        append(out, v + 1LL);
      }
      out += '\n';
    }
  }
  return out;
}

}  // namespace meshpipe
