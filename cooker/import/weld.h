// SPDX-License-Identifier: MIT
// Welding: vertices whose positions are equal bit for bit get one number.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace boxtree::cooker {

/// Appends positions to an array (three numbers each). Positions that are equal bit for bit get the
/// number of the first, so -0 and +0 stay distinct and no position changes. Numbers follow the
/// order of first appearance: an array without duplicates keeps its order.
///
/// The array may be longer than what was added, so that positions can be welded in place: `add`
/// then overwrites the next ones.
///
/// An open-addressing table of vertex numbers; the array holds the keys. 4 bytes per slot, at most
/// 2/3 full. `add` is expected O(1). T is float or double; at most 2^32 - 1 vertices.
template <class T>
class Welder {
 public:
  /// Writes to `positions` from its beginning. The array must outlive the welder, and others must
  /// not change what was added. `expected` vertices fit without growing the table.
  explicit Welder(std::vector<T>& positions, std::size_t expected = 0);

  /// The number of the vertex with exactly these bits, appended if it is new.
  std::uint32_t add(const std::array<T, 3>& position);

  /// Prefetches the slot that `add` of this position reads first: tables of large meshes do not fit
  /// into caches.
  void prefetch(const std::array<T, 3>& position) const;

  /// Vertices added so far that were new.
  [[nodiscard]] std::size_t size() const { return count_; }

  /// Makes room for `more` new vertices.
  void reserve(std::size_t more);

 private:
  void rehash(std::size_t slots);

  std::vector<T>& positions_;
  std::size_t count_ = 0;
  std::vector<std::uint32_t> table_;  // power of two long; kFree or a vertex number
};

/// Input of weld_in_place: the vertex stays.
inline constexpr std::uint32_t kWeldUsed = 0;
/// Input of weld_in_place: the vertex is dropped.
inline constexpr std::uint32_t kWeldUnused = 0xffffffffu;

/// Welds the used vertices of `positions` in place and drops the others. `numbers` has an element
/// per vertex: on entry whether it is used, on return the new number of a used one. `expected`
/// distinct vertices fit without growing the table.
template <class T>
void weld_in_place(std::vector<T>& positions, std::span<std::uint32_t> numbers,
                   std::size_t expected);

extern template void weld_in_place<float>(std::vector<float>&, std::span<std::uint32_t>,
                                          std::size_t);
extern template void weld_in_place<double>(std::vector<double>&, std::span<std::uint32_t>,
                                           std::size_t);

extern template class Welder<float>;
extern template class Welder<double>;

}  // namespace boxtree::cooker
