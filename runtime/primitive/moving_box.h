// SPDX-License-Identifier: MIT
// When a box that moves along a line touches a triangle: see moving_shape.h.
#pragma once

#include <optional>

#include "runtime/primitive/moving_shape.h"

namespace boxtree {

/// MovingShape::first_touch() of a box.
[[nodiscard]] std::optional<MovingShape::Touch> first_touch_of_box(const MovingShape& moving,
                                                                   const Triangle& triangle,
                                                                   double from, double to) noexcept;
/// Likewise contact_at(), where `s` is a result of that.
[[nodiscard]] MovingShape::Contact contact_of_box(const MovingShape& moving,
                                                  const Triangle& triangle, double s) noexcept;

}  // namespace boxtree
