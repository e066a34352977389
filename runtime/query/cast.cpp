// SPDX-License-Identifier: MIT
// Casts over any codec.
#include <cmath>

#include "runtime/primitive/float_state.h"
#include "runtime/query/cast_query.h"
#include "runtime/query/invalid_query.h"
#include "runtime/walk/face_copies.h"
#include "runtime/walk/walk_tree.h"

namespace boxtree {

void CastQuery::test(const Triangle& triangle, std::uint32_t face_index,
                     std::uint32_t half) noexcept {
  // The bounds are a lower bound of the touch, too: beginning there makes it agree with every key
  // above.
  const SlabInterval interval = slab.intersect(bounds_of(triangle));
  if (interval.enter > interval.leave || interval.leave < 0) return;
  const double from = std::max(interval.enter, 0.0);
  if (from > t_max) return;
  const std::optional<double> s = moving.first_touch(triangle, from, t_max);
  if (!s) return;
  CastCandidate found{true, *s, {kNoFaceId, face_index}, half, triangle};
  if (wanted == Wanted::kAll) {
    const FaceWithCopies faces(tree, face_index);
    if (faces.count() - 1 > copies_left) {
      error = Errc::kNodeCorrupt;
      return;
    }
    copies_left -= faces.count() - 1;
    for (std::uint32_t i = 0; i < faces.count() && !stopped; ++i) {
      found.face = faces.face(i);
      const double wanted_to = (*visitor)(found);
      stopped = !(wanted_to >= 0);
      t_max = std::min(t_max, wanted_to);
    }
    return;
  }
  if (best.is_hit && found.s == best.s) {
    name(tree, found.face);
    name(tree, best.face);
    if (!comes_before(tree, found.face, half, best.face, best.half)) return;
  }
  best = found;
  t_max = found.s;
}

namespace {

bool is_unsigned(double x) {
  return x >= 0 && std::isfinite(x);
}

// A shape in tree space, or the name of a field that is not valid.
struct ShapeInTree {
  ConvexShape shape;
  Eigen::Vector3d center;  // object space
  const char* invalid = nullptr;
};

ShapeInTree in_tree(const BoundTree& tree, const Sphere& sphere) {
  ShapeInTree out;
  out.center = sphere.center;
  out.shape.radius = sphere.radius * tree.frame().inverse_scale;
  if (!is_within_range(tree.frame().to_tree(sphere.center))) out.invalid = "center";
  if (!is_unsigned(sphere.radius)) out.invalid = "radius";
  return out;
}

ShapeInTree in_tree(const BoundTree& tree, const Capsule& capsule) {
  ShapeInTree out;
  const Eigen::Vector3d start = tree.frame().to_tree(capsule.start);
  const Eigen::Vector3d end = tree.frame().to_tree(capsule.end);
  if (!is_within_range(start)) out.invalid = "start";
  if (!is_within_range(end)) out.invalid = "end";
  if (!is_unsigned(capsule.radius)) out.invalid = "radius";
  if (out.invalid != nullptr) return out;
  out.center = capsule.start / 2 + capsule.end / 2;
  out.shape.axes = 1;
  out.shape.axis[0] = end / 2 - start / 2;
  out.shape.half[0] = 1;
  out.shape.radius = capsule.radius * tree.frame().inverse_scale;
  return out;
}

ShapeInTree in_tree(const BoundTree& tree, const OrientedBox& box) {
  ShapeInTree out;
  out.center = box.center;
  out.shape.axes = 3;
  const auto& q = box.rotation.coeffs();  // x, y, z, w
  const double largest = std::max(largest_magnitude(q[0], q[1], q[2]), std::abs(q[3]));
  if (!is_within_range(tree.frame().to_tree(box.center))) out.invalid = "center";
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (!is_unsigned(box.half_extents[k])) out.invalid = "half_extents";
  }
  if (!(largest > 0) || !std::isfinite(largest)) out.invalid = "rotation";
  if (out.invalid != nullptr) return out;
  const double x = q[0] / largest, y = q[1] / largest, z = q[2] / largest, w = q[3] / largest;
  const double length = ((x * x + y * y) + z * z) + w * w;
  const double s = 2 / length;
  out.shape.axis[0] = {1 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)};
  out.shape.axis[1] = {s * (x * y - w * z), 1 - s * (x * x + z * z), s * (y * z + w * x)};
  out.shape.axis[2] = {s * (x * z + w * y), s * (y * z - w * x), 1 - s * (x * x + y * y)};
  for (std::size_t k = 0; k < 3; ++k) {
    out.shape.half[k] = box.half_extents[static_cast<Eigen::Index>(k)] * tree.frame().inverse_scale;
  }
  return out;
}

