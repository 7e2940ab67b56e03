// SPDX-License-Identifier: BSD-3-Clause
#include "tools/rounds/rounds.h"

#include <gtest/gtest.h>

namespace meshpipe {
namespace {

Outcome outcome_missing(const std::string& requirement, double value) {
  Outcome o;
  o.status = 6;
  o.program = "mcheck";
  o.message = "contract missed";
  o.failures = {{requirement, "fact", value, 0.1, 12, {0, 1, 2}}};
  o.refined = 1e4;
  return o;
}

/// The verdict after rounds that fail with these figures; with a bounded distance there may be more of them.
std::string verdict_of(const std::vector<std::pair<const char*, double>>& rounds, bool bounded = true) {
  std::string text;
  for (const auto& [requirement, value] : rounds) {
    Outcome o = outcome_missing(requirement, value);
    o.bounded_distance = bounded;
    text += verdict_block(text, o);
  }
  return text;
}

bool asks_for_another(const std::string& verdict) { return verdict.ends_with("next=refine\n"); }

TEST(rounds, a_block_has_one_line_per_fact) {
  EXPECT_EQ(verdict_block("", outcome_missing("kappa", 0.03)),
            "round=1\nstatus=6\nprogram=mcheck\nmessage=contract missed\nfailure=kappa 0.03 0.1 12 0 1 2\n"
            "score=kappa 0.03\ncount=kept\nnext=refine\n");
  EXPECT_EQ(verdict_block("", Outcome{}), "round=1\nstatus=0\nprogram=\nmessage=\ncount=kept\nnext=stop\n");
  Outcome upstream;
  upstream.status = 5, upstream.program = "mrelax", upstream.message = "mrelax failed before this";
  EXPECT_EQ(verdict_block("round=1\nscore=kappa 0.03\n", upstream),
            "round=2\nstatus=5\nprogram=mrelax\nmessage=mrelax failed before this\ncount=free\nnext=stop\n");
}

TEST(rounds, two_in_a_row_without_progress_are_the_last) {
  EXPECT_TRUE(asks_for_another(verdict_of({{"kappa", 0.01}, {"kappa", 0.02}, {"kappa", 0.015}})));
  EXPECT_FALSE(
      asks_for_another(verdict_of({{"kappa", 0.01}, {"kappa", 0.02}, {"kappa", 0.015}, {"kappa", 2e-2}})));
  EXPECT_TRUE(asks_for_another(
      verdict_of({{"kappa", 0.01}, {"kappa", 0.02}, {"kappa", 0.015}, {"kappa", 0.021}, {"kappa", 0.02}})));
}

TEST(rounds, fewer_pairs_are_progress_and_requirements_are_compared_with_themselves) {
  const std::vector<std::pair<const char*, double>> rounds{
      {"intersections", 5}, {"folds", 6}, {"intersections", 1}, {"intersections", 15}};
  EXPECT_TRUE(asks_for_another(verdict_of(rounds)));
  auto more = rounds;
  more.push_back({"folds", 7});
  EXPECT_FALSE(asks_for_another(verdict_of(more)));
}

TEST(Rounds, ManyFaultyTrianglesAreTheLast) {
  for (bool bounded : {false, true}) {
    Outcome o = outcome_missing("kappa", 0.01);
    o.bounded_distance = bounded;
    o.faulty = 30;
    EXPECT_TRUE(is_repeated("", o));
    o.faulty = 31;
    EXPECT_EQ(is_repeated("", o), bounded);
  }
}

TEST(rounds, a_difference_beyond_six_digits_is_no_progress) {
  EXPECT_FALSE(
      asks_for_another(verdict_of({{"kappa", 0.01}, {"kappa", 0.01 + 1e-9}, {"kappa", 0.01 + 2e-9}})));
}

TEST(rounds, requirements_without_a_score_go_on_until_the_rounds_are_over) {
  for (bool bounded : {false, true}) {
    const int most = bounded ? most_rounds_for_distance : most_rounds;
    std::vector<std::pair<const char*, double>> rounds(most - 1, {"vertices", 0.5});
    EXPECT_TRUE(asks_for_another(verdict_of(rounds, bounded)));
    rounds.push_back({"vertices", 0.1});
    EXPECT_FALSE(asks_for_another(verdict_of(rounds, bounded)));
  }
}

TEST(rounds, without_refined_sizes_there_is_no_other) {
  Outcome o = outcome_missing("kappa", 0.01);
  o.refined = 0;
  EXPECT_FALSE(is_repeated("", o));
}

TEST(rounds, the_count_is_given_up_after_two_rounds_or_for_a_distance) {
  EXPECT_NE(verdict_block("", outcome_missing("kappa", 0.01)).find("count=kept"), std::string::npos);
  const std::string one = verdict_of({{"kappa", 0.01}}, false);
  EXPECT_EQ(one.find("count=free"), std::string::npos);
  EXPECT_NE(verdict_block(one, outcome_missing("kappa", 0.03)).find("count=free"), std::string::npos);
  Outcome o = outcome_missing("hausdorff", 0.01);
  o.bounded_distance = true;
  EXPECT_NE(verdict_block("", o).find("count=free"), std::string::npos);
}

}  // namespace
TEST(Rounds, SizesAndTrianglesAreKnownLater) {
  Outcome first, second;
  first.mean_size = 0.25, second.mean_size = 0.125;
  first.triangles = 1e4;
  std::string verdict = verdict_block("", first);
  verdict += verdict_block(verdict, second);
  EXPECT_EQ(numbers_in(verdict, "size"), (std::vector<double>{0.25, 0.125}));
  EXPECT_EQ(numbers_in(verdict, "triangles"), std::vector<double>{1e4});
  EXPECT_TRUE(numbers_in("", "size").empty());
}

TEST(Rounds, TrianglesMayNotMultiply) {
  auto round = [](double triangles) {
    Outcome o = outcome_missing("kappa", 0.01);
    o.triangles = triangles;
    return o;
  };
  const std::string one = verdict_block("", round(2e4));
  EXPECT_FALSE(has_outgrown("", 1e6, 4e6)) << "the first round";
  EXPECT_FALSE(has_outgrown(one, 4e4, 4e4));
  EXPECT_TRUE(has_outgrown(one, 4.1e4, 1));
  EXPECT_FALSE(is_repeated(one, round(4.1e4)));
  EXPECT_TRUE(has_outgrown("", 2e4, 9e4)) << "by the sizes of the next";
  Outcome far = outcome_missing("hausdorff", 0.01);
  far.bounded_distance = true, far.triangles = 1e5, far.refined = 9e5;
  EXPECT_TRUE(is_repeated("", far));
  far.refined = 1.1e6;
  EXPECT_FALSE(is_repeated("", far));
  far.triangles = 3e5;
  EXPECT_TRUE(is_repeated("", far)) << "not many for what it has";
  EXPECT_TRUE(has_outgrown(one + verdict_block(one, round(2.1e4)), 2e4, 1)) << "both together";
  EXPECT_FALSE(has_outgrown(verdict_block("", round(100)), 2 * small_result, 1)) << "cheap in any case";
}

TEST(Rounds, FewerPatchesOfAnotherExtentAreProgress) {
  auto score = [](double patches) {
    return score_of(outcome_missing("patches", patches).failures[0]).value();
  };
  EXPECT_TRUE(another_round({score(2), score(1), score(1)}, 9));
  EXPECT_FALSE(another_round({score(2), score(2), score(2)}, 9));
}

}  // namespace meshpipe
