// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/page.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <sstream>

#include "formats/text.h"
#include "lib/core/number.h"
#include "tools/report/verdict.h"

namespace meshpipe {
namespace {

std::string escaped(const std::string& text) { return xml_escaped(text); }

/// A table, row by row. A row's first cell is its heading.
class HtmlTable {
 public:
  /// A heading that ends with `#` is that of a column of numbers.
  HtmlTable(const std::string& caption, const std::vector<std::string>& headings, const char* css = "") {
    out_ = "<table class=\"" + std::string(css) + "\"><caption>" + caption + "</caption><thead><tr>";
    for (std::string h : headings) {
      numbers_.push_back(h.ends_with('#'));
      if (numbers_.back()) h.pop_back();
      out_ += std::string("<th scope=\"col\"") + (numbers_.back() ? " class=\"n\">" : ">") + h + "</th>";
    }
    out_ += "</tr></thead><tbody>\n";
  }
  /// Adds a row of cells, which are HTML.
  void row(const std::vector<std::string>& cells) { add(row_html(cells)); }
  void add(const std::string& row) { out_ += row; }
  std::string row_html(const std::vector<std::string>& cells) const {
    std::string html = "<tr><th scope=\"row\">" + cells[0] + "</th>";
    for (std::size_t i = 1; i < cells.size(); ++i)
      html += (numbers_[i] ? "<td class=\"n\">" : "<td>") + cells[i] + "</td>";
    return html + "</tr>\n";
  }
  std::string finish() { return std::move(out_) + "</tbody></table>\n"; }

