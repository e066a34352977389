// SPDX-License-Identifier: MIT
// Welding by an open-addressing hash table (linear probing) over vertex numbers.
#include "cooker/import/weld.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <type_traits>

#include "cooker/import/hash_mix.h"
#include "cooker/system/prefetch.h"

namespace boxtree::cooker {
namespace {

constexpr std::uint32_t kFree = 0xffffffffu;
constexpr std::size_t kMinSlots = 64;

// Slots for `vertices` at a load of at most 2/3; linear probing is slow above.
std::size_t slots_for(std::size_t vertices) {
  const std::size_t wanted = vertices + vertices / 2 + 1;
  return std::bit_ceil(wanted < kMinSlots ? kMinSlots : wanted);
}

// Neighbouring positions differ in few bits.
template <class T>
std::uint64_t hash_bits(const T* position) {
  using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
  std::uint64_t hash = 0;
  for (int axis = 0; axis < 3; ++axis) {
    hash = hash_with(hash, std::bit_cast<Bits>(position[axis]));
  }
  return hash;
}

}  // namespace

template <class T>
Welder<T>::Welder(std::vector<T>& positions, std::size_t expected) : positions_(positions) {
  rehash(slots_for(expected));
}

template <class T>
std::uint32_t Welder<T>::add(const std::array<T, 3>& position) {
  if (3 * (count_ + 1) > 2 * table_.size()) rehash(2 * table_.size());
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = hash_bits(position.data()) & mask;
  // Terminates: at least a third of the slots is free.
  for (; table_[slot] != kFree; slot = (slot + 1) & mask) {
    const T* other = &positions_[std::size_t{3} * table_[slot]];
    // Bits and not values: -0 is not +0 here. NOLINTNEXTLINE(*-suspicious-memory-comparison,cert-*)
    if (std::memcmp(other, position.data(), sizeof(position)) == 0) return table_[slot];
  }
  assert(count_ < kFree);
  const std::size_t at = 3 * count_;
  if (at < positions_.size()) {
    std::copy(position.begin(), position.end(), &positions_[at]);
  } else {
    positions_.insert(positions_.end(), position.begin(), position.end());
  }
  table_[slot] = static_cast<std::uint32_t>(count_++);
  return table_[slot];
}

template <class T>
void Welder<T>::prefetch(const std::array<T, 3>& position) const {
  cooker::prefetch(&table_[hash_bits(position.data()) & (table_.size() - 1)]);
}

template <class T>
void Welder<T>::reserve(std::size_t more) {
  const std::size_t slots = slots_for(count_ + more);
  if (slots > table_.size()) rehash(slots);
  // At least doubles, so that many small calls do not copy the array each time.
  const std::size_t wanted = 3 * (count_ + more);
  if (wanted > positions_.capacity()) {
    positions_.reserve(positions_.empty() ? wanted : std::max(wanted, 2 * positions_.size()));
  }
}

template <class T>
void Welder<T>::rehash(std::size_t slots) {
  // The new table does not need the old one: free it first to keep peak memory low.
  table_ = std::vector<std::uint32_t>();
  table_.assign(slots, kFree);
  const std::size_t mask = slots - 1;
  for (std::size_t vertex = 0; vertex < count_; ++vertex) {
    std::size_t slot = hash_bits(&positions_[3 * vertex]) & mask;
    while (table_[slot] != kFree) slot = (slot + 1) & mask;
    table_[slot] = static_cast<std::uint32_t>(vertex);
  }
}

template <class T>
void weld_in_place(std::vector<T>& positions, std::span<std::uint32_t> numbers,
                   std::size_t expected) {
  // So far ahead that a line of memory has arrived, and not so far that it is gone again.
  constexpr std::size_t kAhead = 16;
  Welder<T> welder(positions, expected);
  const auto position = [&positions](std::size_t vertex) -> std::array<T, 3> {
    return {positions[3 * vertex], positions[3 * vertex + 1], positions[3 * vertex + 2]};
  };
  for (std::size_t vertex = 0; vertex < numbers.size(); ++vertex) {
    if (vertex + kAhead < numbers.size()) welder.prefetch(position(vertex + kAhead));
    // A vertex is never written behind its place of reading: at most that many were added.
    if (numbers[vertex] != kWeldUnused) numbers[vertex] = welder.add(position(vertex));
  }
  positions.resize(3 * welder.size());
}

template class Welder<float>;
template class Welder<double>;
template void weld_in_place<float>(std::vector<float>&, std::span<std::uint32_t>, std::size_t);
template void weld_in_place<double>(std::vector<double>&, std::span<std::uint32_t>, std::size_t);

}  // namespace boxtree::cooker
