// SPDX-License-Identifier: MIT
// Chooses the intervals of each block of faces that take the fewest bits.
#include "cooker/encode/face_ids.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include "format/face_ids.h"
#include "format/limits.h"

namespace boxtree::cooker {
namespace {

constexpr std::uint32_t kOffsetBitsEnd = 32;  // intervals as long as all ids together

using Ids = std::span<const std::uint32_t>;

// A way to store a block: the intervals of 2^offset_bits numbers that hold those of its faces. The
// number of a face is its id without the base of the group and what its place adds.
struct Plan {
  FaceIdBlock block{};
  std::uint32_t intervals = 0;
  std::uint32_t bits = ~std::uint32_t{0};
};

[[nodiscard]] std::uint32_t number_of(Ids ids, std::uint32_t base, std::uint32_t grain,
                                      std::size_t i) {
  const auto place = static_cast<std::uint32_t>(i);
  return ids[i] - base - (place >> grain << grain);
}

// The starts of the fewest intervals of that length. Precondition: `sorted` ascends.
class Cover {
 public:
  Cover(Ids sorted, std::uint32_t offset_bits) {
    std::uint64_t end = 0;  // of the last interval
    for (const std::uint32_t number : sorted) {
      if (count_ != 0 && number < end) continue;
      start_[count_++] = number;
      end = number + (std::uint64_t{1} << offset_bits);
    }
  }
  [[nodiscard]] Ids starts() const { return {start_.data(), count_}; }

 private:
  std::array<std::uint32_t, kIdBlockFaces> start_;
  std::uint32_t count_ = 0;
};

// The numbers of a block's faces, ascending; none if one of them would be negative.
class Numbers {
 public:
  Numbers(Ids ids, std::uint32_t base, std::uint32_t grain) {
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const std::uint32_t number = number_of(ids, base, grain, i);
      if (number > kMaxFaces) return;  // negative, without its sign
      number_[i] = number;
    }
    count_ = ids.size();
    std::sort(number_.begin(), number_.begin() + static_cast<std::ptrdiff_t>(count_));
  }
  [[nodiscard]] Ids sorted() const { return {number_.data(), count_}; }

 private:
  std::array<std::uint32_t, kIdBlockFaces> number_;
  std::size_t count_ = 0;
};

// How far the numbers of a block lie apart, negative ones included.
[[nodiscard]] std::int64_t spread_of(Ids ids, std::uint32_t grain) {
  std::int64_t least = ids[0], largest = ids[0];
  for (std::size_t i = 1; i < ids.size(); ++i) {
    const std::int64_t number =
        std::int64_t{ids[i]} - static_cast<std::int64_t>(i >> grain << grain);
    least = std::min(least, number);
    largest = std::max(largest, number);
  }
  return largest - least;
}

[[nodiscard]] Plan plan_of(Ids ids, std::uint32_t base) {
  Plan best;
  // Places add nothing, or the number of the leaf, or that of the face: for sources in the order of
  // a tree, whose leaves may have been reordered.
  constexpr auto kLeafGrain = static_cast<std::uint32_t>(std::countr_zero(kLeafFaces));
  const std::int64_t spread = spread_of(ids, FaceIdBlock::kNoGrain);
  for (const std::uint32_t grain : {FaceIdBlock::kNoGrain, kLeafGrain, 0u}) {
    // Elsewhere they save little, and a third of the time of this function is enough.
    if (grain != FaceIdBlock::kNoGrain && spread_of(ids, grain) > spread / 2) continue;
    const Numbers numbers(ids, base, grain);
    if (numbers.sorted().empty()) continue;
    const auto count = static_cast<std::uint32_t>(ids.size());
    for (std::uint32_t offset_bits = 0; offset_bits < kOffsetBitsEnd; ++offset_bits) {
      if (count * offset_bits >= best.bits) break;
      const Cover cover(numbers.sorted(), offset_bits);
      const auto intervals = static_cast<std::uint32_t>(cover.starts().size());
      const FaceIdBlock block{0, offset_bits,
                              static_cast<std::uint32_t>(std::bit_width(cover.starts().back())),
                              width_below(intervals), grain};
      const std::uint32_t bits = count * block.width() + intervals * block.start_bits;
      if (bits < best.bits) best = {block, intervals, bits};
      if (intervals == 1) break;
    }
  }
  return best;
}

void write_block(Ids ids, std::uint32_t base, const FaceIdBlock& block, std::byte* out) {
  const Numbers numbers(ids, base, block.grain);
  const Cover cover(numbers.sorted(), block.offset_bits);
  const Ids starts = cover.starts();
  for (std::uint32_t k = 0; k < starts.size(); ++k) {
    write_bits(out, block.middle - (k + 1) * block.start_bits, block.start_bits, starts[k]);
  }
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::uint32_t number = number_of(ids, base, block.grain, i);
    const auto after = std::upper_bound(starts.begin(), starts.end(), number);
    const auto interval = static_cast<std::uint64_t>(after - starts.begin() - 1);
    const std::uint64_t offset = number - starts[interval];
    write_bits(out, block.middle + i * block.width(), block.width(),
               interval << block.offset_bits | offset);
  }
}

