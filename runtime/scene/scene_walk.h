// SPDX-License-Identifier: MIT
// How every query walks a scene: the top level of the file, then the tree over moving instances.
#pragma once

#include "runtime/primitive/rounding.h"
#include "runtime/primitive/vector3.h"
#include "runtime/query/scaled_length.h"
#include "runtime/scene/bound_scene.h"
#include "runtime/scene/top_level_walk.h"
#include "runtime/walk/traversal.h"
#include "runtime/walk/work.h"

namespace boxtree {

/// How far a box in the scene's frame may be from what is compared in units of the scene, for what
/// is at most `magnitude` from the origin on each axis: 64 roundings of magnitudes. The rounding of
/// the instance is in its box.
[[nodiscard]] inline double frame_error(const BoundScene& scene, double magnitude) noexcept {
  return 64 * kRoundoffF64 * (magnitude + largest_magnitude(scene.to_units(scene.frame().origin))) +
         kLengthUnderflow;
}

/// A squared distance in the scene's frame that covers everything within `distance`; `error`:
/// frame_error().
[[nodiscard]] inline double frame_bound(double distance, double error) noexcept {
  return (distance + error) * (distance + error) * (1 + 16 * kRoundoffF64);
}

/// Which instances a query admits, and its work limit.
struct Admission {
  const BoundScene& scene;
  QueryKinds kind;
  LayerMask layers;
  QueryWork& work;
  const InstanceFilter* filter = nullptr;  // null: every instance

  /// Not inlined: each query has several.
  [[nodiscard]] bool admits(std::uint32_t instance, std::uint32_t layer) const;
};

/// What is known of a query that visits instances one after the other.
struct InstanceOutcome {
  Errc error = Errc::kOk;
  bool stopped = false;

  [[nodiscard]] bool is_done() const noexcept { return error != Errc::kOk || stopped; }
  /// Keeps what came of an instance. Returns whether to go on.
  [[nodiscard]] bool note(const Result<Visit>& visited) noexcept {
    if (!visited) error = visited.code();
    stopped = visited && *visited == Visit::kStopped;
    return !is_done();
  }
};

/// What a query compares with boxes of instances by a box, in the scene's frame.
struct BoxInFrame {
  Box<double> in_frame;

  template <class Tree>
  [[nodiscard]] Errc walk(const Tree& tree, InstanceVisitor instances) const {
    return walk_instances(tree, instances, in_frame);
  }
};

// Members of the queries of a scene, below:
// query.visit(instance, const BoundScene::Placed&) -> bool: whether to go on.
// query.walk(tree, InstanceVisitor) -> Errc: walk_instances with the query's shape; `tree`: a
//   TopLevel or a MovingTree.
// query.admission; and query.error, which is set when an instance is corrupt.

/// Counts an instance and visits it; whether to go on.
template <class Query>
[[nodiscard]] bool visit_instance(Query& query, std::uint32_t instance,
                                  const BoundScene::Placed& placed) {
  if (!query.admission.work.take_one()) query.error = Errc::kWorkLimit;
  return query.error == Errc::kOk && query.visit(instance, placed);
}

/// Visits the static instances that the query may intersect, each at most once whatever the bytes.
template <class Query>
Errc walk_static(const BoundScene& scene, Query& query) {
  WalkBound visits(scene.instance_count());
  return query.walk(scene.top_level(), [&](std::uint32_t instance) {
    query.error = visits.count(NodeState::kValid);
    if (query.error != Errc::kOk) return false;
    if (scene.is_detached(instance)) return true;
    const std::optional<InstanceRecord> record = scene.record_of(instance);
    if (record && !query.admission.admits(instance, record->layer)) return true;
    const auto placed = record ? scene.place(instance, *record) : std::nullopt;
    if (!placed) query.error = Errc::kRecordInvalid;
    return placed && visit_instance(query, instance, *placed);
  });
}

/// Visits the moving instances that the query may intersect.
template <class Query>
Errc walk_moving(const BoundScene& scene, Query& query) {
  return query.walk(scene.moving_tree(), [&](std::uint32_t number) {
    const BoundScene::Moving& moving = scene.moving()[number];
    return !query.admission.admits(moving.instance, moving.placed.layer) ||
           visit_instance(query, moving.instance, moving.placed);
  });
}

/// Visits the instances whose boxes overlap. The query may stop it, and keeps errors of instances.
template <class Query>
Errc visit_overlapping_instances(const BoundScene& scene, Query& query) {
  const Errc walked = walk_static(scene, query);
  if (walked != Errc::kOk || query.is_done()) return walked;
  return walk_moving(scene, query);
}

/// The same from near to far. Moving instances come first: they are few, and near the query.
template <class Query>
Errc visit_nearest_instances(const BoundScene& scene, Query& query) {
  const Errc walked = walk_moving(scene, query);
  if (walked != Errc::kOk || query.is_done()) return walked;
  return walk_static(scene, query);
}

}  // namespace boxtree
