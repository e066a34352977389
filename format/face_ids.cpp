// SPDX-License-Identifier: MIT
// Reads face ids: what their block says, their fields, the starts of their intervals.
#include "format/face_ids.h"

#include <algorithm>

namespace boxtree {
namespace {

// low_bits for widths below 64.
std::uint64_t mask(std::uint32_t width) noexcept {
  return (std::uint64_t{1} << width) - 1;
}

// The id of the face with this place in the block. `at`: what the section holds from a position
// on; `position`: of the field of the face.
template <class At>
std::uint32_t id_of(const FaceIdView::Block& block, std::uint32_t place, std::uint64_t position,
                    const At& at) noexcept {
  const FaceIdBlock& fields = block.fields;
  const std::uint64_t field = at(position) & mask(fields.width());
  const std::uint64_t interval = field >> fields.offset_bits;
  const std::uint64_t start =
      at(block.middle - fields.start_bits - interval * fields.start_bits) & mask(fields.start_bits);
  const std::uint64_t offset = field & mask(fields.offset_bits);
  const std::uint32_t by_place = place & ~static_cast<std::uint32_t>(mask(fields.grain));
  return block.base + static_cast<std::uint32_t>(start + offset) + by_place;
}

}  // namespace

std::uint32_t FaceIdView::operator[](std::uint32_t face) const noexcept {
  const Block block = block_of(face);
  const std::uint32_t place = face % kIdBlockFaces;
  // Starts precede the middle. Where there are too few, a position is too large, or negative and
  // so, without a sign, too large as well.
  return id_of(block, place, block.middle + std::uint64_t{place} * block.fields.width(),
               [this](std::uint64_t position) {
                 position = std::min(position, last_bit_);
                 return load<std::uint64_t>(bytes_ + position / 8) >> (position % 8);
               });
}

void FaceIdView::read_leaf(std::uint32_t leaf,
                           std::span<std::uint32_t, kLeafFaces> out) const noexcept {
  const std::uint32_t first = leaf * kLeafFaces;
  const Block block = block_of(first);
  if (!block.is_inside(last_bit_)) {  // corrupt, or near the end
    for (std::uint32_t i = 0; i < kLeafFaces; ++i) out[i] = (*this)[first + i];
    return;
  }
  const std::uint32_t place = first % kIdBlockFaces;
  std::uint64_t position = block.middle + std::uint64_t{place} * block.fields.width();
  for (std::uint32_t i = 0; i < kLeafFaces; ++i, position += block.fields.width()) {
    out[i] = id_of(block, place + i, position, [this](std::uint64_t at) {
      return load<std::uint64_t>(bytes_ + at / 8) >> (at % 8);
    });
  }
}

}  // namespace boxtree
