// SPDX-License-Identifier: MIT
// A file without a name that nobody else sees.
#pragma once

namespace boxtree::cooker {

/// A descriptor to write, read and map; the file goes with it. In memory where the system has such
/// files (Linux), else in the folder for temporary files. -1, with the reason in errno, on errors.
[[nodiscard]] int open_memory_file() noexcept;

}  // namespace boxtree::cooker
