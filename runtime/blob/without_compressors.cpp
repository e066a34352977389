// SPDX-License-Identifier: MIT
// In place of liblzma and zstd where the cooker is built without them (BOXTREE_BLOB=OFF).
#include "runtime/blob/compressor.h"

namespace boxtree {
namespace {

Error without(const char* library) {
  return {Errc::kFeatureUnsupported,
          std::string("this boxtree was built without ") + library + " (BOXTREE_BLOB=OFF)"};
}

}  // namespace

Status decompress_lzma(Bytes /*stream*/, std::span<std::byte> /*out*/,
                       std::uint64_t /*memory_limit*/) {
  return without("liblzma");
}

Status decompress_zstd(Bytes /*stream*/, std::span<std::byte> /*out*/,
                       std::uint64_t /*memory_limit*/) {
  return without("zstd");
}

Result<std::vector<std::byte>> compress_lzma(Bytes /*bytes*/) {
  return without("liblzma");
}

Result<std::vector<std::byte>> compress_zstd(Bytes /*bytes*/) {
  return without("zstd");
}

std::string lzma_version() {
  return "none";
}

std::string zstd_version() {
  return "none";
}

}  // namespace boxtree
