// SPDX-License-Identifier: MIT
// Checks that no input is overwritten.
#pragma once

#include <filesystem>
#include <span>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// Checks that no output is an input or another output, under any name, hard link or symbolic link.
/// Empty paths are outputs that were not given. Reads no file; call it before anything is written.
/// Error: kWriteFailed.
Status check_outputs(std::span<const std::filesystem::path> outputs,
                     std::span<const std::filesystem::path> inputs);

}  // namespace boxtree::cooker
