// SPDX-License-Identifier: MIT
// Welding by an open-addressing hash table (linear probing) over vertex numbers.
#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <type_traits>

#include <boxtree/cooker/import/weld.h>

namespace boxtree::cooker {
namespace {

constexpr std::uint32_t kFree = 0xffffffffu;
constexpr std::size_t kMinSlots = 64;

// Room for `vertices` at a load of at most 2/3, beyond which linear probing gets slow.
std::size_t slots_for(std::size_t vertices) {
  const std::size_t wanted = vertices + vertices / 2 + 1;
  return std::bit_ceil(wanted < kMinSlots ? kMinSlots : wanted);
}

// Each coordinate is spread over 64 bits before the next comes in, because the bits of neighbouring
// positions differ in few places; the top bits of a product depend on all bits below, hence the
// final fold. Multiplier: 2^64 divided by the golden ratio (Knuth, TAOCP 6.4).
template <class T>
std::uint64_t hash_bits(const T* position) {
  using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
  std::uint64_t hash = 0;
  for (int axis = 0; axis < 3; ++axis) {
    hash = (hash ^ std::bit_cast<Bits>(position[axis])) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 32;
  }
  return hash;
}

}  // namespace

template <class T>
Welder<T>::Welder(std::vector<T>& positions, std::size_t expected) : positions_(positions) {
  assert(positions.empty());
  rehash(slots_for(expected));
}

template <class T>
std::uint32_t Welder<T>::add(const std::array<T, 3>& position) {
  const std::size_t count = positions_.size() / 3;
  if (3 * (count + 1) > 2 * table_.size()) rehash(2 * table_.size());
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = hash_bits(position.data()) & mask;
  // Terminates: at least a third of the slots is free.
  for (; table_[slot] != kFree; slot = (slot + 1) & mask) {
    const T* other = &positions_[std::size_t{3} * table_[slot]];
    // Bits and not values: -0 is not +0 here. NOLINTNEXTLINE(*-suspicious-memory-comparison,cert-*)
    if (std::memcmp(other, position.data(), sizeof(position)) == 0) return table_[slot];
  }
  assert(count < kFree);
  table_[slot] = static_cast<std::uint32_t>(count);
  positions_.insert(positions_.end(), position.begin(), position.end());
  return table_[slot];
}

template <class T>
void Welder<T>::reserve(std::size_t more) {
  const std::size_t slots = slots_for(positions_.size() / 3 + more);
  if (slots > table_.size()) rehash(slots);
  // Never by less than doubling: many small calls must not copy the array each time.
  const std::size_t wanted = positions_.size() + 3 * more;
  if (wanted > positions_.capacity()) {
    positions_.reserve(positions_.empty() ? wanted : std::max(wanted, 2 * positions_.size()));
  }
}

template <class T>
void Welder<T>::rehash(std::size_t slots) {
  // The old table is not needed to build the new one: free it first to keep the peak low.
  table_ = std::vector<std::uint32_t>();
  table_.assign(slots, kFree);
  const std::size_t mask = slots - 1;
  for (std::size_t vertex = 0; vertex < positions_.size() / 3; ++vertex) {
    std::size_t slot = hash_bits(&positions_[3 * vertex]) & mask;
    while (table_[slot] != kFree) slot = (slot + 1) & mask;
    table_[slot] = static_cast<std::uint32_t>(vertex);
  }
}

template class Welder<float>;
template class Welder<double>;

}  // namespace boxtree::cooker
