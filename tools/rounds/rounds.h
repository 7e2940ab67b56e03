// SPDX-License-Identifier: BSD-3-Clause
// The machine-readable outcome of mcheck: what failed, where, by how much, and whether refined sizes may
// help. One block of lines `key=value` per round, appended, so that the scores of earlier rounds are known.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lib/check/check.h"

namespace meshpipe {

/// How well a round met its first failed requirement: larger is better.
struct Score {
  std::string requirement;
  double value = 0;
};

/// The outcome of one run of mcheck.
struct Outcome {
  int status = 0;
  std::string program, message;   ///< the program that failed, and its error
  std::vector<Failure> failures;  ///< in the order of the contract
  double mean_size = 0;           ///< of the result, see Findings
  double triangles = 0;           ///< of the result
  double faulty = 0;              ///< triangles of the result at which the contract fails
  double refined = 0;  ///< triangles that sizes which may meet the contract ask for; 0: none were written
  bool bounded_distance = false;  ///< a distance is required: the number of triangles follows from it
};

/// The number of rounds of a chain at most: the whole takes about three times as long as the first at most.
/// What is not met by then hardly ever was, except a distance.
constexpr int most_rounds = 3, most_rounds_for_distance = 6;
/// No other round starts once those after the first have made this many times its triangles (or times
/// `small_result`, where that is more): sizes that fall and fall do not help.
constexpr double most_growth = 2, small_result = 15000;
/// Nor if refined sizes ask for this many times more; for a distance, for this many triangles, and for
/// several times those that there are.
constexpr double most_refined_growth = 2, most_refined = 1e6, most_refined_at_once = 4;
/// The verdicts of this many rounds keep the number of triangles asked for, so that two rounds aim at it;
/// later ones give it up: it stands in the way of smaller sizes.
constexpr int rounds_of_count = 1;
/// After this many rounds in a row that are no better than an earlier one, there is no further round (which
/// most_rounds says before it, unless a distance is required).
constexpr int most_vain_rounds = 2;
/// Nor is there one where more triangles are faulty, except for a distance: smaller sizes only crumple the
/// mesh there. Of 25 spoiled surfaces that missed the contract, no later round met it from more than six.
constexpr double many_faulty = 30;

/// Returns the score of a failure. None for requirements without an order (topology, patches) or never seen
/// to stall.
std::optional<Score> score_of(const Failure& failure);

/// Returns the scores of the rounds in a verdict's text, an empty requirement where a round has none.
std::vector<Score> scores_in(std::string_view verdict);

/// Returns the numbers of the lines "key=number" in a verdict's text.
std::vector<double> numbers_in(std::string_view verdict, const std::string& key);

/// Returns whether this many triangles, added to those of the rounds in a verdict's text, are too many for
/// another round, which makes `next` more of them.
bool has_outgrown(std::string_view verdict, double triangles, double next);

/// Returns whether the last of these rounds is worth another. `most`: how many there may be.
bool another_round(const std::vector<Score>& rounds, int most);

/// Returns whether the chain is to be repeated after this round, with refined sizes. `verdict` as below.
bool is_repeated(std::string_view verdict, const Outcome& outcome);

/// Returns the block of a round to append to the verdict, see mcheck(1). `verdict`: the text of the rounds
/// before it.
std::string verdict_block(std::string_view verdict, const Outcome& outcome);

}  // namespace meshpipe
