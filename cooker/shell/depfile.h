// SPDX-License-Identifier: MIT
// What a build system is told: which files an output was made of.
#pragma once

#include <filesystem>
#include <span>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// Writes "output: inputs" in make syntax to `path`, which takes the place of another file only
/// once it is whole. Error: kWriteFailed.
Status write_depfile(const std::filesystem::path& path, const std::filesystem::path& output,
                     std::span<const std::filesystem::path> inputs);

}  // namespace boxtree::cooker
