// SPDX-License-Identifier: MIT
// Distance queries.
#include <boxtree/distance.h>

#include "runtime/primitive/float_state.h"
#include "runtime/primitive/vector3.h"
#include "runtime/query/distance_query.h"
#include "runtime/query/distance_walk.h"
#include "runtime/query/invalid_query.h"

namespace boxtree {
namespace {

struct Placed {
  const BoundTree& first;
  const Pose& first_pose;
  const BoundTree& second;
  const RelativePose& pose;
  const WorldMetric& metric;
};

Distance answer(const Placed& placed, const DistanceWalk& walk) {
  Distance result;
  result.nodes_expanded = walk.visited();
  result.converged = !walk.is_spent();
  result.lower = placed.metric.length_below(walk.lower());
  const NearestPair& nearest = walk.nearest();
  if (walk.has_found()) {
    result.upper = placed.metric.length_above(nearest.upper);
    const Eigen::Vector3d origin =
        product(placed.first_pose.linear(), placed.first.frame().to_object(nearest.origin)) +
        placed.first_pose.translation();
    const auto to_world = [&](const Eigen::Vector3d& point) -> Eigen::Vector3d {
      const int exponent = placed.metric.exponent();
      return {origin[0] + std::ldexp(point[0], exponent),
              origin[1] + std::ldexp(point[1], exponent),
              origin[2] + std::ldexp(point[2], exponent)};
    };
    result.witness =
        DistanceWitness{nearest.faces, to_world(nearest.first), to_world(nearest.second)};
  }
  return result;
}

// Apart from distance(), so that its stack is not there while nearby_leaves() has its own.
[[gnu::noinline]] Result<Distance> search(const Placed& placed, const Approximation& approximation,
                                          double root_distance,
                                          const std::optional<NearbyLeaves>& nearby) {
  DistanceWalk walk(placed.first, placed.second, placed.pose, placed.metric, approximation);
  if (const Errc error = walk.run(root_distance, nearby); error != Errc::kOk) return error;
  return answer(placed, walk);
}

}  // namespace

Result<Distance> distance(const Tree& first, const Pose& first_pose, const Tree& second,
                          const Pose& second_pose, const DistanceOptions& options) {
  const DefaultFloatState state;
  if (const char* field = invalid_field(options)) return invalid_query(field);
  return distance_of_trees(BoundTree::of(first), first_pose, BoundTree::of(second), second_pose,
                           options);
}

Result<Distance> distance_of_trees(const BoundTree& first, const Pose& first_pose,
                                   const BoundTree& second, const Pose& second_pose,
                                   const DistanceOptions& options) {
  const std::optional<RelativePose> pose =
      RelativePose::make(first, first_pose, second, second_pose);
  if (!pose) return Errc::kInvalidPose;
  const std::optional<WorldMetric> metric = WorldMetric::make(first, first_pose, second, *pose);
  if (!metric) return Errc::kInvalidPose;
  if (first.empty() || second.empty()) {
    Distance nothing;
    nothing.lower = std::numeric_limits<double>::infinity();
    return nothing;
  }
  Approximation approximation = options;
  approximation.absolute_error = metric->from_world_above(options.absolute_error);
  approximation.max_distance = metric->from_world_above(options.max_distance);
  const Placed placed{first, first_pose, second, *pose, *metric};
  const double root_distance =
      metric->squared_distance(root_box<double>(first), root_box<double>(second), *pose);
  std::optional<NearbyLeaves> nearby;
  if (options.node_budget > 0 && root_below(root_distance) <= approximation.max_distance) {
    nearby = nearby_leaves(first, second, *pose);
  }
  return search(placed, approximation, root_distance, nearby);
}

}  // namespace boxtree
