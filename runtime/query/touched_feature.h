// SPDX-License-Identifier: MIT
// What casts and contacts say of the feature that is touched.
#pragma once

#include <Eigen/Core>

#include "runtime/primitive/convex_shape.h"
#include "runtime/query/cast_query.h"

namespace boxtree {

/// The part of the face's triangle that is a part of the triangle that was found.
[[nodiscard]] TrianglePart part_of_face(const CastCandidate& found, TrianglePart part) noexcept;
/// Whether a part of the face's triangle is active.
[[nodiscard]] bool is_active(const BoundTree& tree, const CastCandidate& found,
                             const TrianglePart& part) noexcept;
/// The normal of the triangle that was found. Zero if it has no area in tree space: a pose may give
/// it one, by rounding.
[[nodiscard]] Eigen::Vector3d front_normal(const CastCandidate& found) noexcept;
/// The same on the side of `normal`.
[[nodiscard]] Eigen::Vector3d face_normal(const CastCandidate& found,
                                          const Eigen::Vector3d& normal) noexcept;
[[nodiscard]] Eigen::Vector3d resolved(const Eigen::Vector3d& normal,
                                       const Eigen::Vector3d& of_face, bool keeps_its_own,
                                       const Eigen::Vector3d& velocity) noexcept;

/// Fills in what a CastHit or Contact says of the part of the triangle that is touched.
template <class Hit>
void set_feature(const BoundTree& tree, const CastCandidate& found, const TrianglePart& part,
                 Hit& hit) noexcept {
  const TrianglePart of_face = part_of_face(found, part);
  hit.feature = of_face.feature;
  hit.feature_index = of_face.index;
  hit.is_active = is_active(tree, found, of_face);
}

}  // namespace boxtree
