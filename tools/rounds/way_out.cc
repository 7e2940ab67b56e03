// SPDX-License-Identifier: BSD-3-Clause
#include "tools/rounds/way_out.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "lib/core/number.h"

namespace meshpipe {
namespace {

constexpr int not_admissible = 4, goal_missed = 5, contract_missed = 6;

constexpr double beyond_repair = 100;  ///< pairs of triangles that cross, of the input or new ones

/// Over the best distance of a chain's rounds. Sizes fall less where more is allowed, and so those rounds end
/// at others: asked for 1.01 times the best, six of seven surfaces missed it, by up to 1.34 times; asked for
/// 1.5 times, a sphere of 100 triangles did; 3 times sufficed.
constexpr double distance_margin = 3;

/// A number as a message shows it, not below the value: what is at least that large still is.
std::string at_least(double x) { return shown(rounded_up(x)); }

struct Case {
  int status;
  const FailureFacts& facts;
  const std::vector<Provenance>& history;
  const Diagnosis& found;

  bool ran(const std::string& program) const {
    return std::any_of(history.begin(), history.end(), [&](const auto& p) { return p.program == program; });
  }
  bool used(const std::string& program, const std::string& option) const {
    return std::any_of(history.begin(), history.end(), [&](const Provenance& p) {
      const std::string all = ' ' + p.arguments + ' ';
      return p.program == program &&
             (all.find(' ' + option + ' ') != all.npos || all.find(' ' + option + '=') != all.npos);
    });
  }
  /// Was mfeature asked to remove less than this? What its own tolerance leaves a larger one does as well.
  bool removed_less(double width) const {
    const std::string option = "--tolerance=";
    return std::any_of(history.begin(), history.end(), [&](const Provenance& p) {
      const std::size_t at = p.program == "mfeature" ? p.arguments.find(option) : std::string::npos;
      if (at == std::string::npos) return false;
      char* end = nullptr;
      return std::strtod(p.arguments.c_str() + at + option.size(), &end) < width && *end != '%';
    });
  }
  bool missed(const char* requirement) const { return facts.requirement == requirement; }
};

/// The table: the first row that applies is named. Sizes and options that were asked for come first, then
/// defects of the input, from those with the most specific repair to mwrap, which repairs all of them but
/// loses patches, and at last what gives up a promise.
struct Row {
  bool (*applies)(const Case&);
  WayOut (*way)(const Case&);
};
const Row table[] = {
    {[](const Case& c) {
       return c.found.gaps.within > 0 && c.status >= goal_missed && !c.missed("hausdorff") &&
              !c.used("mclean", "--weld");
     },
     [](const Case& c) {
       return WayOut{"mclean --weld " + shown(c.found.gaps.within), c.found.gaps.text()};
     }},
    {[](const Case& c) {
       const double crossings = c.missed("intersections") ? c.facts.value : 0;
       return std::max(crossings, (double)c.found.intersections) > beyond_repair && !c.ran("mwrap") &&
              c.status >= goal_missed;
     },
     [](const Case& c) {
       return WayOut{"mwrap", c.missed("intersections") && c.facts.value > beyond_repair
                                  ? "these are more crossings than a repair of the input removes"
                                  : std::to_string(c.found.intersections) +
                                        " pairs of triangles of the input " + "intersect, first at " +
                                        shown(c.found.intersection)};
     }},
    {[](const Case& c) {
       return c.found.spikes > 0 && c.status >= goal_missed && !c.used("mclean", "--drop-spikes");
     },
     [](const Case& c) {
       return WayOut{"mclean --drop-spikes 5",
                     c.found.spikes == 1 ? "a vertex sticks out of the surface"
                                         : std::to_string(c.found.spikes) + " vertices stick out of it"};
     }},
    {[](const Case& c) { return c.facts.far_off; },
     [](const Case&) {
       return WayOut{"mconvert --center", "coordinates are closer together near the origin"};
     }},
    {[](const Case& c) { return c.facts.least_size > 0; },
     [](const Case& c) {
       return WayOut{"--min " + at_least(c.facts.least_size), "smaller sizes cannot be met"};
     }},
    {[](const Case& c) { return c.facts.strip_width > 0 && c.removed_less(c.facts.strip_width); },
     [](const Case& c) {
       return WayOut{"--tolerance " + at_least(c.facts.strip_width), "narrower strips are removed"};
     }},
    {[](const Case& c) { return c.missed("hausdorff") && c.used("msize", "--min"); },
     [](const Case&) {
       return WayOut{"without --min", "smaller triangles reduce the distance"};
     }},
    {[](const Case& c) { return c.missed("hausdorff") && c.used("mcheck", "--max-error"); },
     [](const Case& c) {
       return WayOut{"--max-error " + at_least(distance_margin * c.facts.value),
                     shown(c.facts.value) + " was reached"};
     }},
    {[](const Case& c) {
       return c.status >= goal_missed && c.found.weld > c.facts.narrow_width && !c.used("mclean", "--weld");
     },
     [](const Case& c) {
       return WayOut{"mclean --weld " + at_least(c.found.weld),
                     std::to_string(c.found.short_edges) +
                         " edges of the input are shorter, and no other below " + shown(c.found.next_edge)};
     }},
    {[](const Case& c) { return c.status >= goal_missed && c.found.intersections > 0 && !c.ran("mwrap"); },
     [](const Case& c) {
       const bool wrap = c.used("mclean", "--resolve") || (c.found.open && !c.found.sheets);
       return WayOut{wrap             ? "mwrap"
                     : c.found.sheets ? "mclean --resolve all"
                                      : "mclean --resolve outer",
                     std::to_string(c.found.intersections) +
                         " pairs of triangles of the input intersect, first at " +
                         shown(c.found.intersection)};
     }},
    {[](const Case& c) { return c.status >= goal_missed && c.found.sheets && !c.ran("msmooth"); },
     [](const Case&) {
       return WayOut{"--smooth", "smooths the rough lines along which sheets of labeled images meet"};
     }},
    {[](const Case& c) {
       return c.status >= goal_missed && c.found.joined && !c.found.sheets && !c.used("mclean", "--sheets");
     },
     [](const Case&) {
       return WayOut{"--sheets pair", "sheets that meet are taken apart; none of them separates two regions"};
     }},
    {[](const Case& c) { return c.found.at_border && c.used("mlines", "--keep-boundary"); },
     [](const Case&) {
       return WayOut{"without --keep-boundary", "the place is next to fixed points of the border"};
     }},
    {[](const Case& c) {
       return c.found.at_patch_border && !c.missed("creases") && !c.used("mfeature", "--merge-auto");
     },
     [](const Case&) {
       return WayOut{"--merge-auto", "the place is next to a border of patches"};
     }},
    {[](const Case& c) { return c.found.at_crease && !c.used("mfeature", "--feature-angle"); },
     [](const Case&) {
       return WayOut{"--feature-angle none", "the place is next to a crease that became a model edge"};
     }},
    {[](const Case& c) { return c.status >= goal_missed && c.used("msize", "--min"); },
     [](const Case&) {
       return WayOut{"without --min", "smaller triangles may fit"};
     }},
    {[](const Case& c) { return c.status >= goal_missed && !c.ran("mwrap") && !c.found.sheets; },
     [](const Case&) {
       return WayOut{"mwrap", "a wrap has no details below its resolution"};
     }},
    {[](const Case& c) { return c.status == contract_missed; },
     [](const Case&) {
       return WayOut{"--accept", "writes the result although it misses its contract"};
     }},
};

}  // namespace

std::optional<WayOut> way_out(int status, const FailureFacts& facts, const std::vector<Provenance>& history,
                              const Diagnosis& diagnosis) {
  if (status < not_admissible || status > contract_missed) return {};
  const Case c{status, facts, history, diagnosis};
  for (const Row& row : table)
    if (row.applies(c)) return row.way(c);
  return {};
}

}  // namespace meshpipe
