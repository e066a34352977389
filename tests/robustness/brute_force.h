// SPDX-License-Identifier: MIT
// Every query to every decoded triangle, without a tree.
#pragma once

#include "tests/robustness/answers.h"
#include "tests/robustness/run.h"

namespace boxtree::robustness {

/// Checks the answers of a tree one by one against a loop over its decoded triangles.
void check_brute_force(Run& run, const Subject& subject, const QuerySet& queries);

/// Cooks the mesh in every codec and store; each store's answers are held against brute force and
/// are the same bits in all codecs. Returns how many answers named a face.
std::size_t check_answers(Run& run, const SourceMesh& mesh, const QuerySet& queries);

/// The pairs that loops over both meshes find, in the first tree's space. Sorted, each once.
using FacePairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
[[nodiscard]] FacePairs brute_pairs(const Tree& first, const Pose& first_pose, const Tree& second,
                                    const Pose& second_pose);

/// The pairs that the query finds. Sorted, each as often as it was reported.
[[nodiscard]] FacePairs found_pairs(const Tree& first, const Pose& first_pose, const Tree& second,
                                    const Pose& second_pose);

}  // namespace boxtree::robustness
