// SPDX-License-Identifier: MIT
// Contacts in the scene of any file: of what moves, of one instance, of a tree that is no part.
#include "tests/fuzz/answers.h"
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_scene(input, [](const Scene& scene, const QueryInput& query, const auto& check) {
    const auto all = [](const ScenePair&) { return true; };
    const auto with_points = [&](const ScenePairContact& contact) {
      check_contact(contact, check);
      return true;
    };
    switch (query.option(2) % 6) {
      case 3:
        check(pair_contacts(scene, with_points, query.limits()));
        break;
      case 4:
        check(pair_contacts_of(scene, query.option(3), with_points, query.limits()));
        break;
      case 5:
        if (scene.trees().empty()) return;
        check(pair_contacts(scene, scene.trees()[0], query.pose(), with_points, kAllLayers,
                            query.limits()));
        break;
      case 0:
        check(contacts(scene, all, query.limits()));
        break;
      case 1:
        check(contacts_of(scene, query.option(3), all, query.limits()));
        break;
      default:
        if (scene.trees().empty()) return;
        check(
            overlap_pairs(scene, scene.trees()[0], query.pose(), all, kAllLayers, query.limits()));
    }
  });
}

}  // namespace boxtree::fuzz
