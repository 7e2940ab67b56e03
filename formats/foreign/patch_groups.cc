// SPDX-License-Identifier: BSD-3-Clause
#include "formats/foreign/patch_groups.h"

#include <fnmatch.h>

#include <algorithm>

#include "formats/text.h"
#include "lib/core/lists.h"

namespace meshpipe {
namespace {

/// Returns the words of a line; = is one.
std::vector<std::string> words_of(std::string_view line, const Text& text) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < line.size();) {
    if (line[i] == ' ' || line[i] == '\t' || line[i] == '\r') {
      ++i;
    } else if (line[i] == '"') {
      const std::size_t end = line.find('"', i + 1);
      if (end == std::string_view::npos) text.fail("a quote that does not end");
      words.emplace_back(line.substr(i + 1, end - i - 1));
      i = end + 1;
    } else {
      const std::size_t end = std::min(line.find_first_of(" \t\r\"", i), line.size());
      words.emplace_back(line.substr(i, end - i));
      i = end;
    }
  }
  return words;
}

/// Returns the labels of the patches that a word names, ascending.
std::vector<int> patches_of_word(const std::string& word, const std::vector<int>& labels,
                                 const Stream& stream) {
  std::vector<int> found;
  for (int label : labels)
    if (const std::string name = stream.name_of(2, label);
        !name.empty() && fnmatch(word.c_str(), name.c_str(), 0) == 0)
      found.push_back(label);
  // patches without a name go by their number
  if (word.find_first_of("*?[") != std::string::npos)
    for (int label : labels)
      if (stream.name_of(2, label).empty() && fnmatch(word.c_str(), std::to_string(label).c_str(), 0) == 0)
        found.push_back(label);
  long long number = 0;
  if (found.empty() && parse_integer(word, number))
    for (int label : labels)
      if (label == number) found.push_back(label);
  return found;
}

/// Returns whether a word names a patch that lost all faces in cleaning.
bool is_lost(const std::string& word, const Stream& stream) {
  return std::any_of(stream.names.begin(), stream.names.end(), [&](const Name& n) {
    return n.dim == 2 && fnmatch(word.c_str(), n.text.c_str(), 0) == 0;
  });
}

}  // namespace

std::vector<PatchGroup> read_groups(std::string_view bytes, const std::string& where, const Stream& stream) {
  std::vector<int> labels;
  if (stream.surface.face.has("patch")) labels = stream.surface.face.get<int>("patch");
  sort_unique(labels);
  Text text(bytes, where);
  std::vector<PatchGroup> groups;
  std::vector<std::pair<std::string, std::size_t>> named;  // and on which line
  while (text.next_line()) {
    const std::string_view line = text.rest();
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> words = words_of(line, text);
    PatchGroup group;
    if (words.size() > 1 && words[1] == "=") {
      group.name = words[0];
      for (const auto& [name, line_number] : named)
        if (name == group.name)
          text.fail("group " + quoted(name) + " again, which line " + std::to_string(line_number) + " has");
      named.emplace_back(group.name, text.line());
      words.erase(words.begin(), words.begin() + 2);
    }
    for (const std::string& word : words) {
      const std::vector<int> found = patches_of_word(word, labels, stream);
      if (found.empty() && !is_lost(word, stream))
        text.fail("no patch has the name or number " + quoted(word));
      group.patches.insert(group.patches.end(), found.begin(), found.end());
    }
    if (words.empty()) text.fail("a group of 0 patches");
    if (!group.patches.empty()) groups.push_back(std::move(group));
  }
  return groups;
}

}  // namespace meshpipe
