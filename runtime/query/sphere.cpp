// SPDX-License-Identifier: MIT
// Sphere queries over any codec.
#include <algorithm>
#include <cmath>

#include <boxtree/runtime/primitive/predicates.h>
#include <boxtree/runtime/query/face_visit.h>
#include <boxtree/runtime/query/sphere.h>

namespace boxtree {
namespace {

struct SphereQuery {
  Eigen::Vector3d center;  // tree space
  double squared_radius;

  template <class S>
  [[nodiscard]] bool overlaps(const Box<S>& box) const noexcept {
    return squared_distance(center, box) <= squared_radius;
  }
  [[nodiscard]] bool touches(const Triangle& triangle) const noexcept {
    return (closest_point_on_triangle(center, triangle) - center).squaredNorm() <= squared_radius;
  }
};

}  // namespace

Result<Visit> overlap_sphere(const Tree& tree, const Eigen::Vector3d& center, double radius,
                             FaceVisitor visitor) {
  const Eigen::Vector3d tree_center = tree.frame().to_tree(center);
  if (!(radius >= 0) || !std::isfinite(radius) || !is_within_reach(tree_center)) {
    return Errc::kInvalidQuery;
  }
  // Twice the reach spans every distance that can occur; a larger radius changes no answer.
  const double tree_radius = std::min(radius * tree.frame().inverse_scale, 4 * kReach);
  return visit_faces(tree, SphereQuery{tree_center, tree_radius * tree_radius}, visitor);
}

}  // namespace boxtree
