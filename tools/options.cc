// SPDX-License-Identifier: BSD-3-Clause
#include "tools/options.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "lib/core/number.h"

namespace meshpipe {
namespace {

constexpr const char* common_group = "Common options";
constexpr std::size_t help_width = 100;  // columns: two windows of this width fit on a wide screen
constexpr std::size_t text_column = 28;  // where the texts of options start

/// Breaks a text at blanks, so that its lines fit into help_width. All but the first get `indent` blanks in
/// front.
std::string wrapped(const std::string& text, std::size_t indent) {
  std::string out;
  std::size_t column = indent;
  std::istringstream words(text);
  for (std::string word; words >> word; column += word.size()) {
    const bool fits = column + 1 + word.size() <= help_width;
    if (!out.empty()) out += fits ? " " : '\n' + std::string(indent, ' ');
    column = fits ? column + !out.empty() : indent;
    out += word;
  }
  return out;
}

struct PlainHelp : CLI::Formatter {
  PlainHelp() { label("Positionals", "Arguments"); }

  /// The usage comes first, the examples, with which descriptions end, come last.
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    const std::string text = app->get_description();
    const std::size_t examples = std::min(text.find("\n\nExample"), text.size());
    const std::string arguments = make_positionals(app);
    return make_usage(app, std::move(name)) + '\n' + wrapped(text.substr(0, examples), 0) + "\n\n" +
           arguments + (arguments.empty() ? "" : "\n") + make_groups(app, mode) +
           text.substr(std::min(examples + 1, text.size())) + '\n';
  }

  std::string make_group(std::string group, bool is_positional,
                         std::vector<const CLI::Option*> options) const override {
    group += ":\n";
    for (const CLI::Option* o : options) group += make_option(o, is_positional);
    return group;
  }

  std::string make_option(const CLI::Option* o, bool is_positional) const override {
    std::string line = "  " + make_option_name(o, is_positional) + make_option_opts(o);
    if (line.size() + 2 > text_column)
      line += '\n' + std::string(text_column, ' ');
    else
      line.resize(text_column, ' ');
    return line + wrapped(make_option_desc(o), text_column) + '\n';
  }

  std::string make_option_opts(const CLI::Option* o) const override {
    if (o->get_type_size() == 0) return "";
    const std::string text = o->get_type_name();  // the type, and after a colon the checks
    const std::size_t colon = text.ends_with("[:NAME]") ? text.npos : text.find(':');
    const std::string type = text.substr(0, colon), check = colon == text.npos ? "" : text.substr(colon + 1);
    if (type.empty()) return "";
    if (type == "TEXT" && check.starts_with('{') && check.ends_with('}')) {
      std::string words = check.substr(1, check.size() - 2);
      std::replace(words.begin(), words.end(), ',', '|');
      return words.insert(0, " ");
    }
    std::string shown = " ";
    return shown += type == "INT" || type == "UINT" ? "N" : type == "FLOAT" ? "X" : type;
  }
};

}  // namespace

void use_plain_help(CLI::App& app) { app.formatter(std::make_shared<PlainHelp>()); }

void add_common_options(CLI::App& app, CommonOptions& options, const std::string& program, bool reads_file) {
  app.option_defaults()->group(common_group);
  if (reads_file)
    app.add_option("FILE", options.input,
                   "input: the stream or any mesh format; - (default) is standard input")
        ->type_name("");
  app.add_option("-o,--output", options.output, "write to this file instead of standard output")
      ->type_name("FILE");
  auto* ascii = app.add_flag("--ascii", options.ascii, "write the output as text");
  app.add_flag("--binary", options.binary, "write the output in binary")->excludes(ascii);
  app.add_option("-j,--threads", options.threads, "number of threads; the result does not depend on it")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  app.add_flag("-q,--quiet", options.quiet, "report errors and warnings only");
  app.add_flag("-v,--verbose", options.verbose, "report more");
  app.add_option("--json", options.json,
                 "write the report as JSON to this file; - is standard output, unless that is -o")
      ->type_name("FILE");
  app.set_version_flag("--version", program + " " MESHPIPE_VERSION " (mply 1.0)");
  app.get_option("--version")
      ->description("print the versions of the program and of the stream")
      ->group(common_group);
  app.set_help_flag("-h,--help", "print this text");
  app.get_option("--help")->group(common_group);
}

std::string recorded_options(const CLI::App& app) {
  std::string out;
  for (const CLI::Option* o : app.get_options()) {
    if (o->count() == 0 || !o->get_group().starts_with(recorded_group)) continue;
    if (!out.empty()) out += ' ';
    out += o->get_name(!o->nonpositional());
    if (o->get_expected_min() == 0) continue;
    const bool is_file = o->get_type_name().starts_with("FILE");
    char separator = '=';
    for (std::string r : o->results()) {
      if (is_file && r != "none") {  // the name of the data in the file stays
        const std::size_t colon = o->get_type_name() == "FILE[:NAME]" ? r.rfind(':') : r.npos;
        if (colon == r.npos) continue;
        r.erase(0, colon);
      }
      out += separator + r;
      separator = ',';
    }
  }
  return out;
}

std::string first_length(const CLI::App& app) {
  static const std::set<std::string> types = {
      "H", "EPS", "D", "D|P%|auto", "auto|TOL", "LENGTH", "L|P%|Kr", "EXPR", "T[,GROWTH[,N]][,outside]"};
  for (const CLI::Option* o : app.get_options()) {
    if (o->count() == 0 ||
        (!types.contains(o->get_type_name()) && o->get_name() != "--data" && o->get_name() != "--names"))
      continue;
    const std::string& value = o->results()[0];
    double zero = 1;
    if (CLI::detail::lexical_cast(value, zero) && zero == 0) continue;
    if (value != "auto" && !value.ends_with('%') && !value.ends_with('r')) return o->get_name();
  }
  return {};
}

CLI::Validator positive_number() {
  return {[](std::string& text) {
            double x = 0;
            const bool good = CLI::detail::lexical_cast(text, x) && std::isfinite(x) && x > 0;
            return good ? std::string() : "'" + text + "' is not a positive number";
          },
          ""};
}

CLI::Validator finite_number() {
  return {[](std::string& text) {
            double x = 0;
            const bool good = CLI::detail::lexical_cast(text, x) && std::isfinite(x);
            return good ? std::string() : "'" + text + "' is not a finite number";
          },
          ""};
}

CLI::Validator count_between(double least, double most) {
  return {[=](std::string& text) -> std::string {
            double x = 0;
            if (!CLI::detail::lexical_cast(text, x) || x != std::floor(x))
              return "'" + text + "' is not a whole number";
            if (x < least || x > most) {
              char limits[64];
              std::snprintf(limits, sizeof limits, "%.0f to %.0f", least, most);
              return "'" + text + "' is not in the range " + limits;
            }
            return {};
          },
          ""};
}

std::optional<double> parse_length(std::string_view text, double diagonal) {
  double value = 0;
  const bool percent = text.ends_with('%');
  const char* end = text.data() + text.size() - percent;
  const auto [at, error] = from_chars(text.data(), end, value);
  if (error != std::errc() || at != end || !(value >= 0) || !std::isfinite(value)) return {};
  return percent ? value / 100 * diagonal : value;
}

}  // namespace meshpipe
