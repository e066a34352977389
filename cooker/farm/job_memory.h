// SPDX-License-Identifier: MIT
// How much memory a cook will take, from the sizes of what it reads.
#pragma once

#include <cstdint>

#include "cooker/shell/cook_job.h"

namespace boxtree::cooker {

/// About the most bytes that a cook takes at once, beside those of the program; rather too many
/// than too few. Looks at sizes of files, and reads a profile and the buffers' sizes that a .gltf
/// states. Files that cannot be read count as none: their jobs fail at once.
[[nodiscard]] std::uint64_t estimated_memory(const CookJob& job);

}  // namespace boxtree::cooker