// One cast of any shape.
class Cast {
 public:
  Cast(const Tree& queried, const ShapeInTree& shape, const Motion& motion,
       const QueryLimits& limits)
      : tree_(BoundTree::of(queried)), shape_(shape), motion_(motion), work_(limits) {
    // A shape that stays where it is goes nowhere along any direction.
    const double length = largest_magnitude(motion.direction);
    is_moving_ = length != 0;
    line_ = {shape.center, is_moving_ ? motion.direction : Eigen::Vector3d::UnitX(), 0,
             is_moving_ ? motion.t_max : 0};
    if (!(length <= std::numeric_limits<double>::max())) invalid_ = "direction";
    if (!(motion.t_max >= 0)) invalid_ = "t_max";
    if (shape.invalid != nullptr) invalid_ = shape.invalid;
    if (invalid_ == nullptr && !(largest_magnitude(shape.shape.half_extents()) <= kMaxCoordinate)) {
      invalid_ = shape.shape.axes == 3 ? "half_extents" : "radius";
    }
  }

  /// The field that is not valid, or null.
  [[nodiscard]] const char* invalid() const { return invalid_; }

  /// `visit`: called with the query and each touch of kAll. Precondition: nothing is invalid.
  template <class Visit, class Answer>
  Errc run(CastQuery::Wanted wanted, const Visit& visit, const Answer& answer) {
    WalkBound nodes(tree_.node_count(), &work_);
    const int exponent = exponent_of(largest_magnitude(line_.direction));
    CastQuery* query_of_visitor = nullptr;
    const auto all = [&](const CastCandidate& found) { return visit(*query_of_visitor, found); };
    const CastQuery::Visitor visitor(all);
    CastQuery query(tree_, shape_.shape, line_, exponent, is_moving_, wanted, &visitor, nodes);
    query_of_visitor = &query;
    if (tree_.empty() || !query.enters_root()) return Errc::kOk;
    const Errc walked = walk_nearest(tree_, query);
    if (walked != Errc::kOk) return walked;
    if (query.error != Errc::kOk) return query.error;
    answer(query);
    return Errc::kOk;
  }

  [[nodiscard]] CastHit hit_of(const CastQuery& query, const CastCandidate& found) const {
    CastHit hit;
    hit.initially_touching = found.s == 0;
    const MovingShape::Contact contact = query.moving.contact_at(found.triangle, found.s);
    const int exponent = query.parameter_exponent;
    hit.t_lower = parameter_of(line_, found.s, exponent);
    hit.t = hit.initially_touching ? 0 : parameter_of(line_, contact.by, exponent);
    hit.face = found.face;
    name(tree_, hit.face);
    hit.triangle = found.half;
    hit.point = tree_.frame().to_object(contact.point);
    hit.normal = contact.normal;
    hit.feature = contact.feature;
    return hit;
  }

 private:
  const BoundTree& tree_;
  const ShapeInTree& shape_;
  const Motion& motion_;
  QueryWork work_;
  Ray line_;  // of the shape's center
  bool is_moving_;
  const char* invalid_ = nullptr;
};

