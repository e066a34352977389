// SPDX-License-Identifier: MIT
// The instances of a scene from near to far of a point.
#pragma once

#include <cstdint>

#include "runtime/scene/scene_walk.h"

namespace boxtree {

/// Instances from near to far of a point, by their boxes. Compiled once, for what takes longer at
/// each instance than it takes to come there.
class NearPointWalk {
 public:
  /// Receives an instance; may lower the bound. An error ends the walk.
  using Visitor = FunctionRef<Errc(NearPointWalk& walk, std::uint32_t instance,
                                   const BoundScene::Placed& placed)>;

  /// `point`: in the scene's frame.
  NearPointWalk(const Admission& admitted, const Eigen::Vector3d& point, Visitor visitor) noexcept
      : admission(admitted), point_(point), visitor_(visitor) {}

  /// Those beyond `distance` are left out from now on; boxes may be off by `missing`.
  void set_bound(double distance, double missing) noexcept {
    bound_ = frame_bound(distance, missing);
  }

  /// Visits them. Errors: those of the visitor; kWorkLimit; those of corrupt bytes.
  [[nodiscard]] Errc run();

  // As the query of visit_nearest_instances().
  [[nodiscard]] bool is_done() const noexcept { return error != Errc::kOk; }
  template <class Tree>
  [[nodiscard]] Errc walk(const Tree& tree, InstanceVisitor instances) const {
    return walk_instances(tree, instances, point_, bound_);
  }
  [[nodiscard]] bool visit(std::uint32_t instance, const BoundScene::Placed& placed) {
    error = visitor_(*this, instance, placed);
    return error == Errc::kOk;
  }
  Admission admission;
  Errc error = Errc::kOk;

 private:
  Eigen::Vector3d point_;
  double bound_ = 0;  // squared
  Visitor visitor_;
};

}  // namespace boxtree
