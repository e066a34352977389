// SPDX-License-Identifier: MIT
// Compares every query with a loop over all decoded triangles, without a tree.
#pragma once

#include "tests/robustness/answers.h"
#include "tests/robustness/run.h"

namespace boxtree::robustness {

/// Compares the answers of a tree one by one with a loop over its decoded triangles.
void check_brute_force(Run& run, const Subject& subject, const QuerySet& queries);

/// Cooks the mesh with every codec and store. Compares the answers of each store with brute force;
/// they must have the same bits in all codecs. Returns the number of answers with a face.
std::size_t check_answers(Run& run, const SourceMesh& mesh, const QuerySet& queries);

/// The pairs found by loops over both meshes, in the first tree's space. Sorted, without
/// duplicates.
using FacePairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
[[nodiscard]] FacePairs brute_pairs(const Tree& first, const Pose& first_pose, const Tree& second,
                                    const Pose& second_pose);

/// The pairs found by the query. Sorted; duplicates are kept.
[[nodiscard]] FacePairs found_pairs(const Tree& first, const Pose& first_pose, const Tree& second,
                                    const Pose& second_pose);

}  // namespace boxtree::robustness
