// SPDX-License-Identifier: MIT
// The proof of a scene: every instance lies inside every box of the top level above it, each static
// one is a leaf exactly once, and all that the records refer to is there.
#pragma once

#include "cooker/proof/proof.h"

namespace boxtree::cooker {

/// What does not hold of the scene of an open file, in order of discovery; empty also for a file
/// without a scene. At most kMaxFindings. Safe on any bytes.
[[nodiscard]] Findings prove_scene(const File& file);

}  // namespace boxtree::cooker
