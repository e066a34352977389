// SPDX-License-Identifier: MIT
// Distance queries: one instance of the walk for each codec, and one for pairs of different codecs.
#include <variant>

#include <boxtree/runtime/query/distance.h>
#include <boxtree/runtime/query/distance_walk.h>
#include <boxtree/runtime/query/erased_codec.h>
#include <boxtree/runtime/query/float_state.h>
#include <boxtree/runtime/tree/dispatch.h>

namespace boxtree {
namespace {

struct Placed {
  const Tree& first;
  const Pose& first_pose;
  const Tree& second;
  const RelativePose& pose;
  const WorldMetric& metric;
};

template <Codec A, Codec B>
Result<Distance> search(const Placed& placed, const A& first_codec, const B& second_codec,
                        const Approximation& approximation) {
  DistanceWalk walk(placed.first, first_codec, placed.second, second_codec, placed.pose,
                    placed.metric, approximation);
  if (const Errc error = walk.run(); error != Errc::kOk) return error;
  Distance result;
  result.nodes_expanded = walk.visited();
  result.is_near_enough = !walk.is_spent();
  result.lower = placed.metric.length_below(walk.lower());
  const NearestPair& nearest = walk.nearest();
  const bool is_within = walk.lower() <= approximation.max_distance;
  if (is_within && nearest.upper < std::numeric_limits<double>::infinity()) {
    result.upper = placed.metric.length_above(nearest.upper);
    const Eigen::Vector3d origin =
        placed.first_pose * placed.first.frame().to_object(nearest.origin);
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

}  // namespace

Result<Distance> distance(const Tree& first, const Pose& first_pose, const Tree& second,
                          const Pose& second_pose, const DistanceOptions& options) {
  const DefaultFloatState state;
  if (!options.is_valid()) return Errc::kInvalidQuery;
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
  // By what is bound, not by what the records say: a tree of one leaf has no nodes to bind.
  if (first.codec_view().index() != second.codec_view().index()) {
    return search(placed, ErasedCodec{&first}, ErasedCodec{&second}, approximation);
  }
  return with_codec(first, [&]<class C>(const C& codec) {
    return search(placed, codec, std::get<C>(second.codec_view()), approximation);
  });
}

}  // namespace boxtree
