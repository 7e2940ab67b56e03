// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/summary.h"

#include <cmath>

#include "lib/core/number.h"

namespace meshpipe {
namespace {

std::string cell(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
  return text.empty() ? "-" : text;
}

}  // namespace

std::string summary_heading() {
  std::string line = "output\tstatus\tfailed";
  for (const Figure& f : figures(Findings())) line += '\t' + f.key;
  return line + '\n';
}

std::string summary_line(const Summary& summary, int status) {
  std::string failed;
  for (const Failure& f : summary.failures)
    if (const std::string& name = f.requirement; (',' + failed + ',').find(',' + name + ',') == failed.npos)
      failed += (failed.empty() ? "" : ",") + name;
  std::string line = cell(summary.output) + '\t' + std::to_string(status) + '\t' + cell(failed);
  std::size_t i = 0;
  for (const Figure& f : figures(Findings())) {
    const bool known = i < summary.figures.size() && summary.figures[i].key == f.key;
    const double value = known ? summary.figures[i++].result : no_figure;
    line += '\t' + (std::isnan(value) ? "-" : shown(value));
  }
  return line + '\n';
}

}  // namespace meshpipe
