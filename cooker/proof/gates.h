// SPDX-License-Identifier: MIT
// The gates that a candidate must pass to be chosen.
#pragma once

#include <cstdint>

#include "cooker/encode/encoded_tree.h"

namespace boxtree::cooker {

/// Results of one candidate. It passes if no face is missed, no box escapes and the rest
/// of what its record states holds, too.
struct Gates {
  std::uint64_t missed = 0;   // faces that no walk from the root reaches
  std::uint64_t escapes = 0;  // boxes that do not contain what is below them
  bool certificate = false;   // whether the rest of what the record states holds

  [[nodiscard]] bool pass() const { return missed == 0 && escapes == 0 && certificate; }
};

/// Binds the encoded tree as a reader would and walks all of it. `source` is for external geometry.
[[nodiscard]] Gates check_gates(const EncodedTree& tree, const MeshArrays& source);

}  // namespace boxtree::cooker
