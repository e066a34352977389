// SPDX-License-Identifier: MIT
// Meshes on which builds and machines could disagree: ties, cancellation, signed zeros, both ends
// of the range of floats.
#pragma once

#include <vector>

#include "cooker/import/source_mesh.h"

namespace boxtree::same_bytes {

/// The same bits on every machine: generators of whole numbers that the C++ standard defines, the
/// four operations, and scaling by powers of two.
[[nodiscard]] std::vector<cooker::SourceMesh> meshes();

}  // namespace boxtree::same_bytes
