// SPDX-License-Identifier: MIT
// liblzma, one call each way: buffers are whole, so no stream state is kept.
#include <lzma.h>
#include <string>

#include "runtime/blob/compressor.h"

namespace boxtree {
namespace {

const std::uint8_t* octets(Bytes bytes) {
  return reinterpret_cast<const std::uint8_t*>(bytes.data());
}

const char* meaning_of(lzma_ret result) {
  switch (result) {
    case LZMA_OK:
      return "ended early or late";
    case LZMA_MEM_ERROR:
      return "out of memory";
    case LZMA_FORMAT_ERROR:
      return "no .xz stream";
    case LZMA_OPTIONS_ERROR:
    case LZMA_UNSUPPORTED_CHECK:
      return "made with options that this liblzma does not know";
    case LZMA_DATA_ERROR:
      return "damaged";
    case LZMA_BUF_ERROR:
      return "cut short, or more than it states";
    default:
      return "refused by liblzma";
  }
}

}  // namespace

Status decompress_lzma(Bytes stream, std::span<std::byte> out, std::uint64_t memory_limit) {
  std::uint64_t limit = memory_limit;
  std::size_t in_at = 0;
  std::size_t out_at = 0;
  const lzma_ret result =
      lzma_stream_buffer_decode(&limit, 0, nullptr, octets(stream), &in_at, stream.size(),
                                reinterpret_cast<std::uint8_t*>(out.data()), &out_at, out.size());
  if (result == LZMA_MEMLIMIT_ERROR) {
    return Error{Errc::kBlobLimit, "the lzma decoder needs " + std::to_string(limit) +
                                       " bytes, allowed are " + std::to_string(memory_limit)};
  }
  if (result == LZMA_OK && in_at == stream.size() && out_at == out.size()) return {};
  return Error{Errc::kBlobCorrupt,
               std::string("lzma stream: ") + meaning_of(result) + ": read " +
                   std::to_string(in_at) + " of " + std::to_string(stream.size()) +
                   " bytes, gave " + std::to_string(out_at) + " of " + std::to_string(out.size())};
}

Result<std::vector<std::byte>> compress_lzma(Bytes bytes) {
  std::vector<std::byte> out(lzma_stream_buffer_bound(bytes.size()));
  std::size_t size = 0;
  const lzma_ret result = lzma_easy_buffer_encode(
      LZMA_PRESET_DEFAULT | LZMA_PRESET_EXTREME, LZMA_CHECK_CRC32, nullptr, octets(bytes),
      bytes.size(), reinterpret_cast<std::uint8_t*>(out.data()), &size, out.size());
  if (result != LZMA_OK) {
    return Error{Errc::kInternal, std::string("lzma encoder: ") + meaning_of(result)};
  }
  out.resize(size);
  return out;
}

std::string lzma_version() {
  return lzma_version_string();
}

}  // namespace boxtree