 private:
  std::string out_;
  std::vector<bool> numbers_;
};

std::string scrolled(const std::string& label, const std::string& html) {
  return "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"" + escaped(label) + "\">" +
         html + "</div>\n";
}

/// A button that leads the viewer to a triangle; viewer.js enables it once there is a view.
std::string button(std::size_t item, int triangle) {
  const std::string t = std::to_string(triangle);
  return "<button type=\"button\" disabled data-result=\"" + std::to_string(item) + "\" data-t=\"" + t +
         "\" aria-label=\"Show triangle " + t + "\">" + t + "</button>";
}

std::string verdict_of(const PageItem& item) {
  if (!item.contract) return "Not compared with the surface it was made from.";
  if (item.failures.empty()) return "The contract is met.";
  return "The contract is missed: " + std::to_string(item.failures.size()) +
         (item.failures.size() == 1 ? " failure." : " failures.");
}

std::string verdict_html(const PageItem& item) {
  const char* css = !item.contract ? "" : item.failures.empty() ? " met" : " missed";
  std::string html = std::string("<p class=\"verdict") + css + "\">" + verdict_of(item) + "</p>\n";
  if (!item.failures.empty()) {
    html += "<ul>\n";
    for (const Failure& f : item.failures)
      html += "<li><strong>" + escaped(f.requirement) + "</strong>: " + escaped(f.fact) + "</li>\n";
    html += "</ul>\n";
  }
  for (const std::string& w : item.warnings) html += "<p class=\"note\">" + escaped(w) + "</p>\n";
  return html;
}

const char* meaning_of(const std::string& requirement) {
  constexpr std::pair<const char*, const char*> words[] = {
      {"topology", "manifold; components, genus and loops of the reference"},
      {"intersections", "none where the reference has none"},
      {"folds", "no folded edges"},
      {"creases", "no edges that cut off a crease"},
      {"patches", "all patches of the reference, in place"},
      {"vertices", "vertices off the reference, in edges"},
      {"kappa", "smallest kappa, where no corner forces less"},
      {"kappa_off_wedges", "smallest kappa away from sharp corners"},
      {"kappa_mean", "mean kappa"},
      {"angle", "smallest angle, degrees"},
      {"hausdorff", "Hausdorff distance over the diagonal"},
      {"mean", "mean distance over the diagonal"},
      {"rms", "root mean square distance over the diagonal"},
      {"boundary", "distance of borders over the diagonal"},
      {"features", "distance of features over the diagonal"},
      {"deviation", "distance of the surfaces, in sizes"},
      {"size", "deviation of edges from the size"},
      {"trace", "kappa lost at the cuts"}};
  for (auto [name, text] : words)
    if (requirement == name) return text;
  return "";
}

std::string contract_html(const PageItem& item) {
  HtmlTable table("Contract", {"requirement", "asked", "before#", "reached#", "pass"});
  for (std::size_t i = 0; i < item.contract->size(); ++i) {
    const Requirement& r = (*item.contract)[i];
    const bool missed = std::any_of(item.failures.begin(), item.failures.end(),
                                    [&](const Failure& f) { return f.requirement == r.name; });
    const char* key = r.name == "kappa"        ? "kappa_min"
                      : r.name == "kappa_mean" ? "kappa_mean"
                      : r.name == "angle"      ? "min_angle"
                      : r.name == "size"       ? "edge_deviation"
                                               : "";
    std::string before = "-";
    for (const Figure& f : item.figures)
      if (f.key == key) before = text_of(f.reference, f.decimals);
    const double x = item.reached[i];
    const bool counted = std::isnan(x);
    const std::string asked = counted ? "yes" : (is_lower_limit(r) ? "above " : "at most ") + shown(r.limit);
    table.row({r.name + "<br><span class=\"note\">" + meaning_of(r.name) + "</span>", asked, before,
               counted ? (missed ? "no" : "yes") : text_of(x, short_figure),
               missed ? "<span class=\"no\">missed</span>" : "<span class=\"yes\">met</span>"});
  }
  return table.finish();
}

std::string figures_html(const PageItem& item) {
  const bool compared = item.contract.has_value();
  HtmlTable table("Figures", compared ? std::vector<std::string>{"figure", "before#", "after#"}
                                      : std::vector<std::string>{"figure", "value#"});
  for (const Figure& f : item.figures) {
    const bool before = compared && !std::isnan(f.reference);
    if (!compared && (f.key.find("distance") != f.key.npos || f.key.find("hausdorff") != f.key.npos ||
                      f.key == "deviation" || f.key == "kappa_off_wedges" || f.key == "self_intersections" ||
                      f.key == "new_intersections" || f.key == "folds" || f.key == "needles"))
      continue;  // what was not measured
    const bool always = f.key == "genus" || f.key == "loops" || f.key == "self_intersections";
    if (f.decimals == count_figure && !always && !(f.reference > 0) && !(f.result > 0)) continue;
    if (std::isnan(f.result) && !before) continue;
    const std::string after = text_of(f.result, f.decimals);
    if (compared)
      table.row({f.label, text_of(f.reference, f.decimals), after});
    else
      table.row({f.label, after});
  }
  return table.finish();
}

std::string patches_html(const PageItem& item, std::size_t number) {
  if (item.patches.empty()) return "";
  HtmlTable table("Patches", {"name", "area#", "triangles#", "smallest kappa#", "in triangle#"});
  for (const PatchRow& p : item.patches)
    table.row({escaped(p.name), shown(p.area), std::to_string(p.triangles), text_of(p.kappa, 4),
               button(number, p.worst)});
  return scrolled("Patches of " + item.name, table.finish());
}

std::string worst_html(const PageItem& item, std::size_t number) {
  if (item.worst.empty()) return "";
  HtmlTable table("The worst triangles", {"triangle", "kappa#", "center"});
  for (const ListedTriangle& t : item.worst)
    table.row({button(number, t.triangle), text_of(t.kappa, 4), shown(t.center)});
  return scrolled("The worst triangles of " + item.name, table.finish());
}

std::string offending_html(const PageItem& item, std::size_t number) {
  if (item.offending.empty()) return "";
  const std::size_t all = item.offending_triangles.size(), rows = item.offending.size();
  HtmlTable table("Offending triangles: " + std::to_string(all), {"triangle", "kappa#", "center", "fault"},
                  "faults");
  std::string rest;
  for (std::size_t i = 0; i < rows; ++i) {
    const ListedTriangle& t = item.offending[i];
    const std::string row =
        table.row_html({button(number, t.triangle), text_of(t.kappa, 4), shown(t.center), t.why});
    if (i < first_rows)
      table.add(row);
    else
      rest += row;
  }
  std::string html = table.finish();
  if (!rest.empty())
    html += "<button type=\"button\" class=\"more\" disabled data-all=\"" + std::to_string(number) +
            "\">Show " + (rows < all ? "the first " : "all ") + std::to_string(rows) +
            "</button>\n<script type=\"text/plain\" id=\"rows" + std::to_string(number) + "\">" +
            packed_bytes(rest) + "</script>\n";
  return "<section>" + scrolled("Offending triangles in " + item.name, html) + "</section>";
}

std::string data_uri(const char* type, const std::string& bytes) {
  return std::string("data:") + type + ";base64," + base64(bytes);
}

std::string histograms_html(const PageItem& item) {
  const std::string what = "Histograms of kappa, of its smallest values, and of the smallest angle" +
                           std::string(item.contract ? ", before (orange line) and after (blue)" : "");
  return "<figure><img alt=\"" + what + "; the figures are in the table above\" src=\"" +
         data_uri("image/svg+xml", item.histograms) + "\"><figcaption>" + what + "</figcaption></figure>\n";
}

std::string provenance_html(const PageItem& item) {
  if (item.history.empty()) return "";
  std::string html = "<h3>Programs that made it</h3>\n<pre tabindex=\"0\" aria-label=\"Programs that made " +
                     escaped(item.name) + "\">";
  for (const Provenance& p : item.history)
    html += escaped(p.program + ' ' + p.version + (p.arguments.empty() ? "" : ' ' + p.arguments)) + '\n';
  return html + "</pre>\n";
}

std::string item_html(const PageItem& item, std::size_t number, bool several) {
  const std::string id = "item" + std::to_string(number);
  std::string html = "<section aria-label=\"" + escaped(item.name) + "\">\n<h2 id=\"" + id + "\">" +
                     escaped(item.name) + "</h2>\n";
  if (several) html += verdict_html(item);
  html += "<div class=\"columns\">\n<div>";
  if (item.contract) html += contract_html(item);
  html += worst_html(item, number) + offending_html(item, number) + patches_html(item, number);
  html += "</div>\n<div>" + figures_html(item) + "</div>\n</div>\n";
  return html + histograms_html(item) + provenance_html(item) + "</section>\n";
}

std::string viewer_html(const Page& page) {
  std::string html = R"(<section aria-label="Surface"><h2>Surface</h2>
<div id="viewer" hidden>
<div class="bar">
<label>Color by <select id="color"></select></label>
<label><input type="checkbox" id="wire" checked> mesh lines</label>
<button type="button" id="reset">Whole surface</button>
<button type="button" id="prev">Previous bad triangle</button>
<button type="button" id="next">Next bad triangle</button>
</div>
<div class="panes">
)";
  for (const char* side : {"Left", "Right"})
    html +=
        std::string("<div class=\"pane\"") + (*side == 'R' ? " hidden" : "") + "><div class=\"bar\"><label>" +
        side +
        " <select></select></label></div><div class=\"frame\"><canvas tabindex=\"0\" role=\"application\" "
        "aria-label=\"" +
        side +
        " view\" aria-describedby=\"keys\"></canvas><div class=\"mark\" hidden></div><img class=\"still\" "
        "alt=\"" +
        side +
        R"( view, as it was when printed" src="data:image/gif;base64,R0lGODlhAQABAAAAACwAAAAAAQABAAA="></div></div>
)";
  html += R"(</div>
<div id="legend"></div>
<p id="status" role="status"></p>
<p class="note keys" id="keys">Drag or use the arrow keys to rotate, with Shift to move; turn the wheel or press + and - to
zoom; Home shows the whole; n and p go to the next and the previous bad triangle (an offending one; if there is none, one of
the worst). Model edges are thick, and fade where they would hide the surface. Triangles in front of the selected one are cut away. Click a triangle for its figures.</p>
</div>
<div id="stills"><p class="note" id="why">Scripts are needed to rotate the surface and for the buttons below; this is a picture of it.</p>
)";
  for (const PageItem& item : page.items)
    if (!item.picture.empty())
      html += "<figure><img alt=\"" + escaped(item.name) + ", colored by kappa\" src=\"" +
              data_uri("image/png", item.picture) + "\"><figcaption>" + escaped(item.name) +
              ", colored by kappa: dark 0, light 1" + (item.offending.empty() ? "" : "; red: offending") +
              "</figcaption></figure>\n";
  return html + "</div></section>\n";
}

