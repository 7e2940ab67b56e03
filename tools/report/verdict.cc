// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/verdict.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "formats/stream/model_edges.h"
#include "formats/text.h"
#include "lib/clean/clean.h"
#include "lib/core/lists.h"
#include "lib/core/number.h"
#include "lib/defeature/defeature.h"
#include "tools/report/histogram.h"

namespace meshpipe {
namespace {

std::string row(const std::string& label, const std::string& before, const std::string& after) {
  char s[120];
  std::snprintf(s, sizeof s, "%-26s %12s %12s", label.c_str(), before.c_str(), after.c_str());
  return s;
}

/// What mclean has done to the input; all 0 if nothing.
Remark cleaning_of(const Stream& stream) {
  Remark cleaning;
  for (const std::string& text : stream.remarks)
    if (const Remark r = parse_remark(text); r.opened + r.split + r.dropped > 0) cleaning = r;
  return cleaning;
}

/// Returns the labels, or names, of lines of the input that no edge of a result of the chain has.
std::vector<std::string> lines_lost(const Stream& stream) {
  std::vector<std::string> lost;
  std::vector<int> given = read_model_edges(stream).tag, kept;
  sort_unique(given);
  if (!stream.find("ref_vertex") || given.empty() || given.back() == 0) return lost;
  for (const LineEdge& e : model_lines(stream)) kept.push_back(e.tag);
  sort_unique(kept);
  for (int tag : given) {
    if (tag == 0 || std::binary_search(kept.begin(), kept.end(), tag)) continue;
    const std::string name = stream.name_of(1, tag);
    lost.push_back(name.empty() ? std::to_string(tag) : meshpipe::quoted(name));
  }
  return lost;
}

}  // namespace

std::function<std::string(int)> namer(const Stream& stream) {
  return [&stream](int label) {
    const std::string name = stream.name_of(2, label);
    return name.empty() ? std::to_string(label) : name;
  };
}

double moved_in(const Stream& stream) {
  double sum = 0;
  for (const std::string& remark : stream.remarks) sum += moved_by(remark);
  return sum;
}

double required_distance(const Contract& contract) {
  double most = std::numeric_limits<double>::infinity();
  for (const Requirement& r : contract)
    if (r.name == "hausdorff") most = std::min(most, r.limit);
  return most;
}

std::vector<std::string> warnings_of(const Stream& stream, const Findings& f) {
  std::vector<std::string> lines;
  if (const int n = f.sheets ? f.sheets->flips[1] : 0; n > 0)
    lines.push_back("the surface cannot be oriented: triangles on both sides of " + std::to_string(n) +
                    (n == 1 ? " line" : " lines") +
                    " have the same vertices there, but are oriented differently; genus and boundary loops "
                    "are those of the surface cut open along this");
  if (const double most = moved_in(stream); most > 0)
    lines.push_back("mfeature has moved points by up to " + shown(most) +
                    ": this is part of the distance at most");
  if (const Remark r = cleaning_of(stream); r.opened + r.split + r.dropped > 0)
    lines.push_back("of the input, mclean has opened " + std::to_string(r.opened) + " edges, split " +
                    std::to_string(r.split) + " vertices, dropped " + std::to_string(r.dropped) +
                    " triangles");
  std::string lost;
  for (const std::string& line : lines_lost(stream)) lost += (lost.empty() ? "" : ", ") + line;
  if (!lost.empty()) lines.push_back("lines of the input that have no edge in the result: " + lost);
  return lines;
}

nlohmann::ordered_json report_of(const Findings& f, const Stream& stream) {
  auto report = nlohmann::ordered_json::object(), reference = report;
  for (const Figure& x : figures(f))
    for (auto [where, value] : {std::pair{&report, x.result}, std::pair{&reference, x.reference}}) {
      if (std::isnan(value)) continue;
      if (x.decimals == count_figure)
        (*where)[x.key] = (long long)value;
      else
        (*where)[x.key] = value;
    }
  const Soundness &m = f.mesh, &r = f.reference;
  report["topology_same"] =
      m.sound() && r.sound() && m.components == r.components && m.genus == r.genus && m.loops == r.loops;
  for (auto [where, q] : {std::pair{&report, &f.quality}, std::pair{&reference, &f.reference_quality}}) {
    (*where)["kappa_histogram"] = bins(q->kappas, 0, 1, 50);
    (*where)["angle_histogram"] = q->angle_histogram;
  }
  report["reference"] = reference;
  if (f.sheets)
    for (const RegionVolume& v : f.sheets->volumes)
      report["region_volumes"].push_back(
          {{"label", v.label}, {"volume", v.result}, {"reference", v.reference}});
  if (const double most = moved_in(stream); most > 0) report["moved"] = most;
  if (const auto lost = lines_lost(stream); !lost.empty()) report["lines_lost"] = lost;
  if (const Remark c = cleaning_of(stream); c.opened + c.split + c.dropped > 0)
    report["input"] = {{"opened", c.opened}, {"split", c.split}, {"dropped", c.dropped}};
  return report;
}

nlohmann::ordered_json failures_json(const std::vector<Failure>& failures) {
  auto list = nlohmann::ordered_json::array();
  for (const Failure& x : failures) list.push_back({{"requirement", x.requirement}, {"fact", x.fact}});
  return list;
}

std::string summary_of(const std::vector<Failure>& failures) {
  return "contract missed: " + failures[0].requirement + ": " + failures[0].fact +
         (failures.size() > 1 ? " (and " + std::to_string(failures.size() - 1) + " more)" : "");
}

FailureFacts facts_about(const Failure& f, const Mesh& mesh) {
  FailureFacts facts;
  facts.requirement = f.requirement;
  facts.value = f.value;
  facts.place = f.place;
  if (f.triangle < 0 || std::isnan(f.place.x)) return facts;
  const Tri& t = mesh.tris[f.triangle];
  for (int i = 0; i < 3; ++i)
    facts.reach = std::max(facts.reach, norm(mesh.points[t[(i + 1) % 3]] - mesh.points[t[i]]));
  return facts;
}

std::string text_of(double x, int decimals) {
  if (std::isnan(x)) return "-";
  char s[400];
  if (decimals == short_figure)
    std::snprintf(s, sizeof s, "%.3g", x);
  else
    std::snprintf(s, sizeof s, "%.*f", decimals == count_figure ? 0 : decimals, x);
  return s;
}

std::vector<std::string> figure_table(const std::vector<Figure>& figures) {
  std::vector<std::string> lines{row("", "reference", "result")};
  for (const Figure& f : figures) {
    const bool always = f.key == "genus" || f.key == "loops" || f.key == "self_intersections";
    if (f.decimals == count_figure && !always && !(f.reference > 0) && !(f.result > 0)) continue;
    if (std::isnan(f.reference) && std::isnan(f.result)) continue;
    lines.push_back(row(f.label, text_of(f.reference, f.decimals), text_of(f.result, f.decimals)));
  }
  return lines;
}

std::string findings_svg(const Findings& f) {
  const auto &a = f.reference_quality.kappas, &b = f.quality.kappas;
  return histogram_svg(
      {{"kappa", 0, 1, bins(a, 0, 1, 50), bins(b, 0, 1, 50)},
       {"kappa, the smallest", 0, 0.1, bins(a, 0, 0.1, 20), bins(b, 0, 0.1, 20), (int)a.size(),
        (int)b.size()},
       {"smallest angle, degrees", 0, 60, f.reference_quality.angle_histogram, f.quality.angle_histogram}});
}

}  // namespace meshpipe
