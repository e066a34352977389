// SPDX-License-Identifier: MIT
// A body beside the instances of a scene: one of these, or a tree that is no part of it. What
// queries of pairs compare with instances.
#pragma once

#include <cstdint>
#include <optional>

#include "runtime/scene/bound_scene.h"

namespace boxtree {

/// A body and an instance, in the order in which their trees are compared: the first one's pose
/// magnifies errors less.
struct BodyPair {
  struct Placed {
    std::uint32_t instance;  // kNoInstance for a body that is no part of the scene
    const BoundTree& tree;
    const Pose& pose;
  };
  Placed first;
  Placed second;
  bool is_reported_swapped;  // whether answers name the second one first
};

/// A tree in a pose, and where that is. Boxes are widened by the rounding between the world and the
/// space in which two trees are compared (PlacementBounds::error), each by its own tree's share.
/// The first tree of a comparison is the one whose pose magnifies errors less, so both shares
/// suffice.
struct SceneBody {
  const BoundTree* tree;
  Pose pose;
  Box<double> in_frame;    // its box in the scene's frame
  double condition;        // of its placement
  std::uint32_t instance;  // kNoInstance for a body that is no part of the scene
  LayerMask layers;        // whose instances it meets

  /// Answers name an instance before what it meets, and what it meets before another body.
  [[nodiscard]] BodyPair pair_with(std::uint32_t other_instance,
                                   const BoundScene::Placed& other) const noexcept {
    const BodyPair::Placed own{instance, *tree, pose};
    const BodyPair::Placed met{other_instance, *other.tree, other.pose};
    const bool is_named_first = instance != kNoInstance;
    return other.placement.condition() < condition ? BodyPair{met, own, is_named_first}
                                                   : BodyPair{own, met, !is_named_first};
  }
};

/// An instance that moves, of a scene that answers queries of pairs. It meets no layers where it
/// answers none.
SceneBody moving_body(const BoundScene& scene, const BoundScene::Moving& moving);
/// An instance where it is now; nothing where it answers no queries of pairs. Errors: kPartLeftOut,
/// kInstanceIndex, kRecordInvalid.
Errc find_body(const BoundScene& scene, std::uint32_t instance, std::optional<SceneBody>& body);
/// A tree that is no part of the scene; nothing where it is empty. Errors: kPartLeftOut,
/// kInvalidPose.
Errc place_body(const BoundScene& scene, const BoundTree& tree, const Pose& pose, LayerMask layers,
                std::optional<SceneBody>& body);

}  // namespace boxtree
