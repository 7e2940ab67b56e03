// SPDX-License-Identifier: BSD-3-Clause
// The frame of every program: options, input and output, exit status.
#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "formats/stream.h"
#include "lib/core/error.h"
#include "tools/io.h"

namespace meshpipe {

/// Returns the number of triangles that the machine's memory holds in a pipeline of these programs.
double most_triangles();

/// Runs a program: parses the common options and those that `options` adds, runs `body`, and turns exceptions
/// into one line on standard error and the exit status. `summary` ends with the examples that --help shows.
/// The stream records all of `options` except those of other groups, such as "Reports", which must not change
/// the result.
/// -o and --json are checked before `body` runs; call Io::expect_report for further files.
int run_tool(int argc, char** argv, const char* program, const char* summary,
             const std::function<void(CLI::App&)>& options, const std::function<void(Io&)>& body,
             Usage usage = {});

}  // namespace meshpipe
