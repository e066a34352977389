// SPDX-License-Identifier: MIT
// The memory that Linux allows a process by its control groups, as those of containers and of
// Slurm.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

namespace boxtree::cooker {

/// The least limit of the groups, and of those that they are in. `groups`: /proc/self/cgroup,
/// "0::/a/b" or, of version 1, "4:memory:/a/b"; `root`: /sys/fs/cgroup. Nothing where there is no
/// limit. A group that is not below `root`, as seen from a container, is that of `root`.
[[nodiscard]] std::optional<std::uint64_t> memory_limit(std::string_view groups,
                                                        const std::filesystem::path& root);

}  // namespace boxtree::cooker
