// SPDX-License-Identifier: MIT
// Identical faces: leaves hold one of them, and a list names its copies.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cooker/import/source_mesh.h"

namespace boxtree::cooker {

/// Which faces are copies of which.
struct Duplicates {
  /// For each face, its original, itself or another face; empty if no two faces are identical.
  std::vector<std::uint32_t> original;
  std::uint32_t count = 0;  // faces whose original is another face

  [[nodiscard]] bool is_original(std::size_t face) const {
    return original.empty() || original[face] == face;
  }
};

/// Groups faces with bitwise identical corner positions in the same order, so that a result
/// computed for one holds for all. The original of a group is the face with the smallest face id,
/// and among equal ids the first face: ties between answers go to it, too.
[[nodiscard]] Duplicates find_duplicates(const MeshView& mesh);

/// Appends the copies to `order`, which holds the originals in the order of the tree. Copies are
/// ordered by the place of their original, then by id. Returns for each copy the place of its
/// original, ascending.
[[nodiscard]] std::vector<std::uint32_t> append_duplicates(const MeshView& mesh,
                                                           const Duplicates& duplicates,
                                                           std::vector<std::uint32_t>& order);

}  // namespace boxtree::cooker
