// SPDX-License-Identifier: MIT
// boxtree::blob, a library of its own: files that are compressed as a whole (paper section 3.1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <boxtree/export.h>
#include <boxtree/file.h>

namespace boxtree {

/// What open_blob() may allocate unless told otherwise, in bytes: the file inside, and the
/// decompressor.
inline constexpr std::uint64_t kDefaultBlobMemory = std::uint64_t{1} << 30;

/// Decompresses the file inside the blob at `path` into memory of the File's own and opens it. The
/// size that the blob states is compared with `memory_limit` before anything is allocated, and no
/// more is ever produced, whatever the stream holds.
/// Errors: as File::open(); kFeatureUnsupported when the file is no blob; kBlobLimit; kBlobCorrupt
/// when the stream is truncated, damaged or not as long as stated. A changed bit anywhere in the
/// blob is one of these, kChecksumMismatch or kPaddingNotZero. Thread-safe.
BOXTREE_API Result<File> open_blob(const std::string& path,
                                   std::uint64_t memory_limit = kDefaultBlobMemory);

/// The same over memory of the caller, which is not needed any more afterwards.
BOXTREE_API Result<File> open_blob(Bytes blob, std::uint64_t memory_limit = kDefaultBlobMemory);

/// The blob of a whole .bxt file. Deterministic for one version of the compressor. Error: kInternal
/// when the compressor fails. Allocates; thread-safe.
BOXTREE_API Result<std::vector<std::byte>> make_blob(Bytes file, BlobMethod method);

/// Size in bytes of `bytes` compressed alone, as make_blob() would. For tables. Error and cost as
/// there.
BOXTREE_API Result<std::uint64_t> compressed_size(Bytes bytes, BlobMethod method);

}  // namespace boxtree
