// SPDX-License-Identifier: MIT
// Welding: positions that are equal bit for bit get one vertex number.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace boxtree::cooker {

/// Appends positions to an array (three numbers each) and gives those that are equal bit for bit
/// one number, the first one's; so -0 and +0 stay apart and nothing ever moves. Numbers follow the
/// order of first appearance: an array without duplicates keeps its order.
///
/// The array may be longer than what was added, so that positions can be welded where they stand:
/// `add` then overwrites what comes next in it.
///
/// An open-addressing table of vertex numbers, whose keys are the array itself: 4 bytes a slot, at
/// most 2/3 full. Expected O(1) an `add`. T is float or double; at most 2^32 - 1 vertices.
template <class T>
class Welder {
 public:
  /// Writes to `positions` from its beginning; it must outlive the welder, and others must leave
  /// alone what was added. `expected` vertices fit without growing the table.
  explicit Welder(std::vector<T>& positions, std::size_t expected = 0);

  /// The number of the vertex with exactly these bits, appended if it is new.
  std::uint32_t add(const std::array<T, 3>& position);

  /// Fetches what an `add` of this position, soon, looks at first: tables of large meshes are in no
  /// cache.
  void prefetch(const std::array<T, 3>& position) const;

  /// Vertices added so far that were new.
  [[nodiscard]] std::size_t size() const { return count_; }

  /// Makes room for `more` further vertices, should they all be new.
  void reserve(std::size_t more);

 private:
  void rehash(std::size_t slots);

  std::vector<T>& positions_;
  std::size_t count_ = 0;
  std::vector<std::uint32_t> table_;  // power of two long; kFree or a vertex number
};

/// What weld_in_place is told of a vertex that stays.
inline constexpr std::uint32_t kWeldUsed = 0;
/// ... and of one that goes.
inline constexpr std::uint32_t kWeldUnused = 0xffffffffu;

/// Welds the used ones of `positions` where they stand and drops the others. `numbers`, as many as
/// vertices, says which are used, and afterwards which number each of those has. `expected`
/// vertices that differ fit without growing the table.
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
