// SPDX-License-Identifier: MIT
// The tree over the moving instances of a scene: in private memory, refitted from a leaf up when
// one of them is given another pose.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "format/children.h"
#include "format/memory.h"
#include "runtime/primitive/rounding.h"
#include "runtime/tree/bound_codec.h"
#include "runtime/tree/float_range.h"

namespace boxtree {

/// A complete binary tree: node 1 is the root, nodes 2n and 2n + 1 are the children of node n,
/// leaves are the last half. Holds boxes only. A leaf is a place; build() assigns places to
/// instances so that neighbours in the tree are neighbours in space.
class MovingTree {
 public:
  struct Decoder {
    using Scalar = double;
    using Children = ChildSet<2, double>;
    static constexpr std::uint32_t kDepthLimit = 32;

    const Box<double>* nodes = nullptr;
    std::uint32_t leaves = 0;  // a power of two

    [[nodiscard]] NodeState expand(NodeRef ref, const Box<double>& /*box*/,
                                   Children& out) const noexcept {
      out.clear();
      for (std::uint32_t child = 2 * ref.first; child <= 2 * ref.first + 1; ++child) {
        if (nodes[child].low[0] > nodes[child].high[0]) continue;  // no instance below
        out.add(nodes[child], NodeRef{child, 0}, child >= leaves);
      }
      return NodeState::kValid;
    }
  };

  /// For walks by vectors: the boxes of eight nodes, 8n to 8n + 7, rounded outwards to floats. Low
  /// planes of a box that is empty or no node's lie above its high ones.
  struct Eight {
    float low[3][8];
    float high[3][8];
  };
  /// How many of the levels there are in eights: every third, from the leaves up. The first has the
  /// root one to three levels above it.
  static constexpr std::size_t kMostDepths = 11;  // of 32 levels

  explicit MovingTree(const Memory* memory = nullptr) noexcept
      : nodes_(memory), eight_(memory), place_(memory), at_place_(memory) {}

  /// Assigns places to instances with these boxes and builds the tree over them. Allocates.
  MovingTree(std::span<const Box<double>> boxes, const Memory* memory);
  /// Precondition: both are of one memory.
  void swap(MovingTree& other) noexcept {
    std::swap(leaves_, other.leaves_);
    nodes_.swap(other.nodes_);
    eight_.swap(other.eight_);
    std::swap(depths_, other.depths_);
    std::swap(top_node_, other.top_node_);
    first_eight_.swap(other.first_eight_);
    place_.swap(other.place_);
    at_place_.swap(other.at_place_);
  }
  /// Gives the instance with number `moving` another box; O(log n), no allocation.
  void refit(std::uint32_t moving, const Box<double>& box) noexcept;

  [[nodiscard]] bool empty() const noexcept { return place_.empty(); }
  [[nodiscard]] bool is_leaf() const noexcept { return leaves_ == 1 && !empty(); }
  [[nodiscard]] std::uint32_t node_count() const noexcept { return empty() ? 0 : leaves_ - 1; }
  [[nodiscard]] NodeRef root_ref() const noexcept { return {1, 0}; }
  [[nodiscard]] Decoder decoder() const noexcept { return {nodes_.data(), leaves_}; }
  [[nodiscard]] const Box<double>& root_box() const noexcept { return nodes_[1]; }
  /// Whether it has eights that filters in single precision may be used for.
  [[nodiscard]] bool has_float_nodes() const noexcept {
    return !empty() && !is_leaf() && is_in_float_range(root_box());
  }
  /// See kMostDepths; leaves are of the last.
  [[nodiscard]] std::uint32_t depths() const noexcept { return depths_; }
  /// The node in lane 0 of the one eight of depth 0.
  [[nodiscard]] std::uint32_t top_node() const noexcept { return top_node_; }
  /// That of a node, which is in lane node % 8.
  [[nodiscard]] const Eight& eight(std::uint32_t node, std::size_t depth) const noexcept {
    return eight_[number_of_eight(node, depth)];
  }
  [[nodiscard]] const Box<double>& box(std::uint32_t moving) const noexcept {
    return nodes_[leaves_ + place_[moving]];
  }
  /// The number of a leaf's moving instance.
  [[nodiscard]] std::uint32_t instance(NodeRef leaf) const noexcept {
    return at_place_[leaf.first - leaves_];
  }

 private:
  void join(std::uint32_t node) noexcept;
  void number_eights() noexcept;
  void round(std::uint32_t node, std::size_t depth) noexcept;
  [[nodiscard]] std::uint32_t number_of_eight(std::uint32_t node,
                                              std::size_t depth) const noexcept {
    return node / 8 + first_eight_[depth];
  }

  std::uint32_t leaves_ = 0;
  std::uint32_t depths_ = 0;
  std::uint32_t top_node_ = 0;
  // Of each depth: the number of its first eight, less what node / 8 is there, modulo 2^32.
  std::array<std::uint32_t, kMostDepths> first_eight_{};
  Array<Box<double>> nodes_;  // [2 leaves_]; node 0 is not used
  Array<Eight> eight_;
  Array<std::uint32_t> place_;     // of each moving instance
  Array<std::uint32_t> at_place_;  // [leaves_]; unspecified where no instance is
};

template <class S>
[[nodiscard]] Box<S> root_box(const MovingTree& tree) noexcept {
  return tree.root_box();
}

/// Largest magnitude of any box coordinate, rounded outwards as in Eight.
[[nodiscard]] inline double max_abs_of(const MovingTree& tree) noexcept {
  return float_above(max_abs_of(tree.root_box()).maxCoeff());
}

}  // namespace boxtree
