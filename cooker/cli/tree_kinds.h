// SPDX-License-Identifier: MIT
// What a profile left to one tree of a scene that is queried by itself.
#pragma once

#include <cstdint>

#include <boxtree/boxtree.h>

namespace boxtree::cooker {

/// The kinds of queries that the objects answer which place the tree; those of the scene if none
/// does, since a program may place it; all kinds in a file without a scene. O(instances).
/// Errors: those of Scene::bind.
Result<QueryKinds> kinds_of_tree(const File& file, std::uint32_t tree);

/// kPartLeftOut for one kind that kinds_of_tree() does not name, with the line of the profile if
/// the whole scene lacks it.
[[nodiscard]] Error kind_left_out(const File& file, std::uint32_t tree, QueryKinds kind);

}  // namespace boxtree::cooker
