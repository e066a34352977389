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

using Ids = std::span<const std::uint32_t>;

// The numbers of a block's faces, ascending; none if one of them would be negative.
class Numbers {
 public:
  Numbers() = default;
  Numbers(Ids ids, std::uint32_t base, std::uint32_t grain) {
    static_assert(kMaxFaces <= ~std::uint32_t{0} / 2);
    std::array<std::uint64_t, kIdBlockFaces> number_and_place;
    for (std::uint32_t i = 0; i < ids.size(); ++i) {
      const std::uint32_t number = ids[i] - base - (i >> grain << grain);
      if (number > kMaxFaces) return;  // negative, without its sign
      number_and_place[i] = std::uint64_t{number} << 32 | i;
    }
    count_ = ids.size();
    std::sort(number_and_place.begin(),
              number_and_place.begin() + static_cast<std::ptrdiff_t>(count_));
    for (std::size_t i = 0; i < count_; ++i) {
      number_[i] = static_cast<std::uint32_t>(number_and_place[i] >> 32);
      place_[i] = static_cast<std::uint32_t>(number_and_place[i]);
    }
  }
  [[nodiscard]] Ids sorted() const { return {number_.data(), count_}; }
  /// Of the face with each number.
  [[nodiscard]] Ids places() const { return {place_.data(), count_}; }

 private:
  std::array<std::uint32_t, kIdBlockFaces> number_;
  std::array<std::uint32_t, kIdBlockFaces> place_;
  std::size_t count_ = 0;
};

// How far the numbers of a block lie apart, negative ones included.
[[nodiscard]] std::int64_t spread_of(Ids ids, std::uint32_t grain) {
  static_assert(kMaxFaces <= 0x7fffffffu);
  auto least = static_cast<std::int32_t>(ids[0]);
  std::int32_t largest = least;
  for (std::uint32_t i = 1; i < ids.size(); ++i) {
    const auto number =
        static_cast<std::int32_t>(ids[i]) - static_cast<std::int32_t>(i >> grain << grain);
    least = std::min(least, number);
    largest = std::max(largest, number);
  }
  return std::int64_t{largest} - least;
}

// The fewest intervals of 2^0, 2^1 ... numbers that hold those of a block, for kLengths lengths at
// once, the longest last: compilers make vectors of them.
class Covers {
 public:
  static constexpr std::uint32_t kLengths = 16;

  // Precondition: `sorted` ascends and is not empty; numbers and intervals are less than 2^31.
  Covers(Ids sorted, std::uint32_t longest_bits) : longest_bits_(longest_bits) {
    std::array<std::int32_t, kLengths> last_place;
    for (std::uint32_t i = 0; i < kLengths; ++i) {
      const std::uint32_t bits = longest_bits - std::min(longest_bits, kLengths - 1 - i);
      last_place[i] = static_cast<std::int32_t>(low_bits(bits));
    }
    start_.fill(static_cast<std::int32_t>(sorted.front()));
    intervals_.fill(1);
    for (const std::uint32_t each : sorted) {
      const auto number = static_cast<std::int32_t>(each);
      for (std::uint32_t i = 0; i < kLengths; ++i) {
        const std::int32_t is_outside = number - start_[i] > last_place[i] ? -1 : 0;
        start_[i] += (number - start_[i]) & is_outside;
        intervals_[i] -= is_outside;
      }
    }
  }

  // For intervals of 2^bits numbers. Precondition: it is one of the lengths.
  [[nodiscard]] std::uint32_t intervals(std::uint32_t bits) const {
    return static_cast<std::uint32_t>(intervals_[place_of(bits)]);
  }
  [[nodiscard]] std::uint32_t last_start(std::uint32_t bits) const {
    return static_cast<std::uint32_t>(start_[place_of(bits)]);
  }

 private:
  [[nodiscard]] std::size_t place_of(std::uint32_t bits) const {
    return kLengths - 1 - (longest_bits_ - bits);
  }

  std::uint32_t longest_bits_;
  std::array<std::int32_t, kLengths> start_;
  std::array<std::int32_t, kLengths> intervals_;
};

// A way to store a block: the intervals of 2^offset_bits numbers that hold those of its faces. The
// number of a face is its id without the base of the group and what its place adds.
struct Plan {
  FaceIdBlock block{};
  std::uint32_t intervals = 0;
  std::uint32_t bits = ~std::uint32_t{0};
};

