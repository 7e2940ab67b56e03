// SPDX-License-Identifier: BSD-3-Clause

#include "lib/core/lists.h"
#include "lib/solids/solids.h"

namespace meshpipe {
namespace {

std::string pair_of(const std::array<int, 2>& labels) {
  return std::to_string(labels[0]) + " and " + std::to_string(labels[1]);
}

/// The label that all triangles around the outside have: the first of -1 and 0 that is one.
int outside_label(const Solids& solids, const std::vector<std::array<int, 2>>& given) {
  int lacks[2] = {-1, -1};  // a triangle without -1, and one without 0
  for (int t = 0; t < (int)given.size(); ++t)
    if (solids.sides[t][0] == 0 || solids.sides[t][1] == 0)
      for (int label : {-1, 0})
        if (given[t][0] != label && given[t][1] != label) lacks[label + 1] = t;
  for (int label : {-1, 0})
    if (lacks[label + 1] < 0) return label;
  throw LabelsContradict("triangle " + std::to_string(lacks[1]) + " has labels " + pair_of(given[lacks[1]]) +
                         " on its sides, but one is outside, where -1 or 0 is expected");
}

}  // namespace

std::vector<int> labels_of(const Solids& solids, const std::vector<std::array<int, 2>>& given) {
  const int n = (int)given.size(), regions = (int)solids.volume.size();
  std::vector<int> label(regions, 0), from(regions, -1);
  const Lists triangles = lists_of(regions, [&](auto use) {
    for (int t = 0; t < n; ++t)
      for (int r : solids.sides[t]) use(r, t);
  });
  std::vector<int> todo{0};
  std::vector<char> known(regions, 0);
  label[0] = outside_label(solids, given);
  known[0] = 1;
  while (!todo.empty()) {
    const int r = take_last(todo);
    for (int t : triangles[r]) {
      const int other = solids.sides[t][solids.sides[t][0] == r];
      const std::array<int, 2>& pair = given[t];
      const std::string where =
          "triangle " + std::to_string(t) + " has labels " + pair_of(pair) + " on its sides, but ";
      if (pair[0] != label[r] && pair[1] != label[r])
        throw LabelsContradict(where + "triangle " + std::to_string(from[r]) +
                               " gives the region on one of them label " + std::to_string(label[r]));
      const int beyond = pair[pair[0] == label[r]];
      if (other == r && beyond != label[r])
        throw LabelsContradict(where + "they are one region: the sheet encloses nothing");
      if (known[other] && label[other] != beyond)
        throw LabelsContradict(where + "triangle " + std::to_string(from[other]) +
                               " gives the region on one of them label " + std::to_string(label[other]));
      if (known[other]) continue;
      known[other] = 1;
      label[other] = beyond;
      from[other] = t;
      todo.push_back(other);
    }
  }
  return label;
}

}  // namespace meshpipe
