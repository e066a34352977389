// SPDX-License-Identifier: MIT
// Closest-point queries over any codec.
#include <algorithm>
#include <cmath>

#include <boxtree/runtime/primitive/predicates.h>
#include <boxtree/runtime/query/point.h>
#include <boxtree/runtime/query/traversal.h>

namespace boxtree {
namespace {

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
    for (std::uint32_t i = 0; i < batch.count; ++i) test(i);
    return true;
  }

  void test(std::uint32_t i) noexcept {
    const Triangle triangle = batch.triangle(i);
    const double bounds_distance = squared_distance(point, bounds_of(triangle));
    if (bounds_distance > best) return;
    const Eigen::Vector3d closest = closest_point_on_triangle(point, triangle);
    // Never below the distance of the bounds, so that it agrees with every key above.
    const double distance = std::max(bounds_distance, (closest - point).squaredNorm());
    const FaceRef face = face_ref(tree, batch.face[i]);
    if (distance > best) return;
    if (found && distance == best && !comes_before(face, found->face)) return;
    best = distance;
    found = ClosestPoint{closest, distance, face, half_of_face(batch, i)};
  }
};

}  // namespace

Result<std::optional<ClosestPoint>> closest_point(const Tree& tree, const Eigen::Vector3d& point,
                                                  double max_distance) {
  const Eigen::Vector3d tree_point = tree.frame().to_tree(point);
  if (!is_within_reach(tree_point) || !(max_distance >= 0)) return Errc::kInvalidQuery;
  const double tree_distance = max_distance * tree.frame().inverse_scale;
  PointQuery query{tree, tree_point, tree_distance * tree_distance, {}, Errc::kOk, {}};
  const Errc walked =
      with_codec(tree, [&](const auto& codec) { return traverse_nearest(tree, codec, query); });
  if (walked != Errc::kOk) return walked;
  if (query.error != Errc::kOk) return query.error;
  if (query.found) {
    query.found->point = tree.frame().to_object(query.found->point);
    query.found->distance = std::sqrt(query.found->distance) * tree.frame().scale;
  }
  return query.found;
}

}  // namespace boxtree
