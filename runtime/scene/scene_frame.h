// SPDX-License-Identifier: MIT
// The space in which boxes of instances are compared.
#pragma once

#include <span>

#include "format/box.h"
#include "runtime/tree/frame.h"

namespace boxtree {

/// The centre of the boxes and a power of two, 2^exponent, that scales them to the range of all
/// trees; 2^0 for a point at the origin, as of a tree that is one. Deterministic, because the bytes of cooked files depend on it.
[[nodiscard]] Frame frame_around(std::span<const Box<double>> boxes, int& exponent) noexcept;

}  // namespace boxtree
