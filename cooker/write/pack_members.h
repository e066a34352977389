// SPDX-License-Identifier: MIT
// What goes into a pack: files, and the members of packs, under the names that they get there.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <boxtree/file.h>

namespace boxtree::cooker {

/// What trees of a pack are named after.
enum class PackNames : std::uint8_t {
  kTree,  ///< A file of one tree after the tree, others after the file without its folders.
  kPath,  ///< Every file after its path.
};

/// A file that becomes a member of a pack.
struct PackMember {
  std::filesystem::path path;      // the input that it is, or is a member of
  std::uint64_t offset = 0;        // of its bytes in that
  std::uint64_t bytes = 0;         // of it
  std::string name;                // UTF-8, not empty
  std::vector<std::string> trees;  // names in the pack, in the order of the member's trees
};

/// Opens an input by the path that it was given by.
using OpenInput = std::function<Result<File>(const std::filesystem::path&)>;

/// The members that an input contributes: itself, or those of a pack. Names of trees are those of
/// the input, a tree without one is called after its file; of trees in one file that share a name,
/// the second ends in #2. Reads the whole input, whose checksums it compares.
/// Errors: those of `open`; kChecksumMismatch and kPaddingNotZero; the first finding of check_pack;
/// kSectionMissing for a file without trees.
Result<std::vector<PackMember>> list_members(const std::filesystem::path& path, PackNames names,
                                             const OpenInput& open);

/// Where `split` puts a member: "props/rock.bxt". Characters that a file system takes for more than
/// a name, and all of "." and "..", are %XX, so that no name leads out of the folder, and two names
/// never to one file.
[[nodiscard]] std::filesystem::path member_path(std::string_view name);

}  // namespace boxtree::cooker
