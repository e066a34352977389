// SPDX-License-Identifier: MIT
// A whole .bxt file, compressed inside another one: for cold storage and for comparison. It cannot
// be mapped and queried; boxtree::blob decompresses it when it is opened.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include <boxtree/kinds.h>

namespace boxtree {

/// FileHeader::incompatible_features of a blob: it has one section, kBlob, and no trees.
inline constexpr std::uint32_t kFeatureBlob = 1u;

/// First bytes of the section; the compressed stream follows up to its end.
struct BlobHeader {
  BlobMethod method;
  std::uint32_t reserved0;   // zero
  std::uint64_t file_bytes;  // of the file inside
  std::uint64_t checksum;    // XXH3-64 of the file inside
  std::uint64_t reserved1;   // zero
};
static_assert(sizeof(BlobHeader) == 32 && std::is_trivially_copyable_v<BlobHeader>);

}  // namespace boxtree
