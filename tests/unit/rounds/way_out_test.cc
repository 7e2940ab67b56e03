// SPDX-License-Identifier: BSD-3-Clause
#include "tools/rounds/way_out.h"

#include <gtest/gtest.h>

using namespace meshpipe;

namespace {

constexpr int refused = 4, unreached = 5, missed = 6;

std::string named(int status, const FailureFacts& facts, const Diagnosis& found,
                  const std::vector<Provenance>& history = {}) {
  const auto way = way_out(status, facts, history, found);
  return way ? way->what : "";
}

}  // namespace

TEST(WayOut, NamesTheRepairOfWhatIsMeasured) {
  Diagnosis found;
  EXPECT_EQ(named(missed, {}, found), "mwrap");
  found.at_crease = true;
  EXPECT_EQ(named(missed, {}, found), "--feature-angle none");
  found.at_patch_border = true;
  EXPECT_EQ(named(missed, {}, found), "--merge-auto");
  FailureFacts creases;  // which no patch has cut off
  creases.requirement = "creases";
  EXPECT_NE(named(missed, creases, found), "--merge-auto");
  found.joined = true;
  EXPECT_EQ(named(missed, {}, found), "--sheets pair");
  found.sheets = true;
  EXPECT_EQ(named(missed, {}, found), "--smooth");
  found.intersections = 3;
  EXPECT_EQ(named(missed, {}, found), "mclean --resolve all");  // what bounds the outside is not all
  found.joined = found.sheets = false;
  EXPECT_EQ(named(missed, {}, found), "mclean --resolve outer");
  found.weld = 2.3456e-7;
  EXPECT_EQ(named(missed, {}, found), "mclean --weld 2.35e-07");
  found.spikes = 1;
  EXPECT_EQ(named(missed, {}, found), "mclean --drop-spikes 5");
}

TEST(WayOut, NamesWhatHelpsWhereSizesFailed) {
  Diagnosis found;
  found.weld = 1e-7;
  FailureFacts facts;
  facts.narrow_width = 3;  // what is to be welded is not what is slender
  EXPECT_EQ(named(unreached, facts, found), "mwrap");
  facts = sizes_from(4);
  EXPECT_EQ(named(unreached, facts, found), "--min 4");
  facts.far_off = true;
  EXPECT_EQ(named(unreached, facts, found), "mconvert --center");
}

TEST(WayOut, ManyCrossingsAreForAWrap) {
  Diagnosis found;
  found.spikes = 1;
  FailureFacts crossings;
  crossings.requirement = "intersections";
  crossings.value = 12;
  EXPECT_EQ(named(missed, crossings, found), "mclean --drop-spikes 5");
  crossings.value = 1200;
  EXPECT_EQ(named(missed, crossings, found), "mwrap");
  found.gaps = {3600, 3600, 0.003};  // triangles of a soup cross at their borders
  EXPECT_EQ(named(missed, crossings, found), "mclean --weld 0.003");
  found.gaps = {};
  crossings.value = 12;
  found.intersections = 1200;  // of the input
  EXPECT_EQ(named(missed, crossings, found), "mwrap");
}

TEST(WayOut, NamesNothingThatWasTried) {
  Diagnosis found;
  found.weld = 1e-7;
  found.intersections = 3;
  found.at_crease = true;
  std::vector<Provenance> history{{"mclean", "", "--weld=1e-06"}};
  EXPECT_EQ(named(missed, {}, found, history), "mclean --resolve outer");
  history.push_back({"mclean", "", "--resolve=outer"});
  EXPECT_EQ(named(missed, {}, found, history), "mwrap");
  history.push_back({"mwrap", "", ""});
  EXPECT_EQ(named(missed, {}, found, history), "--feature-angle none");
  history.push_back({"mfeature", "", "--feature-angle=none"});
  EXPECT_EQ(named(missed, {}, found, history), "--accept");
  EXPECT_EQ(named(unreached, {}, found, history), "");
}

TEST(WayOut, AsksToLeaveOutAnOptionThatStandsInTheWay) {
  Diagnosis found;
  found.at_border = true;
  EXPECT_EQ(named(missed, {}, found, {{"mlines", "", "--keep-boundary"}}), "without --keep-boundary");
  FailureFacts facts;
  facts.requirement = "hausdorff";
  facts.value = 0.0123456;
  EXPECT_EQ(named(missed, facts, {}, {{"msize", "", "--size=1 --min=0.5"}}), "without --min");
  EXPECT_EQ(named(missed, facts, {}, {{"mcheck", "", "--max-error=0.001"}}), "--max-error 0.0371");
}

TEST(WayOut, KnowsWhatCanBeMet) {
  EXPECT_EQ(named(unreached, sizes_from(0.12345), {}), "--min 0.124");
  EXPECT_EQ(named(refused, {}, {}), "");  // the message says which program to run first
  EXPECT_EQ(named(3, {}, {}), "");
}

TEST(WayOut, RemovesStripsThatCostTooMuch) {
  FailureFacts facts;
  facts.strip_width = 0.02;
  EXPECT_EQ(named(unreached, facts, {}), "mwrap");
  EXPECT_EQ(named(unreached, facts, {}, {{"mfeature", "", "--tolerance=0"}}), "--tolerance 0.02");
  EXPECT_EQ(named(unreached, facts, {}, {{"mfeature", "", "--size=1 --tolerance=0.01"}}), "--tolerance 0.02");
  EXPECT_EQ(named(unreached, facts, {}, {{"mfeature", "", "--tolerance=0.03"}}), "mwrap");
}