// The least bits, and of equal plans the one with the shortest intervals. Lengths are tried from
// the longest down, because most short ones, which take many starts, then need not be.
[[nodiscard]] Plan plan_of(const Numbers& numbers, std::uint32_t grain) {
  const Ids sorted = numbers.sorted();
  const auto count = static_cast<std::uint32_t>(sorted.size());
  const std::uint32_t last = sorted.back();
  Plan best;
  // One interval holds all numbers.
  auto longest = static_cast<std::uint32_t>(std::bit_width(last - sorted.front()));
  for (;;) {
    const Covers covers(sorted, longest);
    const std::uint32_t shortest = longest - std::min(longest, Covers::kLengths - 1);
    for (std::uint32_t offset_bits = longest;; --offset_bits) {
      const std::uint32_t intervals = covers.intervals(offset_bits);
      const FaceIdBlock block{
          0, offset_bits,
          static_cast<std::uint32_t>(std::bit_width(covers.last_start(offset_bits))),
          width_below(intervals), grain};
      const std::uint32_t bits = count * block.width() + intervals * block.start_bits;
      if (bits <= best.bits) best = {block, intervals, bits};
      // Shorter intervals are as many at least, and the last of them starts here at the earliest.
      const std::uint64_t earliest =
          last + std::uint64_t{1} -
          std::min(std::uint64_t{1} << offset_bits, last + std::uint64_t{1});
      const std::uint32_t least = count * block.interval_bits +
                                  intervals * static_cast<std::uint32_t>(std::bit_width(earliest));
      if (offset_bits == 0 || least > best.bits) return best;
      if (offset_bits == shortest) break;
    }
    longest = shortest - 1;
  }
}

// A block with the numbers of its faces as it stores them.
struct PlannedBlock {
  Plan plan;
  Numbers numbers;
};

[[nodiscard]] PlannedBlock best_plan(Ids ids, std::uint32_t base) {
  PlannedBlock best;
  // Places add nothing, or the number of the leaf, or that of the face: for sources in the order of
  // a tree, whose leaves may have been reordered.
  constexpr auto kLeafGrain = static_cast<std::uint32_t>(std::countr_zero(kLeafFaces));
  const std::int64_t spread = spread_of(ids, FaceIdBlock::kNoGrain);
  for (const std::uint32_t grain : {FaceIdBlock::kNoGrain, kLeafGrain, 0u}) {
    // Elsewhere they save little, and a third of the time of this function is enough.
    if (grain != FaceIdBlock::kNoGrain && spread_of(ids, grain) > spread / 2) continue;
    const Numbers numbers(ids, base, grain);
    if (numbers.sorted().empty()) continue;
    const Plan plan = plan_of(numbers, grain);
    if (plan.bits < best.plan.bits) best = {plan, numbers};
  }
  return best;
}

// Precondition: kBitPadding bytes follow the block.
void write_block(const PlannedBlock& planned, std::byte* out) {
  const FaceIdBlock& block = planned.plan.block;
  const Ids numbers = planned.numbers.sorted();
  const std::uint64_t length = std::uint64_t{1} << block.offset_bits;
  std::uint64_t start = 0, intervals = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i == 0 || numbers[i] >= start + length) {
      start = numbers[i];
      ++intervals;
      write_short_bits(out, block.middle - intervals * block.start_bits, block.start_bits, start);
    }
    write_short_bits(out, block.middle + planned.numbers.places()[i] * block.width(), block.width(),
                     (intervals - 1) << block.offset_bits | (numbers[i] - start));
  }
}

struct Group {
  FaceIdGroup head{};
  std::vector<std::byte> bits;
};

[[nodiscard]] Group encode_group(Ids ids) {
  Group group;
  group.head.base = *std::min_element(ids.begin(), ids.end());
  std::array<PlannedBlock, kIdGroupBlocks> planned;
  std::uint32_t end = 0;
  const std::size_t blocks = (ids.size() + kIdBlockFaces - 1) / kIdBlockFaces;
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t first = b * kIdBlockFaces;
    planned[b] =
        best_plan(ids.subspan(first, std::min<std::size_t>(kIdBlockFaces, ids.size() - first)),
                  group.head.base);
    Plan& plan = planned[b].plan;
    plan.block.middle = end + plan.intervals * plan.block.start_bits;
    group.head.block[b] = plan.block.word();
    end += plan.bits;
  }
  const std::size_t size = align_up((end + 7) / 8, kIdUnit);
  group.bits.resize(size + kBitPadding);
  for (std::size_t b = 0; b < blocks; ++b) write_block(planned[b], group.bits.data());
  group.bits.resize(size);
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
