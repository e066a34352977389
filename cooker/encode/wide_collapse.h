// SPDX-License-Identifier: MIT
// Converts a binary tree to one with eight children per node by choosing which nodes stay.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cooker/build/build_tree.h"
#include "format/codec_wide.h"

namespace boxtree::cooker {

/// The cheapest choice of nodes that stay such that each has at most eight children (dynamic
/// programming over forests, after Ylitie, Karras, Laine, "Efficient Incoherent Ray Traversal on
/// GPUs Through Compressed Wide BVHs", 2017). A node costs its area, as it is visited by that share
/// of rays, plus `node_cost` of the root's area for the bytes it takes.
class WideCollapse {
 public:
  /// Precondition: the tree has more than one leaf.
  WideCollapse(const BuildTree& tree, double node_cost);

  /// Nodes and leaves of the build tree that become the children of `node`, from left to right.
  void children_of(std::uint32_t node, std::vector<std::uint32_t>& children) const;

 private:
  // For forests with at most 1 .. 8 roots over a node and its subtree: the cost, and the number of
  // roots on the left; kSameAsFewer if one root less is as cheap.
  static constexpr std::uint8_t kSameAsFewer = 0xff;
  using Costs = std::array<double, kWideChildren>;
  using LeftRoots = std::array<std::uint8_t, kWideChildren>;

  // The cheapest division of a number of roots between two sides.
  struct Division {
    double cost;
    std::uint8_t on_left;
  };

  static Division best_division(const Costs& left, const Costs& right, std::size_t roots);
  // Fills the forests over a node and returns their costs.
  static Costs choose_forests(const Costs& left, const Costs& right, double own_cost,
                              LeftRoots& left_roots);
  void gather(std::uint32_t node, std::size_t roots, std::vector<std::uint32_t>& children) const;

  const BuildTree& tree_;
  std::vector<LeftRoots> left_roots_;
  std::vector<std::uint8_t> own_division_;  // of the eight roots below a node that stays
};

}  // namespace boxtree::cooker
