// SPDX-License-Identifier: MIT
// Files as commands open them: mapped, or decompressed if they are blobs.
#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <string>

#include <boxtree/file.h>

#include "cooker/import/import.h"
#include "format/tree_record.h"

namespace boxtree::cooker {

struct OpenedFile {
  File file;
  std::uint64_t blob_bytes = 0;  // size of the compressed file; 0 for a mapped one
};

/// File::open(), with the message of input_failure() for a missing file.
Result<File> map_file(const std::filesystem::path& path);

/// "-" is standard input. Errors as map_file, open_blob and standard_input.
Result<OpenedFile> open_file(const std::filesystem::path& path);

/// How commands import meshes, which may come from anywhere: no file ends the command.
[[nodiscard]] inline ImportOptions careful_import() {
  ImportOptions options;
  options.try_first = true;
  return options;
}

/// A tree of a file as users say it.
struct WhichTree {
  std::string text;        // name or number; empty: the first
  bool is_number = false;  // text is a number and no name, as a number in JSON is

  [[nodiscard]] bool empty() const { return text.empty(); }
  auto operator<=>(const WhichTree&) const = default;
};

/// The tree with that name or, if none is called so, that number. A number need not be in the file:
/// binding finds that out. Error: kTreeIndex.
Result<std::uint32_t> find_tree(const File& file, const WhichTree& which);

/// The record of a tree, which may be in a member of a pack; one that no check accepts if its
/// member cannot be opened, which binding the tree tells. Precondition: the file has that tree.
[[nodiscard]] TreeRecord record_of(const File& file, std::uint32_t tree);

/// The same error; of a mesh that is not the tree's (kExternalMeshMismatch) it names the one that
/// was given and the one that is needed.
[[nodiscard]] Error naming_mesh(const std::filesystem::path& mesh, const Error& error);

}  // namespace boxtree::cooker
