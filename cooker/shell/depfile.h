// SPDX-License-Identifier: MIT
// Writes the dependencies of an output for a build system.
#pragma once

#include <filesystem>
#include <span>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// Writes "output: inputs" and an empty rule for each input, as gcc -MP does, in make syntax to
/// `path`, replacing an existing file only once it is complete. Error: kWriteFailed, also for names
/// that make has no way to read.
Status write_depfile(const std::filesystem::path& path, const std::filesystem::path& output,
                     std::span<const std::filesystem::path> inputs);

}  // namespace boxtree::cooker
