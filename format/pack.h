// SPDX-License-Identifier: MIT
// A pack: many .bxt files in one, unchanged, with an index of their trees by name. Opening it reads
// no member, and a query reads that of its tree.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

namespace boxtree {

/// FileHeader::incompatible_features of a pack: section kPack is in the place of kTrees.
inline constexpr std::uint32_t kFeaturePack = 2u;

/// One tree of a pack. Rows ascend strictly by their names, bytes as unsigned numbers; so the
/// number of a tree in the pack is its place among all names.
struct PackRow {
  std::uint64_t offset;       // of the member in section members, a multiple of kLargeAlignment
  std::uint64_t bytes;        // of the member, which is a .bxt file
  std::uint32_t tree;         // number of the tree in it
  std::uint32_t name_offset;  // into the names section
  std::uint32_t name_bytes;   // at least one
  std::uint32_t member_name_bytes;  // the name begins with that of the member, of this many
};
static_assert(sizeof(PackRow) == 32 && std::is_trivially_copyable_v<PackRow>);
static_assert(offsetof(PackRow, tree) == 16 && offsetof(PackRow, name_offset) == 20);

/// What is between the name of a member that has several trees and the name of a tree.
inline constexpr std::string_view kMemberEnd = "/";

}  // namespace boxtree
