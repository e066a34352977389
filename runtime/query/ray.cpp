// SPDX-License-Identifier: MIT
// Ray queries over any codec.
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "runtime/query/float_state.h"
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

Result<std::optional<RayHit>> cast_ray(const Tree& tree, const Ray& ray, bool stop_at_first,
                                       QueryWork& work) {
  if (!is_valid(ray) || !is_within_reach(tree.frame().to_tree(ray.origin))) {
    return Errc::kInvalidQuery;
  }
  WalkBound nodes(tree.record().node_count, &work);
  RayQuery query(tree, nodes, ray, direction_exponent(ray.direction), stop_at_first);
  const Errc walked =
      with_codec(tree, [&](const auto& codec) { return walk_nearest(tree, codec, query); });
  if (walked != Errc::kOk) return walked;
  if (query.error != Errc::kOk) return query.error;
  if (query.hit) query.hit->t = parameter_of(ray, query.hit->t, query.parameter_exponent);
  return query.hit;
}

Result<std::optional<RayHit>> closest_hit(const Tree& tree, const Ray& ray,
                                          const QueryLimits& limits) {
  const DefaultFloatState state;
  QueryWork work(limits);
  return cast_ray(tree, ray, false, work);
}

Result<std::optional<RayHit>> any_hit(const Tree& tree, const Ray& ray, const QueryLimits& limits) {
  const DefaultFloatState state;
  QueryWork work(limits);
  return cast_ray(tree, ray, true, work);
}

}  // namespace boxtree
