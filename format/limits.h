// SPDX-License-Identifier: MIT
// Limits that every file obeys and every reader may rely on. They are part of the format: stacks
// and loops are sized by them, so raising one is a new format version.
#pragma once

#include <cstddef>
#include <cstdint>

namespace boxtree {

/// Sections in one file. Bounds the work of open().
inline constexpr std::uint32_t kMaxSections = 1u << 20;

/// Trees in one file that is no pack: a row of the section table has 16 bits for an owner or none.
inline constexpr std::uint32_t kMaxTrees = (1u << 16) - 1;

/// Trees in a pack.
inline constexpr std::uint32_t kMaxPackedTrees = 1u << 24;

/// Inner nodes on the longest path of a tree; traversal stacks are sized by it.
/// 2^31 faces need 31 levels of halving; the rest is room for uneven splits and shrink nodes.
inline constexpr std::uint32_t kMaxDepth = 96;

/// Faces, vertices and nodes of one tree: a child is a 32-bit number and one value marks "none".
inline constexpr std::uint32_t kMaxFaces = 0x7fffffffu;
inline constexpr std::uint32_t kMaxVertices = 0x7fffffffu;
inline constexpr std::uint32_t kMaxNodes = 0xfffffffeu;

/// Bound of |TreeRecord::scale_exponent|: 2^e and 2^-e are both normal doubles.
inline constexpr std::int32_t kMaxScaleExponent = 1010;

/// Whether -limit <= x <= limit, without abs(), which overflows for the least number. Precondition:
/// 0 <= limit.
[[nodiscard]] constexpr bool is_within(std::int64_t x, std::int64_t limit) noexcept {
  return -limit <= x && x <= limit;
}

/// Bound of the root box's coordinates, in tree space: finite in the scalar of every codec. Valid
/// files stay below 2^41: the largest extent is 2^15, and f32 resolves 2^-24 of a position.
inline constexpr double kMaxRootCoordinate = 0x1p100;

/// kMaxDepth of codecs with eight children per node, whose stacks hold seven entries per level. It
/// equals the splits allowed in the binary tree that a wide tree is collapsed from, so none is too
/// deep.
inline constexpr std::uint32_t kMaxWideDepth = 64;

/// Faces in a leaf of the wide codecs; only the last leaf of a tree may hold fewer.
inline constexpr std::uint32_t kLeafFaces = 8;

/// Number of leaves for `faces` faces when all but the last are full.
[[nodiscard]] constexpr std::size_t leaves_of(std::size_t faces) noexcept {
  return (faces + kLeafFaces - 1) / kLeafFaces;
}

/// Triangles in one leaf: each of its faces may be a quad.
inline constexpr std::uint32_t kMaxLeafTriangles = 2 * kLeafFaces;

/// Sections of at least kLargeSection bytes start at a cache line. Smaller ones, which are in the
/// nearest cache after a few queries, and the end of the file lie at numbers of eight bytes.
inline constexpr std::uint64_t kLargeSection = 4096;
inline constexpr std::uint64_t kLargeAlignment = 64;
inline constexpr std::uint64_t kSmallAlignment = 8;

}  // namespace boxtree