CastResult one_touch(const Tree& tree, const ShapeInTree& shape, const Motion& motion,
                     CastQuery::Wanted wanted, const QueryLimits& limits) {
  const DefaultFloatState state;
  Cast cast(tree, shape, motion, limits);
  if (cast.invalid() != nullptr) return {Errc::kInvalidQuery, cast.invalid()};
  CastResult result;
  const Errc error = cast.run(
      wanted, [](const CastQuery&, const CastCandidate&) { return -1.0; },
      [&](const CastQuery& query) {
        if (query.best.is_hit) result = cast.hit_of(query, query.best);
      });
  return error == Errc::kOk ? result : CastResult(error);
}

Result<Visit> all_touches(const Tree& tree, const ShapeInTree& shape, const Motion& motion,
                          CastVisitor visitor, const QueryLimits& limits) {
  const DefaultFloatState state;
  Cast cast(tree, shape, motion, limits);
  if (cast.invalid() != nullptr) return invalid_query(cast.invalid());
  Visit end = Visit::kComplete;
  const Errc error = cast.run(
      CastQuery::Wanted::kAll,
      [&](const CastQuery& query, const CastCandidate& found) {
        return RayInTree::scaled(visitor(cast.hit_of(query, found)), query.parameter_exponent);
      },
      [&](const CastQuery& query) { end = query.stopped ? Visit::kStopped : Visit::kComplete; });
  if (error != Errc::kOk) return error;
  return end;
}

}  // namespace

CastResult cast_closest(const Tree& tree, const Sphere& sphere, const Motion& motion,
                        const QueryLimits& limits) {
  return one_touch(tree, in_tree(BoundTree::of(tree), sphere), motion, CastQuery::Wanted::kClosest,
                   limits);
}
CastResult cast_closest(const Tree& tree, const Capsule& capsule, const Motion& motion,
                        const QueryLimits& limits) {
  return one_touch(tree, in_tree(BoundTree::of(tree), capsule), motion, CastQuery::Wanted::kClosest,
                   limits);
}
CastResult cast_closest(const Tree& tree, const OrientedBox& box, const Motion& motion,
                        const QueryLimits& limits) {
  return one_touch(tree, in_tree(BoundTree::of(tree), box), motion, CastQuery::Wanted::kClosest,
                   limits);
}

CastResult cast_any(const Tree& tree, const Sphere& sphere, const Motion& motion,
                    const QueryLimits& limits) {
  return one_touch(tree, in_tree(BoundTree::of(tree), sphere), motion, CastQuery::Wanted::kAny,
                   limits);
}
CastResult cast_any(const Tree& tree, const Capsule& capsule, const Motion& motion,
                    const QueryLimits& limits) {
  return one_touch(tree, in_tree(BoundTree::of(tree), capsule), motion, CastQuery::Wanted::kAny,
                   limits);
}
CastResult cast_any(const Tree& tree, const OrientedBox& box, const Motion& motion,
                    const QueryLimits& limits) {
  return one_touch(tree, in_tree(BoundTree::of(tree), box), motion, CastQuery::Wanted::kAny,
                   limits);
}

Result<Visit> cast_all(const Tree& tree, const Sphere& sphere, const Motion& motion,
                       CastVisitor visitor, const QueryLimits& limits) {
  return all_touches(tree, in_tree(BoundTree::of(tree), sphere), motion, visitor, limits);
}
Result<Visit> cast_all(const Tree& tree, const Capsule& capsule, const Motion& motion,
                       CastVisitor visitor, const QueryLimits& limits) {
  return all_touches(tree, in_tree(BoundTree::of(tree), capsule), motion, visitor, limits);
}
Result<Visit> cast_all(const Tree& tree, const OrientedBox& box, const Motion& motion,
                       CastVisitor visitor, const QueryLimits& limits) {
  return all_touches(tree, in_tree(BoundTree::of(tree), box), motion, visitor, limits);
}

}  // namespace boxtree
