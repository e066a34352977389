// SPDX-License-Identifier: MIT
// Ray queries over any codec.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "runtime/primitive/float_state.h"
#include "runtime/primitive/normal.h"
#include "runtime/query/invalid_query.h"
#include "runtime/query/nearest_hits.h"
#include "runtime/query/ray_query.h"
#include "runtime/walk/walk_tree.h"

namespace boxtree {

const char* refused_field(const Ray& ray) noexcept {
  const char* const field = invalid_field(ray, largest_magnitude(ray.direction));
  return field != nullptr ? field : "origin";
}

Errc cast_ray(const BoundTree& tree, const Ray& ray, bool stop_at_first, QueryWork& work,
              RayCandidate& hit, RayWishes* wishes) {
  const double length = largest_magnitude(ray.direction);
  if (invalid_field(ray, length) != nullptr) return Errc::kInvalidQuery;
  WalkBound nodes(tree.node_count(), &work);
  RayQuery query(tree, ray, exponent_of(length), nodes, stop_at_first, hit, wishes);
  if (!(query.origin_max_abs <= kMaxCoordinate)) return Errc::kInvalidQuery;  // NaN, too
  if (tree.empty() || !query.enters_root()) return Errc::kOk;
  // Wide codecs: RayWalk::intersect (ray_wide.cpp); others: traverse_nearest (walk/traversal.h),
  // which calls RayQuery::key.
  const Errc walked = walk_nearest(tree, query);
  if (walked != Errc::kOk) return walked;
  if (query.error != Errc::kOk) return query.error;
  query.finish(ray);
  return Errc::kOk;
}

namespace {

// Whether the ray may hit a triangle that it meets, from the side that it meets.
bool admits_side(const RayTest& query, const Triangle& triangle) noexcept {
  const BackFaces back_faces = query.wishes->faces.options->back_faces;
  return back_faces == BackFaces::kHit ||
         meets_front(query.shear, triangle) == (back_faces == BackFaces::kIgnore);
}

}  // namespace

bool meet_wishes(RayTest& query, RayCandidate& candidate) {
  FaceWishes& faces = query.wishes->faces;
  if (faces.stopped || !admits_side(query, candidate.triangle)) return false;
  const std::uint32_t index = candidate.face.index;
  if (query.wishes->all == nullptr) {
    return !faces.has_filter() || faces.name_wanted(query.tree, index, candidate.face);
  }
  // One by one: a leaf seldom has two hits.
  const auto name_face = [&](std::uint32_t of) { return face_ref(query.tree, of); };
  query.error =
      faces.visit_wanted(query.tree, index, query.t_max, name_face, [&](const FaceRef& face) {
        candidate.face = face;
        return (*query.wishes->all)(query, candidate);
      });
  return false;
}

RayHit described(const BoundTree& tree, const RayCandidate& hit) noexcept {
  return {hit.t,
          hit.face,
          hit.half,
          hit.u,
          hit.v,
          tree.frame().to_object(hit.point()),
          unit_normal(hit.triangle)};
}

namespace {

RayResult hit_on(const Tree& queried, const Ray& ray, bool stop_at_first, const QueryLimits& limits,
                 RayWishes* wishes = nullptr) {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(queried);
  QueryWork work(limits);
  RayCandidate hit;
  const Errc error = cast_ray(tree, ray, stop_at_first, work, hit, wishes);
  if (error == Errc::kInvalidQuery) return {error, refused_field(ray)};
  if (error != Errc::kOk || !hit.is_hit) return error;
  return described(tree, hit);
}

RayResult wanted_hit(const Tree& tree, const Ray& ray, bool stop_at_first,
                     const FaceOptions& options) {
  RayWishes wishes{{BoundTree::of(tree), &options}, &meet_wishes};
  return hit_on(tree, ray, stop_at_first, options.limits, &wishes);
}

}  // namespace

RayResult closest_hit(const Tree& tree, const Ray& ray, const QueryLimits& limits) {
  return hit_on(tree, ray, false, limits);
}

RayResult any_hit(const Tree& tree, const Ray& ray, const QueryLimits& limits) {
  return hit_on(tree, ray, true, limits);
}

RayResult closest_hit(const Tree& tree, const Ray& ray, const FaceOptions& options) {
  return wanted_hit(tree, ray, false, options);
}

RayResult any_hit(const Tree& tree, const Ray& ray, const FaceOptions& options) {
  return wanted_hit(tree, ray, true, options);
}

Result<Visit> all_hits(const Tree& queried, const Ray& ray, RayVisitor visitor,
                       const FaceOptions& options) {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(queried);
  QueryWork work(options.limits);
  const auto visit = [&](const RayTest& query, const RayCandidate& found) {
    RayCandidate hit = found;
    hit.t = parameter_of(ray, found.t, query.parameter_exponent);
    return RayInTree::scaled(visitor(described(tree, hit)), query.parameter_exponent);
  };
  const RayWishes::Visitor all(visit);
  RayWishes wishes{{tree, &options}, &meet_wishes, &all};
  RayCandidate none;
  const Errc error = cast_ray(tree, ray, false, work, none, &wishes);
  if (error == Errc::kInvalidQuery) return invalid_query(refused_field(ray));
  if (error != Errc::kOk) return error;
  return wishes.faces.stopped ? Visit::kStopped : Visit::kComplete;
}

bool comes_first(const Tree& tree, const RayHit& a, const RayHit& b) noexcept {
  if (a.t != b.t) return a.t < b.t;
  return comes_before(BoundTree::of(tree), a.face, a.triangle, b.face, b.triangle);
}

Result<std::size_t> nearest_hits(const Tree& tree, const Ray& ray, std::span<RayHit> hits,
                                 const FaceOptions& options) {
  return first_hits(tree, ray, HitRoom(hits), options);
}

}  // namespace boxtree
