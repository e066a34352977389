// SPDX-License-Identifier: MIT
// The search for the closest point, whatever the codec.
#pragma once

#include <algorithm>
#include <optional>

#include <boxtree/runtime/primitive/predicates.h>
#include <boxtree/runtime/query/point.h>
#include <boxtree/runtime/query/traversal.h>

namespace boxtree {

/// A query of traverse_nearest, in tree space.
struct PointQuery {
  const Tree& tree;
  Eigen::Vector3d point;  // tree space
  double best;            // squared distance; shrinks
  std::optional<ClosestPoint> found;
  Errc error = Errc::kOk;
  TriangleBatch batch;

  [[nodiscard]] double bound() const noexcept { return best; }

  template <class S>
  [[nodiscard]] double key(const Box<S>& box) const noexcept {
    return squared_distance(point, box);
  }

  [[nodiscard]] bool leaf(NodeRef ref) noexcept {
    error = tree.leaves().read(ref.first, ref.second, batch);
    if (error != Errc::kOk) return false;
    for (std::uint32_t i = 0; i < batch.count; ++i) {
      test(batch.triangle(i), batch.face[i], half_of_face(batch, i));
    }
    return true;
  }

  void test(const Triangle& triangle, std::uint32_t face_order, std::uint32_t half) noexcept {
    const double bounds_distance = squared_distance(point, bounds_of(triangle));
    if (bounds_distance > best) return;
    const Eigen::Vector3d closest = closest_point_on_triangle(point, triangle);
    // Never below the distance of the bounds, so that it agrees with every key above.
    const double distance = std::max(bounds_distance, (closest - point).squaredNorm());
    const FaceRef face = face_ref(tree, face_order);
    if (distance > best) return;
    if (found && distance == best && !comes_before(face, found->face)) return;
    best = distance;
    found = ClosestPoint{closest, distance, face, half};
  }
};

}  // namespace boxtree
