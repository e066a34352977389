// SPDX-License-Identifier: MIT
// Writes encoded trees as a .bxt file.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cooker/encode/encoded_scene.h"
#include "cooker/encode/encoded_tree.h"
#include "cooker/encode/materials.h"
#include "cooker/write/atomic_file.h"
#include "format/container.h"

namespace boxtree::cooker {

/// The contents of a file. An empty `cook_record`, a missing scene and missing materials
/// are omitted.
struct FileParts {
  std::span<const EncodedTree> trees;
  std::string cook_record;
  const SceneParts* scene = nullptr;
  const Materials* materials = nullptr;  // of trees without a scene
};

/// The whole file in memory: what write_file writes. Errors: those of encode_scene.
Result<std::vector<std::byte>> serialize(const FileParts& parts);

/// The place of every section in that file, and its size. Errors: the same.
struct FileLayout {
  std::vector<SectionEntry> sections;
  std::uint64_t bytes = 0;
};
Result<FileLayout> layout_of(const FileParts& parts);

/// The same as serialize() for trees alone, which cannot fail.
[[nodiscard]] std::vector<std::byte> serialize(std::span<const EncodedTree> trees,
                                               const std::string& cook_record = {});

/// Writes the file, maps it, proves every tree of it (cooker/proof/proof.h), and then commits it
/// to `to`: on any error before, the old file is unchanged. Returns its size. Errors: kWriteFailed;
/// kMeshTooLarge for more trees than a file can hold; those of encode_scene; the first finding if
/// the proof fails, which is an internal error.
Result<std::uint64_t> write_file(const OutputTarget& to, const FileParts& parts);

}  // namespace boxtree::cooker
