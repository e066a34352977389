// SPDX-License-Identifier: MIT
// Ray queries over any codec.
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <boxtree/runtime/query/float_state.h>
#include <boxtree/runtime/query/ray_query.h>
#include <boxtree/runtime/wide/walks.h>

namespace boxtree {
namespace {

// An origin that is not finite is not within reach either.
bool is_valid(const Ray& ray) {
  return ray.direction.allFinite() && !ray.direction.isZero(0) && ray.t_min >= 0 &&
         ray.t_min <= ray.t_max;  // false for NaN
}

// The power of two that brings the largest component of the direction into [1/2, 1) of tree space.
// Directions of any length then behave alike, and t is converted without rounding.
int direction_exponent(const Ray& ray) {
  const double largest = ray.direction.cwiseAbs().maxCoeff();
  if (largest >= std::numeric_limits<double>::min()) [[likely]] {  // a normal number
    constexpr int kBias = std::numeric_limits<double>::max_exponent - 2;
    return static_cast<int>(std::bit_cast<std::uint64_t>(largest) >> 52) - kBias;
  }
  int exponent = 0;
  static_cast<void>(std::frexp(largest, &exponent));
  return exponent;
}

Result<std::optional<RayHit>> cast(const Tree& tree, const Ray& ray, bool stop_at_first) {
  const DefaultFloatState state;
  if (!is_valid(ray) || !is_within_reach(tree.frame().to_tree(ray.origin))) {
    return Errc::kInvalidQuery;
  }
  RayQuery query(tree, ray, direction_exponent(ray), stop_at_first);
  const Errc walked =
      with_codec(tree, [&](const auto& codec) { return walk_nearest(tree, codec, query); });
  if (walked != Errc::kOk) return walked;
  if (query.error != Errc::kOk) return query.error;
  if (query.hit) query.hit->t = RayQuery::scaled(query.hit->t, -query.parameter_exponent);
  return query.hit;
}

}  // namespace

Result<std::optional<RayHit>> closest_hit(const Tree& tree, const Ray& ray) {
  return cast(tree, ray, false);
}

Result<std::optional<RayHit>> any_hit(const Tree& tree, const Ray& ray) {
  return cast(tree, ray, true);
}

}  // namespace boxtree
