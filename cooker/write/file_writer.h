// SPDX-License-Identifier: MIT
// Encoded trees to the bytes of a .bxt file.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <boxtree/cooker/encode/encoded_tree.h>
#include <boxtree/cooker/write/atomic_file.h>

namespace boxtree::cooker {

/// The whole file in memory: what write_file writes. `cook_record` is omitted when empty.
[[nodiscard]] std::vector<std::byte> serialize(std::span<const EncodedTree> trees,
                                               const std::string& cook_record = {});

/// Writes the file, maps what was written, proves every tree of it (cooker/proof/proof.h), and only
/// then lets it take the place of `path`. On any error the old file is untouched.
/// Errors: kWriteFailed; the first finding if the proof fails, which is a defect of ours.
Status write_file(const std::filesystem::path& path, std::span<const EncodedTree> trees,
                  const std::string& cook_record);

}  // namespace boxtree::cooker
