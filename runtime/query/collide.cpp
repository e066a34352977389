// SPDX-License-Identifier: MIT
// Contacts and overlaps of shapes: casts that stay where they are.
#include <algorithm>
#include <cstdint>

#include <boxtree/collide.h>

#include "runtime/primitive/float_state.h"
#include "runtime/primitive/penetration.h"
#include "runtime/primitive/vector3.h"
#include "runtime/query/cast_query.h"
#include "runtime/query/invalid_query.h"
#include "runtime/query/shape_in_tree.h"

namespace boxtree {
namespace {

// Calls visit(query, candidate) -> bool, whether to go on, with each triangle that is touched.
template <class Visitor>
Result<Visit> visit_touched(const BoundTree& tree, const ShapeInTree& shape,
                            const QueryLimits& limits, const Visitor& visit) {
  if (shape.invalid != nullptr) return invalid_query(shape.invalid);
  QueryWork work(limits);
  WalkBound nodes(tree.node_count(), &work);
  const auto touched = [&](const CastQuery& query, const CastCandidate& found) {
    return visit(query, found) ? 0.0 : -1.0;
  };
  const CastQuery::Visitor visitor(touched);
  // A line of no length along any direction.
  const Ray line{shape.center, Eigen::Vector3d::UnitX(), 0, 0};
  CastQuery query(tree, {shape.shape, line, false}, CastQuery::Wanted::kAll, &visitor, nodes);
  if (const Errc error = query.run(); error != Errc::kOk) return error;
  return query.faces.stopped ? Visit::kStopped : Visit::kComplete;
}

template <class Shape>
Result<Visit> visit_contacts(const Tree& queried, const Shape& shape, ContactVisitor visitor,
                             const QueryLimits& limits) {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(queried);
  return visit_touched(tree, in_tree(tree.frame(), shape), limits,
                       [&](const CastQuery& query, const CastCandidate& found) {
                         const ConvexShape& placed = query.moving.shape;
                         const Penetration at =
                             penetration(placed, relative_to(placed.center, found.triangle),
                                         query.moving.doubt);
                         Contact contact;
                         contact.face = found.face;
                         contact.triangle = found.half;
                         contact.point = tree.frame().to_object(placed.center + at.point);
                         contact.normal = at.normal;
                         contact.depth = at.depth * tree.frame().scale;
                         contact.feature = at.feature;
                         return visitor(contact);
                       });
}

// Tells the second triangle of a quad that was visited already from others, leaf by leaf.
class VisitedFaces {
 public:
  // Whether the face, or the original of this copy, comes for the first time.
  bool is_new(const CastCandidate& found) {
    if (found.face.index != found.original) return is_new_;  // copies follow their original
    if (found.original / kLeafFaces != leaf_) {
      leaf_ = found.original / kLeafFaces;
      visited_ = 0;
    }
    const std::uint32_t bit = 1u << (found.original % kLeafFaces);
    is_new_ = (visited_ & bit) == 0;
    visited_ |= bit;
    return is_new_;
  }

 private:
  std::uint32_t leaf_ = ~std::uint32_t{0};
  std::uint32_t visited_ = 0;  // bit i: face i of the leaf
  bool is_new_ = true;
};

template <class Shape>
Result<Visit> visit_faces_of(const Tree& queried, const Shape& shape, FaceVisitor visitor,
                             const QueryLimits& limits) {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(queried);
  VisitedFaces visited;
  return visit_touched(tree, in_tree(tree.frame(), shape), limits,
                       [&](const CastQuery&, const CastCandidate& found) {
                         return !visited.is_new(found) || visitor(found.face);
                       });
}

}  // namespace

Result<Visit> collide(const Tree& tree, const Sphere& sphere, ContactVisitor visitor,
                      const QueryLimits& limits) {
  return visit_contacts(tree, sphere, visitor, limits);
}
Result<Visit> collide(const Tree& tree, const Capsule& capsule, ContactVisitor visitor,
                      const QueryLimits& limits) {
  return visit_contacts(tree, capsule, visitor, limits);
}
Result<Visit> collide(const Tree& tree, const OrientedBox& box, ContactVisitor visitor,
                      const QueryLimits& limits) {
  return visit_contacts(tree, box, visitor, limits);
}

Result<Visit> overlap_capsule(const Tree& tree, const Capsule& capsule, FaceVisitor visitor,
                              const QueryLimits& limits) {
  return visit_faces_of(tree, capsule, visitor, limits);
}
Result<Visit> overlap_oriented_box(const Tree& tree, const OrientedBox& box, FaceVisitor visitor,
                                   const QueryLimits& limits) {
  return visit_faces_of(tree, box, visitor, limits);
}

std::size_t merge_contacts(std::span<Contact> contacts, double distance, double cosine) {
  const auto is_same = [&](const Contact& a, const Contact& b) {
    const Eigen::Vector3d between = a.point - b.point;
    return std::sqrt(squared_length(between)) <= distance && dot(a.normal, b.normal) >= cosine;
  };
  std::size_t kept = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    std::size_t same = 0;
    while (same < kept && !is_same(contacts[same], contacts[i])) ++same;
    if (same == kept) {
      contacts[kept++] = contacts[i];
    } else if (contacts[i].depth > contacts[same].depth) {
      contacts[same] = contacts[i];
    }
  }
  return kept;
}

}  // namespace boxtree
