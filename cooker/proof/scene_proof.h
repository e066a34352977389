// SPDX-License-Identifier: MIT
// Proves a scene: every instance is inside every box of the top level above it, each static
// instance is a leaf exactly once, and all references in records are valid.
#pragma once

#include "cooker/proof/proof.h"

namespace boxtree::cooker {

/// The faults of the scene of an open file, in order of discovery, at most kMaxFindings; empty for
/// a file without a scene. Safe on any bytes.
[[nodiscard]] Findings prove_scene(const File& file);

}  // namespace boxtree::cooker
