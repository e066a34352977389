// SPDX-License-Identifier: MIT
// Boxes against the tree of any file, all faces, as far as it matters, and those of batches.
#include "tests/fuzz/overlap_batch.h"
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_tree(input, [](const Tree& tree, const QueryInput& query, const auto& check) {
    const Eigen::Vector3d low = query.vector(0);
    const bool by_size = query.option(1) % 2 == 1;
    const Eigen::AlignedBox3d box(low,
                                  by_size ? low + query.vector(3).cwiseAbs() : query.vector(3));
    std::uint64_t faces = 0;
    const auto all = overlap_box(
        tree, box, [&faces](const FaceRef&) { return ++faces != 0; }, query.limits());
    check(all);
    const std::uint64_t budget = query.option(2) == 0 ? kUnlimitedNodes : query.option(2);
    const auto within = overlap_box_within(tree, box, query.number(6), budget);
    check(within);
    // Who is sure of a hit has one.
    if (all && within && within->overlap == Overlap::kOverlapping && faces == 0) {
      finding("overlap_box_within is hit by a box that overlap_box is not");
    }
    if (query.option(1) % 4 < 2) {
      visit_many(
          query, check,
          [&](const Eigen::Vector3d& offset) {
            return Eigen::AlignedBox3d(box.min() + offset, box.max() + offset);
          },
          [&](auto shapes, auto results, auto visitor, const QueryLimits& limits) {
            return overlap_boxes(tree, shapes, results, visitor, limits);
          },
          [&](const Eigen::AlignedBox3d& moved, auto visitor, const QueryLimits& limits) {
            return overlap_box(tree, moved, visitor, limits);
          });
    }
  });
}

}  // namespace boxtree::fuzz
