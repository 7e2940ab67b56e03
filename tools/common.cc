// SPDX-License-Identifier: BSD-3-Clause
#include "tools/common.h"

#include <malloc.h>
#include <omp.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <new>

#include "formats/stream/lift_tables.h"
#include "formats/stream/region_tables.h"
#include "lib/check/check.h"
#include "lib/clean/clean.h"
#include "lib/core/failure_facts.h"
#include "lib/core/junctions.h"
#include "tools/files.h"
#include "tools/progress_line.h"
#include "tools/rounds/way_out.h"

namespace meshpipe {
namespace {

/// Waiting threads must not keep the other programs of a pipe from working. OpenMP reads the variable before
/// main, and after this if it is linked as an archive; mremesh sets it for the other case.
[[gnu::constructor(101)]] void wait_passively() { ::setenv("OMP_WAIT_POLICY", "passive", 0); }

/// Sets when freed memory returns to the system. The defaults raise the limit during the run.
void tune_allocation(bool keeps_all) {
  if (keeps_all) {
    ::mallopt(M_MMAP_MAX, 0);
    ::mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
    return;
  }
  // arrays above 8 MB return when freed; smaller ones are reused, which saves a quarter of the page faults of
  // a surface of 70,000 triangles
  ::mallopt(M_MMAP_THRESHOLD, 8 << 20);
  ::mallopt(M_TRIM_THRESHOLD, 1 << 20);
}

/// Reports a failure and returns its status. `failed_program` is this one or one before it in the pipe. Of a
/// pipe only the failed program and the last one speak; the others pass the failure on as the line that
/// stands for the stream.
int report_failure(const Io& io, int status, const std::string& why, const std::string& failed_program) {
  bool pass_on = io.output == "-" && !io.wrote_to_stdout && !::isatty(STDOUT_FILENO);
  if (io.on_failure)
    pass_on &= io.on_failure(status, why, failed_program);
  else if (failed_program == io.program || !pass_on)
    std::fprintf(stderr, "%s: error: %s\n", io.program.c_str(), why.c_str());
  if (pass_on) {
    const std::string line = "mply-failed " + failed_program + ' ' + std::to_string(status) + '\n';
    (void)!::write(STDOUT_FILENO, line.data(), line.size());
  }
  return status;
}

/// Runs `work` and turns exceptions into a reported failure with its exit status.
int guarded(const Io& io, const std::function<void()>& work) {
  auto failed = [&](int status, const char* why) {
    if (status == 1 || status == 7) remove_file(io.finished_file);  // its report or verdict is missing
    return report_failure(io, status, why, io.program);
  };
  try {
    work();
    return 0;
  } catch (const UpstreamFailed& e) {
    return report_failure(io, e.status, e.program + " failed before this", e.program);
  } catch (const BadUsage& e) {
    return failed(2, e.what());
  } catch (const BadInput& e) {
    return failed(3, e.what());
  } catch (const NotAdmissible& e) {
    return failed(4, e.what());
  } catch (const GoalMissed& e) {
    return failed(5, e.what());
  } catch (const ContractMissed& e) {
    return failed(6, e.what());
  } catch (const CannotWrite& e) {
    return failed(7, e.what());
  } catch (const std::bad_alloc&) {
    return failed(1, "out of memory");
  } catch (const std::exception& e) {
    return failed(1, e.what());
  }
}

void write_report(const Io& io) {
  if (!io.json.empty()) Io::write_file(io.json, io.report.dump(2) + '\n');
}

/// Returns what helps after a failure, "" or "; try ... (...)", for its message; the report gets it too.
std::string way_out_of(Io& io, const std::exception& failure, int status) {
  const bool remeshed = io.stream.find("ref_vertex");
  // a mesh that mcheck compares with any other was not made by the chain
  if (!io.names_way_out || io.stream.surface.tris.empty() || (status == 6 && !remeshed)) return "";
  const FailureFacts facts = facts_of(failure);
  Diagnosis found;
  if (status > 4) {
    Surface surface = remeshed ? read_reference(io.stream) : io.stream.surface;
    if (has_sheets(io.stream)) join_borders(surface);  // copies of a vertex are no intersections
    found = diagnose(surface, facts.place, facts.reach);
    found.joined = has_sheets(io.stream);
    if (found.joined)
      for (const SheetPatch& s : read_sheets(io.stream))
        found.sheets |= s.front > 0 && s.back > 0 && s.front != s.back;
  }
  for (const std::string& remark : io.stream.remarks) found.spikes += Spikes::parse(remark);
  found.gaps = gaps_of(io.stream.remarks);
  std::vector<Provenance> history = io.stream.history;
  history.push_back({io.program, "", io.arguments});
  const std::optional<WayOut> way = way_out(status, facts, history, found);
  if (!way) return "";
  io.report["way_out"] = {{"try", way->what}, {"because", way->why}};
  return "; try " + way->what + " (" + way->why + ")";
}

/// Returns what a message with places and lengths of the stream has to add to them, or "".
std::string unit_of(const Io& io) {
  return io.stream.unit == 0
             ? ""
             : " (coordinates and lengths are multiples of 2^" + std::to_string(io.stream.unit) + ')';
}

/// Throws: BadUsage if a file has another extension than those listed; devices and pipes have none.
void expect_extension(const std::string& path, std::string_view known) {
  const std::string extension = extension_of(path);
  if (path == "-" || (!extension.empty() && known.find(extension) != known.npos)) return;
  std::error_code error;
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)) return;
  throw BadUsage("'" + path + "' has extension '" + extension + "'; known are " + std::string(known));
}

