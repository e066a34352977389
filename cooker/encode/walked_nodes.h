// SPDX-License-Identifier: MIT
// Plain nodes with their numbers by kind, for packing and counting.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "format/codec_plain.h"

namespace boxtree::cooker {

/// The nodes of a binary tree in the order of the walk, with cuts in the codec's scalar type, and
/// each node's number among the nodes of its kind. Points to the bytes of the plain nodes.
template <class Cut>
struct WalkedNodes {
  Bytes bytes;
  std::vector<std::uint32_t> number;
  std::array<std::uint32_t, kNodeKinds> kind_count{};

  explicit WalkedNodes(Bytes plain) : bytes(plain), number(plain.size() / sizeof(PlainNode<Cut>)) {
    for (std::size_t i = 0; i < number.size(); ++i) {
      number[i] = kind_count[static_cast<std::size_t>((*this)[i].node_kind())]++;
    }
  }
  [[nodiscard]] std::size_t size() const { return number.size(); }
  [[nodiscard]] PlainNode<Cut> operator[](std::size_t i) const {
    return load<PlainNode<Cut>>(bytes.data(), i);
  }
  [[nodiscard]] std::uint32_t largest_count() const {
    return *std::max_element(kind_count.begin(), kind_count.end());
  }
};

}  // namespace boxtree::cooker
