// SPDX-License-Identifier: MIT
// libzstd, one call each way.
#include <memory>
#include <string>
#include <zstd.h>

#include "runtime/blob/compressor.h"

namespace boxtree {
namespace {

// The strongest level below the "ultra" ones, which take several times the memory.
constexpr int kLevel = 19;

struct FreeContext {
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

}  // namespace

// Decompressing in one call needs no separate window: the output is the window.
Status decompress_zstd(Bytes stream, std::span<std::byte> out, std::uint64_t /*memory_limit*/) {
  const std::unique_ptr<ZSTD_DCtx, FreeContext> context(ZSTD_createDCtx());
  if (context == nullptr) return Error{Errc::kBlobLimit, "no memory for the zstd decoder"};
  const std::size_t frame = ZSTD_findFrameCompressedSize(stream.data(), stream.size());
  if (ZSTD_isError(frame) != 0 || frame != stream.size()) {
    return Error{Errc::kBlobCorrupt, "zstd stream: not one whole frame"};
  }
  const std::size_t got =
      ZSTD_decompressDCtx(context.get(), out.data(), out.size(), stream.data(), stream.size());
  if (ZSTD_isError(got) != 0) {
    return Error{Errc::kBlobCorrupt, std::string("zstd stream: ") + ZSTD_getErrorName(got)};
  }
  if (got == out.size()) return {};
  return Error{Errc::kBlobCorrupt, "zstd stream gave " + std::to_string(got) + " of " +
                                       std::to_string(out.size()) + " bytes"};
}

Result<std::vector<std::byte>> compress_zstd(Bytes bytes) {
  std::vector<std::byte> out(ZSTD_compressBound(bytes.size()));
  const std::size_t size =
      ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kLevel);
  if (ZSTD_isError(size) != 0) {
    return Error{Errc::kInternal, std::string("zstd encoder: ") + ZSTD_getErrorName(size)};
  }
  out.resize(size);
  return out;
}

std::string zstd_version() {
  return ZSTD_versionString();
}

}  // namespace boxtree
