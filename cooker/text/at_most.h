// SPDX-License-Identifier: MIT
// Bounds in messages.
#pragma once

#include <string>

namespace boxtree::cooker {

/// A bound with so many significant digits: the nearest such number that is not below it, so that
/// what is printed holds, and serves as a tolerance. Precondition: it is finite, 0 or more.
[[nodiscard]] std::string at_most(double bound, int digits);

/// "no vertex moved by more than 0.00636", with three digits; "no vertex moved".
[[nodiscard]] std::string moves_in_words(double max_vertex_error);

}  // namespace boxtree::cooker
