// SPDX-License-Identifier: MIT
// Faces that touch a frustum, over any codec.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "runtime/primitive/float_state.h"
#include "runtime/primitive/vector3.h"
#include "runtime/query/frustum_sides.h"
#include "runtime/query/invalid_query.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/walk/erased_codec.h"
#include "runtime/walk/face_visit.h"
#include "runtime/walk/traversal.h"
#include "runtime/walk/work.h"

namespace boxtree {
namespace {

constexpr std::size_t kPlanes = 6;

}  // namespace

// Whether anything is left when the planes have cut the triangle (Sutherland and Hodgman,
// "Reentrant Polygon Clipping", 1974). Each plane is widened by more than what cutting at those
// before it has moved, so that nothing is lost that touches.
bool FrustumSides::touches(const Triangle& triangle) const noexcept {
  constexpr std::size_t kMost = 3 + kPlanes;  // each plane adds one corner
  const Box<double> bounds = bounds_of(triangle);
  std::array<Eigen::Vector3d, kMost> polygon;
  std::copy(triangle.corner.begin(), triangle.corner.end(), polygon.begin());
  std::size_t count = triangle.corner.size();
  for (const FrustumSide& plane : side) {
    if (plane.lowest(bounds) >= 0) continue;
    std::array<Eigen::Vector3d, kMost> kept;
    std::size_t left = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d& a = polygon[i];
      const Eigen::Vector3d& b = polygon[(i + 1) % count];
      const double of_a = plane.at(a), of_b = plane.at(b);
      if (of_a >= 0 && left < kept.size()) kept[left++] = a;
      if ((of_a >= 0) != (of_b >= 0) && left < kept.size()) {
        kept[left++] = a + (of_a / (of_a - of_b)) * (b - a);
      }
    }
    if (left == 0) return false;
    std::copy_n(kept.begin(), left, polygon.begin());
    count = left;
  }
  return true;
}
namespace {

struct FrustumQuery {
  using Visitor = FaceVisitor;

  FrustumSides sides;

  template <class S>
  [[nodiscard]] bool overlaps(const Box<S>& box) const noexcept {
    return sides.overlaps(box);
  }
  [[nodiscard]] bool touches(const Triangle& triangle) const noexcept {
    return sides.touches(triangle);
  }
};

FrustumSide side_of(const BoundTree& tree, const Frustum::Plane& plane) noexcept {
  const Eigen::Vector3d normal = plane.head<3>();
  const double power = scale_to_one(normal);
  const Frame& frame = tree.frame();
  FrustumSide side;
  side.normal = (power * normal) * frame.scale;
  const double offset = power * plane[3];
  side.offset = dot(power * normal, frame.origin) + offset;
  double size = std::abs(offset);
  for (Eigen::Index k = 0; k < 3; ++k) {
    size += std::abs(power * normal[k]) * std::abs(frame.origin[k]);
    size += std::abs(side.normal[k]) * tree.largest_abs();
  }
  side.offset += FrustumSides::kError * size;
  return side;
}

}  // namespace

Frustum Frustum::of(const ViewProjection& view_projection, ClipDepth depth) noexcept {
  const DefaultFloatState state;
  const auto row = [&](Eigen::Index i) -> Plane { return view_projection.row(i).transpose(); };
  const Plane near = depth == ClipDepth::kZeroToOne ? row(2) : row(3) + row(2);
  return {
      {row(3) + row(0), row(3) - row(0), row(3) + row(1), row(3) - row(1), near, row(3) - row(2)}};
}

Frustum Frustum::of(const std::array<Eigen::Vector3d, 8>& corners) noexcept {
  const DefaultFloatState state;
  // Each side has four of them, one after the other around it.
  constexpr std::array<std::array<std::size_t, 4>, kPlanes> kSides = {
      {{0, 3, 7, 4}, {1, 5, 6, 2}, {0, 4, 5, 1}, {3, 2, 6, 7}, {0, 1, 2, 3}, {4, 7, 6, 5}}};
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& corner : corners) middle += corner / 8;
  Frustum frustum;
  for (std::size_t i = 0; i < kPlanes; ++i) {
    const auto& [a, b, c, d] = kSides[i];
    const Eigen::Vector3d across = corners[c] - corners[a], other = corners[d] - corners[b];
    // Scaled, so that the product is finite; of a side without area nothing is cut off.
    Eigen::Vector3d normal = cross(scale_to_one(across) * across, scale_to_one(other) * other);
    if (dot(normal, middle - corners[a]) < 0) normal = -normal;
    // All corners are inside, whatever is rounded.
    double least = dot(normal, corners[0]);
    for (const Eigen::Vector3d& corner : corners) least = std::min(least, dot(normal, corner));
    frustum.planes[i] << normal, -least;
  }
  return frustum;
}

Result<Visit> overlap_frustum(const Tree& queried, const Frustum& frustum, FaceVisitor visitor,
                              const QueryLimits& limits) {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(queried);
  FrustumQuery query;
  if (!is_finite(frustum)) return invalid_query("planes");
  for (std::size_t i = 0; i < kPlanes; ++i) {
    query.sides.side[i] = side_of(tree, frustum.planes[i]);
  }
  QueryWork work(limits);
  WalkBound nodes(tree.node_count(), &work);
  FaceWalk<FrustumQuery> walk{{tree, visitor}, query, nodes};
  return outcome_of(traverse_overlap(tree, ErasedCodec{&tree}, walk), walk);
}

}  // namespace boxtree
