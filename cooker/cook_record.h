// SPDX-License-Identifier: MIT
// The record of how a file was made: JSON for people and build systems, stored in the file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cooker/cook.h"

namespace boxtree::cooker {

/// Tool, options and sources, without folders; a profile is recorded as a hash.
[[nodiscard]] std::string make_cook_record(const CookOptions& options, const CookInput& input,
                                           const Profile& profile);

/// What a record has of a cook without a profile: equal for equal options and sources.
struct RecordedCook {
  std::string options;               // as recorded_options() has them
  std::vector<std::string> sources;  // recorded_hash() of each, in the order of the inputs
};

/// Nothing if the text is no such record.
[[nodiscard]] std::optional<RecordedCook> recorded_cook(std::string_view record);

[[nodiscard]] std::string recorded_options(const CookOptions& options);
/// Of ImportReport::content_hash.
[[nodiscard]] std::string recorded_hash(std::uint64_t hash);

}  // namespace boxtree::cooker
