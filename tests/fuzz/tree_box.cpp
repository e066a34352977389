// SPDX-License-Identifier: MIT
// Boxes against the tree of any file, all faces and as far as it matters.
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_tree(input, [](const Tree& tree, const Question& question, const auto& check) {
    const Eigen::Vector3d low = question.vector(0);
    const bool by_size = question.option(1) % 2 == 1;
    const Eigen::AlignedBox3d box(
        low, by_size ? low + question.vector(3).cwiseAbs() : question.vector(3));
    std::uint64_t faces = 0;
    const auto all = overlap_box(
        tree, box, [&faces](const FaceRef&) { return ++faces != 0; }, question.limits());
    check(all);
    const std::uint64_t budget = question.option(2) == 0 ? kUnlimitedNodes : question.option(2);
    const auto within = overlap_box_within(tree, box, question.number(6), budget);
    check(within);
    // Who is sure of a hit has one.
    if (all && within && within->overlap == Overlap::kOverlapping && faces == 0) {
      finding("overlap_box_within is hit by a box that overlap_box is not");
    }
  });
}

}  // namespace boxtree::fuzz