std::string overview_html(const Page& page) {
  if (page.items.size() < 2) return "";
  HtmlTable table("Results", {"name", "triangles#", "smallest kappa#", "verdict"});
  for (std::size_t i = 0; i < page.items.size(); ++i) {
    const PageItem& item = page.items[i];
    table.row({"<a href=\"#item" + std::to_string(i) + "\">" + escaped(item.name) + "</a>",
               std::to_string(item.triangles), item.worst.empty() ? "-" : text_of(item.worst[0].kappa, 4),
               verdict_of(item)});
  }
  return table.finish();
}

std::string run_html(const Page& page) {
  if (page.command.empty() && page.times.empty()) return "";
  std::string html = "<section aria-label=\"Run\"><h2>Run</h2>\n";
  if (!page.command.empty())
    html += "<pre tabindex=\"0\" aria-label=\"Command line\">" + escaped(page.command) + "</pre>\n";
  if (!page.times.empty()) {
    HtmlTable table("Time in seconds", {"program", "processor#", "elapsed#"});
    double processor = 0, elapsed = 0;
    for (const StageTime& t : page.times) {
      table.row({escaped(t.program), text_of(t.user + t.system, 2), text_of(t.elapsed, 2)});
      processor += t.user + t.system;
      elapsed += t.elapsed;
    }
    table.row({"all", text_of(processor, 2), text_of(elapsed, 2)});
    html += table.finish();
  }
  return html + "</section>\n";
}

