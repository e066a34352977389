// SPDX-License-Identifier: MIT
#include "runtime/scene/scene_body.h"

#include "runtime/tree/root_box.h"

namespace boxtree {
namespace {

// An instance that answers no queries of pairs meets nothing.
LayerMask layers_met(const BoundScene& scene, std::uint32_t instance, std::uint32_t layer) {
  const LayerRecord record = scene.layer(layer);
  const bool answers = scene.is_enabled(instance) && (record.query_kinds & kPairQueries) != 0;
  return answers ? record.collides_with : 0;
}

SceneBody body_of(const BoundScene& scene, std::uint32_t instance, const BoundScene::Placed& placed,
                  const PlacementBounds& bounds) {
  return {placed.tree,      placed.pose, scene.to_frame(bounds.world),
          bounds.condition, instance,    layers_met(scene, instance, placed.layer)};
}

}  // namespace

SceneBody moving_body(const BoundScene& scene, const BoundScene::Moving& moving) {
  return body_of(scene, moving.instance, moving.placed, moving.bounds);
}

Errc find_body(const BoundScene& scene, std::uint32_t instance, std::optional<SceneBody>& body) {
  if ((scene.query_kinds() & kPairQueries) == 0) return Errc::kPartLeftOut;
  if (instance >= scene.instance_count()) return Errc::kInstanceIndex;
  const std::optional<BoundScene::Placed> placed = scene.place_now(instance);
  if (!placed) return Errc::kRecordInvalid;
  if (layers_met(scene, instance, placed->layer) == 0) return Errc::kOk;
  const auto bounds = placed->bounds();
  if (!bounds) return Errc::kRecordInvalid;
  body.emplace(body_of(scene, instance, *placed, *bounds));
  return Errc::kOk;
}

Errc place_body(const BoundScene& scene, const BoundTree& tree, const Pose& pose, LayerMask layers,
                std::optional<SceneBody>& body) {
  if ((scene.query_kinds() & kPairQueries) == 0) return Errc::kPartLeftOut;
  const std::optional<Placement> placement = scene.place_in_units(tree, pose);
  if (!placement) return Errc::kInvalidPose;
  if (tree.empty()) return Errc::kOk;
  const auto bounds = placement->bounds(root_box<double>(tree));
  if (!bounds) return Errc::kInvalidPose;
  body.emplace(SceneBody{&tree, pose, scene.to_frame(bounds->world), bounds->condition, kNoInstance,
                         layers});
  return Errc::kOk;
}

}  // namespace boxtree
