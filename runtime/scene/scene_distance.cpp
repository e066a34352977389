// SPDX-License-Identifier: MIT
// Distances in a scene: instances by how far their boxes are from that of the body, then tree
// against tree.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include <boxtree/scene_distance.h>

#include "runtime/primitive/float_state.h"
#include "runtime/primitive/rounding.h"
#include "runtime/query/approximation.h"
#include "runtime/query/distance_query.h"
#include "runtime/query/invalid_query.h"
#include "runtime/query/relative_pose.h"
#include "runtime/query/world_metric.h"
#include "runtime/scene/near_point_walk.h"
#include "runtime/scene/scene_body.h"
#include "runtime/scene/scene_walk.h"
#include "runtime/tree/float_range.h"

namespace boxtree {
namespace {

// An instance, and how far it is from the body at least, by their boxes.
struct NearInstance {
  float gap;  // in units of the scene, rounded down
  std::uint32_t instance;

  // The order in which instances are compared: the same whatever order a walk finds them in, so
  // that answers do not depend on how a build walks.
  friend bool operator<(const NearInstance& a, const NearInstance& b) noexcept {
    return a.gap != b.gap ? a.gap < b.gap : a.instance < b.instance;
  }
};

// Finds the `room` instances after `last` that are nearest to a body. Walks compare boxes with the
// center of the body's.
class NearInstances {
 public:
  // Of the first turn: few, since what they are compared by bounds the walks of the others.
  static constexpr std::size_t kFirstRoom = 16;
  // So many that a body in the midst of thousands has a few turns, and as few as the stack has room
  // for (threads.md).
  static constexpr std::size_t kRoom = 1024;

  // Precondition: room is at most kRoom.
  NearInstances(const BoundScene& scene, const SceneBody& body, const NearInstance& last,
                std::size_t room, double most, QueryWork& work) noexcept
      : scene_(scene),
        body_(body),
        work_(work),
        last_(last),
        room_(room),
        most_(most),
        center_(center(body.in_frame)) {
    double squared = 0, magnitude = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double low = body.in_frame.low[k], high = body.in_frame.high[k];
      squared += (high / 2 - low / 2) * (high / 2 - low / 2);
      magnitude = std::max({magnitude, std::abs(low), std::abs(high)});
    }
    radius_ = std::sqrt(squared) * (1 + 16 * kRoundoffF64);
    // The rounding of the other box is larger by that of what is between both at most.
    error_ = frame_error(scene, magnitude);
    constexpr double kSure = 1 - 64 * kRoundoffF64;
    gaps_ = {{kSure, kSure, kSure}, kSure, {error_, error_, error_}};
  }

  [[nodiscard]] Errc find() {
    const auto met = [this](NearPointWalk& walk, std::uint32_t instance,
                            const BoundScene::Placed& placed) {
      return meet(walk, instance, placed);
    };
    NearPointWalk walk({scene_, kPairQueries, body_.layers, work_}, center_, met);
    set_bound(walk);
    const Errc error = walk.run();
    std::sort_heap(near_.begin(), near_.begin() + static_cast<std::ptrdiff_t>(count_));
    return error;
  }

  /// Whether there may be more.
  [[nodiscard]] bool is_full() const noexcept { return count_ == room_; }
  /// In order.
  [[nodiscard]] std::span<const NearInstance> found() const noexcept {
    return std::span(near_).first(count_);
  }

 private:
  Errc meet(NearPointWalk& walk, std::uint32_t instance, const BoundScene::Placed& placed) {
    if (instance == body_.instance || placed.tree->empty()) return Errc::kOk;
    const auto bounds = placed.bounds();
    if (!bounds) return Errc::kRecordInvalid;
    const Box<double> box = scene_.to_frame(bounds->world);
    const NearInstance met{float_below(std::sqrt(gaps_.squared_distance(body_.in_frame, box))),
                           instance};
    if (!(last_ < met) || met.gap > most_) return Errc::kOk;
    // A heap, the farthest on top.
    const auto begin = near_.begin();
    if (is_full()) {
      if (!(met < near_.front())) return Errc::kOk;
      std::pop_heap(begin, begin + static_cast<std::ptrdiff_t>(room_));
      --count_;
    }
    near_[count_++] = met;
    std::push_heap(begin, begin + static_cast<std::ptrdiff_t>(count_));
    if (is_full()) {
      most_ = near_.front().gap;
      set_bound(walk);
    }
    return Errc::kOk;
  }
  // A gap is less by up to 64 roundings, two steps of a float and error_ on each axis: what is as
  // near as the farthest that is kept may have a number that comes before its.
  void set_bound(NearPointWalk& walk) const noexcept {
    walk.set_bound(most_ * (1 + 8 * kRoundoffF32), radius_ + 2 * error_ + kFloatUnderflow);
  }

