// SPDX-License-Identifier: MIT
// Contacts in the scene of any file: of what moves, of one instance, of a tree that is no part.
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_scene(input, [](const Scene& scene, const Question& question, const auto& check) {
    const auto all = [](const ScenePair&) { return true; };
    switch (question.option(2) % 3) {
      case 0:
        check(contacts(scene, all, question.limits()));
        break;
      case 1:
        check(contacts_of(scene, question.option(3), all, question.limits()));
        break;
      default:
        if (scene.trees().empty()) return;
        check(overlap_pairs(scene, scene.trees()[0], question.pose(), all, kAllLayers,
                            question.limits()));
    }
  });
}

}  // namespace boxtree::fuzz
