// SPDX-License-Identifier: MIT
// Contacts and overlaps of shapes: casts that stay where they are.
#include <algorithm>
#include <cstdint>

#include <boxtree/collide.h>

#include "runtime/primitive/float_state.h"
#include "runtime/primitive/penetration.h"
#include "runtime/primitive/vector3.h"
#include "runtime/query/collide_query.h"
#include "runtime/query/invalid_query.h"
#include "runtime/query/shape_casts.h"
#include "runtime/query/touched_feature.h"

namespace boxtree {
Contact contact_of(const CastQuery& query, const CastCandidate& found,
                   const Frame& frame) noexcept {
  const Penetration& at = found.at;
  Contact contact;
  contact.face = found.face;
  contact.triangle = found.half;
  contact.point = frame.to_object(query.moving.shape.center + at.point);
  contact.normal = at.normal;
  contact.depth = at.depth * frame.scale;
  contact.face_normal = found.face_normal;
  set_feature(query.tree, found, at.feature, contact);
  return contact;
}

namespace {

// `visit`: of visit_touched.
template <class Visitor>
Result<Visit> visit_touched_by(const BoundTree& tree, const ShapeInTree& shape,
                               const QueryLimits& limits, CastQuery::Wanted wanted,
                               const Visitor& visit) {
  if (shape.invalid != nullptr) return invalid_query(shape.invalid);
  QueryWork work(limits);
  return visit_touched(tree, {shape.shape, line_at(shape.center), false}, wanted, work, visit);
}

}  // namespace

Result<Visit> visit_contacts_in(const BoundTree& tree, const ShapeInTree& shape,
                                ContactVisitor visitor, const QueryLimits& limits) {
  return visit_touched_by(tree, shape, limits, CastQuery::Wanted::kContacts,
                          [&](const CastQuery& query, const CastCandidate& found) {
                            return visitor(contact_of(query, found, tree.frame()));
                          });
}

Result<Visit> visit_touched_faces_in(const BoundTree& tree, const ShapeInTree& shape,
                                     FaceVisitor visitor, const QueryLimits& limits) {
  VisitedFaces visited;
  return visit_touched_by(tree, shape, limits, CastQuery::Wanted::kFaces,
                          [&](const CastQuery&, const CastCandidate& found) {
                            return !visited.is_new(found) || visitor(found.face);
                          });
}

namespace {

template <class Shape>
Result<Visit> visit_contacts(const Tree& queried, const Shape& shape, ContactVisitor visitor,
                             const QueryLimits& limits) {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(queried);
  return visit_contacts_in(tree, in_tree(tree.frame(), shape), visitor, limits);
}

template <class Shape>
Result<Visit> visit_faces_of(const Tree& queried, const Shape& shape, FaceVisitor visitor,
                             const QueryLimits& limits) {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(queried);
  return visit_touched_faces_in(tree, in_tree(tree.frame(), shape), visitor, limits);
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

Eigen::Vector3d resolved_normal(const Contact& contact, const Eigen::Vector3d& velocity) {
  const DefaultFloatState state;
  return resolved(contact.normal, contact.face_normal, contact.is_active, velocity);
}

std::size_t merge_contacts(std::span<Contact> contacts, double distance, double cosine) {
  return merge(contacts, distance, cosine);
}

}  // namespace boxtree