/// What the viewer needs to know; "<" is written so that it ends no script.
std::string script_json(const nlohmann::ordered_json& json) {
  std::string text;
  for (char c : json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace))
    c == '<' ? text += "\\u003c" : text += c;
  return text;
}

std::string data_html(const Page& page) {
  auto results = nlohmann::ordered_json::array(), meshes = results;
  std::string blocks;
  for (std::size_t i = 0; i < page.items.size(); ++i) {
    auto worst = nlohmann::ordered_json::array();
    for (const ListedTriangle& t : page.items[i].worst) worst.push_back(t.triangle);
    auto exact = nlohmann::ordered_json::object();
    const auto& faulty = page.items[i].offending;
    for (const auto& list :
         {std::span(page.items[i].worst), std::span(faulty).first(std::min(first_rows, faulty.size()))})
      for (const ListedTriangle& t : list)
        exact[std::to_string(t.triangle)] = {t.center.x, t.center.y, t.center.z};
    results.push_back({{"worst", worst}, {"exact", exact}});
    blocks += "<script type=\"text/plain\" id=\"faulty" + std::to_string(i) + "\">" +
              packed_bytes(nlohmann::json(page.items[i].offending_triangles).dump()) + "</script>\n";
    for (const PackedMesh& m : page.items[i].meshes) {
      nlohmann::ordered_json head = m.head;
      head["id"] = "mesh" + std::to_string(meshes.size());
      head["result"] = i;
      blocks += "<script type=\"text/plain\" id=\"mesh" + std::to_string(meshes.size()) + "\">" + m.bytes +
                "</script>\n";
      meshes.push_back(std::move(head));
    }
  }
  return blocks + "<script type=\"application/json\" id=\"data\">" +
         script_json({{"results", results}, {"meshes", meshes}}) + "</script>\n";
}

}  // namespace

