// SPDX-License-Identifier: MIT
// Arguments that no query takes. Not inlined: they are rare, and each query has some.
#pragma once

#include <Eigen/Geometry>

#include <boxtree/error.h>
#include <boxtree/query.h>

namespace boxtree {

/// kInvalidQuery for an argument, or a field of it, whose name is short enough for a std::string to
/// take without allocating.
[[nodiscard, gnu::cold]] Error invalid_query(const char* argument) noexcept;

/// Whether the corners of a box are finite and in order.
[[nodiscard]] bool is_finite_box(const Eigen::AlignedBox3d& box) noexcept;

/// The first field that is NaN or negative; null if there is none.
[[nodiscard]] const char* invalid_field(const Approximation& approximation) noexcept;

}  // namespace boxtree
