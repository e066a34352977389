// SPDX-License-Identifier: MIT
// What casts and contacts say of the feature that is touched.
#pragma once

#include <Eigen/Core>

#include "runtime/primitive/convex_shape.h"
#include "runtime/query/cast_query.h"

namespace boxtree {

/// Whether a part of the triangle that was found, which is in tree space, is active.
[[nodiscard]] bool is_active(const BoundTree& tree, const CastCandidate& found,
                             const TrianglePart& part) noexcept;
/// The normal of the face on the side of `normal`.
[[nodiscard]] Eigen::Vector3d face_normal(const Triangle& triangle,
                                          const Eigen::Vector3d& normal) noexcept;
[[nodiscard]] Eigen::Vector3d resolved(const Eigen::Vector3d& normal,
                                       const Eigen::Vector3d& of_face, bool keeps_its_own,
                                       const Eigen::Vector3d& velocity) noexcept;

/// Fills feature, feature_index and face_normal of a CastHit or Contact whose normal is known.
template <class Hit>
void set_feature(const Triangle& triangle, const TrianglePart& part, Hit& hit) noexcept {
  hit.feature = part.feature;
  hit.feature_index = part.index;
  hit.face_normal = face_normal(triangle, hit.normal);
}

}  // namespace boxtree