std::vector<StageTime> parse_times(std::string_view text) {
  std::vector<StageTime> times;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) {
    std::replace(line.begin(), line.end(), ',', '.');  // as some locales write it
    StageTime t;
    char program[32], rest = 0;
    if (std::sscanf(line.c_str(), "%31s %lf %lf %lf %c", program, &t.user, &t.system, &t.elapsed, &rest) != 4)
      continue;
    t.program = program;
    times.push_back(t);
  }
  return times;
}

nlohmann::ordered_json json_of(const Page& page) {
  nlohmann::ordered_json json{{"program", "mreport"}};
  if (!page.command.empty()) json["command"] = page.command;
  if (!page.error.empty()) json["error"] = page.error;
  for (const StageTime& t : page.times)
    json["times"].push_back(
        {{"program", t.program}, {"user", t.user}, {"system", t.system}, {"elapsed", t.elapsed}});
  json["results"] = nlohmann::ordered_json::array();
  for (const PageItem& item : page.items) {
    nlohmann::ordered_json result{{"name", item.name}};
    if (item.contract) result["met"] = item.failures.empty();
    result.update(item.report);
    for (std::size_t i = 0; item.contract && i < item.contract->size(); ++i) {
      nlohmann::ordered_json row{{"requirement", (*item.contract)[i].name}};
      if (!std::isnan(item.reached[i]))
        row.update({{"asked", (*item.contract)[i].limit}, {"reached", item.reached[i]}});
      result["contract"].push_back(row);
    }
    for (const PatchRow& p : item.patches)
      result["patches"].push_back(
          {{"name", p.name}, {"area", p.area}, {"triangles", p.triangles}, {"kappa_min", p.kappa}});
    for (const Provenance& p : item.history)
      result["history"].push_back(p.program + ' ' + p.version +
                                  (p.arguments.empty() ? "" : ' ' + p.arguments));
    json["results"].push_back(result);
  }
  return json;
}

std::string html_of(const Page& page) {
  const std::string title = escaped(page.title);
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      // nothing is loaded from anywhere, whatever names and messages hold
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src "
      "'unsafe-inline'; script-src 'unsafe-inline'\">\n<title>" +
      title + "</title>\n<style>\n" + page_css + "</style>\n</head>\n<body>\n<header><h1>" + title +
      "</h1></header>\n<main>\n";
  if (!page.error.empty())
    html += "<p class=\"verdict missed\">The run ended early, with " + escaped(page.error) + "</p>\n";
  html += page.items.size() == 1 ? verdict_html(page.items[0]) : overview_html(page);
  html +=
      "<p class=\"note\">Kappa measures the shape of a triangle by its angles a, b, c as 4 sin a sin b sin c "
      "/ (sin a + "
      "sin b + sin c): 1 where it is equilateral, 0 where it has no area.</p>\n";
  html += viewer_html(page);
  for (std::size_t i = 0; i < page.items.size(); ++i)
    html += item_html(page.items[i], i, page.items.size() > 1);
  html += run_html(page);
  html +=
      "<section aria-label=\"For scripts\"><h2>For scripts</h2>\n"
      "<p class=\"note\">The same as JSON, in this file's element of id "
      "<code>report</code>.</p></section>\n</main>\n"
      "<script type=\"application/json\" id=\"report\">" +
      script_json(json_of(page)) + "</script>\n" + data_html(page);
  return html + "<script>\n" + viewer_js + "</script>\n</body>\n</html>\n";
}

}  // namespace meshpipe
