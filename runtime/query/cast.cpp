// SPDX-License-Identifier: MIT
// Casts over any codec.
#include <cmath>

#include "runtime/primitive/float_state.h"
#include "runtime/primitive/normal.h"
#include "runtime/primitive/vector3.h"
#include "runtime/query/cast_query.h"
#include "runtime/query/invalid_query.h"
#include "runtime/query/shape_in_tree.h"
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
  if (!admits_side(triangle)) return;
  const std::optional<double> s = moving.first_touch(triangle, from, t_max);
  if (!s) return;
  CastCandidate found{true, *s, {kNoFaceId, face_index}, face_index, half, triangle};
  if (wanted == Wanted::kAll) {
    error = faces.visit_wanted(tree, face_index, t_max, [&](const FaceRef& face) {
      found.face = face;
      return (*visitor)(*this, found);
    });
    return;
  }
  if (faces.has_filter() && !faces.name_wanted(tree, face_index, found.face)) return;
  if (best.is_hit && found.s == best.s) {
    name(tree, found.face);
    name(tree, best.face);
    if (!comes_before(tree, found.face, half, best.face, best.half)) return;
  }
  best = found;
  t_max = found.s;
}

bool CastQuery::admits_side(const Triangle& triangle) const noexcept {
  if (faces.options == nullptr || faces.options->back_faces == BackFaces::kHit) return true;
  const bool is_back = dot(unit_normal(triangle), moving.direction) > 0;
  return is_back == (faces.options->back_faces == BackFaces::kOnly);
}

Errc CastQuery::run() {
  if (tree.empty() || !meets(tree.root_lanes())) return Errc::kOk;
  const Errc walked = walk_nearest(tree, *this);
  return walked != Errc::kOk ? walked : error;
}

namespace {

// One cast of any shape.
class Cast {
 public:
  Cast(const Tree& queried, const ShapeInTree& shape, const Motion& motion,
       const FaceOptions& options)
      : tree_(BoundTree::of(queried)),
        shape_(shape),
        motion_(motion),
        work_(options.limits),
        options_(options) {
    // A shape that stays where it is goes nowhere along any direction.
    const double length = largest_magnitude(motion.direction);
    is_moving_ = length != 0;
    line_ = {shape.center, is_moving_ ? motion.direction : Eigen::Vector3d::UnitX(), 0,
             is_moving_ ? motion.t_max : 0};
    if (!(length <= std::numeric_limits<double>::max())) invalid_ = "direction";
    if (!(motion.t_max >= 0)) invalid_ = "t_max";
    if (shape.invalid != nullptr) invalid_ = shape.invalid;
  }

  /// The field that is not valid, or null.
  [[nodiscard]] const char* invalid() const { return invalid_; }

  /// `visitor`: of kAll, or null. `answer`: called with the query once it has walked the tree.
  /// Precondition: nothing is invalid.
  template <class Answer>
  Errc run(CastQuery::Wanted wanted, const CastQuery::Visitor* visitor, const Answer& answer) {
    WalkBound nodes(tree_.node_count(), &work_);
    CastQuery query(tree_, shape_.shape, line_, is_moving_, wanted, visitor, nodes, &options_);
    const Errc error = query.run();
    if (error == Errc::kOk) answer(query);
    return error;
  }

