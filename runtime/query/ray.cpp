// SPDX-License-Identifier: MIT
// Ray queries over any codec.
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "runtime/primitive/float_state.h"
#include "runtime/primitive/normal.h"
#include "runtime/query/ray_query.h"
#include "runtime/walk/walk_tree.h"

namespace boxtree {

bool is_valid(const Ray& ray) noexcept {
  return ray.direction.allFinite() && !ray.direction.isZero(0) && ray.t_min >= 0 &&
         ray.t_min <= ray.t_max;  // false for NaN
}

int direction_exponent(const Eigen::Vector3d& direction) noexcept {
  const double largest = direction.cwiseAbs().maxCoeff();
  if (largest >= std::numeric_limits<double>::min()) [[likely]] {  // a normal number
    constexpr int kBias = std::numeric_limits<double>::max_exponent - 2;
    return static_cast<int>(std::bit_cast<std::uint64_t>(largest) >> 52) - kBias;
  }
  int exponent = 0;
  static_cast<void>(std::frexp(largest, &exponent));
  return exponent;
}

Errc cast_ray(const BoundTree& tree, const Ray& ray, bool stop_at_first, QueryWork& work,
              RayCandidate& hit) {
  if (!is_valid(ray)) return Errc::kInvalidQuery;
  WalkBound nodes(tree.node_count(), &work);
  RayQuery query(tree, ray, direction_exponent(ray.direction), nodes, stop_at_first, hit);
  if (!is_within_reach(query.origin)) return Errc::kInvalidQuery;
  if (tree.empty() || !query.enters_root()) return Errc::kOk;
  const Errc walked = walk_nearest(tree, query);
  if (walked != Errc::kOk) return walked;
  if (query.error != Errc::kOk) return query.error;
  if (hit.is_hit) hit.t = parameter_of(ray, hit.t, query.parameter_exponent);
  return Errc::kOk;
}

namespace {

RayResult hit_on(const Tree& queried, const Ray& ray, bool stop_at_first,
                 const QueryLimits& limits) {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(queried);
  QueryWork work(limits);
  RayCandidate hit;
  const Errc error = cast_ray(tree, ray, stop_at_first, work, hit);
  if (error != Errc::kOk || !hit.is_hit) return error;
  return RayHit{hit.t,
                hit.face,
                hit.half,
                hit.u,
                hit.v,
                tree.frame().to_object(hit.point()),
                unit_normal(hit.triangle)};
}

}  // namespace

RayResult closest_hit(const Tree& tree, const Ray& ray, const QueryLimits& limits) {
  return hit_on(tree, ray, false, limits);
}

RayResult any_hit(const Tree& tree, const Ray& ray, const QueryLimits& limits) {
  return hit_on(tree, ray, true, limits);
}

}  // namespace boxtree
