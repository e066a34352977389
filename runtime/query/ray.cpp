// SPDX-License-Identifier: MIT
// Ray queries over any codec.
#include <algorithm>
#include <cmath>

#include <boxtree/runtime/primitive/predicates.h>
#include <boxtree/runtime/query/ray.h>
#include <boxtree/runtime/query/ray_slab.h>
#include <boxtree/runtime/query/traversal.h>

namespace boxtree {
namespace {

bool is_valid(const Ray& ray) {
  return ray.origin.allFinite() && ray.direction.allFinite() && !ray.direction.isZero(0) &&
         ray.t_min >= 0 && ray.t_min <= ray.t_max;  // false for NaN
}

Eigen::Vector3d reach_of(const Tree& tree) {
  const TreeRecord& record = tree.record();
  Eigen::Vector3d reach;
  for (std::size_t k = 0; k < 3; ++k) {
    reach[static_cast<Eigen::Index>(k)] =
        std::max(std::abs(record.root_low[k]), std::abs(record.root_high[k]));
  }
  return reach;
}

// The power of two that brings the largest component of the direction into [1/2, 1) of tree space.
// Directions of any length then behave alike, and t is converted without rounding.
int direction_exponent(const Ray& ray) {
  int exponent = 0;
  static_cast<void>(std::frexp(ray.direction.cwiseAbs().maxCoeff(), &exponent));
  return exponent;
}

Eigen::Vector3d scaled(const Eigen::Vector3d& v, int exponent) {
  return {std::ldexp(v[0], exponent), std::ldexp(v[1], exponent), std::ldexp(v[2], exponent)};
}

// A ray in tree space: origin + s * direction, where s = t * 2^parameter_exponent.
struct RayQuery {
  RayQuery(const Tree& asked, const Ray& ray, bool stop_at_first) noexcept
      : tree(asked),
        parameter_exponent(direction_exponent(ray) - asked.record().scale_exponent),
        origin(asked.frame().to_tree(ray.origin)),
        direction(scaled(ray.direction, -direction_exponent(ray))),
        slab(origin, direction, reach_of(asked)),
        shear(origin, direction),
        t_min(std::ldexp(ray.t_min, parameter_exponent)),
        t_max(std::ldexp(ray.t_max, parameter_exponent)),
        any(stop_at_first) {}

  [[nodiscard]] double bound() const noexcept { return t_max; }

  template <class S>
  [[nodiscard]] double key(const Box<S>& box) const noexcept {
    const SlabInterval interval = slab.intersect(box);
    const bool passes = interval.enter <= interval.leave && interval.leave >= t_min;
    return passes ? interval.enter : std::numeric_limits<double>::infinity();
  }

  [[nodiscard]] bool leaf(NodeRef ref) noexcept {
    error = tree.leaves().read(ref.first, ref.second, batch);
    if (error != Errc::kOk) return false;
    for (std::uint32_t i = 0; i < batch.count; ++i) test(i);
    return !(any && hit.has_value());
  }

  void test(std::uint32_t i) noexcept {
    const Triangle triangle = batch.triangle(i);
    const SlabInterval interval = slab.intersect(bounds_of(triangle));
    if (interval.enter > interval.leave) return;
    const std::optional<RayTriangleHit> found = intersect_ray_triangle(shear, triangle);
    if (!found) return;
    // The hit lies in the triangle's bounds; holding t to them makes it agree with every key above.
    const double t = std::clamp(found->t, interval.enter, interval.leave);
    if (t < t_min || t > t_max) return;
    const FaceRef face = face_ref(tree, batch.face[i]);
    if (hit && t == hit->t && !comes_before(face, hit->face)) return;
    hit = RayHit{t, face, half_of_face(batch, i), found->u, found->v};
    t_max = t;
  }

  const Tree& tree;
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

Result<std::optional<RayHit>> cast(const Tree& tree, const Ray& ray, bool stop_at_first) {
  if (!is_valid(ray) || !is_within_reach(tree.frame().to_tree(ray.origin))) {
    return Errc::kInvalidQuery;
  }
  RayQuery query(tree, ray, stop_at_first);
  const Errc walked =
      with_codec(tree, [&](const auto& codec) { return traverse_nearest(tree, codec, query); });
  if (walked != Errc::kOk) return walked;
  if (query.error != Errc::kOk) return query.error;
  if (query.hit) query.hit->t = std::ldexp(query.hit->t, -query.parameter_exponent);
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
