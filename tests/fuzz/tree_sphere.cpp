// SPDX-License-Identifier: MIT
// Spheres against the tree of any file.
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_tree(input, [](const Tree& tree, const Question& question, const auto& check) {
    const std::uint32_t most = question.option(1) == 0 ? ~0u : question.option(1);
    std::uint32_t faces = 0;
    check(overlap_sphere(
        tree, question.vector(0), question.number(3),
        [&](const FaceRef&) { return ++faces < most; }, question.limits()));
  });
}

}  // namespace boxtree::fuzz
