// SPDX-License-Identifier: MIT
// Choosing among encodings of the same tree, by bytes and by expected work, never by a clock.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include <boxtree/cooker/proof/gates.h>

namespace boxtree::cooker {

/// What the user values.
enum class Goal : std::uint8_t { kMemory, kSpeed, kBalance };

/// One encoding that was tried.
struct Candidate {
  CodecId codec;
  std::uint64_t tree_bytes = 0;
  std::uint64_t geometry_bytes = 0;
  ExpectedVisits cost;
  Gates gates;
  std::string rejected;  // why it was not chosen; empty for the chosen one
};

/// Number of the best candidate that passes its gates: fewest bytes, fewest expected visits over
/// ray, box and pair, or the smallest product of both; ties go to the earlier one. Nothing when
/// none passes. Fills Candidate::rejected of the others.
std::optional<std::size_t> choose(std::span<Candidate> candidates, Goal goal);

}  // namespace boxtree::cooker
