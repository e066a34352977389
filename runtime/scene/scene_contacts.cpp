// SPDX-License-Identifier: MIT
// Contacts in a scene: candidates by their boxes in the world, then tree against tree.
#include "runtime/primitive/float_state.h"
#include "runtime/query/pair_query.h"
#include "runtime/scene/scene_pairs.h"

namespace boxtree {
namespace {

// One body tested against all instances that its box overlaps. Boxes are widened by the rounding
// between the world and the space in which two trees are compared (PlacementBounds::error), each by
// its own tree's share. The first tree of a comparison is the one whose pose magnifies errors less,
// so both shares suffice.
struct BodyInScene : BoxInFrame, InstanceOutcome {
  Admission admission;
  const BoundTree& tree;
  const Pose& pose;
  double condition;            // of its placement
  std::uint32_t own_instance;  // kNoInstance for a body that is no part of the scene
  bool is_first;               // in reports
  BodyPairVisitor visitor;

  [[nodiscard]] bool visit(std::uint32_t instance, const BoundScene::Placed& other) {
    if (instance == own_instance) return true;
    const BodyPair::Placed own{own_instance, tree, pose}, met{instance, *other.tree, other.pose};
    return note(other.placement.condition() < condition
                    ? visitor({met, own, is_first}, admission.work)
                    : visitor({own, met, !is_first}, admission.work));
  }
};

// A moving body against those instances of the tree over moving ones with which it makes a pair
// that has not been looked at: static ones, and moving ones that come after it.
struct LaterMoving {
  BodyInScene& body;
  const Admission& admission;
  Errc& error;

  [[nodiscard]] bool is_done() const noexcept { return body.is_done(); }
  template <class S>
  [[nodiscard]] bool overlaps(const Box<S>& box) const noexcept {
    return body.overlaps(box);
  }
  [[nodiscard]] bool visit(std::uint32_t instance, const BoundScene::Placed& other) {
    return (instance <= body.own_instance && !other.at_rest) || body.visit(instance, other);
  }
};

BodyInScene body_of(const BoundScene& scene, std::uint32_t instance,
                    const BoundScene::Placed& placed, const PlacementBounds& bounds,
                    BodyPairVisitor visitor, QueryWork& work) {
  return {{scene.to_frame(bounds.world)},
          {},
          {scene, kPairQueries, scene.layer(placed.layer).collides_with, work},
          *placed.tree,
          placed.pose,
          bounds.condition,
          instance,
          true,
          visitor};
}

bool answers_contacts(const BoundScene& scene, std::uint32_t instance, std::uint32_t layer) {
  return scene.is_enabled(instance) && (scene.layer(layer).query_kinds & kPairQueries) != 0;
}

}  // namespace

Result<Visit> visit_moving_pairs(const BoundScene& scene, BodyPairVisitor visitor,
                                 const QueryLimits& limits) {
  QueryWork work(limits);
  if ((scene.query_kinds() & kPairQueries) == 0) return Errc::kPartLeftOut;
  for (const BoundScene::Moving& moving : scene.moving()) {
    if (moving.placed.at_rest || !answers_contacts(scene, moving.instance, moving.placed.layer)) {
      continue;
    }
    BodyInScene body = body_of(scene, moving.instance, moving.placed, moving.bounds, visitor, work);
    Errc walked = walk_static(scene, body);
    if (walked == Errc::kOk && !body.is_done()) {
      LaterMoving later{body, body.admission, body.error};
      MovingInstances<LaterMoving> others(later, scene.moving_tree());
      walked = traverse_overlap(scene.moving_tree(), scene.moving_tree().decoder(), others);
    }
    Result<Visit> visit = outcome_of(walked, body);
    if (!visit || *visit == Visit::kStopped) return visit;
  }
  return Visit::kComplete;
}

Result<Visit> visit_pairs_of(const BoundScene& scene, std::uint32_t instance,
                             BodyPairVisitor visitor, const QueryLimits& limits) {
  QueryWork work(limits);
  if ((scene.query_kinds() & kPairQueries) == 0) return Errc::kPartLeftOut;
  if (instance >= scene.instance_count()) return Errc::kInstanceIndex;
  const std::optional<BoundScene::Placed> placed = scene.place_now(instance);
  if (!placed) return Errc::kRecordInvalid;
  if (!answers_contacts(scene, instance, placed->layer)) return Visit::kComplete;
  const auto bounds = placed->bounds();
  if (!bounds) return Errc::kRecordInvalid;
  BodyInScene body = body_of(scene, instance, *placed, *bounds, visitor, work);
  return outcome_of(visit_overlapping_instances(scene, body), body);
}

Result<Visit> visit_pairs_with(const BoundScene& scene, const BoundTree& tree, const Pose& pose,
                               BodyPairVisitor visitor, LayerMask layers,
                               const QueryLimits& limits) {
  QueryWork work(limits);
  if ((scene.query_kinds() & kPairQueries) == 0) return Errc::kPartLeftOut;
  const std::optional<Placement> placement = scene.place_in_units(tree, pose);
  if (!placement) return Errc::kInvalidPose;
  if (tree.empty()) return Visit::kComplete;
  const auto bounds = placement->bounds(root_box<double>(tree));
  if (!bounds) return Errc::kInvalidPose;
  BodyInScene body{{scene.to_frame(bounds->world)},
                   {},
                   {scene, kPairQueries, layers, work},
                   tree,
                   pose,
                   bounds->condition,
                   kNoInstance,
                   false,
                   visitor};
  return outcome_of(visit_overlapping_instances(scene, body), body);
}

namespace {

// Passes on the pairs of faces of two bodies.
struct FacePairs {
  ScenePairVisitor visitor;

  Result<Visit> operator()(const BodyPair& pair, QueryWork& work) const {
    const auto report = [&](const FacePair& faces) {
      const SceneFace a{pair.first.instance, faces.first};
      const SceneFace b{pair.second.instance, faces.second};
      return pair.is_reported_swapped ? visitor({b, a}) : visitor({a, b});
    };
    return visit_pairs(pair.first.tree, pair.first.pose, pair.second.tree, pair.second.pose, report,
                       work);
  }
};

}  // namespace

Result<Visit> contacts(const Scene& scene, ScenePairVisitor visitor, const QueryLimits& limits) {
  const DefaultFloatState state;
  return visit_moving_pairs(BoundScene::of(scene), FacePairs{visitor}, limits);
}

Result<Visit> contacts_of(const Scene& scene, std::uint32_t instance, ScenePairVisitor visitor,
                          const QueryLimits& limits) {
  const DefaultFloatState state;
  return visit_pairs_of(BoundScene::of(scene), instance, FacePairs{visitor}, limits);
}

Result<Visit> overlap_pairs(const Scene& scene, const Tree& tree, const Pose& pose,
                            ScenePairVisitor visitor, LayerMask layers, const QueryLimits& limits) {
  const DefaultFloatState state;
  return visit_pairs_with(BoundScene::of(scene), BoundTree::of(tree), pose, FacePairs{visitor},
                          layers, limits);
}

}  // namespace boxtree
