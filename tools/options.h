// SPDX-License-Identifier: BSD-3-Clause
// The options that every program has, and how options are shown and recorded.
#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace meshpipe {

struct CommonOptions {
  std::string input = "-", output = "-";
  std::string json;  ///< file of the report; empty: none
  bool ascii = false, binary = false, quiet = false, verbose = false;
  int threads = 0;  ///< 0: as OpenMP chooses
};

/// Adds the options; FILE only if the program reads one. Those that `app` already has get a better --help.
void add_common_options(CLI::App& app, CommonOptions& options, const std::string& program, bool reads_file);

/// Returns the first option of the command line that has lengths, not shares of the surface's; "" without.
std::string first_length(const CLI::App& app);

/// Returns the options of the command line that change the result, as the stream records them: those of
/// recorded_group. Left out are names of files, which depend on where the program ran.
std::string recorded_options(const CLI::App& app);
constexpr const char* recorded_group = "Options";

/// Sets the --help formatter, which leaves out what only a programmer wants to know: types, checks,
/// exclusions.
void use_plain_help(CLI::App& app);

/// Returns a check of an option's value: finite and above 0.
CLI::Validator positive_number();
/// Accepts finite numbers.
CLI::Validator finite_number();
/// Accepts whole numbers from `least` to `most`, also as 1.5e4.
CLI::Validator count_between(double least, double most);
/// Parses a length, or with % a part of `diagonal`; none if the text is neither, negative or infinite.
std::optional<double> parse_length(std::string_view text, double diagonal);

}  // namespace meshpipe
