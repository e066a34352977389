// SPDX-License-Identifier: MIT
// How far subtrees extend along some axes, as far as a search has seen them. The box of a node
// reaches far beyond what it holds where the axes are not its own; the extent of its leaves is
// learnt once and serves all pairs that it is in, tens of them in a search for the distance of two
// trees.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "format/box.h"
#include "format/children.h"

namespace boxtree {

/// Extents of some nodes and leaves of one tree along the axes of a search. It forgets some at
/// will: then their boxes have to do.
class KnownExtents {
 public:
  /// The extent of a node or leaf, null if it is not known.
  [[nodiscard]] const Box<double>* find(NodeRef ref, bool is_leaf) const noexcept {
    const std::size_t place = place_of(ref, is_leaf);
    const Entry& entry = entries_[place];
    return tags_[place] == tag_of(is_leaf) && entry.ref == ref ? &entry.extent : nullptr;
  }
  void keep(NodeRef ref, bool is_leaf, const Box<double>& extent) noexcept {
    const std::size_t place = place_of(ref, is_leaf);
    tags_[place] = tag_of(is_leaf);
    entries_[place] = {ref, extent};
  }
  /// The axes have changed. They do so when a nearer pair is found, far less than 2^63 times.
  void forget() noexcept { axes_ += 2; }

 private:
  struct Entry {
    NodeRef ref;
    Box<double> extent;
  };

  // A search between two bodies meets some hundred nodes and leaves of each.
  static constexpr std::size_t kPlaces = 352;

  [[nodiscard]] std::uint64_t tag_of(bool is_leaf) const noexcept {
    return axes_ + (is_leaf ? 1 : 0);
  }
  // The odd constants, of the golden ratio and of xxHash, spread numbers that are multiples of one
  // another; the product's upper bits depend on all of them.
  static std::size_t place_of(NodeRef ref, bool is_leaf) noexcept {
    const std::uint32_t mixed =
        ref.first * 0x9e3779b1u ^ ref.second * 0x85ebca77u ^ (is_leaf ? 0xc2b2ae3du : 0u);
    return static_cast<std::size_t>((std::uint64_t{mixed} * kPlaces) >> 32);
  }

  std::uint64_t axes_ = 2;
  // Apart from the entries, which need no first values: a search of a few pairs pays for these.
  std::array<std::uint64_t, kPlaces> tags_{};  // 0: of no axes
  std::array<Entry, kPlaces> entries_;
};

}  // namespace boxtree
