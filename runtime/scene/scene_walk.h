// SPDX-License-Identifier: MIT
// How every query walks a scene: the top level of the file, then the tree over moving instances.
#pragma once

#include <boxtree/runtime/query/traversal.h>
#include <boxtree/runtime/scene/scene.h>

namespace boxtree {

/// Which instances a query is for.
struct Admission {
  const Scene& scene;
  QueryKinds kind;
  LayerMask layers;

  [[nodiscard]] bool admits(std::uint32_t layer) const noexcept {
    return ((layers >> layer) & 1u) != 0 && (scene.layer(layer).query_kinds & kind) != 0;
  }
};

/// What the templates of query/traversal.h ask of boxes, in the scene's frame, passed on to
/// `Query`, whose leaves are instances: query.visit(instance, const Scene::Placed&) -> bool:
/// whether to go on query.admission, and query.error, which is set when an instance is corrupt.
template <class Query>
struct InstanceBoxes {
  Query& query;

  [[nodiscard]] double bound() const noexcept { return query.bound(); }
  template <class S>
  [[nodiscard]] double key(const Box<S>& box) const noexcept {
    return query.key(box);
  }
  template <class S>
  [[nodiscard]] bool overlaps(const Box<S>& box) const noexcept {
    return query.overlaps(box);
  }
};

template <class Query>
struct StaticLeaves : InstanceBoxes<Query> {
  [[nodiscard]] bool leaf(NodeRef ref) {
    Query& asked = this->query;
    const Scene& scene = asked.admission.scene;
    const std::uint32_t instance = scene.top_level().instance(ref);
    if (scene.is_detached(instance)) return true;
    const std::optional<Scene::Placed> placed = scene.place(instance, asked.error);
    if (!placed) return false;
    return !asked.admission.admits(placed->layer) || asked.visit(instance, *placed);
  }
};

template <class Query>
struct MovingLeaves : InstanceBoxes<Query> {
  [[nodiscard]] bool leaf(NodeRef ref) {
    Query& asked = this->query;
    const Scene& scene = asked.admission.scene;
    const Scene::Moving& moving = scene.moving()[scene.moving_tree().moving(ref)];
    return !asked.admission.admits(moving.placed.layer) ||
           asked.visit(moving.instance, moving.placed);
  }
};

/// Visits the instances whose boxes overlap; the query may stop it, and holds errors of instances.
template <class Query>
Errc walk_overlap(const Scene& scene, Query& query) {
  StaticLeaves<Query> resting{{query}};
  const Errc walked = traverse_overlap(scene.top_level(), scene.top_level().codec, resting);
  if (walked != Errc::kOk || query.is_done()) return walked;
  MovingLeaves<Query> moving{{query}};
  return traverse_overlap(scene.moving_tree(), scene.moving_tree().codec(), moving);
}

/// The same from near to far. Moving instances come first: they are few, and near what asks.
template <class Query>
Errc walk_nearest(const Scene& scene, Query& query) {
  MovingLeaves<Query> moving{{query}};
  const Errc walked = traverse_nearest(scene.moving_tree(), scene.moving_tree().codec(), moving);
  if (walked != Errc::kOk || query.is_done()) return walked;
  StaticLeaves<Query> resting{{query}};
  return traverse_nearest(scene.top_level(), scene.top_level().codec, resting);
}

}  // namespace boxtree
