// SPDX-License-Identifier: MIT
// Bounds on surface errors: converts lengths of the world to those of a mesh, and the stiffness of
// contacts to a length. Uses no library functions whose last bits differ between machines.
#pragma once

#include <Eigen/Core>

#include "cooker/scene/profile.h"

namespace boxtree::cooker {

/// An upper bound of the largest factor by which `linear` stretches a vector (its largest singular
/// value), too large by less than one in ten thousand. Exact if `linear` has at most one non-zero
/// number in each row and column. Precondition: finite.
[[nodiscard]] double largest_stretch(const Eigen::Matrix3d& linear) noexcept;

/// The largest error, in world lengths, of a surface on which bodies rest by a penalty force (rule
/// S3). An error d stores 1/2 k d^2 in the contact, which throws a body up by at most `jump` if d
/// <= sqrt(2 m g jump / k). It is invisible if d <= 0.1 m g / k, a tenth of the penetration at
/// rest.
[[nodiscard]] double largest_surface_error(const ContactRule& rule) noexcept;

/// At most length / scale: the next smaller double if the quotient is rounded up. Precondition:
/// both positive and finite.
[[nodiscard]] double divided_below(double length, double scale) noexcept;

}  // namespace boxtree::cooker
