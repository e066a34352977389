// SPDX-License-Identifier: MIT
// Builds the tree over moving instances.
#include "runtime/scene/moving_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace boxtree {
namespace {

// Sorts numbers of boxes in space: separates the two halves of the range along the longest side of
// their centres, then each half alike. `size` is a power of two; the numbers fill it from the
// front.
void sort_in_space(std::span<std::uint32_t> numbers, std::uint32_t size,
                   std::span<const Box<double>> boxes) {
  if (size < 2 || numbers.size() < 2) return;
  const auto centre = [&](std::uint32_t number, std::size_t axis) {
    return boxes[number].low[axis] / 2 + boxes[number].high[axis] / 2;
  };
  std::size_t longest = 0;
  double largest = -1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double low = centre(numbers[0], axis), high = low;
    for (const std::uint32_t number : numbers) {
      low = std::min(low, centre(number, axis));
      high = std::max(high, centre(number, axis));
    }
    if (high - low > largest) {
      largest = high - low;
      longest = axis;
    }
  }
  const std::size_t left = std::min<std::size_t>(size / 2, numbers.size());
  std::nth_element(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(left),
                   numbers.end(), [&](std::uint32_t a, std::uint32_t b) {
                     const double x = centre(a, longest), y = centre(b, longest);
                     return x != y ? x < y : a < b;
                   });
  sort_in_space(numbers.first(left), size / 2, boxes);
  sort_in_space(numbers.subspan(left), size / 2, boxes);
}

}  // namespace

MovingTree::MovingTree(std::span<const Box<double>> boxes, const Memory* memory)
    : leaves_(std::bit_ceil(std::max(static_cast<std::uint32_t>(boxes.size()), 1u))),
      nodes_(2 * std::size_t{leaves_}, empty_box<double>(), memory),
      eight_(memory),
      place_(boxes.size(), memory),
      at_place_(leaves_, memory) {
  const auto count = static_cast<std::uint32_t>(boxes.size());
  Array<std::uint32_t> numbers(count, memory);
  std::iota(numbers.begin(), numbers.end(), 0u);
  sort_in_space(numbers, leaves_, boxes);
  for (std::uint32_t place = 0; place < count; ++place) {
    place_[numbers[place]] = place;
    at_place_[place] = numbers[place];
    nodes_[leaves_ + place] = boxes[numbers[place]];
  }
  for (std::uint32_t node = leaves_ - 1; node > 0; --node) join(node);
  number_eights();
  Eight none;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::fill(std::begin(none.low[axis]), std::end(none.low[axis]),
              std::numeric_limits<float>::infinity());
    std::fill(std::begin(none.high[axis]), std::end(none.high[axis]),
              -std::numeric_limits<float>::infinity());
  }
  std::size_t depth = depths_;
  const std::size_t count_of_eights =
      depth == 0 ? 0 : number_of_eight(2 * leaves_ - 1, depth - 1) + std::size_t{1};
  eight_ = Array<Eight>(count_of_eights, none, memory);
  for (std::uint32_t level = leaves_; level > 1; level /= 8) {
    --depth;
    for (std::uint32_t node = level; node < 2 * level; ++node) round(node, depth);
  }
}

// Levels are those of the binary tree, of which leaves are the last: level l has nodes 2^l to
// 2^(l + 1) - 1.
void MovingTree::number_eights() noexcept {
  const auto levels = static_cast<std::uint32_t>(std::countr_zero(leaves_));
  std::uint32_t count = 0;  // of those of lower depths
  for (std::uint32_t level = levels == 0 ? 1 : (levels - 1) % 3 + 1; level <= levels; level += 3) {
    const std::uint32_t first_node = std::uint32_t{1} << level;
    if (depths_ == 0) top_node_ = first_node & ~7u;
    first_eight_[depths_++] = count - first_node / 8;
    count += std::max(first_node / 8, 1u);
  }
}

}  // namespace boxtree
