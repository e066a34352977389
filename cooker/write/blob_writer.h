// SPDX-License-Identifier: MIT
// Writes files that are compressed as a whole, with the same checks as mapped ones.
#pragma once

#include "cooker/write/file_writer.h"
#include "format/blob.h"

namespace boxtree::cooker {

/// Writes the blob of the file that write_file() would write, reads it back, compares it bit for
/// bit with the original, proves every tree, and then commits it to `to`. Errors: as
/// write_file(); kBlobCorrupt if the comparison fails, which is an internal error. Returns its
/// size.
Result<std::uint64_t> write_blob(const OutputTarget& to, const FileParts& parts, BlobMethod method);

}  // namespace boxtree::cooker