struct Group {
  FaceIdGroup head{};
  std::vector<std::byte> bits;
};

[[nodiscard]] Group encode_group(Ids ids) {
  Group group;
  group.head.base = *std::min_element(ids.begin(), ids.end());
  std::array<Plan, kIdGroupBlocks> plans;
  std::uint32_t end = 0;
  const std::size_t blocks = (ids.size() + kIdBlockFaces - 1) / kIdBlockFaces;
  const auto ids_of = [&](std::size_t b) {
    const std::size_t first = b * kIdBlockFaces;
    return ids.subspan(first, std::min<std::size_t>(kIdBlockFaces, ids.size() - first));
  };
  for (std::size_t b = 0; b < blocks; ++b) {
    Plan& plan = plans[b] = plan_of(ids_of(b), group.head.base);
    plan.block.middle = end + plan.intervals * plan.block.start_bits;
    group.head.block[b] = plan.block.word();
    end += plan.bits;
  }
  group.bits.resize(align_up((end + 7) / 8, kIdUnit));
  for (std::size_t b = 0; b < blocks; ++b) {
    write_block(ids_of(b), group.head.base, plans[b].block, group.bits.data());
  }
  return group;
}

}  // namespace

std::vector<std::byte> encode_face_ids(const SourceMesh& mesh,
                                       std::span<const std::uint32_t> order) {
  std::vector<std::uint32_t> ids(order.size());
  std::transform(order.begin(), order.end(), ids.begin(),
                 [&](std::uint32_t face) { return mesh.face_id(face); });
  std::vector<Group> groups(id_groups_of(static_cast<std::uint32_t>(ids.size())));
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, groups.size()),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t g = range.begin(); g < range.end(); ++g) {
                        const std::size_t first = g * kIdGroupFaces;
                        groups[g] = encode_group(Ids(ids).subspan(
                            first, std::min<std::size_t>(kIdGroupFaces, ids.size() - first)));
                      }
                    });
  const std::size_t table = id_table_bytes(static_cast<std::uint32_t>(ids.size()));
  std::size_t size = table;
  for (Group& group : groups) {
    group.head.begin = static_cast<std::uint32_t>(size / kIdUnit);
    size += group.bits.size();
  }
  std::vector<std::byte> out;
  out.reserve(size + kBitPadding);
  for (const Group& group : groups) {
    const Bytes head = std::as_bytes(std::span(&group.head, 1));
    out.insert(out.end(), head.begin(), head.end());
  }
  out.resize(table);  // without the blocks that the last group does not need
  for (const Group& group : groups) out.insert(out.end(), group.bits.begin(), group.bits.end());
  out.resize(size + kBitPadding);
  return out;
}

bool is_in_source_order(const SourceMesh& mesh, std::span<const std::uint32_t> order) {
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (mesh.face_id(order[i]) != i) return false;
  }
  return true;
}

}  // namespace boxtree::cooker
