// SPDX-License-Identifier: MIT
// Contacts in a scene: candidates by their boxes in the world, then tree against tree.
#include "runtime/primitive/float_state.h"
#include "runtime/query/pair_query.h"
#include "runtime/scene/scene_pairs.h"

namespace boxtree {
namespace {

// One body tested against all instances that its box overlaps.
struct BodyInScene : BoxInFrame, InstanceOutcome {
  BodyInScene(const BoundScene& scene, const SceneBody& of, BodyPairVisitor pairs,
              QueryWork& work) noexcept
      : BoxInFrame{of.in_frame},
        admission{scene, kPairQueries, of.layers, work},
        body(of),
        visitor(pairs) {}

  Admission admission;
  const SceneBody& body;
  BodyPairVisitor visitor;

  [[nodiscard]] bool visit(std::uint32_t instance, const BoundScene::Placed& other) {
    return instance == body.instance ||
           note(visitor(body.pair_with(instance, other), admission.work));
  }
};

// A moving body against those instances of the tree over moving ones with which it makes a pair
// that has not been looked at: static ones, and moving ones that come after it.
struct LaterMoving {
  BodyInScene& in_scene;
  const Admission& admission;
  Errc& error;

  [[nodiscard]] bool is_done() const noexcept { return in_scene.is_done(); }
  template <class Tree>
  [[nodiscard]] Errc walk(const Tree& tree, InstanceVisitor instances) const {
    return in_scene.walk(tree, instances);
  }
  [[nodiscard]] bool visit(std::uint32_t instance, const BoundScene::Placed& other) {
    return (instance <= in_scene.body.instance && !other.at_rest) ||
           in_scene.visit(instance, other);
  }
};

// Whatever the body meets, if there is one.
Result<Visit> visit_pairs_of_body(const BoundScene& scene, const std::optional<SceneBody>& body,
                                  BodyPairVisitor visitor, const QueryLimits& limits) {
  if (!body) return Visit::kComplete;
  QueryWork work(limits);
  BodyInScene in_scene(scene, *body, visitor, work);
  return outcome_of(visit_overlapping_instances(scene, in_scene), in_scene);
}

}  // namespace

Result<Visit> visit_moving_pairs(const BoundScene& scene, BodyPairVisitor visitor,
                                 const QueryLimits& limits) {
  QueryWork work(limits);
  if ((scene.query_kinds() & kPairQueries) == 0) return Errc::kPartLeftOut;
  for (const BoundScene::Moving& moving : scene.moving()) {
    if (moving.placed.at_rest) continue;
    const SceneBody body = moving_body(scene, moving);
    if (body.layers == 0) continue;
    BodyInScene in_scene(scene, body, visitor, work);
    Errc walked = walk_static(scene, in_scene);
    if (walked == Errc::kOk && !in_scene.is_done()) {
      LaterMoving later{in_scene, in_scene.admission, in_scene.error};
      walked = walk_moving(scene, later);
    }
    Result<Visit> visit = outcome_of(walked, in_scene);
    if (!visit || *visit == Visit::kStopped) return visit;
  }
  return Visit::kComplete;
}

Result<Visit> visit_pairs_of(const BoundScene& scene, std::uint32_t instance,
                             BodyPairVisitor visitor, const QueryLimits& limits) {
  std::optional<SceneBody> body;
  if (const Errc error = find_body(scene, instance, body); error != Errc::kOk) return error;
  return visit_pairs_of_body(scene, body, visitor, limits);
}

Result<Visit> visit_pairs_with(const BoundScene& scene, const BoundTree& tree, const Pose& pose,
                               BodyPairVisitor visitor, LayerMask layers,
                               const QueryLimits& limits) {
  std::optional<SceneBody> body;
  if (const Errc error = place_body(scene, tree, pose, layers, body); error != Errc::kOk) {
    return error;
  }
  return visit_pairs_of_body(scene, body, visitor, limits);
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