/// Runs the body of a program between the checks of its files and its report.
void run_body(Io& io, const std::function<void(Io&)>& body, const Usage& usage) {
  io.expect_report("-o", io.output, usage.writes.empty());
  if (!usage.writes.empty()) expect_extension(io.output, usage.writes);
  if (!io.json.empty()) io.expect_report("--json", io.json);
  if (!usage.reads) set_phase(Phase::working);
  try {
    const ProgressLine line(io.program, io.quiet);
    body(io);
  } catch (const NotAdmissible& e) {
    const std::string way = way_out_of(io, e, 4);
    if (io.report.size() > 1) write_report(io);  // it was measured before
    throw NotAdmissible(e.what() + unit_of(io) + way);
  } catch (const GoalMissed& e) {
    const std::string way = way_out_of(io, e, 5);
    write_report(io);
    throw GoalMissed(e.what() + unit_of(io) + way);
  } catch (const ContractMissed& e) {
    const std::string way = way_out_of(io, e, 6);
    write_report(io);
    throw ContractMissed(e.what() + unit_of(io) + way);
  }
  write_report(io);
}

/// The parser's message as one line that continues "PROGRAM: error: ".
std::string parse_message(const CLI::ParseError& e, const std::string& program) {
  std::string why = e.what();
  std::replace(why.begin(), why.end(), '\n', ' ');
  if ('A' <= why[0] && why[0] <= 'Z' && why[1] >= 'a') why[0] += 'a' - 'A';
  return why + "; see " + program + " --help";
}

}  // namespace

double most_triangles() {
  // the largest programs of the chain take 300 bytes per triangle, and two of them hold theirs at a time
  constexpr double bytes = 600, numbered = 715827882;  // half-edges are numbered by int
  double memory =
      static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    memory = std::min(memory, static_cast<double>(limit.rlim_cur));
  return std::min(numbered, memory / bytes);
}

int run_tool(int argc, char** argv, const char* program, const char* summary,
             const std::function<void(CLI::App&)>& options, const std::function<void(Io&)>& body,
             Usage usage) {
  remove_partial_file_on_signals();
  tune_allocation(usage.passes);
  Io io;
  io.program = program;
  io.usage = usage;
  CLI::App app{summary, program};
  use_plain_help(app);
  app.option_defaults()->group(recorded_group);
  options(app);
  add_common_options(app, io, program, usage.reads);

  auto show = [&](const std::string& text) {
    return guarded(io, [&] { write_all(STDOUT_FILENO, text, "stdout"); });
  };
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return show(app.help());
  } catch (const CLI::CallForVersion& e) {
    return show(std::string(e.what()) + '\n');
  } catch (const CLI::ParseError& e) {
    return report_failure(io, 2, parse_message(e, program), program);
  }
  if (io.threads > 0) omp_set_num_threads(io.threads);
  io.arguments = recorded_options(app);
  io.length = first_length(app);
  io.report["program"] = program;
  return guarded(io, [&] { run_body(io, body, usage); });
}

}  // namespace meshpipe
