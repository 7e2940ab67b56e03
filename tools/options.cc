// SPDX-License-Identifier: BSD-3-Clause
#include "tools/options.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "lib/core/number.h"

namespace meshpipe {
namespace {

constexpr const char* common_group = "Common options";

struct PlainHelp : CLI::Formatter {
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

void use_plain_help(CLI::App& app) {
  app.formatter(std::make_shared<PlainHelp>());
  app.get_formatter()->column_width(34);
}

void add_common_options(CLI::App& app, CommonOptions& options, const std::string& program, bool reads_file) {
  app.option_defaults()->group(common_group);
  if (reads_file)
    app.add_option("FILE", options.input, "input: the stream or any mesh format; - is standard input")
        ->type_name("");
  app.add_option("-o,--output", options.output, "write to this file instead of standard output")
      ->type_name("FILE");
  auto* ascii = app.add_flag("--ascii", options.ascii, "write text");
  app.add_flag("--binary", options.binary, "write binary")->excludes(ascii);
  app.add_option("-j,--threads", options.threads, "threads; the result does not depend on it")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  app.add_flag("-q,--quiet", options.quiet, "say nothing but errors");
  app.add_flag("-v,--verbose", options.verbose, "say more");
  app.add_option("--json", options.json, "write the report to this file; - is standard output, if -o is not")
      ->type_name("FILE");
  app.set_version_flag("--version", program + " " MESHPIPE_VERSION " (mply 1.0)");
  app.get_option("--version")->description("the version, and that of the stream")->group(common_group);
  app.set_help_flag("-h,--help", "this text");
  app.get_option("--help")->group(common_group);
}

std::string recorded_options(const CLI::App& app) {
  std::string out;
  for (const CLI::Option* o : app.get_options()) {
    if (o->count() == 0 || o->get_group() != recorded_group) continue;
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

CLI::Validator positive_number() {
  return {[](std::string& text) {
            double x = 0;
            const bool good = CLI::detail::lexical_cast(text, x) && std::isfinite(x) && x > 0;
            return good ? std::string() : "'" + text + "' is not a positive number";
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
