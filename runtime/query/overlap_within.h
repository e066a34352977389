// SPDX-License-Identifier: MIT
// Overlap as far as it matters: hit, free, or too close to be worth telling.
#pragma once

#include <cstdint>
#include <optional>

#include <boxtree/configuration.h>
#include <boxtree/runtime/query/approximation.h>
#include <boxtree/runtime/query/types.h>

namespace boxtree {

static_assert(kHasWithinQueries,
              "BOXTREE_QUERIES left within queries out of this build of boxtree");

enum class Overlap : std::uint8_t {
  kHit,          // some face touches
  kFree,         // none does
  kUndecided,    // not told apart, and closer to each other than the distance asked with
  kBudgetSpent,  // the budget ran out before anything was known
};

struct PairOverlap {
  Overlap overlap = Overlap::kFree;
  std::optional<FacePair> contact;   // of a hit
  std::uint64_t nodes_expanded = 0;  // pairs of nodes taken apart and of leaves compared
};

/// Whether two surfaces touch. Hits and frees are certain: exact predicates decide, as for
/// overlap_pairs. Where the walk comes upon parts of both that are closer than `distance` (in the
/// world) it may end with kUndecided: the larger the distance, the earlier; never if it is 0. The
/// walk ends with kBudgetSpent rather than visit more than `node_budget` pairs. Poses as for
/// overlap_pairs. Errors: kInvalidPose, kInvalidQuery (distance NaN or negative) and those of
/// corrupt bytes. Never allocates.
Result<PairOverlap> overlap_within(const Tree& first, const Pose& first_pose, const Tree& second,
                                   const Pose& second_pose, double distance,
                                   std::uint64_t node_budget = kUnlimitedNodes);

struct BoxOverlap {
  Overlap overlap = Overlap::kFree;
  std::optional<FaceRef> face;       // of a hit
  std::uint64_t nodes_expanded = 0;  // nodes taken apart and leaves read
};

/// The same for a closed box in object space and the surface. Certain here means exact, where
/// overlap_box may report a face that misses the box by a rounding.
Result<BoxOverlap> overlap_box_within(const Tree& tree, const Eigen::AlignedBox3d& box,
                                      double distance, std::uint64_t node_budget = kUnlimitedNodes);

}  // namespace boxtree
