// SPDX-License-Identifier: BSD-3-Clause
#include "tools/removed.h"

#include <cstdio>

namespace meshpipe {
namespace {

constexpr std::size_t most_lines = 5;  ///< of single features; the others with -v

std::string text(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3g", x);
  return buffer;
}

std::string text(std::size_t n, const char* what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

}  // namespace

void report_flips(Io& io, const Flips& flips) {
  io.report["flipped"] = flips.count;
  if (flips.count == 0) return;
  const std::string moved = flips.moved > 0 ? "; no point has moved by more than " + text(flips.moved) : "";
  io.say(text(flips.count, "edge") +
         " flipped at triangles of no height, or where the surface lay flat on itself" + moved);
}

void report_removed(Io& io, const DefeatureReport& r, double tolerance, const Stream& stream) {
  io.report["tolerance"] = tolerance;
  io.report["moved"] = r.moved;
  if (r.stopped)
    io.say("features narrower than " + text(tolerance) +
           " stay: without them the surface would intersect itself");
  auto list = nlohmann::ordered_json::array();
  if (!r.removed.empty())
    io.say("removed " + text(r.removed.size(), "feature") + " narrower than " + text(tolerance) +
           "; no point has moved by more than " + text(r.moved));
  for (const RemovedFeature& f : r.removed) {
    const std::string line = "  " + text(f.width) + " wide, " + text(f.length) + " long, at (" +
                             text(f.at.x) + " " + text(f.at.y) + " " + text(f.at.z) + ")";
    list.size() < most_lines ? io.say(line) : io.detail(line);
    list.push_back({{"width", f.width}, {"length", f.length}, {"at", {f.at.x, f.at.y, f.at.z}}});
  }
  if (list.size() > most_lines && !io.verbose) io.say("  and others, narrower; -v lists them");
  std::vector<std::string> vanished;
  std::string names;
  for (int label : r.vanished) {
    const std::string name = stream.name_of(2, label);
    vanished.push_back(name.empty() ? std::to_string(label) : name);
    names += (names.empty() ? "" : ", ") + vanished.back();
  }
  if (!names.empty()) io.warn("patches narrower than the tolerance are removed: " + names);
  io.report["removed"] = list;
  io.report["vanished"] = vanished;
}

}  // namespace meshpipe
