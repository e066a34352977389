// SPDX-License-Identifier: MIT
// One number or range per line: easy to write for tools and people.
#include "cooker/scene/hidden_faces.h"

#include <algorithm>

#include <fmt/format.h>

#include "cooker/text/number_of.h"

namespace boxtree::cooker {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::optional<FaceRange> range_of(std::string_view text) {
  const std::size_t dash = text.find('-');
  const auto first = number_of<std::uint32_t>(trimmed(text.substr(0, dash)));
  const auto last = dash == std::string_view::npos
                        ? first
                        : number_of<std::uint32_t>(trimmed(text.substr(dash + 1)));
  if (!first || !last || *last < *first) return std::nullopt;
  return FaceRange{*first, *last};
}

}  // namespace

Result<std::vector<FaceRange>> parse_hidden_faces(std::string_view text, std::string_view list) {
  std::vector<FaceRange> ranges;
  for (std::uint32_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    line = trimmed(line.substr(0, line.find('#')));
    if (line.empty()) continue;
    const auto range = range_of(line);
    if (!range) {
      return Error{Errc::kProfileInvalid,
                   fmt::format("{}:{}: expected the number of a face, or a range as 12-40, found "
                               "\"{}\"",
                               list, number, line)};
    }
    ranges.push_back(*range);
  }
  std::sort(ranges.begin(), ranges.end(),
            [](const FaceRange& a, const FaceRange& b) { return a.first < b.first; });
  std::vector<FaceRange> joined;
  for (const FaceRange& range : ranges) {
    // In 64 bits: the last number has no successor in 32.
    if (!joined.empty() && range.first <= std::uint64_t{joined.back().last} + 1) {
      joined.back().last = std::max(joined.back().last, range.last);
    } else {
      joined.push_back(range);
    }
  }
  return joined;
}

bool is_hidden(const std::vector<FaceRange>& ascending, std::uint32_t face) {
  const auto range =
      std::partition_point(ascending.begin(), ascending.end(),
                           [&](const FaceRange& candidate) { return candidate.last < face; });
  return range != ascending.end() && range->first <= face;
}

}  // namespace boxtree::cooker
