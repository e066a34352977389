// SPDX-License-Identifier: MIT
// How far a surface may be off: from lengths of the world to those of a mesh, and from the
// stiffness of contacts to a length. Free of library functions whose last bits differ between
// machines.
#pragma once

#include <Eigen/Core>

#include "cooker/scene/profile.h"

namespace boxtree::cooker {

/// At least the largest factor by which `linear` stretches a vector (its largest singular value),
/// and above that by less than one in ten thousand; exact where `linear` has one number other than
/// zero in each row and column. Precondition: finite.
[[nodiscard]] double largest_stretch(const Eigen::Matrix3d& linear) noexcept;

/// The largest distance, in world lengths, by which a surface may be off when bodies rest on it by
/// a penalty force (rule S3). Putting the surface there stores 1/2 k d^2 in the contact, which
/// throws a body up by at most `jump` if d <= sqrt(2 m g jump / k); it is not seen at all if
/// d <= 0.1 m g / k, a tenth of the penetration at rest.
[[nodiscard]] double largest_surface_error(const ContactRule& rule) noexcept;

/// At most length / scale, the neighbour below where the quotient rounds up. Precondition: both
/// positive and finite.
[[nodiscard]] double divided_below(double length, double scale) noexcept;

}  // namespace boxtree::cooker
