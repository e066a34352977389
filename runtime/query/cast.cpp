// SPDX-License-Identifier: MIT
// Casts over any codec.
#include <cmath>

#include "runtime/primitive/float_state.h"
#include "runtime/primitive/normal.h"
#include "runtime/primitive/vector3.h"
#include "runtime/query/cast_query.h"
#include "runtime/query/invalid_query.h"
#include "runtime/query/shape_casts.h"
#include "runtime/query/touched_feature.h"
#include "runtime/walk/walk_tree.h"

namespace boxtree {
namespace {

double near_of(const BoundTree& tree, const Eigen::Vector3d& extent) noexcept {
  return RaySlab::power_above(tree.largest_abs()) + 2 * largest_magnitude(extent);
}

}  // namespace

CastQuery::CastQuery(const BoundTree& queried, const Path& path, Wanted wanted_touches,
                     const Visitor* all, WalkBound& bound, const FaceOptions* face_options) noexcept
    : CastQuery(queried, path, path.shape.half_extents(), wanted_touches, all, bound,
                face_options) {}

CastQuery::CastQuery(const BoundTree& queried, const Path& path, const Eigen::Vector3d& half,
                     Wanted wanted_touches, const Visitor* all, WalkBound& bound,
                     const FaceOptions* face_options) noexcept
    : RayInTree(queried, path.line, exponent_of(largest_magnitude(path.line.direction)),
                near_of(queried, half)),
      tree(queried),
      nodes(bound),
      shape(path.shape),
      extent(half),
      near(near_of(queried, half)),
      placed(path.placed),
      is_moving(path.is_moving),
      moving(placed != nullptr ? placed->moving : moving_in_tree()),
      wanted(wanted_touches),
      visitor(all),
      faces(queried, face_options) {
  slab.widen(AxisLanes(extent));
}

MovingShape CastQuery::moving_in_tree() const noexcept {
  MovingShape out{shape, is_moving ? direction.vector() : Eigen::Vector3d::Zero(),
                  MovingShape::doubt_of(near, origin_max_abs) + shape.error};
  out.shape.center = origin.vector();
  return out;
}

void CastQuery::test(const Triangle& triangle, std::uint32_t face_index, std::uint32_t half) {
  // The bounds are a lower bound of the touch, too: beginning there makes it agree with every key
  // above.
  const SlabInterval interval = slab.intersect(bounds_of(triangle));
  if (interval.enter > interval.leave || interval.leave < 0) return;
  const double from = std::max(interval.enter, 0.0);
  if (from > t_max) return;
  CastCandidate found;
  const auto touches = [&](const Triangle& compared) {
    const double scale = scale_of_parameters();
    const auto touch = moving.first_touch(compared, from * scale, t_max * scale);
    if (touch) found.touch = *touch;
    return touch.has_value();
  };
  // Many do not touch, or too late: a triangle that need not be known for more is copied later.
  const bool is_compared = placed == nullptr && wanted != Wanted::kContacts && !wants_a_side();
  if (is_compared && !touches(triangle)) return;
  set_triangle(triangle, face_index, half, found);
  if (!is_compared) {
    if (!admits_side(found)) return;
    if (wanted == Wanted::kContacts) {
      const std::optional<Penetration> contact = moving.contact_at_rest(found.triangle);
      if (!contact) return;
      found.at = *contact;
      found.face_normal = face_normal(found, contact->normal);
    } else if (!touches(found.triangle)) {
      return;
    }
  }
  take(found);
}

void CastQuery::set_triangle(const Triangle& triangle, std::uint32_t face_index, std::uint32_t half,
                             CastCandidate& found) const noexcept {
  found.is_hit = true;
  found.face = {kNoFaceId, face_index};
  found.original = face_index;
  found.half = half;
  found.in_tree = triangle;
  if (placed == nullptr) {
    found.triangle = triangle;
    return;
  }
  found.triangle = placed->apply(triangle);
  found.is_placed = true;
  found.is_mirror = placed->is_mirror;
  found.inactive = placed->inactive;
}

void CastQuery::take_face(std::uint32_t face_index, std::uint32_t half) {
  CastCandidate found;
  found.is_hit = true;
  found.face = {kNoFaceId, face_index};
  found.original = face_index;
  found.half = half;
  take(found);
}

void CastQuery::take(CastCandidate& found) {
  const double scale = scale_of_parameters();
  if (visitor != nullptr) {
    error = faces.visit_wanted(tree, found.original, t_max, names, [&](const FaceRef& face) {
      found.face = face;
      return (*visitor)(*this, found) / scale;
    });
    return;
  }
  if (faces.has_filter() && !faces.name_wanted(tree, found.original, found.face)) return;
  if (best.is_hit && found.touch.s == best.touch.s) {
    name(tree, found.face);
    name(tree, best.face);
    if (!comes_before(tree, found.face, found.half, best.face, best.half)) return;
  }
  best = found;
  t_max = found.touch.s / scale;
}

bool CastQuery::admits_side(const CastCandidate& found) const noexcept {
  if (!wants_a_side()) return true;
  const bool is_back = dot(front_normal(found), moving.direction) > 0;
  return is_back == (faces.options->back_faces == BackFaces::kOnly);
}

Errc CastQuery::run() {
  if (tree.empty() || !meets(tree.root_lanes())) return Errc::kOk;
  const Errc walked = walk_nearest(tree, *this);
  return walked != Errc::kOk ? walked : error;
}

CastLine::CastLine(const ShapeInTree& shape, const Motion& motion) noexcept {
  // A shape that stays where it is goes nowhere along any direction.
  const double length = largest_magnitude(motion.direction);
  is_moving = length != 0;
  line = {shape.center, is_moving ? motion.direction : Eigen::Vector3d::UnitX(), 0,
          is_moving ? motion.t_max : 0};
  invalid = shape.invalid;
  if (invalid != nullptr) return;
  if (!(length <= std::numeric_limits<double>::max())) invalid = "direction";
  if (!(motion.t_max >= 0)) invalid = "t_max";
}

CastHit hit_of(const BoundTree& tree, const MovingShape& moving, const CastCandidate& found,
               const Ray& line, int exponent, const Frame& frame) noexcept {
  CastHit hit;
  hit.initially_touching = found.touch.s == 0;
  const MovingShape::Contact contact = moving.contact_at(found.triangle, found.touch);
  hit.t_lower = parameter_of(line, found.touch.s, exponent);
  hit.t = hit.initially_touching ? 0 : parameter_of(line, contact.by, exponent);
  hit.face = found.face;
  hit.triangle = found.half;
  hit.point = frame.to_object(contact.point);
  hit.normal = contact.normal;
  hit.face_normal = face_normal(found, hit.normal);
  set_feature(tree, found, contact.feature, hit);
  return hit;
}

namespace {

CastHit described(const CastQuery& query, const CastLine& cast, const CastCandidate& found) {
  return hit_of(query.tree, query.moving, found, cast.line, query.parameter_exponent,
                query.tree.frame());
}

}  // namespace

CastResult one_touch_in(const BoundTree& tree, const ShapeInTree& shape, const Motion& motion,
                        CastQuery::Wanted wanted, const FaceOptions& options) {
  const CastLine cast(shape, motion);
  if (cast.invalid != nullptr) return {Errc::kInvalidQuery, cast.invalid};
  QueryWork work(options.limits);
  WalkBound nodes(tree.node_count(), &work);
  CastQuery query(tree, {shape.shape, cast.line, cast.is_moving}, wanted, nullptr, nodes, &options);
  const Errc error = query.run();
  if (error != Errc::kOk || !query.best.is_hit) return error;
  CastHit hit = described(query, cast, query.best);
  name(tree, hit.face);
  return hit;
}

Result<Visit> all_touches_in(const BoundTree& tree, const ShapeInTree& shape, const Motion& motion,
                             CastVisitor visitor, const FaceOptions& options) {
  const CastLine cast(shape, motion);
  if (cast.invalid != nullptr) return invalid_query(cast.invalid);
  const auto touched = [&](const CastQuery& query, const CastCandidate& found) {
    return RayInTree::scaled(visitor(described(query, cast, found)), query.parameter_exponent);
  };
  const CastQuery::Visitor all(touched);
  QueryWork work(options.limits);
  WalkBound nodes(tree.node_count(), &work);
  CastQuery query(tree, {shape.shape, cast.line, cast.is_moving}, CastQuery::Wanted::kAll, &all,
                  nodes, &options);
  if (const Errc error = query.run(); error != Errc::kOk) return error;
  return query.faces.stopped ? Visit::kStopped : Visit::kComplete;
}

namespace {

template <class Shape>
CastResult one_touch(const Tree& queried, const Shape& shape, const Motion& motion,
                     CastQuery::Wanted wanted, const FaceOptions& options) {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(queried);
  return one_touch_in(tree, in_tree(tree.frame(), shape), motion, wanted, options);
}

template <class Shape>
Result<Visit> all_touches(const Tree& queried, const Shape& shape, const Motion& motion,
                          CastVisitor visitor, const FaceOptions& options) {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(queried);
  return all_touches_in(tree, in_tree(tree.frame(), shape), motion, visitor, options);
}

}  // namespace

CastResult cast_closest(const Tree& tree, const Sphere& sphere, const Motion& motion,
                        const FaceOptions& options) {
  return one_touch(tree, sphere, motion, CastQuery::Wanted::kClosest, options);
}
CastResult cast_closest(const Tree& tree, const Capsule& capsule, const Motion& motion,
                        const FaceOptions& options) {
  return one_touch(tree, capsule, motion, CastQuery::Wanted::kClosest, options);
}
CastResult cast_closest(const Tree& tree, const OrientedBox& box, const Motion& motion,
                        const FaceOptions& options) {
  return one_touch(tree, box, motion, CastQuery::Wanted::kClosest, options);
}

CastResult cast_any(const Tree& tree, const Sphere& sphere, const Motion& motion,
                    const FaceOptions& options) {
  return one_touch(tree, sphere, motion, CastQuery::Wanted::kAny, options);
}
CastResult cast_any(const Tree& tree, const Capsule& capsule, const Motion& motion,
                    const FaceOptions& options) {
  return one_touch(tree, capsule, motion, CastQuery::Wanted::kAny, options);
}
CastResult cast_any(const Tree& tree, const OrientedBox& box, const Motion& motion,
                    const FaceOptions& options) {
  return one_touch(tree, box, motion, CastQuery::Wanted::kAny, options);
}

Result<Visit> cast_all(const Tree& tree, const Sphere& sphere, const Motion& motion,
                       CastVisitor visitor, const FaceOptions& options) {
  return all_touches(tree, sphere, motion, visitor, options);
}
Result<Visit> cast_all(const Tree& tree, const Capsule& capsule, const Motion& motion,
                       CastVisitor visitor, const FaceOptions& options) {
  return all_touches(tree, capsule, motion, visitor, options);
}
Result<Visit> cast_all(const Tree& tree, const OrientedBox& box, const Motion& motion,
                       CastVisitor visitor, const FaceOptions& options) {
  return all_touches(tree, box, motion, visitor, options);
}

}  // namespace boxtree
