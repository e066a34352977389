// SPDX-License-Identifier: MIT
// Constants of a machine as a file: what `boxtree bench --calibrate --json` prints and
// `boxtree cook --costs` takes.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <boxtree/error.h>

#include "cooker/choose/calibrate.h"

namespace boxtree::cooker {

[[nodiscard]] std::string costs_to_json(const Calibration& calibration);

/// The constants in such a text. Error: kFileUnreadable, with what was expected where, unless every
/// codec has exactly one row for each of exact and grid, and every kind of query has three steps,
/// finite, not negative, and not all zero: what is missing would be taken for free.
Result<std::vector<CodecCost>> parse_costs(std::string_view text);

/// The same from a file; errors name it.
Result<std::vector<CodecCost>> read_costs(const std::filesystem::path& path);

}  // namespace boxtree::cooker
