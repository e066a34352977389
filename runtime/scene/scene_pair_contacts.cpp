// SPDX-License-Identifier: MIT
// Where triangles of a scene touch those of what moves, or of a body that is no part of it.
#include <utility>

#include "runtime/primitive/float_state.h"
#include "runtime/query/pair_query.h"
#include "runtime/scene/scene_pairs.h"

namespace boxtree {
namespace {

// Passes on the contacts of two bodies.
struct ContactsOfPair {
  ScenePairContactVisitor visitor;

  Result<Visit> operator()(const BodyPair& pair, QueryWork& work) const {
    const auto report = [&](const PairContact& found) {
      ScenePairContact contact{found, pair.first.instance, pair.second.instance};
      if (pair.is_reported_swapped) {
        std::swap(contact.faces.first, contact.faces.second);
        std::swap(contact.first_triangle, contact.second_triangle);
        std::swap(contact.first_instance, contact.second_instance);
        contact.normal = -contact.normal;
      }
      return visitor(contact);
    };
    return visit_pair_contacts(pair.first.tree, pair.first.pose, pair.second.tree, pair.second.pose,
                               report, work);
  }
};

}  // namespace

Result<Visit> pair_contacts(const Scene& scene, ScenePairContactVisitor visitor,
                            const QueryLimits& limits) {
  const DefaultFloatState state;
  return visit_moving_pairs(BoundScene::of(scene), ContactsOfPair{visitor}, limits);
}

Result<Visit> pair_contacts_of(const Scene& scene, std::uint32_t instance,
                               ScenePairContactVisitor visitor, const QueryLimits& limits) {
  const DefaultFloatState state;
  return visit_pairs_of(BoundScene::of(scene), instance, ContactsOfPair{visitor}, limits);
}

Result<Visit> pair_contacts(const Scene& scene, const Tree& tree, const Pose& pose,
                            ScenePairContactVisitor visitor, LayerMask layers,
                            const QueryLimits& limits) {
  const DefaultFloatState state;
  return visit_pairs_with(BoundScene::of(scene), BoundTree::of(tree), pose, ContactsOfPair{visitor},
                          layers, limits);
}

}  // namespace boxtree
