// SPDX-License-Identifier: MIT
// Nothing that is read may be written over.
#pragma once

#include <filesystem>
#include <span>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// Whether the outputs are files of their own: none of them is an input or another output, by
/// whatever name, hard link or symbolic link. Empty paths are outputs that were not given. Reads
/// no file; to be called before anything is written. Error: kWriteFailed.
Status check_outputs(std::span<const std::filesystem::path> outputs,
                     std::span<const std::filesystem::path> inputs);

}  // namespace boxtree::cooker
