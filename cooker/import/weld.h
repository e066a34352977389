// SPDX-License-Identifier: MIT
// Welding: positions that are equal bit for bit get one vertex number.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace boxtree::cooker {

/// Appends positions to an array (three numbers each) and gives those that are equal bit for bit
/// one number, the first one's; so -0 and +0 stay apart and nothing ever moves. Numbers follow the
/// order of first appearance: an array without duplicates keeps its order.
///
/// An open-addressing table of vertex numbers, whose keys are the array itself: 4 bytes a slot, at
/// most 2/3 full. Expected O(1) an `add`. T is float or double; at most 2^32 - 1 vertices.
template <class T>
class Welder {
 public:
  /// `positions` is appended to; it must outlive the welder and must not be changed by others.
  /// `expected` vertices fit without growing the table.
  explicit Welder(std::vector<T>& positions, std::size_t expected = 0);

  /// The number of the vertex with exactly these bits, appended if it is new.
  std::uint32_t add(const std::array<T, 3>& position);

  /// Makes room for `more` further vertices, should they all be new.
  void reserve(std::size_t more);

 private:
  void rehash(std::size_t slots);

  std::vector<T>& positions_;
  std::vector<std::uint32_t> table_;  // power of two long; kFree or a vertex number
};

extern template class Welder<float>;
extern template class Welder<double>;

}  // namespace boxtree::cooker
