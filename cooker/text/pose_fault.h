// SPDX-License-Identifier: MIT
// Why a pose is refused, in words: queries, which allocate nothing, answer with a code alone.
#pragma once

#include <string>

#include <boxtree/query.h>

namespace boxtree::cooker {

/// Whether the linear part has an inverse in double: the test of pair queries, with their
/// arithmetic, for a body relative to itself. The inverse must be finite, and so must the product
/// of both (a determinant beyond the range of doubles makes the inverse zero).
[[nodiscard]] bool has_double_inverse(const Pose& pose) noexcept;

/// What is wrong with a pose that was refused, to stand behind its name: "is not finite: row 1,
/// column 4 is inf".
[[nodiscard]] std::string pose_fault(const Pose& pose);

}  // namespace boxtree::cooker
