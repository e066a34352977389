// SPDX-License-Identifier: MIT
// Checks the index of a pack: names in order, members one behind another, each tree listed once.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>

#include "cooker/proof/proof.h"

namespace boxtree::cooker {

/// Violations of the specification in sections pack, names and members, at most kMaxFindings. Opens
/// each member, and looks no further into it. O(trees log(trees)). Precondition: the file is a
/// pack.
[[nodiscard]] Findings check_pack(const File& file);

/// What of check_pack() needs no member opened: where they are, and how trees are called.
[[nodiscard]] Findings check_pack_index(const File& file);

/// The rest, for one member, as for_each_member() has it.
[[nodiscard]] Findings check_member(const File& file, std::string_view name,
                                    std::span<const std::uint32_t> trees);

/// Calls use(name, trees) for each member, in the order of the file: its name, and the numbers in
/// the pack of its trees. Precondition: check_pack_index() has found no more than
/// padding.
void for_each_member(
    const File& file,
    const std::function<void(std::string_view name, std::span<const std::uint32_t> trees)>& use);

}  // namespace boxtree::cooker
