// SPDX-License-Identifier: MIT
// Faces that are the same: a tree holds one of them, and a list says which others it stands for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cooker/import/source_mesh.h"

namespace boxtree::cooker {

/// Which faces are copies of which.
struct Duplicates {
  /// For each face the one that stands for it, itself or another; empty where no two are the same.
  std::vector<std::uint32_t> original;
  std::uint32_t count = 0;  // faces that another one stands for

  [[nodiscard]] bool is_original(std::size_t face) const {
    return original.empty() || original[face] == face;
  }
};

/// Groups faces with the same corner positions, to the bit, in the same order: whatever is computed
/// of one of them holds for the others. The one with the smallest face id stands for its group, and
/// of equal ids the first, as ties between answers go to it.
[[nodiscard]] Duplicates find_duplicates(const SourceMesh& mesh);

/// Appends the copies to `order`, which holds the originals as a tree orders them: those of the
/// first one first, and of one by their ids. Returns for each copy the place of its original,
/// ascending.
[[nodiscard]] std::vector<std::uint32_t> append_duplicates(const SourceMesh& mesh,
                                                           const Duplicates& duplicates,
                                                           std::vector<std::uint32_t>& order);

}  // namespace boxtree::cooker