  [[nodiscard]] CastHit hit_of(const CastQuery& query, const CastCandidate& found) const {
    CastHit hit;
    hit.initially_touching = found.s == 0;
    const MovingShape::Contact contact = query.moving.contact_at(found.triangle, found.s);
    const int exponent = query.parameter_exponent;
    hit.t_lower = parameter_of(line_, found.s, exponent);
    hit.t = hit.initially_touching ? 0 : parameter_of(line_, contact.by, exponent);
    hit.face = found.face;
    name(tree_, hit.face);  // unless a visitor gets it, which has all named
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
  const FaceOptions& options_;
  Ray line_;  // of the shape's center
  bool is_moving_;
  const char* invalid_ = nullptr;
};

CastResult one_touch(const Tree& tree, const ShapeInTree& shape, const Motion& motion,
                     CastQuery::Wanted wanted, const FaceOptions& options) {
  const DefaultFloatState state;
  Cast cast(tree, shape, motion, options);
  if (cast.invalid() != nullptr) return {Errc::kInvalidQuery, cast.invalid()};
  CastResult result;
  const Errc error = cast.run(wanted, nullptr, [&](const CastQuery& query) {
    if (query.best.is_hit) result = cast.hit_of(query, query.best);
  });
  return error == Errc::kOk ? result : CastResult(error);
}

Result<Visit> all_touches(const Tree& tree, const ShapeInTree& shape, const Motion& motion,
                          CastVisitor visitor, const FaceOptions& options) {
  const DefaultFloatState state;
  Cast cast(tree, shape, motion, options);
  if (cast.invalid() != nullptr) return invalid_query(cast.invalid());
  Visit end = Visit::kComplete;
  const auto touched = [&](const CastQuery& query, const CastCandidate& found) {
    return RayInTree::scaled(visitor(cast.hit_of(query, found)), query.parameter_exponent);
  };
  const CastQuery::Visitor all(touched);
  const Errc error = cast.run(CastQuery::Wanted::kAll, &all, [&](const CastQuery& query) {
    end = query.faces.stopped ? Visit::kStopped : Visit::kComplete;
  });
  if (error != Errc::kOk) return error;
  return end;
}

}  // namespace

CastResult cast_closest(const Tree& tree, const Sphere& sphere, const Motion& motion,
                        const FaceOptions& options) {
  return one_touch(tree, in_tree(BoundTree::of(tree), sphere), motion, CastQuery::Wanted::kClosest,
                   options);
}
CastResult cast_closest(const Tree& tree, const Capsule& capsule, const Motion& motion,
                        const FaceOptions& options) {
  return one_touch(tree, in_tree(BoundTree::of(tree), capsule), motion, CastQuery::Wanted::kClosest,
                   options);
}
CastResult cast_closest(const Tree& tree, const OrientedBox& box, const Motion& motion,
                        const FaceOptions& options) {
  return one_touch(tree, in_tree(BoundTree::of(tree), box), motion, CastQuery::Wanted::kClosest,
                   options);
}

CastResult cast_any(const Tree& tree, const Sphere& sphere, const Motion& motion,
                    const FaceOptions& options) {
  return one_touch(tree, in_tree(BoundTree::of(tree), sphere), motion, CastQuery::Wanted::kAny,
                   options);
}
CastResult cast_any(const Tree& tree, const Capsule& capsule, const Motion& motion,
                    const FaceOptions& options) {
  return one_touch(tree, in_tree(BoundTree::of(tree), capsule), motion, CastQuery::Wanted::kAny,
                   options);
}
CastResult cast_any(const Tree& tree, const OrientedBox& box, const Motion& motion,
                    const FaceOptions& options) {
  return one_touch(tree, in_tree(BoundTree::of(tree), box), motion, CastQuery::Wanted::kAny,
                   options);
}

Result<Visit> cast_all(const Tree& tree, const Sphere& sphere, const Motion& motion,
                       CastVisitor visitor, const FaceOptions& options) {
  return all_touches(tree, in_tree(BoundTree::of(tree), sphere), motion, visitor, options);
}
Result<Visit> cast_all(const Tree& tree, const Capsule& capsule, const Motion& motion,
                       CastVisitor visitor, const FaceOptions& options) {
  return all_touches(tree, in_tree(BoundTree::of(tree), capsule), motion, visitor, options);
}
Result<Visit> cast_all(const Tree& tree, const OrientedBox& box, const Motion& motion,
                       CastVisitor visitor, const FaceOptions& options) {
  return all_touches(tree, in_tree(BoundTree::of(tree), box), motion, visitor, options);
}

}  // namespace boxtree
