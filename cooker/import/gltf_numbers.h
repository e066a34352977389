// SPDX-License-Identifier: MIT
// Numbers of the glTF 2.0 specification: those of the binary container (section 4.4) and those that
// JSON has for names.
#pragma once

#include <cstdint>

namespace boxtree::cooker {

constexpr std::uint32_t kGlbMagic = 0x46546c67u;  // "glTF"
constexpr std::uint32_t kGlbVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4e4f534au;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004e4942u;  // "BIN"
constexpr std::uint64_t kGlbHeaderBytes = 12;
constexpr std::uint64_t kChunkHeaderBytes = 8;

/// The bytes of a chunk, of which JSON is filled up with spaces and others with zeros.
[[nodiscard]] constexpr std::uint64_t chunk_bytes(std::uint64_t bytes) {
  constexpr std::uint64_t kAlignment = 4;
  return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

// Modes of primitives (5.24.4), of which that of fans is the last.
constexpr std::uint64_t kModeLines = 1;
constexpr std::uint64_t kModeTriangles = 4;
constexpr std::uint64_t kModeTriangleFan = 6;

// Types of components (5.1.3).
constexpr std::uint64_t kUnsignedByte = 5121;
constexpr std::uint64_t kUnsignedShort = 5123;
constexpr std::uint64_t kUnsignedInt = 5125;
constexpr std::uint64_t kFloat = 5126;

// Targets of buffer views (5.11.5).
constexpr std::uint64_t kArrayBuffer = 34962;
constexpr std::uint64_t kElementArrayBuffer = 34963;

}  // namespace boxtree::cooker
