// SPDX-License-Identifier: MIT
// Counts the work of queries; the counts are the same on every machine.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <boxtree/error.h>

#include "cooker/choose/workload.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree::cooker {

enum class QueryKind : std::uint8_t { kRay, kBox, kPoint, kPair };
inline constexpr std::size_t kQueryKinds = 4;
inline constexpr std::array<const char*, kQueryKinds> kQueryNames = {"ray", "box", "point", "pair"};

/// What pairs are, for texts.
inline constexpr const char* kShallowMeaning =
    "all contacts with a copy at 0.9 of the distance at which boxes touch";

/// Mean numbers of steps over the queries of a kind. For pairs: nodes expanded against a box of the
/// other tree, and pairs of leaves compared.
struct Work {
  double nodes = 0;
  double leaves = 0;
};
using WorkOfKinds = std::array<Work, kQueryKinds>;

/// The fixed queries that candidates are compared by, for a mesh with these bounds. Pairs: all
/// contacts of the tree and its copy, in poses in which their bounds just touch, so that candidates
/// are not rated by the number of contacts that the mesh has with itself.
/// Other measures of all contacts are means over Workload::poses, most of which go deeper and take
/// several times as long.
[[nodiscard]] Workload choice_queries(const Eigen::AlignedBox3d& bounds);

/// Runs every kind of query on one tree and counts up to a million nodes and leaves of each kind. A
/// tree without faces has no work. Errors: those of the queries.
Result<WorkOfKinds> count_work(const Tree& tree, const Workload& queries);

}  // namespace boxtree::cooker
