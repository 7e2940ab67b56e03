// SPDX-License-Identifier: BSD-3-Clause
#include "tools/rounds/rounds.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>

#include "lib/core/number.h"

namespace meshpipe {
namespace {

std::string shown_or_dash(double x) { return std::isnan(x) ? "-" : shown(x); }

/// "kappa 0.03 0.1 12 0 1 2": requirement, value, limit, triangle, place; - for what there is not.
std::string failure_line(const Failure& f) {
  return f.requirement + ' ' + shown_or_dash(f.value) + ' ' + shown_or_dash(f.limit) + ' ' +
         (f.triangle < 0 ? "-" : std::to_string(f.triangle)) + ' ' + shown_or_dash(f.place.x) + ' ' +
         shown_or_dash(f.place.y) + ' ' + shown_or_dash(f.place.z);
}

}  // namespace

std::optional<Score> score_of(const Failure& failure) {
  if (std::isnan(failure.value)) return {};
  // rounded as shown: a difference that nobody sees is no progress
  const double value = std::strtod(shown(failure.value).c_str(), nullptr);
  if (failure.requirement == "kappa") return Score{failure.requirement, value};
  for (const char* less : {"intersections", "folds", "patches", "hausdorff", "deviation"})
    if (failure.requirement == less) return Score{failure.requirement, -value};
  return {};
}

std::vector<Score> scores_in(std::string_view verdict) {
  std::vector<Score> rounds;
  while (!verdict.empty()) {
    const std::string_view line = verdict.substr(0, verdict.find('\n'));
    verdict.remove_prefix(std::min(line.size() + 1, verdict.size()));
    if (line.starts_with("round=")) rounds.emplace_back();
    if (!line.starts_with("score=") || rounds.empty()) continue;
    const std::size_t blank = line.find(' ');
    if (blank == line.npos) continue;
    rounds.back() = {std::string(line.substr(6, blank - 6)),
                     std::strtod(std::string(line.substr(blank + 1)).c_str(), nullptr)};
  }
  return rounds;
}

std::vector<double> numbers_in(std::string_view verdict, const std::string& key) {
  const std::string start = '\n' + key + '=';
  std::vector<double> numbers;
  for (std::size_t at = 0; (at = verdict.find(start, at)) != verdict.npos;) {
    at += start.size();
    numbers.push_back(std::strtod(std::string(verdict.substr(at, 40)).c_str(), nullptr));
  }
  return numbers;
}

bool has_outgrown(std::string_view verdict, double triangles, double next) {
  std::vector<double> rounds = numbers_in(verdict, "triangles");
  rounds.push_back(triangles);
  const double later = std::accumulate(rounds.begin() + 1, rounds.end(), 0.0);
  const double most = most_growth * std::max(rounds[0], small_result);
  return later > most || later + next > most_refined_growth * most;
}

bool another_round(const std::vector<Score>& rounds, int most) {
  if ((int)rounds.size() >= most) return false;
  std::map<std::string, double> best;
  int vain = 0;
  for (const Score& s : rounds) {
    const auto [at, first] = best.try_emplace(s.requirement, s.value);
    if (s.requirement.empty() || first || s.value > at->second) {
      vain = 0;
      at->second = s.value;
    } else if (++vain == most_vain_rounds) {
      return false;
    }
  }
  return true;
}

bool is_repeated(std::string_view verdict, const Outcome& outcome) {
  if (!(outcome.refined > 0) || outcome.failures.empty()) return false;
  if (!outcome.bounded_distance && outcome.faulty > many_faulty) return false;
  if (outcome.bounded_distance
          ? outcome.refined > std::max(most_refined, most_refined_at_once * outcome.triangles)
          : has_outgrown(verdict, outcome.triangles, outcome.refined))
    return false;
  std::vector<Score> rounds = scores_in(verdict);
  rounds.push_back(score_of(outcome.failures[0]).value_or(Score{}));
  return another_round(rounds, outcome.bounded_distance ? most_rounds_for_distance : most_rounds);
}

std::string verdict_block(std::string_view verdict, const Outcome& outcome) {
  std::optional<Score> score;
  if (!outcome.failures.empty()) score = score_of(outcome.failures[0]);
  const int round = (int)scores_in(verdict).size() + 1;
  const bool free = outcome.bounded_distance || round > rounds_of_count;
  std::string block = "round=" + std::to_string(round) + "\nstatus=" + std::to_string(outcome.status) +
                      "\nprogram=" + outcome.program + "\nmessage=" + outcome.message + '\n';
  for (const Failure& f : outcome.failures) block += "failure=" + failure_line(f) + '\n';
  if (outcome.mean_size > 0) block += "size=" + shown(outcome.mean_size) + '\n';
  if (outcome.triangles > 0) block += "triangles=" + shown(outcome.triangles) + '\n';
  if (score) block += "score=" + score->requirement + ' ' + shown(score->value) + '\n';
  block += std::string("count=") + (free ? "free" : "kept") + '\n';
  return block + "next=" + (is_repeated(verdict, outcome) ? "refine" : "stop") + '\n';
}

}  // namespace meshpipe
