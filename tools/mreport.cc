// SPDX-License-Identifier: BSD-3-Clause
// mreport: one HTML page that shows results or intermediates.
#include <cctype>
#include <filesystem>

#include "tools/common.h"
#include "tools/compare.h"
#include "tools/report/page.h"
#include "tools/report/verdict.h"

using namespace meshpipe;

namespace {

struct Options {
  std::vector<std::string> results;
  std::string reference, require, title, command, times;
  double max_error = 0;
  int samples = 10000, status = 0;
};

/// Returns the contract that a result was checked by: as the options say, or as mcheck's line in its history.
Contract contract_of(const Stream& stream, const Options& o) {
  std::string require = o.require, max_error;
  for (const Provenance& p : stream.history) {
    if (p.program != "mcheck" || !o.require.empty()) continue;
    auto value = [&](const std::string& option) {
      const std::size_t at = (' ' + p.arguments).find(" --" + option + '=');
      if (at == std::string::npos) return std::string();
      const std::string rest = p.arguments.substr(at + option.size() + 3);
      return rest.substr(0, rest.find(' '));
    };
    require = value("require");
    max_error = value("max-error");
  }
  Contract contract = parse_contract(require.empty() ? default_contract : require);
  if (o.max_error > 0)
    contract.push_back({"hausdorff", o.max_error});
  else if (!max_error.empty())
    contract.push_back(parse_contract("hausdorff=" + max_error)[0]);
  return contract;
}

PageItem item_of(Io& io, Stream& stream, const std::string& name, const Options& o) {
  if (o.reference.empty() && !stream.find("ref_vertex")) return page_item(stream, name, nullptr);
  Judgment judgment{contract_of(stream, o), {}, {}};
  judgment.findings = compare(io, stream, o.reference, judgment.contract, o.samples, judgment.reference);
  return page_item(stream, name, &judgment);
}

/// Returns the last intermediate in a folder of mremesh --keep, such as 12-relax.ply; any other path as it
/// is.
std::string last_intermediate(const std::string& path) {
  if (!std::filesystem::is_directory(path)) return path;
  std::string last;
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    const std::string name = entry.path().filename().string();
    const bool stage = name.size() > 7 && std::isdigit((unsigned char)name[0]) &&
                       std::isdigit((unsigned char)name[1]) && name[2] == '-' && name.ends_with(".ply");
    if (stage && name > last && entry.is_regular_file() && entry.file_size() > 0) last = name;
  }
  if (last.empty()) throw BadInput(path + ": the folder holds no intermediate of mremesh --keep");
  return (std::filesystem::path(path) / last).string();
}

void report(Io& io, Options& o) {
  if (!o.require.empty()) parse_contract(o.require);
  if (o.results.empty()) o.results = {"-"};
  Page page;
  if (!o.times.empty()) page.times = parse_times(read_bytes(o.times));
  page.command = o.command;
  for (const std::string& result : o.results) {
    Stream stream;
    io.input = last_intermediate(result);
    if (page.items.empty())
      std::swap(stream, io.read());
    else
      stream = io.read(io.input);
    const std::string name =
        io.input == "-" ? "standard input" : std::filesystem::path(io.input).filename().string();
    if (o.status != 0 && o.status != 6)
      page.error = "status " + std::to_string(o.status) + "; this is " + name;
    page.items.push_back(item_of(io, stream, o.title.empty() || o.results.size() > 1 ? name : o.title, o));
  }
  page.title = !o.title.empty()         ? o.title
               : page.items.size() == 1 ? page.items[0].name
                                        : std::to_string(page.items.size()) + " meshes";
  io.report = json_of(page);
  io.write_bytes(html_of(page));
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  auto add_options = [&](CLI::App& app) {
    app.add_option("RESULT", o.results,
                   "results, intermediates, or folders of mremesh --keep; - is standard input")
        ->type_name("");
    app.add_option("--reference", o.reference, "the surface to compare with (default: the one in the stream)")
        ->type_name("FILE");
    app.add_option("--require", o.require,
                   "the contract, see mcheck(1) (default: that of mcheck in the stream's history)")
        ->type_name("LIST");
    app.add_option("--max-error", o.max_error, "also require hausdorff=E")
        ->check(positive_number())
        ->type_name("E");
    app.add_option("--samples", o.samples, "points on each surface for the distance (default 10000)")
        ->check(CLI::Range(1, 100000000));
    app.add_option("--title", o.title, "heading of the page (default: the name of the file)");
    app.add_option("--times", o.times, "show stage times: lines PROGRAM USER SYSTEM ELAPSED, in seconds")
        ->type_name("FILE");
    app.add_option("--command", o.command, "show this command line");
    app.add_option("--status", o.status, "show that the run ended with this status")
        ->check(CLI::Range(0, 255))
        ->type_name("N");
  };
  return run_tool(
      argc, argv, "mreport",
      "Show results or intermediates as one HTML page with a 3-D view; it needs no network.\n\nexamples:\n"
      "  mremesh -q --triangles 6000 tree.stl -o mesh.ply && mreport mesh.ply -o mesh.html\n"
      "  mclean -q tree.stl | mpartition | mmultiscale | mparam | mreport -o charts.html",
      add_options, [&](Io& io) { report(io, o); }, {.reads = false, .writes = ".html .htm"});
}
