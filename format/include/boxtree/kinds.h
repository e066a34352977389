// SPDX-License-Identifier: MIT
// What a file and the programs that read it share: bytes, kinds of queries, ways to compress, and
// what stands for "none". Values are pinned.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace boxtree {

/// Read-only bytes of any alignment.
using Bytes = std::span<const std::byte>;

/// Kinds of queries, as bits: what a scene is queried for, what its instances answer.
using QueryKinds = std::uint8_t;
/// Lines: all queries of rays, and casts of shapes.
inline constexpr QueryKinds kRayQueries = 1;
/// What touches a shape at rest: overlaps of boxes and all other shapes, collide(), frustums.
inline constexpr QueryKinds kBoxQueries = 2;
/// Closest points.
inline constexpr QueryKinds kPointQueries = 4;
/// Two trees: contacts and distances of instances, and of a tree with a scene.
inline constexpr QueryKinds kPairQueries = 8;
/// All of them.
inline constexpr QueryKinds kAllQueries = 15;

/// The id of a face in trees that were cooked without ids, and of no face.
inline constexpr std::uint32_t kNoFaceId = 0xffffffffu;

/// The material of a face in files or trees without materials.
inline constexpr std::uint32_t kNoMaterial = 0xffffffffu;

/// How a file that is compressed as a whole is compressed.
enum class BlobMethod : std::uint32_t {
  kLzma = 1,  ///< An .xz stream.
  kZstd = 2,  ///< A zstd frame.
};

}  // namespace boxtree
