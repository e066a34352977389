// SPDX-License-Identifier: MIT
// One pair of functions per compression method. Nothing else calls the compression libraries.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <boxtree/error.h>

#include "format/blob.h"
#include "format/bytes.h"

namespace boxtree {

/// Fills `out` with exactly what `stream` holds. kBlobCorrupt when it is damaged, truncated,
/// followed by anything, or holds fewer or more bytes than `out`; kBlobLimit when the decompressor
/// itself would need more than `memory_limit`.
Status decompress_lzma(Bytes stream, std::span<std::byte> out, std::uint64_t memory_limit);
Status decompress_zstd(Bytes stream, std::span<std::byte> out, std::uint64_t memory_limit);

/// The strongest setting that stays practical for a build farm.
Result<std::vector<std::byte>> compress_lzma(Bytes bytes);
Result<std::vector<std::byte>> compress_zstd(Bytes bytes);

/// "5.4.1": of the library that runs, on which compressed bytes depend.
[[nodiscard]] std::string lzma_version();
[[nodiscard]] std::string zstd_version();

}  // namespace boxtree
