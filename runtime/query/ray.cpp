// SPDX-License-Identifier: MIT
// Ray queries over any codec.
#include "runtime/primitive/float_state.h"
#include "runtime/primitive/normal.h"
#include "runtime/query/ray_query.h"
#include "runtime/walk/walk_tree.h"

namespace boxtree {

const char* refused_field(const Ray& ray) noexcept {
  const char* const field = invalid_field(ray, largest_magnitude(ray.direction));
  return field != nullptr ? field : "origin";
}

Errc cast_ray(const BoundTree& tree, const Ray& ray, bool stop_at_first, QueryWork& work,
              RayCandidate& hit) {
  const double length = largest_magnitude(ray.direction);
  if (invalid_field(ray, length) != nullptr) return Errc::kInvalidQuery;
  WalkBound nodes(tree.node_count(), &work);
  RayQuery query(tree, ray, exponent_of(length), nodes, stop_at_first, hit);
  if (!(query.origin_max_abs <= kMaxCoordinate)) return Errc::kInvalidQuery;  // NaN, too
  if (tree.empty() || !query.enters_root()) return Errc::kOk;
  // Wide codecs: RayWalk::intersect (ray_wide.cpp); others: traverse_nearest (walk/traversal.h),
  // which calls RayQuery::key.
  const Errc walked = walk_nearest(tree, query);
  if (walked != Errc::kOk) return walked;
  if (query.error != Errc::kOk) return query.error;
  if (hit.is_hit) {
    hit.t = parameter_of(ray, hit.t, query.parameter_exponent);
    name(tree, hit.face);
  }
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
  if (error == Errc::kInvalidQuery) return {error, refused_field(ray)};
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
