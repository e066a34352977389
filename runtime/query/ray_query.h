// SPDX-License-Identifier: MIT
// A ray on its way through one tree: what every walk, whatever the codec, asks of it.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include <boxtree/ray.h>

#include "runtime/primitive/predicates.h"
#include "runtime/query/ray_slab.h"
#include "runtime/walk/traversal.h"

namespace boxtree {

/// A ray in tree space, origin + s * direction, where s = t * 2^parameter_exponent: the largest
/// component of the direction is in [1/2, 1), so that directions of any length behave alike and t
/// is converted without rounding. A query of traverse_nearest.
struct RayQuery {
  RayQuery(const Tree& asked, WalkBound& bound, const Ray& ray, int direction_exponent,
           bool stop_at_first) noexcept
      : tree(asked),
        nodes(bound),
        parameter_exponent(direction_exponent - asked.record().scale_exponent),
        origin(asked.frame().to_tree(ray.origin)),
        direction(scaled(ray.direction, -direction_exponent)),
        slab(origin, direction, reach_of(asked)),
        shear(origin, direction),
        t_min(scaled(ray.t_min, parameter_exponent)),
        t_max(scaled(ray.t_max, parameter_exponent)),
        any(stop_at_first) {}

  /// x * 2^exponent, by a product where the power is a normal number.
  [[nodiscard]] static double scaled(double x, int exponent) noexcept {
    constexpr int kBias = std::numeric_limits<double>::max_exponent - 1;
    if (std::abs(exponent) >= kBias) return std::ldexp(x, exponent);
    return x * std::bit_cast<double>(static_cast<std::uint64_t>(exponent + kBias) << 52);
  }
  [[nodiscard]] static Eigen::Vector3d scaled(const Eigen::Vector3d& v, int exponent) noexcept {
    return {scaled(v[0], exponent), scaled(v[1], exponent), scaled(v[2], exponent)};
  }

  [[nodiscard]] double bound() const noexcept { return t_max; }

  template <class S>
  [[nodiscard]] double key(const Box<S>& box) const noexcept {
    return slab.key(box, t_min);
  }

  [[nodiscard]] bool leaf(NodeRef ref) noexcept {
    error = tree.leaves().read(ref.first, ref.second, batch);
    if (error != Errc::kOk) return false;
    for (std::uint32_t i = 0; i < batch.count; ++i) {
      test(batch.triangle(i), batch.face[i], half_of_face(batch, i));
    }
    return !is_done();
  }

  /// Whether no other triangle can matter.
  [[nodiscard]] bool is_done() const noexcept { return any && hit.has_value(); }

  void test(const Triangle& triangle, std::uint32_t face_order, std::uint32_t half) noexcept {
    const SlabInterval interval = slab.intersect(bounds_of(triangle));
    if (interval.enter > interval.leave) return;
    const std::optional<RayTriangleHit> found = intersect_ray_triangle(shear, triangle);
    if (!found) return;
    // The hit lies in the triangle's bounds; holding t to them makes it agree with every key above.
    const double t = std::clamp(found->t, interval.enter, interval.leave);
    if (t < t_min || t > t_max) return;
    const FaceRef face = face_ref(tree, face_order);
    if (hit && t == hit->t && !comes_before(face, half, hit->face, hit->triangle)) return;
    hit = RayHit{t, face, half, found->u, found->v};
    t_max = t;
  }

  const Tree& tree;
  WalkBound& nodes;
  int parameter_exponent;
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
  RaySlab slab;
  RayShear shear;
  double t_min;
  double t_max;  // shrinks to the best hit
  bool any;
  std::optional<RayHit> hit;
  Errc error = Errc::kOk;
  TriangleBatch batch;
};

/// By vectors; see walk_tree.h.
Errc walk_wide(const Tree& tree, RayQuery& query);

/// A parameter of the query in those of the ray. Kept within the ray's own interval, as conversion
/// may underflow: for a subnormal direction, say.
[[nodiscard]] inline double parameter_of(const Ray& ray, double scaled, int exponent) noexcept {
  return std::clamp(RayQuery::scaled(scaled, -exponent), ray.t_min, ray.t_max);
}

/// The power of two that brings the largest component of a direction into [1/2, 1).
[[nodiscard]] int direction_exponent(const Eigen::Vector3d& direction) noexcept;

/// Whether a ray has finite numbers, a direction and an ordered interval; an origin that is not
/// finite is left to is_within_reach().
[[nodiscard]] bool is_valid(const Ray& ray) noexcept;

/// closest_hit or any_hit for callers that have seen to the floating-point state.
Result<std::optional<RayHit>> cast_ray(const Tree& tree, const Ray& ray, bool stop_at_first,
                                       QueryWork& work);

}  // namespace boxtree
