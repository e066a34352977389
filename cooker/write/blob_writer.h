// SPDX-License-Identifier: MIT
// Files that are compressed as a whole, written with the same care as mapped ones.
#pragma once

#include <filesystem>

#include "cooker/write/file_writer.h"
#include "format/blob.h"

namespace boxtree::cooker {

/// Writes the blob of what write_file() would write, opens what was written, compares it bit for
/// bit with what was meant, proves every tree, and only then lets it take the place of `path`.
/// Errors: as write_file(); kBlobCorrupt if it does not come back, which is an internal error.
/// Returns its size.
Result<std::uint64_t> write_blob(const std::filesystem::path& path, const FileParts& parts,
                                 BlobMethod method);

}  // namespace boxtree::cooker