  const BoundScene& scene_;
  const SceneBody& body_;
  QueryWork& work_;
  const NearInstance last_;
  const std::size_t room_;
  double most_;  // instances farther away are not looked for
  Eigen::Vector3d center_;
  double radius_;  // of a ball around the body's box
  double error_;
  GapWeights gaps_;
  std::size_t count_ = 0;
  std::array<NearInstance, kRoom> near_;
};

// Keeps what is known of the instances that were compared.
class NearestOfScene {
 public:
  NearestOfScene(const BoundScene& scene, const SceneBody& body, const DistanceOptions& options)
      : scene_(scene), body_(body), options_(options) {
    answer_.lower = options.max_distance;
  }

  [[nodiscard]] Result<SceneDistance> run() {
    NearInstance last{-1, 0};  // before all others
    QueryWork work(QueryLimits{});
    for (std::size_t room = NearInstances::kFirstRoom;; room = NearInstances::kRoom) {
      NearInstances near(scene_, body_, last, room, scene_.to_units(most()), work);
      if (const Errc error = near.find(); error != Errc::kOk) return error;
      for (const NearInstance& instance : near.found()) {
        if (instance.gap > scene_.to_units(most())) return answer();
        if (answer_.nodes_expanded >= options_.node_budget) return answer_at(instance);
        if (const Errc error = compare(instance.instance); error != Errc::kOk) return error;
        if (answer_.upper == 0) return answer();
      }
      // Each turn has other instances, since they come after those of the turn before.
      if (!near.is_full()) return answer();
      last = near.found().back();
    }
  }

 private:
  // What is farther away can be skipped.
  [[nodiscard]] double most() const noexcept {
    return std::min(options_.max_distance, converged_beyond(options_, answer_.upper));
  }

  [[nodiscard]] Errc compare(std::uint32_t instance) {
    const std::optional<BoundScene::Placed> other = scene_.place_now(instance);
    if (!other) return Errc::kRecordInvalid;
    const BodyPair pair = body_.pair_with(instance, *other);
    DistanceOptions options = options_;
    options.max_distance = most();
    options.node_budget -= answer_.nodes_expanded;
    const Result<Distance> found = distance_of_trees(pair.first.tree, pair.first.pose,
                                                     pair.second.tree, pair.second.pose, options);
    if (!found) return found.code();
    answer_.nodes_expanded += found->nodes_expanded;
    answer_.converged &= found->converged;
    answer_.lower = std::min(answer_.lower, found->lower);
    if (!found->witness || !(found->upper < answer_.upper)) return Errc::kOk;
    answer_.upper = found->upper;
    const DistanceWitness& witness = *found->witness;
    answer_.witness = {
        {{pair.first.instance, witness.faces.first}, {pair.second.instance, witness.faces.second}},
        witness.first,
        witness.second};
    if (pair.is_reported_swapped) {
      std::swap(answer_.witness->faces.first, answer_.witness->faces.second);
      std::swap(answer_.witness->first, answer_.witness->second);
    }
    return Errc::kOk;
  }

  // Instances that were not compared are farther away than most().
  [[nodiscard]] SceneDistance answer() const {
    SceneDistance answer = answer_;
    answer.lower = std::min(answer.lower, most());
    return answer;
  }

  // The budget is spent, and this is the nearest instance that was not compared.
  [[nodiscard]] SceneDistance answer_at(const NearInstance& next) {
    answer_.converged = false;
    answer_.lower = std::min(answer_.lower, scene_.to_world(next.gap));
    return answer();
  }

  const BoundScene& scene_;
  const SceneBody& body_;
  const DistanceOptions& options_;
  SceneDistance answer_;
};

// Where there is no body, nothing is near.
Result<SceneDistance> distance_of_body(const BoundScene& scene,
                                       const std::optional<SceneBody>& body,
                                       const DistanceOptions& options) {
  if (body) return NearestOfScene(scene, *body, options).run();
  SceneDistance nothing;
  nothing.lower = options.max_distance;
  return nothing;
}

}  // namespace

Result<SceneDistance> distance(const Scene& queried, const Tree& tree, const Pose& pose,
                               LayerMask layers, const DistanceOptions& options) {
  const DefaultFloatState state;
  const BoundScene& scene = BoundScene::of(queried);
  if (const char* field = invalid_field(options)) return invalid_query(field);
  std::optional<SceneBody> body;
  const Errc error = place_body(scene, BoundTree::of(tree), pose, layers, body);
  if (error != Errc::kOk) return error;
  return distance_of_body(scene, body, options);
}

Result<SceneDistance> distance_of(const Scene& queried, std::uint32_t instance,
                                  const DistanceOptions& options) {
  const DefaultFloatState state;
  const BoundScene& scene = BoundScene::of(queried);
  if (const char* field = invalid_field(options)) return invalid_query(field);
  std::optional<SceneBody> body;
  if (const Errc error = find_body(scene, instance, body); error != Errc::kOk) return error;
  return distance_of_body(scene, body, options);
}

}  // namespace boxtree
