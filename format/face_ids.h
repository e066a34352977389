// SPDX-License-Identifier: MIT
// Section face_ids: the number of each face in the source. Sources keep neighbours together, and so
// do trees, so the ids of 64 faces lie in a few short intervals: a face has the number of its
// interval and a place in it. Any id can be read alone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "format/bits.h"
#include "format/bytes.h"
#include "format/limits.h"

namespace boxtree {

inline constexpr std::uint32_t kIdBlockFaces = 64;
inline constexpr std::uint32_t kIdGroupBlocks = 16;
inline constexpr std::uint32_t kIdGroupFaces = kIdBlockFaces * kIdGroupBlocks;

/// The bits of a group start at multiples of this many bytes, so that 32-bit offsets suffice for
/// the largest tree.
inline constexpr std::uint64_t kIdUnit = 4;

/// What the section begins with, for every 1024 faces. The last has only the blocks that it needs.
struct FaceIdGroup {
  std::uint32_t base;   // no start of an interval is smaller
  std::uint32_t begin;  // of its bits in the section, in units of kIdUnit
  std::array<std::uint32_t, kIdGroupBlocks> block;  // FaceIdBlock::word
};
static_assert(sizeof(FaceIdGroup) == 72 && std::is_trivially_copyable_v<FaceIdGroup>);
static_assert(offsetof(FaceIdGroup, block) == 8);

/// How 64 faces are stored. The starts of their intervals end, and the fields of the faces begin,
/// at the bit `middle` of the group.
struct FaceIdBlock {
  /// What `grain` has to be for ids that do not grow with the place of the face in its block.
  static constexpr std::uint32_t kNoGrain = 6;

  std::uint32_t middle;         // 16 bits
  std::uint32_t offset_bits;    // 5 bits: of the place in an interval
  std::uint32_t start_bits;     // 5 bits: of the start of an interval
  std::uint32_t interval_bits;  // 3 bits: of the number of an interval
  std::uint32_t grain;          // 3 bits: the place in the block is added but for so many low bits

  [[nodiscard]] static constexpr FaceIdBlock of(std::uint32_t word) noexcept {
    return {word & 0xffffu, word >> 16 & 31u, word >> 21 & 31u, word >> 26 & 7u, word >> 29};
  }
  [[nodiscard]] constexpr std::uint32_t word() const noexcept {
    return middle | offset_bits << 16 | start_bits << 21 | interval_bits << 26 | grain << 29;
  }
  /// Bits of the field of a face.
  [[nodiscard]] constexpr std::uint32_t width() const noexcept {
    return offset_bits + interval_bits;
  }
};

[[nodiscard]] constexpr std::uint32_t id_groups_of(std::uint32_t faces) noexcept {
  return faces / kIdGroupFaces + (faces % kIdGroupFaces != 0 ? 1 : 0);
}
[[nodiscard]] constexpr std::uint32_t id_blocks_of(std::uint32_t faces) noexcept {
  return faces / kIdBlockFaces + (faces % kIdBlockFaces != 0 ? 1 : 0);
}

/// Bytes of all FaceIdGroup of so many faces.
[[nodiscard]] constexpr std::uint64_t id_table_bytes(std::uint32_t faces) noexcept {
  return std::uint64_t{id_groups_of(faces)} * offsetof(FaceIdGroup, block) +
         std::uint64_t{id_blocks_of(faces)} * sizeof(std::uint32_t);
}

/// The fewest bytes that the ids of so many faces take: they are those of the source, in order.
[[nodiscard]] constexpr std::uint64_t least_id_bytes(std::uint32_t faces) noexcept {
  return id_table_bytes(faces) + kBitPadding;
}

/// The ids of one tree, or none.
class FaceIdView {
 public:
  FaceIdView() noexcept = default;
  /// Precondition: section.size() >= least_id_bytes of the faces that are read.
  explicit FaceIdView(Bytes section) noexcept
      : bytes_(section.data()), last_bit_((section.size() - kBitPadding) * 8) {}

  explicit operator bool() const noexcept { return bytes_ != nullptr; }

  /// The id of a face; corrupt bytes may give any number. Reads nothing outside the section.
  [[nodiscard]] std::uint32_t operator[](std::uint32_t face) const noexcept;

  /// The ids of faces 8 leaf to 8 leaf + 7, in a third of the time of eight reads. Those of faces
  /// that do not exist are unspecified. Precondition: the first face exists.
  void read_leaf(std::uint32_t leaf, std::span<std::uint32_t, kLeafFaces> out) const noexcept;

  /// What the faces of a block have in common. Positions are bits of the section.
  struct Block {
    std::uint32_t base;
    FaceIdBlock fields;
    std::uint64_t middle;

    /// Whether fields of all faces, and all starts that these can name, begin in the section:
    /// `last_bit` is the last where one may.
    [[nodiscard]] constexpr bool is_inside(std::uint64_t last_bit) const noexcept {
      const std::uint64_t starts = std::uint64_t{fields.start_bits} << fields.interval_bits;
      return starts <= middle && middle + (kIdBlockFaces - 1) * fields.width() <= last_bit;
    }
  };
  /// The block of a face. Precondition: the face exists.
  [[nodiscard]] Block block_of(std::uint32_t face) const noexcept {
    const std::byte* const group = bytes_ + face / kIdGroupFaces * sizeof(FaceIdGroup);
    const FaceIdBlock fields = FaceIdBlock::of(load<std::uint32_t>(
        group + offsetof(FaceIdGroup, block), face / kIdBlockFaces % kIdGroupBlocks));
    const std::uint64_t begin = load<std::uint32_t>(group + offsetof(FaceIdGroup, begin));
    return {load<std::uint32_t>(group + offsetof(FaceIdGroup, base)), fields,
            begin * (kIdUnit * 8) + fields.middle};
  }
  [[nodiscard]] const std::byte* bytes() const noexcept { return bytes_; }
  /// The last bit that a field may begin at: kBitPadding bytes can be read from there.
  [[nodiscard]] std::uint64_t last_bit() const noexcept { return last_bit_; }

 private:
  const std::byte* bytes_ = nullptr;
  std::uint64_t last_bit_ = 0;
};

}  // namespace boxtree
