// SPDX-License-Identifier: MIT
// Files as commands open them: mapped, or decompressed if they are blobs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <boxtree/file.h>

#include "cooker/import/import.h"

namespace boxtree::cooker {

struct OpenedFile {
  File file;
  std::uint64_t blob_bytes = 0;  // size of the compressed file; 0 for a mapped one
};

/// Errors as File::open and open_blob.
Result<OpenedFile> open_file(const std::filesystem::path& path);

/// How commands import meshes, which may come from anywhere: no file ends the command.
[[nodiscard]] inline ImportOptions careful_import() {
  ImportOptions options;
  options.try_first = true;
  return options;
}

/// The number of a tree that is named by its number or its name. A number need not be in the file:
/// binding finds that out.
Result<std::uint32_t> find_tree(const File& file, const std::string& which);

}  // namespace boxtree::cooker
