// SPDX-License-Identifier: MIT
// A machine's constants as a file: the output of `boxtree bench --calibrate --json` and the input
// of `boxtree cook --costs`.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <boxtree/error.h>

#include "cooker/choose/calibrate.h"

namespace boxtree::cooker {

[[nodiscard]] std::string costs_to_json(const Calibration& calibration);

/// What to tell of constants that were measured while other programs ran; empty if none did.
[[nodiscard]] std::string disturbed_constants(const Calibration& calibration);

/// The constants in a JSON text. Every codec needs exactly one row for each of exact and grid, and
/// every kind of query three steps that are finite, not negative and not all zero, because a
/// missing step would count as free; how they were measured may be missing. Error: kDocumentInvalid
/// with the place and what was expected.
Result<Calibration> parse_costs(std::string_view text);

/// The same from a file; errors include its path.
Result<Calibration> read_costs(const std::filesystem::path& path);

}  // namespace boxtree::cooker
