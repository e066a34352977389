// SPDX-License-Identifier: MIT
// Counts steps of the runtime's own walks. All codecs use the same walk in double: boxes of f32
// codecs convert to double unchanged, so the walk visits the nodes that a query visits.
#include "cooker/choose/work.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "runtime/query/pair_walk.h"
#include "runtime/query/point_query.h"
#include "runtime/query/ray_query.h"
#include "runtime/query/shape_query.h"
#include "runtime/walk/erased_codec.h"
#include "runtime/walk/face_visit.h"

namespace boxtree::cooker {
namespace {

// If each query visits a whole mesh, as when its faces coincide, a few queries suffice. At this
// many steps of a kind, the current query ends and no other follows.
constexpr std::uint64_t kMostSteps = 1'000'000;

struct Counts {
  std::uint64_t nodes = 0;
  std::uint64_t leaves = 0;

  [[nodiscard]] bool are_enough() const { return nodes + leaves >= kMostSteps; }
};

// Any codec, with a count of the nodes expanded.
struct ListeningCodec : ErasedCodec {
  Counts* counts;

  [[nodiscard]] NodeState expand(NodeRef ref, const Box<double>& box,
                                 Children& out) const noexcept {
    if (counts->are_enough()) return NodeState::kCorrupt;  // ends the walk; mean_work() knows why
    ++counts->nodes;
    return ErasedCodec::expand(ref, box, out);
  }
};

template <class Query>
struct Listening : Query {
  Counts* counts;

  [[nodiscard]] bool leaf(NodeRef ref) {
    ++counts->leaves;
    return Query::leaf(ref) && !counts->are_enough();
  }
};
template <class Query>
Listening(Query, Counts*) -> Listening<Query>;

// Triangles are left out: whether those of two leaves touch changes no count, and where they lie on
// one line or plane each pair of them takes exact arithmetic.
struct LeafPairCounter {
  static constexpr bool kCountsLeafPairs = true;
  Counts* counts;

  void node_pair(NodeRef, bool /*first_is_leaf*/, NodeRef, bool /*second_is_leaf*/) noexcept {}
  void leaf_pair(NodeRef, NodeRef) const noexcept { ++counts->leaves; }
};

Errc run_query(const BoundTree& tree, const Ray& ray, Counts& counts) {
  const int exponent = exponent_of(largest_magnitude(ray.direction));
  WalkBound nodes(tree.node_count());
  RayCandidate hit;
  Listening query{RayQuery(tree, ray, exponent, nodes, false, hit), &counts};
  if (tree.empty() || !query.enters_root()) return Errc::kOk;
  const Errc walked = traverse_nearest(tree, ListeningCodec{{&tree}, &counts}, query);
  return walked != Errc::kOk ? walked : query.error;
}

Errc run_query(const BoundTree& tree, const Eigen::AlignedBox3d& box, Counts& counts) {
  const BoxQuery shape{tree.frame().to_tree(box.min()), tree.frame().to_tree(box.max())};
  const auto go_on = [](const FaceRef&) { return true; };
  WalkBound nodes(tree.node_count());
  Listening query{FaceWalk<BoxQuery>{{tree, go_on}, shape, nodes}, &counts};
  const Errc walked = traverse_overlap(tree, ListeningCodec{{&tree}, &counts}, query);
  return walked != Errc::kOk ? walked : query.error;
}

Errc run_query(const BoundTree& tree, const Eigen::Vector3d& point, Counts& counts) {
  constexpr double kAnywhere = std::numeric_limits<double>::infinity();
  WalkBound nodes(tree.node_count());
  Listening query{PointQuery(tree, nodes, tree.frame().to_tree(point), kAnywhere), &counts};
  const Errc walked = traverse_nearest(tree, ListeningCodec{{&tree}, &counts}, query);
  return walked != Errc::kOk ? walked : query.error;
}

Errc run_query(const BoundTree& tree, const Pose& pose, Counts& counts) {
  const auto relative = RelativePose::make(tree, Pose::Identity(), tree, pose);
  // Bounds as large as doubles allow leave no room for a copy: nothing to count.
  if (!relative) return Errc::kOk;
  const auto go_on = [](const FacePair&) { return true; };
  const ListeningCodec codec{{&tree}, &counts};
  PairBound bound(tree, tree, nullptr);
  return PairWalk(tree, codec, tree, codec, *relative, go_on, bound, LeafPairCounter{&counts})
      .run()
      .code();
}

template <class Query>
Result<Work> mean_work(const Tree& tree, const std::vector<Query>& queries) {
  Counts counts;
  std::size_t run_count = 0;
  for (const Query& query : queries) {
    const Errc error = run_query(BoundTree::of(tree), query, counts);
    ++run_count;
    if (counts.are_enough()) break;  // the limit ended the query, so its error does not count
    if (error != Errc::kOk) return error;
  }
  const auto each = static_cast<double>(std::max<std::size_t>(run_count, 1));
  return Work{static_cast<double>(counts.nodes) / each, static_cast<double>(counts.leaves) / each};
}

}  // namespace

Workload choice_queries(const Eigen::AlignedBox3d& bounds) {
  if (bounds.isEmpty()) return {};
  Workload queries = make_workload(bounds, {400, 100, 100, 32});
  // The third of every four poses is at 0.9 of the distance at which bounds touch.
  std::vector<Pose> near;
  for (std::size_t i = 2; i < queries.poses.size(); i += 4) near.push_back(queries.poses[i]);
  queries.poses = std::move(near);
  return queries;
}

Result<WorkOfKinds> count_work(const Tree& whole, const Workload& queries) {
  WorkOfKinds work{};
  if (whole.empty()) return work;
  // Copies cost no step, and n faces in one place form n * n pairs.
  const Tree tree = whole.without_duplicates();
  const auto enter = [&](QueryKind kind, const auto& of_kind) -> Status {
    const Result<Work> mean = mean_work(tree, of_kind);
    if (!mean) return mean.error();
    work[static_cast<std::size_t>(kind)] = *mean;
    return {};
  };
  if (Status status = enter(QueryKind::kRay, queries.rays); !status) return status.error();
  if (Status status = enter(QueryKind::kBox, queries.boxes); !status) return status.error();
  if (Status status = enter(QueryKind::kPoint, queries.points); !status) return status.error();
  if (Status status = enter(QueryKind::kPair, queries.poses); !status) return status.error();
  return work;
}

}  // namespace boxtree::cooker
