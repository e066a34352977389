// SPDX-License-Identifier: MIT
// Encoded trees to the bytes of a .bxt file.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "cooker/encode/encoded_scene.h"
#include "cooker/encode/encoded_tree.h"
#include "cooker/write/atomic_file.h"
#include "format/container.h"

namespace boxtree::cooker {

/// What a file holds. `cook_record` is omitted when empty, the scene when there is none.
struct FileParts {
  std::span<const EncodedTree> trees;
  std::string cook_record;
  const SceneParts* scene = nullptr;
};

/// The whole file in memory: what write_file writes. Errors: those of encode_scene.
Result<std::vector<std::byte>> serialize(const FileParts& parts);

/// Where everything stands in that file, and how many bytes it has. Errors likewise.
struct FileLayout {
  std::vector<SectionEntry> sections;
  std::uint64_t bytes = 0;
};
Result<FileLayout> layout_of(const FileParts& parts);

/// The same as serialize() for trees alone, which cannot fail.
[[nodiscard]] std::vector<std::byte> serialize(std::span<const EncodedTree> trees,
                                               const std::string& cook_record = {});

/// Writes the file, maps what was written, proves every tree of it (cooker/proof/proof.h), and only
/// then lets it take the place of `path`. On any error the old file is untouched. Returns its size.
/// Errors: kWriteFailed; kMeshTooLarge for more trees than a file can hold; those of encode_scene;
/// the first finding if the proof fails, which is an internal error.
Result<std::uint64_t> write_file(const std::filesystem::path& path, const FileParts& parts);

}  // namespace boxtree::cooker
