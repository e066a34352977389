// SPDX-License-Identifier: MIT
#include "cooker/text/nearest_name.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace boxtree::cooker {

std::size_t edit_distance(std::string_view from, std::string_view to) {
  // Rows of the table of distances between the first i letters of one word and the first j of the
  // other.
  std::vector<std::size_t> before_last(to.size() + 1), last(to.size() + 1), row(to.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= from.size(); ++i) {
    before_last.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= to.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (from[i - 1] == to[j - 1] ? 0u : 1u);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && from[i - 1] == to[j - 2] && from[i - 2] == to[j - 1]) {
        row[j] = std::min(row[j], before_last[j - 2] + 1);
      }
    }
  }
  return row.back();
}

std::string nearest_name(std::string_view name, std::span<const std::string> names) {
  const auto nearest =
      std::min_element(names.begin(), names.end(), [name](const auto& a, const auto& b) {
        // Of those that one mistake is enough for, first what begins alike: fewer are at the first
        // letter.
        const auto mistakes = [name](const std::string& of) {
          const std::size_t distance = edit_distance(name, of);
          return std::pair(distance, distance == 1 && of.substr(0, 1) != name.substr(0, 1));
        };
        return mistakes(a) < mistakes(b);
      });
  return nearest == names.end() ? std::string() : *nearest;
}

std::string meant_name(std::string_view name, std::span<const std::string> names,
                       std::span<const Synonym> synonyms) {
  for (const Synonym& synonym : synonyms) {
    const bool is_one =
        synonym.word == name && std::ranges::find(names, synonym.name) != names.end();
    if (is_one) return std::string(synonym.name);
  }
  const std::string nearest = nearest_name(name, names);
  const std::size_t distance = edit_distance(name, nearest);
  const bool is_near = distance <= std::max<std::size_t>(name.size() / 3, 1) &&
                       distance < std::max(name.size(), nearest.size());  // something is common
  return is_near ? nearest : std::string();
}

std::string listed(std::span<const std::string> names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
    text += names[i];
  }
  return text;
}

std::string joined(std::span<const std::string> words, std::string_view between) {
  std::string text;
  for (const std::string& word : words) {
    if (&word != words.data()) text += between;
    text += word;
  }
  return text;
}

namespace {

std::string did_you_mean(const std::string& name) {
  return "; did you mean '" + name + "'?";
}

}  // namespace

std::string suggestion(std::string_view name, std::span<const std::string> names,
                       std::span<const Synonym> synonyms) {
  const std::string meant = meant_name(name, names, synonyms);
  return meant.empty() ? meant : did_you_mean(meant);
}

std::string nearest_in_words(std::string_view name, std::span<const std::string> names,
                             std::span<const Synonym> synonyms) {
  constexpr std::size_t kMost = 32;
  if (names.empty()) return " (there are none)";
  const std::string meant = meant_name(name, names, synonyms);
  if (!meant.empty()) return " (nearest: \"" + meant + "\")";
  return names.size() > kMost ? std::string() : " (" + listed(names) + ")";
}

std::string path_suggestion(std::string_view name, std::span<const std::string> names) {
  std::string near = suggestion(name, names);
  if (!near.empty()) return near;
  const std::string end = "/" + std::string(name);
  const auto longer = std::find_if(names.begin(), names.end(),
                                   [&](const std::string& each) { return each.ends_with(end); });
  return longer == names.end() ? std::string() : did_you_mean(*longer);
}

std::string expected_if_few(std::span<const std::string> names) {
  constexpr std::size_t kMost = 8;
  return names.empty() || names.size() > kMost ? std::string() : "; expected " + listed(names);
}

}  // namespace boxtree::cooker
