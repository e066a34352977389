// SPDX-License-Identifier: MIT
// The files of one import: checked before, hashed after.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include <boxtree/error.h>

#include "cooker/import/source_file.h"

namespace boxtree::cooker {

/// Whether the source has at least one byte and, if it is a named file, is a regular one that can
/// be opened. `named_in`: as for read_failure.
Status check_source_file(const SourceFile& source, const std::string& named_in = {});

/// XXH3 (64 bits) over the bytes of the files, one after the other. Does not depend on their paths.
Result<std::uint64_t> hash_source_files(std::span<const std::filesystem::path> files);

/// The same over bytes.
[[nodiscard]] std::uint64_t hash_source_bytes(Bytes bytes);

}  // namespace boxtree::cooker
