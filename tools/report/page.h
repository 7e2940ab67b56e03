// SPDX-License-Identifier: BSD-3-Clause
// mreport's page: one HTML file that needs no other.
#pragma once
#include "tools/report/page_item.h"

namespace meshpipe {

extern const char* const page_css;
extern const char* const viewer_js;

/// Processor and elapsed time of one program, in seconds.
struct StageTime {
  std::string program;
  double user = 0, system = 0, elapsed = 0;
};

/// Parses lines "PROGRAM USER SYSTEM ELAPSED"; other lines are left out.
std::vector<StageTime> parse_times(std::string_view text);

struct Page {
  std::string title, command, error;  ///< the last two may be empty: the command line, and what ended it
  std::vector<StageTime> times;
  std::vector<PageItem> items;
};

/// Returns the page. The same page gives the same bytes.
std::string html_of(const Page& page);

/// Returns the report inside the page, which --json writes, too.
nlohmann::ordered_json json_of(const Page& page);

}  // namespace meshpipe
